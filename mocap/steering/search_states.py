"""Walks under way as arrays, and the three things a beam search does with them: expand, score, prune.

All walks of a layer are handled at once: each field of `States` holds one number per walk.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Points
from mocap.graphs.compiled_graph import AHEAD, CompiledGraph
from mocap.steering.path_objective import Prices, Route


class States(NamedTuple):
    """N walks under way: where each stands, and what it cost."""

    node: Indices
    turn: Points  # with move, places the node's clip: p ↦ turn · p + move
    move: Points
    along: Array  # metres of path
    frames: Indices
    cost: Array
    trail: Indices  # the number of the state before
    hop: Indices  # the hop that led here, -1 at a start

    def take(self, chosen: slice | NDArray[Any]) -> States:
        """Take some of the walks."""
        return States._make(values[chosen] for values in self)

    @staticmethod
    def join(parts: Sequence[States]) -> States:
        """Put several sets of walks into one."""
        return States._make(np.concatenate(values) for values in zip(*parts, strict=True))


@dataclass(frozen=True, eq=False)
class SearchSpace:
    """What stays the same during a search.

    Parameters
    ----------
    graph, route, prices : where to walk, what is wished for, and what it costs to go without.
    along : shape (T,), metres of path over the frames of all edges in a row.
    price : shape (H,), what the transition of each hop costs.
    length : shape (H,), metres of path that each hop is long.
    since : shape (H, 2), what to take off `along` to count from the start of a hop.
    ahead : shape (N, 3), metres from each node to where it will be after `AHEAD` seconds.
    """

    graph: CompiledGraph
    route: Route
    prices: Prices
    along: Array
    price: Array
    length: Array
    since: Array
    ahead: Array


def search_space(graph: CompiledGraph, route: Route, prices: Prices) -> SearchSpace:
    """Work out what each hop costs, and how far along the path it leads."""
    hops = graph.hops
    along = np.cumsum(np.maximum(graph.tracks.step, route.least / graph.fps))
    before = np.concatenate([[0.0], along])
    parts = before[hops.starts + hops.counts] - before[hops.starts]  # (H, 2)
    since = before[hops.starts] - np.stack([np.zeros(len(parts)), parts[:, 0]], axis=1)
    price = np.where(graph.blended, prices.seam + prices.match * graph.cost**2, 0.0)[hops.last]
    ahead = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)
    return SearchSpace(graph, route, prices, along, price, parts.sum(axis=1), since, ahead)


def start_states(graph: CompiledGraph, nodes: Indices, place: complex, heading: float) -> States:
    """Stand at each of some nodes, over a place and about to move in a direction (radians)."""
    none = np.zeros(len(nodes), np.intp)
    turn = np.exp(1j * (heading - graph.going[nodes]))
    move = place - turn * graph.at[nodes]
    return States(nodes, turn, move, np.zeros(len(nodes)), none, np.zeros(len(nodes)), none, none - 1)


def expand(space: SearchSpace, states: States, number: int) -> States:
    """Lengthen every walk by every hop that leaves its node.

    The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², and the prices.
    One departure: after each hop s slides half-way to the point abreast, so that a walk which cuts a corner
    does not have to walk the metres that it saved.

    Parameters
    ----------
    space : where to search.
    states : the walks.
    number : of the first of them in the history of the search; the others follow.

    Returns
    -------
    The longer walks.
    """
    graph = space.graph
    of, hop = graph.hops.leaving(states.node)
    last, turn = graph.hops.last[hop], states.turn[of]
    new = States(
        graph.target[last],
        turn * graph.turn[last],
        states.move[of] + turn * graph.move[last],
        states.along[of] + space.length[hop],
        states.frames[of] + graph.hops.frames[hop],
        states.cost[of] + (space.price[hop] + hop_costs(space, states, of, hop)),
        number + of,
        hop,
    )
    return new._replace(along=new.along + slide(space, new, space.length[hop] / 2))


def frames_along(space: SearchSpace, hop: Indices, start: Array) -> tuple[Indices, Indices, Array]:
    """List the frames that some hops play: their rows, which hop each belongs to, and metres of path.

    `start` (n,) are the metres of path at which each of the n hops begins.
    """
    row, of = space.graph.hops.rows(hop)
    since = np.repeat(space.since[hop].ravel(), space.graph.hops.counts[hop].ravel())
    return row, of, space.along[row] - since + start[of]


def hop_costs(space: SearchSpace, states: States, chosen: Indices, hop: Indices) -> Array:
    """Sum up over the frames of n hops how far they are from what is wished for, shape (n,).

    The walks of `states` with the numbers `chosen` (n,) take the hops with the numbers `hop` (n,).
    """
    graph, route, prices = space.graph, space.route, space.prices
    if not len(hop):
        return np.empty(0)
    row, number, along = frames_along(space, hop, states.along[chosen])
    of = chosen[number]
    body = states.move[of] + states.turn[of] * graph.tracks.ground[row]
    first = np.cumsum(graph.hops.frames[hop]) - graph.hops.frames[hop]
    off = _square(body - route.at(along))
    off += prices.stray * off**2
    if route.bare:
        return np.asarray(np.add.reduceat(off, first))
    point, frame = route.point(along), states.frames[of] + np.arange(len(of)) - first[number]
    label, late = route.label[point], frame / graph.fps - route.clock[point]
    if graph.labels.names:
        off += prices.label * ((label >= 0) & ~graph.labels.bears[label, row])
    off += prices.late * np.where(np.isnan(late), 0.0, late) ** 2
    off += crowding(space, body, frame)
    return np.asarray(np.add.reduceat(off, first))


def crowding(space: SearchSpace, body: Points, frame: Indices) -> Array:
    """Price how much too near a body is to others."""
    price = np.zeros(body.shape)
    for other in space.route.others:
        near = space.route.apart - np.abs(body - other[np.minimum(frame, len(other) - 1)])
        price += space.prices.crowding * np.maximum(near, 0.0) ** 2
    return price


def slide(space: SearchSpace, states: States, most: Array) -> Array:
    """Measure half the way along the path to where it passes the body, at most `most` metres (N,)."""
    body = states.move + states.turn * space.graph.at[states.node]
    way = space.route.ways[space.route.point(states.along)]
    abreast = ((body - space.route.near(states.along)) * way.conj()).real
    return np.asarray(np.minimum(np.maximum(abreast / 2, -most), most))


def score(space: SearchSpace, states: States, rescue: float) -> Array:
    """Rate walks by what they cost, and what it would cost to let their clips play on; small is good.

    Without the second part a walk that has just paid for a turn looks worse than one about to leave the path.
    It counts no more than `rescue` (m²): by then a transition could have saved the walk.
    """
    graph, node = space.graph, states.node
    ahead = states.move[:, None] + states.turn[:, None] * graph.ahead[node]
    off = _square(ahead - space.route.near(states.along[:, None] + space.ahead[node]))
    if len(space.route.others):  # to give way takes longer: look twice and thrice as far
        body = states.move + states.turn * graph.at[node]
        further = ahead[:, -1:] + (ahead[:, -1:] - body[:, None]) * [0, 1, 2]
        then = np.arange(1, 4) * round(graph.fps * AHEAD[-1])
        off += crowding(space, further, states.frames[:, None] + then)
    loss = off.sum(axis=1) * graph.fps * AHEAD[0]  # each point ahead stands for the frames up to it
    return np.asarray(states.cost + np.minimum(loss, rescue))


def prune(states: States, scores: Array, cells: Indices, width: int) -> States:
    """Keep the best of the walks that stand alike, and of these the `width` best.

    Parameters
    ----------
    states, scores : N walks, and how good each is; small is good.
    cells : shape (C, N), whole numbers that are the same for walks that stand alike, as `standing` gives.
    width : how many to keep.

    Examples
    --------
    >>> one = np.zeros(3, np.intp)
    >>> walks = States(one, one + 0j, one + 0j, one + 0.0, one, one + 0.0, one, np.arange(3))
    >>> prune(walks, np.array([3.0, 1.0, 2.0]), np.array([[7, 7, 7], [1, 1, 2]]), 5).hop
    array([1, 2])
    """
    order = np.argsort(scores, kind="stable")
    cells = cells[:, order]
    alike = np.lexsort(cells)  # walks that stand alike come together, the best of them first
    cells = cells[:, alike]
    new = np.concatenate([[True], (cells[:, 1:] != cells[:, :-1]).any(axis=0)])
    first = np.sort(alike[new])
    return states.take(order[first[:width]])


def standing(space: SearchSpace, states: States, place: float, turn: float) -> Indices:
    """Give where walks stand in whole numbers (5, N): node, cells of `place` metres, of `turn` radians, time.

    Time counts only where others walk, who are somewhere else a moment later.
    """
    body = (states.move + states.turn * space.graph.at[states.node]) / place
    clock = states.frames * (4 / space.graph.fps) * bool(len(space.route.others))
    cells = [body.real, body.imag, np.angle(states.turn) / turn, clock]
    return np.stack([states.node, *(np.floor(values).astype(np.intp) for values in cells)])


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
