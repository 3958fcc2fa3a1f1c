"""Search for one leg of a direction, from where the body stands to where it waits or the walk ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np

from mocap._shared.arrays import Mask, Points
from mocap._shared.deadlines import Deadline
from mocap._shared.records import NamedTuple
from mocap.body.ground_path import GroundPath
from mocap.body.planar import from_ground
from mocap.errors import NoWalk
from mocap.files.directions import Direction
from mocap.graphs.compiled_graph import walk_track
from mocap.graphs.edge_tables import Edge
from mocap.steering.anchoring import wrapped
from mocap.steering.detours import line_around, metres_of
from mocap.steering.directed_walk import LATE
from mocap.steering.direction_legs import Leg, position_of, rotations_at_ends
from mocap.steering.direction_search import ENTERED_PRICE, DirectedSearch, Goal, Prices, attainable_times
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import Found, find_walk
from mocap.steering.standing import StandingGraph
from mocap.steering.tuned import TUNED

WIDTHS = (60, 200)  # beam widths: the second if the first search misses what is asked for
TURNED = np.radians(30)  # radians between a line and a heading at its end, beyond which the line is turned
LESS_LATE = 0.35  # times the price of a delay, if clips are too slow to be in time. At 1 ends are missed
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
    """

    walk: Found
    facing: float
    heading: float
    rotations: tuple[float, float]
    position: complex
    metres: Sequence[float]


