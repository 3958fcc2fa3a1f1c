"""Random input and answers, right and wrong, for `18-motion-matching.toml`."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Mask


def standardised(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() * weight
    return np.asarray(scaled)


def draw_standardise(rng: np.random.Generator) -> tuple[Array, list[slice], list[float]]:
    """Draw columns whose spreads differ within a group, and between groups by a hundred."""
    sizes = rng.integers(2, 5, rng.integers(2, 4))
    stops = np.cumsum(sizes)
    groups = [slice(int(stop - size), int(stop)) for size, stop in zip(sizes, stops, strict=True)]
    spreads = np.concatenate([10 ** rng.uniform(-1, 1) * rng.uniform(0.3, 3, size) for size in sizes])
    values = rng.normal(scale=spreads, size=(int(rng.integers(20, 40)), int(stops[-1]))) + 3 * spreads
    return values, groups, [float(weight) for weight in rng.uniform(0.3, 0.8, len(sizes))]


def spring(x: float, v: float, goal: float, halflife: float, t: float) -> float:
    pull = 2 * np.log(2) / halflife
    gap = x - goal
    return float(goal + (gap + (v + gap * pull) * t) * np.exp(-pull * t))


def next_frame(costs: Array, usable: Mask, now: int, near: int, bonus: float) -> int:
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - now) >= near))
    best = int(candidates[costs[candidates].argmin()])
    return now if costs[best] + bonus >= costs[now] else best


def draw_next_frame(rng: np.random.Generator) -> tuple[Array, Mask, int, int, float]:
    """Draw a trap: an unusable frame or a neighbour is nearest, or the bonus decides."""
    count, near, bonus = int(rng.integers(30, 60)), int(rng.integers(3, 6)), float(rng.uniform(0.2, 0.6))
    costs, usable = rng.uniform(1.5, 9, count), rng.random(count) < 0.7
    now = int(rng.integers(near, count - near))
    gaps = np.abs(np.arange(count) - now)
    far = np.flatnonzero(gaps >= near)
    usable[rng.choice(far, 6, replace=False)] = True
    trap = int(rng.integers(5))
    if trap == 0:  # the nearest is not usable
        other = int(rng.choice(far))
        usable[other], costs[other] = False, 0.01
    elif trap == 1:  # the nearest is a neighbour
        beside = int(rng.choice(np.flatnonzero((gaps > 0) & (gaps < near))))
        usable[beside], costs[beside] = True, 0.01
    else:  # to play on costs a little more than the best, a little less, or much less
        more = {2: rng.uniform(0.2, 0.8), 3: -rng.uniform(0.2, 0.8), 4: -1.5}[trap]
        costs[now] = costs[usable & (gaps >= near)].min() + more * bonus
    return costs, usable, now, near, bonus
