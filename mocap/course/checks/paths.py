"""Checks of notebook 08."""

from collections.abc import Callable

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body.ground_path import GroundPath
from mocap.course.check import Check, Mistake

Line = Callable[[Array], Array]


def _polyline(rng: np.random.Generator) -> Array:
    return np.asarray(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))


def _at(points: Array, along: Array, knots: Array) -> Array:
    return np.stack([np.interp(along, knots, axis) for axis in points.T], axis=-1)


def _lengths(points: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def _nearest_corner(points: Array, along: Array) -> Array:
    return np.asarray(points[np.abs(_lengths(points) - along[:, None]).argmin(axis=1)])


def _draw_point_at(rng: np.random.Generator) -> tuple[Array, Array]:
    points = _polyline(rng)
    return points, rng.uniform(-0.2, 1.2, 12) * _lengths(points)[-1]


point_at = Check(
    name="point_at",
    asks="the points (n, 2) at `along` metres along the line; beyond an end, that end",
    start="how far along is each corner? Take 0 and np.cumsum of the pieces' lengths; then use np.interp.",
    draw=_draw_point_at,
    truth=lambda points, along: _at(points, along, _lengths(points)),
    mistakes=[
        Mistake(
            lambda points, along: _at(points, along, np.linspace(0, _lengths(points)[-1], len(points))),
            "you treat the corners as evenly spaced; the pieces of a line differ in length.",
        ),
        Mistake(
            lambda points, along: _at(points[1:], along, _lengths(points)[1:]),
            "the first corner lies 0 m along: it is missing from your lengths.",
        ),
        Mistake(
            lambda points, along: _at(points[:-1], along, _lengths(points)[1:]),
            "you are one corner late: the first corner lies 0 m along.",
        ),
        Mistake(_nearest_corner, "that is the nearest corner; between two corners, interpolate."),
        Mistake(
            lambda points, along: _at(
                points,
                along,
                np.concatenate([[0.0], np.cumsum(np.sum(np.diff(points, axis=0) ** 2, axis=1))]),
            ),
            "your lengths are squared: a square root is missing.",
        ),
    ],
)


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
