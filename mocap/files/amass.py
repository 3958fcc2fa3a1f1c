"""AMASS archives (`.npz`): poses of the SMPL body as rotation vectors, in metres, with z up [AMASS19].

An archive holds `poses` (F, 66 or more), `trans` (F, 3), a frame rate, and numbers of the body's shape,
`betas`. The surface that the shape belongs to comes under a licence of its own and is not here: all archives
are read onto one body of 22 joints, the mean one. Fingers, face and soft tissue, the numbers after the first
66 of a pose, are left out.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mocap._shared.archives import Member, open_archive
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, Remedy, warn
from mocap.files.recordings import Recording

_JOINTS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("smpl.toml").read_text("utf-8"))
SKELETON = replace(Skeleton.from_table(_JOINTS), dofs=["xyz"] * len(_JOINTS))
PELVIS = np.array([0.0, -0.223, 0.028])  # where `trans` 0 puts the pelvis, in the archive's own axes

RATES = ("mocap_framerate", "mocap_frame_rate")
WIDTH = 3 * len(SKELETON)
WIDTHS = {"poses": WIDTH, "trans": 3}  # numbers of a frame that are read
ROOM = 2**27  # bytes of arrays in the smallest file: somebody who stands still for a quarter of an hour


def is_amass(path: str | Path) -> bool:
    """Check, by the names of its arrays, whether an `.npz` file is such an archive.

    Examples
    --------
    >>> is_amass("graph.npz")
    False
    """
    try:
        with open_archive(path, "an AMASS archive", ROOM) as members:
            return {"poses", "trans"} <= set(members)
    except MocapError:
        return False


def read(path: str | Path, *, fps: float | None = None) -> Recording:
    """Read an archive.

    Parameters
    ----------
    path : the file. No code in it is run: arrays of objects are refused.
    fps : frames per second, which replace those of the file; needed where it has none.

    Returns
    -------
    A motion of `SKELETON`, y up; no angles.

    Raises
    ------
    MocapError, FormatError : for a file that cannot be read, and for arrays that are missing, of another
        shape, or not finite.

    Warns
    -----
    MocapWarning : where the file gives the body a shape.
    """
    with open_archive(path, "an AMASS archive with poses and trans", ROOM) as members:
        counts = [_count(path, members, key) for key in WIDTHS]
        if counts[0] != counts[1]:
            raise FormatError(path, None, f"as many rows of trans as of poses, {counts[0]}", str(counts[1]))
        if counts[0] == 0:
            raise FormatError(path, None, "one frame or more in 'poses'", "none")
        rate = fps or _rate(path, members)
        numbers = {key: members[key].read()[:, :width] for key, width in WIDTHS.items()}
        for key, rows in numbers.items():
            fine = (np.abs(rows) < 1e6).all(axis=1)  # not so for nan
            if not fine.all():
                got = f"others in frame {fine.argmin()}"
                raise FormatError(path, None, f"finite numbers below 1e6 in '{key}'", got)
        betas = members.get("betas")
        plausible = betas is not None and betas.dtype.kind in "fiu" and math.prod(betas.shape) <= WIDTH
        shaped = betas is not None and plausible and betas.read().any()
    if shaped:
        so = "the bones are those of the mean body, so feet may stand some centimetres off the ground"
        warn(f"{path}: betas, the shape of the body, are ignored: {so}.")
    poses, trans = (rows.astype(float) for rows in numbers.values())
    local = rotations.from_rotvec(poses.reshape(len(poses), -1, 3))
    local[:, 0] = rotations.multiply(rotations.Z_UP, local[:, 0])
    places = rotations.rotate(rotations.Z_UP, PELVIS + trans)
    return Recording(Motion(SKELETON, places, local, rate, Path(path).stem), {}, {})


def _count(path: str | Path, members: Mapping[str, Member], key: str) -> int:
    """Count the frames of an array, which has rows of numbers, as many as are read, or more."""
    if key not in members:
        raise FormatError(path, None, "arrays 'poses' and 'trans', as AMASS archives have", f"no '{key}'")
    member = members[key]
    if len(member.shape) != 2 or member.shape[1] < WIDTHS[key] or member.dtype.kind not in "fiu":
        raise FormatError(path, None, f"{WIDTHS[key]} numbers for each frame in '{key}'", str(member))
    return member.shape[0]


def _rate(path: str | Path, members: Mapping[str, Member]) -> float:
    key = next((key for key in RATES if key in members), None)
    if key is None:
        raise FormatError(path, None, f"'{RATES[0]}'", "none", remedy=Remedy("give {}", "fps"))
    member = members[key]
    rate = member.read().item() if math.prod(member.shape) == 1 and member.dtype.kind in "fiu" else None
    if rate is None or not 0 < rate < 1e6:
        got = str(member) if rate is None else str(rate)
        raise FormatError(path, None, f"one number above 0 in '{key}'", got)
    return float(rate)
