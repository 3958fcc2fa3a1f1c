"""Search for a walk that follows a direction: prices of headings, discs, the time and the place of arrival.

The paper asks for such functions: "the user can supply an arbitrary function", the sum of a non-negative term
for each edge [KGP02, 4.2]. `DirectedSearch` adds terms to those of `PathSearch`, and ends a walk where it may
end: at any node, or at one in which the body stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

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
    arrival : factor of the squared delay (or advance) in seconds, at each point that asks for a time.
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
    """The request of a direction on a route, for a graph of N nodes and T frames of edges.

    Parameters
    ----------
    allowed : shape (N,), the nodes at which a walk may end.
    must_stand : whether these stand, so that a walk must come near the end of the route to end.
    starts_standing : whether the body stands at the start.
    at_nodes, in_frames : shapes (N,) and (T,), the headings of the body, radians, in the coordinates of the
        clips.
    heading : the heading at the end, radians; None for any.
    times : pairs of metres along the route and the time there, seconds.
    paces : the usual and the fast pace of the clips, m/s, by which delays are expected.
    headings : pairs of metres along the route and the heading there.
    discs : centres and radii of enlarged discs.
    prices : the prices of deviations.
    """

    allowed: Mask
    must_stand: bool
    at_nodes: Array
    in_frames: Array
    heading: float | None = None
    times: Sequence[tuple[float, float]] = ()
    paces: tuple[float, float] = (1.0, 1.0)
    starts_standing: bool = False
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
        self.is_timed = bool(goal.times)
        starting = TUNED.starting_metres if goal.starts_standing else 0.0
        stopping = TUNED.starting_metres if goal.must_stand else 0.0
        length = route.length
        # Arc lengths, and the distances that take as long at a constant pace: half of it at a start or stop.
        self.knots = np.array([0.0, starting, max(starting, length - stopping), max(starting, length)])
        self.paced = self.knots + starting * np.array([0, 1, 1, 1]) + stopping * np.array([0, 0, 0, 1])
        self.paced_times = [(float(self._paced(metres)), seconds) for metres, seconds in goal.times]
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

    def frame_prices(
        self, states: States, walk: Indices, row: Indices, along: Array, body: Points
    ) -> Array | float:
        """Return the prices of headings along the route and of discs."""
        goal = self.goal
        if not (goal.headings or goal.discs):
            return 0.0
        prices = np.zeros(len(row))
        for metres, heading in goal.headings:
            frames = np.flatnonzero(np.abs(along - metres) < goal.prices.near)
            facing = np.angle(states.rotation[walk[frames]]) + goal.in_frames[row[frames]]
            prices[frames] += goal.prices.heading * _missed(facing - heading)
        for centre, radius in goal.discs:
            frames = np.flatnonzero(np.abs(body - centre) < radius)
            depth = radius - np.abs(body[frames] - centre)
            is_inside = depth > TUNED.clearances[-1] - MARGIN
            prices[frames] += goal.prices.disc * depth**2 + np.where(is_inside, ENTERED_PRICE, 0.0)
        return prices

    def expand(self, states: States) -> States:
        """Extend walks as `PathSearch` does, and add the prices of times, and those of the end on arrival.

        With times, walks may stand for a while. They end if they are too late even for a very slow walk.
        """
        longer = super().expand(states)
        fits = longer.along < self.route.length + TUNED.overshoot
        if self.goal.times:
            fits &= self._is_in_time(longer)
        longer = longer.take(fits)
        cost = longer.cost + self._costs_of_times(states, longer)
        cost += np.where(self.done(longer), self._costs_of_end(longer), 0.0)
        return longer._replace(cost=cost)

    def _paced(self, along: ArrayLike) -> Array:
        """Return the distances that take as long at a constant pace as arc lengths of the route."""
        return np.asarray(np.interp(np.asarray(along), self.knots, self.paced))

    def _is_in_time(self, states: States) -> Mask:
        """Return which walks are not slower than `TUNED.slowest` beyond the next time that is asked for."""
        metres, seconds = np.array(self.goal.times).T
        following = seconds[np.minimum(np.searchsorted(metres, states.along), len(metres) - 1)]
        latest = following + states.along / TUNED.slowest + TUNED.grace
        return np.asarray(states.frames < latest * self.graph.fps)

    def _costs_of_times(self, states: States, longer: States) -> Array:
        """Compute the prices of delays at the points that walks pass in their last step, from `states`."""
        costs = np.zeros(len(longer.node))
        start = states.along[longer.trail]
        for metres, seconds in self.goal.times:
            passing = np.flatnonzero((start < metres) & (longer.along >= metres))
            if metres < self.route.length and len(passing):
                first = states.frames[longer.trail[passing]]
                fraction = (metres - start[passing]) / (longer.along - start)[passing]
                frame = first + fraction * (longer.frames[passing] - first)
                costs[passing] += self.goal.prices.arrival * (frame / self.graph.fps - seconds) ** 2
        return costs

    def score(self, states: States) -> Array:
        """Add the expected price of the next time, and the least cost of coming to stand, to those of walks.

        A walk that stops has to enter a clip that stops in time. Without this estimate, walks that go on
        would be better until it is too late.
        """
        scores = super().score(states)
        if self.goal.times:
            seconds = states.frames / self.graph.fps
            delays = expected_delays(self.paced_times, self.goal.paces, self._paced(states.along), seconds)
            scores = scores + self.goal.prices.arrival * delays**2
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
        if goal.times and goal.times[-1][0] >= self.route.length:
            costs += prices.arrival * (states.frames / self.graph.fps - goal.times[-1][1]) ** 2
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


def expected_delays(
    times: Sequence[tuple[float, float]], paces: tuple[float, float], along: Array, seconds: Array
) -> Array:
    """Estimate the delays of walks at the next point that asks for a time.

    A walk is late if even the fast pace brings it there too late, and early (negative) if the usual pace
    brings it there too early. Between them, and after the last point, 0 is expected.

    Parameters
    ----------
    times : pairs of metres along a route and the time there, seconds.
    paces : the usual and the fast pace, m/s.
    along, seconds : shape (N,), the arc lengths of the walks, and their times.

    Examples
    --------
    Four metres are left for 2, 3 and 6 seconds. They take 4 s at the usual pace, and 2.5 s at the fast one:

    >>> expected_delays([(4.0, 6.0)], (1.0, 1.6), np.zeros(3), np.array([4.0, 3.0, 0.0])).tolist()
    [0.5, 0.0, -2.0]
    """
    metres, moments = np.array([*times, (np.inf, np.nan)]).T
    number = np.searchsorted(metres, along, side="right")
    distance = np.where(np.isfinite(metres[number]), metres[number] - along, 0.0)
    usual, fast = paces
    duration = moments[number] - seconds
    delays = np.maximum(distance / fast - duration, 0.0) + np.minimum(distance / usual - duration, 0.0)
    return np.asarray(np.nan_to_num(delays))


def attainable_times(
    times: Sequence[tuple[float, float]], pace: float, seconds: float
) -> list[tuple[float, float]]:
    """Replace the times along a route that a pace cannot keep by the earliest that it can.

    If a walk is late anyway, the price of its delay would otherwise exceed all others.

    Parameters
    ----------
    times : pairs of metres along the route and the time there, seconds.
    pace : m/s.
    seconds : the time at the start of the route.

    Examples
    --------
    >>> attainable_times([(4.0, 2.0), (8.0, 12.0)], pace=1.0, seconds=0.0)
    [(4.0, 4.0), (8.0, 12.0)]
    """
    attainable = []
    start = 0.0
    for metres, wanted in times:
        seconds = max(wanted, seconds + (metres - start) / pace)
        start = metres
        attainable.append((metres, seconds))
    return attainable


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
