"""Random input and answers, right and wrong, for `17-parametric-graphs.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Points

Box = tuple[Array, Array]


def draw_mixed_way(rng: np.random.Generator) -> tuple[Points, Array, Array, float]:
    """Draw three walks that turn to different sides, seen from their bodies, and weights."""
    speeds = rng.uniform(0.5, 1.5, (3, 12)) + 1j * rng.uniform(-0.2, 0.2, (3, 12))
    turnings = rng.uniform(0.5, 2, (3, 12)) * np.array([[-1.0], [1.0], [0.3]])
    return speeds, turnings, rng.dirichlet(np.ones(3)), 0.1


def integrated(speed: Points, turning: Array, dt: float) -> Points:
    heading = np.concatenate([[0], np.cumsum(turning * dt)])
    return np.concatenate([[0], np.cumsum(speed * np.exp(1j * heading[:-1]) * dt)])


def draw_shrink_box(rng: np.random.Generator) -> tuple[Array, Array, Array, float]:
    """Draw good targets in degrees and m/s, and bad ones near a side of them."""
    scale = np.array([60.0, 0.4])
    good = rng.uniform([-50, 0.7], [50, 1.3], (12, 2))
    low, high = good.min(axis=0), good.max(axis=0)
    bad = rng.uniform(low + 0.05 * (high - low), high - 0.05 * (high - low), (3, 2))
    return good, bad, scale, 0.01


def shrunk(good: Array, bad: Array, scale: Array, eps: float) -> Box:
    """Shrink the box of good samples until no bad one is left, each time by the side that loses least."""
    low, high = good.min(axis=0), good.max(axis=0)
    room = eps * scale
    for sample in bad:
        if ((sample > low - room) & (sample < high + room)).all():
            lost = np.array([(sample - low) / scale, (high - sample) / scale])
            side, axis = divmod(int(lost.argmin()), len(low))
            if side == 0:
                low[axis] = sample[axis] + room[axis]
            else:
                high[axis] = sample[axis] - room[axis]
    return low, high


def cut_all(good: Array, bad: Array, scale: Array, eps: float) -> Box:
    """Move the nearer side of every axis."""
    low, high = good.min(axis=0), good.max(axis=0)
    for sample in bad:
        if ((sample > low - eps * scale) & (sample < high + eps * scale)).all():
            nearer = sample - low < high - sample
            low = np.where(nearer, sample + eps * scale, low)
            high = np.where(nearer, high, sample - eps * scale)
    return low, high


def draw_box_at(rng: np.random.Generator) -> tuple[float, Array, Array, Array, int]:
    at = np.sort(rng.uniform(-75, 75, 9))
    low, high = at - rng.uniform(20, 60, 9), at + rng.uniform(20, 60, 9)
    return float(rng.uniform(-60, 60)), at, low, high, int(rng.integers(3, 6))


def weighed(asked: float, at: Array, low: Array, high: Array, k: int) -> tuple[float, float]:
    near = np.argsort(np.abs(at - asked))[:k]
    gaps = np.abs(at - asked)[near]
    weights = 1 / gaps - 1 / gaps[-1]
    weights = weights / weights.sum()
    return float(weights @ low[near]), float(weights @ high[near])
