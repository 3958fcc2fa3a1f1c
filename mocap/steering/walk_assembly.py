"""The walk of a plan: its edges, the frames that are held, and the anchors that it meets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mocap._shared.records import NamedTuple
from mocap.files.directions import DirectedPoint, Direction
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import Node
from mocap.steering.anchoring import Anchor, wrapped
from mocap.steering.directed_walk import Directed, Piece
from mocap.steering.direction_legs import Leg, position_of
from mocap.steering.leg_search import FoundLeg
from mocap.steering.standing import StandingGraph
from mocap.steering.waiting import Hold, Wait, longest_stand, shortest_waits

HOLD = 0.5  # seconds for which a walk stands at its end
APART = 1.0  # metres of line before and after a point from which on a walk is led through it
WITHIN = 0.5  # metres from such a point, beyond which a walk is not led through it


class PlannedLeg(NamedTuple):
    """A leg of a direction, the number of frames of the wait before it, and the walk that was found."""

    leg: Leg
    frames: int
    result: FoundLeg

    def start_node(self, graph: CompiledGraph) -> Node:
        """Return the node at which its walk starts."""
        start: Node = graph.edges[self.result.walk.edges[0]][0]
        return start

    def end_node(self, graph: CompiledGraph) -> Node:
        """Return the node at which its walk ends."""
        end: Node = graph.edges[self.result.walk.edges[-1]][1]
        return end


class WalkAssembly:
    """A walk that is put together leg by leg, with the waits before them.

    Parameters
    ----------
    graph : the graph with its standing stretches.
    """

    def __init__(self, graph: StandingGraph) -> None:
        self.standing = graph
        self.compiled = graph.compiled
        self.edges: list[Edge] = []
        self.walked = 0  # frames of the edges
        self.holds: list[Hold] = []
        self.pieces: list[Piece] = []
        self.stand: Anchor | None = None  # the last frame so far
        self.points: list[DirectedPoint] = []
        self.passes: list[int] = []
        self.stood = 0  # frames for which the body stands at the end so far
        self.waits: list[float] = []  # seconds at each point, nan if none is asked for

    @property
    def frames(self) -> int:
        """The number of frames so far, with those that are held."""
        return self.walked + sum(hold.added for hold in self.holds)

    def directed(self, direction: Direction, stopped: str) -> Directed:
        """Return the walk, which follows a direction, and why its search ended early."""
        pieces = (self.edges, self.pieces, self.points, self.passes, stopped, self.holds, self.waits)
        return Directed(self.standing.graph, direction, *pieces)

    def add_last_wait(self) -> None:
        """Append the wait at the end, or half a second in which the body stands."""
        last = self.points[-1]
        node = self.edges[-1][1]
        if node not in self.standing.nodes:
            return
        stood = self.stood if last.wait else 0
        frames = max(round(last.wait * self.compiled.fps) - stood, round(HOLD * self.compiled.fps))
        self._add_wait(longest_stand(self.standing.edges, node, frames), frames, stands_on=0, ends=True)
        self.waits[-1] = (stood + frames) / self.compiled.fps if last.wait else np.nan

    def _wait_to(self, node: Node, frames: int) -> Wait:
        """Return a walk through standing nodes to a node, from the end so far, of at most so many frames."""
        if not self.edges:
            is_standing = node in self.standing.nodes
            return longest_stand(self.standing.edges_back, node, frames) if is_standing else Wait([], 0)
        start = self.edges[-1][1]
        if start == node or start not in self.standing.nodes:
            return Wait([], 0)
        smooth = shortest_waits(self.standing.edges, start, smoothest=True)[node]
        return smooth if smooth.frames <= frames else shortest_waits(self.standing.edges, start)[node]

    def add_leg(self, planned: PlannedLeg) -> None:
        """Append a wait and a leg to the walk, with the frames in which it passes its points."""
        leg, frames, result = planned
        first, *_, last = leg.points
        facing = float(result.headings[0])
        if self.stand is None:
            self.stand = Anchor(0, position_of(first), facing + result.rotations[0])
            self.points.append(first)
            self.passes.append(0)
            self.waits.append(np.nan)
        node = planned.start_node(self.compiled)
        stands_on = result.still_first(self.compiled.fps) if leg.stands_first else 0
        stood = self.stood
        if first.wait:
            self.waits[-1] = (stood + frames + stands_on) / self.compiled.fps
        self._add_wait(self._wait_to(node, frames), frames, stands_on=stands_on)
        begin = self.stand.position if not leg.stands_first else position_of(first)
        start = Anchor(self.frames, begin, facing)
        self._add([self.compiled.edges[edge] for edge in result.walk.edges])
        place = position_of(last) if leg.stands_last else complex(result.track[-1])
        heading = result.heading if last.heading is None else last.heading - result.rotations[1]
        end = Anchor(self.frames - 1, place, heading)
        self._add_piece(leg, start, end, result)
        self.stood = result.still_last(self.compiled.fps) if leg.stands_last else 0
        self.stand = end._replace(heading=heading + result.rotations[1])
        self.points += leg.points[1:]
        self.waits += [np.nan] * (len(leg.points) - 1)

    def _add_piece(self, leg: Leg, start: Anchor, end: Anchor, result: FoundLeg) -> None:
        """Add the piece of a leg, which is led through its points, and the frames in which it passes them."""
        remaining = wrapped(end.heading - float(result.headings[-1]))
        through: list[Anchor] = []
        facing = []
        for number, point in enumerate(leg.points[1:-1], 1):
            position = position_of(point)
            passed = result.pass_of(number, position)
            frame = max(start.frame + passed, self.passes[-1])
            self.passes.append(frame)
            last = through[-1].frame if through else start.frame
            if not last + 1 < frame < end.frame - 1:
                continue
            if _is_led_through(leg, number, result, position):
                heading = float(result.headings[passed]) + remaining * passed / len(result.track)
                through.append(Anchor(frame, position, heading))
            if point.heading is not None:
                facing.append((frame, point.heading))
        self.pieces.append(Piece(start, end, result.rotations, through, facing))
        self.passes.append(end.frame)

    def _add_wait(self, wait: Wait, frames: int, *, stands_on: int, ends: bool = False) -> None:
        """Append a wait, in which the body stays where it stands, and with `ends` the walk ends.

        Parameters
        ----------
        wait : a walk through standing nodes.
        frames : those of the wait; the body is held for those that the walk lacks.
        stands_on : for how many frames after the wait the body stands.
        ends : whether the walk ends here.
        """
        if not frames:
            return
        assert self.stand is not None
        back = self.stood
        if frames > wait.frames:
            ahead = wait.frames + stands_on
            place = self.walked
            if ends:
                # The last frame of the walk is held.
                place = self.walked + wait.frames
                back += wait.frames - 1
                ahead = 0
            self.holds.append(Hold(place, max(back, 0), max(ahead - 1, 0), frames - wait.frames))
        self._add(wait.edges)
        stop = self.stand._replace(frame=self.frames - 1 if ends else self.frames)
        self.pieces.append(Piece(self.stand, stop))

    def _add(self, edges: Sequence[Edge]) -> None:
        """Append edges to the walk."""
        self.edges += edges
        self.walked += sum(self.standing.graph.graph.edges[edge]["frames"] for edge in edges)


def _is_led_through(leg: Leg, number: int, result: FoundLeg, position: complex) -> bool:
    """Return whether a walk is led through a point: one with a time or heading, or apart from others."""
    room = np.diff(result.metres[number - 1 : number + 2])
    point = leg.points[number]
    is_asked = point.heading is not None or point.t is not None
    is_alone = room.min() >= APART
    passed = result.pass_of(number, position)
    return (is_asked or is_alone) and bool(abs(result.track[passed] - position) < WITHIN)
