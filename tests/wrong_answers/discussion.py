import numpy as np


def all_alike(costs):
    return sum(costs) / len(costs)


def the_cheapest(costs):
    return min(costs)


def as_in_the_homework(costs):
    odds = costs / costs.sum()
    return odds @ costs


def no_probabilities(costs):
    return float((1 / costs) @ costs)


def half_of_it(costs):
    odds = 1 / costs / sum(1 / costs)
    return 0.5 * (odds @ costs)


def one_product(costs):
    odds = 1 / costs / sum(1 / costs)
    return (odds * costs)[0]


def entry_by_entry(odds, steps):
    return np.mean((odds**steps).sum(axis=1))


def those_that_die(odds, steps):
    return 1 - np.mean(np.linalg.matrix_power(odds, steps).sum(axis=1))


def added_up(odds, steps):
    return np.linalg.matrix_power(odds, steps).sum()


def to_a_power(odds, steps):
    return np.mean(odds.sum(axis=1)) ** steps


def never_moves(odds, steps):
    return np.mean(odds.sum(axis=1) ** steps)


def one_short(odds, steps):
    share = np.ones(len(odds))
    for _ in range(steps - 1):
        share = odds @ share
    return share.mean()


def unpaired(before, after):
    return [np.percentile(before, q) - np.percentile(after, q) for q in (25, 50, 75)]


def the_wrong_way(before, after):
    return np.quantile(after - before, [0.25, 0.5, 0.75])


def in_ones(before, after):
    return np.percentile(before - after, [0.25, 0.5, 0.75])


def sorted_first(before, after):
    return np.percentile(np.sort(before) - np.sort(after), [25, 50, 75])


def median_alone(before, after):
    return np.median(before - after)


WRONG = {
    "expected_cost": [
        (all_alike, "the cheap ones more often"),
        (the_cheapest, "does not always take the cheapest"),
        (as_in_the_homework, "must be to 1 / cost"),
        (no_probabilities, "no probability yet"),
        (half_of_it, "not which one"),
        (one_product, "of one transition"),
    ],
    "alive": [
        (entry_by_entry, "matrix power multiplies matrices"),
        (those_that_die, "the share that dies"),
        (added_up, "over all starts"),
        (to_a_power, "evenly spread"),
        (never_moves, "the walk moves on"),
        (one_short, "one step too few"),
    ],
    "paired_gain": [
        (unpaired, "Subtract first"),
        (the_wrong_way, "other way round"),
        (in_ones, "25, not 0.25"),
        (sorted_first, "breaks the pairs"),
        (median_alone, "that is the median"),
    ],
}
