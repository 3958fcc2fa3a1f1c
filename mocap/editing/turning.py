"""How people take a bend: slower, and leaning into it.

Who goes round a bend of curvature k (radians per metre) at speed v leans inwards by atan(v² k / g), measured
from the feet to the centre of mass, or would fall outwards. People lean little, and so they slow down:

    v / v₀ = q(k) = (1 + (R k)²)^(-1/4),   R = 1.2 m,   v₀ the speed straight on

In tight bends v² k then stays at v₀² / R, about a tenth of g for a walk. Half of it is shorter steps, half a
slower clock: steps are √q times as long, and last 1/√q as long. The law and R are ours, from captured turns.
At a corner, where v k is still more than a walk may turn, it goes more slowly yet, from a little before.
"""

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.path_editing import Ride, moving_frames
from mocap.editing.pins import plant_pins
from mocap.editing.retiming import at_frames

RADIUS = 1.2  # metres; R above. People who run slow down more, R of about 2 m at 2.5 to 3 m/s
GRAVITY = 9.81
CELL, SOFT = 0.02, 0.2  # metres: a line's curvature is taken at such distances, and smoothed by so much
SMOOTH = 0.3  # seconds by which speeds are smoothed
STANDS, WALKS = 0.2, 0.5  # metres per second: below the first a body stands, and its path curls
# Of the speed that the law gives, and metres per second: so slowly a walk goes at least where it would turn
# faster than it may. With 0.6 a brisk walk is up to 18 cm off at a corner of 135°, not 9. A walk keeps to
# `WITHIN` of the limit, because its speed varies.
SLOWER, LEAST, WITHIN = 0.45, 0.3, 0.95
RATIOS = (0.3, 1.25)  # of speeds, after and before: a turn that is made straight speeds up a little
PELVIS, TRUNK = 0.5, 0.25  # of the lean; the legs take the whole of it, and the feet none


def bends_of(path: GroundPath) -> tuple[Array, Array, Array, Array]:
    """Measure how a line bends, and how much slower than straight on people walk there.

    Gives, for places along it, the metres, the curvature k (radians per metre), the pace q, and the largest
    curvature nearby, unsmoothed.

    Examples
    --------
    >>> from mocap.body import circle
    >>> [round(float(some[100]), 2) for some in bends_of(circle(1.0))]  # 2 m along it
    [2.0, 1.0, 0.8, 1.0]
    >>> corner = GroundPath([[0, 0], [0, 2], [1, 2]])
    >>> [some[[80, 90, 100]].round(2).tolist() for some in bends_of(corner)[1:]]  # 40 cm and 20 before, at it
    [[0.66, 1.86, 2.58], [0.88, 0.64, 0.55], [2.01, 3.79, 3.99]]
    """
    along = np.arange(0.0, path.length + CELL, CELL)
    turning = np.gradient(np.asarray(moving_frames(path, along).angle), CELL)
    curvature = gaussian_filter1d(turning, SOFT / CELL, mode="nearest")
    sharpest = maximum_filter1d(abs(turning), 2 * round(SOFT / CELL) + 1)
    sharpest = gaussian_filter1d(sharpest, SOFT / CELL / 2, mode="nearest", truncate=2.0)
    return along, curvature, (1 + (RADIUS * curvature) ** 2) ** -0.25, sharpest


def places_on(path: GroundPath, ride: Ride, fps: float, limit: float = np.inf) -> tuple[Array, Array]:
    """Say where on a line a walk is, slowed by as much as the line bends more than the walk's own path.

    Gives for each of its F frames the metres along the line, and its speed there over its own: steps are
    √ratio times as long, and a frame lasts 1/√ratio as long. The ratio is r = q(k) / q(k₀), with k₀ of its
    own path: 1 for a captured turn on its own path. Where a body stands, its path curls, and that says
    nothing: r = 1. Where it would turn faster than the limit, radians per second, and than by itself to the
    same side, r is smaller, down to `SLOWER` or `LEAST`.

    Examples
    --------
    >>> straight = Ride(GroundPath([[0, 0], [0, 6]]), np.arange(0, 6, 0.5))  # half a metre in a frame
    >>> corner = GroundPath([[0, 0], [0, 3], [3, 3]])
    >>> [part[4:8].round(2).tolist() for part in places_on(corner, straight, 2.0)]
    [[2.0, 2.5, 2.99, 3.36], [1.0, 0.97, 0.55, 0.83]]
    """
    (_, curvature, slower, sharpest), (_, bends, own, tightest) = bends_of(path), bends_of(ride.path)
    walks = np.clip((_speed(ride.along, fps) - STANDS) / (WALKS - STANDS), 0, 1)
    cells, speeds = np.round(ride.along / CELL).astype(int), np.gradient(ride.along) * fps
    # How it turns by itself is measured as on the line, or it would be slowed on its own path, too.
    paces, tight = (some[np.clip(cells, 0, len(own) - 1)] for some in (own, np.sign(bends) * tightest))
    here, ratio, last, (low, high) = 0.0, 1.0, len(slower) - 1, RATIOS
    places, there = [], np.stack([slower, sharpest, np.sign(curvature)], axis=1).tolist()
    steps = np.diff(ride.along, prepend=ride.along[:1])
    for step, pace, walk, speed, bend in np.stack([steps, paces, walks, speeds, tight], axis=1).tolist():
        here += ratio**0.5 * step
        q, k, side = there[min(round(here / CELL), last)]
        ratio = min(max(q / pace, low), high) ** walk
        more = (k - max(side * bend, 0.0)) * speed
        if more * ratio > WITHIN * limit:
            ratio = max(WITHIN * limit / more, SLOWER * ratio, min(LEAST / speed, ratio))
        places.append((here, ratio))
    along, ratios = np.array(places).T
    return along, ratios


