"""Interactive control: a character that gets a new command in any frame while it walks [KGP02, 5.3]."""

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.steering.look_ahead import Command, lengthen, look_ahead_by, start_walk


class Pose(NamedTuple):
    """One frame: root position (3,) in metres, rotations (J, 4), and whether a transition is under way."""

    root_position: Array
    rotations: Array
    blending: bool


class Controller:
    """A character on a motion graph; each `step` takes a command and gives the next pose.

    While it plays one hop, it looks ahead from the end of this hop: in each frame all walks ahead grow by one
    round, so that no step takes long. At the end of the hop it takes the first hop of the best walk. The cost
    of a walk compares its velocity with the command, as `look_ahead` says.

    A step makes little garbage. But when Python's collector visits a large graph, this takes 30 to 90 ms.
    Where every step must be on time, call `gc.freeze()` after the graph is built.

    Parameters
    ----------
    graph : pruned, so that a walk never ends.
    start : the first node; by default the first of the graph.
    ahead : seconds to look ahead.
    width : walks that stay in each round.

    Raises
    ------
    NoWalk : for a start that is not in the graph, and where the graph comes to an end.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(), 30)]
    >>> controller = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> controller.step(heading=0.0, speed=1.0).rotations.shape
    (38, 4)
    """

    def __init__(
        self,
        graph: MotionGraph | CompiledGraph,
        *,
        start: Node | None = None,
        ahead: float = 3.0,
        width: int = 64,
    ) -> None:
        self.graph = compile_graph(graph)
        self.ahead = look_ahead_by(self.graph, ahead, width)
        self.edges: list[int] = []  # still to be played; the first one is under way
        self.frame = 0  # of the first edge
        self.turn, self.move = 1 + 0j, 0j  # place its clip: p ↦ turn · p + move
        # The node where the hop under way ends, and how its clip is turned there.
        self.node, self.end_turn = 0 if start is None else self.graph.index(start), self.turn
        self.command = Command(0j, -1)
        self._restart()

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame.

        Parameters
        ----------
        heading : the direction to go in, radians; 0 is +z, π/2 is +x.
        speed : metres per second.
        label : the kind of motion, "" for any.

        Raises
        ------
        MocapError : for a heading or speed that is no finite number, or a speed below 0.
        NoWalk : for a label that no clip of the graph has.
        """
        if not (np.isfinite(heading) and np.isfinite(speed) and speed >= 0):
            raise MocapError(f"A command is a finite heading and a speed from 0 on, got {heading}, {speed}.")
        velocity = speed * complex(np.exp(1j * heading))
        command = Command(velocity, self.graph.label_number(label))
        if command != self.command:
            self.command = command
            self._restart()
        if self.edges and self.frame == self.graph.frames[self.edges[0]]:
            self._leave(self.edges.pop(0))
        if not self.edges:
            self._choose()
        elif not self.decided:
            self._look()
        pose = pose_on_edge(self.graph, self.edges[0], self.frame, self.turn, self.move)
        self.frame += 1
        return pose

    @property
    def frames_left(self) -> int:
        """The frames until the next choice: the rest of the hop under way."""
        return sum(int(self.graph.frames[edge]) for edge in self.edges) - self.frame * bool(self.edges)

    def _restart(self) -> None:
        """Look ahead anew, from the end of the hop under way."""
        self.walks, self.decided = start_walk(self.node, self.end_turn), False

    def _look(self) -> None:
        """Look ahead by one round; without longer walks the choice is clear."""
        longer = lengthen(self.ahead, self.walks, self.command)
        self.walks, self.decided = longer or self.walks, longer is None

    def _choose(self) -> None:
        """Take the first hop of the best walk, and look ahead from its end."""
        while not self.decided:
            self._look()
        hop = int(self.walks.first[0])
        if hop < 0:
            raise NoWalk(f"The walk ends at node {self.graph.nodes[self.node]}: prune the graph first.")
        self.edges = self.graph.hops.edges(np.array([hop])).tolist()
        last = self.edges[-1]
        self.frame, self.node = 0, int(self.graph.target[last])
        self.end_turn = self.turn * complex(self.graph.turn[last])
        self._restart()

    def _leave(self, edge: int) -> None:
        """Place the clip that an edge leads to."""
        self.move += self.turn * complex(self.graph.move[edge])
        self.turn *= complex(self.graph.turn[edge])
        self.turn /= abs(self.turn)  # stays of length 1 on walks of any length
        self.frame = 0


def pose_on_edge(graph: CompiledGraph, edge: int, frame: int, turn: complex, move: complex) -> Pose:
    """Take a frame of an edge from its clip, or blend it from two clips in a transition.

    `turn` and `move` place the clip that the edge leaves: p ↦ turn · p + move.
    """
    (clip, first), (other, end), _ = graph.edges[edge]
    clips, window = graph.source.clips, graph.source.window
    root, turns = _placed(clips[clip], first + frame, turn, move)
    if not graph.blended[edge]:
        return Pose(root, turns, blending=False)
    move += turn * complex(graph.move[edge])
    turn *= complex(graph.turn[edge])
    there = _placed(clips[other], end - window + frame, turn, move)
    alpha = cubic_weights(window)[frame]
    mixed = alpha * root + (1 - alpha) * there[0]
    return Pose(mixed, rotations.slerp(there[1], turns, np.array(alpha)), blending=True)


def _placed(motion: Motion, frame: int, turn: complex, move: complex) -> tuple[Array, Array]:
    """Place one frame: root position and rotations."""
    place = PlanarTransform.from_complex(turn, move)
    turns = motion.rotations[frame].copy()
    turns[0] = place.apply_orientations(turns[0])
    return place.apply_points(motion.root_positions[frame]), turns


class Steered(NamedTuple):
    """A steered motion, F frames, and what the character did in each.

    `blending` (F,) says whether a transition was under way, `frames_left` (F,) how many frames the character
    still had to play before its next choice.
    """

    motion: Motion
    blending: Mask
    frames_left: Indices

    def delay(self, heading: float, frame: int) -> Array:
        """Split the delay of a command: seconds of waiting, of transitions and of clip until it is obeyed.

        Parameters
        ----------
        heading, frame : the direction asked for, radians, and the frame of the command, from 1/3 s on.

        Returns
        -------
        Three numbers; nan where the command is not obeyed, as `measure_delay` defines it.
        """
        fps, (x, _, z) = self.motion.fps, self.motion.root_positions.T
        track, back = (z + 1j * x) * np.exp(-1j * heading), round(self.motion.fps / 3)
        obeys = np.abs(np.angle(track[frame:] - track[frame - back : -back])) < np.pi / 9
        if not obeys.any():
            return np.full(3, np.nan)
        took = int(obeys.argmax()) + 1
        wait = min(int(self.frames_left[frame]), took)
        blends = int(self.blending[frame + wait : frame + took].sum())
        return np.array([wait, blends, took - wait - blends]) / fps


def steer(graph: MotionGraph | CompiledGraph, headings: Sequence[float], speed: float = 1.1) -> Steered:
    """Steer a character by one heading per frame, and record what it does.

    Parameters
    ----------
    graph : pruned.
    headings : shape (F,), radians; 0 is +z, π/2 is +x.
    speed : metres per second.

    Examples
    --------
    Two seconds ahead, then to the left:

    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> steered = steer(graph, [0.0] * 60 + [np.pi / 2] * 60)
    >>> len(steered.motion), steered.blending.shape
    (120, (120,))

    Notebook: 08b-steering
    """
    controller = Controller(graph)
    poses, left = [], []
    for heading in headings:
        left.append(controller.frames_left)
        poses.append(controller.step(float(heading), speed))
    roots, turns, blending = (np.array(values) for values in zip(*poses, strict=True))
    skeleton = controller.graph.source.clips[0].skeleton
    return Steered(Motion(skeleton, roots, turns, controller.graph.fps, "steered"), blending, np.array(left))


class Delay(NamedTuple):
    """The delay until a character obeys, and the CPU time per step.

    `mean` and `slowest` (95 %) are delays in seconds; `step` (mean) and `worst` are CPU times in ms. Two mean
    parts of the delay are `waiting`, until the hop under way ends, and `blending`, in transitions after it.
    The rest is spent in clips that turn.
    """

    mean: float
    slowest: float
    step: float
    worst: float
    waiting: float
    blending: float


def measure_delay(
    graph: MotionGraph | CompiledGraph, *, turns: int = 60, speed: float = 1.1, seed: int = 0
) -> Delay:
    """Command a character to turn by 30 to 120 degrees many times, and measure how soon it obeys.

    It obeys when its direction over the last third of a second is within 20 degrees of the command. A turn
    that takes longer than 8 s counts as 8 s.

    Parameters
    ----------
    graph : pruned.
    turns : the number of turns.
    speed : metres per second.
    seed : of the random turns.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> 0 < measure_delay(graph, turns=1).mean <= 8
    True

    Notebook: 08b-steering
    """
    controller, random = Controller(graph), np.random.default_rng(seed)
    heading, back = 0.0, round(controller.graph.fps / 3)
    track, costs, delays = [0j] * back, [0.0], []
    for _ in range(turns):
        heading += random.choice([-1, 1]) * random.uniform(np.pi / 6, 2 * np.pi / 3)
        wait, frames, blends = controller.frames_left, 0, 0
        obeys = False
        while not obeys and frames < round(8 * controller.graph.fps):
            start = time.thread_time()
            pose = controller.step(heading, speed)
            costs.append(time.thread_time() - start)
            track.append(complex(pose.root_position[2], pose.root_position[0]))
            blends += pose.blending and frames >= wait
            way = (track[-1] - track[-1 - back]) * np.exp(-1j * heading)
            obeys, frames = frames >= back and abs(np.angle(way)) < np.pi / 9, frames + 1
        delays.append((frames, min(wait, frames), blends))
    took, waited, blended = np.transpose(delays) / controller.graph.fps
    slowest, cost = float(np.percentile(took, 95)), np.array(costs[1:]) * 1e3
    parts = float(waited.mean()), float(blended.mean())
    return Delay(float(took.mean()), slowest, float(cost.mean()), float(cost.max()), *parts)
