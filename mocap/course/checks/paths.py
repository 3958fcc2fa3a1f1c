"""Checks of notebook 08."""

from collections.abc import Callable
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.ground_path import GroundPath
from mocap.course.check import Check, Mistake

Line = Callable[[Array], Array]


def _polyline(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))


def _cost(track: Array, path: Line, along: float, steps: Array) -> tuple[float, float]:
    reached = along + np.cumsum(steps)
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def _steps(track: Array) -> Array:
    return np.asarray(np.hypot(*np.diff(track, axis=0).T))


def _unsquared(track: Array, path: Line, along: float, least: float) -> tuple[float, float]:
    reached = along + np.cumsum(np.maximum(_steps(track), least))
    return float(np.hypot(*(track[1:] - path(reached)).T).sum()), float(reached[-1])


def _draw_edge_cost(rng: np.random.Generator) -> tuple[Array, Line, float, float]:
    line = GroundPath(_polyline(rng))
    track = rng.normal(scale=0.05, size=(rng.integers(4, 12), 2)).cumsum(axis=0)
    return track, line.at, float(rng.uniform(0, line.length)), float(rng.uniform(0.02, 0.06))


edge_cost = Check(
    name="edge_cost",
    asks="the sum of Eq. 9 over the edge's frames, and s at the edge's end",
    start="np.diff gives the steps; make each at least `least`; add them up from `along`; then measure.",
    draw=_draw_edge_cost,
    truth=lambda track, path, along, least: _cost(track, path, along, np.maximum(_steps(track), least)),
    mistakes=[
        Mistake(
            lambda track, path, along, least: _cost(track, path, along, _steps(track)),
            "the least progress is missing: a walk that stands still would cost little and stand for ever.",
        ),
        Mistake(
            lambda track, path, along, least: _cost(track, path, along, _steps(track) + least),
            "you add the least progress to every step; it is a minimum: take the larger of the two.",
        ),
        Mistake(
            lambda track, path, along, least: _cost(track, path, 0.0, np.maximum(_steps(track), least)),
            "s starts at 0 in each of your edges; it must continue from `along`, where the walk is.",
        ),
        Mistake(
            lambda track, path, along, least: (
                _cost(track, path, along, np.maximum(_steps(track), least))[0] / (len(track) - 1),
                _cost(track, path, along, np.maximum(_steps(track), least))[1],
            ),
            "that is a mean; Eq. 9 is a sum, so that long edges cost more than short ones.",
        ),
        Mistake(_unsquared, "you sum distances; Eq. 9 sums their squares."),
    ],
)


def _survivors(stand: Indices, costs: Array, width: int, columns: int = 4) -> Indices:
    order = np.argsort(costs)
    _, first = np.unique(stand[order, :columns], axis=0, return_index=True)
    return np.asarray(order[np.sort(first)[:width]])


def _beam_first(stand: Indices, costs: Array, width: int) -> Indices:
    order = np.argsort(costs)[:width]
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return np.asarray(order[np.sort(first)])


def _first_come(stand: Indices, costs: Array, width: int) -> Indices:
    _, first = np.unique(stand, axis=0, return_index=True)
    return np.asarray(first[np.argsort(costs[first])][:width])


def _draw_survivors(rng: np.random.Generator) -> tuple[Indices, Array, int]:
    count = int(rng.integers(30, 60))
    return rng.integers(0, 2, size=(count, 4)), rng.permutation(count) / 100, int(rng.integers(3, 7))


survivors = Check(
    name="survivors",
    asks="the indices of the walks that go on, the cheapest first",
    start="sort by cost; np.unique(..., axis=0, return_index=True) finds the first of each kind of row.",
    draw=_draw_survivors,
    truth=_survivors,
    mistakes=[
        Mistake(
            lambda stand, costs, width: np.argsort(costs)[:width],
            "that is the beam alone: of walks that stand alike, keep only the cheapest.",
        ),
        Mistake(
            lambda stand, costs, width: _survivors(stand, costs, len(costs)),
            "that is dominance alone: only `width` walks may go on.",
        ),
        Mistake(
            _beam_first,
            "you fill the beam with walks that stand alike: apply dominance first.",
        ),
        Mistake(_first_come, "of walks that stand alike, you keep the first in the list, not the cheapest."),
        Mistake(
            lambda stand, costs, width: _survivors(stand, costs, width, 3),
            "walks that are turned differently do not stand alike: the last column counts as well.",
        ),
        Mistake(
            lambda stand, costs, width: np.sort(_survivors(stand, costs, width)),
            "these are the right walks; put the cheapest first.",
        ),
    ],
)


