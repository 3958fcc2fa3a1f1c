"""One search in layers: many unfinished walks as arrays, lengthened together; the best of each layer go on.

A depth-first search, as in the paper, is too slow for a dense graph: there are dozens of choices per second,
and it tries few of them before the time is over. But what a walk can still do depends only on its node, its
place and its direction. So here all walks advance together, a layer at a time: a few centimetres of a path,
or a tenth of a second. The time is linear in the number of layers.

Ground points are complex numbers z + ix, and p ↦ rotation · p + translation is the transform of the clip of a
walk's last node.
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

# In the unit of costs, m² or m²/s: walks whose costs differ by less are equally good, and go in the order in
# which they were found. Rounding of a cost is some 1e-12; a frame that is 1 cm off a path costs 1e-4 m².
EQUAL = 1e-7

# Of a cell's width: a place or a direction so little below a cell's border is on it. Straight paths have
# places whose x is 0, but for rounding.
ON_BORDER = 1e-6


class States(NamedTuple):
    """N unfinished walks: where each ends, and its cost so far; each field has shape (N,).

    Examples
    --------
    >>> zero = np.zeros(2, np.intp)
    >>> walks = States(zero, zero + 1j, zero + 0j, zero + 0.0, zero, np.array([4.0, 3.0]), zero, zero - 1)
    >>> walks.take(walks.cost.argsort()).cost
    array([3., 4.])
    """

    node: Indices
    rotation: Points  # with `translation`, the transform of the node's clip
    translation: Points
    along: Array  # metres
    frames: Indices
    cost: Array
    trail: Indices  # the number of the state before, -1 at a start
    macro_edge: Indices  # what led here, -1 at a start

    def take(self, chosen: slice | NDArray[Any]) -> States:
        """Take some of the walks."""
        return States._make(values[chosen] for values in self)

    def then(self, rows: Indices, steps: States) -> States:
        """Lengthen walks by steps, each a walk in its first clip's coordinates; step n continues `rows[n]`.

        The longer walks' `trail` are the rows of those that they continue, their `macro_edge` is the step's.
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
        """Put several sets of walks into one."""
        return States._make(np.concatenate(values) for values in zip(*parts, strict=True))


def start_states(nodes: Indices, rotation: Points, translation: Points) -> States:
    """Start a walk at each of some nodes, whose clips are transformed by p ↦ rotation · p + translation."""
    zero = np.zeros(len(nodes))
    no_frames = np.zeros(len(nodes), np.intp)
    start = np.full(len(nodes), -1, np.intp)  # no state and no macro-edge leads here
    return States(
        nodes, rotation, translation, along=zero, frames=no_frames, cost=zero, trail=start, macro_edge=start
    )


def macro_edge_states(graph: CompiledGraph, along: Array, price: Array) -> States:
    """Take each of the H macro-edges of a graph as a walk of its own.

    Parameters
    ----------
    graph : the compiled graph.
    along : metres of each macro-edge (H,).
    price : of each edge (E,); a macro-edge costs what the edge costs by which it leaves its clip.
    """
    last = graph.macro_edges.last
    frames = graph.macro_edges.frames
    numbers = np.arange(len(along))
    transform = (graph.rotation[last], graph.translation[last])
    return States(graph.target[last], *transform, along, frames, price[last], numbers, numbers)


def standing(states: States, roots: Points, cell: float, sector: float) -> Indices:
    """Round the state of walks to integers (4, N): node, and cells of `cell` metres and `sector` radians.

    `roots`, shape (nodes,), are the root's positions at the nodes, in the coordinates of their clips.
    """
    body = (states.translation + states.rotation * roots[states.node]) / cell
    cells = np.floor(np.array([body.real, body.imag, np.angle(states.rotation) / sector]) + ON_BORDER)
    return np.concatenate([states.node[None], cells.astype(np.intp)])


def select(scores: Array, cells: Indices, width: int) -> Indices:
    """Choose the best one of the walks that stand alike, and of these the `width` best, in order.

    Parameters
    ----------
    scores : shape (N,); small is good.
    cells : shape (C, N), whole numbers; walks with the same column stand alike.
    width : how many to choose.

    Examples
    --------
    >>> select(np.array([3.0, 1.0, 2.0]), np.array([[7, 7, 7], [1, 1, 2]]), 5)
    array([1, 2])

    Notebook: 08c-judging-a-search
    """
    order = in_order(scores, EQUAL)
    cells = cells[:, order]
    alike = np.lexsort(cells)  # walks that stand alike come together, the best of them first
    cells = cells[:, alike]
    new = np.concatenate([[True], (cells[:, 1:] != cells[:, :-1]).any(axis=0)])
    return np.asarray(order[np.sort(alike[new])[:width]])


class LayeredSearch:
    """A search in layers; iterate over it, and each round gives the walks that stayed.

    The caller drives it, so that a clock, a bar, a key press or a picture can come between two rounds. A
    subclass defines in `expand`, `score`, `cells`, `layers` and `done` what it searches for.

    Parameters
    ----------
    starts : the first walks.
    width : walks that stay in a round. No walk goes on that costs as much as the best one that arrived.
    """

    expand: Callable[[States], States]  # longer walks; the `trail` of each is the row that it goes on from
    score: Callable[[States], Array]  # (N,), small is good: the cost, and what is expected to come
    cells: Callable[[States], Indices]  # columns of whole numbers (C, N), equal where walks stand alike
    layers: Callable[[States], Indices]  # (N,)
    # reads: name: all kinds of search define it
    done: Callable[[States], Mask]  # (N,), which have arrived

    def __init__(self, starts: States, width: int) -> None:
        self.waiting: dict[int, list[States]] = {0: [starts]}
        self.width = self.first = width  # `first` of the starts go on
        self.history: list[States] = []
        self.arrived: list[States] = []
        self.expanded = self.cut = 0

    def __iter__(self) -> Iterator[States]:
        while self.waiting:
            yield from self.rounds(min(self.waiting))

    def rounds(self, layer: int) -> Iterator[States]:
        """Work through a layer: keep its best walks, and put what they become into the layers they reach."""
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
            # A walk that has not left the layer goes on in it, or it would compete with those ahead.
            reached = np.maximum(self.layers(longer), layer)
            for then in set(reached.tolist()):
                self.waiting.setdefault(then, []).append(longer.take(reached == then))

    def still_going(self, states: States) -> States:
        """Put aside the walks that have arrived, and drop those that cannot become the best one."""
        has_arrived = self.done(states)
        if not has_arrived.any():
            return states
        self.arrived.append(states.take(has_arrived))
        # No cost is below 0, so a walk that costs as much as the best one cannot become better.
        best = min(arrived.cost.min() for arrived in self.arrived)
        return states.take(~has_arrived & (states.cost < best - EQUAL))

    def trace(self, states: States, row: int) -> States:
        """Return the states of one walk, from its start over all rounds to this row of some states."""
        history = States.join(self.history)
        rows = [int(states.trail[row])]
        while rows[-1] >= 0:
            rows.append(int(history.trail[rows[-1]]))
        earlier = history.take(np.array(rows[-2::-1], int))  # without the -1 of the start
        return States.join([earlier, states.take(slice(row, row + 1))])
