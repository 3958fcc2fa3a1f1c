"""The walks of a beam search as arrays, and the three steps of the search: expand, score, prune.

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
from mocap.steering.own_turning import Bending
from mocap.steering.path_objective import Prices, Route, least_progress

CREEP = 0.05  # metres per second: the least progress of a walk that is laid on the path, so that searches end


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
    turn: Points  # with move, places the node's clip: p ↦ turn · p + move
    move: Points
    along: Array  # metres along the path
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
    graph, route, prices : the graph, the wishes, and the price of each deviation.
    along : shape (T,), running sum of the progress, metres, over the frames of all edges.
    price : shape (H,), the price of each hop's transition.
    length : shape (H,), the progress over each hop, metres.
    since : shape (H, 2), the value of `along` to subtract, so that it counts from the start of a hop.
    ahead : shape (N, 3), the progress from each node in the next `AHEAD` seconds, metres.
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
    """Compute the price of each hop's transition, and its progress along the path."""
    hops = graph.hops
    along = np.cumsum(
        least_progress(graph, route) if route.bending is None else _progress(graph, route.bending)
    )
    before = np.concatenate([[0.0], along])
    parts = before[hops.starts + hops.counts] - before[hops.starts]  # (H, 2)
    since = before[hops.starts] - np.stack([np.zeros(len(parts)), parts[:, 0]], axis=1)
    price = np.where(graph.blended, prices.seam + prices.match * graph.cost**2, 0.0)[hops.last]
    ahead = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)
    return SearchSpace(graph, route, prices, along, price, parts.sum(axis=1), since, ahead)


def start_states(graph: CompiledGraph, nodes: Indices, place: complex, heading: float) -> States:
    """Start a walk at each of some nodes, at one place and in one direction (radians).

    Examples
    --------
    At the first node, over the point x = 2, z = 1, about to go towards +x:

    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> start = start_states(graph, np.array([0]), 1 + 2j, np.pi / 2)
    >>> start.turn * graph.at[:1] + start.move
    array([1.+2.j])
    """
    none = np.zeros(len(nodes), np.intp)
    turn = np.exp(1j * (heading - graph.going[nodes]))
    move = place - turn * graph.at[nodes]
    return States(nodes, turn, move, np.zeros(len(nodes)), none, np.zeros(len(nodes)), none, none - 1)


