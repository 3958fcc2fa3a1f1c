"""When and where does a foot stand? Plants are found from how slowly and how low its joints move.

A foot has two joints that can stand: the ankle stands while the sole lies flat, the ball until the toes
leave. All thresholds come from the clip: how still a foot stands differs a thousandfold between a
generated clip and a captured one.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import binary_propagation

from mocap._shared.arrays import Array, Mask
from mocap._shared.arrays import runs as runs  # which the room exports
from mocap._shared.records import NamedTuple
from mocap.body.body_sides import sides
from mocap.body.kinematics import joint_positions
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs, with_roles
from mocap.body.motion import Motion, require_motion
from mocap.errors import MocapError

# Seconds. No foot comes to stand, nor takes a step, in less. With 0.1 the worst F1 falls to 0.945; with
# 0.025 a captured run breaks into more plants, 3.12 per second instead of 3.05.
SPAN = 0.05

GRAVITY = 9.81  # metres per second squared

# Where a plant starts, and how far it lasts: shares of the way from standing to swinging speed, on a
# logarithmic scale. The ankle's are smaller: while the foot rolls over heel and ball, the ankle moves
# slowly but does not stand. With the ball's shares for the ankle, the mean F1 under noise of half a
# millimetre falls from 0.91 to 0.82. With the ankle's shares for the ball, a foot stands for only 38 % of a
# walk.
ANKLE = (0.2, 0.3)
BALL = (0.45, 0.55)

# Percent of the frames. Even a runner's feet stand for longer. With 5 or 20, feet stand for 1 % less or
# more of a walk.
SLOWEST = 10

# Of the swinging speed. Where even the slowest tenth is faster, nothing stands: a jog on a cart at 3 m/s
# has no plants with 0.2, and some with 0.3.
STANDING_AT_MOST = 0.2
STILL = 1e-7  # m/s: rounding of numbers in files

# Of the foot's length. With 0.5, plants of runs slide by up to 4.4 cm before the clean-up instead of 3.1
# (95 % of them). With 0.125 a foot stands for only 45 % of a walk.
FROM_PLACE = 0.25

# Of the way up from where a joint stands to the top of its swing. With 0.5, feet more than 15 cm above the
# floor are marked in 13 % more frames, in jumps and acrobatics of subjects 02, 16 and 49; without a bound
# in twice as many. With 0.125 a foot stands for only 45 % of a walk.
LOW = 0.25

# Percent of a joint's heights: the top of its swing, without the few frames in which a marker may leap.
# With 98 or 100, feet stand for 0.1 % less or more of a walk.
TOP = 99

# Of the leg's length: a step lifts the ball at least so far. Without it noise would count as a swing: one
# who stands still with noise of 5 mm loses 5 % of the marks. With 0.05 or 0.2 a foot stands for up to 1 %
# less or more of a walk.
LEAST_LIFT = 0.1

# Of the leg's length: a foot counts as no shorter, as one without toes has no joint at its ball. The bundled
# body's foot is 0.16 legs long from ankle to ball.
FOOT_PER_LEG = 0.1


def mark_plants(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Mark as contacts when each ankle and each ball stands on the ground.

    A joint's speed is its mean over the `SPAN` that ends, or the one that starts, with a frame, whichever is
    slower: so the first and the last frame of a plant belong to it. The clip's standing speed is the one that
    the balls stay below in a tenth of the frames. Its swinging speed is √(g · leg), at which legs swing as
    pendulums do. Between these two, on a logarithmic scale, lie two thresholds. A plant starts below the
    lower one, and lasts as long as the joint stays below the upper one (hysteresis: noise does not cut a
    plant), is low, and is within a quarter of the foot's length of its place, which is its median while it is
    slow. A foot that lands running, or rolls off, is slow before it stands and after, but not at its place.

    Parameters
    ----------
    motion : F frames, more than 0.1 s.
    legs : by default those of `body.find_legs`; if their names are unknown, found by the motion.

    Returns
    -------
    The motion with new `contacts` for the legs' joints; those of other joints stay.

    Raises
    ------
    MocapError : for what is no motion, legs that cannot be found, and for a clip that is too short.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> clip = sample("walk_straight")
    >>> marked = mark_plants(replace(clip, contacts={}))
    >>> round(float((marked.contacts["lfoot"] == clip.contacts["lfoot"]).mean()), 2)
    1.0

    Notebook: 04b-feet
    """
    require_motion(motion)
    if legs is None:
        motion = with_roles(motion)
        legs = find_legs(motion.skeleton)
    span = max(1, int(SPAN * motion.fps))
    if len(motion) <= 2 * span:
        needs = f"To tell standing from swinging takes more than {2 * span} frames"
        raise MocapError(f"{needs}; '{motion.name}' has {len(motion)}.")
    joints = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    positions = joint_positions(motion)[:, joints]  # (F, 2 · legs, 3)
    lengths = np.max([leg.lengths(motion.skeleton) for leg in legs], axis=0)
    length = lengths[:2].sum()
    from_place = FROM_PLACE * max(lengths[2], FOOT_PER_LEG * length)
    speeds = _slower_speeds(positions, span, motion.fps)
    heights = positions[..., 1]
    swinging = np.sqrt(GRAVITY * length)
    # A clip made by arithmetic stands still to the last digit, and a logarithm needs a number above 0.
    ratio = np.percentile(speeds[:, 1::2], SLOWEST) / swinging
    standing = swinging * np.clip(ratio, np.finfo(float).eps, STANDING_AT_MOST)
    low = heights < _low_enough(heights, speeds, length)
    marks: dict[str, Mask] = {}
    for column, joint in enumerate(joints):
        shares = (ANKLE, BALL)[column % 2]
        enter, leave = (standing ** (1 - share) * swinging**share for share in shares)
        slow = hysteresis(speeds[:, column], low[:, column], enter, leave)
        slow &= _near_place(positions[:, column], slow, from_place)
        marks.setdefault(motion.skeleton.names[joint], settle(slow, least_frames(motion.fps)))
    return replace(motion, contacts={**motion.contacts, **marks})


