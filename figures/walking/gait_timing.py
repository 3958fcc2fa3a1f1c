"""The timing of a walk: how far, in which phase, how vigorously, and in which gait, frame by frame.

There are three: steady, with halts, and changing from one gait into another. A change mixes the figures of
both gaits by weights that add up to one.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from walking.gait import Gait, mix
from walking.walking_body import FPS

Stage = tuple[float, float, float]

PAD = 4.0  # seconds planned before the first frame and after the last: every foot needs a next step


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

    def cut(self) -> Timing:
        """Cut off the `PAD` seconds before and after."""
        times, phase, distance, vigour, weights = (values[..., self.inside] for values in self[:5])
        return Timing(times, phase, distance, vigour, weights, self.gaits, self.skipped)


def steady(gait: Gait, speed: float, seconds: float, rng: np.random.Generator) -> Timing:
    """Walk in one gait at one speed, metres per second."""
    times = _times(seconds)
    return _walking(times, np.full_like(times, speed), (gait,), np.ones((1, len(times))), rng)


def changing(gaits: tuple[Gait, Gait], stages: Sequence[Stage], rng: np.random.Generator) -> Timing:
    """Change from one gait into another and back.

    Parameters
    ----------
    gaits : the two.
    stages : (second, metres per second, weight of the second gait), in the order of time; values between two
        stages are interpolated and smoothed.
    rng : draws the small differences.
    """
    moments, speeds, weights = np.array(stages).T
    times = _times(moments[-1])
    speed, weight = (gaussian_filter1d(np.interp(times, moments, v), 0.2 * FPS) for v in (speeds, weights))
    return _walking(times, speed, gaits, np.stack([1 - weight, weight]), rng)


def _times(seconds: float) -> Array:
    return np.arange(-round(PAD * FPS), round((seconds + PAD) * FPS) + 1) / FPS


def _walking(
    times: Array, speed: Array, gaits: tuple[Gait, ...], weights: Array, rng: np.random.Generator
) -> Timing:
    """Walk at a speed that varies by a few percent; a slower walk has shorter and fewer steps."""
    usual, cadence, stride = (
        mix([getattr(gait, name) for gait in gaits], weights) for name in ("speed", "cadence", "stride")
    )
    wander = drift(rng, times, 2)
    pace = np.maximum(speed + 0.06 * wander[:, 0], speed / 2)
    strides = cadence / 120 * (pace / usual) ** 0.2 * (1 + 0.03 * wander[:, 1])  # per second
    phase, distance = (np.cumsum(rate) / FPS for rate in (strides, pace))
    vigour = (pace / strides / stride) ** 0.25
    start = round(PAD * FPS)
    phase, distance = phase - phase[start], distance - distance[start]
    return Timing(times, phase, distance, vigour, weights, gaits, np.empty(0))


def halting(gait: Gait, strides: Sequence[float], rests: Sequence[float]) -> Timing:
    """Stand, walk, stand, and so on. During a halt the phase rests; after it one step is left out.

    `strides` counts the strides between the halts, multiples of 1/2; `rests` gives the seconds of each halt,
    one number more.
    """
    closing = np.concatenate([[0.0], np.cumsum(strides)])  # the strikes that put the feet side by side
    hold = closing + 0.3
    rate = gait.cadence / 120
    arrive = (hold - hold[0]) / rate + np.concatenate([[0.0], np.cumsum(rests[:-1])])
    times = _times(float(arrive[-1] + rests[-1]))
    knots = np.stack([arrive, arrive + np.asarray(rests)], axis=-1).ravel()
    phase = gaussian_filter1d(np.interp(times, knots, np.repeat(hold, 2)), 0.15 * FPS)
    moving = np.zeros_like(phase)
    for start, stop in pairwise(closing):  # the pelvis arrives one step earlier
        moving += quintic_step((phase - start - 0.4) / 0.9) * quintic_step(
            (stop - 0.5 + gait.under - phase) / 0.9
        )
    distance = 0.88 * gait.stride * np.cumsum(moving * np.gradient(phase))
    vigour = gaussian_filter1d(np.sqrt(moving), 0.1 * FPS)
    return Timing(times, phase, distance, vigour, np.ones((1, len(times))), (gait,), closing + 0.5)


def drift(rng: np.random.Generator, times: Array, count: int) -> Array:
    """Draw `count` smooth noises of unit size, shape (F, count), from sines with periods of 2 to 11 s."""
    periods = rng.uniform(2.0, 11.0, (6, count))
    starts = rng.uniform(0.0, 2 * np.pi, (6, count))
    waves = np.sin(2 * np.pi * times[:, None, None] / periods + starts)
    return np.asarray(waves.sum(axis=1) / np.sqrt(3))
