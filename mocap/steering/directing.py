"""Walks that follow a direction: they stand, start, wait, turn and arrive as it says."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mocap.errors import NoWalk, warn
from mocap.files.directions import DirectedPoint, Direction
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, Node, require_graph
from mocap.steering.anchoring import Anchor
from mocap.steering.directed_walk import Directed, Piece, warn_of_misses
from mocap.steering.direction_legs import Leg, legs_of, position_of, spare_seconds
from mocap.steering.direction_search import Prices
from mocap.steering.leg_search import FoundLeg, LegSearch
from mocap.steering.path_objective import Settings
from mocap.steering.standing import StandingGraph, with_standing
from mocap.steering.tuned import TUNED
from mocap.steering.waiting import Waits, find_waits, longest_wait, wait_durations

SLACK = 0.15  # seconds by which a wait may differ
LONGER = 0.5  # seconds by which a wait may be longer than a walk at the usual pace needs to be in time
HOLD = 0.5  # seconds for which a walk stands at its end


def direct(
    graph: MotionGraph | StandingGraph,
    direction: Direction | Sequence[DirectedPoint],
    *,
    settings: Settings | None = None,
    prices: Prices | None = None,
    kept: Sequence[Edge] = (),
) -> Directed:
    """Find a walk that follows a direction: a line with times, headings, labels, waits and discs to avoid.

    The direction is cut where the walk waits. Each leg is a search along its line, led around the discs and
    turned at its ends where a heading asks for it. Times, headings and the end are priced beside the line
    [KGP02, 4.2]. A wait is a walk through standing stretches. What a search misses by some centimetres and
    degrees is spread over its steps (`anchoring`).

    Parameters
    ----------
    graph : pruned. Standing stretches that pruning removed are added again. To follow several directions,
        pass `steering.with_standing(graph)`.
    direction : the direction, or its points.
    settings : the effort of the search, and the prices of deviations from the line. By default the beam width
        is 50, and 200 in a second search for a leg that misses what is asked for. Times are priced by
        `Prices.arrival` in place of `late`.
    prices : the prices of what else is asked for.
    kept : edges of an earlier walk, which stays as it was where it can, as `PathRequest.kept`.

    Raises
    ------
    NoWalk : if no clip stands and the direction asks for it, for discs that leave no way, and as for
        `steering.follow_path`.
    MocapError : for an invalid direction.

    Warns
    -----
    MocapWarning : where the walk is more than 10 cm, 10° or 0.3 s off what is asked for, for a wait that is
        shorter because no clip stands as long, and for a disc that is entered.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> from mocap.files import DirectedPoint, Direction
    >>> names = ("stop_and_go", "walk_straight", "walk_curve_1")
    >>> clips = [body.resample(datasets.sample(name), 30) for name in names]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> points = [DirectedPoint(0, 0), DirectedPoint(0, 5)]
    >>> directed = direct(graph, Direction(points, start="stand", end="stand", facing=0.0))
    >>> last = directed.arrivals[-1]
    >>> last.off < 0.1, abs(last.turned) < 0.17
    (True, True)

    Notebook: 08b-steering
    """
    direction = direction if isinstance(direction, Direction) else Direction(direction)
    standing = graph if isinstance(graph, StandingGraph) else with_standing(require_graph(graph))
    search = LegSearch(standing, direction, settings or Settings(), prices or Prices(), kept)
    plan = _Plan(standing, direction, search)
    for leg in legs_of(direction):
        plan.add_leg(leg)
    directed = plan.directed()
    if direction.around and directed.entered > 0:
        depth = f"The nearest walk enters a disc by {100 * directed.entered:.0f} cm"
        raise NoWalk(f"{depth}: no clips turn as the way round it does; leave more room, or add such clips.")
    warn_of_misses(directed)
    return directed


class _Plan:
    """A walk that grows leg by leg, with the waits between the legs.

    Parameters
    ----------
    graph : the graph with its standing stretches.
    direction : what the walk follows.
    search : finds its legs.
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
        self.slack = max(1, round(SLACK * self.compiled.fps))
        self.edges: list[Edge] = []
        self.frames = 0
        self.pieces: list[Piece] = []
        self.stand: Anchor | None = None  # the last frame so far
        self.points: list[DirectedPoint] = []
        self.passes: list[int] = []
        self.stopped = ""

    def add_leg(self, leg: Leg) -> None:
        """Find a leg, after the wait at its start, and the last wait if it is the last one."""
        first = leg.points[0]
        waits = self._waits_before(first)
        heading = self.stand.heading if self.stand else first.heading
        durations = self._durations(leg, waits)
        result = self.search.find(leg, heading, durations, self.frames / self.compiled.fps)
        node = self.compiled.edges[result.walk.edges[0]][0]
        wait = waits.get(node, [])
        if self._count(wait) != result.walk.waited:
            wait = self._wait_of(node, result.walk.waited)
        self._append_leg(leg, wait, result)
        self.stopped = self.stopped or result.walk.stopped

    def directed(self) -> Directed:
        """Return the whole walk, after the wait at its end."""
        last = self.points[-1]
        node = self.edges[-1][1]
        if node in self.standing.nodes:
            frames = round(max(last.wait, HOLD) * self.compiled.fps)
            self._add_wait(longest_wait(self.standing.edges, node, frames), ends=True)
        graph = self.compiled.source
        parts = (self.edges, self.pieces, self.points, self.passes, self.stopped)
        return Directed(graph, self.direction, *parts)

    def _seconds_of_wait(self, point: DirectedPoint) -> float:
        """Return how long the walk waits before a leg, at its first point."""
        is_first = not self.edges
        return max(point.wait, point.t or 0.0) if is_first else point.wait

    def _waits_before(self, first: DirectedPoint) -> Waits:
        """Find the waits before a leg, by the nodes at which they end."""
        seconds = self._seconds_of_wait(first)
        if not self.edges and not seconds:
            return {}
        frames = round(seconds * self.compiled.fps)
        entries = [self.edges[-1][1]] if self.edges else sorted(self.standing.nodes)
        edges = self.standing.edges
        for entry in entries:
            waits = find_waits(edges, entry, frames, self.slack)
            leaving = {node: walk for node, walk in waits.items() if node in self.standing.leaving}
            if leaving:
                return leaving
        longest = [longest_wait(edges, entry, frames) for entry in entries]
        walk = max(longest, key=self._count)
        stood = self._count(walk) / self.compiled.fps
        if stood < seconds - SLACK:
            lasts = f"A wait of {seconds:.1f} s lasts {stood:.1f} s"
            warn(f"{lasts}, because no clip stands longer: add one that does.")
        return {walk[-1][1] if walk else entries[0]: walk}

    def _durations(self, leg: Leg, waits: Waits) -> dict[int, list[int]]:
        """Return the frames for which the body can wait before a leg, by the numbers of nodes.

        Without a time to keep, these are the waits that are asked for. With one, longer waits are added,
        about `SLACK` seconds apart, as long as a walk at the usual pace needs to be in time.
        """
        durations = {self.compiled.index(node): [self._count(walk)] for node, walk in waits.items()}
        spare = spare_seconds(leg, self.standing.paces[0], self.frames / self.compiled.fps)
        longest = round((spare + LONGER) * self.compiled.fps)
        if not leg.stands_first or spare <= 0:
            return durations
        shortest = round(self._seconds_of_wait(leg.points[0]) * self.compiled.fps)
        for node, possible in self._possible_waits(longest).items():
            number = self.compiled.index(node)
            kept = durations.get(number, [])
            for frames in possible:
                if frames >= shortest and (not kept or frames >= kept[-1] + self.slack):
                    kept.append(frames)
            if kept:
                durations[number] = kept
        return durations

    def _possible_waits(self, frames: int) -> dict[Node, list[int]]:
        """Return the durations of the waits from which a leg can start, at most so many frames, by nodes."""
        starts = [self.edges[-1][1]] if self.edges else sorted(self.standing.nodes)
        durations = wait_durations(self.standing.edges, starts, frames)
        return {node: durations[node] for node in sorted(self.standing.leaving) if node in durations}

    def _wait_of(self, node: Node, frames: int) -> list[Edge]:
        """Return a wait of so many frames that ends at a node, from where the walk is so far."""
        if self.edges:
            return find_waits(self.standing.edges, self.edges[-1][1], frames, 0)[node]
        return next(iter(find_waits(self.standing.edges_back, node, frames, 0).values()))

    def _count(self, walk: Sequence[Edge]) -> int:
        """Count the frames of a walk."""
        return sum(self.compiled.source.graph.edges[edge]["frames"] for edge in walk)

    def _append_leg(self, leg: Leg, wait: Sequence[Edge], result: FoundLeg) -> None:
        """Append a wait and a leg to the walk, with the frames in which it passes its points."""
        first, *_, last = leg.points
        walk = [self.compiled.edges[edge] for edge in result.walk.edges]
        if self.stand is None:
            self.stand = Anchor(0, position_of(first), result.facing + result.rotations[0])
            self.points.append(first)
            self.passes.append(0)
        self._add_wait(wait)
        begin = self.stand.position if not leg.stands_first else position_of(first)
        start = Anchor(self.frames, begin, result.facing)
        self._add(walk)
        place = position_of(last) if leg.stands_last else result.position
        heading = result.heading if last.heading is None else last.heading - result.rotations[1]
        end = Anchor(self.frames - 1, place, heading)
        self.pieces.append(Piece(start, end, result.rotations))
        self.stand = end._replace(heading=heading + result.rotations[1])
        passed = start.frame + np.searchsorted(result.walk.along, result.metres[1:-1])
        self.points += leg.points[1:]
        self.passes += [*np.minimum(passed, end.frame).tolist(), end.frame]

    def _add_wait(self, walk: Sequence[Edge], *, ends: bool = False) -> None:
        """Append a wait, in which the body stays where it stands, and with `ends` the walk ends."""
        if not walk:
            return
        assert self.stand is not None
        self._add(walk)
        stop = self.stand._replace(frame=self.frames - 1 if ends else self.frames)
        self.pieces.append(Piece(self.stand, stop))

    def _add(self, edges: Sequence[Edge]) -> None:
        """Append edges to the walk."""
        self.edges += edges
        self.frames += self._count(edges)
