"""The layered search for the best walk along a route: what its walks cost, and which of them go on.

1. Of the walks in a layer that stand alike, only the best one stays (dominance).
2. Of these, only the `width` best stay (the beam).
3. Each of them is lengthened by every hop that leaves its node, and put into the layer that it reaches.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.ties import first_least
from mocap.body.planar import on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import AHEAD, LEAST, CompiledGraph
from mocap.steering.layered_search import EQUAL, LayeredSearch, States, hop_states, standing
from mocap.steering.path_objective import Route, Settings

LAYER = 0.15  # metres of path
IDLE = 0.1  # m²: the price of a frame of a bent walk that moves on by less than the least progress
SLOWEST, GRACE = 0.3, 4.0  # metres per second, seconds: a bent walk that falls behind is dropped
QUICK = 0.5  # metres per second: clips that walk
CREEP = 0.05  # metres per second: the least progress of a walk that is laid on the path, so that searches end


Watch = Callable[["PathSearch", States], None]
watching: ContextVar[Watch] = ContextVar("watching", default=lambda search, states: None)
"""Called in each round with a search under way and its walks, the best first: whoever draws them sets it."""


class Found(NamedTuple):
    """The best walk found.

    `edges` are numbers in the compiled graph; the first one's clip is placed by p ↦ turn · p + move. `along`
    gives each frame's progress along the path, metres. `expanded` counts the walks that were lengthened,
    `cut` those that were dropped. `stopped` is "", or the reason why the search ended early.
    """

    edges: Indices
    turn: complex
    move: complex
    along: Array
    cost: float
    expanded: int
    cut: int
    stopped: str


def find_walk(graph: CompiledGraph, route: Route, starts: States, settings: Settings) -> Found:
    """Find the best walk from one of the starts to the end of a route.

    After Ctrl-C it is the best so far.

    Raises
    ------
    NoWalk : where every walk ends before the route does, or the search before its first step.
    """
    search = PathSearch(graph, route, starts, settings)
    try:
        for layer in settings.progress(range(int(route.length / LAYER) + 1)):
            for walks in search.rounds(layer):
                watching.get()(search, walks)
    except KeyboardInterrupt:
        return search.found("interrupted")
    return search.found("")


class PathSearch(LayeredSearch):
    """A search along a route, with H hops of T frames together and N nodes.

    Parameters
    ----------
    graph, route : the graph, and the path with its wishes.
    starts : where walks start.
    settings : how thoroughly to search, and what deviations cost.
    """

    def __init__(self, graph: CompiledGraph, route: Route, starts: States, settings: Settings) -> None:
        super().__init__(starts, settings.width_on(route))
        self.graph, self.route, self.settings = graph, route, settings
        hops, own = graph.hops, route.own
        if own:
            self.first = len(starts.node)  # all cost the same before they turn
        # Metres by which each frame of all edges moves on (T,), and each hop (H,).
        self.progress = np.maximum(own.step, CREEP / graph.fps) if own else graph.progress
        before = np.concatenate([[0.0], np.cumsum(self.progress)])
        length = (before[hops.starts + hops.counts] - before[hops.starts]).sum(axis=1)
        price = np.where(graph.blended, settings.seam + settings.match * graph.cost**2, 0.0)
        self.hops = hop_states(graph, length, price)
        # Metres from each node in the next `AHEAD` seconds (N, 3).
        self.ahead = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)

    def line(self, states: States) -> Points:
        """Give where the first of some walks has come from, a point for each hop."""
        steps = self.trace(states, 0)
        return np.asarray(steps.move + steps.turn * self.graph.at[steps.node])

    def expand(self, states: States) -> States:
        """Lengthen every walk by every hop that leaves its node.

        The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², plus the
        prices. One departure from the paper: after each hop s moves half-way to the point of the path
        abreast of the body, so that a walk which cuts a corner need not walk the metres that it saved; but
        it moves on by γ in each frame, unless times are asked for. `Wishes.slide` is the share of that
        distance. Walks that are laid on the path stay on it.
        """
        of, hop = self.graph.hops.leaving(states.node)
        hops, route = self.hops.take(hop), self.route
        new = states.then(of, hops._replace(cost=hops.cost + self.hop_costs(states, of, hop)))
        at, point = self.graph.at[new.node], route.point(new.along)
        if route.own:
            turn = np.exp(-1j * route.own.going[new.node]) * route.ways[point]
            new = new._replace(turn=turn, move=route.at(new.along) - turn * at)
            in_time = new.frames <= (new.along / SLOWEST + GRACE) * self.graph.fps
            return new.take(in_time | np.isfinite(route.clock).any())
        off = new.move + new.turn * at - route.points[point]
        abreast = np.clip((off * route.ways[point].conj()).real, -hops.along, hops.along)
        least = LEAST / self.graph.fps * hops.frames * ~np.isfinite(route.clock).any()
        moved = np.maximum(hops.along + route.wishes.slide * abreast, least)
        return new._replace(along=states.along[of] + moved)

    def frames_along(self, hop: Indices, start: Array) -> tuple[Indices, Indices, Array]:
        """List the frames that n hops play: their rows, which hop each belongs to, and metres along the path.

        `start` (n,) are the metres along the path at which each of the hops begins.
        """
        row, of = self.graph.hops.rows(hop)
        along = np.cumsum(self.progress[row])
        ends = along[np.cumsum(self.graph.hops.frames[hop]) - 1]
        return row, of, along + (start - ends + self.hops.along[hop])[of]

    def hop_costs(self, states: States, chosen: Indices, hop: Indices) -> Array:
        """Sum the costs of the frames of n hops (n,), which the walks `states.take(chosen)` take.

        They are the distance from the path, or what it costs to bend the walk, and missed wishes.
        """
        graph, route, prices = self.graph, self.route, self.settings
        if not len(hop):
            return np.empty(0)
        row, number, along = self.frames_along(hop, states.along[chosen])
        of = chosen[number]
        first = np.cumsum(graph.hops.frames[hop]) - graph.hops.frames[hop]
        body = states.move[of] + states.turn[of] * graph.ground[row]
        if own := route.own:  # radians that a frame is turned beyond what it turns itself
            turned = route.curvature[route.point(along)] * own.step[row] - route.turns[row]
            off = prices.bend * (turned * graph.fps) ** 2
            off += IDLE * (own.step[row] < LEAST / graph.fps)
        else:
            off = _square(body - route.at(along))
            off += prices.stray * off**2
        if route.bare:
            return np.asarray(np.add.reduceat(off, first))
        point, frame = route.point(along), states.frames[of] + np.arange(len(of)) - first[number]
        label, late = route.label[point], frame / graph.fps - route.clock[point]
        if graph.label_names:
            off += prices.label * ((label >= 0) & ~graph.bears[label, row])
        off += prices.late * np.where(np.isnan(late), 0.0, late) ** 2
        off += self.crowding(body, frame)
        return np.asarray(np.add.reduceat(off, first))

    def crowding(self, body: Points, frame: Indices) -> Array:
        """Compute the cost of bodies that are too near to others, of the shape of `body`."""
        price = np.zeros(body.shape)
        for other in self.route.others:
            near = self.route.wishes.apart - np.abs(body - other[np.minimum(frame, len(other) - 1)])
            price += self.settings.crowding * np.maximum(near, 0.0) ** 2
        return price

    def score(self, states: States) -> Array:
        """Rate walks by their cost plus the expected cost if their clips play on; small is good.

        Without the second term a walk that has just paid for a turn looks worse than one about to leave the
        path. The second term is at most `Settings.rescue` (m²), because a transition can still save the walk.
        """
        graph, node, route = self.graph, states.node, self.route
        line = route.points[route.point(states.along[:, None] + self.ahead[node])]
        ahead = line if route.own else states.move[:, None] + states.turn[:, None] * graph.ahead[node]
        off = _square(ahead - line)
        if len(route.others):  # to give way takes longer: look up to three times as far
            body = states.move + states.turn * graph.at[node]
            further = ahead[:, -1:] + (ahead[:, -1:] - body[:, None]) * [0, 1, 2]
            then = np.arange(1, 4) * round(graph.fps * AHEAD[-1])
            off += self.crowding(further, states.frames[:, None] + then)
        loss = off.sum(axis=1) * graph.fps * AHEAD[0]  # each point ahead stands for the frames up to it
        return np.asarray(states.cost + np.minimum(loss, self.settings.rescue))

    def cells(self, states: States) -> Indices:
        """Give the node, cells of the ground and of directions and, among others, the time."""
        alike = standing(states, self.graph.at, self.settings.alike, self.settings.alike)
        clock = states.frames * (4 / self.graph.fps) * bool(len(self.route.others))
        return np.concatenate([alike, clock.astype(np.intp)[None]])

    def layers(self, states: States) -> Indices:
        """Count layers of `LAYER` metres along the path."""
        return (states.along / LAYER).astype(np.intp)

    def done(self, states: States) -> Mask:
        """Say which walks are at the end of the route."""
        return states.along >= self.route.length

    def found(self, stopped: str) -> Found:
        """Give the best walk; where none has arrived, the cheapest of the last layer."""
        if not self.arrived and not stopped:
            if self.route.own:
                raise too_slow(self.graph)
            reached = max(float(states.along.max()) for states in self.history)
            raise NoWalk(f"Every walk ends after {reached:.1f} m of the path: prune the graph first.")
        if not self.arrived and len(self.history) < 2:
            raise NoWalk(f"The search was {stopped} before its first step.")
        last = States.join(self.arrived or self.history[-1:])
        walk = self.trace(last, int(first_least(last.cost, EQUAL)))
        hops = walk.hop[1:]
        along, edges = self.frames_along(hops, walk.along[:-1])[2], self.graph.hops.edges(hops)
        turn, move, cost = complex(walk.turn[0]), complex(walk.move[0]), float(walk.cost[-1])
        return Found(edges, turn, move, along, cost, self.expanded, self.cut, stopped)


def too_slow(graph: CompiledGraph, nearest: str = "") -> NoWalk:
    """Say that no walk goes on along a line as people walk, or how the `nearest` unbent one does, and why."""
    fault = nearest or f"No walk goes along the line at {SLOWEST:g} m/s"
    clips = [on_ground(clip.root_positions) for clip in graph.source.clips]
    quick = [clip for clip in clips if np.percentile(np.abs(np.diff(clip)), 90) * graph.fps > QUICK]
    some = f"{len(quick)} of {len(clips)} clips go faster than {QUICK:g} m/s"
    helps = f"{some}, but few transitions join their steps: try a larger threshold, "
    helps += "more walks, or `bend`" if nearest else "or more walks"
    slow = f"no clip goes faster than {QUICK:g} m/s: add some that walk"
    return NoWalk(f"{fault}; {helps if quick else slow}.")


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
