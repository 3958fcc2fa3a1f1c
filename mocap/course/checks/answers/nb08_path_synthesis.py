"""Notebook 08: inputs, right answers and mistakes of `survivors` and `look_ahead`."""

from collections.abc import Callable
from functools import partial

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.course.checks.answers.common import Arguments

Walk = tuple[complex, complex, float, float]
"""A walk: rotation, translation, metres along the line, and cost."""

Line = Callable[[Array], Points]
"""From metres along a line to its points."""

# ---- survivors


def draw_survivors(rng: np.random.Generator) -> Arguments:
    """Draw walks as rows of equal and different states, their costs, and how many may go on."""
    count = int(rng.integers(30, 60))
    return rng.integers(0, 2, size=(count, 4)), rng.permutation(count) / 100, int(rng.integers(3, 7))


def right_survivors(stand: Indices, costs: Array, width: int) -> Indices:
    """Keep the best of the walks that stand alike, and of these the cheapest."""
    order = np.argsort(costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return order[np.sort(first)[:width]]


def mistake_beam_alone(stand: Indices, costs: Array, width: int) -> object:
    """Return the `width` walks of least cost, equivalent or not."""
    return np.argsort(costs)[:width]


def mistake_dominance_alone(stand: Indices, costs: Array, width: int) -> object:
    """Return the cheapest walk of each state, all of them, by rising cost."""
    return right_survivors(stand, costs, len(costs))


def mistake_beam_first(stand: Indices, costs: Array, width: int) -> object:
    """Cut to the `width` cheapest walks, then keep the cheapest of these in each state."""
    order = np.argsort(costs)[:width]
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return order[np.sort(first)[:width]]


def mistake_first_in_list(stand: Indices, costs: Array, width: int) -> object:
    """Keep the walk of lowest index in each state, and of these the `width` cheapest."""
    _, first = np.unique(stand, axis=0, return_index=True)
    return first[np.argsort(costs[first])][:width]


def mistake_heading_ignored(stand: Indices, costs: Array, width: int) -> object:
    """Keep the cheapest walk for each value of the first three columns, without the heading."""
    return right_survivors(stand[:, :3], costs, width)


def mistake_unsorted(stand: Indices, costs: Array, width: int) -> object:
    """Return the right walks by rising index instead of rising cost."""
    return np.sort(right_survivors(stand, costs, width))


def mistake_places_in_sorted_list(stand: Indices, costs: Array, width: int) -> object:
    """Return the ranks by cost of the right walks instead of their indices."""
    order = np.argsort(costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return np.sort(first)[:width]


def mistake_order_of_stands(stand: Indices, costs: Array, width: int) -> object:
    """Keep the cheapest walk of each state, and of these `width`, in the lexicographic order of states."""
    order = np.argsort(costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return order[first][:width]


def mistake_dearest_first(stand: Indices, costs: Array, width: int) -> object:
    """Keep the most expensive walk of each state, and of these the `width` most expensive, those first."""
    order = np.argsort(-costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    return order[np.sort(first)[:width]]


def mistake_dearest_of_equals(stand: Indices, costs: Array, width: int) -> object:
    """Keep the most expensive walk of each state, and of these the `width` cheapest."""
    order = np.argsort(-costs)
    _, first = np.unique(stand[order], axis=0, return_index=True)
    chosen = order[first]
    return chosen[np.argsort(costs[chosen])][:width]


def mistake_fixed_width(stand: Indices, costs: Array, width: int) -> object:
    """Return the first three right walks, whatever the width."""
    return right_survivors(stand, costs, 3)


def mistake_walk_too_few(stand: Indices, costs: Array, width: int) -> object:
    """Return the first `width` - 1 right walks."""
    return right_survivors(stand, costs, width - 1)


def mistake_walk_too_many(stand: Indices, costs: Array, width: int) -> object:
    """Return `width` + 1 walks, the cheapest of their states."""
    return right_survivors(stand, costs, width + 1)


def mistake_node_alone(stand: Indices, costs: Array, width: int) -> object:
    """Keep the cheapest walk for each value of the first column, the node."""
    return right_survivors(stand[:, :1], costs, width)


def mistake_rows_of_stand(stand: Indices, costs: Array, width: int) -> object:
    """Return the states of the right walks, shape (W, 4), instead of their indices."""
    return stand[right_survivors(stand, costs, width)]


# ---- look_ahead


def draw_look_ahead(rng: np.random.Generator) -> Arguments:
    """Draw a walk, its root in the coming frames, and a line."""
    corners = rng.normal(size=(rng.integers(4, 9), 2)).cumsum(axis=0) @ [1, 1j]
    reached = np.append(0, np.cumsum(abs(np.diff(corners))))
    along = float(rng.uniform(0, reached[-1]))
    ahead = (rng.normal(scale=0.05, size=(rng.integers(4, 12), 2)) @ [1, 1j]).cumsum()
    rotation = complex(np.exp(1j * rng.uniform(-3, 3)))
    point = complex(np.interp(along, reached, corners))
    walk = rotation, complex(point + 0.1 - rotation * ahead[0]), along, 0.7
    line = partial(np.interp, xp=reached, fp=corners)  # a function that can be sent to another process
    return walk, ahead, line, 0.4


def distances_of(walk: Walk, ahead: Points, line: Line) -> Array:
    """Measure from each coming frame to the point of the line where it should be."""
    rotation, translation, along, _ = walk
    s = np.asarray(along + np.cumsum(abs(np.diff(ahead))))
    return np.asarray(abs(rotation * ahead[1:] + translation - line(s)))


def right_look_ahead(walk: Walk, ahead: Points, line: Line, limit: float) -> float:
    """Compute Eq. 9 for the coming frames, at most `limit`."""
    return min(float((distances_of(walk, ahead, line) ** 2).sum()), limit)


def mistake_not_transformed(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Measure from the points of the clip as they were captured, without rotation and translation."""
    _, _, along, cost = walk
    return right_look_ahead((1, 0, along, cost), ahead, line, limit)


def mistake_translated_first(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Measure from rotation · (p + translation)."""
    rotation, translation, along, cost = walk
    return right_look_ahead((rotation, rotation * translation, along, cost), ahead, line, limit)


def mistake_not_rotated(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Measure from p + translation, without the rotation."""
    _, translation, along, cost = walk
    return right_look_ahead((1, translation, along, cost), ahead, line, limit)


def mistake_distances(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the sum of the distances in metres, at most `limit`."""
    return min(float(distances_of(walk, ahead, line).sum()), limit)


def mistake_mean_of_frames(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the mean of the squared distances over the frames, at most `limit`."""
    return min(float((distances_of(walk, ahead, line) ** 2).mean()), limit)


def mistake_starts_at_zero(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Count s from 0 instead of `along`, and so compare with the beginning of the line."""
    rotation, translation, _, cost = walk
    return right_look_ahead((rotation, translation, 0.0, cost), ahead, line, limit)


def mistake_point_stands_still(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Compare every frame with the point of the line at `along`."""
    _, _, along, _ = walk
    return right_look_ahead(walk, ahead, lambda s: line(np.full(len(s), along)), limit)


def mistake_unlimited(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the sum of the squared distances without the upper limit."""
    return right_look_ahead(walk, ahead, line, np.inf)


def mistake_spared(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return `limit` minus the right cost."""
    return limit - right_look_ahead(walk, ahead, line, limit)


def mistake_cost_so_far_included(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Add the walk's cost so far to the sum of squares, and limit this total."""
    *_, cost = walk
    return min(right_look_ahead(walk, ahead, line, np.inf) + cost, limit)


def mistake_cost_so_far_added(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Limit the sum of squares, and add the walk's cost so far to the result."""
    *_, cost = walk
    return right_look_ahead(walk, ahead, line, limit) + cost


def mistake_first_point_included(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Add the squared distance of the current point, `ahead[0]`, from the line at `along`."""
    rotation, translation, along, _ = walk
    first = abs(rotation * ahead[0] + translation - line(np.array([along]))[0]) ** 2
    return min(right_look_ahead(walk, ahead, line, np.inf) + float(first), limit)


def mistake_steps_not_added_up(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Compare each frame with the line at `along` plus its own step, without the steps before it."""
    rotation, translation, along, _ = walk
    s = np.asarray(along + abs(np.diff(ahead)))
    return min(float((abs(rotation * ahead[1:] + translation - line(s)) ** 2).sum()), limit)


def mistake_line_a_frame_behind(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Compare each frame with the line's point of the frame before it."""
    rotation, translation, along, _ = walk
    steps = np.append(0, abs(np.diff(ahead))[:-1])
    s = np.asarray(along + np.cumsum(steps))
    return min(float((abs(rotation * ahead[1:] + translation - line(s)) ** 2).sum()), limit)


def mistake_steps_without_abs(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Advance along the line by the z components of the steps, which may be negative."""
    rotation, translation, along, _ = walk
    s = np.asarray(along + np.cumsum(np.diff(ahead).real))
    return min(float((abs(rotation * ahead[1:] + translation - line(s)) ** 2).sum()), limit)


def mistake_limit_of_each_frame(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Limit the squared distance of each frame to `limit`, and add these up."""
    return float(np.minimum(distances_of(walk, ahead, line) ** 2, limit).sum())


def mistake_at_least(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the sum of squares, but at least `limit`."""
    return max(right_look_ahead(walk, ahead, line, np.inf), limit)


def mistake_last_frame_alone(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the squared distance of the last frame alone, at most `limit`."""
    return min(float(distances_of(walk, ahead, line)[-1] ** 2), limit)


def mistake_rooted_sum(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Return the square root of the sum of squares, at most `limit`."""
    return min(float(np.sqrt((distances_of(walk, ahead, line) ** 2).sum())), limit)


def mistake_rotated_backwards(walk: Walk, ahead: Points, line: Line, limit: float) -> object:
    """Rotate the points by the opposite angle, and then translate them."""
    rotation, translation, along, cost = walk
    return right_look_ahead((rotation.conjugate(), translation, along, cost), ahead, line, limit)
