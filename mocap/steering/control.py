"""Interactive control: a character that is told where to go while it walks [KGP02, 5.3]."""

import time
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node


class Pose(NamedTuple):
    """One frame: `root_position` (3,), metres; `rotations` (J, 4); and whether a transition is under way."""

    root_position: Array
    rotations: Array
    blending: bool


class Command(NamedTuple):
    """What the character is told: a velocity on the ground, as complex z + ix, and a label's number or -1."""

    velocity: complex
    label: int


class Walks(NamedTuple):
    """Walks looked ahead: by which hop each began, where it has come, how long it is, and what it costs."""

    first: Indices  # -1 for one that has not begun
    node: Indices
    turn: Points
    frames: Indices
    cost: Array


class Controller:
    """A character on a graph; each `step` gives its next pose.

    While it plays one hop it looks `ahead` seconds past that hop's end, a round of the search in each frame,
    so that no step takes long. It keeps the `width` best walks, and in the end takes the first hop of the one
    whose velocity is nearest to what is asked for: Σ ‖v - v'‖² Δt, plus `SEAM` for a transition and `LABEL`
    for each second without the label.

    A step leaves next to nothing to collect. But when Python's collector goes through a whole graph, for
    some other work's sake, that takes 30 to 90 ms: who must not stop calls `gc.freeze()` once all is built.

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
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(), 30)]
    >>> controller = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> controller.step(heading=0.0, speed=1.0).rotations.shape
    (38, 4)

    Notebook: 08-path-synthesis
    """

    SEAM = 0.1  # m²/s, as are all costs here
    LABEL = 4.0

    def __init__(
        self,
        graph: MotionGraph | CompiledGraph,
        *,
        start: Node | None = None,
        ahead: float = 3.0,
        width: int = 64,
    ) -> None:
        self.graph = compile_graph(graph)
        self.width, self.horizon = width, ahead * self.graph.fps
        self.weights = cubic_weights(self.graph.source.window)
        self._prepare()
        self.edges: list[int] = []  # still to be played, the one under way first
        self.frame = 0  # of that one
        self.turn, self.move = 1 + 0j, 0j  # place its clip: p -> turn · p + move
        # Where the hop under way ends: there the next one is chosen.
        self.node, self.end_turn = 0 if start is None else self.graph.index(start), self.turn
        self.told = Command(0j, -1)
        self._begin()

    def _prepare(self) -> None:
        """Work out for every hop how far it leads, what it costs, and for how long it lacks each label."""
        graph, hops = self.graph, self.graph.hops
        self.frames = hops.frames
        origin = np.repeat(np.arange(len(graph.nodes)), np.diff(hops.first))
        end = graph.turn[hops.last] * graph.at[graph.target[hops.last]] + graph.move[hops.last]
        self.leads: Points = end - graph.at[origin]
        self.price = np.where(graph.blended[hops.last], self.SEAM, 0.0)
        lacks = np.pad(np.cumsum(~graph.labels.bears, axis=1), ((0, 0), (1, 0)))  # (L, T + 1), frames
        played: Indices = lacks[:, hops.starts + hops.counts] - lacks[:, hops.starts]  # (L, H, 2)
        self.lacks: Array = played.sum(axis=-1) / graph.fps  # (L, H), seconds

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
        if command != self.told:
            self.told = command
            self._begin()
        if self.edges and self.frame == self.graph.frames[self.edges[0]]:
            self._leave(self.edges.pop(0))
        if not self.edges:
            self._choose()
        elif not self.decided:
            self._look()
        pose = self._pose(self.edges[0], self.frame)
        self.frame += 1
        return pose

    def _command(self, heading: float, speed: float, label: str) -> Command:
        if not (np.isfinite(heading) and np.isfinite(speed) and speed >= 0):
            raise MocapError(f"A command is a finite heading and a speed from 0 on, got {heading}, {speed}.")
        velocity = speed * complex(np.exp(1j * heading))
        return Command(velocity, self.graph.label_number(label))

    def _begin(self) -> None:
        """Start to look ahead, from where the hop under way ends."""
        none = np.zeros(1, np.intp)
        self.walks = Walks(none - 1, none + self.node, np.array([self.end_turn]), none, np.zeros(1))
        self.decided = False

    def _look(self) -> None:
        """Go on by one round: every walk that is too short, by every hop."""
        graph, walks, command = self.graph, self.walks, self.told
        short = walks.frames < self.horizon
        of, hop = graph.hops.leaving(walks.node[short])
        of = np.flatnonzero(short)[of]
        self.decided = not len(hop)
        if self.decided:
            return
        seconds, last = self.frames[hop] / graph.fps, graph.hops.last[hop]
        off = walks.turn[of] * self.leads[hop] - command.velocity * seconds
        cost = (off.real**2 + off.imag**2) / seconds + self.price[hop]
        if command.label >= 0:
            cost += self.LABEL * self.lacks[command.label, hop]
        first = np.where(walks.first[of] < 0, hop, walks.first[of])
        frames = walks.frames[of] + self.frames[hop]
        longer = Walks(
            first, graph.target[last], walks.turn[of] * graph.turn[last], frames, walks.cost[of] + cost
        )
        both = (np.concatenate([a[~short], b]) for a, b in zip(walks, longer, strict=True))
        self.walks = _best(Walks._make(both), self.width)

    def _choose(self) -> None:
        """Enter the first hop of the best walk, and begin to look past it."""
        while not self.decided:
            self._look()
        hop = int(self.walks.first[0])
        if hop < 0:
            raise NoWalk(f"The walk ends at node {self.graph.nodes[self.node]}: prune the graph first.")
        self.edges = self.graph.hops.edges(np.array([hop])).tolist()
        last = self.edges[-1]
        self.frame, self.node = 0, int(self.graph.target[last])
        self.end_turn = self.turn * complex(self.graph.turn[last])
        self._begin()

    def _leave(self, edge: int) -> None:
        """Place the clip that an edge leads to."""
        self.move += self.turn * complex(self.graph.move[edge])
        self.turn *= complex(self.graph.turn[edge])
        self.turn /= abs(self.turn)  # no drift, however long it walks
        self.frame = 0

    def _pose(self, edge: int, frame: int) -> Pose:
        """Take a frame of an edge from its clip, or blend it of two."""
        graph, (start, end, _) = self.graph, self.graph.edges[edge]
        here = self._placed(start[0], start[1] + frame, self.turn, self.move)
        if not graph.blended[edge]:
            return Pose(*here, blending=False)
        turn = self.turn * complex(graph.turn[edge])
        move = self.move + self.turn * complex(graph.move[edge])
        there = self._placed(end[0], end[1] - len(self.weights) + frame, turn, move)
        alpha = self.weights[frame]
        root = alpha * here[0] + (1 - alpha) * there[0]
        return Pose(root, rotations.slerp(there[1], here[1], np.array(alpha)), blending=True)

    def _placed(self, clip: int, frame: int, turn: complex, move: complex) -> tuple[Array, Array]:
        motion = self.graph.source.clips[clip]
        place = PlanarTransform.from_complex(turn, move)
        turns = motion.rotations[frame].copy()
        turns[0] = place.apply_orientations(turns[0])
        return place.apply_points(motion.root_positions[frame]), turns


