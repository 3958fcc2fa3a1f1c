"""Checks of notebook 18."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.course.check import Check, Mistake


def _scaled(values: Array, groups: Sequence[slice], weights: Sequence[float], how: str = "") -> Array:
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        deviation = group.std(axis=0).mean()
        if how == "flat":
            deviation = group.std()
        elif how == "variance":
            deviation = group.var(axis=0).mean()
        scaled[:, columns] = group / deviation * (1 / weight if how == "weight" else weight)
    return np.asarray(scaled)


def _own_scales(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    scaled = (values - values.mean(axis=0)) / values.std(axis=0)
    for columns, weight in zip(groups, weights, strict=True):
        scaled[:, columns] *= weight
    return np.asarray(scaled)


def _one_scale(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    scaled = (values - values.mean(axis=0)) / values.std(axis=0).mean()
    for columns, weight in zip(groups, weights, strict=True):
        scaled[:, columns] *= weight
    return np.asarray(scaled)


def _uncentred(values: Array, groups: Sequence[slice], weights: Sequence[float]) -> Array:
    scaled = values.copy()
    for columns, weight in zip(groups, weights, strict=True):
        scaled[:, columns] *= weight / values[:, columns].std(axis=0).mean()
    return scaled


def _draw_standardise(rng: np.random.Generator) -> tuple[Array, list[slice], list[float]]:
    """Draw columns whose spreads differ within a group, and between groups by a hundred."""
    sizes = rng.integers(2, 5, rng.integers(2, 4))
    stops = np.cumsum(sizes)
    groups = [slice(int(stop - size), int(stop)) for size, stop in zip(sizes, stops, strict=True)]
    spreads = np.concatenate([10 ** rng.uniform(-1, 1) * rng.uniform(0.3, 3, size) for size in sizes])
    values = rng.normal(scale=spreads, size=(int(rng.integers(20, 40)), int(stops[-1]))) + 3 * spreads
    return values, groups, [float(weight) for weight in rng.uniform(0.3, 0.8, len(sizes))]


standardise = Check(
    name="standardise",
    asks="an array of the same shape: the mean taken off, and each group of columns in its own scale",
    start="values[:, columns].std(axis=0) gives one deviation for each column of a group.",
    draw=_draw_standardise,
    truth=_scaled,
    mistakes=[
        Mistake(
            _own_scales,
            "each column has its own scale: one that hardly varies is blown up. Use one scale for a group.",
        ),
        Mistake(
            _one_scale, "all groups share one scale: metres and metres per second are not yet comparable."
        ),
        Mistake(_uncentred, "the mean of each column is still there; take it off first."),
        Mistake(
            lambda values, groups, weights: _scaled(values, groups, weights, "weight"),
            "the weights work the wrong way round: a larger weight must make its group's numbers larger.",
        ),
        Mistake(
            lambda values, groups, weights: _scaled(values, groups, weights, "variance"),
            "you divide by the variance; its root, the standard deviation, has the unit of the numbers.",
        ),
        Mistake(
            lambda values, groups, weights: _scaled(values, groups, weights, "flat"),
            "that is the deviation of all numbers of a group together; "
            "take the mean of its columns' deviations.",
        ),
        Mistake(
            lambda values, groups, weights: _scaled(values, groups, [1.0] * len(groups)),
            "the weights are not used yet.",
        ),
    ],
)


def _spring(x: float, v: float, goal: float, halflife: float, t: float) -> float:
    pull = 2 * np.log(2) / halflife
    gap = x - goal
    return float(goal + (gap + (v + gap * pull) * t) * np.exp(-pull * t))


def _half_damped(x: float, v: float, goal: float, halflife: float, t: float) -> float:
    return _spring(x, v, goal, 2 * halflife, t)


def _without_pull(x: float, v: float, goal: float, halflife: float, t: float) -> float:
    gap = x - goal
    return float(goal + (gap + v * t) * np.exp(-2 * np.log(2) / halflife * t))


spring_after = Check(
    name="spring_after",
    asks="one number: where the spring is after t seconds",
    start="the formula has four parts: y from the half-life, j0 and j1 from the start, and what is left.",
    draw=lambda rng: (
        *(float(number) for number in rng.uniform(0.5, 3, 3) * rng.choice([-1, 1], 3)),
        float(rng.uniform(0.1, 0.5)),
        float(rng.uniform(0.05, 0.4)),
    ),
    truth=_spring,
    mistakes=[
        Mistake(
            lambda x, v, goal, halflife, t: goal + (x - goal) * 2 ** (-t / halflife),
            "that is plain decay: it forgets the velocity, and starts with a jolt.",
        ),
        Mistake(
            lambda x, v, goal, halflife, t: _spring(x, 0.0, goal, halflife, t),
            "the velocity at the start is left out.",
        ),
        Mistake(_half_damped, "y is 2 ln 2 / h; yours is half of that."),
        Mistake(_without_pull, "j1 is v + j0 y: the spring pulls from the start."),
        Mistake(
            lambda x, v, goal, halflife, t: _spring(x, v, 0.0, halflife, t),
            "it ends at 0: j0 is the gap to the goal, and the goal is added at the end.",
        ),
        Mistake(
            lambda x, v, goal, halflife, t: _spring(x, v, goal, halflife, t) - goal,
            "that is the gap that is left; add the goal.",
        ),
    ],
)


def _next_frame(costs: Array, usable: Mask, now: int, near: int, bonus: float, how: str = "") -> int:  # noqa: PLR0913, PLR0917 (how wrong it is)
    bonus = {"no bonus": 0.0, "wrong way": -bonus}.get(how, bonus)
    frames = np.arange(len(costs))
    may = np.ones(len(costs), bool) if how == "all" else usable.copy()
    if how != "neighbours":
        may &= np.abs(frames - now) >= near
    candidates = frames[may]
    place = int(costs[candidates].argmin())
    best = int(candidates[place])
    if how != "always" and costs[best] + bonus >= costs[now]:
        return now
    return place if how == "among" else best


def _draw_next_frame(rng: np.random.Generator) -> tuple[Array, Mask, int, int, float]:
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


def _why(how: str, hint: str) -> Mistake:
    return Mistake(
        lambda costs, usable, now, near, bonus: _next_frame(costs, usable, now, near, bonus, how),
        hint,
    )


next_frame = Check(
    name="next_frame",
    asks="the number of a frame, a whole number; now means to play on",
    start="which frames may be chosen? np.where(may, costs, np.inf) leaves the others out.",
    draw=_draw_next_frame,
    truth=_next_frame,
    mistakes=[
        _why("all", "you also choose frames that are not usable: their future is not known."),
        _why("neighbours", "frames fewer than `near` from now may not be chosen: that would be no cut."),
        _why("no bonus", "the bonus is not used yet: another frame must be better by more than that."),
        _why("wrong way", "the bonus works the wrong way round: it must make cuts rarer."),
        _why(
            "among",
            "that is a place among the frames that may be chosen; return the number of the frame itself.",
        ),
        _why("always", "you always cut; play on where no other frame is better by more than the bonus."),
    ],
)
