"""Checks of notebook 05."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake


def _matches(rng: np.random.Generator) -> tuple[Array, float]:
    """Draw the distances of some matches, and the probability that the successor leaves them."""
    return rng.uniform(100, 400, rng.integers(1, 9)), float(rng.choice([0.5, 1.0]))


def _with_odds(rng: np.random.Generator) -> tuple[Array, Array]:
    costs, left = _matches(rng)
    odds = rng.uniform(0.1, 1, len(costs))
    return costs, left * odds / odds.sum()


def _chain(rng: np.random.Generator) -> tuple[Array, int]:
    """Draw the probabilities of going from segment to segment, some without successor, and a length."""
    count = int(rng.integers(3, 9))
    odds = rng.random((count, count)) * (rng.random((count, count)) < 0.5)
    odds[rng.integers(count)] = 0
    return odds / np.maximum(odds.sum(axis=1, keepdims=True), 1e-9), int(rng.integers(2, 9))


def _alive(probabilities: Array, steps: int) -> Array:
    """Give, for each start, the probability that this many steps can be taken."""
    return np.asarray(np.linalg.matrix_power(probabilities, steps).sum(axis=1))


inverse_shares = Check(
    name="inverse_shares",
    asks="the probability of each match: smaller for a larger D, and `left` in all",
    start="a match with half the distance should be taken twice as often: start with 1 / costs.",
    draw=_matches,
    truth=lambda costs, left: left / costs / np.sum(1 / costs),
    mistakes=[
        Mistake(
            lambda costs, left: left * costs / np.sum(costs),
            "in proportion to D, the worst match is taken most often: that is the slip to fix.",
        ),
        Mistake(
            lambda costs, left: 1 / costs / np.sum(1 / costs),
            "these add up to 1, but the successor may have taken half: share only `left`.",
        ),
        Mistake(lambda costs, left: left / costs, "these do not add up to `left`: divide by their sum."),
        Mistake(lambda costs, left: 1 / costs, "these do not add up to `left`: divide by their sum."),
        Mistake(
            lambda costs, left: left * (1 - costs / np.sum(costs)),
            "1 - D / ΣD falls with D, but with n matches it adds up to n - 1, and a single match gets 0.",
        ),
    ],
)

expected_seam = Check(
    name="expected_seam",
    asks="the mean D of the matches that are taken",
    start="weight each D by its probability; then think of the walks that take no match at all.",
    draw=_with_odds,
    truth=lambda costs, probabilities: np.sum(costs * probabilities) / np.sum(probabilities),
    mistakes=[
        Mistake(
            lambda costs, probabilities: np.sum(costs * probabilities),
            "where the successor takes half, the probabilities add up to ½: divide by their sum.",
        ),
        Mistake(
            lambda costs, probabilities: np.mean(costs),
            "this is the mean if all matches are equally likely; here the likelier ones count more.",
        ),
        Mistake(
            lambda costs, probabilities: np.mean(costs * probabilities),
            "the probabilities already replace 1 / n: take the sum, and divide it by their sum.",
        ),
        Mistake(
            lambda costs, probabilities: costs[np.argmax(probabilities)],
            "that is the likeliest match alone; the others are taken too.",
        ),
    ],
)

chance_to_last = Check(
    name="chance_to_last",
    asks="the probability that a walk from a random start has `count` segments",
    start="with one segment every walk is there: begin with a vector of ones, and take a step: P @ alive.",
    draw=_chain,
    truth=lambda probabilities, count: _alive(probabilities, count - 1).mean(),
    mistakes=[
        Mistake(
            lambda probabilities, count: _alive(probabilities, count).mean(),
            "a walk of `count` segments takes count - 1 steps: the start is the first segment.",
        ),
        Mistake(
            lambda probabilities, count: 1 - _alive(probabilities, count - 1).mean(),
            "that is the probability that the walk ends before.",
        ),
        Mistake(
            lambda probabilities, count: np.sum(probabilities ** (count - 1), axis=1).mean(),
            "** raises each number by itself; two steps are the matrix product P @ P.",
        ),
        Mistake(
            lambda probabilities, count: _alive(probabilities, count - 1)[0],
            "that is for walks from segment 0; the start is random, each equally likely.",
        ),
        Mistake(
            lambda probabilities, count: np.mean(probabilities.any(axis=1)) ** (count - 1),
            "walks do not come to all segments equally often: follow the probabilities, step by step.",
        ),
    ],
)
