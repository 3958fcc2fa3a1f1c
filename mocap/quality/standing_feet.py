"""Feet that slide, or sink below the height at which they stand.

A foot that slides does not stand still in the world, so it cannot be found by its speed there. It is found by
its height: it is low, and neither rises nor falls. While it stands, it moves backwards as seen from the body,
however the body's path was changed afterwards. A foot that is far above the lowest one of the clip does not
slide: its body may hang, climb or lie.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import minimum_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.body.legs import Leg
from mocap.feet.footplants import mark_plants
from mocap.quality.limits import LIMITS
from mocap.quality.measures import Measure, Seen
from mocap.quality.seam_measures import FootSliding, feet_of, foot_sliding

STANDING_PERCENTILE = 15  # of a ball's heights: where it stands, even if it is lower for a moment
HIGHEST = 0.035  # of the leg's length: a standing ball is no higher above that percentile
GROUND_PERCENTILE = 5  # of the heights of the lower ball: the ground, even if the body hangs in most frames
GROUND_REACH = 0.12  # of the leg's length, above the ground: a foot that is higher does not stand on it
LEVEL = 0.2  # m/s: a standing ball rises or falls no faster
WALKING = 0.25  # m/s: a slower body does not walk
EVIDENCE = 0.5  # metres of the body's path over standing feet, to measure its slip
SLIDING_PERCENTILE = 25  # of the frames, by the speed of the slowest joint of the feet
SLOW = 0.5  # m/s: the foot sliding of a slower body is divided by this speed
FLOOR_PERCENTILE = 10  # of the heights of standing feet: the floor, whatever the shoes
BRIEF = 0.1  # seconds: a joint that is deeper for less is not noticed


def measure_feet(seen: Seen) -> Iterator[Measure]:
    """Measure the feet of a body whose legs are known."""
    standing = np.stack([is_standing(seen, leg) for leg in seen.legs], axis=-1)
    grounded = is_near_ground(seen)
    yield slip(seen, standing & grounded)
    yield _foot_sliding(seen, grounded)
    yield _sliding_speed(seen, grounded)
    yield toes(seen, standing)


def is_standing(seen: Seen, leg: Leg) -> Mask:
    """Mark frames (F,) in which the ball of a foot is low, and neither rises nor falls."""
    heights = seen.positions[:, leg.ball, 1]
    length = leg.lengths(seen.motion.skeleton)[:2].sum()
    low = heights < np.percentile(heights, STANDING_PERCENTILE) + HIGHEST * length
    return np.asarray(low & (np.abs(_central_velocities(heights, seen)) < LEVEL))


def is_near_ground(seen: Seen) -> Mask:
    """Mark frames in which the ball of each foot, (F, legs), is near the lowest ones of the clip."""
    heights = seen.positions[:, [leg.ball for leg in seen.legs], 1]
    length = seen.legs[0].lengths(seen.motion.skeleton)[:2].sum()
    ground = np.percentile(heights.min(axis=1), GROUND_PERCENTILE)
    return np.asarray(heights < ground + GROUND_REACH * length)


def _central_velocities(values: Array, seen: Seen) -> Array:
    """Return velocities (F, ...) over a step before and a step after each frame, or fewer near the ends."""
    frames = np.arange(len(values))
    later = np.minimum(frames + seen.step, len(values) - 1)
    earlier = np.maximum(frames - seen.step, 0)
    seconds = (later - earlier) / seen.motion.fps
    changes = values[later] - values[earlier]
    return np.asarray((changes.T / seconds).T)


def slip(seen: Seen, standing: Mask) -> Measure:
    """Measure the slip ratio: the speed of standing feet along the body's path, in percent of its speed.

    It is the median over the path of the body. A path k times as long as that of the steps has a slip ratio
    of (k - 1) / k. A foot that moves faster than the body swings; it does not stand.

    Parameters
    ----------
    seen : the motion.
    standing : the frames in which the ball of each foot is low, (F, legs), as marked by `is_standing`.
    """
    velocity = _central_velocities(seen.motion.root_positions[:, [0, 2]], seen)
    speed = np.linalg.norm(velocity, axis=-1)
    direction = velocity / np.maximum(speed, 1e-9)[:, None]
    balls = [leg.ball for leg in seen.legs]
    of_balls = _central_velocities(seen.positions[:, balls][..., [0, 2]], seen)
    along = (of_balls * direction[:, None]).sum(axis=-1)
    walks = standing & (speed > WALKING)[:, None] & (along < speed[:, None])
    frames, feet = np.nonzero(walks)
    distances = speed[frames] / seen.motion.fps
    if distances.sum() < EVIDENCE:
        return Measure("slip", 0.0, LIMITS.slip, "% of speed", "too short a walk to tell")
    ratio = weighted_median(along[frames, feet] / speed[frames], distances)
    detail = "feet slide forwards" if ratio > 0 else "feet slide backwards"
    return Measure("slip", 100 * abs(ratio), LIMITS.slip, "% of speed", detail)


def weighted_median(values: Array, weights: Array) -> float:
    """Return the value at which the cumulative weight of the sorted values (N,) reaches one half.

    Examples
    --------
    >>> weighted_median(np.array([3.0, 1.0, 2.0]), np.array([5.0, 1.0, 1.0]))
    3.0
    """
    order = values.argsort()
    cumulative = weights[order].cumsum()
    half = np.searchsorted(cumulative, cumulative[-1] / 2)
    return float(values[order][half])


def _foot_sliding(seen: Seen, grounded: Mask) -> Measure:
    """Measure the foot sliding distance within the whole duration of a footplant, the mean over them.

    Footplants that are mostly not `grounded` (F, legs) do not count.
    """
    marked = mark_plants(seen.motion, seen.legs)
    footplants = []
    for leg, is_near in zip(seen.legs, grounded.T, strict=True):
        plants = foot_sliding(marked, feet_of([leg]), positions=seen.positions)
        footplants += [plant for plant in plants if 2 * is_near[plant.start : plant.stop].mean() > 1]
    if not footplants:
        return Measure("foot_sliding", 0.0, LIMITS.foot_sliding, "cm", "no foot contact")
    distances = [distance_per_stance(footplant) for footplant in footplants]
    worst = footplants[int(np.argmax(distances))]
    detail = f"'{worst.joint}', frames {worst.start} to {worst.stop - 1}"
    return Measure("foot_sliding", float(np.mean(distances)), LIMITS.foot_sliding, "cm", detail)


def distance_per_stance(footplant: FootSliding) -> float:
    """Extend the foot sliding distance to the whole duration of a footplant, cm.

    Its n frames last n / fps, but the first and the last are only (n - 1) / fps apart. At a low frame rate,
    and in a short stance, a foot that slides at constant speed would seem to slide less.

    Examples
    --------
    >>> at_30_hz = FootSliding("lfoot", 0, 6, 1.5)
    >>> at_60_hz = FootSliding("lfoot", 0, 12, 1.65)
    >>> [round(distance_per_stance(footplant), 3) for footplant in (at_30_hz, at_60_hz)]
    [1.8, 1.8]
    """
    frames = footplant.stop - footplant.start
    return footplant.distance * frames / max(frames - 1, 1)


def _sliding_speed(seen: Seen, grounded: Mask) -> Measure:
    """Measure the foot sliding speed, in percent of the body's speed, if a foot is `grounded` (F, legs)."""
    feet = seen.positions[:, feet_of(seen.legs)][..., [0, 2]]
    steps = np.linalg.norm(feet[seen.step :] - feet[: -seen.step], axis=-1)
    slowest = steps.min(axis=1)[grounded[: len(steps)].any(axis=1)] / seen.seconds
    if not len(slowest):
        return Measure("sliding_speed", 0.0, LIMITS.sliding_speed, "% of speed", "no foot near the ground")
    path = np.diff(seen.motion.root_positions[:, [0, 2]], axis=0)
    body_speed = float(np.linalg.norm(path, axis=-1).mean()) * seen.motion.fps
    percent = 100 * float(np.percentile(slowest, SLIDING_PERCENTILE)) / max(SLOW, body_speed)
    return Measure("sliding_speed", percent, LIMITS.sliding_speed, "% of speed")


