import numpy as np


def homework_odds(costs, left):
    return [left * cost / sum(costs) for cost in costs]


def odds_of_one(costs, left):
    odds = 1 / costs
    return odds / odds.sum()


def raw_odds(costs, left):
    return left * costs**-1.0


def complement(costs, left):
    return (1 - costs / costs.sum()) * left


def not_normed(costs, probabilities):
    return costs @ probabilities


def even_die(costs, probabilities):
    return costs.sum() / len(costs)


def mean_of_products(costs, probabilities):
    return (probabilities * costs).mean()


def likeliest(costs, probabilities):
    return max(zip(probabilities, costs, strict=True))[1]


def one_step_too_many(probabilities, count):
    alive = np.ones(len(probabilities))
    for _ in range(count):
        alive = probabilities @ alive
    return alive.mean()


def chance_to_end(probabilities, count):
    alive = np.ones(len(probabilities))
    for _ in range(count - 1):
        alive = probabilities @ alive
    return 1 - alive.sum() / len(alive)


def number_by_number(probabilities, count):
    return (probabilities ** (count - 1)).sum() / len(probabilities)


def from_the_first(probabilities, count):
    here = np.eye(len(probabilities))[0]
    for _ in range(count - 1):
        here = here @ probabilities
    return here.sum()


def share_of_dead_ends(probabilities, count):
    return np.mean(probabilities.sum(axis=1) > 0) ** (count - 1)


WRONG = {
    "inverse_shares": [
        (homework_odds, "the slip to fix"),
        (odds_of_one, "share only `left`"),
        (raw_odds, "divide by their sum"),
        (complement, "n - 1"),
    ],
    "expected_seam": [
        (not_normed, "add up to ½"),
        (even_die, "equally likely"),
        (mean_of_products, "already replace 1 / n"),
        (likeliest, "the others are taken too"),
    ],
    "chance_to_last": [
        (one_step_too_many, "count - 1 steps"),
        (chance_to_end, "ends before"),
        (number_by_number, "matrix product"),
        (from_the_first, "the start is random"),
        (share_of_dead_ends, "equally often"),
    ],
}