def _best(walks: Walks, width: int) -> Walks:
    """Keep the walks that cost least a frame."""
    best = np.argsort(walks.cost / walks.frames)[:width]
    return Walks._make(values[best] for values in walks)


class Delay(NamedTuple):
    """How soon it obeys, `mean` and `slowest` (95 %), seconds; CPU time of a `step` and the `worst`, ms."""

    mean: float
    slowest: float
    step: float
    worst: float


def measure_delay(
    graph: MotionGraph | CompiledGraph, *, turns: int = 60, speed: float = 1.1, seed: int = 0
) -> Delay:
    """Tell a character again and again to turn by 30 to 120 degrees, and measure how soon it does.

    It obeys when its direction over the last third of a second is within 20 degrees of the one asked for;
    a turn that takes longer than 8 s counts as 8 s.

    Parameters
    ----------
    graph : pruned.
    turns : how many times.
    speed : metres a second.
    seed : of the turns.

    Notebook: 08-path-synthesis
    """
    controller = Controller(graph)
    random, fps = np.random.default_rng(seed), controller.graph.fps
    back, heading = round(fps / 3), 0.0
    track, costs, delays = [0j] * back, [0.0], []
    for _ in range(turns):
        heading += random.choice([-1, 1]) * random.uniform(np.pi / 6, 2 * np.pi / 3)
        for frame in range(round(8 * fps)):
            start = time.thread_time()
            x, _, z = controller.step(heading, speed).root_position
            costs.append(time.thread_time() - start)
            track.append(complex(z, x))
            way = (track[-1] - track[-1 - back]) * np.exp(-1j * heading)
            if frame >= back and abs(np.angle(way)) < np.pi / 9:
                break
        delays.append((frame + 1) / fps)
    slowest, cost = float(np.percentile(delays, 95)), np.array(costs[1:]) * 1e3
    return Delay(float(np.mean(delays)), slowest, float(cost.mean()), float(cost.max()))
