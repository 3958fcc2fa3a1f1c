"""The best walk along a line on the ground: a search in layers, vectorised over its states.

Depth first, as in the paper, drowns in a dense graph: of dozens of choices a second it has tried few when
time runs out. But what a walk can still do depends only on where it stands: at which node, in which place,
turned which way. So here all walks advance together, a few centimetres of path at a time. Of those that
stand alike only the best goes on (dominance), and of these the `width` most promising (a beam). The time is
linear in the path's length.

The promise of a walk is what it has cost, and what it would cost to let its clip just play on for most of a
second, though no more than `rescue`: by then a transition could have mended it. Without this a walk that has
just paid for a turn looks worse than one about to run off the path.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Points, ranges
from mocap._shared.progress import Progress
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import AHEAD, CompiledGraph
from mocap.steering.path_objective import Prices, Route

States = NDArray[np.void]  # of the dtype STATE


@dataclass(frozen=True)
class Beam:
    """How thoroughly to search, and what counts beside the squared distance from the path.

    Parameters
    ----------
    width : walks that go on in a layer.
    layer : metres of path that a layer is long.
    place, turn : walks nearer than this, metres and radians, at the same node stand alike.
    rescue : the most that is expected to be lost where a walk is about to leave the path, m².
    seconds : time to search; when it is over, the best walk so far is taken.
    progress : wraps the layers, to show a bar.
    """

    width: int = 100
    layer: float = 0.15
    place: float = 0.1
    turn: float = 0.1
    rescue: float = 1.5
    seconds: float = np.inf
    progress: Progress = iter


STATE = np.dtype(
    [
        ("node", np.intp),
        ("turn", complex),  # with move, places the node's clip: p -> turn · p + move
        ("move", complex),
        ("along", float),  # metres of path
        ("frames", np.intp),
        ("cost", float),
        ("trail", np.intp),  # the number of the state before
        ("hop", np.intp),  # that led here, -1 at a start
    ]
)
"""A walk so far: where it stands, and what it cost."""


class Found(NamedTuple):
    """The best walk found.

    `edges` are numbers in the compiled graph, and the first one's clip is placed by p -> turn · p + move.
    `along` says how far along the path each frame counts; `expanded` states were followed, `cut` were dropped
    as no better or less promising; `stopped` is "" or says what ended the search before its end.
    """

    edges: Indices
    turn: complex
    move: complex
    along: Array
    cost: float
    expanded: int
    cut: int
    stopped: str


def start_states(graph: CompiledGraph, nodes: Indices, place: complex, heading: float) -> States:
    """Stand at each of some nodes, over a place and about to move in a direction (radians)."""
    states = np.zeros(len(nodes), STATE)
    states["node"], states["hop"] = nodes, -1
    states["turn"] = np.exp(1j * (heading - graph.going[nodes]))
    states["move"] = place - states["turn"] * graph.at[nodes]
    return states


def find_walk(graph: CompiledGraph, route: Route, starts: States, beam: Beam, prices: Prices) -> Found:
    """Find a walk from one of some starts to the end of a route.

    The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², and `prices`.
    One departure: after each hop s slides half-way to the point abreast, so that a walk which cuts a corner
    does not have to lose the metres that it saved.

    Returns
    -------
    The best walk; after Ctrl-C or when the time is over, the best so far.

    Raises
    ------
    NoWalk : where every walk ends before the route does.
    """
    run = _Run(graph, route, beam, prices)
    run.waiting[0] = [starts]
    stopped = ""
    try:
        stopped = run.to_the_end()
    except KeyboardInterrupt:
        stopped = "interrupted"
    return run.found(stopped)


class _Run:
    """A search under way: the states that wait in each layer, and how every state came about."""

    def __init__(self, graph: CompiledGraph, route: Route, beam: Beam, prices: Prices) -> None:
        self.graph, self.route, self.beam, self.prices = graph, route, beam, prices
        self.along = np.cumsum(np.maximum(graph.step, route.least / graph.fps))  # over all edges in a row
        self.hops = _Hops(graph, self.along)
        price = np.where(graph.blended, prices.seam + prices.match * graph.cost**2, 0.0)
        self.price = price[graph.last]
        self.ahead_along = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)
        self.waiting: dict[int, list[States]] = {}
        self.history: list[States] = []
        self.expanded = self.cut = 0
        self.best: States | None = None

    def to_the_end(self) -> str:
        """Work through the layers; say what stopped it before the last one."""
        deadline = time.monotonic() + self.beam.seconds
        last = int(self.route.length / self.beam.layer)
        for layer in self.beam.progress(range(last + 1)):
            while states := self.waiting.pop(layer, []):
                if time.monotonic() > deadline:
                    return "out of time"
                # Who has not left the layer goes on in it, or who lags would vie with those ahead.
                self.sort(self.follow(self.select(np.concatenate(states))), layer)
        return ""

    def select(self, states: States) -> States:
        """Keep the best of those that stand alike, and of these the `width` most promising."""
        beam, graph, node, turn = self.beam, self.graph, states["node"], states["turn"]
        body = (states["move"] + turn * graph.at[node]) / beam.place
        key = node
        clock = states["frames"] * (4 / graph.fps) * bool(len(self.route.others))  # they move on
        for value in (body.real, body.imag, np.angle(turn) / beam.turn, clock):
            key = (key << 12) + (np.floor(value).astype(np.int64) & 0xFFF)
        ahead = states["move"][:, None] + turn[:, None] * graph.ahead[node]
        off = _square(ahead - self.route.near(states["along"][:, None] + self.ahead_along[node]))
        if len(self.route.others):  # to give way takes longer: look twice and thrice as far
            further = ahead[:, -1:] + (ahead[:, -1:] - body[:, None] * beam.place) * [0, 1, 2]
            then = np.arange(1, 4) * round(graph.fps * AHEAD[-1])
            off += self.crowding(further, states["frames"][:, None] + then)
        loss = off.sum(axis=1) * graph.fps * AHEAD[0]  # each point ahead stands for the frames up to it
        order = np.argsort(states["cost"] + np.minimum(loss, beam.rescue), kind="stable")
        _, first = np.unique(key[order], return_index=True)
        first.sort()
        chosen = order[first[: beam.width]]
        self.cut += len(order) - len(chosen)
        return states[chosen]

    def follow(self, states: States) -> States:
        """Take every hop from some states."""
        graph, hops, before = self.graph, self.hops, self.expanded
        self.history.append(states)
        self.expanded += len(states)
        first = graph.hop_first[states["node"]]
        count = graph.hop_first[states["node"] + 1] - first
        of, hop = np.repeat(np.arange(len(first)), count), ranges(first, count)
        new, last = states[of], graph.last[hop]
        new["cost"] += self.price[hop] + self.wanting(new, hop)
        new["node"], new["hop"], new["trail"] = graph.target[last], hop, before + of
        new["move"] += new["turn"] * graph.move[last]
        new["turn"] *= graph.turn[last]
        new["frames"] += hops.frames[hop]
        new["along"] += hops.length[hop]
        new["along"] += self.slide(new, hops.length[hop] / 2)
        return new

    def slide(self, states: States, most: Array) -> Array:
        """Measure half the way along the path to where it passes the body."""
        body = states["move"] + states["turn"] * self.graph.at[states["node"]]
        way = self.route.ways[self.route.point(states["along"])]
        abreast = ((body - self.route.near(states["along"])) * way.conj()).real
        return np.asarray(np.minimum(np.maximum(abreast / 2, -most), most))

    def wanting(self, states: States, hop: Indices) -> Array:
        """Sum up over each hop's frames how far they are from what is wished."""
        graph, route, prices = self.graph, self.route, self.prices
        if not len(hop):
            return np.empty(0)
        row, along, of = self.hops.play(hop)
        along += states["along"][of]
        body = states["move"][of] + states["turn"][of] * graph.track[row]
        first = np.cumsum(self.hops.frames[hop]) - self.hops.frames[hop]
        off = _square(body - route.at(along))
        off += prices.stray * off**2
        if route.bare:
            return np.asarray(np.add.reduceat(off, first))
        point, frame = route.point(along), states["frames"][of] + np.arange(len(of)) - first[of]
        label, late = route.label[point], frame / graph.fps - route.clock[point]
        if graph.labels:
            off += prices.label * ((label >= 0) & ~graph.bears[label, row])
        off += prices.late * np.where(np.isnan(late), 0.0, late) ** 2
        off += self.crowding(body, frame)
        return np.asarray(np.add.reduceat(off, first))

    def crowding(self, body: Points, frame: Indices) -> Array:
        """Price how much too near a body is to others."""
        price = np.zeros(body.shape)
        for other in self.route.others:
            near = self.route.apart - np.abs(body - other[np.minimum(frame, len(other) - 1)])
            price += self.prices.crowding * np.maximum(near, 0.0) ** 2
        return price

    def sort(self, new: States, earliest: int) -> None:
        """Sort states into the layers they have reached; those at the end compete for the best."""
        done = new["along"] >= self.route.length
        if done.any():
            arrived = new[done]
            first = arrived["cost"].argmin()
            if self.best is None or arrived["cost"][first] < self.best["cost"][0]:
                self.best = arrived[first : first + 1]
            # No cost is below 0, so what costs as much as the best walk cannot become better.
            new = new[~done & (new["cost"] < self.best["cost"][0])]
        layer = np.maximum((new["along"] / self.beam.layer).astype(np.intp), earliest)
        for reached in set(layer.tolist()):
            self.waiting.setdefault(reached, []).append(new[layer == reached])

    def found(self, stopped: str) -> Found:
        """Trace the best walk back to its start; where none has arrived, the best of those under way."""
        if self.best is None and not stopped:
            reached = max(float(states["along"].max()) for states in self.history)
            raise NoWalk(f"Every walk ends after {reached:.1f} m of the path: prune the graph first.")
        if not self.history:
            raise NoWalk(f"The search was {stopped} before its first step.")
        best = self.history[-1][[self.history[-1]["cost"].argmin()]] if self.best is None else self.best
        history = np.concatenate(self.history)
        hops: list[int] = []
        states: list[int] = []
        state, hop = int(best["trail"][0]), int(best["hop"][0])
        while hop >= 0:
            hops.append(hop)
            states.append(state)
            state, hop = int(history["trail"][state]), int(history["hop"][state])
        if not hops:
            raise NoWalk(f"The search was {stopped} before its first step.")
        start = history[states[-1]]
        _, along, of = self.hops.play(np.array(hops[::-1]))
        along += history["along"][states[::-1]][of]
        edges = self.hops.edges(np.array(hops[::-1]))
        turn, move = complex(start["turn"]), complex(start["move"])
        return Found(edges, turn, move, along, float(best["cost"][0]), self.expanded, self.cut, stopped)


