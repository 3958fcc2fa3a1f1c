"""Acclaim motions (`.amc`) of an Acclaim skeleton.

An AMC file gives a bone's rotation M as angles about the bone's own axes. The ASF file turns these axes by C
against the world, so a joint's rotation in its parent's frame is L = C M C⁻¹.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.errors import FormatError
from mocap.files.amc import read_frames
from mocap.files.asf import MOVES, TURNS, AcclaimSkeleton, Bone
from mocap.files.text import check_room

CMU_RATE = 120.0  # frames per second in most of the CMU database


def read_amc(path: str | Path, asf: AcclaimSkeleton, *, fps: float | None = None) -> Motion:
    """Read an AMC file.

    The root's position is its position at rest + T; its rotation is M O, with O its orientation at rest.

    Parameters
    ----------
    path : the file.
    asf : its skeleton.
    fps : frames per second; by default those of a first line "# fps 30", which `save` writes, else CMU's 120.

    Returns
    -------
    The motion, named after the file.

    Raises
    ------
    FormatError : with the line that breaks the format or does not fit the skeleton.
    """
    keywords, numbers, rate = read_frames(path, asf.dofs(), asf.needed())
    degrees, frames = _in_degrees(keywords, asf), len(numbers["root"])
    check_room(path, frames * len(asf.skeleton), sum(block.size for block in numbers.values()))
    local = np.tile(rotations.IDENTITY, (frames, len(asf.skeleton), 1))
    for name in asf.needed():
        bone, block = asf.bones[name], numbers[name]
        for place, dof in enumerate(bone.dofs if name != "root" else ()):
            if dof not in TURNS and np.any(moving := block[:, place] != 0):
                frame, expected = int(moving.argmax()), "since bones keep their lengths"
                got = f"{block[frame, place]:g} in frame {frame}"
                raise FormatError(path, None, f"0 for '{dof}' of '{name}', {expected}", got)
        local[:, asf.skeleton.index(name)] = turned(name, bone, block, degrees)
    root = asf.bones["root"]
    moves = np.zeros((len(local), 3))
    for column, move in zip(numbers["root"].T, root.dofs, strict=True):
        if move in MOVES:
            moves[:, MOVES.index(move)] = column
    return Motion(
        asf.skeleton, root.vector + moves * asf.unit, local, fps or rate or CMU_RATE, Path(path).stem
    )


def read_angles(path: str | Path, asf: AcclaimSkeleton) -> dict[str, Array]:
    """Give each bone's angles, shape (F, rotational dofs), in degrees, as they are in the file."""
    keywords, numbers, _ = read_frames(path, asf.dofs(), asf.needed())
    unit = 1.0 if _in_degrees(keywords, asf) else np.degrees(1.0)
    return {name: unit * numbers[name][:, asf.bones[name].turns] for name in asf.needed()}


def _in_degrees(keywords: set[str], asf: AcclaimSkeleton) -> bool:
    return ":RADIANS" not in keywords and (asf.degrees or ":DEGREES" in keywords)


def turned(name: str, bone: Bone, numbers: Array, degrees: bool) -> Array:
    """Turn a bone's numbers (F, dofs) into quaternions (F, 4), in its parent's frame."""
    turns = numbers[:, bone.turns]
    angles = np.radians(turns) if degrees else turns
    own = (
        euler.from_euler(bone.order, angles) if bone.order else np.tile(rotations.IDENTITY, (len(angles), 1))
    )
    return rotations.multiply(own, bone.axis) if name == "root" else own @ conjugation(bone.axis)


def conjugation(axis: Array) -> Array:
    """Give the matrix (4, 4) with M @ matrix = C M C⁻¹: linear in M, its rows are where 1, i, j, k go."""
    return rotations.multiply(rotations.multiply(axis, np.eye(4)), rotations.inverse(axis))
