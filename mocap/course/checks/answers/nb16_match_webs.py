"""Notebook 16: inputs, right answers and mistakes of `spread` and `neighbour_weights`."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from math import isclose
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments
from mocap.course.checks.inputs import Links, MatchesOf, found_near

# ---- spread


def draw_spread(rng: np.random.Generator) -> Arguments:
    """Link eight motions in a chain, and some of them across, both ways."""
    links: Links = {number: [] for number in range(10)}
    order = rng.permutation(8).tolist()
    chain = list(pairwise(order))
    across = [(chain[n][0], chain[n + 2][1]) for n in range(0, 5, 2)]
    for source, target in [*chain, *across]:
        for start, end in ((source, target), (target, source)):
            for _ in range(2):
                cost = round(float(rng.uniform(1, 5)), 3)
                links[start].append((cost, end, int(rng.integers(-2, 3))))
    return 10 * order[0], partial(found_near, links, []), partial(isclose, abs_tol=4)


def right_spread(query: int, matches_of: MatchesOf, is_same: Callable[[int, int], bool]) -> list[int]:
    """Ask what is like a query, then what is like each new find, the cheapest first, until nothing is new."""
    matches = [query]
    asking = [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _, match in new:
            if not any(is_same(match, match_before) for match_before in matches):
                matches.append(match)
                asking.append(match)
    return matches


def same_spread(answer: Any, wanted: list[int]) -> bool:  # noqa: ANN401
    """Check whether two lists of frames are equal."""
    return list(answer) == list(wanted)


def mistake_single_step(query: int, matches_of: MatchesOf, is_same: Callable[[int, int], bool]) -> object:
    """Return the query and its own new matches, without those of the matches."""
    matches = [query]
    asking = [query]
    if asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _, match in new:
            if not any(is_same(match, match_before) for match_before in matches):
                matches.append(match)
                asking.append(match)
    return matches


def mistake_without_query(query: int, matches_of: MatchesOf, is_same: Callable[[int, int], bool]) -> object:
    """Return the right matches without the query."""
    return right_spread(query, matches_of, is_same)[1:]


def mistake_query_twice(query: int, matches_of: MatchesOf, is_same: Callable[[int, int], bool]) -> object:
    """Compare a find with all matches but the query, which can therefore be found again."""
    matches = [query]
    asking = [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _, match in new:
            if not any(is_same(match, match_before) for match_before in matches[1:]):
                matches.append(match)
                asking.append(match)
    return matches


def mistake_farthest_first(query: int, matches_of: MatchesOf, is_same: Callable[[int, int], bool]) -> object:
    """Take the finds of each step by falling cost, so that of two similar ones the farther is kept."""
    matches = [query]
    asking = [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: -pair[0])
        asking = []
        for _, match in new:
            if not any(is_same(match, match_before) for match_before in matches):
                matches.append(match)
                asking.append(match)
    return matches


# ---- neighbour_weights


def draw_neighbour_weights(rng: np.random.Generator) -> Arguments:
    """Draw sorted distances; now and then the first one is 0."""
    distances = np.sort(rng.uniform(0.1, 5, rng.integers(3, 7)))
    if rng.random() < 0.3:
        distances[0] = 0
    return (distances,)


def normalised(weights: Array) -> Array:
    """Divide weights by their sum; those of which one is infinite become NaN or 0."""
    with np.errstate(invalid="ignore"):
        return np.asarray(weights / weights.sum())


def inverses(distances: Array) -> Array:
    """Return 1 / d, infinite for a sample at distance 0."""
    with np.errstate(divide="ignore"):
        return np.asarray(1 / distances)


def hit_gets_all(distances: Array, weights: Array) -> Array:
    """Return the weights 1, 0, 0, ... if the first sample has the distance 0, and else the right ones."""
    return np.eye(len(distances))[0] if distances[0] == 0 else weights


def right_neighbour_weights(distances: Array) -> Array:
    """Weigh samples by 1 / d - 1 / d_k; one that is hit gets all."""
    return hit_gets_all(distances, normalised(inverses(distances) - 1 / distances[-1]))


def mistake_hit_forgotten(distances: Array) -> object:
    """Return the normalised 1 / d - 1 / d_k, NaN for a sample at distance 0."""
    return normalised(inverses(distances) - 1 / distances[-1])


def mistake_last_not_subtracted(distances: Array) -> object:
    """Return the normalised 1 / d; a sample at distance 0 gets weight 1."""
    return hit_gets_all(distances, normalised(inverses(distances)))


def mistake_last_not_subtracted_hit_forgotten(distances: Array) -> object:
    """Return the normalised 1 / d, NaN for a sample at distance 0."""
    return normalised(inverses(distances))


def mistake_squared_distances(distances: Array) -> object:
    """Return the normalised 1 / d²; a sample at distance 0 gets weight 1."""
    return hit_gets_all(distances, normalised(inverses(distances**2)))


def mistake_squared_distances_hit_forgotten(distances: Array) -> object:
    """Return the normalised 1 / d², NaN for a sample at distance 0."""
    return normalised(inverses(distances**2))


def mistake_not_normalised(distances: Array) -> object:
    """Return 1 / d - 1 / d_k without dividing by the sum; a sample at distance 0 gets weight 1."""
    return hit_gets_all(distances, inverses(distances) - 1 / distances[-1])


def mistake_not_normalised_hit_forgotten(distances: Array) -> object:
    """Return 1 / d - 1 / d_k without dividing by the sum, infinite for a sample at distance 0."""
    return inverses(distances) - 1 / distances[-1]


def mistake_differences(distances: Array) -> object:
    """Return the normalised d_k - d; a sample at distance 0 gets weight 1."""
    return hit_gets_all(distances, normalised(distances[-1] - distances))


def mistake_differences_hit_forgotten(distances: Array) -> object:
    """Return the normalised d_k - d, also for a sample at distance 0."""
    return normalised(distances[-1] - distances)
