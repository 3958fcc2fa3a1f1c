"""How a walk turns: more slowly than straight on, and leaning to the inside of the turn.

On a path of curvature k (radians per metre) at speed v, a body leans inwards by atan(v² k / g), measured from
the feet to the centre of mass, or would fall outwards. People lean little, and therefore slow down:

    v / v₀ = q(k) = (1 + (R k)²)^(-1/4),   R = 1.2 m,   v₀ the speed straight on

In tight bends v² k then stays at v₀² / R, about a tenth of g for a walk. Half of it is shorter steps, half a
slower clock: steps are √q times as long, and last 1/√q as long. The law and R are ours, from captured turns.
At a corner, where v k is still more than a walk may turn, the walk slows down further, from a little before.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.path_editing import Ride, moving_frames
from mocap.editing.pins import plant_pins
from mocap.editing.retiming import at_frames
from mocap.editing.tuned import TUNED

GRAVITY = 9.81  # metres per second squared
CELL = 0.02  # metres between the points at which the curvature of a line is computed
TOLERANCE = 1e-6  # frames, for times that were rounded


class Bends(NamedTuple):
    """The bends of a line, at points 2 cm apart: arrays (n,).

    Parameters
    ----------
    along : metres along the line.
    curvature : k, radians per metre, positive to the left.
    pace : q(k), the speed there over the speed straight on.
    sharpest : the largest absolute curvature nearby, before smoothing, radians per metre.
    """

    along: Array
    curvature: Array
    pace: Array
    sharpest: Array


class SlowedWalk(NamedTuple):
    """A walk, slowed down for the bends of a line.

    Parameters
    ----------
    motion : F frames at the new times.
    source_along : shape (F,), metres along the path of the walk itself.
    along : shape (F,), metres along the line.
    lean : shape (F,), the additional lean to the left, radians.
    """

    motion: Motion
    source_along: Array
    along: Array
    lean: Array


def bends_of(path: GroundPath) -> Bends:
    """Compute the curvature of a line, and the pace of people who walk on it.

    Examples
    --------
    >>> from mocap.body import circle
    >>> [round(float(values[100]), 2) for values in bends_of(circle(1.0))]  # 2 m along it
    [2.0, 1.0, 0.8, 1.0]
    >>> corner = bends_of(GroundPath([[0, 0], [0, 2], [1, 2]]))
    >>> [values[[80, 90, 100]].round(2).tolist() for values in corner[1:]]  # 40 and 20 cm before it, at it
    [[0.66, 1.86, 2.58], [0.88, 0.64, 0.55], [2.01, 3.79, 3.99]]
    """
    along = np.arange(0.0, path.length + CELL, CELL)
    unsmoothed = np.gradient(np.asarray(moving_frames(path, along).angle), CELL)
    curvature = gaussian_filter1d(unsmoothed, TUNED.bend_blur / CELL, mode="nearest")
    sharpest = maximum_filter1d(abs(unsmoothed), 2 * round(TUNED.bend_blur / CELL) + 1)
    sharpest = gaussian_filter1d(sharpest, TUNED.bend_blur / CELL / 2, mode="nearest", truncate=2.0)
    return Bends(along, curvature, (1 + (TUNED.bend_radius * curvature) ** 2) ** -0.25, sharpest)


def places_on(path: GroundPath, ride: Ride, fps: float, limit: float = np.inf) -> tuple[Array, Array]:
    """Compute the positions of a walk on a line, for which it slows down as far as its own path bends less.

    The ratio of the speeds on the line and on the walk's own path is r = q(k) / q(k₀), with the curvatures k
    of the line and k₀ of the own path: 1 for a captured turn on its own path. Steps are √r times as long, and
    a frame lasts 1/√r as long. While a body stands, its path curls without meaning, and r = 1. Where the walk
    would turn faster than the limit, and faster than by itself to the same side, r is smaller, down to 0.45
    times that, or to 0.3 m/s.

    Parameters
    ----------
    path : the line.
    ride : the walk's own path, and the metres along it in each of F frames.
    fps : frames per second of the walk.
    limit : the largest turning rate, radians per second.

    Returns
    -------
    The metres along the line, and r, (F,) each.

    Examples
    --------
    >>> straight = Ride(GroundPath([[0, 0], [0, 6]]), np.arange(0, 6, 0.5))  # half a metre in a frame
    >>> corner = GroundPath([[0, 0], [0, 3], [3, 3]])
    >>> [part[4:8].round(2).tolist() for part in places_on(corner, straight, 2.0)]
    [[2.0, 2.5, 2.99, 3.36], [1.0, 0.97, 0.55, 0.83]]
    """
    line = bends_of(path)
    cells = np.stack([line.pace, line.sharpest, np.sign(line.curvature)], axis=1).tolist()
    metres = 0.0
    ratio = 1.0
    places = []
    for step, pace, walking, speed, bend in _paces(ride, fps).tolist():
        metres += ratio**0.5 * step
        line_pace, line_bend, side = cells[min(round(metres / CELL), len(cells) - 1)]
        ratio = min(max(line_pace / pace, TUNED.lowest_ratio), TUNED.highest_ratio) ** walking
        extra_bend = line_bend - max(side * bend, 0.0)
        ratio = _ratio_within(TUNED.rate_margin * limit, extra_bend * speed, speed, ratio)
        places.append((metres, ratio))
    along, ratios = np.array(places).T
    return along, ratios


def _paces(ride: Ride, fps: float) -> Array:
    """Compute for each frame of a walk what its ratio of speeds depends on, (F, 5).

    The columns are the step from the previous frame (metres), the pace q(k₀), a weight from 0 for standing to
    1 for walking, the speed (m/s), and the largest curvature nearby, with its sign (radians per metre).
    """
    # The curvatures of the walk's own path are computed as those of the line: on its own path r is 1.
    bends = bends_of(ride.path)
    cell = np.clip(np.round(ride.along / CELL).astype(int), 0, len(bends.pace) - 1)
    signed_bend = np.sign(bends.curvature) * bends.sharpest
    steps = np.diff(ride.along, prepend=ride.along[:1])
    over_standing = _speed(ride.along, fps) - TUNED.standing_speed
    walking = np.clip(over_standing / (TUNED.walking_speed - TUNED.standing_speed), 0, 1)
    speeds = np.gradient(ride.along) * fps
    return np.stack([steps, bends.pace[cell], walking, speeds, signed_bend[cell]], axis=1)


def _ratio_within(limit: float, rate: float, speed: float, ratio: float) -> float:
    """Lower a ratio of speeds until a walk turns within a limit, but not below the least speed at a corner.

    Parameters
    ----------
    limit : the largest turning rate, radians per second.
    rate : the turning rate beyond what the walk turns by itself, at its own speed, radians per second.
    speed : its own speed, metres per second.
    ratio : the ratio of speeds by the law.
    """
    if rate * ratio > limit:
        return max(limit / rate, TUNED.corner_ratio * ratio, min(TUNED.corner_speed / speed, ratio))
    return ratio


def slowed_frames(ratio: Array) -> Array:
    """Compute the frames of a walk that are shown when it is slowed down, as numbers with fractions.

    Parameters
    ----------
    ratio : shape (F,), the ratios of speeds from `places_on`. A frame lasts 1/√ratio as long.

    Examples
    --------
    >>> slowed_frames(np.array([1.0, 0.25, 0.25])).round(2).tolist()
    [0.0, 0.67, 1.25, 1.75]
    """
    durations = ratio**-0.5  # new frames per old frame
    times = np.concatenate([[0.0], np.cumsum((durations[1:] + durations[:-1]) / 2)])
    return np.interp(np.arange(int(times[-1] + TOLERANCE) + 1), times, np.arange(len(ratio)))


def slow_down(motion: Motion, ride: Ride, path: GroundPath, limit: float = np.inf) -> SlowedWalk:
    """Slow a walk down for the bends of a line.

    Parameters
    ----------
    motion : F frames.
    ride : its path, and the metres along it in each frame.
    path : the line; the walk starts at its start.
    limit : the largest turning rate, radians per second.

    Returns
    -------
    The walk at its new times, with its positions and its lean.

    Examples
    --------
    >>> from mocap.body import circle
    >>> from mocap.datasets import sample
    >>> from mocap.editing import ride_of
    >>> walk = sample("walk_straight")[:480]
    >>> slowed = slow_down(walk, ride_of(walk), circle(1.0))
    >>> round(slowed.motion.duration / walk.duration, 2)
    1.11
    >>> round(float(slowed.along[-1] / slowed.source_along[-1]), 2)
    0.9
    >>> round(float(np.degrees(slowed.lean[200])), 2)
    6.16
    """
    places, ratio = places_on(path, ride, motion.fps, limit)
    numbers = np.arange(len(motion))
    frames = slowed_frames(ratio)
    source_along = np.interp(frames, numbers, ride.along)
    along = np.interp(frames, numbers, places)
    source_speed = np.interp(frames, numbers, _speed(ride.along, motion.fps))
    source_lean = _balance(ride.path, source_along, source_speed)
    lean_on_line = _balance(path, along, _speed(along, motion.fps))
    return SlowedWalk(at_frames(motion, frames), source_along, along, lean_on_line - source_lean)


def _balance(path: GroundPath, along: Array, speed: Array) -> Array:
    """Compute the lean of a body in balance, atan(v² k / g), (F,), radians to the left."""
    bends = bends_of(path)
    curvature = np.interp(along, bends.along, bends.curvature)
    return np.asarray(np.arctan(curvature * speed**2 / GRAVITY))


def lean(motion: Motion, heading: Array, angle: Array) -> tuple[Motion, dict[int, Array]]:
    """Lean a body to the left: its feet move to the right, and its root is lowered.

    A straight leg of length h that leans by an angle a about its foot ends h cos a above the foot, and
    h sin a to its left. So a root at height h is lowered to h cos a, and footplants move by h sin a to the
    right: legs reach them at the same length, and feet stay on the floor. The root stays on its path.

    Captured people lean most in the legs. The pelvis leans by half as much, the trunk by a quarter. Feet keep
    their slope on the ground.

    Parameters
    ----------
    motion : F frames, with footplants.
    heading : shape (F,), the direction of travel, radians.
    angle : shape (F,), the lean to the left, radians.

    Returns
    -------
    The motion, and the positions of its footplants, as the `held` of `feet.clean_up`.

    Examples
    --------
    >>> from mocap.body import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]  # towards +z: left is +x
    >>> leaning, held = lean(walk, np.zeros(240), np.full(240, 0.3))
    >>> moved = dict(zip(walk.skeleton.names, joint_positions(leaning)[0] - joint_positions(walk)[0]))
    >>> for name in ("head", "root", "ltibia", "lfoot"):
    ...     print(name, moved[name][:2].round(3).tolist())  # metres to the left, and up
    head [0.043, -0.047]
    root [0.0, -0.043]
    ltibia [-0.128, -0.034]
    lfoot [-0.25, -0.01]
    >>> round(float(np.nanmean(held[4] - joint_positions(walk)[:, 4], axis=0)[0]), 3)  # of the left ankle
    -0.295
    """
    zeros = np.zeros(len(motion))
    leftward = np.stack([np.cos(heading), zeros, -np.sin(heading)], axis=1)
    backward = -np.stack([np.sin(heading), zeros, np.cos(heading)], axis=1)
    height = motion.root_positions[:, 1]
    outward = -(height * np.sin(angle))[:, None] * leftward
    outside = replace(motion, root_positions=motion.root_positions + outward)
    lowered = motion.root_positions.copy()
    lowered[:, 1] = height * np.cos(angle)
    fractions = _lean_fractions(motion.skeleton)
    world = forward_kinematics(motion).matrices
    local = motion.rotations.copy()
    for joint, fraction in fractions.items():
        ancestors = motion.skeleton.path_to_root(joint)[1:]
        parent = rotations.from_matrix(world[:, ancestors[0]]) if joint else rotations.IDENTITY
        parent_fraction = next((fractions[above] for above in ancestors if above in fractions), 0.0)
        # W' = T W, where T leans by this joint's fraction; and so with the fraction of the joint above.
        leaning = rotations.multiply(_rotations_about(backward, fraction * angle), parent)
        leaning_parent = rotations.multiply(_rotations_about(backward, parent_fraction * angle), parent)
        new_world = rotations.multiply(leaning, motion.rotations[:, joint])
        local[:, joint] = rotations.multiply(rotations.inverse(leaning_parent), new_world)
    pins = plant_pins(outside)
    held = np.where(np.isfinite(pins.low), pins.low, np.nan)
    places = {joint: held[:, column] for column, joint in enumerate(pins.joints)}
    return replace(motion, root_positions=lowered, rotations=local), places


def _lean_fractions(skeleton: Skeleton) -> Mapping[int, float]:
    """Return the joints that lean by another fraction of the lean than the joint above: {joint: fraction}."""
    legs = find_legs(skeleton)
    fractions = {0: TUNED.pelvis_lean, **dict.fromkeys(skeleton.children(0), TUNED.trunk_lean)}
    for leg in legs:
        fractions[skeleton.path_to_root(leg.hip)[-2]] = TUNED.pelvis_lean
    fractions |= {leg.hip: 1.0 for leg in legs}
    fractions |= {leg.ankle: 0.0 for leg in legs}
    return fractions


def _rotations_about(axis: Array, angle: Array) -> Array:
    """Return rotations about axes (F, 3) by angles (F,), as quaternions (F, 4)."""
    return rotations.from_rotvec(axis * angle[:, None])


def _speed(along: Array, fps: float) -> Array:
    """Return the smoothed speed of a walk, (F,), metres per second, from the metres along its path."""
    return np.asarray(gaussian_filter1d(np.gradient(along) * fps, TUNED.speed_blur * fps, mode="nearest"))
