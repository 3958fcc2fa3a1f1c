"""Beam search for the best walk along a route: the costs of walks, and the selection in each layer.

1. Of the walks of a layer in the same cell (node, position and direction), only the best is kept (dominance).
2. Of these, only the `width` best are kept (the beam width).
3. Each of them is extended by every macro-edge that leaves its node, and enters the layer that it
reaches.
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
from mocap.errors import NoWalk, Remedy
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering.layered_search import EQUAL, LayeredSearch, States, macro_edge_states, standing
from mocap.steering.path_objective import Route, Settings
from mocap.steering.tuned import TUNED

Watch = Callable[["PathSearch", States], None]
watching: ContextVar[Watch] = ContextVar("watching", default=lambda search, states: None)
"""A callback to draw a search: called in each round with the search and its kept walks, the best first."""


class Found(NamedTuple):
    """The result of a search, its best walk.

    `edges` are numbers in the compiled graph, and p ↦ rotation · p + translation is the transform of the clip
    of the first edge. `along` is the arc length along the path in each frame, metres. `expanded` is the
    number of walks that were extended, `cut` the number of those that were dropped. `stopped` is "", or the
    reason for which the search ended early. `waited` is the number of frames before the first one, in which
    the body waits, for a search that chooses among them.
    """

    edges: Indices
    rotation: complex
    translation: complex
    along: Array
    cost: float
    expanded: int
    cut: int
    stopped: str
    waited: int = 0


def find_walk(  # noqa: PLR0913 (a search, its limits and its kind)
    graph: CompiledGraph,
    route: Route,
    starts: States,
    settings: Settings,
    deadline: Deadline | None = None,
    kind: Callable[[CompiledGraph, Route, States, Settings], PathSearch] | None = None,
) -> Found:
    """Find the best walk from one of the starts to the end of a route.

    After Ctrl-C, or at the deadline, the best walk so far is returned.

    Parameters
    ----------
    graph, route, starts, settings : as for `PathSearch`.
    deadline : a deadline shared by several searches, by default that of the settings, from the call.
    kind : creates the search, by default a `PathSearch`.

    Raises
    ------
    NoWalk : if every walk ends before the route, or the search was stopped before its first step.
    """
    deadline = deadline or Deadline(settings.deadline)
    search = (kind or PathSearch)(graph, route, starts, settings)
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
    """A layered search for a walk along a route, in a graph of N nodes, T frames and H macro-edges.

    Parameters
    ----------
    graph : the compiled graph.
    route : the path and the requests along it.
    starts : the initial walks.
    settings : the effort of the search, and the prices of deviations.
    """

    def __init__(self, graph: CompiledGraph, route: Route, starts: States, settings: Settings) -> None:
        super().__init__(starts, settings.width_on(route))
        self.graph = graph
        self.route = route
        self.settings = settings
        if route.smooth or route.label[0] >= 0:
            self.first = len(starts.node)  # keep all starts: their costs do not differ before the first step
        # The progress along the path in each frame of all edges, metres (T,).
        if route.smooth:
            self.progress = np.maximum(route.smooth.step, TUNED.creep / graph.fps)
        else:
            self.progress = graph.progress
        self.is_timed = bool(np.isfinite(route.clock).any())
        kept = set(route.request.kept)
        self.is_new = np.array([edge not in kept for edge in graph.edges]) if kept else None
        macro_edges = graph.macro_edges
        cumulated = np.concatenate([[0.0], np.cumsum(self.progress)])
        stops = macro_edges.starts + macro_edges.counts
        length = (cumulated[stops] - cumulated[macro_edges.starts]).sum(axis=1)  # (H,)
        price = np.where(graph.blended, settings.seam + settings.match * graph.cost**2, 0.0)
        self.macro_edges = macro_edge_states(graph, length, price)
        # The arc length of the root's track from each node after `GRAPH_TUNED.ahead` seconds, metres (N, 3).
        self.ahead = np.cumsum(np.abs(np.diff(graph.ahead, axis=1, prepend=graph.at[:, None])), axis=1)

    def line(self, states: States) -> Points:
        """Return the root positions on the ground at the nodes of the first of some walks."""
        steps = self.trace(states, 0)
        return np.asarray(steps.translation + steps.rotation * self.graph.at[steps.node])

    def expand(self, states: States) -> States:
        """Extend every walk by every macro-edge that leaves its node.

        The cost of an edge is that of [KGP02, Eq. 9], g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖², plus the
        prices. One departure from the paper: after each macro-edge, s is moved half-way to the projection of
        the body on the path, so that a walk that cuts a corner does not have to catch up the distance saved.
        The progress remains at least γ in each frame, unless times are requested. `PathRequest.correction` is
        the fraction, one half by default. Bent walks stay on the path.
        """
        route = self.route
        row, macro_edge = self.graph.macro_edges.leaving(states.node)
        macro_edges = self.macro_edges.take(macro_edge)
        cost = macro_edges.cost + self.macro_edge_costs(states, row, macro_edge)
        longer = states.then(row, macro_edges._replace(cost=cost))
        root = self.graph.at[longer.node]
        point = route.point(longer.along)
        direction = route.directions[point]
        if route.smooth:
            rotation = np.exp(-1j * route.smooth.going[longer.node]) * direction
            longer = longer._replace(rotation=rotation, translation=route.at(longer.along) - rotation * root)
            in_time = longer.frames <= (longer.along / TUNED.slowest + TUNED.grace) * self.graph.fps
            return longer.take(in_time | self.is_timed)
        error = longer.translation + longer.rotation * root - route.points[point]
        abreast = np.clip((error * direction.conj()).real, -macro_edges.along, macro_edges.along)
        least_step = GRAPH_TUNED.least_speed / self.graph.fps  # metres in a frame
        least_progress = np.where(self.is_timed, 0.0, least_step * macro_edges.frames)
        progress = np.maximum(macro_edges.along + route.request.correction * abreast, least_progress)
        return longer._replace(along=states.along[row] + progress)

    def frames_along(self, macro_edge: Indices, start: Array) -> tuple[Indices, Indices, Array]:
        """Return the frames of n macro-edges: rows, indices into `macro_edge`, and arc lengths on the path.

        `start` (n,) are the arc lengths at which the macro-edges begin.
        """
        row, number = self.graph.macro_edges.rows(macro_edge)
        along = np.cumsum(self.progress[row])
        ends = along[np.cumsum(self.graph.macro_edges.frames[macro_edge]) - 1]
        return row, number, along + (start - ends + self.macro_edges.along[macro_edge])[number]

    def macro_edge_costs(self, states: States, chosen: Indices, macro_edge: Indices) -> Array:
        """Compute the costs (n,) of n macro-edges, by which the walks `states.take(chosen)` are extended.

        A cost is the sum over frames of the squared distance from the path, or of the price of bending the
        walk, and of the prices of unmet requests.
        """
        graph = self.graph
        route = self.route
        prices = self.settings
        if not len(macro_edge):
            return np.empty(0)
        row, number, along = self.frames_along(macro_edge, states.along[chosen])
        walk = chosen[number]
        first = np.cumsum(graph.macro_edges.frames[macro_edge]) - graph.macro_edges.frames[macro_edge]
        body = states.translation[walk] + states.rotation[walk] * graph.ground[row]
        if route.smooth:
            costs = self._bending_costs(route.smooth, row, along)
        else:
            costs = _square(body - route.at(along))
            costs += prices.stray * costs**2
        costs += self.frame_prices(states, walk, row, along, body)
        if route.bare:
            return np.asarray(np.add.reduceat(costs, first))
        if self.is_new is not None:
            costs += np.where(self.is_new[graph.of[row]], prices.change, 0.0)
        point = route.point(along)
        if graph.label_names:
            label = route.label[point]
            is_missed = (label >= 0) & ~graph.bears[label, row]
            costs += np.where(is_missed, prices.label, 0.0)
        frame = states.frames[walk] + np.arange(len(walk)) - first[number]
        delay = frame / graph.fps - route.clock[point]  # seconds, nan if no time is requested
        costs += prices.late * np.where(np.isnan(delay), 0.0, delay) ** 2
        costs += self.crowding(body, frame)
        return np.asarray(np.add.reduceat(costs, first))

    def frame_prices(
        self, states: States, walk: Indices, row: Indices, along: Array, body: Points
    ) -> Array | float:
        """Return further prices of frames; 0 here, for other kinds of search to define.

        Parameters
        ----------
        states : the walks before a step.
        walk, row, along, body : for each frame of the step the index of its walk, its row in the arrays of
            all frames, its arc length, and the position of the root.
        """
        return 0.0

    def _bending_costs(self, unbent: CompiledGraph, row: Indices, along: Array) -> Array:
        """Compute the costs of bending: those of added rotation, and of frames with little progress."""
        step = unbent.step[row]
        bend = self.route.curvature[self.route.point(along)] * step - self.route.rotations[row]  # radians
        costs = self.settings.bend * (bend * self.graph.fps) ** 2
        costs += np.where(step < GRAPH_TUNED.least_speed / self.graph.fps, TUNED.idle_price, 0.0)
        return costs

    def crowding(self, body: Points, frame: Indices) -> Array:
        """Compute the cost of bodies that are too near to others, with the shape of `body`."""
        cost = np.zeros(body.shape)
        for track in self.route.others:
            distance = np.abs(body - track[np.minimum(frame, len(track) - 1)])
            shortfall = self.route.request.apart - distance
            cost += self.settings.crowding * np.maximum(shortfall, 0.0) ** 2
        return cost

    def score(self, states: States) -> Array:
        """Compute the cost of walks plus the expected cost of continuing their clips (lower is better).

        Without the expected cost, a walk that has just paid for a change of direction would be ranked behind
        one that is about to leave the path. It is at most `Settings.rescue` (m²), because a transition may
        lead the walk back.
        """
        graph = self.graph
        route = self.route
        node = states.node
        line = route.points[route.point(states.along[:, None] + self.ahead[node])]
        if_played = states.translation[:, None] + states.rotation[:, None] * graph.ahead[node]
        ahead = line if route.smooth else if_played
        costs = _square(ahead - line)
        if len(route.others):  # avoiding others takes longer: look ahead up to three times as far
            body = states.translation + states.rotation * graph.at[node]
            last = ahead[:, -1:]
            multiples = np.array(TUNED.wider_views)
            farther = last + (last - body[:, None]) * multiples
            frames = (multiples + 1) * round(graph.fps * GRAPH_TUNED.ahead[-1])
            costs += self.crowding(farther, states.frames[:, None] + frames)
        first = GRAPH_TUNED.ahead[0]  # seconds. A point ahead represents the frames before it
        expected = costs.sum(axis=1) * graph.fps * first
        return np.asarray(states.cost + np.minimum(expected, self.settings.rescue))

    def cells(self, states: States) -> Indices:
        """Return cells of node, position and direction and, if there are others, of time (5, N)."""
        cells = standing(states, self.graph.at, self.settings.cell, self.settings.cell)
        time = np.zeros(len(states.node), np.intp)
        if len(self.route.others):
            time = (states.frames * (TUNED.clock / self.graph.fps)).astype(np.intp)
        return np.concatenate([cells, time[None]])

    def layers(self, states: States) -> Indices:
        """Return the layers of walks, each of `TUNED.layer` metres along the path."""
        return (states.along / TUNED.layer).astype(np.intp)

    # reads: name: all kinds of search define it
    def done(self, states: States) -> Mask:
        """Return which walks have reached the end of the route."""
        return states.along >= self.route.length

    def best_walk(self, stopped: str) -> Found:
        """Return the walk of least cost at the end of the route, or in the last layer if none has arrived."""
        if not self.arrived and not stopped:
            if self.route.smooth:
                raise too_slow(self.graph)
            reached = max(float(states.along.max()) for states in self.history)
            raise NoWalk(f"Every walk ends after {reached:.1f} m of the path: prune the graph first.")
        if not self.arrived and len(self.history) < 2:
            remedy = ": give it longer" if stopped == OUT_OF_TIME else ""
            raise NoWalk(f"The search was {stopped} before its first step{remedy}.")
        last = States.join(self.arrived or self.history[-1:])
        walk = self.trace(last, int(first_least(last.cost, EQUAL)))
        macro_edges = walk.macro_edge[1:]
        edges = self.graph.macro_edges.edges(macro_edges)
        _, _, along = self.frames_along(macro_edges, walk.along[:-1])
        rotation = complex(walk.rotation[0])
        translation = complex(walk.translation[0])
        cost = float(walk.cost[-1])
        counts = (self.expanded, self.cut)
        return Found(edges, rotation, translation, along, cost, *counts, stopped, int(walk.frames[0]))


def too_slow(graph: CompiledGraph, nearest: str = "") -> NoWalk:
    """Return the error that no walk follows a line, with a probable reason.

    `nearest` describes the nearest walk found without bending. It replaces the first sentence.
    """
    fault = nearest or f"No walk goes along the line at {TUNED.slowest:g} m/s"
    clips = [on_ground(clip.root_positions) for clip in graph.source.clips]
    speeds = [np.percentile(np.abs(np.diff(clip)), 90) * graph.fps for clip in clips]
    walking = [speed for speed in speeds if speed > TUNED.walking_speed]
    if not walking:
        return NoWalk(f"{fault}; no clip goes faster than {TUNED.walking_speed:g} m/s: add some that walk.")
    reason = f"{len(walking)} of {len(clips)} clips go faster than {TUNED.walking_speed:g} m/s"
    problem = f"{fault}; {reason}, but few transitions join their steps"
    if nearest:
        return NoWalk(f"{problem}.", remedy=Remedy("try a larger threshold, more walks, or {}", "bend"))
    return NoWalk(f"{problem}: try a larger threshold, or more walks.")


def _square(numbers: Points) -> Array:
    return np.asarray(numbers.real**2 + numbers.imag**2)