def slow_down(
    motion: Motion, ride: Ride, path: GroundPath, limit: float = np.inf
) -> tuple[Motion, Array, Array, Array]:
    """Slow a walk for the bends of a line.

    Parameters
    ----------
    motion, ride : F frames, and where they are on their own path.
    path : the line, which the walk starts at its start.
    limit : how fast it may be turned, radians per second.

    Returns
    -------
    The walk at its new times; in each of its frames the metres along its own path, those along the line, and
    by how much more than by itself it must lean to the left, radians.

    Examples
    --------
    >>> from mocap.body import circle
    >>> from mocap.datasets import sample
    >>> from mocap.editing import ride_of
    >>> walk = sample("walk_straight")[:480]
    >>> slow, own, along, leaning = slow_down(walk, ride_of(walk), circle(1.0))
    >>> round(slow.duration / walk.duration, 2), round(float(along[-1] / own[-1]), 2)
    (1.11, 0.9)
    >>> round(float(np.degrees(leaning[200])), 2)
    6.16
    """
    (places, ratio), numbers = places_on(path, ride, motion.fps, limit), np.arange(len(motion))
    clock = ratio**-0.5  # new frames per old frame
    times = np.concatenate([[0.0], np.cumsum((clock[1:] + clock[:-1]) / 2)])
    frames = np.interp(np.arange(int(times[-1] + 1e-6) + 1), times, numbers)
    own, along = (np.interp(frames, numbers, some) for some in (ride.along, places))
    speeds = np.interp(frames, numbers, _speed(ride.along, motion.fps)), _speed(along, motion.fps)
    before, after = (
        np.arctan(np.interp(where, *bends_of(line)[:2]) * speed**2 / GRAVITY)
        for where, line, speed in zip((own, along), (ride.path, path), speeds, strict=True)
    )
    return at_frames(motion, frames), own, along, after - before


def lean(motion: Motion, way: Array, angle: Array) -> tuple[Motion, dict[int, Array]]:
    """Let a body lean, the root in its place, and its feet further out.

    Captured people lean most in the legs: the pelvis by half as much, the trunk by a quarter. Feet keep their
    slope on the ground.

    Parameters
    ----------
    motion : F frames, with plants.
    way : shape (F,), which way it goes, radians.
    angle : shape (F,), by how much it leans to the left, radians.

    Returns
    -------
    The motion, and where its plants shall be, as the `held` of `feet.clean_up`.

    Examples
    --------
    >>> from mocap.body import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]  # left is +x where it goes towards +z
    >>> leaning, held = lean(walk, np.zeros(240), np.full(240, 0.1))
    >>> moved = dict(zip(walk.skeleton.names, (joint_positions(leaning) - joint_positions(walk))[0, :, 0]))
    >>> [round(float(moved[name]), 3) for name in ("head", "root", "ltibia", "lfoot")]  # metres
    [0.014, 0.0, -0.043, -0.084]
    >>> round(float(np.nanmean(held[4] - joint_positions(walk)[:, 4], axis=0)[0]), 3)  # of the left ankle
    -0.1
    """
    height, ahead = motion.root_positions[:, 1], np.stack([np.sin(way), 0 * way, np.cos(way)], axis=1)
    left = np.stack([np.cos(way), 0 * way, -np.sin(way)], axis=1)
    outer = replace(motion, root_positions=motion.root_positions - (height * np.tan(angle))[:, None] * left)
    skeleton, legs = motion.skeleton, find_legs(motion.skeleton)
    shares = {0: PELVIS, **dict.fromkeys(skeleton.children(0), TRUNK)}
    shares |= {skeleton.path_to_root(leg.hip)[-2]: PELVIS for leg in legs}
    shares |= {leg.hip: 1.0 for leg in legs} | {leg.ankle: 0.0 for leg in legs}
    world, pose = forward_kinematics(motion).matrices, motion.rotations.copy()
    for joint, share in shares.items():
        above = skeleton.path_to_root(joint)[1:]
        old = rotations.from_matrix(world[:, above[0]]) if joint else np.array([1.0, 0, 0, 0])
        # W' = T W, where T tilts about the way ahead: of this joint, and of the nearest one above it.
        tilted, before = (
            rotations.multiply(rotations.from_rotvec(-ahead * (part * angle)[:, None]), old)
            for part in (share, next((shares[other] for other in above if other in shares), 0.0))
        )
        pose[:, joint] = rotations.multiply(
            rotations.inverse(before), rotations.multiply(tilted, motion.rotations[:, joint])
        )
    pins = plant_pins(outer)
    held = np.where(np.isfinite(pins.low), pins.low, np.nan)
    return replace(motion, rotations=pose), {joint: held[:, n] for n, joint in enumerate(pins.joints)}


def _speed(along: Array, fps: float) -> Array:
    return np.asarray(gaussian_filter1d(np.gradient(along) * fps, SMOOTH * fps, mode="nearest"))
