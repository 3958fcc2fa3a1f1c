"""Footplants along a path, and how a foot rolls over each of them.

A planted foot does not slide. The heel strikes, and the foot rolls about it until the sole is flat. It stands
flat until the heel rises, then rolls about its ball until that leaves the ground. All of it is driven by one
clock, the phase, which counts strides: a foot strikes at whole numbers, the other foot at halves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.body.ground_path import GroundPath

GRID = 0.02  # metres between the points of a path that `winding` lays out
SOFT = 0.25  # metres over which `winding` smooths the turning
PIVOT = 0.3  # metres: a shorter stretch is a turn on the spot, whose turning stays where it is


def winding(stretches: Sequence[tuple[float, float]]) -> Array:
    """Lay out a path by its lengths and turns.

    Parameters
    ----------
    stretches : pairs of metres and degrees to the left; the turning is smoothed between stretches. One of
        less than 0.3 m is a turn on the spot.

    Returns
    -------
    Points (N, 2), metres, 2 cm apart; the first is the origin, and the path starts along +z.

    Examples
    --------
    >>> winding([(2.0, 0.0), (1.0, 90.0)])[-1].round(1)
    array([0.7, 2.6])
    """
    counts = [max(1, round(metres / GRID)) for metres, _ in stretches]
    turns = np.radians([degrees for _, degrees in stretches]) / counts
    spots = np.array([metres < PIVOT for metres, _ in stretches])
    soft = gaussian_filter1d(np.repeat(np.where(spots, 0, turns), counts), SOFT / GRID)
    heading = np.cumsum(soft + np.repeat(np.where(spots, turns, 0), counts))
    pieces = GRID * np.stack([np.sin(heading), np.cos(heading)], axis=-1)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(pieces, axis=0)])


class SmoothPath(NamedTuple):
    """A smooth curve on the ground, without corners; beyond both ends it goes straight on."""

    curve: CubicSpline
    length: float

    def point(self, along: Array) -> Array:
        """Points (..., 2), (x, z), that lie `along` metres from the start."""
        inside = np.clip(along, 0, self.length)
        return np.asarray(self.curve(inside) + (along - inside)[..., None] * self.curve(inside, 1))

    def heading(self, along: Array) -> Array:
        """Directions of the curve, radians about +y from +z; they do not jump if `along` is dense."""
        x, z = np.moveaxis(self.curve(np.clip(along, 0, self.length), 1), -1, 0)
        return np.asarray(np.unwrap(np.arctan2(x, z)))


def smooth_path(points: ArrayLike) -> SmoothPath:
    """Draw a curve through points (N, 2) on the ground, metres, along which `point` moves a metre per metre.

    A natural cubic spline c(u) passes through the points, C²; its parameter u is the length of the chords.
    A second spline fits points of the first one at even arc lengths s(u) = ∫ |c'| du. The length is right
    within 1 % where neighbouring chords turn by less than 35°, but not around sharp corners.

    Raises
    ------
    MocapError : for points that make no `GroundPath`.

    Examples
    --------
    >>> ahead = smooth_path([[0, 0], [0, 2], [0, 4]])
    >>> ahead.point(np.array([1.0, 5.0])).round(6).tolist(), round(ahead.length, 6)
    ([[0.0, 1.0], [0.0, 5.0]], 4.0)
    """
    points = GroundPath(np.asarray(points, float)).points
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=-1))])
    curve = CubicSpline(knots, points, bc_type="natural")
    fine = np.linspace(0, knots[-1], 20 * len(points) + 1)
    speed = np.linalg.norm(curve(fine, 1), axis=-1)
    pieces = (speed[1:] + speed[:-1]) / 2 * np.diff(fine)
    lengths = np.concatenate([[0.0], np.cumsum(pieces)])
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
    """How a foot rolls.

    Phases after the strike: at `flat` the sole is flat, at `heel_off` the heel rises, from `let_go` the leg
    carries nothing, at `lift` the ball leaves the ground. At the strike the toes point up by `strike`
    degrees; `heel_rise` lists the degrees by which they point down at even steps from `heel_off` to `lift`.
    """

    flat: float
    heel_off: float
    let_go: float
    lift: float
    strike: float
    heel_rise: tuple[float, ...]


class Footplant(NamedTuple):
    """A foot on the ground: from its strike to its lift, and how it swings to the next footplant.

    `strike` and `next_strike` are phases; `position` (2,) is the ankle's x and z in metres; `yaw` is the
    direction of the foot, radians. `vigour` scales pitch and swing until the next strike. `weights` mix the
    gaits, as everywhere.
    """

    strike: float
    next_strike: float
    position: Array
    yaw: float
    vigour: float
    roll: Roll
    weights: Array

    @property
    def lift(self) -> float:
        """Phase at which the ball leaves the ground."""
        return self.next_strike - 1 + self.roll.lift

    @property
    def heel_off(self) -> float:
        """Phase at which the heel rises."""
        return self.next_strike - 1 + self.roll.heel_off


class FootPath(NamedTuple):
    """One foot, frame by frame.

    `ankle` (F, 3) in metres; `pitch`, `yaw`, `toe` (F,) in radians, toes up positive. `flat` and `planted`
    (F,) mark where the ankle and the ball stand still.
    """

    ankle: Array
    pitch: Array
    yaw: Array
    toe: Array
    flat: Mask
    planted: Mask

    def cut(self, inside: slice) -> FootPath:
        """Cut out some of the frames."""
        ankle, pitch, yaw, toe = (values[inside] for values in self[:4])
        return FootPath(ankle, pitch, yaw, toe, self.flat[inside], self.planted[inside])


def landing_pitch(roll: Roll, phase: ArrayLike) -> Array:
    """Angle by which the toes point up after the strike, radians: strike · (1 - u)³ (1 + u).

    The time u = phase / flat goes from 0 to 1, when the sole is flat.

    Examples
    --------
    >>> roll = Roll(0.1, 0.3, 0.5, 0.6, 20.0, (0, 10, 40))
    >>> np.degrees(landing_pitch(roll, [0.0, 0.05, 0.2])).round(2)
    array([20.  ,  3.75,  0.  ])
    """
    u = np.clip(np.asarray(phase) / roll.flat, 0, 1)
    return np.asarray(np.radians(roll.strike) * (1 - u) ** 3 * (1 + u))


def rising_pitch(roll: Roll, phase: ArrayLike) -> Array:
    """Angle by which the toes point up from heel off to lift, radians (below 0), by a cubic spline.

    Examples
    --------
    >>> roll = Roll(0.1, 0.3, 0.5, 0.6, 20.0, (0, 10, 40))
    >>> np.degrees(rising_pitch(roll, [0.2, 0.6])).round(2) + 0.0
    array([  0., -40.])
    """
    knots = np.linspace(roll.heel_off, roll.lift, len(roll.heel_rise))
    curve = CubicSpline(knots, -np.radians(roll.heel_rise), bc_type=((1, 0.0), (2, 0.0)))
    return np.asarray(curve(np.clip(phase, knots[0], knots[-1])))


def _sole(yaw: Array, pitch: ArrayLike, ahead: float, up: float) -> Array:
    """Vector that is `ahead` and `up` in a foot turned by `yaw`, its toes raised by `pitch`."""
    level = ahead * np.cos(pitch) - up * np.sin(pitch)
    rise = ahead * np.sin(pitch) + up * np.cos(pitch) + np.zeros_like(yaw)
    return np.stack([level * np.sin(yaw), rise, level * np.cos(yaw)], axis=-1)


def about_ball(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Position of the ankle while the ball stands still; if the sole is flat it is above `place`."""
    ball = _sole(yaw, 0.0, foot.instep, foot.ball)
    ball[:, [0, 2]] += place
    return np.asarray(ball + _sole(yaw, pitch, -foot.instep, foot.ankle - foot.ball))


