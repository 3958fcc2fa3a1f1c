"""Search for a walk that follows a direction: prices of headings, discs, the time and the place of arrival.

The paper asks for such functions: "the user can supply an arbitrary function", the sum of a non-negative term
for each edge [KGP02, 4.2]. `DirectedSearch` adds terms to those of `PathSearch`, and ends a walk where it may
end: at any node, or at one in which the body stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import dataclass
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.steering.detours import Disc
from mocap.steering.layered_search import States
from mocap.steering.path_objective import Route, Settings
from mocap.steering.path_search import PathSearch
from mocap.steering.tuned import TUNED

Sums = dict[tuple[bytes, float, float], tuple[Array, Array]]
_SUMS: WeakKeyDictionary[CompiledGraph, Sums] = WeakKeyDictionary()
ENTERED_PRICE = 1e4  # m² for each frame in a disc, more than all other prices of a walk together
UNREACHED = 100.0  # metres or m², for nodes from which no way leads to an end
MARGIN = 0.1  # metres around a disc that count as inside, because a correction may move the walk later


@dataclass(frozen=True)
class Prices:
    """Prices of what a direction asks for beside the line; the unit is m², as in `Settings`.

    Parameters
    ----------
    position : factor of the squared distance from the end, m², where a walk stands.
    facing : factor of 2 - 2 cos of the error of the heading, where one is asked for at the end.
    heading : the same in each frame within `near` metres of a point that asks for a heading.
    near : the distance along the line from such a point, metres.
    arrival : factor of the squared delay (or advance) at the end in seconds.
    disc : factor of the squared depth in an enlarged disc in metres, in each frame.

    Examples
    --------
    >>> Prices().position
    30.0

    Notebook: 08b-steering
    """

    position: float = 30.0
    facing: float = 300.0
    heading: float = 0.3
    near: float = 0.3  # reads: name: public, and users give it as a keyword
    arrival: float = 20.0
    disc: float = 20.0


@dataclass(frozen=True, eq=False)
class Goal:
    """What a direction asks for on a route, for a graph of N nodes and T frames of edges.

    Parameters
    ----------
    allowed : shape (N,), the nodes at which a walk may end.
    must_stand : whether these stand, so that a walk must come near the end of the route to end.
    at_nodes, in_frames : shapes (N,) and (T,), the headings of the body, radians, in the coordinates of the
        clips.
    heading : the heading at the end, radians; None for any.
    seconds : the time of arrival; None for any.
    headings : pairs of metres along the route and the heading there.
    discs : centres and radii of enlarged discs.
    prices : the prices of deviations.
    """

    allowed: Mask
    must_stand: bool
    at_nodes: Array
    in_frames: Array
    heading: float | None = None
    seconds: float | None = None
    headings: Sequence[tuple[float, float]] = ()
    discs: Sequence[Disc] = ()
    prices: Prices = Prices()


class DirectedSearch(PathSearch):
    """A layered search for a walk along a route that ends where a goal allows it.

    Parameters
    ----------
    graph, route, starts, settings : as for `PathSearch`.
    goal : what is asked for beside the line.
    """

    def __init__(
        self, graph: CompiledGraph, route: Route, starts: States, settings: Settings, *, goal: Goal
    ) -> None:
        super().__init__(graph, route, starts, settings)
        self.goal = goal
        self.first = max(self.first, len(starts.node))  # the starts differ in the pose only
        if goal.must_stand:
            # The least distance (metres) and price of seams (m²) from each node to where a walk may end.
            self.to_end, self.price_to_end = self._estimates()

    def _estimates(self) -> tuple[Array, Array]:
        """Return the least sums to the ends, which are the same in each search with these prices of seams."""
        known_sums = _SUMS.setdefault(self.graph, {})
        key = (self.goal.allowed.tobytes(), self.settings.seam, self.settings.match)
        if key not in known_sums:
            values = (self.macro_edges.along, self.macro_edges.cost)
            lengths, prices = (least_sums(self.graph, value, self.goal.allowed) for value in values)
            known_sums[key] = (lengths, prices)
        return known_sums[key]

    def macro_edge_costs(self, states: States, chosen: Indices, macro_edge: Indices) -> Array:
        """Add the prices of headings along the route and of discs to those of a path."""
        costs = super().macro_edge_costs(states, chosen, macro_edge)
        goal = self.goal
        if not (len(macro_edge) and (goal.headings or goal.discs)):
            return costs
        row, number, along = self.frames_along(macro_edge, states.along[chosen])
        walk = chosen[number]
        counts = self.graph.macro_edges.frames[macro_edge]
        prices = np.zeros(len(row))
        rotation = states.rotation[walk]
        facing = np.angle(rotation) + goal.in_frames[row]
        for metres, heading in goal.headings:
            is_near = np.abs(along - metres) < goal.prices.near
            prices += np.where(is_near, goal.prices.heading * _missed(facing - heading), 0.0)
        body = states.translation[walk] + rotation * self.graph.ground[row]
        for centre, radius in goal.discs:
            depth = np.maximum(radius - np.abs(body - centre), 0.0)
            prices += goal.prices.disc * depth**2
            prices[depth > TUNED.clearances[-1] - MARGIN] += ENTERED_PRICE
        return costs + np.add.reduceat(prices, np.cumsum(counts) - counts)

    def expand(self, states: States) -> States:
        """Extend walks as `PathSearch` does, and add the prices of the end to those that arrive."""
        longer = super().expand(states)
        longer = longer.take(longer.along < self.route.length + TUNED.overshoot)
        cost = longer.cost + np.where(self.done(longer), self._costs_of_end(longer), 0.0)
        return longer._replace(cost=cost)

    def score(self, states: States) -> Array:
        """Add the least cost of coming to stand to the expected cost of walks.

        A walk that stops has to enter a clip that stops in time. Without this estimate, walks that go on
        would be better until it is too late.
        """
        scores = super().score(states)
        if not self.goal.must_stand:
            return scores
        remaining = self.route.length - states.along
        excess = np.maximum(np.minimum(self.to_end[states.node], UNREACHED) - remaining, 0.0)
        price = np.minimum(self.price_to_end[states.node], UNREACHED)
        return np.asarray(scores + price + self.goal.prices.position * excess**2)

    def _costs_of_end(self, states: States) -> Array:
        """Compute the prices of the place, the heading and the time at which walks end."""
        goal = self.goal
        prices = goal.prices
        costs = prices.position * np.abs(self._body(states) - self.route.points[-1]) ** 2
        if not goal.must_stand:
            costs = np.zeros(len(costs))
        if goal.heading is not None:
            costs += prices.facing * _missed(self.facing(states) - goal.heading)
        if goal.seconds is not None:
            costs += prices.arrival * (states.frames / self.graph.fps - goal.seconds) ** 2
        return np.asarray(costs)

    def facing(self, states: States) -> Array:
        """Return the headings of the body at the nodes of walks, radians."""
        return np.asarray(np.angle(states.rotation) + self.goal.at_nodes[states.node])

    def _body(self, states: States) -> Points:
        """Return the positions of the root at the nodes of walks."""
        return np.asarray(states.translation + states.rotation * self.graph.at[states.node])

    def layers(self, states: States) -> Indices:
        """Return the layers of walks. Those beyond the end of the route stay in its last layer."""
        return np.minimum(super().layers(states), int(self.route.length / TUNED.layer))

    # reads: name: all kinds of search define it
    def done(self, states: States) -> Mask:
        """Return which walks end: those at the end of the route, or that stand near it."""
        allowed = self.goal.allowed[states.node]
        if not self.goal.must_stand:
            return np.asarray(allowed & (states.along >= self.route.length))
        is_near = np.abs(self._body(states) - self.route.points[-1]) < TUNED.arrival
        return np.asarray(allowed & is_near & (states.along > self.route.length - TUNED.arrival))


def least_sums(graph: CompiledGraph, values: Array, ends: Mask) -> Array:
    """Compute the least sum of the values of macro-edges on a way from each node to one of some ends.

    Value iteration: d(n) = min over the macro-edges h from n of v(h) + d(target of h), and 0 at the ends.

    Parameters
    ----------
    graph : N nodes and H macro-edges.
    values : shape (H,), 0 or more.
    ends : shape (N,).

    Returns
    -------
    Shape (N,), inf for nodes from which no way leads to an end.

    Examples
    --------
    A clip of 90 frames has a transition from frame 60 to frame 20, and the end is the end of the clip:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)[:90]
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.compile_graph(graphs.from_transitions([clip], [back], window=10))
    >>> least_sums(graph, graph.macro_edges.frames * 1.0, np.array([False, False, False, True]))
    array([90., 70., 30.,  0.])
    """
    first = graph.macro_edges.first
    target = graph.target[graph.macro_edges.last]
    leaves = np.flatnonzero(np.diff(first))
    sums = np.where(ends, 0.0, np.inf)
    for _ in range(len(ends)):
        best = np.minimum.reduceat(values + sums[target], first[leaves]) if len(leaves) else sums[leaves]
        better = np.minimum(sums[leaves], best)
        if (better == sums[leaves]).all():
            break
        sums[leaves] = better
    return sums


def _missed(angle: Array) -> Array:
    """Return 2 - 2 cos of angles, about their squares if they are small."""
    return np.asarray(2 - 2 * np.cos(angle))
