"""The layered search for the best walk along a route: what its walks cost, and which of them go on.

1. Of the walks in a layer that stand alike, only the best one stays (dominance).
2. Of these, only the `width` best stay (the beam).
3. Each of them is lengthened by every hop that leaves its node, and put into the layer that it reaches.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.deadlines import OUT_OF_TIME, Deadline
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.body.planar import on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering.layered_search import EQUAL, LayeredSearch, States, hop_states, standing
from mocap.steering.path_objective import Route, Settings
from mocap.steering.tuned import TUNED

Watch = Callable[["PathSearch", States], None]
watching: ContextVar[Watch] = ContextVar("watching", default=lambda search, states: None)
"""A function that is called in each round with a search and its walks, the best first, to draw them."""


class Found(NamedTuple):
    """The best walk found.

    `edges` are numbers in the compiled graph; the transform of the first one's clip is
    p ↦ rotation · p + translation. `along` is each frame's progress along the path, metres. `expanded` is the
    number of walks that were extended, `cut` of those that were dropped. `stopped` is "", or the reason why
    the search ended early.
    """

    edges: Indices
    rotation: complex
    translation: complex
    along: Array
    cost: float
    expanded: int
    cut: int
    stopped: str


def find_walk(
    graph: CompiledGraph,
    route: Route,
    starts: States,
    settings: Settings,
    deadline: Deadline | None = None,
) -> Found:
    """Find the best walk from one of the starts to the end of a route.

    After Ctrl-C, or at the deadline, it is the best so far.

    Parameters
    ----------
    graph, route, starts, settings : as for `PathSearch`.
    deadline : of several searches; by default the one of the settings, from now on.

    Raises
    ------
    NoWalk : where every walk ends before the route does, or the search before its first step.
    """
    deadline = deadline or Deadline(settings.deadline)
    search = PathSearch(graph, route, starts, settings)
    try:
        for layer in settings.progress(range(int(route.length / TUNED.layer) + 1)):
            for walks in search.rounds(layer):
                watching.get()(search, walks)
                if deadline.is_over:
                    return search.best_walk(OUT_OF_TIME)
    except KeyboardInterrupt:
        return search.best_walk("interrupted")
    return search.best_walk("")


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
        self.graph = graph
        self.route = route
        self.settings = settings
        # Metres by which each frame of all edges moves on (T,).
        if route.own or route.label[0] >= 0:
            self.first = len(starts.node)  # all cost the same before they turn, or miss a label
        if route.own:
            self.progress = np.maximum(route.own.step, TUNED.creep / graph.fps)
        else:
            self.progress = graph.progress
        hops = graph.hops
        cumulated = np.concatenate([[0.0], np.cumsum(self.progress)])
        length = (cumulated[hops.starts + hops.counts] - cumulated[hops.starts]).sum(axis=1)  # (H,)
        price = np.where(graph.blended, settings.seam + settings.match * graph.cost**2, 0.0)
        self.hops = hop_states(graph, length, price)
        # Metres from each node in the next `GRAPH_TUNED.ahead` seconds (N, 3).
        self.ahead = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)

    def line(self, states: States) -> Points:
        """Return the positions on the ground that the first of some walks has passed, one for each hop."""
        steps = self.trace(states, 0)
        return np.asarray(steps.translation + steps.rotation * self.graph.at[steps.node])

    def expand(self, states: States) -> States:
        """Lengthen every walk by every hop that leaves its node.

        The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², plus the
        prices. One departure from the paper: after each hop s moves half-way to the point of the path
        abreast of the body, so that a walk which cuts a corner need not walk the metres that it saved; but
        it moves on by γ in each frame, unless times are asked for. `Wishes.slide` is the share of that
        distance. Walks that are laid on the path stay on it.
        """
        route = self.route
        row, hop = self.graph.hops.leaving(states.node)
        hops = self.hops.take(hop)
        cost = hops.cost + self.hop_costs(states, row, hop)
        longer = states.then(row, hops._replace(cost=cost))
        root = self.graph.at[longer.node]
        point = route.point(longer.along)
        direction = route.directions[point]
        is_timed = np.isfinite(route.clock).any()
        if route.own:
            rotation = np.exp(-1j * route.own.going[longer.node]) * direction
            longer = longer._replace(rotation=rotation, translation=route.at(longer.along) - rotation * root)
            in_time = longer.frames <= (longer.along / TUNED.slowest + TUNED.grace) * self.graph.fps
            return longer.take(in_time | is_timed)
        error = longer.translation + longer.rotation * root - route.points[point]
        abreast = np.clip((error * direction.conj()).real, -hops.along, hops.along)
        least_progress = np.where(is_timed, 0.0, GRAPH_TUNED.least_speed / self.graph.fps * hops.frames)
        progress = np.maximum(hops.along + route.wishes.slide * abreast, least_progress)
        return longer._replace(along=states.along[row] + progress)

    def frames_along(self, hop: Indices, start: Array) -> tuple[Indices, Indices, Array]:
        """List the frames that n hops play: their rows, which hop each belongs to, and metres along the path.

        `start` (n,) are the metres along the path at which each of the hops begins.
        """
        row, number = self.graph.hops.rows(hop)
        along = np.cumsum(self.progress[row])
        ends = along[np.cumsum(self.graph.hops.frames[hop]) - 1]
        return row, number, along + (start - ends + self.hops.along[hop])[number]

    def hop_costs(self, states: States, chosen: Indices, hop: Indices) -> Array:
        """Sum the costs of the frames of n hops (n,), which the walks `states.take(chosen)` take.

        They are the distance from the path, or what it costs to bend the walk, and missed wishes.
        """
        graph = self.graph
        route = self.route
        prices = self.settings
        if not len(hop):
            return np.empty(0)
        row, number, along = self.frames_along(hop, states.along[chosen])
        walk = chosen[number]
        first = np.cumsum(graph.hops.frames[hop]) - graph.hops.frames[hop]
        body = states.translation[walk] + states.rotation[walk] * graph.ground[row]
        if route.own:
            costs = self._bending_costs(route.own, row, along)
        else:
            costs = _square(body - route.at(along))
            costs += prices.stray * costs**2
        if route.bare:
            return np.asarray(np.add.reduceat(costs, first))
        point = route.point(along)
        if graph.label_names:
            label = route.label[point]
            is_missed = (label >= 0) & ~graph.bears[label, row]
            costs += np.where(is_missed, prices.label, 0.0)
        frame = states.frames[walk] + np.arange(len(walk)) - first[number]
        delay = frame / graph.fps - route.clock[point]  # seconds; nan for any time
        costs += prices.late * np.where(np.isnan(delay), 0.0, delay) ** 2
        costs += self.crowding(body, frame)
        return np.asarray(np.add.reduceat(costs, first))

    def _bending_costs(self, unbent: CompiledGraph, row: Indices, along: Array) -> Array:
        """Compute the costs of frames that are turned beyond what they turn themselves, or hardly move on."""
        step = unbent.step[row]
        bend = self.route.curvature[self.route.point(along)] * step - self.route.turns[row]  # radians
        costs = self.settings.bend * (bend * self.graph.fps) ** 2
        costs += np.where(step < GRAPH_TUNED.least_speed / self.graph.fps, TUNED.idle_price, 0.0)
        return costs

    def crowding(self, body: Points, frame: Indices) -> Array:
        """Compute the cost of bodies that are too near to others, of the shape of `body`."""
        cost = np.zeros(body.shape)
        for track in self.route.others:
            distance = np.abs(body - track[np.minimum(frame, len(track) - 1)])
            shortfall = self.route.wishes.apart - distance
            cost += self.settings.crowding * np.maximum(shortfall, 0.0) ** 2
        return cost

    def score(self, states: States) -> Array:
        """Rate walks by their cost plus the expected cost if their clips play on; small is good.

        Without the second term a walk that has just paid for a turn looks worse than one about to leave the
        path. The second term is at most `Settings.rescue` (m²), because a transition can still save the walk.
        """
        graph = self.graph
        route = self.route
        node = states.node
        line = route.points[route.point(states.along[:, None] + self.ahead[node])]
        if_played = states.translation[:, None] + states.rotation[:, None] * graph.ahead[node]
        ahead = line if route.own else if_played
        costs = _square(ahead - line)
        if len(route.others):  # to give way takes longer: look up to three times as far
            body = states.translation + states.rotation * graph.at[node]
            last = ahead[:, -1:]
            multiples = np.array(TUNED.give_way)
            farther = last + (last - body[:, None]) * multiples
            frames = (multiples + 1) * round(graph.fps * GRAPH_TUNED.ahead[-1])
            costs += self.crowding(farther, states.frames[:, None] + frames)
        first = GRAPH_TUNED.ahead[0]  # seconds; each point ahead stands for the frames up to it
        loss = costs.sum(axis=1) * graph.fps * first
        return np.asarray(states.cost + np.minimum(loss, self.settings.rescue))

    def cells(self, states: States) -> Indices:
        """Return the node, cells of the ground and of directions and, among others, the time."""
        alike = standing(states, self.graph.at, self.settings.alike, self.settings.alike)
        time = np.zeros(len(states.node), np.intp)
        if len(self.route.others):
            time = (states.frames * (TUNED.clock / self.graph.fps)).astype(np.intp)
        return np.concatenate([alike, time[None]])

    def layers(self, states: States) -> Indices:
        """Count layers of `TUNED.layer` metres along the path."""
        return (states.along / TUNED.layer).astype(np.intp)

    # reads: name: all kinds of search define it
    def done(self, states: States) -> Mask:
        """Check which walks are at the end of the route."""
        return states.along >= self.route.length

    def best_walk(self, stopped: str) -> Found:
        """Return the best walk; if none has arrived, the one of the last layer with the lowest cost."""
        if not self.arrived and not stopped:
            if self.route.own:
                raise too_slow(self.graph)
            reached = max(float(states.along.max()) for states in self.history)
            raise NoWalk(f"Every walk ends after {reached:.1f} m of the path: prune the graph first.")
        if not self.arrived and len(self.history) < 2:
            remedy = ": give it longer" if stopped == OUT_OF_TIME else ""
            raise NoWalk(f"The search was {stopped} before its first step{remedy}.")
        last = States.join(self.arrived or self.history[-1:])
        walk = self.trace(last, int(first_least(last.cost, EQUAL)))
        hops = walk.hop[1:]
        edges = self.graph.hops.edges(hops)
        _, _, along = self.frames_along(hops, walk.along[:-1])
        rotation = complex(walk.rotation[0])
        translation = complex(walk.translation[0])
        cost = float(walk.cost[-1])
        return Found(edges, rotation, translation, along, cost, self.expanded, self.cut, stopped)


def too_slow(graph: CompiledGraph, nearest: str = "") -> NoWalk:
    """Return the error that no walk follows a line, or what the `nearest` unbent walk does, with a reason."""
    fault = nearest or f"No walk goes along the line at {TUNED.slowest:g} m/s"
    clips = [on_ground(clip.root_positions) for clip in graph.source.clips]
    speeds = [np.percentile(np.abs(np.diff(clip)), 90) * graph.fps for clip in clips]
    walking = [speed for speed in speeds if speed > TUNED.walking_speed]
    if not walking:
        return NoWalk(f"{fault}; no clip goes faster than {TUNED.walking_speed:g} m/s: add some that walk.")
    reason = f"{len(walking)} of {len(clips)} clips go faster than {TUNED.walking_speed:g} m/s"
    remedy = (
        "try a larger threshold, more walks, or `bend`"
        if nearest
        else "try a larger threshold, or more walks"
    )
    return NoWalk(f"{fault}; {reason}, but few transitions join their steps: {remedy}.")


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
