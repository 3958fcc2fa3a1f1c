"""Blending of both ends of a walk into two poses, and removal of foot sliding between them.

The residuals at both ends decay into the walk, as those at a cut do in inertialization. This makes feet slide
slightly, and `feet.clean_up` [KSG02] removes the sliding, except in the poses themselves. All of this is
ours.
"""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement, difference, displaced
from mocap.editing.retiming import at_frames
from mocap.errors import MocapWarning
from mocap.feet.footplants import least_frames
from mocap.feet.footskate import clean_up, marks_by_joint, settled_marks
from mocap.methods.in_betweening.tuned import TUNED
from mocap.methods.in_betweening.two_sided_search import pose_at

ANKLE = 0  # the rows of a foot's joints
BALL = 1
FOOT = (ANKLE, BALL)


def meet_poses(motion: Motion, start: Motion, end: Motion, *, speed: bool = True) -> Motion:
    """Blend the first and the last frame of a walk into two poses, by residuals that decay into the walk.

    The residuals decay as in `blending.inertialize`: by a quintic that starts with their velocity at the
    pose, and ends at rest. At the end of the walk it runs backwards.

    Parameters
    ----------
    motion : F frames, which starts and ends near the poses.
    start, end : the poses, which are the first frame of `start` and the last frame of `end`.
    speed : whether the decay starts with the velocities of the residuals. Otherwise it starts level.
    """
    begin = _fading(motion, start, 1, speed=speed)
    finish = _fading(motion, end, -1, speed=speed)
    return displaced(motion, Displacement(begin.root + finish.root, begin.turns + finish.turns))


def _fading(motion: Motion, pose: Motion, direction: int, *, speed: bool) -> Displacement:
    """Compute the decay of the residual x of an end: x(u) = (1 - u)⁴ (x + (4 x + v T) u), and 0 for u ≥ 1.

    `direction` is 1 for the first frames of both motions, and -1 for their last ones.
    """
    last = len(motion) - 1
    frame = 0 if direction > 0 else last
    window = max(1.0, min(TUNED.fade * motion.fps, last / 2))
    time = np.minimum(np.abs(np.arange(last + 1) - frame) / window, 1)
    residual = difference(pose_at(pose, direction), motion[frame : frame + 1])
    drift = Displacement(0 * residual.root, 0 * residual.turns)
    if speed and len(pose) > 1:
        step = direction * motion.fps / pose.fps
        later = difference(pose_at(pose, direction, 1), at_frames(motion, [frame + step]))
        root = (later.root - residual.root) * window / abs(step)
        drift = Displacement(root, (later.turns - residual.turns) * window / abs(step))
    root = _quintic(residual.root, drift.root, time[:, None])
    return Displacement(root, _quintic(residual.turns, drift.turns, time[:, None, None]))


def _quintic(x: Array, v: Array, u: Array) -> Array:
    """Evaluate the quintic that decays from x with the velocity v at u = 0 to rest at u = 1."""
    return np.asarray((1 - u) ** 4 * (x + (4 * x + v) * u))


def stand(motion: Motion) -> Motion:
    """Remove foot sliding without changing the poses of the first and the last frames.

    `feet.clean_up` moves a footplant to its mean position, and blends the change over 0.2 s, which would
    change a pose at an end. Therefore footplants near an end keep their position next to it, and from there
    to the end both joints of the foot are held on their own path, as if they were planted.

    Parameters
    ----------
    motion : F frames with contacts, whose feet hardly slide at both ends.

    Returns
    -------
    The motion, in which footplants that the clean-up released are no longer marked.
    """
    legs = find_legs(motion.skeleton)
    marks = settled_marks(motion, legs)
    places = joint_positions(motion)
    columns = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    held = np.full((len(motion), len(columns), 3), np.nan)  # NaN for joints that are not held
    for number, leg_marks in enumerate(marks):
        foot = slice(len(FOOT) * number, len(FOOT) * (number + 1))
        foot_places = places[:, columns[foot]]
        _hold_end(held[:, foot], foot_places, leg_marks, motion.fps)
        # The start is the end of the reversed motion.
        _hold_end(held[::-1, foot], foot_places[::-1], leg_marks[:, ::-1], motion.fps)
    names = [motion.skeleton.names[joint] for joint in columns]
    settled = marks_by_joint(motion, legs, marks)
    is_held = np.isfinite(held[..., 0])
    ankle_last = range(len(columns))[::-1]  # its column counts where a foot without toes has its ball there
    constrained = {names[n]: settled[names[n]] | is_held[:, n] for n in ankle_last}
    by_joint = {columns[n]: held[:, n] for n in ankle_last}
    # The warnings of `clean_up` would also list the frames that are held here.
    with warnings.catch_warnings(action="ignore", category=MocapWarning):
        cleaned = clean_up(replace(motion, contacts={**motion.contacts, **constrained}), legs, held=by_joint)
    contacts = {name: mark & settled.get(name, mark) for name, mark in cleaned.contacts.items()}
    return replace(cleaned, contacts=contacts)


def _hold_end(held: Array, places: Array, marks: Mask, fps: float) -> None:
    """Fill in the positions at which a foot is held at the end of a motion and in its last footplant.

    Parameters
    ----------
    held : (F, 2, 3), positions that are filled in, NaN for joints that are not held.
    places : (F, 2, 3), the positions of ankle and ball.
    marks : (2, F), the contacts of ankle and ball.
    fps : frames per second.
    """
    frames = len(places)
    span = least_frames(fps)
    stands = runs(marks[ANKLE] | marks[BALL])
    begin = frames - span - 1
    if len(stands) and stands[-1][1] > frames - max(span, round(TUNED.near_end * fps)):
        first, begin = stands[-1].tolist()
        _hold_last_plant(held[:begin], places[:begin], marks[:, :begin], first)
    held[begin:] = places[begin:]
    # If one joint stands up to the end, the rotation of the foot determines the position of the other. This
    # includes gaps in the contacts that are so short that the clean-up closes them.
    for joint in FOOT:
        partner = BALL - joint
        is_alone = np.isnan(held[:, joint, 0]) & ~np.isnan(held[:, partner, 0])
        is_alone[: min(begin, frames - 1) - span] = False
        offset = places[is_alone, joint] - places[is_alone, partner]
        held[is_alone, joint] = held[is_alone, partner] + offset


def _hold_last_plant(held: Array, places: Array, marks: Mask, first: int) -> None:
    """Hold a foot in the footplant from frame `first` to the last frame.

    A joint that stands in the last frame is held at its position there, and the other joint at the distance
    of a foot's length.
    """
    length = np.linalg.norm(places[0, ANKLE] - places[0, BALL])
    for joint in sorted(FOOT, key=lambda joint: not marks[joint, -1]):
        partner = BALL - joint
        for start, stop in runs(marks[joint]):
            together = np.flatnonzero(np.isfinite(held[start:stop, partner, 0])) + start
            if stop == len(held):
                held[start:stop, joint] = places[-1, joint]
            elif start >= first and len(together):
                offset = (places[together, joint] - places[together, partner]).mean(axis=0)
                offset = length * offset / np.linalg.norm(offset)
                held[start:stop, joint] = held[together[-1], partner] + offset
