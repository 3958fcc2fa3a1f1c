"""Walks that follow a direction: they stand, start, wait, turn and arrive as it says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Indices, Mask, Points
from mocap._shared.deadlines import Deadline
from mocap._shared.records import NamedTuple, dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import from_ground, on_ground
from mocap.editing.bending import LIMIT
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.toes import lowest_heights
from mocap.errors import MocapError, NoWalk, warn
from mocap.files.directions import DirectedPoint, Direction
from mocap.graphs.compiled_graph import walk_track
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph, require_graph
from mocap.steering.anchoring import (
    Anchor,
    Correction,
    corrections,
    end_rotations,
    fit_to_anchors,
    headings_in,
    rotate_at_ends,
)
from mocap.steering.detours import line_around, metres_of
from mocap.steering.direction_search import ENTERED_PRICE, DirectedSearch, Goal, Prices
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import Found, find_walk
from mocap.steering.standing import StandingGraph, with_standing
from mocap.steering.tuned import TUNED
from mocap.steering.waiting import Waits, find_waits, longest_wait
from mocap.synthesis.walk_to_motion import to_motion, with_footplants

SAME = 1e-6  # metres between two points that are one
SLACK = 0.15  # seconds by which a wait may differ
HOLD = 0.5  # seconds for which a walk stands at its end
WIDTHS = (60, 200)  # beam widths: the second if the first search misses what is asked for
LESS_LATE = 0.1  # times the price of a delay, in a last search if no walk arrives
FAST = 1.05  # times the limit of added rotation, above which it is reported
TURNED = np.radians(30)  # radians between a line and a heading at its end, beyond which the line is turned
LATE = 0.3  # seconds, beyond which a delay is reported
OFF = 0.1  # metres
TILTED = np.radians(10)  # radians
GOOD_OFF = 0.35  # metres
UNSEEN = np.radians(45)  # radians that steps may be turned in all before a warning
UNSEEN_FRACTION = 0.1  # of the distance travelled by which steps may be longer or shorter before a warning
CORRECTED = 0.01  # metres or radians: a larger correction moves feet, which are cleaned up


class Arrived(NamedTuple):
    """How a walk arrives at a point of its direction.

    Parameters
    ----------
    point : the point.
    second : the time of arrival.
    off : the distance of the root from it, metres.
    turned : the error of the heading, radians, nan if none is asked for.
    late : the delay, seconds, nan if no time is asked for.
    """

    point: DirectedPoint
    second: float
    off: float  # reads: name: public, as `Followed.off`
    turned: float
    late: float


class _Leg(NamedTuple):
    """The part of a direction between two places where the walk stands, or its ends."""

    points: list[DirectedPoint]
    stands_first: bool
    stands_last: bool
    is_last: bool


class Piece(NamedTuple):
    """A part of a walk between two frames that are corrected: a leg, or a wait.

    Parameters
    ----------
    start, end : the anchors of its first and last frame, before the body is rotated there.
    rotations : those of the body at both ends, radians, if it is to face another way than clips do.
    """

    start: Anchor
    end: Anchor
    rotations: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Directed:
    """A walk that follows a direction; `direct` shows an example.

    Parameters
    ----------
    graph : the graph with its standing stretches.
    direction : the direction.
    walk : the edges of the walk.
    pieces : its legs and waits, with the positions and headings to be met at their ends.
    points : the points of the direction; those in one place are one.
    passes : the frame in which the walk passes each of them.
    stopped : "", or the reason for which a search ended early.
    """

    graph: MotionGraph
    direction: Direction
    walk: list[Edge]
    pieces: Sequence[Piece]
    points: Sequence[DirectedPoint]
    passes: Sequence[int]
    stopped: str

    def __repr__(self) -> str:
        return f"Directed({self.report()})"

    @cached_property
    def raw(self) -> Motion:
        """The motion before it is corrected, where its first clip is."""
        return to_motion(self.graph, self.walk)

    @cached_property
    def fitted(self) -> Motion:
        """The motion that meets what is asked for, before the clean-up of its feet."""
        roots = self.raw.root_positions.copy()
        local = self.raw.rotations.copy()
        for piece in self.pieces:
            frames = slice(piece.start.frame, piece.end.frame + 1)
            part = rotate_at_ends(self._anchored(piece), *piece.rotations)
            roots[frames] = part.root_positions
            local[frames] = part.rotations
        return replace(self.raw, root_positions=roots, rotations=local)

    def _anchored(self, piece: Piece) -> Motion:
        """Return the motion of a piece that meets its anchors."""
        first = piece.start.frame
        part = self.raw[first : piece.end.frame + 1]
        ends = [anchor._replace(frame=anchor.frame - first) for anchor in (piece.start, piece.end)]
        return fit_to_anchors(part, ends)

    @cached_property
    def corrections(self) -> list[Correction]:
        """What was corrected in each piece, except for the rotations at its ends."""
        return [corrections(self.raw, [piece.start, piece.end])[0] for piece in self.pieces]

    @cached_property
    def turning(self) -> float:
        """The largest angular speed that the rotations at ends add to the walk, radians per second."""
        speeds = [0.0]
        for piece in self.pieces:
            if any(piece.rotations):
                turn = end_rotations(self._anchored(piece), *piece.rotations)
                speeds.append(float(np.abs(np.diff(turn)).max() * self.raw.fps))
        return max(speeds)

    def motion(self, *, name: str = "walk", clean: bool | None = None) -> Motion:
        """Return the motion, without foot sliding if `clean` (default: if its steps were corrected)."""
        fitted = replace(self.fitted, name=name)
        if clean is None:
            moved = any(max(part.metres, abs(part.radians)) > CORRECTED for part in self.corrections)
            clean = moved or self.turning > 0
        if not clean:
            return fitted
        marked = with_footplants(self.graph)
        contacts = to_motion(marked, self.walk).contacts
        return clean_feet(replace(fitted, contacts=contacts), lowest_heights(marked.clips))

    @cached_property
    def arrivals(self) -> list[Arrived]:
        """How the walk arrives at each point of the direction."""
        track = on_ground(self.fitted.root_positions)
        facing = headings_in(self.fitted)
        listed = []
        for point, frame in zip(self.points, self.passes, strict=True):
            second = frame / self.raw.fps
            turned = np.nan if point.heading is None else _difference(facing[frame], point.heading)
            late = np.nan if point.t is None else second - point.t
            distance = float(abs(track[frame] - _place(point)))
            listed.append(Arrived(point, second, distance, turned, late))
        return listed

    @property
    def entered(self) -> float:
        """The largest depth of the root in a disc, metres; 0 if it enters none."""
        track = on_ground(self.fitted.root_positions)
        discs = self.direction.around
        depths = [radius - np.abs(track - complex(z, x)).min() for x, z, radius in discs]
        return float(max([0.0, *depths]))

    def report(self) -> str:
        """Summarise the walk in one line: its duration, the largest errors, and the corrections."""
        last = self.arrivals[-1]
        line = f"{len(self.raw) / self.raw.fps:.1f} s, ends {100 * last.off:.0f} cm from the last point"
        turned = [abs(arrival.turned) for arrival in self.arrivals if np.isfinite(arrival.turned)]
        late = [abs(arrival.late) for arrival in self.arrivals if np.isfinite(arrival.late)]
        line += f", headings within {np.degrees(max(turned)):.0f}°" if turned else ""
        line += f", times within {max(late):.1f} s" if late else ""
        metres = max((part.metres for part in self.corrections), default=0.0)
        angle = max((abs(part.radians) for part in self.corrections), default=0.0)
        line += f"; steps corrected by {100 * metres:.0f} cm and {np.degrees(angle):.0f}° in all"
        line += f", turned by up to {np.degrees(self.turning):.0f}°/s" if self.turning else ""
        return f"{line}; {self.stopped}: the best so far" if self.stopped else line


def direct(
    graph: MotionGraph | StandingGraph,
    direction: Direction | Sequence[DirectedPoint],
    *,
    settings: Settings | None = None,
    prices: Prices | None = None,
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
        is 150, and 400 in a second search for a leg that misses what is asked for.
    prices : the prices of what else is asked for.

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
    planner = _Planner(standing, direction, settings or Settings(), prices or Prices())
    for leg in legs_of(direction):
        planner.add_leg(leg)
    directed = planner.directed()
    if direction.around and directed.entered > 0:
        depth = f"The nearest walk enters a disc by {100 * directed.entered:.0f} cm"
        raise NoWalk(f"{depth}: no clips turn as the way round it does; leave more room, or add such clips.")
    _warn_of_misses(directed)
    return directed


def legs_of(direction: Direction) -> list[_Leg]:
    """Cut a direction into legs where it waits; points in one place become one, with a wait between them."""
    merged: list[DirectedPoint] = []
    for point in direction.points:
        if merged and abs(_place(merged[-1]) - _place(point)) < SAME:
            merged[-1] = _stay(merged[-1], point)
        else:
            merged.append(point)
    if len(merged) < 2:
        raise MocapError("All points of the direction are in one place: a walk needs a line.")
    if direction.facing is not None:
        merged[-1] = merged[-1]._replace(heading=direction.facing)
    cuts = [number for number, point in enumerate(merged) if point.wait and 0 < number < len(merged) - 1]
    legs = []
    for start, stop in pairwise([0, *cuts, len(merged) - 1]):
        stands_first = start > 0 or direction.start == "stand" or merged[0].wait > 0
        stands_last = stop < len(merged) - 1 or direction.end == "stand" or merged[-1].wait > 0
        is_last = stop == len(merged) - 1
        legs.append(_Leg(merged[start : stop + 1], stands_first, stands_last, is_last))
    return legs


def _stay(arrival: DirectedPoint, departure: DirectedPoint) -> DirectedPoint:
    """Return a point at which a walk stays from the time of one point to that of another."""
    times = [point.t for point in (arrival, departure) if point.t is not None]
    between = times[1] - times[0] if len(times) > 1 else 0.0
    heading = arrival.heading if departure.heading is None else departure.heading
    wait = arrival.wait + departure.wait + between
    return arrival._replace(wait=wait, heading=heading, label=departure.label or arrival.label)


def _place(point: DirectedPoint) -> complex:
    """Return the position of a point as z + ix."""
    return complex(point.z, point.x)


def _difference(angle: float, origin: float) -> float:
    """Return the difference of two angles, wrapped to [-π, π)."""
    return float((angle - origin + np.pi) % (2 * np.pi) - np.pi)


class _Planner:
    """Finds the legs of a walk one after the other, and the waits between them.

    Parameters
    ----------
    graph, direction, settings, prices : as for `direct`.
    """

    def __init__(
        self, graph: StandingGraph, direction: Direction, settings: Settings, prices: Prices
    ) -> None:
        self.direction = direction
        self.settings = settings
        self.prices = prices
        self.deadline = Deadline(settings.deadline)
        self.slack = max(1, round(SLACK * graph.graph.fps))
        stands = any(leg.stands_first or leg.stands_last for leg in legs_of(direction))
        self.standing = graph
        if stands and not self.standing.nodes:
            missing = f"no clip of the graph stands still for {TUNED.standing_seconds:g} s"
            raise NoWalk(f"The direction asks for a walk that stands, but {missing}: add a clip that stops.")
        self.compiled = graph.compiled
        nodes = self.compiled.nodes
        self.is_arriving = np.array([node in self.standing.arriving for node in nodes])
        self.is_waiting = np.array([node in self.standing.waiting for node in nodes])
        self.is_leaving = np.array([node in self.standing.leaving for node in nodes])
        self.at_nodes, self.in_frames = graph.headings
        self.edges: list[Edge] = []
        self.frames = 0
        self.pieces: list[Piece] = []
        self.stand: Anchor | None = None  # the last frame so far
        self.points: list[DirectedPoint] = []
        self.passes: list[int] = []
        self.stopped = ""

    def add_leg(self, leg: _Leg) -> None:
        """Find a leg, after the wait at its start, and the last wait if it is the last one."""
        first = leg.points[0]
        waits = self._waits_before(first)
        heading = self.stand.heading if self.stand else first.heading
        line = self._line(leg)
        turns = self._turns(leg, line, heading)
        metres = metres_of(line, [_place(point) for point in leg.points])
        nodes = self._start_nodes(leg, waits)
        faced = None if heading is None else heading - turns[0]
        starts = self._starts(nodes, line, faced, must_face=leg.stands_first)
        wait = round(self._seconds_of_wait(first) * self.compiled.fps)
        elapsed = (self.frames + wait) / self.compiled.fps
        goal = self._goal(leg, turns[1], metres, elapsed)
        path = GroundPath(from_ground(line))
        delays_of = partial(self._delays, leg, metres, elapsed)

        def is_in_time(walk: Found) -> bool:  # a leg that starts standing can wait if it is early everywhere
            delays = delays_of(walk) or [0.0]
            wait = min(0.0, max(delays)) if leg.stands_first else 0.0
            return max(abs(delay - wait) for delay in delays) < LATE

        request = self._request(leg, metres, elapsed)
        result = self._search(path, request, goal, starts, is_in_time)
        late = max(delays_of(result), default=0.0)
        if leg.stands_first and late < -LATE / 2:
            waits = self._longer_waits(waits, result, late)
        self._append_leg(leg, turns, waits, result, metres)
        self.stopped = self.stopped or result.stopped

    def _line(self, leg: _Leg) -> Points:
        """Return the line of a leg, led around the discs at the largest clearance that leaves a way."""
        discs = [(complex(z, x), radius) for x, z, radius in self.direction.around]
        *wide, narrowest = TUNED.clearances
        for clearance in wide:
            with suppress(NoWalk):
                return line_around(leg.points, discs, clearance)
        return line_around(leg.points, discs, narrowest)

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

    def _longer_waits(self, waits: Waits, result: Found, late: float) -> Waits:
        """Find a wait that is longer than that before a leg, by the time by which it is early (`-late`)."""
        node = self.compiled.edges[result.edges[0]][0]
        start = self._count(waits.get(node, []))
        edges = self.standing.edges if self.edges else self.standing.edges_back
        entry = self.edges[-1][1] if self.edges else node
        for frames in range(start - round(late * self.compiled.fps), start, -self.slack):
            longer = find_waits(edges, entry, frames, self.slack)
            walk = longer.get(node) if self.edges else next(iter(longer.values()), None)
            if walk:
                return {node: walk}
        return waits

    def _delays(self, leg: _Leg, metres: Sequence[float], elapsed: float, result: Found) -> list[float]:
        """Return the delays at the points of a leg that ask for a time, seconds; negative ones are early."""
        fps = self.compiled.fps
        passed = np.searchsorted(result.along, [*metres[:-1], np.inf]) / fps + elapsed
        delays = []
        for second, point in zip(passed[1:].tolist(), leg.points[1:], strict=True):
            if point.t is not None:
                delays.append(second - point.t)
        return delays

    def _count(self, walk: Sequence[Edge]) -> int:
        """Count the frames of a walk."""
        return sum(self.compiled.source.graph.edges[edge]["frames"] for edge in walk)

    def _start_nodes(self, leg: _Leg, waits: Waits) -> Indices:
        """Return the numbers of the nodes from which a leg may start."""
        if waits:
            return np.array(sorted(self.compiled.index(node) for node in waits))
        if leg.stands_first:
            return np.flatnonzero(self.is_leaving)
        return np.arange(len(self.compiled.nodes))

    def _turns(self, leg: _Leg, line: Points, heading: float | None) -> tuple[float, float]:
        """Return the rotations of the body at the ends of a leg, if it is to face another way there.

        Up to `TUNED.turned_from`, the search and its correction are left to turn the body.
        """
        directions = np.angle([line[1] - line[0], line[-1] - line[-2]]).tolist()
        last = leg.points[-1].heading
        wanted = (heading if leg.stands_first else None, last if leg.stands_last else None)
        turns = [0.0, 0.0]
        for end, (direction, facing) in enumerate(zip(directions, wanted, strict=True)):
            turn = 0.0 if facing is None else _difference(facing, direction)
            turns[end] = turn if abs(turn) > TUNED.turned_from else 0.0
        return turns[0], turns[1]

    def _starts(self, nodes: Indices, line: Points, heading: float | None, *, must_face: bool) -> States:
        """Return the states at the start of a line, with a heading, or else along the line."""
        ahead = float(np.angle(line[min(len(line) - 1, 8)] - line[0]))
        directions = self.at_nodes[nodes] if must_face or heading is not None else self.compiled.going[nodes]
        wanted = ahead if heading is None else heading
        rotation = np.exp(1j * (wanted - directions))
        return start_states(nodes, rotation, line[0] - rotation * self.compiled.at[nodes])

    def _request(self, leg: _Leg, metres: Sequence[float], elapsed: float) -> PathRequest:
        """Return the labels and times of a leg, which starts at a time."""
        labels = [
            (place, point.label) for place, point in zip(metres, leg.points, strict=True) if point.label
        ]
        times = [(0.0, 0.0)]
        for place, point in zip(metres[1:], leg.points[1:], strict=True):
            if point.t is not None and point.t - elapsed > times[-1][1]:
                times.append((place, point.t - elapsed))
        return PathRequest(labels=labels, times=times if len(times) > 1 else ())

    def _goal(self, leg: _Leg, turn: float, metres: Sequence[float], elapsed: float) -> Goal:
        """Return what a leg asks for beside its line, before the body is rotated by `turn` at its end."""
        last = leg.points[-1]
        heading = None if last.heading is None else last.heading - turn
        discs = [(complex(z, x), radius + TUNED.clearances[-1]) for x, z, radius in self.direction.around]
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

    def _allowed(self, leg: _Leg) -> Mask:
        """Return the nodes at which a leg may end: any, or standing ones, from which it can go on."""
        if not leg.stands_last:
            return np.ones(len(self.at_nodes), bool)
        if leg.is_last:
            return self.is_arriving
        settled = self.is_arriving & self.is_waiting
        return settled if settled.any() else self.is_waiting

    def _search(
        self,
        path: GroundPath,
        request: PathRequest,
        goal: Goal,
        starts: States,
        is_in_time: Callable[[Found], bool],
    ) -> Found:
        """Search for a leg, and again if the first walk misses what is asked for."""
        route = make_route(self.compiled, path, request)
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
        turned = 0.0 if goal.heading is None else _difference(self._heading_at_end(result), goal.heading)
        is_outside = result.cost < ENTERED_PRICE
        return bool(is_outside and distance < GOOD_OFF and abs(turned) < TURNED)

    def _heading_at_end(self, result: Found) -> float:
        """Return the heading of the body at the end of a leg, radians."""
        rotation = result.rotation * np.prod(self.compiled.rotation[result.edges])
        return float(np.angle(rotation) + self.at_nodes[self.compiled.target[result.edges[-1]]])

    def _append_leg(
        self,
        leg: _Leg,
        turns: tuple[float, float],
        waits: Waits,
        result: Found,
        metres: Sequence[float],
    ) -> None:
        """Append a wait and a leg to the walk, with the frames in which it passes its points."""
        first, *_, last = leg.points
        walk = [self.compiled.edges[edge] for edge in result.edges]
        facing = float(np.angle(result.rotation) + self.at_nodes[self.compiled.index(walk[0][0])])
        if self.stand is None:
            self.stand = Anchor(0, _place(first), facing + turns[0])
            self.points.append(first)
            self.passes.append(0)
        self._add_wait(waits.get(walk[0][0], []))
        begin = self.stand.position if not leg.stands_first else _place(first)
        start = Anchor(self.frames, begin, facing)
        self._add(walk)
        end = self.frames - 1
        track, _ = walk_track(self.compiled, result.edges, result.rotation, result.translation)
        place = complex(track[-1])
        if leg.stands_last:
            place = _place(last)
        heading = self._heading_at_end(result) if last.heading is None else last.heading - turns[1]
        self.pieces.append(Piece(start, Anchor(end, place, heading), turns))
        self.stand = Anchor(end, place, heading + turns[1])
        passed = [start.frame + int(np.searchsorted(result.along, along)) for along in metres[1:-1]]
        self.points += leg.points[1:]
        self.passes += [*(min(frame, end) for frame in passed), end]

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


def _refuse(goal: Goal, problem: NoWalk | None) -> Found:
    """Raise the error that no walk was found."""
    if goal.must_stand:
        lacks = "No walk along the line comes to stand at its end"
        raise NoWalk(f"{lacks}: add clips that stop, or try a larger threshold.") from problem
    assert problem is not None
    raise problem


def _warn_of_misses(directed: Directed) -> None:
    """Warn of each point at which the walk is off what is asked for, and of large corrections."""
    for number, arrival in enumerate(directed.arrivals, 1):
        _warn_of_arrival(arrival, f"at point {number} (x = {arrival.point.x:g}, z = {arrival.point.z:g})")
    for part in directed.corrections:
        if abs(part.radians) > UNSEEN or part.metres > OFF + UNSEEN_FRACTION * part.travelled:
            turn = f"{np.degrees(abs(part.radians)):.0f}° and {100 * part.metres:.0f} cm"
            warn(
                f"Steps are corrected by {turn} over {part.travelled:.1f} m: no clips stop or turn as asked."
            )
    if directed.turning > FAST * LIMIT:
        speed = f"{np.degrees(directed.turning):.0f}° per second"
        warn(f"The body is turned by up to {speed}, faster than people turn: leave it more room.")


def _warn_of_arrival(arrival: Arrived, place: str) -> None:
    """Warn if a walk is late or early at a point, or has another heading than asked."""
    delay = f"The walk arrives {abs(arrival.late):.1f} s"
    if arrival.late > LATE:
        warn(f"{delay} later than asked {place}: no clips walk so fast.")
    if arrival.late < -LATE:
        warn(f"{delay} sooner than asked {place}: no clips walk so slowly or stand so long.")
    if abs(arrival.turned) > TILTED:
        angle = np.degrees(abs(arrival.turned))
        warn(f"The body is {angle:.0f}° from the heading asked for {place}: no clips turn so.")
