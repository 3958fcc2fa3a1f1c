"""Clips of one body as compact arrays, for files that carry their clips.

Quaternions are stored with 16 bits for each number, and positions of the root with 32. The arrays take about
a ninth of the memory of the clips, or less once they are compressed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mocap._shared.archives import Arrays, Layout, Rules
from mocap._shared.arrays import Mask
from mocap.body.motion import Marks, Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.files.motion_archives import MOST_JOINTS
from mocap.files.text import LARGEST

STEPS = 32767  # of a number of a quaternion, from 0 to 1
NOT_UNIT = 1e-3  # difference of a stored quaternion's length from 1
# The arrays of C clips with J joints and F frames in all, K labels and P joints with contacts.
# reads: statement: a table
LAYOUT: Layout = {
    "joints": (str, ("J",)),
    "parents": (int, ("J",)),
    "offsets": (float, ("C", "J", 3)),
    "axes": (float, ("J", 4)),
    "dofs": (str, ("J",)),
    "roots": (np.float32, ("F", 3)),
    "quaternions": (np.int16, ("F", "J", 4)),
    "label_names": (str, ("K",)),
    "clip_labels": (bool, ("F", "K")),
    "contact_names": (str, ("P",)),
    "clip_contacts": (bool, ("F", "P")),
}


def pack(clips: Sequence[Motion]) -> dict[str, Any]:
    """Return the arrays of `LAYOUT` for clips of one body, which may differ in the lengths of its bones.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> pack([sample("walk_straight")])["quaternions"].dtype
    dtype('int16')
    """
    skeleton = clips[0].skeleton
    quaternions = np.concatenate([clip.rotations for clip in clips])
    arrays: dict[str, Any] = {"joints": skeleton.names}
    arrays |= {key: getattr(skeleton, key) for key in ("parents", "axes", "dofs")}
    arrays["offsets"] = np.stack([clip.skeleton.offsets for clip in clips])
    arrays["roots"] = np.concatenate([clip.root_positions for clip in clips]).astype(np.float32)
    arrays["quaternions"] = np.round(STEPS * quaternions).astype(np.int16)
    arrays |= _columns("label_names", "clip_labels", clips, [clip.labels for clip in clips])
    return arrays | _columns("contact_names", "clip_contacts", clips, [clip.contacts for clip in clips])


def _columns(names: str, columns: str, clips: Sequence[Motion], marks: Sequence[Marks]) -> dict[str, Any]:
    """Return the names of marks, and a column of all frames for each, False in clips without it."""
    listed = list(dict.fromkeys(name for of_clip in marks for name in of_clip))
    rows = []
    for clip, of_clip in zip(clips, marks, strict=True):
        column = np.zeros((len(clip), len(listed)), bool)
        for number, name in enumerate(listed):
            column[:, number] = of_clip.get(name, False)
        rows.append(column)
    return {names: listed, columns: np.concatenate(rows)}


def unpack(arrays: Arrays, fps: float, names: Sequence[str], frames: Sequence[int]) -> list[Motion]:
    """Return the clips of `pack`, with their names and their numbers of frames.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> clip = sample("walk_straight")
    >>> packed = {key: np.asarray(array) for key, array in pack([clip]).items()}
    >>> [back] = unpack(packed, clip.fps, [clip.name], [len(clip)])
    >>> packing_error([clip], [back]) < 1e-3, list(back.labels)
    (True, ['walk'])
    """
    tree = {"parents": arrays["parents"], "axes": arrays["axes"], "dofs": arrays["dofs"].tolist()}
    stops = np.cumsum(frames).tolist()
    clips = []
    for number, (name, count, stop) in enumerate(zip(names, frames, stops, strict=True)):
        part = slice(stop - count, stop)
        skeleton = Skeleton(arrays["joints"].tolist(), offsets=arrays["offsets"][number], **tree)
        stored = arrays["quaternions"][part].astype(float)
        quaternions = stored / np.linalg.norm(stored, axis=-1, keepdims=True)
        roots = arrays["roots"][part].astype(float)
        labels = _marks(arrays, "label_names", "clip_labels", part)
        contacts = _marks(arrays, "contact_names", "clip_contacts", part)
        clips.append(Motion(skeleton, roots, quaternions, fps, name, labels, contacts))
    return clips


def _marks(arrays: Arrays, names: str, columns: str, frames: slice) -> dict[str, Mask]:
    """Return the marks in some frames, by their names; those of no frame are left out."""
    marks = zip(arrays[names].tolist(), arrays[columns][frames].T, strict=True)
    return {name: mark for name, mark in marks if mark.any()}


def packing_error(clips: Sequence[Motion], packed: Sequence[Motion]) -> float:
    """Return the largest distance of a joint in packed clips from its position, metres."""
    errors = [0.0]
    for clip, back in zip(clips, packed, strict=True):
        errors.append(float(np.linalg.norm(clip.positions - back.positions, axis=-1).max()))
    return max(errors)


def as_packed(clips: Sequence[Motion]) -> list[Motion]:
    """Return clips as they are after packing and unpacking, with the roles of their joints."""
    arrays = {key: np.asarray(array) for key, array in pack(clips).items()}
    names = [clip.name for clip in clips]
    backs = unpack(arrays, clips[0].fps, names, [len(clip) for clip in clips])
    chosen = []
    for back, clip in zip(backs, clips, strict=True):
        skeleton = replace(back.skeleton, roles=clip.skeleton.roles)
        chosen.append(replace(back, skeleton=skeleton))
    return chosen


def rules_of_packed(arrays: Arrays) -> Rules:
    """Yield the validity rules for the arrays of `LAYOUT`, beside the number of frames of each clip."""
    joints = arrays["joints"].tolist()
    yield f"a skeleton has at most {MOST_JOINTS} joints", 0 < len(joints) <= MOST_JOINTS
    yield "the frames are those of the clips", arrays["frames"].sum() == len(arrays["roots"])
    yield f"positions are below {LARGEST:g} m", np.abs(arrays["roots"]) < LARGEST
    yield f"offsets are below {LARGEST:g} m", np.abs(arrays["offsets"]) < LARGEST
    lengths = np.linalg.norm(arrays["quaternions"].astype(np.float32), axis=-1) / STEPS
    yield "rotations are quaternions of length 1", np.abs(lengths - 1) < NOT_UNIT
    yield "contacts are of joints", [name in joints for name in arrays["contact_names"].tolist()]
    yield "they are of one skeleton", _is_skeleton(arrays)


def _is_skeleton(arrays: Arrays) -> bool:
    """Return whether the arrays of the joints are a valid skeleton."""
    tree = {"parents": arrays["parents"], "axes": arrays["axes"], "dofs": arrays["dofs"].tolist()}
    try:
        for offsets in arrays["offsets"]:
            Skeleton(arrays["joints"].tolist(), offsets=offsets, **tree)
    except MocapError:
        return False
    return True
