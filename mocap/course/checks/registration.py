"""Random input and answers, right and wrong, for `15-registration.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Points


def draw_next_row(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw what is known of the row above, with cells that no path has reached, and a row of costs."""
    diagonal = rng.uniform(1, 5, 8)
    diagonal[rng.integers(0, 8, 2)] = np.inf
    best = np.minimum(diagonal, rng.uniform(1, 5, 8))
    best[0] = diagonal[0]
    return diagonal, best, rng.uniform(0, 2, 8)


def shifted(row: Array) -> Array:
    return np.append(np.inf, row[:-1])


def right_from_any(diagonal: Array, best: Array, costs: Array) -> Array:
    now = 2 * costs + shifted(best)
    least = np.minimum(now, costs + diagonal)
    for column in range(1, len(costs)):
        least[column] = min(least[column], costs[column] + least[column - 1])
    return np.array([now, least])


def row_after(diagonal: Array, best: Array, costs: Array) -> Array:
    now = 2 * costs + shifted(best)
    return np.array([now, np.minimum(np.minimum(now, costs + diagonal), costs + shifted(now))])


def draw_ground_step(rng: np.random.Generator) -> tuple[float, complex, Array, Points, Array]:
    turns = rng.uniform(-3, 3, 3) + np.array([np.zeros(3), rng.normal(0, 0.4, 3)])
    moves = np.asarray(rng.normal(size=(3, 2)) @ [0.1, 0.1j], complex)
    place = complex(*rng.normal(size=2))
    return float(rng.uniform(-3, 3)), place, turns, moves, rng.dirichlet(np.ones(3))


def step(
    heading: float, place: complex, turns: Array, moves: Points, weights: Array
) -> tuple[float, complex]:
    after = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + after)
    return after, complex(place + weights @ (np.exp(1j * angles) * moves))


def pace(slopes: Array, weights: Array) -> float:
    return float(weights @ slopes / weights.sum())
