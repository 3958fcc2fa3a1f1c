"""Where the feet go: a route over the ground, and each foot's way from plant to plant.

A planted foot does not slide. It comes down on its heel and rolls about it until the sole lies flat,
stands, rolls about its ball while the heel rises, and leaves. In between it swings on the quintic curve
that fits both ends in place, speed and acceleration. All of that is told by one clock, the phase: it
counts strides, and the foot strikes at whole numbers (the other one at halves).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Indices, Mask
from mocap.errors import MocapError


class Route:
    """A smooth curve on the ground, by arc length; beyond both ends it goes straight on.

    Parameters
    ----------
    points : shape (N, 2), metres: (x, z) of at least two points, no two neighbours alike.

    Examples
    --------
    >>> route = Route([[0, 0], [0, 2], [0, 4]])
    >>> route.length, route.place([1.0, 5.0]).round(6).tolist(), float(route.heading(1.0).round(6))
    (4.0, [[0.0, 1.0], [0.0, 5.0]], 0.0)
    """

    def __init__(self, points: ArrayLike) -> None:
        points = np.asarray(points, float)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2 or not np.isfinite(points).all():
            raise MocapError(f"A route needs two or more finite points (x, z), got shape {points.shape}.")
        chords = np.linalg.norm(np.diff(points, axis=0), axis=-1)
        if not chords.min() > 0:
            raise MocapError(f"Points {int(chords.argmin())} and the next of a route are the same.")
        knots = np.concatenate([[0.0], np.cumsum(chords)])
        curve = CubicSpline(knots, points, bc_type="natural")
        fine = np.linspace(0, knots[-1], 20 * len(points) + 1)
        speed = np.linalg.norm(curve(fine, 1), axis=-1)
        lengths = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(fine))])
        self.length = float(lengths[-1])
        even = np.linspace(0, self.length, len(fine))
        self._curve = CubicSpline(even, curve(np.interp(even, lengths, fine)), bc_type="natural")

    def place(self, distance: ArrayLike) -> Array:
        """Find the points (..., 2) at `distance` metres from the start."""
        distance = np.asarray(distance, float)
        inside = np.clip(distance, 0, self.length)
        return np.asarray(self._curve(inside) + (distance - inside)[..., None] * self._curve(inside, 1))

    def heading(self, distance: ArrayLike) -> Array:
        """Find the directions the route runs in, radians about +y from +z, without jumps along an array."""
        x, z = np.moveaxis(self._curve(np.clip(distance, 0, self.length), 1), -1, 0)
        return np.asarray(np.unwrap(np.arctan2(x, z))) if np.ndim(distance) else np.arctan2(x, z)


def smoothstep(amount: ArrayLike) -> Array:
    """Ramp from 0 to 1, 6u⁵ - 15u⁴ + 10u³, at rest and unaccelerated at both ends; 0 before, 1 after.

    Examples
    --------
    >>> smoothstep([-1.0, 0.5, 2.0])
    array([0. , 0.5, 1. ])
    """
    u = np.clip(amount, 0, 1)
    return np.asarray(u**3 * (10 - 15 * u + 6 * u**2))


def winding(stretches: Sequence[tuple[float, float]]) -> Array:
    """Lay out a route as a walker would tell it: so many metres, turning so many degrees to the left.

    Parameters
    ----------
    stretches : pairs of metres and degrees; the turning eases over from one stretch to the next.

    Returns
    -------
    Points (N, 2), metres, 5 cm apart, from the origin, setting out along +z.

    Examples
    --------
    >>> winding([(2.0, 0.0), (1.0, 90.0)])[-1].round(1)
    array([0.7, 2.6])
    """
    step = 0.05
    counts = [max(1, round(metres / step)) for metres, _ in stretches]
    turns = [np.radians(degrees) / n for (_, degrees), n in zip(stretches, counts, strict=True)]
    heading = np.cumsum(gaussian_filter1d(np.repeat(turns, counts), 0.25 / step))
    strides = step * np.stack([np.sin(heading), np.cos(heading)], axis=-1)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(strides, axis=0)])


class Foot(NamedTuple):
    """A foot's shape, in metres.

    `ankle` and `ball` stand that high above the floor; `heel`, `instep` and `toe` are the lengths from
    the ankle back to the heel, from the ankle to the ball, and from the ball to the tip.
    """

    ankle: float
    ball: float
    heel: float
    instep: float
    toe: float


class Roll(NamedTuple):
    """How a foot rolls and swings: phases after its strike, and figures in between.

    At `flat` the sole lies flat, at `heel_off` the heel rises, at `lift` the ball leaves the ground.
    `pitch` lists the degrees by which the toes point up, at even steps from `heel_off` to `1 + flat`. `swing`
    lists what the ankle does in the air beyond the smoothest curve: metres up in the middle, and early rather
    than late; then the same forwards, as shares of the way.
    """

    flat: float
    heel_off: float
    lift: float
    pitch: tuple[float, ...]
    swing: tuple[float, float, float, float]


class Steps(NamedTuple):
    """One foot's N plants, in order.

    `strikes` (N,) are phases, `places` (N, 2) the ankles' x and z in metres, `yaws` (N,) the directions the
    foot points in, radians. For the swing after each plant, `vigour` (N - 1,) scales the pitch and the lift,
    and `rolls`, N - 1 of them, tell how the foot leaves, swings and lands.
    """

    strikes: Array
    places: Array
    yaws: Array
    vigour: Array
    rolls: Sequence[Roll]


class FootPath(NamedTuple):
    """One foot, frame by frame.

    `ankle` (F, 3) in metres; `pitch`, `yaw`, `toe` (F,) in radians, toes up positive. `flat` and `planted`
    (F,) mark where the ankle and the ball stand still. `stance` (F,) is the phase since the strike, as if the
    foot stood no longer than usual; `load` (F,) rises to 1 while it carries the body and is 0 in the air.
    """

    ankle: Array
    pitch: Array
    yaw: Array
    toe: Array
    flat: Mask
    planted: Mask
    stance: Array
    load: Array


def foot_pitch(roll: Roll, phase: ArrayLike) -> Array:
    """Look up how far the toes point up at a phase since the foot's last strike.

    Parameters
    ----------
    roll : the table; it runs from `heel_off` to `1 + flat`, and before and after the foot lies flat.
    phase : shape (...), cycles.

    Returns
    -------
    Radians, shape (...).

    Examples
    --------
    >>> roll = Roll(0.0, 0.5, 0.6, (0, -60, 0), (0, 0, 0, 0))
    >>> np.degrees(foot_pitch(roll, [0.3, 0.75])).round(6)
    array([  0., -60.])
    """
    knots = np.linspace(roll.heel_off, 1 + roll.flat, len(roll.pitch))
    curve = CubicSpline(knots, np.radians(roll.pitch), bc_type="clamped")
    return np.asarray(curve(np.clip(phase, knots[0], knots[-1])))


def foot_path(steps: Steps, phase: Array, foot: Foot) -> FootPath:
    """Move one foot through its plants.

    Parameters
    ----------
    steps : the plants; the first strikes at least one cycle before the first frame, the last after the last.
    phase : shape (F,), cycles, never falling.
    foot : its shape.

    Returns
    -------
    The foot's path over the F frames: still to rounding wherever `flat` and `planted` say so, never
    below the floor, and without a jump in place, speed or acceleration where it leaves or strikes.
    """
    rolls = steps.rolls
    changes = [k for k in range(1, len(rolls)) if rolls[k] != rolls[k - 1]]
    # One roll passes to the next in the middle of the time in which the sole lies flat by both.
    both = [(steps.strikes[k], rolls[k - 1], rolls[k]) for k in changes]
    middles = [s + (max(a.flat, b.flat) + min(a.heel_off, b.heel_off)) / 2 for s, a, b in both]
    parts = np.split(phase, np.searchsorted(phase, middles))
    pieces = [_roll_on(steps, part, rolls[k], foot) for k, part in zip([0, *changes], parts, strict=True)]
    return FootPath(*map(np.concatenate, zip(*pieces, strict=True)))


def _roll_on(steps: Steps, phase: Array, roll: Roll, foot: Foot) -> FootPath:
    """Move the foot through some frames by one and the same roll."""
    last = np.searchsorted(steps.strikes + roll.flat, phase, side="right") - 1
    local = phase - steps.strikes[last + 1] + 1  # lift .. 1 in the air, 1 .. 1 + flat on the heel
    pitch = steps.vigour[last] * foot_pitch(roll, local)
    turn = smoothstep((local - roll.lift) / (1 - roll.lift))
    yaw = steps.yaws[last] + turn * (steps.yaws[last + 1] - steps.yaws[last])
    on_ball, on_heel = local < roll.lift, local >= 1
    rolling = _about_ball(steps.places[last], yaw, pitch, foot)
    landing = _about_heel(steps.places[last + 1], yaw, pitch, foot)
    swinging = _swing(steps, roll, foot, last, local)
    ankle = np.where(on_ball[:, None], rolling, np.where(on_heel[:, None], landing, swinging))
    since = np.where(on_heel, local - 1, phase - steps.strikes[last])
    until = np.where(on_heel, np.inf, roll.lift - local)
    load = np.where(
        on_ball | on_heel, smoothstep(5 * since / roll.lift) * smoothstep(4 * until / roll.lift), 0.0
    )
    stance = np.where(since < roll.lift / 2, since, np.maximum(roll.lift / 2, roll.lift - until))
    flat = local <= roll.heel_off
    return FootPath(ankle, pitch, yaw, _toe(ankle, pitch, foot), flat, on_ball, stance, load)


def _sole(yaw: Array, pitch: ArrayLike, ahead: float, up: float) -> Array:
    """Lay out the vector `ahead` and `up` along a foot that points to `yaw`, its toes raised by `pitch`."""
    level = ahead * np.cos(pitch) - up * np.sin(pitch)
    rise = ahead * np.sin(pitch) + up * np.cos(pitch) + 0 * yaw
    return np.stack([level * np.sin(yaw), rise, level * np.cos(yaw)], axis=-1)


def _about_ball(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Place the ankle, `place` when flat, while the ball stands still."""
    ball = _sole(yaw, 0.0, foot.instep, foot.ball)
    ball[:, [0, 2]] += place
    return np.asarray(ball + _sole(yaw, pitch, -foot.instep, foot.ankle - foot.ball))


