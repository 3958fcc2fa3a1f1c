"""AMASS archives (`.npz`): poses of the SMPL body as rotation vectors, in metres, with z up [AMASS19].

An archive contains `poses` (F, 66 or more) or (F, 22 or more, 3), or their parts `root_orient` (F, 3) and
`pose_body` (F, 63). Other programs for SMPL call the parts `global_orient` and `body_pose`, or the whole
`smpl_poses`, and the positions `transl` or `smpl_trans`. It also contains `trans` (F, 3), a frame rate, and
the shape parameters of the body, `betas`. The shape model has a separate licence and is not included: all
archives are read with the mean body of 22 joints. Fingers, face and soft tissue, the numbers after the first
66 of a pose, are ignored.

Archives that are written have the arrays of AMASS's files of the SMPL+H body: 156 numbers of a pose, of which
those of the fingers are 0, and 0 for `betas` and `dmpls`.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.archives import (
    AMASS,
    LOADERS,
    Arrays,
    Layout,
    Member,
    Rules,
    kind_of,
    open_archive,
    other_kind,
)
from mocap._shared.arrays import Indices
from mocap.body import rotations
from mocap.body.joint_trees import place_joints
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, Remedy, warn
from mocap.files import frame_rates, spaces
from mocap.files.recordings import Recording
from mocap.files.space_evidence import frames_to_look_at, gather

_JOINTS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("smpl.toml").read_text("utf-8"))
SKELETON = replace(Skeleton.from_table(_JOINTS), dofs=["xyz"] * len(_JOINTS))
PELVIS = np.array([0.0, -0.223, 0.028])  # metres: the pelvis for `trans` 0, in the axes of the archive

AXES = (1.0, "z")  # metres in a unit, and the axis that points up
WANTED = "an AMASS archive with poses and trans"
RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "framerate", "frame_rate")
WIDTH = 3 * len(SKELETON)  # numbers of a pose that are read
POSES = (("poses",), ("root_orient", "pose_body"), ("global_orient", "body_pose"), ("smpl_poses",))
"""The names of poses, whole or in two parts. The first that an archive has are read."""
USUAL_POSES = POSES[:2]  # those of AMASS
POSITIONS = ("trans", "transl", "smpl_trans")  # of the body, in other programs too
WHOLE = ("root_orient", "global_orient")  # arrays of which each number is read
SCALING = "smpl_scaling"  # of the unit of `smpl_trans`, in metres the positions are divided by it
WIDTHS = {
    "poses": WIDTH,
    "root_orient": 3,
    "pose_body": WIDTH - 3,
    "global_orient": 3,
    "body_pose": WIDTH - 3,
    "smpl_poses": WIDTH,
    "trans": 3,
    "transl": 3,
    "smpl_trans": 3,
}  # numbers of a frame that are read
LARGEST = 1e6  # radians, metres, frames per second: upper bound of all numbers
ALL_JOINTS = 52  # of the SMPL+H body, with fingers
SHAPES = 16  # shape parameters of a body
SOFT_SHAPES = 8  # shape parameters of soft tissue in a frame
# The arrays that are written, for F frames.
# reads: statement: a table
ARRAYS: Layout = {
    "poses": (float, ("F", 3 * ALL_JOINTS)),  # rotation vectors, radians
    "trans": (float, ("F", 3)),  # metres
    "betas": (float, (SHAPES,)),
    "dmpls": (float, ("F", SOFT_SHAPES)),
    "gender": (str, ()),
    "mocap_framerate": (float, ()),
}
SAME_OFFSET = 1e-6  # metres: the largest difference of the offsets of SMPL's body
REAL_NUMBERS = "fiu"  # kinds of NumPy types: floating point, signed and unsigned integers
ROOM = 2**27  # bytes of arrays in the smallest file, enough for a quarter of an hour of standing still


def is_amass(members: Mapping[str, Member]) -> bool:
    """Return whether an `.npz` file is an AMASS archive, by the names of its arrays.

    Examples
    --------
    >>> is_amass({})
    False
    """
    has_poses = any(set(keys) <= set(members) for keys in POSES)
    return has_poses and any(key in members for key in POSITIONS)


def joints_of_smpl(skeleton: Skeleton) -> Indices | None:
    """Return the index of each joint of `SKELETON` in a skeleton of the same body, or None for another body.

    The joints may have another order, as in a BVH file.

    Examples
    --------
    >>> joints_of_smpl(SKELETON)[:4]
    array([0, 1, 2, 3])
    >>> joints_of_smpl(Skeleton(["hips", "knee"], [-1, 0], [[0, 0, 0], [0, -0.4, 0]]))
    """
    if set(skeleton.names) != set(SKELETON.names):
        return None
    joints = np.array([skeleton.names.index(name) for name in SKELETON.names])
    parents = [skeleton.names[skeleton.parents[joint]] for joint in joints[1:]]
    expected = [SKELETON.names[parent] for parent in SKELETON.parents[1:]]
    differences = np.abs(skeleton.offsets[joints] - SKELETON.offsets)[1:]
    is_same = parents == expected and differences.max() <= SAME_OFFSET
    return joints if is_same else None


def arrays_of(motion: Motion, joints: Indices) -> dict[str, Any]:
    """Convert a motion of the SMPL body to the arrays of an archive, with z up.

    Parameters
    ----------
    motion : F frames.
    joints : the index of each joint of `SKELETON`, from `joints_of_smpl`.
    """
    z_up = rotations.inverse(spaces.UPRIGHT[AXES[1]])
    local = motion.rotations[:, joints]
    local[:, 0] = rotations.multiply(z_up, local[:, 0])
    poses = np.zeros((len(motion), ALL_JOINTS, 3))
    poses[:, : len(joints)] = rotations.to_rotvec(local)
    trans = rotations.rotate(z_up, motion.root_positions) - PELVIS
    frames = len(motion)
    moving = {"poses": poses.reshape(frames, -1), "trans": trans, "mocap_framerate": motion.fps}
    return moving | _mean_body(frames)


def _mean_body(frames: int) -> dict[str, Any]:
    """Return the arrays of an archive that describe the mean body, without soft tissue."""
    return {"gender": "neutral", "betas": np.zeros(SHAPES), "dmpls": np.zeros((frames, SOFT_SHAPES))}


def rules(arrays: Arrays) -> Rules:
    """Yield the validity rules of the arrays that are written."""
    yield "positions are below 1e6 m", np.abs(arrays["trans"]) < LARGEST
    yield "the frame rate is below 1e6 Hz", arrays["mocap_framerate"] < LARGEST


def is_written_by_mocap(members: Mapping[str, Member]) -> bool:
    """Return whether an archive was written by mocap, with z up and the exact frame rate."""
    return "format" in members and kind_of(members) == AMASS


def read(path: str | Path, *, fps: float | None = None, up: str | None = None) -> Recording:
    """Read an archive.

    Parameters
    ----------
    path : the file. Arrays of objects, which could contain code, are rejected.
    fps : frames per second, which replace those of the file, and are required if it has none.
    up : the axis that points up; by default z, as in AMASS, unless the frames show another, such as y.

    Returns
    -------
    A motion of `SKELETON`, y up, without angles.

    Raises
    ------
    MocapError, FormatError : for a file that cannot be read, and for arrays that are missing, not finite or
        have another shape. Also for another kind of file from mocap, with the function that reads it.

    Warns
    -----
    MocapWarning : if the file has shape parameters, which are ignored, and if its arrays have names of other
        programs than AMASS.
    """
    with open_archive(path, WANTED, ROOM) as members:
        keys = _keys_of_poses(path, members)
        key_of_positions = next((key for key in POSITIONS if key in members), POSITIONS[0])
        frames = _count_all_frames(path, members, (*keys, key_of_positions))
        is_ours = is_written_by_mocap(members)
        rate = fps or _rate(path, members, exact=is_ours)
        poses = np.hstack([_rows(members[key], frames) for key in keys])[:, :WIDTH]
        trans = _rows(members[key_of_positions], frames)[:, : WIDTHS[key_of_positions]]
        _require_small(path, " and ".join(keys), poses)
        _require_small(path, key_of_positions, trans)
        scaling = _scaling(path, members) if key_of_positions == "smpl_trans" else 1.0
        has_shape = _has_shape(members)
    if keys not in USUAL_POSES or key_of_positions != POSITIONS[0]:
        _warn_of_names(path, (*keys, key_of_positions), scaling)
    up = up or (AXES[1] if is_ours else None)
    if has_shape:
        effect = "the bones are those of the mean body, so feet may stand some centimetres off the ground"
        warn(f"{path}: betas, the shape of the body, are ignored: {effect}.")
    vectors = poses.astype(float).reshape(frames, -1, 3)
    local = rotations.from_rotvec(vectors)
    positions = PELVIS + trans.astype(float) / scaling
    evidence = None
    if up is None:
        looked_at, looked_rate = frames_to_look_at(positions, rate)
        world = place_joints(SKELETON, positions[looked_at], local[looked_at]).positions
        evidence = gather(SKELETON.parents, world, looked_rate)
    space = spaces.decide([evidence] if evidence else [], AXES, scale=1.0, up=up)
    turn = spaces.UPRIGHT[space.up]
    local[:, 0] = rotations.multiply(turn, local[:, 0])
    motion = Motion(SKELETON, rotations.rotate(turn, positions), local, rate, Path(path).stem)
    return Recording(motion, {}, {}, space=space, evidence=evidence)


def _keys_of_poses(path: str | Path, members: Mapping[str, Member]) -> tuple[str, ...]:
    """Return the names of the arrays of poses, whole or in parts. Raise for a file of another kind."""
    keys = next((keys for keys in POSES if set(keys) <= set(members)), POSES[0])
    if keys != POSES[0] or keys[0] in members:
        return keys
    if kind_of(members) in LOADERS:
        raise other_kind(path, WANTED, members)
    return keys


def _scaling(path: str | Path, members: Mapping[str, Member]) -> float:
    """Read by what positions are divided to be in metres; 1 if the file does not say it."""
    array = members.get(SCALING)
    if array is None:
        return 1.0
    return _positive_number(path, SCALING, array)


def _warn_of_names(path: str | Path, keys: tuple[str, ...], scaling: float) -> None:
    """Warn that arrays with the names of other programs are read as those of AMASS."""
    divided = f" / {scaling:g}" if scaling != 1.0 else ""
    *poses, positions = keys
    read_as = f"{' and '.join(poses)} are read as the poses of AMASS"
    warn(f"{path}: {read_as}, and {positions}{divided} as its trans, in metres.")


def _count_all_frames(path: str | Path, members: Mapping[str, Member], keys: tuple[str, ...]) -> int:
    """Return the number of frames. Raise if there are none, or arrays have different numbers of rows."""
    frames = _count_frames(path, members, keys[0])
    for key in keys[1:]:
        rows = _count_frames(path, members, key)
        if rows != frames:
            raise FormatError(path, None, f"as many rows of {key} as of {keys[0]}, {frames}", str(rows))
    if frames == 0:
        raise FormatError(path, None, f"one frame or more in '{keys[0]}'", "none")
    return frames


def _rows(member: Member, frames: int) -> NDArray[Any]:
    """Read an array with a row of numbers for each frame; (F, J, 3) are rows of J rotation vectors."""
    return member.read().reshape(frames, -1)


def _count_frames(path: str | Path, members: Mapping[str, Member], key: str) -> int:
    """Return the number of rows of an array. Raise if they are too short."""
    if key not in members:
        raise FormatError(path, None, "arrays 'poses' and 'trans', as AMASS archives have", f"no '{key}'")
    array = members[key]
    is_table = len(array.shape) in (2, 3) and array.dtype.kind in REAL_NUMBERS
    width = math.prod(array.shape[1:])
    has_other_parts = key in WHOLE and width != WIDTHS[key]
    if not is_table or width < WIDTHS[key] or has_other_parts:
        raise FormatError(path, None, f"{WIDTHS[key]} numbers for each frame in '{key}'", str(array))
    return array.shape[0]


def _require_small(path: str | Path, key: str, rows: NDArray[Any]) -> None:
    """Raise at the first frame with a number that is not finite, or too large."""
    is_small = (np.abs(rows) < LARGEST).all(axis=1)  # False for nan
    if not is_small.all():
        got = f"others in frame {is_small.argmin()}"
        raise FormatError(path, None, f"finite numbers below 1e6 in '{key}'", got)


def _has_shape(members: Mapping[str, Member]) -> bool:
    """Return whether the shape parameters of an archive differ from those of the mean body."""
    betas = members.get("betas")
    if betas is None or betas.dtype.kind not in REAL_NUMBERS or math.prod(betas.shape) > WIDTH:
        return False
    return bool(betas.read().any())


def _rate(path: str | Path, members: Mapping[str, Member], *, exact: bool) -> float:
    """Read the frame rate, under its newer or its older name, unless `exact` without noise in its digits."""
    key = next((key for key in RATES if key in members), None)
    if key is None:
        raise FormatError(path, None, f"'{RATES[0]}'", "none", remedy=Remedy("give {}", "fps"))
    rate = _positive_number(path, key, members[key])
    return rate if exact else frame_rates.without_noise(rate)


def _positive_number(path: str | Path, key: str, array: Member) -> float:
    """Read an array of a single number above 0."""
    expected = f"one number above 0 in '{key}'"
    if math.prod(array.shape) != 1 or array.dtype.kind not in REAL_NUMBERS:
        raise FormatError(path, None, expected, str(array))
    number = array.read().item()
    if not 0 < number < LARGEST:
        raise FormatError(path, None, expected, str(number))
    return float(number)
