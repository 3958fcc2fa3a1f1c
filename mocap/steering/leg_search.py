"""Search for one leg of a direction, from where the body stands to where it waits or the walk ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np

from mocap._shared.arrays import Indices, Mask, Points
from mocap._shared.deadlines import Deadline
from mocap._shared.records import NamedTuple
from mocap.body.ground_path import GroundPath
from mocap.body.planar import from_ground
from mocap.errors import NoWalk
from mocap.files.directions import Direction
from mocap.graphs.compiled_graph import walk_track
from mocap.steering.anchoring import wrapped
from mocap.steering.detours import line_around, metres_of
from mocap.steering.directed_walk import LATE
from mocap.steering.direction_legs import Leg, place_of, rotations_at_ends
from mocap.steering.direction_search import ENTERED_PRICE, DirectedSearch, Goal, Prices
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import Found, find_walk
from mocap.steering.standing import StandingGraph
from mocap.steering.tuned import TUNED

WIDTHS = (60, 200)  # beam widths: the second if the first search misses what is asked for
LESS_LATE = 0.1  # times the price of a delay, in a last search if no walk arrives
TURNED = np.radians(30)  # radians between a line and a heading at its end, beyond which the line is turned
GOOD_OFF = 0.35  # metres


class FoundLeg(NamedTuple):
    """The result of the search for a leg.

    Parameters
    ----------
    walk : the walk.
    facing : the heading of the body in its first frame, radians, before the body is rotated there.
    heading : the same at its end.
    rotations : the rotations of the body at both ends, radians.
    position : the position of the root at its end.
    metres : the arc lengths of the points of the leg along its line.
    delays : the delays at the points that ask for a time, seconds. Negative ones are early.
    """

    walk: Found
    facing: float
    heading: float
    rotations: tuple[float, float]
    position: complex
    metres: Sequence[float]
    delays: Sequence[float]


class LegSearch:
    """Searches for the legs of a direction.

    Parameters
    ----------
    standing : the graph, with its standing stretches.
    direction : the direction.
    settings, prices : the effort of the search, and the prices of deviations.
    """

    def __init__(
        self, standing: StandingGraph, direction: Direction, settings: Settings, prices: Prices
    ) -> None:
        self.standing = standing
        self.discs = [(complex(z, x), radius) for x, z, radius in direction.around]
        self.settings = settings
        self.prices = prices
        self.deadline = Deadline(settings.deadline)
        self.compiled = standing.compiled
        nodes = self.compiled.nodes
        self.is_arriving = np.array([node in standing.arriving for node in nodes])
        self.is_waiting = np.array([node in standing.waiting for node in nodes])
        self.is_leaving = np.array([node in standing.leaving for node in nodes])
        self.at_nodes, self.in_frames = standing.headings

    def find(self, leg: Leg, heading: float | None, nodes: Indices | None, elapsed: float) -> FoundLeg:
        """Find a leg.

        Parameters
        ----------
        leg : the leg.
        heading : the heading of the body at its start, radians; None for any.
        nodes : the numbers of the nodes at which it may start; None for all that fit.
        elapsed : the time at which it starts, seconds.

        Raises
        ------
        NoWalk : if there is no such walk.
        """
        line = self._line(leg)
        rotations = rotations_at_ends(leg, line, heading)
        metres = metres_of(line, [place_of(point) for point in leg.points])
        faced = None if heading is None else heading - rotations[0]
        starts = self._starts(leg, nodes, line, faced)
        goal = self._goal(leg, rotations[1], metres, elapsed)
        delays_of = partial(self._delays, leg, metres, elapsed)

        def is_in_time(walk: Found) -> bool:  # a leg that starts standing can wait if it is early everywhere
            delays = delays_of(walk) or [0.0]
            wait = min(0.0, max(delays)) if leg.stands_first else 0.0
            return max(abs(delay - wait) for delay in delays) < LATE

        route = make_route(self.compiled, GroundPath(from_ground(line)), _request(leg, metres, elapsed))
        walk = self._search(route, goal, starts, is_in_time)
        track, _ = walk_track(self.compiled, walk.edges, walk.rotation, walk.translation)
        first = self.compiled.index(self.compiled.edges[walk.edges[0]][0])
        facing = float(np.angle(walk.rotation) + self.at_nodes[first])
        ends = (facing, self._heading_at_end(walk))
        return FoundLeg(walk, *ends, rotations, complex(track[-1]), metres, delays_of(walk))

    def _line(self, leg: Leg) -> Points:
        """Return the line of a leg, led around the discs at the largest clearance that leaves a way."""
        *wide, narrowest = TUNED.clearances
        for clearance in wide:
            with suppress(NoWalk):
                return line_around(leg.points, self.discs, clearance)
        return line_around(leg.points, self.discs, narrowest)

    def _starts(self, leg: Leg, nodes: Indices | None, line: Points, heading: float | None) -> States:
        """Return the states at the start of a line, with a heading, or else along the line."""
        if nodes is None:
            nodes = np.flatnonzero(self.is_leaving) if leg.stands_first else np.arange(len(self.at_nodes))
        ahead = float(np.angle(line[min(len(line) - 1, 8)] - line[0]))
        must_face = leg.stands_first or heading is not None
        directions = self.at_nodes[nodes] if must_face else self.compiled.going[nodes]
        wanted = ahead if heading is None else heading
        rotation = np.exp(1j * (wanted - directions))
        return start_states(nodes, rotation, line[0] - rotation * self.compiled.at[nodes])

    def _goal(self, leg: Leg, turn: float, metres: Sequence[float], elapsed: float) -> Goal:
        """Return what a leg asks for beside its line, before the body is rotated by `turn` at its end."""
        last = leg.points[-1]
        heading = None if last.heading is None else last.heading - turn
        discs = [(centre, radius + TUNED.clearances[-1]) for centre, radius in self.discs]
        headings = []
        for place, point in zip(metres[1:-1], leg.points[1:-1], strict=True):
            if point.heading is not None:
                headings.append((place, point.heading))
        # reads: statement: one field a line
        return Goal(
            self._allowed(leg),
            leg.stands_last,
            self.at_nodes,
            self.in_frames,
            heading=heading,
            seconds=None if last.t is None else last.t - elapsed,
            headings=headings,
            discs=discs,
            prices=self.prices,
        )

    def _allowed(self, leg: Leg) -> Mask:
        """Return the nodes at which a leg may end: any, or standing ones, from which it can go on."""
        if not leg.stands_last:
            return np.ones(len(self.at_nodes), bool)
        if leg.is_last:
            return self.is_arriving
        settled = self.is_arriving & self.is_waiting
        return settled if settled.any() else self.is_waiting

    def _delays(self, leg: Leg, metres: Sequence[float], elapsed: float, walk: Found) -> list[float]:
        """Return the delays at the points of a leg that ask for a time, seconds; negative ones are early."""
        fps = self.compiled.fps
        passed = np.searchsorted(walk.along, [*metres[:-1], np.inf]) / fps + elapsed
        delays = []
        for second, point in zip(passed[1:].tolist(), leg.points[1:], strict=True):
            if point.t is not None:
                delays.append(second - point.t)
        return delays

    def _search(self, route: Route, goal: Goal, starts: States, is_in_time: Callable[[Found], bool]) -> Found:
        """Search for a leg, and again if the first walk misses what is asked for."""
        kind = partial(DirectedSearch, goal=goal)
        best: Found | None = None
        problem: NoWalk | None = None
        for settings in self._efforts():
            try:
                result = find_walk(self.compiled, route, starts, settings, self.deadline, kind)
            except NoWalk as error:
                problem = error
                continue
            is_good = self._is_good(result, goal, route) and is_in_time(result)
            if best is None or is_good or result.cost < best.cost:
                best = result
            if is_good or result.stopped or self.deadline.is_over:
                break
        return best or _refuse(goal, problem)

    def _efforts(self) -> Iterator[Settings]:
        """Yield the settings of each search: wider beams, then a lower price of delays."""
        for width in (self.settings.width,) if self.settings.width else WIDTHS:
            yield replace(self.settings, width=width)
        yield replace(self.settings, width=width, late=LESS_LATE * self.settings.late)

    def _is_good(self, result: Found, goal: Goal, route: Route) -> bool:
        """Return whether a leg ends near enough for a correction that nobody sees."""
        track, _ = walk_track(self.compiled, result.edges, result.rotation, result.translation)
        distance = abs(track[-1] - route.points[-1])
        turned = 0.0 if goal.heading is None else wrapped(self._heading_at_end(result) - goal.heading)
        is_outside = result.cost < ENTERED_PRICE
        return bool(is_outside and distance < GOOD_OFF and abs(turned) < TURNED)

    def _heading_at_end(self, result: Found) -> float:
        """Return the heading of the body at the end of a leg, radians."""
        rotation = result.rotation * np.prod(self.compiled.rotation[result.edges])
        return float(np.angle(rotation) + self.at_nodes[self.compiled.target[result.edges[-1]]])


def _request(leg: Leg, metres: Sequence[float], elapsed: float) -> PathRequest:
    """Return the labels and times of a leg, which starts at a time."""
    labels = [(place, point.label) for place, point in zip(metres, leg.points, strict=True) if point.label]
    times = [(0.0, 0.0)]
    for place, point in zip(metres[1:], leg.points[1:], strict=True):
        if point.t is not None and point.t - elapsed > times[-1][1]:
            times.append((place, point.t - elapsed))
    return PathRequest(labels=labels, times=times if len(times) > 1 else ())


def _refuse(goal: Goal, problem: NoWalk | None) -> Found:
    """Raise the error that no walk was found."""
    if goal.must_stand:
        lacks = "No walk along the line comes to stand at its end"
        raise NoWalk(f"{lacks}: add clips that stop, or try a larger threshold.") from problem
    assert problem is not None
    raise problem