Walk = tuple[complex, complex, float, float]
Edge = tuple[int, Points, complex, complex, float]
Longer = list[tuple[int, complex, complex, float, float]]


def _draw_walk(rng: np.random.Generator) -> tuple[Walk, list[Edge], Line, float]:
    """Draw where a walk is, the edges that leave its node, a path, and the least progress per frame."""
    line = GroundPath(_polyline(rng))
    (x, z), along = line.at(0.4 * line.length), 0.4 * line.length
    walk = (complex(_turn(rng)), complex(z, x), along, float(rng.uniform(0.1, 2)))
    edges = []
    for end in rng.permutation(9)[: rng.integers(2, 5)].tolist():
        track = (rng.normal(scale=0.05, size=(rng.integers(3, 9), 2)) @ [1, 1j]).cumsum()
        move = complex(*rng.normal(size=2))
        edges.append((end, track, complex(_turn(rng)), move, float(rng.choice([0.0, 0.3]))))
    return walk, edges, line.at, 0.01


def _turn(rng: np.random.Generator) -> complex:
    return complex(np.exp(1j * rng.uniform(-3, 3)))


def _lengthen(
    walk: Walk, edges: list[Edge], path: Line, least: float, place: Callable[..., Points] | None = None
) -> Longer:
    """Lengthen a walk by each edge; `place` lays the edge's track on the ground, right by default."""
    turn, move, along, cost = walk
    longer = []
    for end, track, edge_turn, edge_move, price in edges:
        placed = place(turn, track, move) if place else turn * track + move
        steps = np.maximum(np.abs(np.diff(placed)), least)
        more, reached = _cost(np.stack([placed.imag, placed.real], axis=1), path, along, steps)
        longer.append((end, turn * edge_turn, move + turn * edge_move, reached, cost + more + price))
    return longer


def _changed(change: Callable[[Walk, Edge, tuple[Any, ...]], tuple[Any, ...]]) -> Callable[..., Longer]:
    """Make the wrong answer in which each longer walk is changed."""

    def wrong(walk: Walk, edges: list[Edge], path: Line, least: float) -> Longer:
        right = _lengthen(walk, edges, path, least)
        return [change(walk, edge, one) for edge, one in zip(edges, right, strict=True)]

    return wrong


def _same_walks(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare longer walks as complex numbers; their ends are numbers of nodes here."""
    here, there = np.asarray(given, complex), np.asarray(wanted, complex)
    return here.shape == there.shape and bool(np.allclose(here, there, rtol=1e-8, atol=1e-9))


lengthen = Check(
    name="lengthen",
    asks="for each edge a tuple (end, turn, move, along, cost) of the longer walk",
    start="place the edge's track by p ↦ turn · p + move, and give it to edge_cost as rows (x, z).",
    draw=_draw_walk,
    truth=_lengthen,
    same=_same_walks,
    mistakes=[
        Mistake(
            lambda walk, edges, path, least: _lengthen(
                walk, edges, path, least, lambda turn, track, move: track
            ),
            "an edge's track is in the coordinates of its clip: place it by turn · track + move first.",
        ),
        Mistake(
            lambda walk, edges, path, least: _lengthen(
                walk, edges, path, least, lambda turn, track, move: 1j * np.conj(turn * track + move)
            ),
            "x and z are swapped: a point is z + ix, so its x is the imaginary part.",
        ),
        Mistake(
            _changed(lambda walk, edge, one: (*one[:2], walk[1] + edge[3], *one[3:])),
            "the edge's shift is seen from its clip, which is turned: add turn · move of the edge.",
        ),
        Mistake(
            _changed(lambda walk, edge, one: (one[0], walk[0], *one[2:])),
            "the turn stays as it was: a transition turns the clip that it leads to, by the edge's turn.",
        ),
        Mistake(
            _changed(lambda walk, edge, one: (*one[:4], one[4] - walk[3])),
            "that is the cost of the edge alone; a walk costs what it has cost so far, and the edge's cost.",
        ),
        Mistake(
            _changed(lambda walk, edge, one: (*one[:4], one[4] - edge[4])),
            "the price of the edge is missing: a seam costs something wherever it lies.",
        ),
        Mistake(
            lambda walk, edges, path, least: _lengthen((*walk[:2], 0.0, walk[3]), edges, path, least),
            "the edge starts at `along`, where the walk is on the path, not at its beginning.",
        ),
        Mistake(
            _changed(lambda walk, edge, one: (*one[:3], one[3] - walk[2], one[4])),
            "`along` is measured from the path's beginning: edge_cost gives the new one, not the difference.",
        ),
    ],
)