class _Hops:
    """The frames of hops: first those of the ride, then those of the edge that ends it."""

    def __init__(self, graph: CompiledGraph, along: Array) -> None:
        self.graph, self.along = graph, along
        ends = graph.track_first + graph.frames
        before = np.concatenate([[0.0], along])
        ride, last = graph.ride, graph.last
        # The stretches of a ride follow one another among the frames of all edges.
        self.first = np.stack([graph.track_first[ride], graph.track_first[last]], axis=1)
        ridden = np.where(graph.rides > 0, ends[ride + graph.rides - 1] - self.first[:, 0], 0)
        self.counts = np.stack([ridden, graph.frames[last]], axis=1)
        self.frames = self.counts.sum(axis=1)
        parts = before[self.first + self.counts] - before[self.first]
        self.length = parts.sum(axis=1)
        self.since = before[self.first] - np.stack([np.zeros(len(ride)), parts[:, 0]], axis=1)

    def play(self, hop: Indices) -> tuple[Indices, Array, Indices]:
        """Give for each frame of some hops its row among all, the metres since its hop began, and its hop."""
        counts = self.counts[hop].ravel()
        row = ranges(self.first[hop].ravel(), counts)
        along = self.along[row] - np.repeat(self.since[hop].ravel(), counts)
        return row, along, np.repeat(np.arange(len(hop)), self.frames[hop])

    def edges(self, hop: Indices) -> Indices:
        """List the edges of some hops."""
        rides = self.graph.rides[hop]
        first = np.stack([self.graph.ride[hop], self.graph.last[hop]], axis=1)
        return ranges(first.ravel(), np.stack([rides, np.ones_like(rides)], axis=1).ravel())


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
