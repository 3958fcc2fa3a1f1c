"""Random input and answers, right and wrong, for `09b-blend-window.toml`."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array


def track(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(int(rng.integers(12, 40)), 3)).cumsum(axis=0))


def draw_added_jolt(rng: np.random.Generator) -> tuple[Array, Array, Array, Array, float]:
    """Draw tracks of a joint in two clips, and a blend of them with a little noise."""
    first = track(rng)
    second = first + rng.normal(size=first.shape).cumsum(axis=0)
    window = len(first) - 8
    alpha = np.concatenate([np.ones(4), 1 - np.arange(1, window + 1) / window, np.zeros(4)])
    mixed = alpha[:, None] * first + (1 - alpha[:, None]) * second
    return mixed + 0.1 * rng.normal(size=first.shape), first, second, alpha, float(rng.integers(24, 121))


def added(result: Array, first: Array, second: Array, alpha: Array) -> Array:
    """Second differences of a blend without the mean of those of its clips, (F - 2, 3)."""
    share = alpha[:, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    return np.asarray(changes[0] - share * changes[1] - (1 - share) * changes[2])


def largest(vectors: Array) -> float:
    return float(np.linalg.norm(vectors, axis=1).max())


def falling(rng: np.random.Generator) -> Array:
    """Draw weights that fall from nearly 1 to 0 and rarely pass 0.5 in the middle."""
    steps = np.arange(1, int(rng.integers(8, 60)) + 1)
    return (1 - steps / len(steps)) ** rng.uniform(1.5, 4)


def draw_reaction_time(rng: np.random.Generator) -> tuple[int, NDArray[np.intp], Array, float]:
    """Draw frames at which transitions leave, and a frame up to the last of them; sometimes one of them."""
    leaves = np.unique(rng.integers(0, 200, int(rng.integers(3, 12))))
    now = rng.choice(leaves) if rng.random() < 0.3 else rng.integers(0, leaves[-1] + 1)
    return int(now), leaves, falling(rng), float(rng.integers(24, 121))


def next_leave(asked: int, leaves: NDArray[np.intp]) -> int:
    return int(leaves[leaves >= asked].min())
