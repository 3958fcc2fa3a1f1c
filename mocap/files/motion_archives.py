"""Motions as `.npz` archives, which keep all numbers, labels, contacts and roles.

A motion of the SMPL body is written in the layout of AMASS, for all programs that read AMASS, see `amass`.
Any other motion is written in the layout of mocap, and read again exactly: an array for each field of
`Motion` and `Skeleton`, with y up, in metres. `numpy.load` reads both, and neither contains code.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared import archives
from mocap._shared.archives import Arrays, Kind, Layout, Rules
from mocap._shared.arrays import Mask
from mocap.body.motion import Marks, Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, shortened
from mocap.files import amass, spaces
from mocap.files.recordings import Recording
from mocap.files.text import LARGEST

MOST_JOINTS = 10_000  # of a skeleton, far above those of any rig
NOT_UNIT = 2e-6  # difference of a quaternion's length from 1; `Motion` refuses half of it
LONGEST_NAME = 1000  # characters: in an array of texts, each takes the memory of the longest

# The arrays of both layouts, for F frames, L labels, C joints with contacts and R roles.
# reads: statement: a table
MARKS: Layout = {
    "name": (str, ()),
    "label_names": (str, ("L",)),
    "labels": (bool, ("F", "L")),
    "contact_names": (str, ("C",)),  # names of joints
    "contacts": (bool, ("F", "C")),
    "role_names": (str, ("R",)),
    "role_joints": (str, ("R",)),  # names of joints
}
# The arrays of the layout of mocap, for F frames of J joints.
# reads: statement: a table
ARRAYS: Layout = {
    "names": (str, ("J",)),
    "parents": (int, ("J",)),
    "offsets": (float, ("J", 3)),
    "axes": (float, ("J", 4)),
    "dofs": (str, ("J",)),
    "root_positions": (float, ("F", 3)),
    "rotations": (float, ("F", "J", 4)),
    "fps": (float, ()),
    **MARKS,
}


def _rules(arrays: Arrays) -> Rules:
    """Yield the validity rules that `Motion` and `Skeleton` do not check, or report at length."""
    yield f"a skeleton has at most {MOST_JOINTS} joints", len(arrays["names"]) <= MOST_JOINTS
    lengths = np.linalg.norm(arrays["rotations"], axis=-1)
    yield "rotations are quaternions of length 1", np.abs(lengths - 1) < NOT_UNIT
    for key in ("root_positions", "offsets"):
        yield f"'{key}' are finite and below {LARGEST:g} m", np.abs(arrays[key]) < LARGEST
    yield f"the frame rate is from {1 / LARGEST:g} to {LARGEST:g} Hz", _is_rate(arrays["fps"])
    yield from _rules_of_marks(arrays)


def _is_rate(fps: NDArray[Any]) -> bool:
    """Return whether a number is a frame rate that all measures in seconds can use."""
    return bool(1 / LARGEST < fps < LARGEST)


def _rules_of_marks(arrays: Arrays) -> Rules:
    """Yield the validity rules of labels, contacts and roles."""
    for key in ("label_names", "contact_names", "role_names"):
        yield f"no name comes twice in '{key}'", len(np.unique(arrays[key])) == len(arrays[key])


def _rules_of_amass(arrays: Arrays) -> Rules:
    """Yield the validity rules of a written archive in the layout of AMASS."""
    yield from amass.rules(arrays)
    yield from _rules_of_marks(arrays)


MOTION = Kind(archives.MOTION, ARRAYS, _rules)
SMPL_MOTION = Kind(archives.AMASS, {**amass.ARRAYS, **MARKS}, _rules_of_amass)
MARKS_OF_AMASS = Kind(archives.AMASS, {"trans": amass.ARRAYS["trans"], **MARKS}, _rules_of_marks)


def is_motion(path: str | Path) -> bool:
    """Return whether an `.npz` file contains a motion, in the layout of AMASS or of mocap, or is damaged.

    A damaged file may be a motion: readers then report the damage, and do not ignore the file.

    Examples
    --------
    >>> is_motion("graph.npz")
    False
    """
    try:
        with archives.open_archive(path, archives.MOTION, amass.ROOM) as members:
            return amass.is_amass(members) or archives.kind_of(members) == MOTION.name
    except FormatError:
        return True
    except MocapError:
        return False


def write(motion: Motion, path: str | Path) -> None:
    """Write a motion to an archive atomically, in the layout of AMASS if the body is SMPL's.

    Parameters
    ----------
    motion : F frames. Of a motion of the SMPL body, rotations and positions are kept within rounding, and the
        `axes` and `dofs` of its skeleton are not. Of any other motion, everything is kept exactly.
    path : the file, `.npz`.

    Raises
    ------
    MocapError : for names that an archive cannot represent, and a file that cannot be written.
    """
    arrays = _arrays_of_marks(motion)
    joints = amass.joints_of_smpl(motion.skeleton)
    if joints is None:
        skeleton = motion.skeleton
        arrays |= {key: getattr(skeleton, key) for key in ("names", "parents", "offsets", "axes", "dofs")}
        arrays |= {key: getattr(motion, key) for key in ("root_positions", "rotations", "fps")}
        _require_names(motion.skeleton.names)
        archives.write_archive(path, MOTION, arrays)
    else:
        archives.write_archive(path, SMPL_MOTION, arrays | amass.arrays_of(motion, joints))


def _arrays_of_marks(motion: Motion) -> dict[str, Any]:
    """Convert the name, the labels, the contacts and the roles of a motion to arrays."""
    roles = motion.skeleton.roles
    _require_names([motion.name, *motion.labels, *roles])
    arrays: dict[str, Any] = {"name": motion.name}
    for key, marks in {"label": motion.labels, "contact": motion.contacts}.items():
        arrays[f"{key}_names"] = [*marks]
        arrays[f"{key}s"] = _columns(marks, len(motion))
    return arrays | {"role_names": [*roles], "role_joints": [*roles.values()]}


def _columns(marks: Marks, frames: int) -> Mask:
    """Return marks as the columns of an array, shape (F, number of marks)."""
    rows = np.zeros((len(marks), frames), bool)
    for row, mark in zip(rows, marks.values(), strict=True):
        row[:] = mark
    return rows.T


def _require_names(names: Iterable[str]) -> None:
    """Raise for a name that an array of texts cannot hold: NumPy drops zero characters at the end."""
    for name in names:
        if name.endswith("\0") or len(name) > LONGEST_NAME:
            needs = f"names of at most {LONGEST_NAME} characters, without a zero character at the end"
            raise MocapError(f"An .npz file holds {needs}, got {shortened(repr(name), 60)}.")


def read(path: str | Path, *, fps: float | None = None, up: str | None = None) -> Recording:
    """Read a motion from an archive in the layout of AMASS or of mocap.

    Parameters
    ----------
    path : the file. Arrays of objects, which could contain code, are rejected.
    fps : frames per second, which replace those of the file.
    up : the axis that points up; by default y in the layout of mocap, and for AMASS as `amass.read` finds it.

    Returns
    -------
    A motion with y up. One that mocap wrote has the name, the labels, the contacts and the roles of the file.

    Raises
    ------
    MocapError, FormatError : for a file that cannot be read, one of another kind, and one that is damaged or
        contains no valid motion.
    """
    with archives.open_archive(path, amass.WANTED, amass.ROOM) as members:
        is_of_mocap = archives.kind_of(members) == MOTION.name
        has_marks = amass.is_written_by_mocap(members)
    if is_of_mocap:
        motion = _read_motion(path)
        motion = spaces.upright(motion if fps is None else replace(motion, fps=fps), up or "y")
        return Recording(motion, {}, {}, has_roles=True)
    recording = amass.read(path, fps=fps, up=up)
    if not has_marks:
        return recording
    return recording._replace(motion=_with_marks(path, recording.motion), has_roles=True)


def _read_motion(path: str | Path) -> Motion:
    """Read a motion in the layout of mocap."""
    arrays = archives.read_archive(path, MOTION, amass.ROOM)
    with _validated(path):
        names = arrays["names"].tolist()
        dofs = arrays["dofs"].tolist()
        tree = {"parents": arrays["parents"], "offsets": arrays["offsets"]}
        skeleton = Skeleton(names, **tree, axes=arrays["axes"], dofs=dofs, roles=_roles(arrays))
        fps = arrays["fps"].item()
        return Motion(skeleton, arrays["root_positions"], arrays["rotations"], fps, **_marks(arrays))


def _with_marks(path: str | Path, motion: Motion) -> Motion:
    """Give a motion of the SMPL body the name, the marks and the roles of its archive."""
    arrays = archives.read_archive(path, MARKS_OF_AMASS, amass.ROOM)
    with _validated(path):
        skeleton = replace(motion.skeleton, roles=_roles(arrays))
        return replace(motion, skeleton=skeleton, **_marks(arrays))


@contextmanager
def _validated(path: str | Path) -> Iterator[None]:
    """Convert an error of `Motion` or `Skeleton` to that of a file."""
    try:
        with np.errstate(all="ignore"):
            yield
    except MocapError as error:
        raise FormatError(path, None, "a valid motion", error.problem()) from None


def _marks(arrays: Arrays) -> dict[str, Any]:
    """Return the name, the labels and the contacts in the arrays of a file, as parameters of `Motion`."""
    marks: dict[str, Any] = {"name": str(arrays["name"])}
    for key in ("label", "contact"):
        names = arrays[f"{key}_names"].tolist()
        marks[f"{key}s"] = dict(zip(names, arrays[f"{key}s"].T, strict=True))
    return marks


def _roles(arrays: Arrays) -> dict[str, str]:
    """Return the roles in the arrays of a file."""
    return dict(zip(arrays["role_names"].tolist(), arrays["role_joints"].tolist(), strict=True))
