"""Control on a motion graph: a character that gets a new command in any frame while it walks [KGP02, 5.3]."""

import cmath
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, on_ground
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.steering.characters import Pose
from mocap.steering.look_ahead import Command, WalksAhead, lengthen, look_ahead_by, start_walk

LONGEST, WIDEST = 60.0, 10_000  # seconds to look ahead, walks that stay in each round


class Controller:
    """A character on a motion graph; each `step` takes a command and gives the next pose [KGP02, 5.3].

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
    MocapError : for less than a frame or more than a minute to look ahead, and a width outside 1 to 10 000.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(), 30)]
    >>> controller = Controller(graphs.prune(graphs.build(clips, window=10, threshold=0.04)))
    >>> controller.step(heading=0.0, speed=1.0).rotations.shape
    (38, 4)
    """

    walks: WalksAhead  # from the end of the hop under way

    def __init__(
        self,
        graph: MotionGraph | CompiledGraph,
        *,
        start: Node | None = None,
        ahead: float = 3.0,
        width: int = 64,
    ) -> None:
        self.graph = compile_graph(graph)
        if not (1 / self.graph.fps <= ahead <= LONGEST and 1 <= width <= WIDEST):
            raise MocapError(
                f"A character looks ahead from a frame to {LONGEST:g} s, and keeps 1 to {WIDEST} walks; "
                f"got {ahead} s and {width}."
            )
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
    def skeleton(self) -> Skeleton:
        """The joints of the graph's clips."""
        return self.graph.source.clips[0].skeleton

    @property
    def fps(self) -> float:
        """Frames per second, those of the graph."""
        return self.graph.fps

    @property
    def frames_left(self) -> int:
        """The frames until the next choice: the rest of the hop under way."""
        return sum(int(self.graph.frames[edge]) for edge in self.edges) - self.frame * bool(self.edges)

    def feet(self) -> Points:
        """Give where ankles and balls are on the ground in the last pose, left before right, shape (4,).

        In a transition the feet of both clips are blended as the root is; those of the blended pose are some
        millimetres from there.

        Raises
        ------
        MocapError : before the first step, and for legs that cannot be found.
        """
        if not self.frame:
            raise MocapError("Feet are those of the last pose: take a step first.")
        edge, frame, graph = self.edges[0], self.frame - 1, self.graph
        (clip, first), (other, end), _ = graph.edges[edge]
        feet = self._feet[clip][first + frame]
        if graph.blended[edge]:
            there = graph.turn[edge] * self._feet[other][end - graph.source.window + frame]
            alpha = self._weights[frame]
            feet = alpha * feet + (1 - alpha) * (there + graph.move[edge])
        return np.asarray(self.turn * feet + self.move)

    def turn_about(self, point: complex, angle: float) -> None:
        """Turn what comes from now on about a point on the ground, z + ix, by an angle in radians.

        The walks ahead turn along; what their first hops cost stays, as good as the angle is small.
        """
        more = cmath.exp(1j * angle)
        self.turn, self.move = more * self.turn, more * (self.move - point) + point
        self.end_turn *= more
        self.walks = self.walks._replace(turn=more * self.walks.turn)

    @cached_property
    def _feet(self) -> list[Points]:
        """The ankles and balls on the ground in each frame (F, 4) of each clip, in its coordinates."""
        joints = [joint for leg in find_legs(self.skeleton) for joint in (leg.ankle, leg.ball)]
        return [on_ground(joint_positions(clip)[:, joints]) for clip in self.graph.source.clips]

    @cached_property
    def _weights(self) -> Array:
        return cubic_weights(self.graph.source.window)

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
        return Pose(root, turns, blending=False, contacts=_contacts(clips[clip], first + frame))
    move += turn * complex(graph.move[edge])
    turn *= complex(graph.turn[edge])
    there = _placed(clips[other], end - window + frame, turn, move)
    alpha = cubic_weights(window)[frame]
    mixed = alpha * root + (1 - alpha) * there[0]
    owner = (clips[clip], first + frame) if alpha >= 0.5 else (clips[other], end - window + frame)
    pose = rotations.slerp(there[1], turns, np.array(alpha))
    return Pose(mixed, pose, blending=True, contacts=_contacts(*owner))


def _contacts(clip: Motion, frame: int) -> dict[str, bool]:
    """Say which joints stand in a frame of a clip."""
    return {name: bool(mark[frame]) for name, mark in clip.contacts.items()}


def _placed(motion: Motion, frame: int, turn: complex, move: complex) -> tuple[Array, Array]:
    """Place one frame: root position and rotations."""
    place = PlanarTransform.from_complex(turn, move)
    turns = motion.rotations[frame].copy()
    turns[0] = place.apply_orientations(turns[0])
    return place.apply_points(motion.root_positions[frame]), turns
