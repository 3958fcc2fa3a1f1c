"""Search for one leg of a direction, from where the body stands to where it waits or the walk ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np

from mocap._shared.arrays import Array, Mask, Points
from mocap._shared.deadlines import Deadline
from mocap._shared.records import NamedTuple
from mocap.body.ground_path import GroundPath
from mocap.body.planar import from_ground
from mocap.errors import NoWalk
from mocap.files.directions import Direction
from mocap.graphs.compiled_graph import walk_track
from mocap.graphs.edge_tables import Edge
from mocap.graphs.tuned import TUNED as GRAPH_TUNED
from mocap.steering.anchoring import wrapped
from mocap.steering.detours import line_around, metres_of
from mocap.steering.directed_walk import LATE
from mocap.steering.direction_legs import Leg, line_with_headings, position_of, rotations_at_ends, times_along
from mocap.steering.direction_search import ENTERED_PRICE, DirectedSearch, Goal, Prices, attainable_times
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import Found, find_walk
from mocap.steering.standing import MOVES, StandingGraph
from mocap.steering.tuned import TUNED

WIDTHS = (60, 200)  # beam widths: the second if the first search misses what is asked for
TURNED = np.radians(30)  # radians between a line and a heading at its end, beyond which the line is turned
LESS_LATE = 0.35  # times the price of a delay, if clips are too slow to be in time. At 1 ends are missed
GOOD_OFF = 0.35  # metres
PASSED = 3  # nodes of a standing stretch that a search may pass beyond the one at which the walk can wait
PASSING = 0.7  # metres along the line around a point, in which the nearest frame passes it


class FoundLeg(NamedTuple):
    """The result of the search for a leg.

    Parameters
    ----------
    walk : the walk.
    track : shape (F,), the position of the root in each frame, as z + ix in metres.
    headings : shape (F,), the heading of the body in each frame, radians, before the body is rotated.
    heading : the same at its end.
    rotations : the rotations of the body at both ends, radians.
    metres : the arc lengths of the points of the leg along its line.
    """

    walk: Found
    track: Points
    headings: Array
    heading: float
    rotations: tuple[float, float]
    metres: Sequence[float]

    def still_first(self, fps: float) -> int:
        """Return for how many frames the body stands before it moves."""
        moving = np.flatnonzero(np.abs(np.diff(self.track)) * fps > MOVES)
        return int(moving[0]) if len(moving) else len(self.track)

    def still_last(self, fps: float) -> int:
        """Return for how many frames the body stands at the end."""
        moving = np.flatnonzero(np.abs(np.diff(self.track)) * fps > MOVES)
        return len(self.track) - 2 - int(moving[-1]) if len(moving) else len(self.track)

    def pass_of(self, number: int, position: complex) -> int:
        """Return the frame in which the walk passes a point of the leg, by its number and its position."""
        distance = np.abs(self.track - position)
        is_near = np.abs(self.walk.along - self.metres[number]) < PASSING
        if not is_near.any():
            return min(int(np.searchsorted(self.walk.along, self.metres[number])), len(self.track) - 1)
        return int(np.where(is_near, distance, np.inf).argmin())


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
        self.stays = np.array([node in standing.nodes for node in nodes])
        self.is_leaving = np.array([node in standing.leaving for node in nodes])
        self.at_nodes, self.in_frames = standing.headings
        self.longest_passed = round(GRAPH_TUNED.longest_macro_edge * self.compiled.fps)

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
        route = self._route(leg, line, metres)
        times = times_along(leg, metres, route.length, elapsed)
        start = int(starts.frames.min()) / self.compiled.fps
        attainable = attainable_times(times, self.standing.paces[1], start)
        can_be_in_time = attainable == times
        factor = 1.0 if can_be_in_time else LESS_LATE
        prices = replace(self.prices, arrival=factor * self.prices.arrival)
        goal = replace(self._goal(leg, rotations[1], metres), times=attainable, prices=prices)
        walk = self._search(route, goal, starts, can_be_in_time=can_be_in_time)
        walk = self._without_wait(walk) if leg.stands_first else walk
        if leg.stands_last:
            can_end = np.array(self.stays if leg.is_last else self.is_waiting)
            is_timed = leg.points[-1].t is not None
            walk = self._until(walk, can_end, 0 if is_timed else self._settled_frames(walk))
        return self._with_track(walk, rotations, metres)

    def _with_track(self, walk: Found, rotations: tuple[float, float], metres: Sequence[float]) -> FoundLeg:
        """Return a leg with the positions and headings of its frames."""
        track, rows = walk_track(self.compiled, walk.edges, walk.rotation, walk.translation)
        turns = np.cumprod([walk.rotation, *self.compiled.rotation[walk.edges]])[:-1]
        turned = np.repeat(np.angle(turns), self.compiled.frames[walk.edges])
        headings = turned + self.in_frames[rows]
        return FoundLeg(walk, track, headings, self._heading_at_end(walk), rotations, metres)

    def _route(self, leg: Leg, line: Points, metres: Sequence[float]) -> Route:
        """Return a line as a route, with the labels of its points."""
        labels = []
        for place, point in zip(metres, leg.points, strict=True):
            if point.label:
                labels.append((place, point.label))
        path = GroundPath(from_ground(line))
        return make_route(self.compiled, path, PathRequest(labels=labels, kept=self.kept))

    def _line(self, leg: Leg) -> Points:
        """Return the line of a leg, led around the discs at the largest clearance that leaves a way."""
        points = line_with_headings(leg.points)
        *wide, narrowest = TUNED.clearances
        for clearance in wide:
            with suppress(NoWalk):
                return line_around(points, self.discs, clearance)
        return line_around(points, self.discs, narrowest)

    def _starts(
        self, leg: Leg, waits: Mapping[int, Sequence[int]], line: Points, heading: float | None
    ) -> States:
        """Return the states at the start of a line after each wait, with a heading, or along the line."""
        if not waits:
            fits = np.flatnonzero(self.is_leaving) if leg.stands_first else range(len(self.at_nodes))
            waits = dict.fromkeys(map(int, fits), (0,))
        rows = [(node, frames, min(waits[node])) for node in sorted(waits) for frames in waits[node]]
        nodes, waited, shortest = np.array(rows).T
        ahead = float(np.angle(line[min(len(line) - 1, 8)] - line[0]))
        must_face = leg.stands_first or heading is not None
        directions = self.at_nodes[nodes] if must_face else self.compiled.going[nodes]
        wanted = ahead if heading is None else heading
        rotation = np.exp(1j * (wanted - directions))
        starts = start_states(nodes, rotation, line[0] - rotation * self.compiled.at[nodes])
        # A wait that is asked for is as dear as a time.
        seconds = (waited - shortest) / self.compiled.fps
        price = self.prices.arrival if leg.points[0].wait else 0.0
        return starts._replace(frames=waited, cost=price * seconds**2)

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
        settled = self.is_arriving & (self.is_waiting | self._passes_waiting())
        return settled if settled.any() else self.is_waiting

    def _passes_waiting(self) -> Mask:
        """Return which nodes a walk reaches by a clip just after one at which it can wait."""
        nodes = np.array(self.compiled.nodes)
        is_near = np.zeros(len(nodes), bool)
        for count in range(1, PASSED + 1):
            earlier = nodes[:-count]
            later = nodes[count:]
            is_short = later[:, 1] - earlier[:, 1] <= self.longest_passed
            is_same_clip = later[:, 0] == earlier[:, 0]
            is_near[count:] |= is_same_clip & is_short & self.is_waiting[:-count]
        return is_near

    def _without_wait(self, walk: Found) -> Found:
        """Return a walk without the edges between standing nodes at its start, a part of the wait."""
        for _ in range(len(walk.edges) - 1):
            edge, *_ = walk.edges
            if not self.stays[self.compiled.target[edge]]:
                break
            frames = int(self.compiled.frames[edge])
            # reads: statement: one field a line
            walk = walk._replace(
                edges=walk.edges[1:],
                along=walk.along[frames:],
                rotation=walk.rotation * self.compiled.rotation[edge],
                translation=walk.translation + walk.rotation * self.compiled.translation[edge],
                waited=walk.waited + frames,
            )
        return walk

    def _settled_frames(self, walk: Found) -> int:
        """Return how many frames at the end of a walk are a part of the wait, after it has come to stand."""
        track = self._with_track(walk, (0.0, 0.0), ())
        settled = round(TUNED.settled_seconds * self.compiled.fps)
        return max(0, track.still_last(self.compiled.fps) - settled)

    def _until(self, walk: Found, can_end: Mask, frames: int) -> Found:
        """Return a walk without its last frames, at most so many, unless it can end only before them."""
        chosen: int | None = None
        dropped = 0
        for number in range(len(walk.edges), 0, -1):
            ends_here = bool(can_end[self.compiled.target[walk.edges[number - 1]]])
            if dropped > frames and (chosen is not None or len(walk.edges) - number > PASSED):
                break
            if ends_here:
                chosen = number
            dropped += int(self.compiled.frames[walk.edges[number - 1]])
        if chosen is None:
            return walk
        kept = int(self.compiled.frames[walk.edges[:chosen]].sum())
        return walk._replace(edges=walk.edges[:chosen], along=walk.along[:kept])

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
        delays = []
        for metres, seconds in goal.times:
            is_last = metres >= length
            passed = len(walk.along) if is_last else int(np.searchsorted(walk.along, metres))
            delays.append((walk.waited + passed) / self.compiled.fps - seconds)
        # A wait before the leg makes up for what its delays have in common.
        shift = float(np.clip(np.mean(delays), -LATE, LATE)) if goal.starts_standing and delays else 0.0
        return max((abs(delay - shift) for delay in delays), default=0.0)

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
