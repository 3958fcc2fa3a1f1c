"""Motions one after the other, and what they need for it: one skeleton and one frame rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Indices, Mask, ranges
from mocap.body.motion import Marks, Motion, require_motions
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, SkeletonMismatch

SAME_RATE = 1.001e-3  # relative difference of frame rates that are one: 29.97 and 30 Hz


def concatenate(motions: Sequence[Motion], name: str | None = None) -> Motion:
    """Concatenate motions in time, without alignment or blending.

    Parameters
    ----------
    motions : one or more, with one skeleton and one frame rate. A label or contact that a motion lacks is
        False in its frames.
    name : the new name, by default that of the first motion.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, or an empty list.

    Examples
    --------
    >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> still = Motion(bone, np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1, 1)), 30.0, "still")
    >>> concatenate([still, still], "stiller")
    Motion('stiller', 8 frames at 30 Hz, 0.233 s, 1 joint)

    Notebook: 00-quickstart
    """
    motions = require_compatible(motions)
    first = motions[0]
    counts = np.array([len(motion) for motion in motions])
    frames = np.stack([np.repeat(np.arange(len(motions)), counts), ranges(0 * counts, counts)], axis=1)
    root_positions = np.concatenate([motion.root_positions for motion in motions])
    rotations = np.concatenate([motion.rotations for motion in motions])
    labels = gather_marks([motion.labels for motion in motions], frames)
    contacts = gather_marks([motion.contacts for motion in motions], frames)
    name = name or first.name
    return Motion(first.skeleton, root_positions, rotations, first.fps, name, labels, contacts)


def require_compatible(motions: Sequence[Motion]) -> tuple[Motion, ...]:
    """Return motions on one skeleton. Raise unless they share it, except for end sites, and a frame rate.

    Files of one laboratory may differ in end sites, which end the last bones and never rotate. All motions
    get the end sites of the first motion with the most joints [ours]. Rates that differ by a
    thousandth or less, such as 29.97 and 30 Hz, are one: that of the first motion [ours].

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and for an empty list.

    Examples
    --------
    >>> from mocap.body import resample
    >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> walk = Motion(bone, np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1, 1)), 120.0, "walk")
    >>> require_compatible([walk, resample(walk, 30.0)])
    Traceback (most recent call last):
    mocap.errors.MocapError: 'walk' runs at 120 Hz, 'walk' at 30 Hz: resample one first.
    """
    motions = require_motions(motions)
    if not motions:
        raise MocapError("This takes one clip or more, got none.")
    fullest = max(motions, key=lambda motion: len(motion.skeleton))
    alike = []
    for motion in motions:
        try:
            alike.append(_with_ends(motion, fullest.skeleton))
        except SkeletonMismatch as error:
            raise SkeletonMismatch(f"'{fullest.name}' and '{motion.name}': {error}") from None
        rate = motions[0].fps
        if abs(motion.fps - rate) > SAME_RATE * rate:
            rates = f"'{motions[0].name}' runs at {motions[0].fps:g} Hz, '{motion.name}' at {motion.fps:g} Hz"
            raise MocapError(f"{rates}: resample one first.")
        if motion.fps != rate:
            alike[-1] = replace(alike[-1], fps=rate)
    return tuple(alike)


def _with_ends(motion: Motion, skeleton: Skeleton) -> Motion:
    """Transfer a motion to a skeleton that differs in end sites only. End sites new to it do not rotate."""
    source = motion.skeleton
    if source is skeleton:
        return motion
    joints = skeleton.joints_in(source)
    if source.names == skeleton.names and np.allclose(source.offsets, skeleton.offsets, rtol=0, atol=1e-6):
        return motion
    rotations = np.where((joints < 0)[:, None], [1.0, 0, 0, 0], motion.rotations[:, joints])
    contacts = {joint: mark for joint, mark in motion.contacts.items() if joint in skeleton.names}
    return replace(motion, skeleton=skeleton, rotations=rotations, contacts=contacts)


def gather_marks(sources: Sequence[Marks], frames: Indices) -> dict[str, Mask]:
    """Gather labels or contacts frame by frame from several motions. One that a motion lacks is False there.

    Parameters
    ----------
    sources : the labels, or the contacts, of each motion.
    frames : shape (F, 2): for each new frame, the number of its motion and its frame in that motion.

    Returns
    -------
    Booleans of shape (F,) for each name in the sources.

    Examples
    --------
    >>> walk, jog = {"walk": np.array([True, True])}, {"jog": np.array([True])}
    >>> gather_marks([walk, jog], np.array([[0, 1], [1, 0]]))
    {'walk': array([ True, False]), 'jog': array([False,  True])}
    """
    gathered: dict[str, Mask] = {}
    for source, marks in enumerate(sources):
        mine = frames[:, 0] == source
        for name, mark in marks.items():
            gathered.setdefault(name, np.zeros(len(frames), bool))[mine] = mark[frames[mine, 1]]
    return gathered
