"""Control on a motion graph: a character that gets a new command in any frame while it walks [KGP02, 5.3].

It looks ahead: many walks grow by one hop per round, and the best stay. The cost of a walk is the sum of
‖v - v'‖² Δt over its hops: v is the mean velocity of the root over the hop, v' the velocity of the command,
and Δt the hop's duration. Each transition adds `SEAM`; each second without the label of the command adds
`LABEL`.
"""

from __future__ import annotations

import cmath
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap._shared.ties import in_order
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.steering.characters import Pose, require_command
from mocap.steering.layered_search import EQUAL, States, hop_states, start_states

SEAM = 0.1  # m²/s, as all costs here
LABEL = 4.0  # m²/s per second
AHEAD, WIDTH = 3.0, 64  # seconds to look ahead, walks that stay in each round


class Controller:
    """A character on a motion graph; each `step` takes a command and gives the next pose [KGP02, 5.3].

    While it plays one hop, it looks ahead from the end of this hop: in each frame all walks ahead grow by one
    round, so that no step takes long. At the end of the hop it takes the first hop of the best walk. The cost
    of a walk compares its velocity with the command, as this file says.

    A step makes little garbage. But when Python's collector visits a large graph, this takes 30 to 90 ms.
    Where every step must be on time, call `gc.freeze()` after the graph is built.

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

    walks: States  # from the end of the hop under way; `hop` is the first of each

    def __init__(self, graph: MotionGraph | CompiledGraph, *, start: Node | None = None) -> None:
        self.graph = compile_graph(graph)
        self.skeleton, self.fps = self.graph.source.clips[0].skeleton, self.graph.fps
        # The root's way on the ground over each hop (H,), in the coordinates of the clip that it leaves.
        hops, last = self.graph.hops, self.graph.hops.last
        leaves = np.repeat(np.arange(len(self.graph.nodes)), np.diff(hops.first))
        end = self.graph.turn[last] * self.graph.at[self.graph.target[last]] + self.graph.move[last]
        self.moved = end - self.graph.at[leaves]
        self.hops = hop_states(self.graph, np.abs(self.moved), np.where(self.graph.blended, SEAM, 0.0))
        # Seconds of each hop without each of the L labels, (L, H).
        without = np.pad(np.cumsum(~self.graph.bears, axis=1), ((0, 0), (1, 0)))  # (L, T + 1), frames
        played: Indices = without[:, hops.starts + hops.counts] - without[:, hops.starts]  # (L, H, 2)
        self.lacks: Array = played.sum(axis=-1) / self.graph.fps
        self.edges: list[int] = []  # of the hop under way, still to be played; the first one is being played
        self.frame = 0  # of the first edge
        self.turn, self.move = 1 + 0j, 0j  # place its clip: p ↦ turn · p + move
        # The node where the hop under way ends, and how its clip is turned there.
        self.node, self.end_turn = 0 if start is None else self.graph.index(start), self.turn
        self.command = 0j, -1
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
        command = speed * complex(np.exp(1j * heading)), self.graph.label_number(label)
        if command != self.command:
            self.command = command
            self._restart()
        if self.edges and self.frame == self.graph.frames[self.edges[0]]:
            self.turn, self.move = self._after()
            self.turn /= abs(self.turn)  # stays of length 1 on walks of any length
            self.frame = 0
            del self.edges[0]
        if not self.edges:
            self._choose()
        elif not self.decided:
            self._look()
        self.frame += 1
        here, there, alpha = self._played()
        root, turns = self._placed(here, self.turn, self.move)
        if blending := here != there:
            other, turned = self._placed(there, *self._after())
            root, turns = alpha * root + (1 - alpha) * other, rotations.slerp(turned, turns, np.array(alpha))
        clip, frame = here if alpha >= 0.5 else there
        marks = self.graph.source.clips[clip].contacts.items()
        return Pose(root, turns, blending, {name: bool(mark[frame]) for name, mark in marks})

    @property
    def frames_left(self) -> int:
        """The frames until the next choice: the rest of the hop under way."""
        return int(self.graph.frames[self.edges].sum()) - self.frame * bool(self.edges)

    def feet(self) -> Points:
        """Give where ankles and balls are on the ground in the last pose, left before right, (4,).

        In a transition the feet of both clips are blended as the root is; those of the blended pose are some
        millimetres from there.

        Raises
        ------
        MocapError : for legs that cannot be found.
        """
        (clip, frame), (other, then), alpha = self._played()
        edge = self.edges[0]
        laid = self.graph.turn[edge] * self._feet[other][then] + self.graph.move[edge]
        return np.asarray(self.turn * (alpha * self._feet[clip][frame] + (1 - alpha) * laid) + self.move)

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

    def _played(self) -> tuple[Node, Node, float]:
        """Give the two clip frames, and the weight of the first one, that the last frame is made of."""
        row = self.graph.first[self.edges[0]] + self.frame - 1
        here, there = self.graph.here[row].tolist(), self.graph.there[row].tolist()
        return here, there, float(self.graph.alpha[row])

    def _after(self) -> tuple[complex, complex]:
        """Place the clip that the edge under way leads to."""
        turn, move = (complex(some[self.edges[0]]) for some in (self.graph.turn, self.graph.move))
        return self.turn * turn, self.move + self.turn * move

    def _placed(self, at: Node, turn: complex, move: complex) -> tuple[Array, Array]:
        """Place one frame of a clip: root position and rotations."""
        clip, frame = self.graph.source.clips[at[0]], at[1]
        place = PlanarTransform.from_complex(turn, move)
        return place.apply_frames(clip.root_positions[frame], clip.rotations[frame])

    def _restart(self) -> None:
        """Look ahead anew, from the end of the hop under way, with one walk without hops."""
        self.walks = start_states(np.array([self.node]), np.array([self.end_turn]), np.zeros(1, complex))
        self.decided = False

    def _look(self) -> None:
        """Lengthen every walk below the horizon by every hop that leaves its node; keep the best walks.

        The best are the `WIDTH` with the lowest cost per frame. Without longer walks the choice is clear.
        """
        (velocity, label), short = self.command, self.walks.frames < AHEAD * self.fps
        going = self.walks.take(short)
        of, hop = self.graph.hops.leaving(going.node)
        self.decided = not len(hop)
        if self.decided:
            return
        steps = self.hops.take(hop)
        seconds = steps.frames / self.fps
        off = going.turn[of] * self.moved[hop] - velocity * seconds
        cost = (off.real**2 + off.imag**2) / seconds + steps.cost
        if label >= 0:
            cost += LABEL * self.lacks[label, hop]
        longer = going.then(of, steps._replace(cost=cost))
        first = np.where(going.hop[of] < 0, hop, going.hop[of])
        walks = States.join([self.walks.take(~short), longer._replace(hop=first)])
        self.walks = walks.take(in_order(walks.cost / walks.frames, EQUAL)[:WIDTH])

    def _choose(self) -> None:
        """Take the first hop of the best walk, and look ahead from its end."""
        while not self.decided:
            self._look()
        hop = int(self.walks.hop[0])
        if hop < 0:
            raise NoWalk(f"The walk ends at node {self.graph.nodes[self.node]}: prune the graph first.")
        self.edges = self.graph.hops.edges(np.array([hop])).tolist()
        last = self.edges[-1]
        self.frame, self.node = 0, int(self.graph.target[last])
        self.end_turn = self.turn * complex(self.graph.turn[last])
        self._restart()
