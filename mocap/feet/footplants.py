"""When does a foot stand? Plants found from how slowly and how low its joints move.

A foot has two joints that can stand: the ankle stands while the sole lies flat, the ball until the toes
leave. All thresholds come from the clip: how still a foot stands differs a thousandfold between a
generated clip and a captured one.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion
from mocap.errors import MocapError

SPAN = 0.05  # seconds: no foot comes to stand, nor takes a step, in less
GRAVITY = 9.81
# How far from standing to swinging speed, on a logarithmic scale, a plant may start, and how far it lasts.
# The ankle's shares are the smaller: where the foot rolls over heel and ball it creeps away without a jolt.
ANKLE, BALL = (0.2, 0.3), (0.45, 0.55)
STRAY = 0.25  # how far from its place a joint may be while it stands, as a share of the foot's length
LOW = 0.25  # how far up from where it stands to the top of its swing a joint may be while it stands


def mark_plants(motion: Motion, legs: Sequence[Leg] | None = None) -> Motion:
    """Mark as contacts when each ankle and each ball stands on the ground.

    A joint's creep is its mean speed over the `SPAN` that ends, or the one that starts, with a frame,
    whichever is slower: so the first and the last frame of a plant belong to it. The clip's standing speed is
    what a tenth of the balls' creeps stay below; its swinging speed is √(g · leg), at which legs swing as
    pendulums do. Between these two, on a logarithmic scale, lie the thresholds: below the first a plant
    starts, and it lasts as long as the creep stays below the second (hysteresis, so that noise does not
    cut it), the joint is low, and no further than a quarter of the foot from its place, its median while it
    stands: a foot that lands running, or rolls off, is slow before it stands and after.

    Parameters
    ----------
    motion : F frames, at least 0.1 s.
    legs : found by name by default.

    Returns
    -------
    The motion with `contacts` for the legs' joints anew; those of other joints stay.

    Raises
    ------
    MocapError : for legs that cannot be found, and for a clip that is too short.

    Examples
    --------
    >>> from mocap.datasets.generated import generate
    >>> clip = generate("walk_straight")
    >>> marked = mark_plants(replace(clip, contacts={}))
    >>> round(float((marked.contacts["lfoot"] == clip.contacts["lfoot"]).mean()), 2)
    1.0

    Notebook: 04-blending
    """
    legs = legs_of(motion.skeleton, legs)
    span = max(1, int(SPAN * motion.fps))
    if len(motion) <= 2 * span:
        raise MocapError(
            f"To tell standing from swinging takes more than {2 * span} frames; "
            f"'{motion.name}' has {len(motion)}."
        )
    joints = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    positions = joint_positions(motion)[:, joints]  # (F, 2 · legs, 3)
    lengths = np.max([leg.lengths(motion.skeleton) for leg in legs], axis=0)
    length, stray = lengths[:2].sum(), STRAY * lengths[2]
    creep, heights = _creep(positions, span, motion.fps), positions[..., 1]
    swinging = np.sqrt(GRAVITY * length)
    # A clip made by arithmetic stands still to the last digit, and a logarithm wants a number above 0; where
    # the slowest tenth goes at a fifth of a swing, nothing stands.
    standing = swinging * np.clip(np.percentile(creep[:, 1::2], 10) / swinging, np.finfo(float).eps, 0.2)
    low = heights < _low_enough(heights, creep, length)
    marks = {}
    for column, joint in enumerate(joints):
        enter, leave = (standing ** (1 - share) * swinging**share for share in (ANKLE, BALL)[column % 2])
        still = hysteresis(creep[:, column], low[:, column], enter, leave)
        still &= _near_place(positions[:, column], still, stray)
        marks[motion.skeleton.names[joint]] = settle(still, least_frames(motion.fps))
    return replace(motion, contacts={**motion.contacts, **marks})


def _creep(positions: Array, span: int, fps: float) -> Array:
    """Measure the slower of the mean speeds over the span before and the span after each frame, (F, N)."""
    speed = np.linalg.norm(positions[span:] - positions[:-span], axis=-1) * fps / span
    beyond = np.full((span, positions.shape[1]), np.inf)
    return np.asarray(np.minimum(np.concatenate([speed, beyond]), np.concatenate([beyond, speed])))


def _low_enough(heights: Array, creep: Array, length: float) -> Array:
    """Give the height up to which each joint may be standing, shape (N,), metres."""
    slow = creep <= np.percentile(creep, 10, axis=0)
    standing = np.nanmedian(np.where(slow, heights, np.nan), axis=0)
    # Where nothing swings, noise is no swing: a step lifts the ball by a tenth of the leg, or so.
    swing = np.maximum(np.percentile(heights, 99, axis=0) - standing, length / 10)
    return np.asarray(standing + swing * LOW)


def _near_place(path: Array, still: Mask, stray: float) -> Mask:
    """Mark where a joint's path (F, 3) is nearer than `stray` to its median within each run of `still`."""
    near = np.zeros(len(still), bool)
    for start, stop in runs(still):
        places = path[start:stop]
        near[start:stop] = np.linalg.norm(places - np.median(places, axis=0), axis=-1) < stray
    return near


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
    marks = np.zeros(len(values), bool)
    for start, stop in runs(allowed & (values < leave)):
        marks[start:stop] = (values[start:stop] < enter).any()
    return marks


def least_frames(fps: float) -> int:
    """Give the frames that a plant, or a gap between two, lasts at least: those of `SPAN`."""
    return max(1, round(SPAN * fps))


def settle(marks: Mask, span: int) -> Mask:
    """Close the gaps between plants that are shorter than `span` frames, then drop plants as short.

    Examples
    --------
    >>> settle(np.array([1, 1, 0, 1, 0, 0, 0, 1, 0, 0], bool), 2).astype(int)
    array([1, 1, 1, 1, 0, 0, 0, 0, 0, 0])
    """
    settled = np.array(marks, bool)
    for start, stop in runs(~settled):
        settled[start:stop] = start > 0 and stop < len(settled) and stop - start < span
    for start, stop in runs(settled):
        # What runs off the clip may have lasted longer.
        settled[start:stop] = stop - start >= span or start == 0 or stop == len(settled)
    return settled
