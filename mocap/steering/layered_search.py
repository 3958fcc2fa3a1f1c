"""Layered beam search: partial walks as arrays, extended together, with a selection in each layer.

The depth-first search of the paper is too slow for a dense graph, with dozens of choices per second of
motion: it explores few of them in the available time. The possible continuations of a walk, however, depend
only on its node, its position and its direction. Therefore all walks advance together, layer by layer. A
layer is a few centimetres of a path, or a tenth of a second. The time is linear in the number of layers.

Ground points are complex numbers z + ix, and p ↦ rotation · p + translation is the transform of the clip of
the last node of a walk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap._shared.ties import in_order
from mocap.graphs.compiled_graph import CompiledGraph

# The tolerance for equal costs, m² or m²/s: such walks remain in the order in which they were found. The
# rounding error of a cost is about 1e-12, and a frame that is 1 cm off a path costs 1e-4 m².
EQUAL = 1e-7

# Fraction of the width of a cell: values that are below a border of cells by less are on the border. On
# straight paths, x is often 0 up to rounding.
ON_BORDER = 1e-6


class States(NamedTuple):
    """N partial walks, described by their ends and costs. Each field has shape (N,).

    Examples
    --------
    >>> zero = np.zeros(2, np.intp)
    >>> walks = States(zero, zero + 1j, zero + 0j, zero + 0.0, zero, np.array([4.0, 3.0]), zero, zero - 1)
    >>> walks.take(walks.cost.argsort()).cost
    array([3., 4.])
    """

    node: Indices
    rotation: Points  # with `translation`, the transform of the clip of the node
    translation: Points
    along: Array  # metres
    frames: Indices
    cost: Array
    trail: Indices  # the number of the previous state, -1 at a start
    macro_edge: Indices  # the last macro-edge, -1 at a start

    def take(self, chosen: slice | NDArray[Any]) -> States:
        """Select some of the walks."""
        return States._make(values[chosen] for values in self)

    def then(self, rows: Indices, steps: States) -> States:
        """Extend walks by steps: step n, in the coordinates of its first clip, continues walk `rows[n]`.

        In the result, `trail` is `rows`, and `macro_edge` that of the steps.
        """
        rotation = self.rotation[rows] * steps.rotation
        translation = self.translation[rows] + self.rotation[rows] * steps.translation
        along = self.along[rows] + steps.along
        frames = self.frames[rows] + steps.frames
        cost = self.cost[rows] + steps.cost
        macro_edge = steps.macro_edge
        return States(steps.node, rotation, translation, along, frames, cost, rows, macro_edge)

    @staticmethod
    def join(parts: Sequence[States]) -> States:
        """Concatenate sets of walks."""
        return States._make(np.concatenate(values) for values in zip(*parts, strict=True))


def start_states(nodes: Indices, rotation: Points, translation: Points) -> States:
    """Create a walk without edges at each of some nodes, with the transforms of their clips."""
    zero = np.zeros(len(nodes))
    no_frames = np.zeros(len(nodes), np.intp)
    start = np.full(len(nodes), -1, np.intp)  # no previous state, and no macro-edge
    return States(
        nodes, rotation, translation, along=zero, frames=no_frames, cost=zero, trail=start, macro_edge=start
    )


def macro_edge_states(graph: CompiledGraph, along: Array, price: Array) -> States:
    """Represent each of the H macro-edges of a graph as a walk, a step for `States.then`.

    Parameters
    ----------
    graph : the compiled graph.
    along : the progress of each macro-edge, metres (H,).
    price : the cost of each edge (E,); that of a macro-edge is the cost of its last edge.
    """
    last = graph.macro_edges.last
    frames = graph.macro_edges.frames
    numbers = np.arange(len(along))
    transform = (graph.rotation[last], graph.translation[last])
    return States(graph.target[last], *transform, along, frames, price[last], numbers, numbers)


def standing(states: States, roots: Points, cell: float, sector: float) -> Indices:
    """Quantise walks to cells (4, N): node, x and z in units of `cell` metres, direction of `sector` radians.

    `roots`, one for each node, are the positions of the root at the nodes in the coordinates of their clips.
    """
    body = (states.translation + states.rotation * roots[states.node]) / cell
    cells = np.floor(np.array([body.real, body.imag, np.angle(states.rotation) / sector]) + ON_BORDER)
    return np.concatenate([states.node[None], cells.astype(np.intp)])


def select(scores: Array, cells: Indices, width: int) -> Indices:
    """Select the best walk of each cell, and of these the `width` best, in order.

    Parameters
    ----------
    scores : shape (N,); lower is better.
    cells : shape (C, N), integers. Walks with equal columns are in the same cell.
    width : the largest number of walks selected.

    Examples
    --------
    >>> select(np.array([3.0, 1.0, 2.0]), np.array([[7, 7, 7], [1, 1, 2]]), 5)
    array([1, 2])

    Notebook: 08c-judging-a-search
    """
    order = in_order(scores, EQUAL)
    cells = cells[:, order]
    by_cell = np.lexsort(cells)  # stable: the first walk of each cell is the best
    cells = cells[:, by_cell]
    is_first = np.concatenate([[True], (cells[:, 1:] != cells[:, :-1]).any(axis=0)])
    return np.asarray(order[np.sort(by_cell[is_first])[:width]])


class LayeredSearch:
    """A layered search as an iterator, which yields the walks that are kept in each round.

    Because the caller drives the iteration, it can check a deadline, show progress, respond to a key or draw
    between two rounds. A subclass defines the search by `expand`, `score`, `cells`, `layers` and `done`.
    Walks that cost as much as the best one that has arrived are dropped.

    Parameters
    ----------
    starts : the initial walks.
    width : the largest number of walks that are kept in a round.
    """

    expand: Callable[[States], States]  # extended walks, whose `trail` is the row of the predecessor
    score: Callable[[States], Array]  # (N,), lower is better: the cost plus the expected cost
    cells: Callable[[States], Indices]  # (C, N), integers, equal for walks in the same cell
    layers: Callable[[States], Indices]  # (N,)
    # reads: name: all kinds of search define it
    done: Callable[[States], Mask]  # (N,), whether a walk has arrived

    def __init__(self, starts: States, width: int) -> None:
        self.waiting: dict[int, list[States]] = {0: [starts]}
        self.width = self.first = width  # `first` is the width of the first round
        self.history: list[States] = []
        self.arrived: list[States] = []
        self.expanded = self.cut = 0

    def __iter__(self) -> Iterator[States]:
        while self.waiting:
            yield from self.rounds(min(self.waiting))

    def rounds(self, layer: int) -> Iterator[States]:
        """Process a layer: yield its best walks, and put their extensions into the layers that they reach."""
        while parts := self.waiting.pop(layer, []):
            states = States.join(parts)
            width = self.width if self.history else self.first
            chosen = states.take(select(self.score(states), self.cells(states), width))
            self.history.append(chosen)
            self.cut += len(states.node) - len(chosen.node)
            yield chosen
            longer = self.expand(chosen)
            longer = self.still_going(longer._replace(trail=longer.trail + self.expanded))
            self.expanded += len(chosen.node)
            # Walks that are still in this layer get another round, instead of competing with walks ahead.
            reached = np.maximum(self.layers(longer), layer)
            for then in set(reached.tolist()):
                self.waiting.setdefault(then, []).append(longer.take(reached == then))

    def still_going(self, states: States) -> States:
        """Select the walks to extend: store those that have arrived, and drop those that cannot be best."""
        has_arrived = self.done(states)
        if not has_arrived.any():
            return states
        self.arrived.append(states.take(has_arrived))
        # Costs never decrease: a walk that costs as much as the best one that has arrived cannot improve.
        best = min(arrived.cost.min() for arrived in self.arrived)
        return states.take(~has_arrived & (states.cost < best - EQUAL))

    def trace(self, states: States, row: int) -> States:
        """Backtrack a walk: return its states in all rounds, from its start to row `row` of `states`."""
        history = States.join(self.history)
        rows = [int(states.trail[row])]
        while rows[-1] >= 0:
            rows.append(int(history.trail[rows[-1]]))
        earlier = history.take(np.array(rows[-2::-1], int))  # without the -1 of the start
        return States.join([earlier, states.take(slice(row, row + 1))])
