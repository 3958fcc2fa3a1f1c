"""Clean feet: they do not slide where they stand, and no joint is under the floor."""

from collections.abc import Mapping

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.foot_joints import Feet, feet_of
from mocap.body.motion import Motion
from mocap.editing.above_floor import Heights, meet_above_floor
from mocap.editing.constraints import Pins
from mocap.editing.edits import edit_solving
from mocap.editing.pins import plant_pins
from mocap.editing.poses import poses_of
from mocap.editing.toes import lowest_allowed
from mocap.editing.tuned import TUNED
from mocap.feet.footskate import clean_up

UP = np.array([0.0, 1.0, 0.0])


def clean_feet(
    motion: Motion,
    lowest: Array | None = None,
    *,
    original: Motion | None = None,
    held: Mapping[int, Array] | None = None,
) -> Motion:
    """Remove foot sliding by `feet.clean_up`, and keep all joints above the floor.

    Parameters
    ----------
    motion : F frames of J joints; its `contacts` say when feet stand.
    lowest : as for `lowest_allowed`.
    original : the motion of which it was made, with heights that are allowed; by default the motion itself.
    held : as for `feet.clean_up`.

    Raises
    ------
    MocapError : as for `feet.clean_up`.

    Warns
    -----
    MocapWarning : for plants that are released, as by `feet.clean_up`.

    Examples
    --------
    >>> from mocap.body import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> heights = joint_positions(clean_feet(walk))[walk.contacts["rtoes"], walk.skeleton.index("rtoes"), 1]
    >>> bool(np.ptp(heights) < 1e-9)
    True
    """
    poses = poses_of(motion)
    source = poses if original is None else poses_of(original)
    cleaned = clean_up(motion, held=held, poses=poses.world)
    feet = feet_of(cleaned)
    return raised(cleaned, lowest_allowed(source, feet, lowest), feet)


def raised(motion: Motion, allowed: Array, feet: Feet) -> Motion:
    """Raise the tips of toes that are lower than allowed, and other joints under the floor, y = 0.

    Toes bend. If other joints are lower than allowed under the floor, by more than 3 mm, the smallest smooth
    change raises them.

    Parameters
    ----------
    motion : F frames of J joints, with clean feet. Plants stay where they are, or rise to the floor.
    allowed : the lowest height of each joint, (F, J), metres.
    feet : from `feet_of`.
    """
    poses = poses_of(motion)
    plants = plant_pins(poses)
    under_floor = np.minimum(allowed, 0.0)
    rise = _rise_of_plants(plants, feet, under_floor)
    raised_plants = Pins(plants.joints, plants.low + rise, plants.high + rise)
    heights = Heights(feet, allowed, under_floor, plants.joints, TUNED.sunk)
    return meet_above_floor(poses, raised_plants, edit_solving(poses), heights, solved=poses).motion


def _rise_of_plants(plants: Pins, feet: Feet, floor: Array) -> Array:
    """Compute the translations (F, P, 3), metres, that raise plants to the floor (F, J) of their joints."""
    is_planted = plants.held[..., 1]
    depth = np.where(is_planted, floor[:, list(plants.joints)] - plants.low[..., 1], 0.0)
    rise = np.zeros(depth.shape)
    for leg in feet.legs:  # a rigid foot: both of its joints rise by as much
        foot = np.isin(plants.joints, leg)
        rise[:, foot] = np.maximum(depth[:, foot].max(axis=1, keepdims=True), 0.0)
    return np.asarray(rise[..., None] * UP)
