"""A space of motions: blends of registered examples, sampled, to be asked for what they do [KG04]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, frozen
from mocap.blending.clocks import checked
from mocap.blending.mixing import mix
from mocap.blending.registering import Registration
from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.methods.match_webs.random_blends import random_weights

FPS = 30.0  # of the blends that are measured
Measure = Callable[[Motion], ArrayLike]
"""Reads one number or a few off a motion."""


@dataclass(frozen=True, eq=False, repr=False)
class MotionSpace:
    """Samples of what blends of examples do.

    registration : the C examples on one clock.
    weights : shape (N, C), of the samples; the first C are the examples themselves.
    values : shape (N, d), the measure of each sample.
    scale : shape (d,), how much of each number counts as far as one of the others.
    """

    registration: Registration
    weights: Array
    values: Array
    scale: Array

    def __post_init__(self) -> None:
        for key in ("weights", "values", "scale"):
            object.__setattr__(self, key, frozen(getattr(self, key), np.float64))

    def __repr__(self) -> str:
        examples, (samples, numbers) = self.weights.shape[1], self.values.shape
        return f"MotionSpace({examples} examples, {samples} samples of {numbers} numbers)"


def sample_space(
    registration: Registration, measure: Measure, *, count: int = 200, scale: ArrayLike | None = None
) -> MotionSpace:
    """Blend examples at random, and measure each blend: samples of a space of motions [KG04, sampling].

    What a blend does is no simple function of its weights: the hand of half of two punches is not half-way
    between their targets. So blends are made and measured. Where the samples are is what can be reached.

    Parameters
    ----------
    registration : the examples, from `blending.register`.
    measure : a function of a `Motion` that gives d numbers, such as `turn` or `hand_target`.
    count : of random blends, beside the examples. 0 leaves the examples alone.
    scale : shape (d,): amounts of each number that count as equally far, such as 10° and 0.1 m/s. By default
        the standard deviations of the samples' values.

    Returns
    -------
    The examples and `count` samples.

    Raises
    ------
    MocapError : for fewer than d + 1 examples, a measure that gives NaN, or now more and now fewer numbers,
        a count below 0, and a scale that is not d numbers above 0.

    Examples
    --------
    >>> from mocap.blending import registering
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.motion_measures import mean_speed
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> sample_space(registering.register(walks), mean_speed, count=10)
    MotionSpace(2 examples, 12 samples of 1 numbers)

    Notebook: 16-match-webs
    """
    if count < 0:
        raise MocapError(f"Take 0 samples or more, got {count}.")
    examples = np.eye(len(registration.clips))
    known = _measured(registration, measure, examples)
    weights = random_weights(known, count)
    values = np.concatenate([known, _measured(registration, measure, weights, known.shape[1])])
    width = values.std(axis=0)
    given = np.where(width > 0, width, 1.0) if scale is None else np.asarray(scale, float)
    if given.shape != width.shape or not (np.isfinite(given).all() and (given > 0).all()):
        raise MocapError(f"A scale is {len(width)} numbers above 0, got {shortened(str(given.tolist()))}.")
    return MotionSpace(registration, np.concatenate([examples, weights]), values, given)


def blend_of(registration: Registration, weights: ArrayLike, *, fps: float | None = None) -> Motion:
    """Blend registered clips as `blending.mix` does, by way of those alone whose weight is not 0.

    Parameters
    ----------
    registration : of C clips, such as that of a space.
    weights : shape (C,), such as from `weights_for`.
    fps : frames per second; the clips' own by default.

    Raises
    ------
    MocapError : for weights that are not C finite numbers or do not add up to one.

    Examples
    --------
    >>> from mocap.blending.registering import register
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(f"walk_5m_{speed}_0") for speed in (0.8, 1.1, 1.4)]
    >>> blend_of(register(walks), [0, 0.5, 0.5])
    Motion('walk + walk', 363 frames at 120 Hz, 38 joints)

    Notebook: 16-match-webs
    """
    return _mixed(registration, checked(weights, len(registration.clips)), fps, rounds=1)


def _mixed(registration: Registration, weights: Array, fps: float | None, rounds: int) -> Motion:
    some = np.flatnonzero(np.abs(weights) > 1e-9)
    few = replace(
        registration,
        clips=tuple(registration.clips[n] for n in some),
        reference=int(np.abs(weights[some]).argmax()),
        times=tuple(registration.times[n] for n in some),
        angles=tuple(registration.angles[n] for n in some),
        centres=tuple(registration.centres[n] for n in some),
        costs=registration.costs[some],
        contacts=tuple(
            match._replace(starts=match.starts[some], stops=match.stops[some])
            for match in registration.contacts
        ),
    )
    return mix(few, weights[some] / weights[some].sum(), fps=fps, rounds=rounds)


def _measured(registration: Registration, measure: Measure, rows: Array, numbers: int = 0) -> Array:
    """Measure the blends of some weights (M, C): shape (M, d)."""
    values: list[Array] = []
    for row in rows:
        value = np.atleast_1d(np.asarray(measure(_mixed(registration, row, FPS, rounds=0)), float))
        numbers = numbers or len(value)
        if value.shape != (numbers,) or not np.isfinite(value).all():
            got = shortened(str(value.tolist()))
            raise MocapError(f"A measure gives {numbers} finite numbers for each blend; this one gave {got}.")
        values.append(value)
    return np.reshape(values, (len(rows), numbers))