def expand(space: SearchSpace, states: States, number: int) -> States:
    """Lengthen every walk by every hop that leaves its node.

    The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², plus the prices.
    One departure from the paper: after each hop s moves half-way to the point of the path abreast of the
    body, so that a walk which cuts a corner need not walk the metres that it saved. `Wishes.slide` is the
    share of that distance.

    Parameters
    ----------
    space : the search.
    states : the walks.
    number : the number of the first walk in the history of the search; the others follow it.

    Returns
    -------
    The longer walks.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.compile_graph(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> from mocap.steering.path_objective import make_route, Wishes
    >>> route = make_route(graph, body.GroundPath([[0, 0], [0, 6]]), Wishes())
    >>> space = search_space(graph, route, Prices())
    >>> longer = expand(space, start_states(graph, np.array([0]), 0j, 0.0), 0)
    >>> len(longer.node) == int(graph.hops.first[1]), bool((longer.frames > 0).all())
    (True, True)

    Notebook: 08-path-synthesis
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
    if space.route.bending is not None:
        return _laid(space, new, space.route.bending)
    return new._replace(along=new.along + slide(space, new, space.length[hop]))


def _progress(graph: CompiledGraph, bending: Bending) -> Array:
    """Give the progress of frames that are laid on the path: along their own, and never quite none."""
    return np.maximum(bending.own.step, CREEP / graph.fps)


def _laid(space: SearchSpace, states: States, bending: Bending) -> States:
    """Put walks on the path, and turn them the way it goes."""
    route, node = space.route, states.node
    turn = np.exp(-1j * bending.own.going[node]) * route.ways[route.point(states.along)]
    return states._replace(turn=turn, move=route.at(states.along) - turn * space.graph.at[node])


def frames_along(space: SearchSpace, hop: Indices, start: Array) -> tuple[Indices, Indices, Array]:
    """List the frames that some hops play: their rows, which hop each belongs to, and metres along the path.

    `start` (n,) are the metres along the path at which each of the n hops begins.
    """
    row, of = space.graph.hops.rows(hop)
    since = np.repeat(space.since[hop].ravel(), space.graph.hops.counts[hop].ravel())
    return row, of, space.along[row] - since + start[of]


def hop_costs(space: SearchSpace, states: States, chosen: Indices, hop: Indices) -> Array:
    """Sum the costs of the frames of n hops, shape (n,): distance from the path, and missed wishes.

    The walks `states.take(chosen)` take the hops with the numbers `hop` (n,).
    """
    graph, route, prices = space.graph, space.route, space.prices
    if not len(hop):
        return np.empty(0)
    row, number, along = frames_along(space, hop, states.along[chosen])
    of = chosen[number]
    first = np.cumsum(graph.hops.frames[hop]) - graph.hops.frames[hop]
    body = states.move[of] + states.turn[of] * graph.tracks.ground[row]
    off = _astray(space, body, along) if route.bending is None else _bent(space, route.bending, row, along)
    if route.bare:
        return np.asarray(np.add.reduceat(off, first))
    point, frame = route.point(along), states.frames[of] + np.arange(len(of)) - first[number]
    label, late = route.label[point], frame / graph.fps - route.clock[point]
    if graph.labels.names:
        off += prices.label * ((label >= 0) & ~graph.labels.bears[label, row])
    off += prices.late * np.where(np.isnan(late), 0.0, late) ** 2
    off += crowding(space, body, frame)
    return np.asarray(np.add.reduceat(off, first))


def _astray(space: SearchSpace, body: Points, along: Array) -> Array:
    """Compute the cost of the distance from the path, of the shape of `body`."""
    off = _square(body - space.route.at(along))
    return off + space.prices.stray * off**2


def _bent(space: SearchSpace, bending: Bending, row: Indices, along: Array) -> Array:
    """Compute the cost of turning frames further than they turn themselves, and of those that stand."""
    graph, route, prices = space.graph, space.route, space.prices
    rates = bending.rates(row, route.point(along), graph.fps)
    return prices.bend * rates**2 + prices.idle * (bending.own.step[row] < route.least / graph.fps)


def crowding(space: SearchSpace, body: Points, frame: Indices) -> Array:
    """Compute the cost of bodies that are too near to others, of the shape of `body`."""
    price = np.zeros(body.shape)
    for other in space.route.others:
        near = space.route.apart - np.abs(body - other[np.minimum(frame, len(other) - 1)])
        price += space.prices.crowding * np.maximum(near, 0.0) ** 2
    return price


def slide(space: SearchSpace, states: States, most: Array) -> Array:
    """Give the metres by which s moves: a share of those to the point abreast, or of `most` (N,) if less."""
    body = states.move + states.turn * space.graph.at[states.node]
    way = space.route.ways[space.route.point(states.along)]
    abreast = ((body - space.route.near(states.along)) * way.conj()).real
    return np.asarray(space.route.slide * np.minimum(np.maximum(abreast, -most), most))


def score(space: SearchSpace, states: States, rescue: float) -> Array:
    """Rate walks by their cost plus the expected cost if their clips play on; small is good.

    Without the second term a walk that has just paid for a turn looks worse than one about to leave the path.
    The second term is at most `rescue` (m²), because a transition can still save the walk.
    """
    graph, node = space.graph, states.node
    line = space.route.near(states.along[:, None] + space.ahead[node])
    ahead = line if space.route.bending else states.move[:, None] + states.turn[:, None] * graph.ahead[node]
    off = _square(ahead - line)
    if len(space.route.others):  # to give way takes longer: look up to three times as far
        body = states.move + states.turn * graph.at[node]
        further = ahead[:, -1:] + (ahead[:, -1:] - body[:, None]) * [0, 1, 2]
        then = np.arange(1, 4) * round(graph.fps * AHEAD[-1])
        off += crowding(space, further, states.frames[:, None] + then)
    loss = off.sum(axis=1) * graph.fps * AHEAD[0]  # each point ahead stands for the frames up to it
    return np.asarray(states.cost + np.minimum(loss, rescue))


def prune(states: States, scores: Array, cells: Indices, width: int) -> States:
    """Keep the best one of the walks that stand alike, and of these the `width` best.

    Parameters
    ----------
    states, scores : N walks and their scores; small is good.
    cells : shape (C, N), whole numbers; walks with the same column stand alike. See `standing`.
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
    """Round the state of walks to whole numbers (5, N): node, cells of `place` metres, of `turn` rad, time.

    Time counts only where there are others, because they move.
    """
    body = (states.move + states.turn * space.graph.at[states.node]) / place
    clock = states.frames * (4 / space.graph.fps) * bool(len(space.route.others))
    cells = [body.real, body.imag, np.angle(states.turn) / turn, clock]
    return np.stack([states.node, *(np.floor(values).astype(np.intp) for values in cells)])


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