class LegSearch:
    """Searches for the legs of a direction.

    Parameters
    ----------
    standing : the graph, with its standing stretches.
    direction : the direction.
    settings, prices : the effort of the search, and the prices of deviations.
    kept : edges of an earlier walk, which stays as it was where it can.
    """

    def __init__(
        self,
        standing: StandingGraph,
        direction: Direction,
        settings: Settings,
        prices: Prices,
        kept: Sequence[Edge],
    ) -> None:
        self.standing = standing
        self.discs = [(complex(z, x), radius) for x, z, radius in direction.around]
        self.settings = settings
        self.prices = prices
        self.kept = kept
        self.deadline = Deadline(settings.deadline)
        self.compiled = standing.compiled
        nodes = self.compiled.nodes
        self.is_arriving = np.array([node in standing.arriving for node in nodes])
        self.is_waiting = np.array([node in standing.waiting for node in nodes])
        self.is_leaving = np.array([node in standing.leaving for node in nodes])
        self.at_nodes, self.in_frames = standing.headings

    def find(
        self, leg: Leg, heading: float | None, waits: Mapping[int, Sequence[int]], elapsed: float
    ) -> FoundLeg:
        """Find a leg.

        Parameters
        ----------
        leg : the leg.
        heading : the heading of the body at its start, radians; None for any.
        waits : the numbers of the nodes at which it may start, and the frames for which the body can wait
            there before, of which the search chooses. If empty, all nodes that fit, without a wait.
        elapsed : the time at which the wait starts, seconds.

        Raises
        ------
        NoWalk : if there is no such walk.
        """
        line = self._line(leg)
        rotations = rotations_at_ends(leg, line, heading)
        metres = metres_of(line, [position_of(point) for point in leg.points])
        faced = None if heading is None else heading - rotations[0]
        starts = self._starts(leg, waits, line, faced)
        labels = [
            (place, point.label) for place, point in zip(metres, leg.points, strict=True) if point.label
        ]
        route = make_route(
            self.compiled, GroundPath(from_ground(line)), PathRequest(labels=labels, kept=self.kept)
        )
        times = []
        for place, point in zip(metres[1:], leg.points[1:], strict=True):
            if point.t is not None:
                times.append((min(place, route.length), point.t - elapsed))
        start = int(starts.frames.min()) / self.compiled.fps
        attainable = attainable_times(times, self.standing.paces[1], start)
        can_be_in_time = attainable == times
        factor = 1.0 if can_be_in_time else LESS_LATE
        prices = replace(self.prices, arrival=factor * self.prices.arrival)
        goal = replace(self._goal(leg, rotations[1], metres), times=attainable, prices=prices)
        walk = self._search(route, goal, starts, can_be_in_time=can_be_in_time)
        track, _ = walk_track(self.compiled, walk.edges, walk.rotation, walk.translation)
        first = self.compiled.index(self.compiled.edges[walk.edges[0]][0])
        facing = float(np.angle(walk.rotation) + self.at_nodes[first])
        ends = (facing, self._heading_at_end(walk))
        return FoundLeg(walk, *ends, rotations, complex(track[-1]), metres)

    def _line(self, leg: Leg) -> Points:
        """Return the line of a leg, led around the discs at the largest clearance that leaves a way."""
        *wide, narrowest = TUNED.clearances
        for clearance in wide:
            with suppress(NoWalk):
                return line_around(leg.points, self.discs, clearance)
        return line_around(leg.points, self.discs, narrowest)

    def _starts(
        self, leg: Leg, waits: Mapping[int, Sequence[int]], line: Points, heading: float | None
    ) -> States:
        """Return the states at the start of a line after each wait, with a heading, or along the line."""
        if not waits:
            fits = np.flatnonzero(self.is_leaving) if leg.stands_first else range(len(self.at_nodes))
            waits = dict.fromkeys(map(int, fits), (0,))
        pairs = [(node, frames) for node in sorted(waits) for frames in waits[node]]
        nodes, waited = np.array(pairs).T
        ahead = float(np.angle(line[min(len(line) - 1, 8)] - line[0]))
        must_face = leg.stands_first or heading is not None
        directions = self.at_nodes[nodes] if must_face else self.compiled.going[nodes]
        wanted = ahead if heading is None else heading
        rotation = np.exp(1j * (wanted - directions))
        starts = start_states(nodes, rotation, line[0] - rotation * self.compiled.at[nodes])
        return starts._replace(frames=waited)

    def _goal(self, leg: Leg, turn: float, metres: Sequence[float]) -> Goal:
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
            paces=self.standing.paces,
            starts_standing=leg.stands_first,
            headings=headings,
            discs=discs,
        )

    def _allowed(self, leg: Leg) -> Mask:
        """Return the nodes at which a leg may end: any, or standing ones, from which it can go on."""
        if not leg.stands_last:
            return np.ones(len(self.at_nodes), bool)
        if leg.is_last:
            return self.is_arriving
        settled = self.is_arriving & self.is_waiting
        return settled if settled.any() else self.is_waiting

    def _search(self, route: Route, goal: Goal, starts: States, *, can_be_in_time: bool) -> Found:
        """Search for a leg, and with a wider beam if the first walk misses what is asked for."""
        kind = partial(DirectedSearch, goal=goal)
        best: Found | None = None
        problem: NoWalk | None = None
        for width in (self.settings.width,) if self.settings.width else WIDTHS:
            settings = replace(self.settings, width=width)
            try:
                result = find_walk(self.compiled, route, starts, settings, self.deadline, kind)
            except NoWalk as error:
                problem = error
                continue
            is_good = self._is_good(result, goal, route, must_be_in_time=can_be_in_time)
            if best is None or is_good or result.cost < best.cost:
                best = result
            if is_good or result.stopped or self.deadline.is_over:
                break
        return best or _refuse(goal, problem)

    def _largest_delay(self, goal: Goal, walk: Found, length: float) -> float:
        """Return the largest delay or advance of a walk at times along a route of a length, seconds."""
        delays = [0.0]
        for metres, seconds in goal.times:
            is_last = metres >= length
            passed = len(walk.along) if is_last else int(np.searchsorted(walk.along, metres))
            delays.append(abs((walk.waited + passed) / self.compiled.fps - seconds))
        return max(delays)

    def _is_good(self, result: Found, goal: Goal, route: Route, *, must_be_in_time: bool) -> bool:
        """Return whether a leg ends near enough for a correction that nobody sees, and is in time."""
        if must_be_in_time and self._largest_delay(goal, result, route.length) > LATE:
            return False
        track, _ = walk_track(self.compiled, result.edges, result.rotation, result.translation)
        distance = abs(track[-1] - route.points[-1])
        turned = 0.0 if goal.heading is None else wrapped(self._heading_at_end(result) - goal.heading)
        is_outside = result.cost < ENTERED_PRICE
        return bool(is_outside and distance < GOOD_OFF and abs(turned) < TURNED)

    def _heading_at_end(self, result: Found) -> float:
        """Return the heading of the body at the end of a leg, radians."""
        rotation = result.rotation * np.prod(self.compiled.rotation[result.edges])
        return float(np.angle(rotation) + self.at_nodes[self.compiled.target[result.edges[-1]]])


def _refuse(goal: Goal, problem: NoWalk | None) -> Found:
    """Raise the error that no walk was found."""
    if goal.must_stand:
        lacks = "No walk along the line comes to stand at its end"
        raise NoWalk(f"{lacks}: add clips that stop, or try a larger threshold.") from problem
    assert problem is not None
    raise problem
