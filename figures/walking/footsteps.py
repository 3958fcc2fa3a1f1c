"""Where the feet go: each foot's way from footplant to footplant.

A planted foot does not slide. It strikes with its heel and rolls about it until the sole lies flat. It
stands, then rolls about its ball while the heel rises, and lifts. In the air it follows a quintic curve that
fits place, speed and acceleration at both ends. One clock drives all of this, the phase: it counts strides,
and a foot strikes at whole numbers (the other foot at halves).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.easing import quintic_step
from mocap.body.ground_path import GroundPath


def winding(stretches: Sequence[tuple[float, float]]) -> Array:
    """Lay out a path by its lengths and turns.

    Parameters
    ----------
    stretches : pairs of metres and degrees to the left; the turning is smoothed between stretches.

    Returns
    -------
    Points (N, 2), metres, 5 cm apart; the first is the origin, and the path starts along +z.

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


class SmoothPath(NamedTuple):
    """A smooth curve on the ground, without corners; beyond both ends it goes straight on."""

    curve: CubicSpline
    length: float

    def at(self, along: Array) -> Array:
        """Give the points (..., 2), (x, z), that lie `along` metres from the start."""
        inside = np.clip(along, 0, self.length)
        return np.asarray(self.curve(inside) + (along - inside)[..., None] * self.curve(inside, 1))

    def heading(self, along: Array) -> Array:
        """Give the directions of the curve, radians about +y from +z; they do not jump."""
        x, z = np.moveaxis(self.curve(np.clip(along, 0, self.length), 1), -1, 0)
        return np.asarray(np.unwrap(np.arctan2(x, z)))


def smooth_path(points: ArrayLike) -> SmoothPath:
    """Draw a curve through points (N, 2) on the ground, metres, along which `at` moves a metre per metre.

    A natural cubic spline c(u) passes through the points, C²; its parameter u is the length of the chords.
    A second spline fits points of the first one at even arc lengths s(u) = ∫ |c'| du. The length is right
    within 1 % where neighbouring chords turn by less than 35°, but not around sharp corners.

    Raises
    ------
    MocapError : for points that make no `GroundPath`.

    Examples
    --------
    >>> ahead = smooth_path([[0, 0], [0, 2], [0, 4]])
    >>> ahead.at(np.array([1.0, 5.0])).round(6).tolist(), round(ahead.length, 6)
    ([[0.0, 1.0], [0.0, 5.0]], 4.0)
    """
    points = GroundPath(np.asarray(points, float)).points
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=-1))])
    curve = CubicSpline(knots, points, bc_type="natural")
    fine = np.linspace(0, knots[-1], 20 * len(points) + 1)
    speed = np.linalg.norm(curve(fine, 1), axis=-1)
    lengths = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(fine))])
    even = np.linspace(0, float(lengths[-1]), len(fine))
    by_length = CubicSpline(even, curve(np.interp(even, lengths, fine)), bc_type="natural")
    return SmoothPath(by_length, float(lengths[-1]))


class Foot(NamedTuple):
    """A foot's shape, in metres.

    `ankle` and `ball` are heights above the floor; `heel`, `instep` and `toe` are the lengths from the ankle
    back to the heel, from the ankle to the ball, and from the ball to the tip.
    """

    ankle: float
    ball: float
    heel: float
    instep: float
    toe: float


class Roll(NamedTuple):
    """How a foot rolls and swings.

    Phases after the strike: at `flat` the sole lies flat, at `heel_off` the heel rises, at `lift` the ball
    leaves the ground. `pitch` lists the degrees by which the toes point up, at even steps from `heel_off` to
    `1 + flat`. `swing` changes the curve of the ankle in the air: (metres up in the middle, metres more in
    the first half than in the second; the same two forwards, as shares of the step).
    """

    flat: float
    heel_off: float
    lift: float
    pitch: tuple[float, ...]
    swing: tuple[float, float, float, float]


class Steps(NamedTuple):
    """One foot's N footplants, in order.

    `strikes` (N,) are phases, `places` (N, 2) the ankle's x and z in metres, `yaws` (N,) the directions in
    which the foot points, radians. For the swing after each footplant, `vigour` (N - 1,) scales the pitch and
    the lift, and `rolls`, N - 1 of them, say how the foot lifts, swings and lands.
    """

    strikes: Array
    places: Array
    yaws: Array
    vigour: Array
    rolls: Sequence[Roll]


class FootPath(NamedTuple):
    """One foot, frame by frame.

    `ankle` (F, 3) in metres; `pitch`, `yaw`, `toe` (F,) in radians, toes up positive. `flat` and `planted`
    (F,) mark where the ankle and the ball stand still. `stance` (F,) is the phase since the strike; it rests
    while the foot stands longer than usual. `load` (F,) is 1 while the foot carries the body, 0 in the air.
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
    """Look up how far the toes point up, at a phase since the foot's last strike.

    Parameters
    ----------
    roll : the table, from `heel_off` to `1 + flat`; before and after the foot lies flat.
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
    """Move one foot through its footplants.

    Parameters
    ----------
    steps : the footplants; the first strike is at least one cycle before the first frame, the last one after
        the last frame.
    phase : shape (F,), cycles, never falling.
    foot : its shape.

    Returns
    -------
    The foot's path over the F frames. It does not move, up to rounding, where `flat` and `planted` are set;
    it is never below the floor; place, speed and acceleration do not jump where it lifts or strikes.
    """
    rolls = steps.rolls
    changes = [k for k in range(1, len(rolls)) if rolls[k] != rolls[k - 1]]
    # One roll passes to the next in the middle of the time when the sole lies flat in both.
    both = [(steps.strikes[k], rolls[k - 1], rolls[k]) for k in changes]
    middles = [s + (max(a.flat, b.flat) + min(a.heel_off, b.heel_off)) / 2 for s, a, b in both]
    parts = np.split(phase, np.searchsorted(phase, middles))
    pieces = [_roll_on(steps, part, rolls[k], foot) for k, part in zip([0, *changes], parts, strict=True)]
    return FootPath(*map(np.concatenate, zip(*pieces, strict=True)))


