"""Random input and answers, right and wrong, of exercises about windows that are alike."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist, squareform

from mocap._shared.arrays import Array, Mask, Points
from mocap.body.planar import PlanarTransform
from mocap.matching.minima import local_minima
from mocap.matching.point_clouds import align

# ---- Notebook 02


def clouds(rng: np.random.Generator) -> tuple[Array, Array]:
    """Make a cloud, and the same cloud turned and moved; two times in three also changed a little.

    One cloud in four is turned by half a turn, and one in four not at all.
    """
    points = rng.normal(size=(int(rng.integers(5, 12)), 3)) + rng.normal(size=3) * 3
    angle = rng.choice([0.0, np.pi, *rng.uniform(-np.pi, np.pi, 2)])
    moved = PlanarTransform(angle, *rng.normal(size=2)).apply_points(points)
    return points, moved + rng.normal(size=points.shape) * rng.choice([0.0, 0.1, 0.1])


def turned(points: Array, angle: float) -> Array:
    """Turn points about the vertical."""
    return PlanarTransform(angle, 0.0, 0.0).apply_points(points)


def parts(points: Array, others: Array) -> tuple[float, float]:
    """Give Σ (x z' - x' z) and Σ (x x' + z z') without centring."""
    (x, _, z), (other_x, _, other_z) = points.T, others.T
    return float((x * other_z - other_x * z).sum()), float((x * other_x + z * other_z).sum())


def centred(points: Array, others: Array) -> tuple[float, float]:
    """Give the same sums of two clouds, each about its mean."""
    return parts(points - points.mean(0), others - others.mean(0))


# ---- Notebook 02b


def diagonal_sums(products: Array, window: int) -> Array:
    """Add up products[i + f, j + f] over a window's frames, as far as a window fits."""
    rows, columns = (count - window + 1 for count in products.shape)
    return np.asarray(np.sum([products[f : f + rows, f : f + columns] for f in range(window)], axis=0))


def inside(grid: Array, found: NDArray[np.intp]) -> set[tuple[int, int]]:
    """Keep the places that are not on the border of a grid."""
    last = np.array(grid.shape) - 1
    return {(int(r), int(c)) for r, c in found[((found > 0) & (found < last)).all(axis=1)]}


# ---- Notebook 02c


def joined_numbers(points: Array) -> Array:
    """Join heights and distances from the window's middle, over the root of the number of points."""
    heights, ground = points[..., 1], points[..., [0, 2]]
    radii = np.linalg.norm(ground - ground.mean(axis=(0, 1)), axis=-1)
    return np.asarray(np.concatenate([heights.ravel(), radii.ravel()]) / np.sqrt(heights.size))


# ---- Notebook 15


Stood = tuple[float, complex]


def draw_next_row(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw what is known of the row above, with cells that no path has reached, and a row of costs."""
    diagonal = rng.uniform(1, 5, 8)
    diagonal[rng.integers(0, 8, 2)] = np.inf
    best = np.minimum(diagonal, rng.uniform(1, 5, 8))
    best[0] = diagonal[0]
    return diagonal, best, rng.uniform(0, 2, 8)


def shifted(row: Array) -> Array:
    """Move a row by one place, with infinity before it."""
    return np.append(np.inf, row[:-1])


def row_after(diagonal: Array, best: Array, costs: Array) -> Array:
    """Give what is known of the next row of a path's costs: its last step not diagonal, and any."""
    now = 2 * costs + shifted(best)
    return np.array([now, np.minimum(np.minimum(now, costs + diagonal), costs + shifted(now))])


def draw_ground_step(rng: np.random.Generator) -> tuple[float, complex, Array, Points, Array]:
    """Draw a heading and a place, the turns and moves of three clips over a step, and weights."""
    turns = rng.uniform(-3, 3, 3) + np.array([np.zeros(3), rng.normal(0, 0.4, 3)])
    moves = np.asarray(rng.normal(size=(3, 2)) @ [0.1, 0.1j], complex)
    place = complex(*rng.normal(size=2))
    return float(rng.uniform(-3, 3)), place, turns, moves, rng.dirichlet(np.ones(3))


def step(heading: float, place: complex, turns: Array, moves: Points, weights: Array) -> Stood:
    """Go one step by the weighted turns; each move is turned by the mean of before and after."""
    after = heading - float(weights @ (turns[1] - turns[0]))
    angles = 0.5 * (turns[0] + heading) + 0.5 * (turns[1] + after)
    return after, complex(place + weights @ (np.exp(1j * angles) * moves))


# ---- Notebook 16


Pairs = list[tuple[float, int]]


MOST = 400  # calls of `matches_of`, far more than a right answer needs


class Matches:
    """What is like what: motions in clusters ten frames apart, some linked; found a little off each time."""

    def __init__(self, links: dict[int, list[tuple[float, int, int]]]) -> None:
        self.links, self.calls = links, 0

    def __call__(self, match: int) -> Pairs:
        """Give what is like a match, as pairs (cost, match)."""
        self.calls += 1
        if self.calls > MOST:
            raise RecursionError(
                f"it has asked {MOST} times and does not end: what is found again, at nearly the same "
                "frames, is not new"
            )
        return [(cost, 10 * other + off) for cost, other, off in self.links[(match + 5) // 10]]


def same_frame(first: int, second: int) -> bool:
    """Say whether two frames are at most four apart."""
    return abs(first - second) <= 4


def draw_spread(rng: np.random.Generator) -> tuple[int, Matches, Callable[[int, int], bool]]:
    """Link eight motions in a chain, and some of them across, both ways."""
    links: dict[int, list[tuple[float, int, int]]] = {number: [] for number in range(10)}
    order = rng.permutation(8).tolist()
    chain = list(pairwise(order))
    for one, other in [*chain, *((chain[n][0], chain[n + 2][1]) for n in range(0, 5, 2))]:
        for here, there in ((one, other), (other, one)):
            for _ in range(2):
                cost = round(float(rng.uniform(1, 5)), 3)
                links[here].append((cost, there, int(rng.integers(-2, 3))))
    return 10 * order[0], Matches(links), same_frame


def spread(query: int, matches_of: Callable[[int], Pairs], same: Callable[[int, int], bool]) -> list[int]:
    """Ask what is like a query, then what is like each new find, the cheapest first, until nothing is new."""
    found, asking = [query], [query]
    while asking:
        new = sorted((pair for match in asking for pair in matches_of(match)), key=lambda pair: pair[0])
        asking = []
        for _cost, match in new:
            if not any(same(match, other) for other in found):
                found.append(match)
                asking.append(match)
    return found


def shares(distances: Array) -> Array:
    """Weigh samples by 1 / d - 1 / d_k; one that is hit gets all."""
    if distances[0] == 0:
        return np.asarray(np.eye(len(distances))[0])
    with np.errstate(all="ignore"):
        weights = 1 / distances - 1 / distances[-1]
        return np.asarray(weights / weights.sum())


def draw_neighbour_weights(rng: np.random.Generator) -> tuple[Array]:
    """Draw sorted distances; now and then the first one is 0."""
    distances = np.sort(rng.uniform(0.1, 5, rng.integers(3, 7)))
    if rng.random() < 0.3:
        distances[0] = 0
    return (distances,)
