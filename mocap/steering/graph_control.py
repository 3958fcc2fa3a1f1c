"""Control on a motion graph: a character that gets a new command in any frame while it walks [KGP02, 5.3].

It looks ahead: many walks grow by one macro-edge per round, and the best stay. The cost of a walk is the sum
of ‖v - v'‖² Δt over its macro-edges: v is the mean velocity of the root over the macro-edge, v' the velocity
of the command, and Δt the macro-edge's duration. Each transition adds `SEAM`; each second without the label
of the command adds `LABEL`.
"""

from __future__ import annotations

import cmath
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap._shared.ties import first_in_order
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.steering.characters import Pose, require_command
from mocap.steering.layered_search import EQUAL, States, macro_edge_states, start_states
from mocap.steering.tuned import TUNED

SEAM = 0.1  # m²/s, as all costs here
LABEL = 4.0  # m²/s per second
AHEAD = 3.0  # seconds to look ahead
WIDTH = 64  # walks that stay in each round


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

    walks: States  # from the end of the macro-edge under way; `macro_edge` is the first of each

    def __init__(self, graph: MotionGraph | CompiledGraph, *, start: Node | None = None) -> None:
        self.graph = compile_graph(graph)
        self.skeleton = self.graph.source.clips[0].skeleton
        self.fps = self.graph.fps
        displacements = _displacements(self.graph)
        self.distances = np.abs(displacements)  # metres, of each macro-edge
        self.directions = np.angle(displacements)  # in coordinates of the clip that it leaves, radians
        seams = np.where(self.graph.blended, SEAM, 0.0)
        self.macro_edges = macro_edge_states(self.graph, self.distances, seams)
        self.seconds = self.macro_edges.frames / self.fps
        self.seconds_without = _seconds_without(self.graph)
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
        elif not self.decided:
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
            self.walks = self.walks._replace(rotation=rotation * self.walks.rotation)

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
        """Look ahead anew, from the end of the macro-edge under way, with one walk without macro-edges."""
        self.walks = start_states(np.array([self.node]), np.array([self.end_turn]), np.zeros(1, complex))
        self.decided = False

    def _look(self) -> None:
        """Lengthen every walk below the horizon by every macro-edge that leaves its node.

        The `WIDTH` walks with the lowest cost per frame stay. Without longer walks the choice is clear.
        """
        velocity, label = self.command
        is_short = self.walks.frames < AHEAD * self.fps
        short = self.walks.take(is_short)
        row, macro_edge = self.graph.macro_edges.leaving(short.node)
        self.decided = not len(macro_edge)
        if self.decided:
            return
        seconds = self.seconds[macro_edge]
        distance = self.distances[macro_edge]
        travel = abs(velocity) * seconds
        missing = self._missing_angles(short.rotation, row, macro_edge)
        price = self.macro_edges.cost[macro_edge]
        turn = np.zeros(len(macro_edge))
        if self.rotation_rate:
            waiting = np.where(short.macro_edge < 0, self.frames_left / self.fps, 0.0)[row]
            start, turn = self._expected_turns(missing, waiting, seconds)
            missing = missing - (start + turn) / 2
            effort = self._correction_cost(distance - travel, turn, waiting + seconds, seconds)
            price = TUNED.turned_seam * price + effort
        # |v - v'|² Δt by the law of cosines
        error = (distance - travel) ** 2 + 2 * distance * travel * (1 - np.cos(missing))
        price = error / seconds + price
        if label >= 0:
            price += LABEL * self.seconds_without[label, macro_edge]
        # Only the walks that stay are put together.
        finished = self.walks.take(~is_short)
        cost = short.cost[row] + price
        frames = short.frames[row] + self.macro_edges.frames[macro_edge]
        costs = np.concatenate([finished.cost / finished.frames, cost / frames])
        chosen = first_in_order(costs, EQUAL, WIDTH)
        count = len(finished.cost)
        is_longer = chosen >= count
        longer = chosen[is_longer] - count
        rows = row[longer]
        steps = self.macro_edges.take(macro_edge[longer])
        rotation = np.exp(1j * turn[longer]) * steps.rotation
        grown = short.then(rows, steps._replace(rotation=rotation, cost=price[longer]))
        first = short.macro_edge[rows]
        grown = grown._replace(macro_edge=np.where(first < 0, macro_edge[longer], first))
        walks = States.join([finished.take(chosen[~is_longer]), grown])
        places = np.argsort(is_longer, kind="stable").argsort()  # where each of the chosen walks is now
        self.walks = walks.take(places)

    def _missing_angles(self, rotation: Points, row: Indices, macro_edge: Indices) -> Array:
        """Return the angles from the directions of macro-edges to the command's, in [-π, π); 0 if it stands.

        Parameters
        ----------
        rotation : of the walks ahead (N,).
        row, macro_edge : the walks' numbers, and the macro-edges that continue them.
        """
        velocity, _ = self.command
        if not velocity:
            return np.zeros(len(row))
        ahead = cmath.phase(velocity) - np.angle(rotation)
        missing = ahead[row] - self.directions[macro_edge]
        return np.asarray((missing + np.pi) % (2 * np.pi) - np.pi)

    def _expected_turns(self, missing: Array, waiting: Array, seconds: Array) -> tuple[Array, Array]:
        """Return the angles by which the figure will have been turned towards the command, radians.

        Parameters
        ----------
        missing : the angle of each macro-edge from the command, if the figure is not turned; radians.
        waiting, seconds : the time until a macro-edge begins, and its duration.

        Returns
        -------
        The angles at the start and at the end of each macro-edge.
        """
        earlier = self.rotation_rate * waiting
        largest = earlier + self.rotation_rate * seconds
        at_start = np.minimum(np.maximum(missing, -earlier), earlier)
        return at_start, np.minimum(np.maximum(missing, -largest), largest)

    def _correction_cost(self, lead: Array, turn: Array, turning: Array, seconds: Array) -> Array:
        """Return the cost of macro-edges whose direction and pace must be corrected, m²/s.

        A figure that can be turned obeys on any clip. Without this cost it might walk along a clip that turns
        all the time, and be turned back all the time.

        Parameters
        ----------
        lead : the distance by which each macro-edge is longer than the command asks for, metres.
        turn, turning : the angle by which the figure is turned for it, radians, and the time for that.
        seconds : its duration.
        """
        rotation_cost = (TUNED.rotation_price * turn) ** 2 / turning
        return np.asarray(rotation_cost + TUNED.pace_price * lead**2 / seconds)

    def _choose(self) -> None:
        """Take the first macro-edge of the best walk, and look ahead from its end."""
        while not self.decided:
            self._look()
        macro_edge = int(self.walks.macro_edge[0])
        if macro_edge < 0:
            raise NoWalk(f"The walk ends at node {self.graph.nodes[self.node]}: prune the graph first.")
        self.edges = self.graph.macro_edges.edges(np.array([macro_edge])).tolist()
        last = self.edges[-1]
        self.frame = 0
        self.node = int(self.graph.target[last])
        self.end_turn = self.turn * complex(self.graph.rotation[last])
        self._restart()


def _displacements(graph: CompiledGraph) -> Points:
    """Compute the root's displacement over each macro-edge (H,), in coordinates of the clip it leaves."""
    macro_edges = graph.macro_edges
    starts = np.repeat(graph.at, np.diff(macro_edges.first))
    targets = graph.target[macro_edges.last]
    ends = graph.rotation[macro_edges.last] * graph.at[targets] + graph.translation[macro_edges.last]
    return ends - starts


def _seconds_without(graph: CompiledGraph) -> Array:
    """Compute the seconds of each of H macro-edges without each of L labels, (L, H)."""
    macro_edges = graph.macro_edges
    frames = np.pad(np.cumsum(~graph.bears, axis=1), ((0, 0), (1, 0)))  # without the label so far, (L, T + 1)
    stops = macro_edges.starts + macro_edges.counts
    of_edges: Indices = frames[:, stops] - frames[:, macro_edges.starts]  # (L, H, 2)
    return np.asarray(of_edges.sum(axis=-1) / graph.fps)
