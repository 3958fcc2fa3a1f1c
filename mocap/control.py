"""Interactive control: a character that is told where to go while it walks [KGP02, 5.3]."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap import rotations
from mocap.blending import cubic_weights
from mocap.compiling import CompiledGraph, compile_graph
from mocap.errors import MocapError, NoWalk
from mocap.motion_graph import MotionGraph, Node
from mocap.transforms import PlanarTransform
from mocap.walks import ranges

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


class Pose(NamedTuple):
    """One frame: `root_position` (3,), metres; `rotations` (J, 4); and whether a transition is under way."""

    root_position: Array
    rotations: Array
    blending: bool


class Command(NamedTuple):
    """What the character is told: a direction (radians), a speed (m/s), and a label's number, -1 for any."""

    heading: float
    speed: float
    label: int


class Controller:
    """A character on a graph; each `step` gives its next pose.

    At every choice point it looks `ahead` seconds ahead, through the `width` best walks, and takes the one whose
    velocity comes nearest to the one asked for: Σ ‖v - v'‖² Δt, plus `SEAM` for a transition and `LABEL` for each
    second without the label. All that does not depend on the command is worked out beforehand.

    Parameters
    ----------
    graph : pruned, so that there is always a way on.
    start : the first node; by default the first of the graph.
    ahead : seconds to look ahead.
    width : walks that go on in each round.

    Raises
    ------
    NoWalk : for a start that the graph lacks, and where the graph comes to an end.

    Examples
    --------
    >>> from mocap import datasets, motion, motion_graph
    >>> clips = [motion.resample(datasets.sample(), 30)]
    >>> controller = Controller(motion_graph.prune(motion_graph.build(clips, window=10, threshold=0.04)))
    >>> controller.step(heading=0.0, speed=1.0).rotations.shape
    (38, 4)
    """

    SEAM = 0.1  # m²/s, as are all costs here
    LABEL = 4.0

    def __init__(
        self,
        graph: MotionGraph | CompiledGraph,
        *,
        start: Node | None = None,
        ahead: float = 1.0,
        width: int = 24,
    ) -> None:
        self.graph = compile_graph(graph)
        self.width, self.horizon = width, ahead * self.graph.fps
        self.node = 0 if start is None else self.graph.index(start)
        self.turn, self.move = 1 + 0j, 0j
        self.plan: list[int] = []  # edges to take, the next one first
        self.edge, self.frame = -1, 0
        self.told: Command | None = None
        self.weights = cubic_weights(self.graph.source.window)
        self._prepare()

    def _prepare(self) -> None:
        """Work out for every hop how far it leads, how long it lasts, and what it costs."""
        graph = self.graph
        origin = np.repeat(np.arange(len(graph.nodes)), np.diff(graph.hop_first))
        ride_end = np.where(graph.rides > 0, graph.ride + graph.rides, graph.ride)
        clip_frames = np.concatenate([[0], np.cumsum(graph.frames)])
        self.frames = clip_frames[ride_end] - clip_frames[graph.ride] + graph.frames[graph.last]
        end = graph.turn[graph.last] * graph.at[graph.target[graph.last]] + graph.move[graph.last]
        self.leads = end - graph.at[origin]
        self.price = np.where(graph.blended[graph.last], self.SEAM, 0.0)
        bears = np.add.reduceat(graph.bears, graph.track_first, axis=1, dtype=np.intp)
        lacks = np.concatenate([np.zeros((len(bears), 1)), np.cumsum(graph.frames - bears, axis=1)], axis=1)
        ridden = lacks[:, ride_end] - lacks[:, graph.ride]
        self.lacks = (ridden + (graph.frames - bears)[:, graph.last]) / graph.fps  # (L, H), seconds

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame.

        Parameters
        ----------
        heading : the direction to go in, radians; 0 is +z, π/2 is +x.
        speed : metres a second.
        label : the kind of motion, "" for any.

        Raises
        ------
        MocapError : for a heading or speed that is no finite number, or a speed below 0.
        NoWalk : for a label that the graph lacks.
        """
        command = self._command(heading, speed, label)
        if self.edge < 0 or self.frame == self.graph.frames[self.edge]:
            self._choose(command)
        pose = self._pose()
        self.frame += 1
        return pose

    def _command(self, heading: float, speed: float, label: str) -> Command:
        if not (np.isfinite(heading) and np.isfinite(speed) and speed >= 0):
            raise MocapError(f"A command is a finite heading and a speed from 0 on, got {heading}, {speed}.")
        if label and label not in self.graph.labels:
            have = ", ".join(self.graph.labels) or "none"
            raise NoWalk(f"No clip of the graph bears the label '{label}'; there are: {have}.")
        return Command(heading, speed, self.graph.labels.index(label) if label else -1)

    def _choose(self, command: Command) -> None:
        """Leave the edge that has ended, and enter the next one of the plan, or of a new plan."""
        if self.edge >= 0:
            self.move += self.turn * complex(self.graph.move[self.edge])
            self.turn *= complex(self.graph.turn[self.edge])
            self.turn /= abs(self.turn)
            self.node = int(self.graph.target[self.edge])
        if not self.plan or command != self.told:
            self.plan, self.told = self._look_ahead(command), command
        self.edge, self.frame = self.plan.pop(0), 0

    def _look_ahead(self, command: Command) -> list[int]:
        """Find the first hop of the best walk of the next moments."""
        graph, wish = self.graph, command.speed * np.exp(1j * command.heading)
        node, turn = np.array([self.node]), np.array([self.turn])
        first, frames, cost = np.array([-1]), np.zeros(1, np.intp), np.zeros(1)
        while True:
            going = frames < self.horizon
            begin = graph.hop_first[node]
            count = np.where(going, graph.hop_first[node + 1] - begin, 0)
            of, hop = np.repeat(np.arange(len(node)), count), ranges(begin, count)
            if not len(hop):
                break
            seconds = self.frames[hop] / graph.fps
            off = turn[of] * self.leads[hop] - wish * seconds
            more = (off.real**2 + off.imag**2) / seconds + self.price[hop]
            if command.label >= 0:
                more += self.LABEL * self.lacks[command.label, hop]
            last, old = graph.last[hop], np.flatnonzero(~going)
            node, turn = (
                np.append(node[old], graph.target[last]),
                np.append(turn[old], turn[of] * graph.turn[last]),
            )
            first = np.append(first[old], np.where(first[of] < 0, hop, first[of]))
            frames = np.append(frames[old], frames[of] + self.frames[hop])
            cost = np.append(cost[old], cost[of] + more)
            best = np.argsort(cost / frames)[: self.width]
            node, turn, first, frames, cost = node[best], turn[best], first[best], frames[best], cost[best]
        if first[0] < 0:
            raise NoWalk(f"The walk ends at node {graph.nodes[self.node]}: prune the graph first.")
        hop = int(first[0])
        return [*range(graph.ride[hop], graph.ride[hop] + graph.rides[hop]), int(graph.last[hop])]

    def _pose(self) -> Pose:
        """Take the frame from its clip, or blend it of two."""
        graph, (start, end, _) = self.graph, self.graph.edges[self.edge]
        here = self._placed(start[0], start[1] + self.frame, self.turn, self.move)
        if not graph.blended[self.edge]:
            return Pose(*here, blending=False)
        turn = self.turn * complex(graph.turn[self.edge])
        move = self.move + self.turn * complex(graph.move[self.edge])
        there = self._placed(end[0], end[1] - len(self.weights) + self.frame, turn, move)
        alpha = self.weights[self.frame]
        root = alpha * here[0] + (1 - alpha) * there[0]
        return Pose(root, rotations.slerp(there[1], here[1], np.array(alpha)), blending=True)

    def _placed(self, clip: int, frame: int, turn: complex, move: complex) -> tuple[Array, Array]:
        motion = self.graph.source.clips[clip]
        place = PlanarTransform(float(np.angle(turn)), move.imag, move.real)
        turns = motion.rotations[frame].copy()
        turns[0] = place.orientations(turns[0])
        return place.points(motion.root_positions[frame]), turns
