"""What stands keeps standing: plants in their places, a floor, and marks that are true after an edit."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, runs
from mocap._shared.records import NamedTuple
from mocap.body.foot_joints import Feet, feet_of
from mocap.body.kinematics import positions_of
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.constraint_checks import warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import pins_of_plants
from mocap.editing.poses import MotionOrPoses, Poses, motion_of
from mocap.editing.toes import SLACK, lowest_allowed

CLOSED = 1e-4  # metres: constraints with a larger error cause a warning, and plants among them are released


def plants_within(plants: Pins, poses: Poses, frames: slice, legs: Sequence[Leg]) -> Pins:
    """Hold feet where they were in all other frames, and in plants that reach from these into them.

    Parameters
    ----------
    plants : of F frames, as from `plant_pins`.
    poses : F frames.
    frames : those that may change, a single range.
    legs : of the plants.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import plant_pins
    >>> from mocap.editing.poses import poses_of
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> legs = find_legs(walk.skeleton)
    >>> plants_within(plants, poses_of(walk), slice(None), legs) is plants
    True
    >>> bool(plants_within(plants, poses_of(walk), slice(100, 140), legs).held[:100].all())
    True
    """
    changes = np.zeros(len(poses), bool)
    changes[frames] = True
    if changes.all():
        return plants
    positions = poses.positions[:, list(plants.joints)]
    stays = np.repeat(~changes[:, None], len(plants.joints), axis=1)
    planted = np.asarray(plants.held.all(axis=-1))
    for leg in legs:  # a rigid foot: both of its joints stay, or neither
        foot = np.isin(plants.joints, leg)
        for start, stop in runs(np.asarray(planted[:, foot].any(axis=1))):
            if not changes[start:stop].all():
                stays[start:stop, foot] |= planted[start:stop, foot]
    low = np.where(stays[..., None], positions, plants.low)
    high = np.where(stays[..., None], positions, plants.high)
    return Pins(plants.joints, low, high)


class Source(NamedTuple):
    """A motion that an edit starts from, as far as the edit must know all of it.

    Parameters
    ----------
    clip : F frames of J joints.
    feet : those of its skeleton.
    lowest : shape (J,), metres: the lowest height of each joint of the feet, -∞ for other joints.
    plants : of F frames, of both legs, where they stand in the clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> source = source_of(sample("walk_straight"))
    >>> [round(float(source.lowest[joint]), 3) for joint in (6, 0)]  # a tip of toes, and the root
    [0.017, -inf]
    """

    clip: MotionOrPoses
    feet: Feet
    lowest: Array
    plants: Pins


def source_of(clip: MotionOrPoses) -> Source:
    """Find the feet of a motion, where they stand, and how low they are.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.
    """
    motion = motion_of(clip)
    feet = feet_of(motion)
    legs = feet.legs or find_legs(motion.skeleton)
    stand = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    joints = [*stand, *feet.joints]
    positions = clip.positions[:, joints] if isinstance(clip, Poses) else positions_of(motion, joints)
    lowest = np.full(len(motion.skeleton), -np.inf)
    lowest[joints] = positions[..., 1].min(axis=0)
    return Source(clip, feet, lowest, pins_of_plants(motion, legs, positions[:, : len(stand)]))


def allowed_by(pins: Pins, poses: Poses, source: Source) -> Array:
    """Compute the lowest height allowed for each joint, (F, J), metres, as `lowest_allowed` does.

    If constraints require that a joint be lower, all of its limb may be as low as necessary.

    Parameters
    ----------
    pins, poses : F frames.
    source : the whole motion.
    """
    allowed = lowest_allowed(poses, source.feet, source.lowest)
    skeleton = poses.motion.skeleton
    for column, joint in enumerate(pins.joints):
        if (pins.high[:, column, 1] < allowed[:, joint] - SLACK).any():
            below = [end for end in range(len(skeleton)) if joint in skeleton.path_to_root(end)]
            allowed[:, [*below, *skeleton.path_to_root(joint)]] = -np.inf
    return allowed


def mark_met(poses: Poses, pins: Pins, plants: Pins, first_frame: int = 0) -> Motion:
    """Warn of constraints that are missed, and mark only those `plants` that are still in their places.

    Parameters
    ----------
    poses : F frames.
    pins : of F frames, all constraints; those of plants are among them.
    plants : of F frames.
    first_frame : the number of the first of them in the clip, which the warning counts from.

    Examples
    --------
    >>> import warnings
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import plant_pins
    >>> from mocap.editing.poses import poses_of
    >>> walk = sample("walk_straight")[:240]
    >>> plants = plant_pins(walk)
    >>> with warnings.catch_warnings(action="ignore"):
    ...     for up in ([0, 0.00009, 0], [0, 0.00015, 0]):  # metres
    ...         higher = Pins(plants.joints, plants.low + up, plants.high + up)
    ...         print(mark_met(poses_of(walk), higher, plants).contacts["lfoot"].sum())
    52
    0
    """
    joints = pins.indices
    errors = pins.errors(poses)
    warn_of_errors(poses.motion, joints, errors, CLOSED, first_frame)
    columns = [joints.index(joint) for joint in plants.joints]
    stands = plants.held.all(axis=-1) & (errors <= CLOSED)[:, columns]
    names = [poses.motion.skeleton.names[joint] for joint in plants.joints]
    contacts = {**poses.motion.contacts, **dict(zip(names, stands.T, strict=True))}
    return replace(poses.motion, contacts=contacts)
