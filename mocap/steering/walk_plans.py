"""Plans of walks that follow a direction: legs, found one after the other, and the waits between them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.errors import NoWalk
from mocap.files.directions import Direction
from mocap.graphs.motion_graph import Node
from mocap.steering.directed_walk import Directed
from mocap.steering.direction_legs import Leg, due_at_end, legs_of, position_of, spare_seconds
from mocap.steering.leg_search import FoundLeg, LegSearch
from mocap.steering.standing import StandingGraph
from mocap.steering.tuned import TUNED
from mocap.steering.waiting import shortest_waits
from mocap.steering.walk_assembly import PlannedLeg, WalkAssembly

SLACK = 0.15  # seconds by which a wait may differ
LONGER = 0.5  # seconds by which a wait may be longer than a walk at the usual pace needs to be in time
STEP = 0.3  # seconds between the waits of which a search chooses. The rest of a delay is made up for later


class _Start(NamedTuple):
    """A node from which a leg can start, and the least and the desired frames of the wait before it."""

    node: Node
    shortest: int
    desired: int


class WalkPlan:
    """The legs of a walk, found one after the other, and the waits before them.

    Parameters
    ----------
    graph : the graph with its standing stretches.
    direction : what the walk follows.
    search : finds its legs.

    Raises
    ------
    NoWalk : if the direction asks for a walk that stands, and no clip does.
    """

    def __init__(self, graph: StandingGraph, direction: Direction, search: LegSearch) -> None:
        stands = any(leg.stands_first or leg.stands_last for leg in legs_of(direction))
        if stands and not graph.nodes:
            missing = f"no clip of the graph stands still for {TUNED.standing_seconds:g} s"
            raise NoWalk(f"The direction asks for a walk that stands, but {missing}: add a clip that stops.")
        self.direction = direction
        self.standing = graph
        self.compiled = graph.compiled
        self.search = search
        self.legs: list[PlannedLeg] = []
        self.frames = 0
        self.heading: float | None = None  # of the body at the end so far, radians
        self.can_start_later = False  # whether no time is asked for so far
        self.spare = 0  # frames by which the walk can start earlier
        stood = [graph.stood(node) for node in graph.arriving]
        self.settling = float(np.median(stood)) / graph.graph.fps if stood else 0.0

    def add_leg(self, leg: Leg, later: Sequence[Leg]) -> None:
        """Find a leg, after the wait at its start, in time for the legs that follow it."""
        due = due_at_end(leg, later, self.standing.paces[0], self.settling)
        timed = leg._replace(points=[*leg.points[:-1], leg.points[-1]._replace(t=due)])
        starts = self._starts(leg)
        result, frames = self._find(timed, starts)
        if not self.legs:
            self.can_start_later = leg.stands_first
            self.spare = frames - min((start.desired for start in starts), default=frames)
        self.can_start_later &= all(point.t is None for point in leg.points[1:])
        self.legs.append(PlannedLeg(leg, frames, result))
        self.frames += frames + len(result.track)
        last = leg.points[-1]
        self.heading = result.heading + result.rotations[1] if last.heading is None else last.heading

    def directed(self) -> Directed:
        """Return the walk that consists of the legs, and of the waits before and after them."""
        assembly = WalkAssembly(self.standing)
        for planned in self.legs:
            assembly.add_leg(planned)
        assembly.add_last_wait()
        reasons = [planned.result.walk.stopped for planned in self.legs]
        stopped = next((reason for reason in reasons if reason), "")
        return assembly.directed(self.direction, stopped)

    def _node(self) -> Node:
        """Return the node at which the walk so far ends."""
        return self.legs[-1].end_node(self.compiled)

    def _stood(self) -> int:
        """Return for how many frames the body stands at the end so far."""
        return self.legs[-1].result.still_last(self.compiled.fps) if self.legs else 0

    def _find(self, leg: Leg, starts: Sequence[_Start]) -> tuple[FoundLeg, int]:
        """Find a leg, and the number of frames of the wait before it.

        If the leg has a single time, it is found without, and the wait is as long as it leaves. If the wait
        is asked for, the walk starts earlier or later instead, as long as no time is asked for before. If the
        leg is late nevertheless, times are priced by the search.
        """
        times = [point for point in leg.points[1:] if point.t is not None]
        elapsed = (self.frames - self.spare) / self.compiled.fps
        spare = spare_seconds(leg, self.standing.paces[1], elapsed)
        if len(times) == 1 and leg.stands_first and spare > leg.points[0].wait:
            untimed = leg._replace(points=[point._replace(t=None) for point in leg.points])
            result = self._search(untimed, starts)
            delay = self._delay(leg, result)
            shift = min(delay, self.spare) if self.can_start_later else 0
            frames = self._frames_of_wait(result, delay - shift)
            missed = delay - shift + frames - result.walk.waited
            changed = abs(delay - shift) if leg.points[0].wait else 0
            if max(missed, changed) <= SLACK * self.compiled.fps:
                self._start_earlier(shift)
                return result, frames
        result = self._search(leg, starts)
        # Half of a delay is made up for by a wait that is asked for.
        spread = round(STEP * self.compiled.fps / (2 if leg.points[0].wait else 1))
        delay = int(np.clip(self._delay(leg, result), -spread, spread))
        return result, self._frames_of_wait(result, delay)

    def _search(self, leg: Leg, starts: Sequence[_Start]) -> FoundLeg:
        """Search for a leg after the wait at its start."""
        heading = self.heading if self.legs else leg.points[0].heading
        elapsed = self.frames / self.compiled.fps
        result = self.search.find(leg, heading, self._durations(leg, starts), elapsed)
        is_timed = any(point.t is not None for point in leg.points[1:])
        if is_timed or not leg.stands_first or not (self.legs or leg.points[0].wait):
            return result
        wanted = round(leg.points[0].wait * self.compiled.fps)
        stands = self._stood() + result.still_first(self.compiled.fps)
        waited = max(self._shortest(result), wanted - stands)
        return result._replace(walk=result.walk._replace(waited=waited))

    def _shortest(self, result: FoundLeg) -> int:
        """Return the least frames of a wait from the end so far to the start of a leg."""
        node = self.compiled.edges[result.walk.edges[0]][0]
        if not self.legs or node not in self.standing.nodes:
            return 0
        return shortest_waits(self.standing.edges, self._node())[node].frames

    def _start_earlier(self, frames: int) -> None:
        """Change the wait before the first leg, so that the walk so far is earlier by some frames."""
        if self.legs and frames:
            first = self.legs[0]
            self.legs[0] = first._replace(frames=first.frames - frames)
            self.spare -= frames
            self.frames -= frames

    def _frames_of_wait(self, result: FoundLeg, delay: int) -> int:
        """Return the frames of the wait before a leg that makes up for a delay as far as it can."""
        return max(self._shortest(result), result.walk.waited - delay)

    def _starts(self, leg: Leg) -> list[_Start]:
        """Find the nodes from which a leg that starts standing can start; none for another leg."""
        if not leg.stands_first:
            return []
        point = leg.points[0]
        wanted = round(point.wait * self.compiled.fps)
        if not self.legs:
            moment = 0.0 if point.t is None else point.t
            wanted = max(wanted, round(moment * self.compiled.fps))
            return [self._start(node, 0, wanted) for node in sorted(self.standing.leaving)]
        node = self._node()
        stays = wanted - self._stood()
        waits = shortest_waits(self.standing.edges, node)
        starts = [
            self._start(end, waits[end].frames, stays)
            for end in sorted(self.standing.leaving)
            if end in waits
        ]
        if not starts:
            raise NoWalk("The walk stops where no clip starts again: add clips that start from standing.")
        excess = [start.shortest - start.desired for start in starts]
        limit = max(min(excess), round(SLACK * self.compiled.fps))
        return [start for start, frames in zip(starts, excess, strict=True) if frames <= limit]

    def _start(self, node: Node, shortest: int, frames: int) -> _Start:
        """Return a start at a node, before which the body stands for some frames, with those after it."""
        return _Start(node, shortest, max(0, frames - self.standing.stands_on(node)))

    def _durations(self, leg: Leg, starts: Iterable[_Start]) -> dict[int, list[int]]:
        """Return the frames for which the body can wait before a leg, by the numbers of nodes.

        Without a time to keep, these are the waits that are asked for. With one, longer waits are added, as
        long as a walk at the usual pace needs to be in time.
        """
        spare = spare_seconds(leg, self.standing.paces[0], self.frames / self.compiled.fps)
        longest = round((spare + LONGER) * self.compiled.fps) if spare > 0 else 0
        step = round(STEP * self.compiled.fps)
        durations = {}
        for node, shortest, desired in starts:
            first = max(shortest, desired)
            durations[self.compiled.index(node)] = [first, *range(first + step, longest + 1, step)]
        return durations

    def _delay(self, leg: Leg, result: FoundLeg) -> int:
        """Return the frames by which a leg that starts standing is late at its points on average."""
        delays = []
        elapsed = self.frames / self.compiled.fps
        for number, point in enumerate(leg.points[1:], 1):
            if point.t is not None:
                is_last = number == len(leg.points) - 1
                passed = len(result.track) if is_last else result.pass_of(number, position_of(point))
                delays.append((result.walk.waited + passed) - (point.t - elapsed) * self.compiled.fps)
        return round(float(np.mean(delays))) if delays and leg.stands_first else 0