def _slower_speeds(positions: Array, span: int, fps: float) -> Array:
    """Measure the slower of the mean speeds over the span before and the span after each frame, (F, N)."""
    speed = np.linalg.norm(positions[span:] - positions[:-span], axis=-1) * fps / span
    past_the_ends = np.full((span, positions.shape[1]), np.inf)
    slower = np.minimum(np.concatenate([speed, past_the_ends]), np.concatenate([past_the_ends, speed]))
    return np.where(slower < STILL, 0.0, slower)


def _low_enough(heights: Array, speeds: Array, length: float) -> Array:
    """Return the height up to which each joint may be standing, shape (N,), metres."""
    slow = speeds <= np.percentile(speeds, SLOWEST, axis=0)
    standing = np.nanmedian(np.where(slow, heights, np.nan), axis=0)
    swing = np.maximum(np.percentile(heights, TOP, axis=0) - standing, LEAST_LIFT * length)
    return np.asarray(standing + swing * LOW)


def _near_place(path: Array, slow: Mask, distance: float) -> Mask:
    """Mark where a joint's path (F, 3) is within `distance` of its median in each run of `slow`."""
    marks = np.zeros(len(slow), bool)
    for start, stop in runs(slow):
        positions = path[start:stop]
        marks[start:stop] = np.linalg.norm(positions - np.median(positions, axis=0), axis=1) < distance
    return marks


def hysteresis(values: Array, allowed: Mask, enter: float, leave: float) -> Mask:
    """Mark the runs in which `values` stay below `leave` and, at least once, fall below `enter`.

    Parameters
    ----------
    values : shape (F,).
    allowed : shape (F,); False ends a run, whatever the value.
    enter, leave : thresholds, `enter` the lower.

    Examples
    --------
    >>> hysteresis(np.array([3, 1, 0, 1, 3, 1, 3]), np.ones(7, bool), 0.5, 2.0).astype(int)
    array([0, 1, 1, 1, 0, 0, 0])
    """
    low = allowed & (values < leave)
    return np.asarray(binary_propagation(low & (values < enter), mask=low))


def least_frames(fps: float) -> int:
    """Return the least number of frames of a plant, or of a gap between two: those of `SPAN`."""
    return max(1, round(SPAN * fps))


def settle(marks: Mask, span: int) -> Mask:
    """Close the gaps between plants that are shorter than `span` frames, then drop plants that are as short.

    Examples
    --------
    >>> settle(np.array([1, 1, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0], bool), 2).astype(int)
    array([1, 1, 1, 1, 0, 0, 0, 0, 0, 1, 1, 0])
    """
    settled = np.array(marks, bool)
    for start, stop in runs(~settled):
        settled[start:stop] = start > 0 and stop < len(settled) and stop - start < span
    for start, stop in runs(settled):
        # A plant at an end of the clip may last longer than the clip shows.
        settled[start:stop] = stop - start >= span or start == 0 or stop == len(settled)
    return settled


class Footprint(NamedTuple):
    """A `joint` on a body's `side` stood in frames [start, end), on average at (x, z), metres.

    Examples
    --------
    >>> step = Footprint("lfoot", "left", start=10, end=40, x=0.1, z=1.5)
    >>> step.end - step.start
    30
    """

    joint: str
    side: str
    start: int
    end: int
    x: float
    z: float


def find_footprints(motion: Motion) -> list[Footprint]:
    """List where joints stood: one print for each run of frames in which a joint of `motion.contacts` stands.

    Parameters
    ----------
    motion : the motion; one without contacts leaves no prints.

    Returns
    -------
    The prints, joint by joint, and in time order for each joint.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> foot = Skeleton(["lfoot"], [-1], [[0, 0, 0]])
    >>> import numpy as np
    >>> still = np.tile([1.0, 0, 0, 0], (4, 1, 1))
    >>> find_footprints(Motion(foot, np.ones((4, 3)), still, 30.0, contacts={"lfoot": [1, 1, 0, 1]}))
    [Footprint(joint='lfoot', side='middle', start=0, end=2, x=1.0, z=1.0), ...start=3, end=4, x=1.0, z=1.0)]

    Notebook: 12-path-editing
    """
    points = joint_positions(motion)[..., [0, 2]]
    side_of = sides(motion.skeleton)
    prints = []
    for name, down in motion.contacts.items():
        joint = motion.skeleton.index(name)
        for start, end in runs(down).tolist():
            place = points[start:end, joint].mean(axis=0).tolist()
            prints.append(Footprint(name, side_of[joint], start, end, *place))
    return prints


def standing_tracks(motion: Motion) -> Array:
    """Return the positions of joints over the ground while they stand: a slide is a smear.

    Parameters
    ----------
    motion : the motion, with contacts.

    Returns
    -------
    Points (x, z), metres, shape (N, 2), joint by joint; nan where a joint does not stand, and between joints.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> tracks = standing_tracks(walk)
    >>> tracks.shape, bool(np.isnan(tracks).any())
    ((484, 2), True)

    Notebook: 12-path-editing
    """
    points = joint_positions(motion)[..., [0, 2]]
    gap = np.full((1, 2), np.nan)
    lines = [np.zeros((0, 2))]
    for name, down in motion.contacts.items():
        track = points[:, motion.skeleton.index(name)]
        lines += [np.where(down[:, None], track, np.nan), gap]
    return np.concatenate(lines)