def about_heel(place: Array, yaw: Array, pitch: Array, foot: Foot) -> Array:
    """Position of the ankle while the heel stands still; if the sole is flat it is above `place`."""
    heel = _sole(yaw, 0.0, -foot.heel, 0.0)
    heel[:, [0, 2]] += place
    return np.asarray(heel + _sole(yaw, pitch, foot.heel, foot.ankle))


def ball_of(plant: Footplant, foot: Foot) -> Array:
    """Position (3,) of the ball of a planted foot, metres."""
    toes = np.array([np.sin(plant.yaw), np.cos(plant.yaw)])
    x, z = plant.position + foot.instep * toes
    return np.array([x, foot.ball, z])


def pitch_for_leg(hip: Array, plant: Footplant, length: ArrayLike, foot: Foot) -> Array:
    """Pitch at which a foot on its ball leaves a leg its length.

    The ankle moves on a circle of radius r about the ball. Seen from the ball, the hip is X ahead, Y up and Z
    to the side, D = √(X² + Y² + Z²), and the ankle is in the direction φ from the toes, so that

        ℓ² = r² + D² - 2 r (X cos φ + Y sin φ).

    Parameters
    ----------
    hip : shape (F, 3), metres.
    plant : the footplant.
    length : ℓ, from hip to ankle, metres, a number or (F,).
    foot : its shape.

    Returns
    -------
    Radians, (F,), below 0 with the heel up; the nearest possible if there is none.
    """
    toes = np.array([np.sin(plant.yaw), np.cos(plant.yaw)])
    from_ball = hip - ball_of(plant, foot)
    ahead = from_ball[:, [0, 2]] @ toes
    up = from_ball[:, 1]
    squares = (from_ball**2).sum(axis=-1)
    radius = np.hypot(foot.instep, foot.ankle - foot.ball)
    cosine = (radius**2 + squares - np.square(length)) / (2 * radius * np.hypot(ahead, up))
    direction = np.arctan2(up, ahead) + np.arccos(np.clip(cosine, -1, 1))
    return np.asarray(direction - np.arctan2(foot.ankle - foot.ball, -foot.instep))


def ball_height(ankle: Array, pitch: Array, foot: Foot) -> Array:
    """Height of the ball of a foot, metres, (F,), from its ankle (F, 3) and pitch (F,)."""
    down = (foot.ankle - foot.ball) * np.cos(pitch)
    return np.asarray(ankle[:, 1] + foot.instep * np.sin(pitch) - down)


def toe_angle(ankle: Array, pitch: Array, foot: Foot, clearance: ArrayLike = 0.0) -> Array:
    """Angle of the toes, radians: as the foot's, unless their tip would be lower than `clearance` metres."""
    missing = foot.ball - ball_height(ankle, pitch, foot) + np.asarray(clearance)
    floor = np.arcsin(np.clip(missing / foot.toe, -1, 1))
    return np.asarray(np.maximum(pitch, floor))