def _roll_on(steps: Steps, phase: Array, roll: Roll, foot: Foot) -> FootPath:
    """Move the foot through some frames that share one roll."""
    last = np.searchsorted(steps.strikes + roll.flat, phase, side="right") - 1
    local = phase - steps.strikes[last + 1] + 1  # lift .. 1 in the air, 1 .. 1 + flat on the heel
    pitch = steps.vigour[last] * foot_pitch(roll, local)
    turn = quintic_step((local - roll.lift) / (1 - roll.lift))
    yaw = steps.yaws[last] + turn * (steps.yaws[last + 1] - steps.yaws[last])
    on_ball, on_heel = local < roll.lift, local >= 1
    rolling = about_ball(steps.places[last], yaw, pitch, foot)
    landing = _about_heel(steps.places[last + 1], yaw, pitch, foot)
    swinging = _swing(steps, roll, foot, last, local)
    ankle = np.where(on_ball[:, None], rolling, np.where(on_heel[:, None], landing, swinging))
    since = np.where(on_heel, local - 1, phase - steps.strikes[last])
    until = np.where(on_heel, np.inf, roll.lift - local)
    load = np.where(
        on_ball | on_heel, quintic_step(5 * since / roll.lift) * quintic_step(4 * until / roll.lift), 0.0
    )
    stance = np.where(since < roll.lift / 2, since, np.maximum(roll.lift / 2, roll.lift - until))
    flat = local <= roll.heel_off
    return FootPath(ankle, pitch, yaw, toe_angle(ankle, pitch, foot), flat, on_ball, stance, load)


def _sole(yaw: Array, pitch: ArrayLike, ahead: float, up: float) -> Array:
    """Give the vector that is `ahead` and `up` in a foot turned by `yaw`, its toes raised by `pitch`."""
    level = ahead * np.cos(pitch) - up * np.sin(pitch)
    rise = ahead * np.sin(pitch) + up * np.cos(pitch) + 0 * yaw
    return np.stack([level * np.sin(yaw), rise, level * np.cos(yaw)], axis=-1)


def about_ball(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Place the ankle while the ball stands still; with the sole flat it is above `place`."""
    ball = _sole(yaw, 0.0, foot.instep, foot.ball)
    ball[:, [0, 2]] += place
    return np.asarray(ball + _sole(yaw, pitch, -foot.instep, foot.ankle - foot.ball))


def _about_heel(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Place the ankle while the heel stands still; with the sole flat it is above `place`."""
    heel = _sole(yaw, 0.0, -foot.heel, 0.0)
    heel[:, [0, 2]] += place
    return np.asarray(heel + _sole(yaw, pitch, foot.heel, foot.ankle))


def _swing(steps: Steps, roll: Roll, foot: Foot, last: Indices, local: Array) -> Array:
    """Move the ankle through the air, from lift to strike."""
    width = 1 - roll.lift
    ends = []
    for moment, turn, place in (
        (roll.lift, about_ball, slice(None, -1)),
        (1.0, _about_heel, slice(1, None)),
    ):
        step = 1e-3  # of a cycle: differences give the speed and the acceleration at the end
        before, at, after = (
            turn(steps.places[place], steps.yaws[place], steps.vigour * foot_pitch(roll, moment + d), foot)
            for d in (-step, 0.0, step)
        )
        speed, push = (after - before) / (2 * step), (after - 2 * at + before) / step**2
        ends.append((at[last], speed[last] * width, push[last] * width**2))
    u = np.clip((local - roll.lift) / width, 0, 1)[:, None]
    curve = _quintic_hermite(ends[0], ends[1], u)
    chord = (ends[1][0] - ends[0][0])[:, [0, 2]]
    round_turn = np.tan((steps.yaws[last + 1] - steps.yaws[last]) / 4)[:, None] / 2  # sagitta over chord
    up, early_up, on, early_on = roll.swing
    bump = 64 * (u * (1 - u)) ** 3
    curve[:, [1]] += bump * (up + early_up * (1 - 2 * u)) * steps.vigour[last][:, None]
    curve[:, [0, 2]] += bump * ((on + early_on * (1 - 2 * u)) * chord + round_turn * chord[:, ::-1] * [-1, 1])
    return curve


def _quintic_hermite(start: Sequence[Array], end: Sequence[Array], u: Array) -> Array:
    """Join two ends by the quintic that has their places, speeds and accelerations, u from 0 to 1."""
    (p0, v0, a0), (p1, v1, a1) = start, end
    gap, speed, push = p1 - p0 - v0 - a0 / 2, v1 - v0 - a0, a1 - a0
    curve = p0 + v0 * u + a0 / 2 * u**2 + (10 * gap - 4 * speed + push / 2) * u**3
    return np.asarray(curve + (-15 * gap + 7 * speed - push) * u**4 + (6 * gap - 3 * speed + push / 2) * u**5)


def toe_angle(ankle: Array, pitch: Array, foot: Foot) -> Array:
    """Let the toes follow the foot where the floor does not stop them."""
    ball = ankle[:, 1] + foot.instep * np.sin(pitch) - (foot.ankle - foot.ball) * np.cos(pitch)
    floor = np.arcsin(np.clip((foot.ball - ball) / foot.toe, -1, 1))
    return np.asarray(np.maximum(pitch, floor))
