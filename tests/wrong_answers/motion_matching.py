import math

import numpy as np


def by_columns(values, groups, weights, scale):
    """Centre, and divide column by column by what `scale` says of the group and the column."""
    result = np.empty_like(values)
    for columns, weight in zip(groups, weights, strict=True):
        for column in range(columns.start, columns.stop):
            numbers = values[:, column]
            result[:, column] = (numbers - numbers.mean()) * weight / scale(values[:, columns], numbers)
    return result


def deviations(group):
    return [math.sqrt(np.mean((column - column.mean()) ** 2)) for column in group.T]


def each_its_own(values, groups, weights):
    return by_columns(values, groups, weights, lambda group, numbers: numbers.std())


def one_for_all(values, groups, weights):
    return by_columns(values, groups, weights, lambda group, numbers: np.mean(deviations(values)))


def not_centred(values, groups, weights):
    result = values.copy()
    for columns, weight in zip(groups, weights, strict=True):
        result[:, columns] = values[:, columns] / np.mean(deviations(values[:, columns])) * weight
    return result


def divided_by_weights(values, groups, weights):
    return by_columns(
        values, groups, [1 / weight for weight in weights], lambda group, numbers: np.mean(deviations(group))
    )


def by_variance(values, groups, weights):
    return by_columns(values, groups, weights, lambda group, numbers: np.mean(np.square(deviations(group))))


def all_numbers_of_a_group(values, groups, weights):
    return by_columns(values, groups, weights, lambda group, numbers: (group - group.mean(axis=0)).std())


def no_weights(values, groups, weights):
    return by_columns(values, groups, [1] * len(weights), lambda group, numbers: np.mean(deviations(group)))


def decay(x, v, goal, halflife, t):
    return goal + (x - goal) * 0.5 ** (t / halflife)


def at_rest(x, v, goal, halflife, t):
    pull = math.log(4) / halflife
    return goal + (x - goal) * (1 + pull * t) * math.exp(-pull * t)


def half_the_damping(x, v, goal, halflife, t):
    pull = math.log(2) / halflife
    return goal + (x - goal + (v + (x - goal) * pull) * t) * math.exp(-pull * t)


def velocity_alone(x, v, goal, halflife, t):
    return goal + (x - goal + v * t) * math.exp(-math.log(4) / halflife * t)


def to_zero(x, v, goal, halflife, t):
    pull = math.log(4) / halflife
    return (x + (v + x * pull) * t) * math.exp(-pull * t)


def gap_alone(x, v, goal, halflife, t):
    pull = math.log(4) / halflife
    return (x - goal + (v + (x - goal) * pull) * t) * math.exp(-pull * t)


def choose(costs, now, bonus, frames):
    """Take the best of some frames by a loop, or play on."""
    best = min(frames, key=lambda frame: costs[frame])
    return best if costs[best] + bonus < costs[now] else now


def candidates(usable, now, near):
    return [frame for frame in range(len(usable)) if usable[frame] and abs(frame - now) >= near]


def all_frames(costs, usable, now, near, bonus):
    frames = [frame for frame in range(len(costs)) if abs(frame - now) >= near]
    return choose(costs, now, bonus, frames)


def neighbours_too(costs, usable, now, near, bonus):
    return choose(costs, now, bonus, np.flatnonzero(usable).tolist())


def bonus_forgotten(costs, usable, now, near, bonus):
    return choose(costs, now, 0.0, candidates(usable, now, near))


def bonus_for_cuts(costs, usable, now, near, bonus):
    return choose(costs, now, -bonus, candidates(usable, now, near))


def place_among_them(costs, usable, now, near, bonus):
    frames = candidates(usable, now, near)
    found = choose(costs, now, bonus, frames)
    return frames.index(found) if found != now else now


def always_cuts(costs, usable, now, near, bonus):
    return choose(costs, now, -math.inf, candidates(usable, now, near))


WRONG = {
    "standardise": [
        (each_its_own, "blown up"),
        (one_for_all, "share one scale"),
        (not_centred, "the mean of each column is still there"),
        (divided_by_weights, "the wrong way round"),
        (by_variance, "you divide by the variance"),
        (all_numbers_of_a_group, "all numbers of a group together"),
        (no_weights, "the weights are not used"),
    ],
    "spring_after": [
        (decay, "plain decay"),
        (at_rest, "the velocity at the start is left out"),
        (half_the_damping, "yours is half of that"),
        (velocity_alone, "the spring pulls from the start"),
        (to_zero, "it ends at 0"),
        (gap_alone, "add the goal"),
    ],
    "next_frame": [
        (all_frames, "not usable"),
        (neighbours_too, "that would be no cut"),
        (bonus_forgotten, "the bonus is not used"),
        (bonus_for_cuts, "it must make cuts rarer"),
        (place_among_them, "a place among the frames"),
        (always_cuts, "you always cut"),
    ],
}