def _about_heel(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Place the ankle, `place` when flat, while the heel stands still."""
    heel = _sole(yaw, 0.0, -foot.heel, 0.0)
    heel[:, [0, 2]] += place
    return np.asarray(heel + _sole(yaw, pitch, foot.heel, foot.ankle))


def _swing(steps: Steps, roll: Roll, foot: Foot, last: Indices, local: Array) -> Array:
    """Carry the ankle through the air, from where it leaves to where it strikes."""
    width = 1 - roll.lift
    ends = []
    for moment, turn, place in (
        (roll.lift, _about_ball, slice(None, -1)),
        (1.0, _about_heel, slice(1, None)),
    ):
        step = 1e-3  # of a cycle: how the foot rolls on gives the speed and the acceleration to fit
        before, at, after = (
            turn(steps.places[place], steps.yaws[place], steps.vigour * foot_pitch(roll, moment + d), foot)
            for d in (-step, 0.0, step)
        )
        speed, push = (after - before) / (2 * step), (after - 2 * at + before) / step**2
        ends.append((at[last], speed[last] * width, push[last] * width**2))
    u = np.clip((local - roll.lift) / width, 0, 1)[:, None]
    curve = _quintic(ends[0], ends[1], u)
    chord = (ends[1][0] - ends[0][0])[:, [0, 2]]
    round_turn = np.tan((steps.yaws[last + 1] - steps.yaws[last]) / 4)[:, None] / 2  # sagitta over chord
    up, early_up, on, early_on = roll.swing
    bump = 64 * (u * (1 - u)) ** 3
    curve[:, [1]] += bump * (up + early_up * (1 - 2 * u)) * steps.vigour[last][:, None]
    curve[:, [0, 2]] += bump * ((on + early_on * (1 - 2 * u)) * chord + round_turn * chord[:, ::-1] * [-1, 1])
    return curve


def _quintic(start: Sequence[Array], end: Sequence[Array], u: Array) -> Array:
    """Join two places with their speeds and accelerations, for u from 0 to 1."""
    (p0, v0, a0), (p1, v1, a1) = start, end
    gap, speed, push = p1 - p0 - v0 - a0 / 2, v1 - v0 - a0, a1 - a0
    curve = p0 + v0 * u + a0 / 2 * u**2 + (10 * gap - 4 * speed + push / 2) * u**3
    return np.asarray(curve + (-15 * gap + 7 * speed - push) * u**4 + (6 * gap - 3 * speed + push / 2) * u**5)


def _toe(ankle: Array, pitch: Array, foot: Foot) -> Array:
    """Let the toes follow the foot unless the floor is in their way."""
    ball = ankle[:, 1] + foot.instep * np.sin(pitch) - (foot.ankle - foot.ball) * np.cos(pitch)
    floor = np.arcsin(np.clip((foot.ball - ball) / foot.toe, -1, 1))
    return np.asarray(np.maximum(pitch, floor))
