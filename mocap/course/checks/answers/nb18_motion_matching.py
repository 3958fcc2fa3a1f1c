"""Notebook 18: inputs, right answers and mistakes of `standardise`, `spring_after` and `next_frame`."""

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.course.checks.answers.common import Arguments
from mocap.methods.motion_matching.nearest_frames import spring

# ---- standardise


def draw_standardise(rng: np.random.Generator) -> Arguments:
    """Draw columns whose spreads differ within a group, and between groups by a hundred."""
    sizes = rng.integers(2, 5, rng.integers(2, 4))
    stops = np.cumsum(sizes)
    groups = [slice(int(stop - size), int(stop)) for size, stop in zip(sizes, stops, strict=True)]
    units = [10 ** rng.uniform(-1, 1) * rng.uniform(0.3, 3, size) for size in sizes]
    spreads = np.concatenate(units)
    values = rng.normal(scale=spreads, size=(int(rng.integers(20, 40)), int(stops[-1]))) + 3 * spreads
    return values, groups, [float(weight) for weight in rng.uniform(0.3, 0.8, len(sizes))]


def right_standardise(values: Array, groups: list[slice], weights: list[float]) -> Array:
    """Divide each group of columns by its mean spread, and weight it."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() * weight
    return np.asarray(scaled)


def mistake_scale_of_each_column(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each column by its own standard deviation."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0) * weight
    return scaled


def mistake_scale_of_all_groups(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each group by the mean standard deviation of the columns of all groups."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / centred.std(axis=0).mean() * weight
    return scaled


def mistake_mean_kept(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide and weight the groups without subtracting the columns' means."""
    scaled = values.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = values[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() * weight
    return scaled


def mistake_divided_by_weight(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each group by its weight instead of multiplying."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std(axis=0).mean() / weight
    return scaled


def mistake_variance(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each group by the mean variance of its columns."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.var(axis=0).mean() * weight
    return scaled


def mistake_deviation_of_all_numbers(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each group by the standard deviation of all its numbers together."""
    centred = values - values.mean(axis=0)
    scaled = centred.copy()
    for columns, weight in zip(groups, weights, strict=True):
        group = centred[:, columns]
        scaled[:, columns] = group / group.std() * weight
    return scaled


def mistake_weights_unused(values: Array, groups: list[slice], weights: list[float]) -> object:
    """Divide each group by its mean spread, with all weights 1."""
    return right_standardise(values, groups, [1.0] * len(groups))


# ---- spring_after


def draw_spring_after(rng: np.random.Generator) -> Arguments:
    """Draw a position, a velocity, a goal, the half-life of a spring, and a time."""
    x, v, goal = (float(number) for number in rng.uniform(0.5, 3, 3) * rng.choice([-1, 1], 3))
    halflife = float(rng.uniform(0.1, 0.5))
    return x, v, goal, halflife, float(rng.uniform(0.05, 0.4))


def right_spring_after(x: float, v: float, goal: float, halflife: float, t: float) -> float:
    """Return where a critically damped spring is after this time."""
    return float(spring(x, v, goal, halflife, t))


def mistake_plain_decay(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return goal + (x - goal) 2^(-t / halflife), an exponential decay without velocity."""
    return goal + (x - goal) * 2 ** (-t / halflife)


def mistake_velocity_dropped(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return the position of a spring that starts at rest."""
    return spring(x, 0.0, goal, halflife, t)


def mistake_half_of_decay(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return the position of a spring with y = ln 2 / halflife, half of the right decay rate."""
    return spring(x, v, goal, 2 * halflife, t)


def mistake_no_pull(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return the position of a spring with j₁ = v instead of v + j₀ y."""
    return spring(x, v - 2 * np.log(2) / halflife * (x - goal), goal, halflife, t)


def mistake_ends_at_zero(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return the position of a spring whose goal is 0."""
    return spring(x, v, 0.0, halflife, t)


def mistake_gap_alone(x: float, v: float, goal: float, halflife: float, t: float) -> object:
    """Return the position relative to the goal."""
    return right_spring_after(x, v, goal, halflife, t) - goal


# ---- next_frame


def draw_next_frame(rng: np.random.Generator) -> Arguments:
    """Draw so few frames that the best is often not usable, too near, just far enough, or hardly better."""
    count = int(rng.integers(12, 18))
    least_distance = int(rng.integers(2, 5))
    current = int(rng.integers(least_distance, count - least_distance))
    usable = rng.random(count) < 0.7
    usable[[0, -1]] = True  # of which one is far enough
    costs = rng.uniform(1.0, 3.0, count)
    costs[current] -= rng.integers(2)  # so that it is sometimes by far the best
    return costs, usable, current, least_distance, float(rng.uniform(0.2, 0.6))


def right_next_frame(costs: Array, usable: Mask, current: int, least_distance: int, bonus: float) -> int:
    """Go to the best usable frame that is not near, if it is better by more than the bonus."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - current) >= least_distance))
    best = int(candidates[costs[candidates].argmin()])
    return current if costs[best] + bonus >= costs[current] else best


def mistake_unusable_frames(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Choose the best frame that is not near, usable or not."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(np.abs(frames - current) >= least_distance)
    best = int(candidates[costs[candidates].argmin()])
    return current if costs[best] + bonus >= costs[current] else best


def mistake_near_frames(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Choose the best usable frame, near or not."""
    candidates = np.flatnonzero(usable)
    best = int(candidates[costs[candidates].argmin()])
    return current if costs[best] + bonus >= costs[current] else best


def mistake_exactly_near_excluded(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Choose the best usable frame more than `least_distance` frames away."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - current) > least_distance))
    best = int(candidates[costs[candidates].argmin()])
    return current if costs[best] + bonus >= costs[current] else best


def mistake_no_bonus(costs: Array, usable: Mask, current: int, least_distance: int, bonus: float) -> object:
    """Cut as soon as the best candidate has a lower cost than the current frame."""
    return right_next_frame(costs, usable, current, least_distance, 0.0)


def mistake_negative_bonus(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Cut even if the best candidate costs more than the current frame, by less than the bonus."""
    return right_next_frame(costs, usable, current, least_distance, -bonus)


def mistake_index_among_candidates(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Return the index of the best frame in the list of candidates."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - current) >= least_distance))
    best = int(candidates[costs[candidates].argmin()])
    return current if costs[best] + bonus >= costs[current] else int(costs[candidates].argmin())


def mistake_always_cuts(
    costs: Array, usable: Mask, current: int, least_distance: int, bonus: float
) -> object:
    """Return the best candidate, also if the current frame costs less."""
    frames = np.arange(len(costs))
    candidates = np.flatnonzero(usable & (np.abs(frames - current) >= least_distance))
    return int(candidates[costs[candidates].argmin()])
