"""Checks of notebook 17."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Points
from mocap.course.check import Check, Mistake

Box = tuple[Array, Array]


def _draw_clips(rng: np.random.Generator) -> tuple[Points, Array, Array, float]:
    """Draw three walks that turn to different sides, seen from their bodies, and weights."""
    speeds = rng.uniform(0.5, 1.5, (3, 12)) + 1j * rng.uniform(-0.2, 0.2, (3, 12))
    turnings = rng.uniform(0.5, 2, (3, 12)) * np.array([[-1.0], [1.0], [0.3]])
    return speeds, turnings, rng.dirichlet(np.ones(3)), 0.1


def _integrated(speed: Points, turning: Array, dt: float, *, late: bool = False) -> Points:
    """Integrate one walk; with `late`, it turns before each step."""
    heading = np.concatenate([[0], np.cumsum(turning * dt)])
    way = speed * np.exp(1j * (heading[1:] if late else heading[:-1])) * dt
    return np.concatenate([[0], np.cumsum(way)])


def _mixed(speeds: Points, turnings: Array, weights: Array, dt: float) -> Points:
    return _integrated(weights @ speeds, weights @ turnings, dt)


def _mix_world(speeds: Points, turnings: Array, weights: Array, dt: float) -> Points:
    """Mix velocities over the ground, which is the same as to mix places."""
    ways = [_integrated(speed, turning, dt) for speed, turning in zip(speeds, turnings, strict=True)]
    return np.asarray(weights @ np.array(ways))


def _likeliest(speeds: Points, turnings: Array, weights: Array, dt: float) -> Points:
    best = int(np.argmax(weights))
    return _integrated(speeds[best], turnings[best], dt)


def _same_places(given: Any, wanted: Points) -> bool:  # noqa: ANN401
    """Compare complex numbers to 8 digits."""
    try:
        return np.shape(given) == wanted.shape and np.allclose(np.asarray(given, complex), wanted, rtol=1e-8)
    except (TypeError, ValueError):
        return False


mixed_way = Check(
    name="mixed_way",
    asks="the places (T + 1,) on the ground, as complex numbers, the first of them 0",
    start="mix speeds and turnings by `weights @ ...`; then the heading in each frame is a sum of turnings.",
    draw=_draw_clips,
    truth=_mixed,
    same=_same_places,
    mistakes=[
        Mistake(
            _mix_world,
            "that mixes places, or velocities over the ground: walks to opposite sides cancel. "
            "Mix what the bodies feel, then integrate once.",
        ),
        Mistake(
            lambda speeds, turnings, weights, dt: _integrated(
                weights @ speeds, weights @ turnings, dt, late=True
            ),
            "the body turns before each step: the heading of frame 0 is 0.",
        ),
        Mistake(
            lambda speeds, turnings, weights, dt: _integrated(weights @ speeds, 0 * turnings[0], dt),
            "the way never turns: each velocity points along the heading at that moment, exp(1j · heading).",
        ),
        Mistake(_likeliest, "that is the clip with the largest weight alone; all of them count."),
        Mistake(
            lambda speeds, turnings, weights, dt: _mixed(speeds, turnings, weights, dt)[1:],
            "the first place is 0, before the first step: there is one place more than steps.",
        ),
    ],
)


def _draw_targets(rng: np.random.Generator) -> tuple[Array, Array, Array, float]:
    """Draw good targets in degrees and m/s, and bad ones near a side of them."""
    scale = np.array([60.0, 0.4])
    good = rng.uniform([-50, 0.7], [50, 1.3], (12, 2))
    low, high = good.min(axis=0), good.max(axis=0)
    bad = rng.uniform(low + 0.05 * (high - low), high - 0.05 * (high - low), (3, 2))
    return good, bad, scale, 0.01


def _shrunk(  # noqa: PLR0913 (each mistake changes one of them)
    good: Array,
    bad: Array,
    scale: Array,
    eps: float,
    *,
    choose: Callable[[Array], Any] = np.argmin,
    shares: bool = True,
    off: bool = True,
) -> Box:
    low, high = good.min(axis=0), good.max(axis=0)
    room = eps * scale if off else 0 * scale
    for sample in bad:
        if ((sample > low - room) & (sample < high + room)).all():
            lost = np.concatenate([sample - low, high - sample]) / np.tile(
                scale if shares else 1 + 0 * scale, 2
            )
            side = int(choose(lost))
            axis = side % len(low)
            if side < len(low):
                low[axis] = sample[axis] + room[axis]
            else:
                high[axis] = sample[axis] - room[axis]
    return low, high


def _cut_all(good: Array, bad: Array, scale: Array, eps: float) -> Box:
    """Move the nearer side of every axis."""
    low, high = good.min(axis=0), good.max(axis=0)
    for sample in bad:
        if ((sample > low - eps * scale) & (sample < high + eps * scale)).all():
            nearer = sample - low < high - sample
            low = np.where(nearer, sample + eps * scale, low)
            high = np.where(nearer, high, sample - eps * scale)
    return low, high


shrink_box = Check(
    name="shrink_box",
    asks="two corners, low (d,) and high (d,)",
    start="begin with good.min(axis=0) and good.max(axis=0). Which of four sides loses least by a bad one?",
    draw=_draw_targets,
    truth=_shrunk,
    mistakes=[
        Mistake(
            lambda good, bad, scale, eps: (good.min(axis=0), good.max(axis=0)),
            "that is the box of the good ones; bad ones are still inside it.",
        ),
        Mistake(_cut_all, "one side is enough to get a bad one out; you move one on every axis."),
        Mistake(
            lambda good, bad, scale, eps: _shrunk(good, bad, scale, eps, shares=False),
            "degrees and m/s are compared as they are: divide each loss by its scale first.",
        ),
        Mistake(
            lambda good, bad, scale, eps: _shrunk(good, bad, scale, eps, off=False),
            "the bad one lies on the new side: keep eps · scale off it.",
        ),
        Mistake(
            lambda good, bad, scale, eps: _shrunk(good, bad, scale, eps, choose=np.argmax),
            "you move the side that loses most; move the one that loses least.",
        ),
    ],
)


def _draw_samples(rng: np.random.Generator) -> tuple[float, Array, Array, Array, int]:
    at = np.sort(rng.uniform(-75, 75, 9))
    low, high = at - rng.uniform(20, 60, 9), at + rng.uniform(20, 60, 9)
    return float(rng.uniform(-60, 60)), at, low, high, int(rng.integers(3, 6))


def _weighed(
    shares: Callable[[Array], Array],
) -> Callable[[float, Array, Array, Array, int], tuple[float, float]]:
    """Look a box up by some shares of the k smallest gaps."""

    def look_up(
        asked: float, at: NDArray[np.float64], low: Array, high: Array, k: int
    ) -> tuple[float, float]:
        gaps = np.abs(at - asked)
        near = np.argsort(gaps)[:k]
        weights = shares(gaps[near])
        return float(weights @ low[near]), float(weights @ high[near])

    return look_up


def _ratio(raw: Array) -> Array:
    return np.asarray(raw / raw.sum())


box_at = Check(
    name="box_at",
    asks="two numbers: the low and the high end of the box",
    start="find the k smallest of np.abs(at - asked), and weigh them as in notebook 16.",
    draw=_draw_samples,
    truth=_weighed(lambda gaps: _ratio(1 / gaps - 1 / gaps[-1])),
    mistakes=[
        Mistake(
            _weighed(lambda gaps: _ratio(1 / gaps)),
            "the k-th neighbour still weighs something; take 1/ε_k off, or the box jumps.",
        ),
        Mistake(
            _weighed(lambda gaps: _ratio(1 / gaps - 1 / gaps[0])),
            "you take the nearest one's 1/ε off, so that the nearest has no say; take the farthest one's.",
        ),
        Mistake(
            _weighed(lambda gaps: 1 / gaps - 1 / gaps[-1]),
            "the weights do not add up to 1; divide by their sum.",
        ),
        Mistake(
            _weighed(lambda gaps: _ratio(gaps)),
            "the farthest weighs most: take 1/ε, not ε.",
        ),
        Mistake(
            _weighed(lambda gaps: np.eye(len(gaps))[0]),
            "that is the nearest sample's box; between two samples the box must move from one to the other.",
        ),
    ],
)
