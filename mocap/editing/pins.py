"""Constraints that edits use: footplants, rails, floors, bars, limits of joints, and orientations."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs, with_roles
from mocap.body.motion import Motion, require_motion
from mocap.editing.boxes import PositionBoxes, RelativeRotation, RotationBoxes
from mocap.editing.constraint_checks import require_pins_of
from mocap.editing.constraints import Pins
from mocap.editing.poses import Frames, MotionOrPoses, poses_of
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError
from mocap.feet.ankle_targets import place_plants, places_at_heights
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import settled_marks


def pin(
    motion: Motion, joint: str | int, frames: Frames, low: ArrayLike, high: ArrayLike | None = None
) -> Pins:
    """Constrain a joint to a position, or to a box, in some frames.

    Parameters
    ----------
    motion : F frames.
    joint : its name or its index.
    frames : a slice, the frames' numbers, or marks (F,).
    low : shape (3,), or one row for each of the frames, metres.
    high : the box's other corner. Without it the joint is held at `low`. An axis from -∞ to ∞ is free.

    Returns
    -------
    The constraints of this joint; `join_pins` joins several.

    Raises
    ------
    MocapError : for a joint or a frame that is not there, a low above its high, a position that is no number.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:60]
    >>> bar = pin(walk, "head", slice(20, 40), [-np.inf] * 3, [np.inf, 1.3, np.inf])
    >>> int(bar.constrained.sum())
    20
    >>> pin(walk, 0, [40], [0, 1, 0]).low[40].tolist()  # the root, at one position
    [[0.0, 1.0, 0.0]]

    Notebook: 14-levels
    """
    require_motion(motion)
    number = motion.skeleton.index(joint) if isinstance(joint, str) else int(joint)
    if isinstance(frames, int | float):
        raise MocapError(f"A pin takes a list of frames, got {frames}: write [{frames:.0f}].")
    try:
        rows = np.arange(len(motion))[frames if isinstance(frames, slice) else list(frames)]
    except IndexError:
        counted = f"'{motion.name}' has {len(motion)} frames, counted from 0"
        takes = f"frames are their numbers, a slice, or {len(motion)} marks"
        raise MocapError(f"{counted}; {takes}.") from None
    shape = (len(motion), 1, 3)
    pins_low = np.full(shape, -np.inf)
    pins_high = np.full(shape, np.inf)
    for box, corner in ((pins_low, low), (pins_high, low if high is None else high)):
        got = np.shape(corner)
        if got not in ((3,), (len(rows), 3)):
            raise MocapError(f"'{joint}': a place is (3,) or ({len(rows)}, 3) metres, got {got}.")
        box[rows, 0] = corner
    pins = Pins((number,), pins_low, pins_high)
    require_pins_of(motion, pins)
    return pins


def join_pins(*parts: Pins) -> Pins:
    """Join constraints, so that all of them apply.

    If two hold the same axis of a joint, the later one applies. A held axis takes precedence over a box. Of
    two boxes the common part is taken, and the later one if they have none.

    Parameters
    ----------
    parts : at least one, all of F frames.

    Raises
    ------
    MocapError : for no constraints, and for different numbers of frames.

    Examples
    --------
    >>> floor = Pins((4,), [[[-np.inf, 0, -np.inf]]], [[[np.inf] * 3]])
    >>> bar = Pins((4,), [[[-np.inf] * 3]], [[[np.inf, 1.3, np.inf]]])
    >>> both = join_pins(floor, bar)
    >>> float(both.low[0, 0, 1]), float(both.high[0, 0, 1])
    (0.0, 1.3)

    Notebook: 14-levels
    """
    if not parts or len({len(part) for part in parts}) > 1:
        counts = ", ".join(str(len(part)) for part in parts) or "none"
        raise MocapError(f"Pins that are joined need the same number of frames, got {counts}.")
    joints = tuple(dict.fromkeys(joint for part in parts for joint in part.joints))
    shape = (len(parts[0]), len(joints), 3)
    low = np.full(shape, -np.inf)
    high = np.full(shape, np.inf)
    for part in parts:
        columns = [joints.index(joint) for joint in part.joints]
        merged = merged_ends(low[:, columns], high[:, columns], part.positions)
        low[:, columns], high[:, columns] = merged
    relative = tuple(rotation for part in parts for rotation in part.rotations.rotations)
    rotations_low = np.hstack([part.rotations.low for part in parts])
    rotations_high = np.hstack([part.rotations.high for part in parts])
    return Pins(joints, low, high, RotationBoxes(relative, rotations_low, rotations_high))


def merged_ends(low: Array, high: Array, later: PositionBoxes) -> tuple[Array, Array]:
    """Merge the ends of boxes (F, P, 3) with those of later boxes for the same joints.

    Of two boxes that hold an axis the later one applies. A held axis takes precedence over a box. Of two
    boxes the common part is taken, and the later one if they have none.

    Examples
    --------
    >>> low = np.array([[[0.0, 0.0, 0.0]]])
    >>> later = PositionBoxes((4,), low + 0.5, low + 2)
    >>> [ends.tolist() for ends in merged_ends(low, low + 1, later)]
    [[[[0.5, 0.5, 0.5]]], [[[1.0, 1.0, 1.0]]]]
    """
    common_low = np.maximum(low, later.low)
    common_high = np.minimum(high, later.high)
    is_disjoint = common_low > common_high
    is_held = low == high
    is_later = later.held | (is_disjoint & ~is_held)
    choices = [is_later, is_disjoint]  # the first that is true counts
    merged_low = np.select(choices, [later.low, low], common_low)
    merged_high = np.select(choices, [later.high, high], common_high)
    return merged_low, merged_high


def plant_pins(
    motion: MotionOrPoses, legs: Sequence[Leg] | None = None, heights: ArrayLike | None = None
) -> Pins:
    """Hold each planted ankle and ball at its mean position as long as it stands.

    In the paper: [Gle98, constraints].

    [Gle98] and [LS99] also let the position of a plant be unknown. In our trials that saved 0.4 % of the
    cost.

    Parameters
    ----------
    motion : its `contacts` say when ankles and balls stand.
    legs : by default those of `body.find_legs`.
    heights : shape (legs, 2), metres: the heights at which ankle and ball stand, if these change. An ankle
        and a ball that stand together are then as far apart as the flat foot is long.

    Raises
    ------
    MocapError : for legs that cannot be found, and marks that are missing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> pins = plant_pins(sample("walk_straight"))
    >>> pins.joints, bool(pins.held.any(axis=(0, 2)).all())
    ((4, 5, 10, 11), True)

    Notebook: 12-path-editing
    """
    poses = poses_of(motion)
    legs = find_legs(poses.motion.skeleton) if legs is None else legs
    feet = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    return pins_of_plants(poses.motion, legs, poses.positions[:, feet], heights)


def pins_of_plants(
    motion: Motion, legs: Sequence[Leg], positions: Array, heights: ArrayLike | None = None
) -> Pins:
    """Hold planted ankles and balls as `plant_pins` does.

    Parameters
    ----------
    motion, legs, heights : as for `plant_pins`.
    positions : of the ankle and the ball of each leg in turn, (F, 2 legs, 3), metres.
    """
    marks = settled_marks(motion, legs)
    tracks = np.swapaxes(positions, 0, 1).reshape(len(legs), 2, len(motion), 3)
    parts = []
    for number, leg in enumerate(legs):
        joints = (tracks[number, 0], tracks[number, 1])
        stands = (marks[number, 0], marks[number, 1])
        length = float(leg.lengths(motion.skeleton)[2])
        if heights is None:
            places = place_plants(joints, stands, length)
        else:
            places = places_at_heights(joints, stands, length, np.asarray(heights, float)[number])
        planted = marks[number][..., None]
        low = np.where(planted, places, -np.inf)
        high = np.where(planted, places, np.inf)
        held = leg[2:] if leg.has_ball else leg[2:3]
        boxes = slice(len(held))
        parts.append(Pins(held, np.swapaxes(low[boxes], 0, 1), np.swapaxes(high[boxes], 0, 1)))
    return join_pins(*parts)


def limit_turns(motion: MotionOrPoses, joints: Sequence[str], *, margin: float = 10.0) -> Pins:
    """Limit the rotations of joints to their range in a clip, with a margin.

    In the paper: [Gle98, joint limits], [LS99, joint limits].

    The paper's limits are angles from a table. Here the clip gives them [ours]: the range of each joint's
    rotation vectors about their mean.

    Parameters
    ----------
    motion : F frames.
    joints : their names.
    margin : degrees beyond the clip's range, about each axis, 0 or more.

    Raises
    ------
    MocapError : for a joint that is not there, and degrees below 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> neck = limit_turns(sample("walk_straight")[:60], ["lowerneck", "upperneck"]).rotations
    >>> (neck.high[0] / TUNED.arm).round(2).tolist()  # radians
    [[0.18, 0.19, 0.18], [0.18, 0.19, 0.18]]
    >>> (neck.low[0] / TUNED.arm).round(2).tolist()
    [[-0.18, -0.19, -0.19], [-0.18, -0.19, -0.19]]

    Notebook: 14-levels
    """
    if not 0 <= margin < np.inf:
        raise MocapError(f"Limits lie 0 degrees or more beyond what a clip does, got {margin}.")
    poses = poses_of(motion)
    relative = []
    for name in joints:
        joint = poses.motion.skeleton.index(name)
        mean = rotations.mean(poses.motion.rotations[:, joint])
        relative.append(RelativeRotation(joint, np.tile(mean, (len(poses), 1)), is_global=False))
    zero = np.zeros((len(poses), len(relative), 3))
    values = RotationBoxes(tuple(relative), zero, zero).values(poses)
    reach = TUNED.arm * np.radians(margin)
    low = zero + values.min(axis=0) - reach
    high = zero + values.max(axis=0) + reach
    return _rotation_pins(RotationBoxes(tuple(relative), low, high))


def keep_turned(motion: MotionOrPoses, joint: str, frames: Frames) -> Pins:
    """Keep the rotation of a joint in the world in some frames.

    In the paper: [Gle98, orientations], [LS99, orientations].

    Parameters
    ----------
    motion : F frames.
    joint : its name.
    frames : a slice, the frames' numbers, or marks (F,).

    Raises
    ------
    MocapError : for a joint or a frame that is not there.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> upright = keep_turned(sample("walk_straight")[:60], "thorax", slice(20, 40))
    >>> int(upright.constrained.sum())
    20

    Notebook: 14-levels
    """
    poses = poses_of(motion)
    number = poses.motion.skeleton.index(joint)
    reference = rotations.from_matrix(poses.matrices[:, number])
    kept = RelativeRotation(number, reference, is_global=True)
    zero = np.zeros((len(poses), 1, 3))
    return _rotation_pins(RotationBoxes((kept,), zero, zero).limited_to(frames))


def _rotation_pins(boxes: RotationBoxes) -> Pins:
    """Return constraints on rotations alone."""
    no_positions = np.zeros((len(boxes), 0, 3))
    return Pins((), no_positions, no_positions, boxes)


def with_plants(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Mark when ankles and balls stand, unless the motion says it of all of them."""
    require_motion(motion)
    if legs is None:
        motion = with_roles(motion)
        legs = find_legs(motion.skeleton)
    names = {motion.skeleton.names[joint] for leg in legs for joint in (leg.ankle, leg.ball)}
    return motion if names <= set(motion.contacts) else mark_plants(motion, legs)
