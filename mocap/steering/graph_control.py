"""Control on a motion graph: a character that gets a new command in any frame while it walks [KGP02, 5.3].

It looks ahead while it walks, as `look_ahead` describes, and plays the first macro-edge of the best walk.
"""

from __future__ import annotations

import cmath
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.steering.characters import Pose, require_command
from mocap.steering.look_ahead import LookAhead, Request


class Controller:
    """A character on a motion graph; each `step` takes a command and gives the next pose [KGP02, 5.3].

    While it plays one macro-edge, it looks ahead from the end of this macro-edge: in each frame all walks
    ahead grow by one round, so that no step takes long. At the end of the macro-edge it takes the first
    macro-edge of the best walk. The cost of a walk compares its velocity with the command, as this file says.

    A step makes little garbage. But when Python's collector visits a large graph, this takes 30 to 90 ms.
    Where every step must be on time, call `gc.freeze()` after the graph is built.

    A figure that is turned in addition, up to `rotation_rate` radians per second, needs no clip that turns.
    The look-ahead counts on it: it turns the walks towards the command as far as their time allows. It
    prefers clips that need little of it, and have the speed of the command.

    Parameters
    ----------
    graph : pruned, so that a walk never ends.
    start : the first node; by default the first of the graph.

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

    def __init__(self, graph: MotionGraph | CompiledGraph, *, start: Node | None = None) -> None:
        self.graph = compile_graph(graph)
        self.skeleton = self.graph.source.clips[0].skeleton
        self.fps = self.graph.fps
        self.ahead = LookAhead(self.graph)
        # Those of the macro-edge under way that are still to be played; the first one is being played.
        self.edges: list[int] = []
        self.frame = 0  # of the first edge
        # The transform of its clip: p ↦ turn · p + move.
        self.turn = 1 + 0j
        self.move = 0j
        # The node where the macro-edge under way ends, and the rotation of its clip there.
        self.node = 0 if start is None else self.graph.index(start)
        self.end_turn = self.turn
        self.command = (0j, -1)  # velocity, label
        self.rotation_rate = 0.0  # radians per second
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
        require_command(heading, speed)
        velocity = speed * complex(np.exp(1j * heading))
        command = (velocity, self.graph.label_number(label))
        if command != self.command:
            self.command = command
            self._restart()
        if self.edges and self.frame == self.graph.frames[self.edges[0]]:
            self.turn, self.move = self._next_transform()
            self.turn /= abs(self.turn)  # stays of length 1 on walks of any length
            self.frame = 0
            del self.edges[0]
        if not self.edges:
            self._choose()
        elif not self.ahead.decided:
            self._look()
        self.frame += 1
        source, target, alpha = self._blended_frames()
        root, local = self._placed(source, self.turn, self.move)
        blending = source != target
        if blending:
            target_root, target_local = self._placed(target, *self._next_transform())
            root = alpha * root + (1 - alpha) * target_root
            local = rotations.slerp(target_local, local, np.array(alpha))
        clip, frame = source if alpha >= 0.5 else target
        marks = self.graph.source.clips[clip].contacts.items()
        return Pose(root, local, blending, {name: bool(mark[frame]) for name, mark in marks})

    @property
    def frames_left(self) -> int:
        """The frames until the next choice: the rest of the macro-edge under way."""
        if not self.edges:
            return 0
        return int(self.graph.frames[self.edges].sum()) - self.frame

    @property
    def example(self) -> Motion:
        """The longest clip of the graph, which shows how the joints bend."""
        return max(self.graph.source.clips, key=len)

    def feet(self) -> Points:
        """Return the ground positions of ankles and balls in the last pose, left before right, (4,).

        In a transition the feet of both clips are blended as the root is; those of the blended pose are some
        millimetres from there.

        Raises
        ------
        MocapError : for legs that cannot be found.
        """
        (source, source_frame), (target, target_frame), alpha = self._blended_frames()
        edge = self.edges[0]
        source_feet = self._feet[source][source_frame]
        target_feet = (
            self.graph.rotation[edge] * self._feet[target][target_frame] + self.graph.translation[edge]
        )
        feet = alpha * source_feet + (1 - alpha) * target_feet
        return np.asarray(self.turn * feet + self.move)

    def turn_about(self, point: complex, angle: float) -> None:
        """Turn what comes from now on about a point on the ground, z + ix, by an angle in radians."""
        rotation = cmath.exp(1j * angle)
        self.transform_by(rotation, point - rotation * point)

    def transform_by(self, rotation: complex, translation: complex) -> None:
        """Transform what comes from now on by p ↦ rotation · p + translation, on the ground, z + ix.

        The walks ahead turn along, unless they count on it (`rotation_rate`). What their first macro-edges
        cost stays, as good as the angle is small.
        """
        self.turn = rotation * self.turn
        self.move = rotation * self.move + translation
        self.end_turn *= rotation
        if not self.rotation_rate:
            self.ahead.rotate(rotation)

    @cached_property
    def _feet(self) -> list[Points]:
        """The ankles and balls on the ground in each frame (F, 4) of each clip, in its coordinates."""
        joints = [joint for leg in find_legs(self.skeleton) for joint in (leg.ankle, leg.ball)]
        return [on_ground(joint_positions(clip)[:, joints]) for clip in self.graph.source.clips]

    def _blended_frames(self) -> tuple[Node, Node, float]:
        """Return the two clip frames that the last pose is blended from, and the weight of the first one."""
        row = self.graph.first[self.edges[0]] + self.frame - 1
        source = self.graph.here[row].tolist()
        target = self.graph.there[row].tolist()
        return source, target, float(self.graph.alpha[row])

    def _next_transform(self) -> tuple[complex, complex]:
        """Return the transform of the clip that the edge under way leads to."""
        edge = self.edges[0]
        turn = complex(self.graph.rotation[edge])
        move = complex(self.graph.translation[edge])
        return self.turn * turn, self.move + self.turn * move

    def _placed(self, node: Node, turn: complex, move: complex) -> tuple[Array, Array]:
        """Place one frame of a clip: root position and rotations."""
        number, frame = node
        clip = self.graph.source.clips[number]
        transform = PlanarTransform.from_complex(turn, move)
        return transform.apply_frames(clip.root_positions[frame], clip.rotations[frame])

    def _restart(self) -> None:
        """Look ahead anew, from the end of the macro-edge under way."""
        self.ahead.restart(self.node, self.end_turn)

    def _look(self) -> None:
        """Look ahead by one more round, if the choice is not clear yet."""
        velocity, label = self.command
        waiting = self.frames_left / self.fps
        self.ahead.grow(Request(velocity, label, self.rotation_rate, waiting))

    def _choose(self) -> None:
        """Take the first macro-edge of the best walk, and look ahead from its end."""
        while not self.ahead.decided:
            self._look()
        macro_edge = self.ahead.best
        if macro_edge < 0:
            raise NoWalk(f"The walk ends at node {self.graph.nodes[self.node]}: prune the graph first.")
        self.edges = self.graph.macro_edges.edges(np.array([macro_edge])).tolist()
        last = self.edges[-1]
        self.frame = 0
        self.node = int(self.graph.target[last])
        self.end_turn = self.turn * complex(self.graph.rotation[last])
        self._restart()
