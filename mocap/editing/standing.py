"""What stands keeps standing: plants in their places, a floor, and marks that are true after an edit."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body.limbs import find_legs
from mocap.editing.constraint_checks import warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import plant_pins
from mocap.editing.poses import MotionOrPoses, Poses, motion_of, poses_of
from mocap.editing.toes import SLACK, lowest_allowed
from mocap.feet.footskate import marks_by_joint, settled_marks

CLOSED = 1e-4  # metres: constraints with a larger error cause a warning, and plants among them are released


def plants_within(plants: Pins, poses: Poses, frames: slice) -> Pins:
    """Hold feet where they were in all other frames, and in plants that reach from these into them.

    Parameters
    ----------
    plants : of F frames, as from `plant_pins`.
    poses : F frames.
    frames : those that may change, a single range.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import plant_pins
    >>> from mocap.editing.poses import motion_of, poses_of
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> plants_within(plants, poses_of(walk), slice(None)) is plants
    True
    >>> bool(plants_within(plants, poses_of(walk), slice(100, 140)).held[:100].all())
    True
    """
    changes = np.zeros(len(poses), bool)
    changes[frames] = True
    if changes.all():
        return plants
    positions = poses.positions[:, list(plants.joints)]
    stays = np.repeat(~changes[:, None], len(plants.joints), axis=1)
    planted = np.asarray(plants.held.all(axis=-1))
    for leg in find_legs(poses.motion.skeleton):  # a rigid foot: both of its joints stay, or neither
        foot = np.isin(plants.joints, leg)
        for start, stop in runs(np.asarray(planted[:, foot].any(axis=1))):
            if not changes[start:stop].all():
                stays[start:stop, foot] |= planted[start:stop, foot]
    low = np.where(stays[..., None], positions, plants.low)
    high = np.where(stays[..., None], positions, plants.high)
    return Pins(plants.joints, low, high)


class Region(NamedTuple):
    """Frames of a motion, with all frames of the plants that reach into them.

    Parameters
    ----------
    frames : of the motion, a range.
    poses : of these frames, with settled contacts.
    plants : of these frames, of both legs.
    """

    frames: slice
    poses: Poses
    plants: Pins

    @property
    def start(self) -> int:
        """The first of the frames."""
        return int(self.frames.start)


def region_around(motion: MotionOrPoses, frames: slice) -> Region:
    """Select frames of a motion, with all frames of the plants that reach into them.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> region_around(sample("walk_straight"), slice(420, 440)).frames
    slice(405, 459, None)
    """
    clip = motion_of(motion)
    legs = find_legs(clip.skeleton)
    marks = settled_marks(clip, legs)
    wider = _with_whole_plants(np.asarray(marks.any(axis=1)), frames)
    poses = poses_of(motion[wider])
    contacts = {**poses.motion.contacts, **marks_by_joint(clip, legs, marks[..., wider])}
    settled = Poses(replace(poses.motion, contacts=contacts), poses.positions, poses.matrices)
    return Region(wider, settled, plant_pins(settled, legs))


def _with_whole_plants(planted: Mask, frames: slice) -> slice:
    """Extend a range of frames by the plants of L feet (L, F) that reach beyond its ends."""
    start = frames.start
    stop = frames.stop
    for foot in planted:
        lifted = np.flatnonzero(~foot)
        if foot[frames.start]:
            start = min(start, int(lifted[lifted < frames.start].max(initial=-1)) + 1)
        if foot[frames.stop - 1]:
            stop = max(stop, int(lifted[lifted >= frames.stop].min(initial=len(foot))))
    return slice(start, stop)


def allowed_by(pins: Pins, poses: Poses, lowest: Array) -> Array:
    """Compute the lowest height allowed for each joint, (F, J), metres, as `lowest_allowed` does.

    If constraints require that a joint be lower, all of its limb may be as low as necessary.

    Parameters
    ----------
    pins, poses : F frames.
    lowest : the lowest height of each joint of the feet in the whole motion, as from `lowest_of_feet`.
    """
    allowed = lowest_allowed(poses, lowest)
    skeleton = poses.motion.skeleton
    for column, joint in enumerate(pins.joints):
        if (pins.high[:, column, 1] < allowed[:, joint] - SLACK).any():
            below = [end for end in range(len(skeleton)) if joint in skeleton.path_to_root(end)]
            allowed[:, [*below, *skeleton.path_to_root(joint)]] = -np.inf
    return allowed


def floor_for(poses: Poses, feet: Sequence[int], allowed: Array) -> Pins:
    """Keep feet, and other joints that are too low, above the heights allowed (F, J), metres."""
    heights = poses.positions[..., 1]
    sinks = (heights < allowed - 2 * SLACK).any(axis=0)
    joints = sorted({*feet, *np.flatnonzero(sinks).tolist()})
    low = np.full((len(poses), len(joints), 3), -np.inf)
    low[..., 1] = allowed[:, joints]
    return Pins(joints, low, np.full_like(low, np.inf))


def mark_met(poses: Poses, joints: Sequence[int], errors: Array, plants: Pins) -> Poses:
    """Warn of constraints that are missed, and mark only those `plants` that are still in their places.

    Parameters
    ----------
    poses : F frames.
    joints : of all constraints, those on positions first, as from `Pins.indices`; those of plants among them.
    errors : shape (F, joints), of these constraints, metres.
    plants : of F frames.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import plant_pins
    >>> from mocap.editing.poses import motion_of, poses_of
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> with warnings.catch_warnings(action="ignore"):
    ...     for up in ([0, 0.00009, 0], [0, 0.00015, 0]):  # metres
    ...         higher = Pins(plants.joints, plants.low + up, plants.high + up)
    ...         errors = higher.errors(poses_of(walk))
    ...         met = mark_met(poses_of(walk), higher.indices, errors, plants)
    ...         print(met.motion.contacts["lfoot"].sum())
    52
    0
    """
    warn_of_errors(poses.motion, joints, errors, CLOSED)
    columns = [joints.index(joint) for joint in plants.joints]
    stands = plants.held.all(axis=-1) & (errors <= CLOSED)[:, columns]
    names = [poses.motion.skeleton.names[joint] for joint in plants.joints]
    contacts = {**poses.motion.contacts, **dict(zip(names, stands.T, strict=True))}
    return Poses(replace(poses.motion, contacts=contacts), poses.positions, poses.matrices)
