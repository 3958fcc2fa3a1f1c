"""The timing of a walk: distance, phase, vigour and gait, frame by frame.

There are three: steady, changing from one gait into another, and with halts. A change mixes the figures of
both gaits by weights that add up to one.

People slow down in curves and keep their cadence, so their steps get shorter. With the speed w on a straight
line and the turn rate ω = κ v (rad/s, κ: curvature of the path) their speed is v (1 + τ ω) = w, hence

    v = 2 w / (1 + √(1 + 4 τ κ w)).

The time τ is fitted to captured strides by `figures/walking_sheet.py`: 0.40 s for subject 16 of the CMU
Graphics Lab Motion Capture Database (1.14 m/s straight, 0.93 at 26°/s, 0.84 at 51°/s), 0.13 and 0.04 s for
two persons from other sources. The walk's `turning` is between, 0.3 s. People turn on the spot by 150°/s.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from walking.footsteps import SmoothPath
from walking.gait import Gait, mix
from walking.walking_body import FPS

Stage = tuple[float, float, float]

PAD = 4.0  # seconds planned before the first frame and after the last: every foot needs a next step
FASTEST_TURN = 2.5  # rad/s
ACCELERATION = 1.3  # m/s²: before and after tight turns
GRID = 0.01  # metres of a path between two limits of speed
HOLD = 0.2  # phase after the last strike at which the clock of one who stands rests: both soles are flat
SOFT_TIME = 0.1  # seconds: the smoothing of distance and phase


class Timing(NamedTuple):
    """The timing of all frames, and of `PAD` seconds before and after them.

    `times` (F,) in seconds, `phase` (F,) in cycles, `distance` (F,) along the path in metres. `vigour` (F,)
    scales the movements: 1 as in the gait's tables, 0 while standing. `weights` (gaits, F) of the `gaits` add
    up to one. `skipped` lists the strikes (phases) that a halt leaves out.
    """

    times: Array
    phase: Array
    distance: Array
    vigour: Array
    weights: Array
    gaits: tuple[Gait, ...]
    skipped: Array

    @property
    def inside(self) -> slice:
        """The frames without the `PAD` seconds before and after."""
        return slice(round(PAD * FPS), len(self.times) - round(PAD * FPS))

    def weights_at(self, phase: float) -> Array:
        """Weights (gaits,) of the gaits at a phase."""
        return np.array([np.interp(phase, self.phase, weight) for weight in self.weights])


def speed_in_curve(speed: Array, bend: Array, turning: float) -> Array:
    """Speed of people in a curve, m/s: v = 2 w / (1 + √(1 + 4 τ κ w)), and ω ≤ 2.5 rad/s.

    Parameters
    ----------
    speed : w, on a straight line, m/s.
    bend : κ, 1/m.
    turning : τ, seconds.

    Examples
    --------
    >>> speed_in_curve(np.array([1.2]), np.array([1.0]), 0.3).round(2)
    array([0.94])
    """
    slowed = 2 * speed / (1 + np.sqrt(1 + 4 * turning * bend * speed))
    return np.asarray(np.minimum(slowed, FASTEST_TURN / np.maximum(bend, 1e-6)))


def speed_limits(path: SmoothPath, speed: float, turning: float) -> Array:
    """Speeds, m/s, at every centimetre of a path, of a walker with a given speed on a straight line.

    They are those of `speed_in_curve`, and change by no more than 1.3 m/s².
    """
    along = np.arange(0, path.length + GRID, GRID)
    heading = gaussian_filter1d(path.heading(along), 2.0)
    bend = np.abs(np.gradient(heading, GRID))
    limits = speed_in_curve(np.full_like(along, speed), bend, turning)
    squares = limits**2
    gain = 2 * ACCELERATION * GRID  # of the square of a speed, from a centimetre to the next
    for grid in range(1, len(squares)):
        squares[grid] = min(squares[grid], squares[grid - 1] + gain)
    for grid in range(len(squares) - 2, -1, -1):
        squares[grid] = min(squares[grid], squares[grid + 1] + gain)
    return np.asarray(np.sqrt(squares))


def drift(rng: np.random.Generator, times: Array, count: int) -> Array:
    """Draw `count` smooth noises of unit size, shape (F, count), from sines with periods of 2 to 11 s."""
    periods = rng.uniform(2.0, 11.0, (6, count))
    starts = rng.uniform(0.0, 2 * np.pi, (6, count))
    waves = np.sin(2 * np.pi * times[:, None, None] / periods + starts)
    return np.asarray(waves.sum(axis=1) / np.sqrt(3))


class _Course(NamedTuple):
    """Targets, frame by frame: speed on a straight line (m/s), strides per second, weights (gaits, F)."""

    speed: Array
    rate: Array
    weights: Array


def _course(gaits: tuple[Gait, ...], speed: Array, weights: Array, rng: np.random.Generator) -> _Course:
    """Choose the cadence for a speed, and vary both a little: a slower walk has shorter and fewer steps."""
    wander = drift(rng, np.arange(len(speed)) / FPS, 2)
    varied = speed * (1 + 0.02 * wander[:, 0])
    step = mix([gait.step_at(varied) for gait in gaits], weights)
    return _Course(varied, varied / (2 * step) * (1 + 0.01 * wander[:, 1]), weights)


def _advance(course: _Course, fractions: Array, length: float) -> Array:
    """Walk along a path: metres from the start, (F,); the walk ends where the path ends.

    `fractions` (gaits, S) are speeds at every centimetre as fractions of those on a straight line.
    """
    distances = [0.0]
    last = fractions.shape[1] - 1
    for speed, weights in zip(course.speed, course.weights.T, strict=True):
        grid = min(int(distances[-1] / GRID), last)
        distances.append(distances[-1] + float(speed * (weights @ fractions[:, grid])) / FPS)
        if distances[-1] > length:
            break
    return np.array(distances[:-1])


def _extended(values: Array, slope: float) -> Array:
    """Add `PAD` seconds before and after, which go on as values do at the ends times `slope`, and smooth."""
    frames = np.arange(1, round(PAD * FPS) + 1)
    earlier = values[0] - slope * frames[::-1] * (values[1] - values[0])
    later = values[-1] + slope * frames * (values[-1] - values[-2])
    return np.asarray(gaussian_filter1d(np.concatenate([earlier, values, later]), SOFT_TIME * FPS))


def _padded(gaits: tuple[Gait, ...], course: _Course, distance: Array) -> Timing:
    """Make the timing of a walk that goes on before its first frame and after its last."""
    frames = len(distance)
    phase = np.concatenate([[0.0], np.cumsum(course.rate[: frames - 1])]) / FPS
    phase = _extended(phase, 1.0)
    distance = _extended(distance, 1.0)
    weights = np.stack([_extended(weight[:frames], 0.0) for weight in course.weights])
    times = (np.arange(len(phase)) - round(PAD * FPS)) / FPS
    strides = np.gradient(distance) / np.gradient(phase)  # metres
    usual = mix([2 * gait.step for gait in gaits], weights)
    vigour = np.sqrt(gaussian_filter1d(np.clip(strides / usual, 0.1, 1.5), 0.2 * FPS))
    return Timing(times, phase, distance, vigour, weights, gaits, np.empty(0))


def steady(gait: Gait, path: SmoothPath, speed: float | None, rng: np.random.Generator) -> Timing:
    """Walk along a path in one gait.

    `speed` in metres per second is kept also in curves; without it the walker has the gait's own speed, and
    slows down in curves.
    """
    target = gait.speed if speed is None else speed
    limits = speed_limits(path, target, gait.turning) / target if speed is None else np.ones(1)
    longest = round(1.5 * FPS * (1 + path.length / target / limits.mean()))
    course = _course((gait,), np.full(longest, target), np.ones((1, longest)), rng)
    return _padded((gait,), course, _advance(course, limits[None], path.length))


def changing(
    gaits: tuple[Gait, Gait], path: SmoothPath, stages: Sequence[Stage], rng: np.random.Generator
) -> Timing:
    """Change from one gait into another and back.

    Parameters
    ----------
    gaits : the two.
    path : it goes straight on beyond its end.
    stages : (second, metres per second on a straight line, weight of the second gait), in the order of time;
        values between two stages are interpolated and smoothed.
    rng : draws the small differences.
    """
    moments, speeds, shares = np.array(stages).T
    times = np.arange(round(moments[-1] * FPS) + 1) / FPS
    speed = gaussian_filter1d(np.interp(times, moments, speeds), 0.2 * FPS)
    share = gaussian_filter1d(np.interp(times, moments, shares), 0.2 * FPS)
    course = _course(gaits, speed, np.stack([1 - share, share]), rng)
    limits = [speed_limits(path, gait.speed, gait.turning) / gait.speed for gait in gaits]
    return _padded(gaits, course, _advance(course, np.stack(limits), np.inf))


def halting(gait: Gait, path: SmoothPath, strides: Sequence[float], rests: Sequence[float]) -> Timing:
    """Stand, walk, stand, and so on. During a halt the phase rests; after it one step is left out.

    `strides` counts the strides between the halts, multiples of 1/2; `rests` gives the seconds of each halt,
    one number more.
    """
    closing = np.concatenate([[0.0], np.cumsum(strides)])  # the strikes that put the feet side by side
    hold = closing + HOLD
    rate = gait.speed / (2 * gait.step)
    arrive = (hold - hold[0]) / rate + np.concatenate([[0.0], np.cumsum(rests[:-1])])
    times = np.arange(round((arrive[-1] + rests[-1]) * FPS) + 1) / FPS
    knots = np.stack([arrive, arrive + np.asarray(rests)], axis=-1).ravel()
    phase = _extended(np.interp(times, knots, np.repeat(hold, 2)), 0.0)
    moving = np.zeros_like(phase)
    for start, stop in pairwise(closing):  # the pelvis arrives one step earlier
        speeding_up = quintic_step((phase - start - 0.4) / 0.9)
        slowing_down = quintic_step((stop - 0.5 + gait.under - phase) / 0.8)
        moving += speeding_up * slowing_down
    limits = speed_limits(path, gait.speed, gait.turning) / gait.speed
    pace = 2 * gait.step * moving * np.gradient(phase) * FPS
    course = _Course(pace, pace, np.ones((1, len(phase))))
    distance = _advance(course, limits[None], np.inf)
    vigour = gaussian_filter1d(np.sqrt(moving), 0.1 * FPS)
    padded = (np.arange(len(phase)) - round(PAD * FPS)) / FPS
    return Timing(padded, phase, distance, vigour, course.weights, (gait,), closing + 0.5)