def joints_of_foot(seen: Seen, leg: Leg) -> list[int]:
    """List the ankle and all joints below it."""
    skeleton = seen.motion.skeleton
    return [joint for joint in range(len(skeleton)) if leg.ankle in skeleton.path_to_root(joint)]


def toes(seen: Seen, standing: Mask) -> Measure:
    """Measure the depth of a foot's lowest joint below the height at which the feet stand.

    That height is the 10th percentile of the lowest joints of standing feet. So it does not matter at which
    height the floor of a clip is, and how thick its shoes are.
    """
    feet = [joints_of_foot(seen, leg) for leg in seen.legs]
    lowest = np.stack([seen.positions[:, joints, 1].min(axis=1) for joints in feet], axis=-1)
    if not standing.any():
        return Measure("toes", 0.0, LIMITS.toes, "cm", "no standing foot")
    depths = np.percentile(lowest[standing], FLOOR_PERCENTILE) - lowest
    lasting = lasting_values(depths, seen.frames(BRIEF))
    frame, foot = np.unravel_index(int(lasting.argmax()), lasting.shape)
    name = seen.motion.skeleton.names[seen.legs[int(foot)].ankle]
    depth = 100 * max(0.0, float(lasting.max()))
    return Measure("toes", depth, LIMITS.toes, "cm", f"below '{name}', frame {frame}")


def lasting_values(values: Array, frames: int) -> Array:
    """Return the smallest of values (F, ...) in a window of frames around each frame.

    A value that is exceeded throughout a window lasts. The windows at the ends are shorter.

    Examples
    --------
    >>> lasting_values(np.array([0.0, 9.0, 0.0, 4.0, 5.0, 4.0, 0.0]), 3)
    array([0., 0., 0., 0., 4., 0., 0.])
    """
    return np.asarray(minimum_filter1d(values, min(frames, len(values)), axis=0, mode="nearest"))
