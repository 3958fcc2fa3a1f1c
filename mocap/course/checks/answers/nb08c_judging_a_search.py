"""Notebook 08c: inputs, right answers and mistakes of `edge_cost` and `lengthen`."""

from collections.abc import Callable

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.body.ground_path import GroundPath
from mocap.course.checks.answers.common import Arguments

PathAt = Callable[[Array], Array]
"""From metres along a path to its points, shape (N, 2)."""

Walk = tuple[complex, complex, float, float]
"""A walk: rotation, translation, metres along the path, and cost."""

Edge = tuple[int, Points, complex, complex, float]
"""An edge: its end, its track, rotation, translation, and price."""

LongerWalk = tuple[int, complex, complex, float, float]
"""The node at the end of a walk, rotation, translation, metres along the path, and cost."""

# ---- edge_cost


def draw_edge_cost(rng: np.random.Generator) -> Arguments:
    """Draw the frames of an edge, a line, an arc length on the line, and the least step along it."""
    line = GroundPath(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))
    track = rng.normal(scale=0.05, size=(rng.integers(4, 12), 2)).cumsum(axis=0)
    return track, line.at, float(rng.uniform(0, line.length)), float(rng.uniform(0.02, 0.06))


def right_edge_cost(track: Array, path: PathAt, along: float, least_step: float) -> tuple[float, float]:
    """Add up Eq. 9 over the points of a track, and say how far along the path it has come."""
    reached = along + np.cumsum(np.maximum(np.hypot(*np.diff(track, axis=0).T), least_step))
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def mistake_no_least_progress(track: Array, path: PathAt, along: float, least_step: float) -> object:
    """Advance along the path by the steps' own lengths, with no minimum."""
    reached = along + np.cumsum(np.hypot(*np.diff(track, axis=0).T))
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def mistake_least_progress_added(track: Array, path: PathAt, along: float, least_step: float) -> object:
    """Advance along the path by each step's length plus `least_step`."""
    reached = along + np.cumsum(np.hypot(*np.diff(track, axis=0).T) + least_step)
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def mistake_starts_at_zero(track: Array, path: PathAt, along: float, least_step: float) -> object:
    """Compare the edge with the start of the path: s counts from 0 instead of `along`."""
    reached = np.cumsum(np.maximum(np.hypot(*np.diff(track, axis=0).T), least_step))
    return float(np.sum((track[1:] - path(reached)) ** 2)), float(reached[-1])


def mistake_mean_of_frames(track: Array, path: PathAt, along: float, least_step: float) -> object:
    """Return the mean of the squared distances, with the right arc length."""
    cost, along = right_edge_cost(track, path, along, least_step)
    return cost / (len(track) - 1), along


def mistake_distances(track: Array, path: PathAt, along: float, least_step: float) -> object:
    """Return the sum of the distances in metres, with the right arc length."""
    reached = along + np.cumsum(np.maximum(np.hypot(*np.diff(track, axis=0).T), least_step))
    distances = np.hypot(*(track[1:] - path(reached)).T)
    return float(distances.sum()), float(reached[-1])


# ---- lengthen


def draw_lengthen(rng: np.random.Generator) -> Arguments:
    """Draw where a walk is, the edges that leave its node, a path, and the least progress per frame."""
    line = GroundPath(rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0))
    along = 0.4 * line.length
    x, z = line.at(along)
    rotation = complex(np.exp(1j * rng.uniform(-3, 3)))
    walk = (rotation, complex(z, x), along, float(rng.uniform(0.1, 2)))
    edges = []
    for end in rng.permutation(9)[: rng.integers(2, 5)].tolist():
        track = (rng.normal(scale=0.05, size=(rng.integers(3, 9), 2)) @ [1, 1j]).cumsum()
        translation = complex(*rng.normal(size=2))
        rotation = complex(np.exp(1j * rng.uniform(-3, 3)))
        edges.append((end, track, rotation, translation, float(rng.choice([0.0, 0.3]))))
    return walk, edges, line.at, 0.01


def lengthened(walk: Walk, edge: Edge, path: PathAt, least_step: float) -> LongerWalk:
    """Lengthen a walk by one edge: its end, transform, arc length and cost."""
    rotation, translation, along, cost = walk
    end, track, edge_rotation, edge_translation, price = edge
    placed = rotation * track + translation
    reached = along + np.cumsum(np.maximum(np.abs(np.diff(placed)), least_step))
    residuals = np.stack([placed.imag, placed.real], axis=1)[1:] - path(reached)
    start = translation + rotation * edge_translation
    new_cost = cost + float(np.sum(residuals**2)) + price
    return end, rotation * edge_rotation, start, float(reached[-1]), new_cost


def right_lengthen(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> list[LongerWalk]:
    """Return the walk longer by each of the edges."""
    return [lengthened(walk, edge, path, least_step) for edge in edges]


def mistake_track_not_transformed(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Take arc length and cost from the track as it was captured; transform the walk's end correctly."""
    _, _, along, cost = walk
    plain = right_lengthen((1, 0, along, cost), edges, path, least_step)
    moved = right_lengthen(walk, edges, path, least_step)
    return [(*start[:-2], *end[-2:]) for start, end in zip(moved, plain, strict=True)]


def mistake_x_and_z_swapped(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Compare the rows (x, z) of the track with rows (z, x) of the path."""
    return right_lengthen(walk, edges, lambda along: path(along)[:, ::-1], least_step)


def mistake_translation_not_rotated(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Add the edge's translation to that of the walk without rotating it."""
    _, translation, _, _ = walk
    longer = right_lengthen(walk, edges, path, least_step)
    starts = [translation + edge_translation for _, _, _, edge_translation, _ in edges]
    return [(*front[:2], start, *front[-2:]) for front, start in zip(longer, starts, strict=True)]


def mistake_rotation_kept(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Return the walk's rotation without multiplying it by the edge's."""
    rotation, _, _, _ = walk
    longer = right_lengthen(walk, edges, path, least_step)
    return [(end, rotation, *rest) for end, _, *rest in longer]


def mistake_edge_alone(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Return the cost of the edge and its price, without the walk's cost so far."""
    rotation, translation, along, _ = walk
    return right_lengthen((rotation, translation, along, 0.0), edges, path, least_step)


def mistake_no_price(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Return the cost without the price of the edge."""
    unpriced = [(*edge[:-1], 0.0) for edge in edges]
    return right_lengthen(walk, unpriced, path, least_step)


def mistake_from_beginning(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Compare each edge with the path from s = 0 instead of from `along`."""
    rotation, translation, _, cost = walk
    return right_lengthen((rotation, translation, 0.0, cost), edges, path, least_step)


def mistake_progress_alone(walk: Walk, edges: list[Edge], path: PathAt, least_step: float) -> object:
    """Return the arc length of the edge itself instead of that from the start of the path."""
    _, _, start, _ = walk
    longer = right_lengthen(walk, edges, path, least_step)
    return [(*front, along - start, cost) for *front, along, cost in longer]
