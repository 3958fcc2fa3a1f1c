"""Control on a parametric motion graph: one decision per motion, without a search [HG07, 5]."""

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body.concatenation import concatenate
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.matching.point_clouds import align
from mocap.methods.parametric_graphs.examples import HALF
from mocap.methods.parametric_graphs.made_motions import WINDOW, MadeMotion, make_motion
from mocap.methods.parametric_graphs.parametric_edges import TargetBox
from mocap.methods.parametric_graphs.stride_spaces import Space
from mocap.methods.parametric_graphs.tuned import TUNED
from mocap.steering.characters import Pose, require_command

TARGET = ("left", "up", "ahead")  # the parameters of a position in the world, relative to the body at phase 0
COMMANDED = ("turn", "speed")  # the parameters that a command sets


class Chosen(NamedTuple):
    """A decision of a `ParametricController`.

    Parameters
    ----------
    node : the node of the motion.
    requested : shape (d,), the parameters by the command, or NaN for those without a request, for which the
        middle of the box is used.
    allowed : shape (d,), the nearest parameters in the box.
    reached : shape (d,), the parameters of the motion. They differ in corners of the box without clips.
    cost : the cost of the transition, metres.

    Examples
    --------
    >>> Chosen("walk", np.array([1.2]), np.array([0.8]), np.array([0.8]), 0.02).node
    'walk'
    """

    node: str
    requested: Array
    allowed: Array
    reached: Array
    cost: float


class _Seam(NamedTuple):
    """A transition: its frames in two motions, the windows, the alignment of the second, and the cost."""

    leave: int
    enter: int
    source: Motion
    target: Motion
    transform: PlanarTransform
    cost: float  # metres


class ParametricController:
    """A character on a parametric motion graph, which implements `steering.Character` [HG07, 5; seam].

    Five frames before a motion is left, the character looks up the box of targets that may follow, chooses
    the parameters in it nearest to the command, generates that motion, and blends over 11 frames. All frames
    until the next decision are generated at once, so that most steps only read them. For nodes with the
    parameters "left", "up" and "ahead", `aim` sets the position in the world. They are entered by their label
    [ours].

    Parameters
    ----------
    graph : a graph of spaces, as from `build_parametric`, in which every node has a successor.
    start : the first node, by default the first of the graph.

    Raises
    ------
    MocapError : for a start that is not in the graph.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.parametric_edges import build_parametric
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> graph = build_parametric({"walk": make_space(strides, 0.4, -0.8, 0.8)}, good=0.05)
    >>> ParametricController(graph).step(heading=0.5, speed=0.8).rotations.shape
    (38, 4)

    Notebook: 17-parametric-graphs
    """

    def __init__(self, graph: nx.DiGraph, *, start: str | None = None) -> None:
        self.graph = graph
        self.node = next(iter(graph)) if start is None else start
        if self.node not in graph:
            raise MocapError(f"There is no node '{self.node}'; there are: {', '.join(graph)}.")
        space: Space = graph.nodes[self.node]["space"]
        self.target = np.full(3, np.nan)
        self._transform_since = IDENTITY
        self.rotation_rate = 0.0  # radians per second, of one who turns the figure in addition
        self.skeleton = space.examples.skeleton
        self.fps = space.examples.fps
        usual = {"turn": 0.0, "speed": float(np.median(space.examples.values[:, 1]))}
        medians = zip(space.parameters, np.median(space.reached, axis=0), strict=True)
        parameters = [usual.get(name, median) for name, median in medians]
        self.parameters = np.clip(parameters, space.low, space.high)
        self.chosen: list[Chosen] = []
        self.current = make_motion(space, self.parameters)
        self.transform = IDENTITY
        self._play([], 0, self.current.frame(0.0))

    @property
    def end(self) -> PlanarTransform:
        """The position and heading of the body at the end of the current motion."""
        last = self.current.frame(1.0)
        x, _, z = self.current.motion.root_positions[last]
        return self.transform @ PlanarTransform(float(self.current.heading[last]), x, z)

    @property
    def frames_left(self) -> int:
        """The number of frames until the next decision."""
        return len(self._frames) - self._next

    def aim(self, position: ArrayLike) -> None:
        """Set the target of the hand, a position (x, y, z) in the world, metres.

        Raises
        ------
        MocapError : for a position that is not three finite numbers.
        """
        target = np.asarray(position, float)
        if target.shape != (3,) or not np.isfinite(target).all():
            raise MocapError(f"A position is three finite numbers, got {target.tolist()}."[:200])
        self.target = target

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Advance the character by one frame.

        Parameters
        ----------
        heading : the desired heading, radians, 0 along +z and π/2 along +x.
        speed : metres per second.
        label : the node to reach by the fewest motions, or "" for any that walks.

        Raises
        ------
        MocapError : for a heading or speed that is not a finite number, or a speed below 0.
        NoWalk : for a node that is not in the graph, or cannot be reached.
        """
        require_command(heading, speed)
        if not self.frames_left:
            self._choose(heading, speed, label)
        frame = self._next
        motion = self._frames
        self._next += 1
        root, turns = self._transform_since.apply_frames(
            motion.root_positions[frame], motion.rotations[frame]
        )
        marks = {name: bool(mark[frame]) for name, mark in motion.contacts.items()}
        return Pose(root, turns, frame in self._blended, marks)

    @property
    def example(self) -> Motion:
        """The current motion, which shows how the joints bend."""
        return self.current.motion

    def transform_by(self, rotation: complex, translation: complex) -> None:
        """Transform what comes from now on by p ↦ rotation · p + translation, on the ground, z + ix."""
        transform = PlanarTransform.from_complex(rotation, translation)
        self.transform = transform @ self.transform
        self._transform_since = transform @ self._transform_since

    def _play(self, previous: list[Motion], blended: int, first: int) -> None:
        """Append the current motion, from frame `first` to the decision, after `blended` frames of a seam."""
        edges = self.graph.edges(self.node, data="edge")
        self.boxes: dict[str, TargetBox] = {node: edge.look_up(self.parameters) for _, node, edge in edges}
        soonest = min(self.current.frame(box.leave) for box in self.boxes.values()) - HALF
        self._decision = max(soonest, first)
        self._next = 0
        self._transform_since = IDENTITY  # of the frames, since they were generated
        start = sum(map(len, previous)) - blended
        self._blended = range(start, start + blended)
        self._frames = concatenate([*previous, *self._transformed(first, self._decision)])

    def _transformed(self, first: int, stop: int) -> list[Motion]:
        """Return frames of the current motion in the world, as a list of one motion or none."""
        return [self.transform.apply_motion(self.current.motion[first:stop])] if first < stop else []

    def _choose(self, heading: float, speed: float, label: str) -> None:
        """Choose the next motion, generate it, and blend into it."""
        node = self._next_node(label, heading, speed)
        space: Space = self.graph.nodes[node]["space"]
        box = self.boxes[node]
        transform = self.end
        parameters = np.full(len(box.low), np.inf)
        for number in range(1 if set(space.parameters) <= set(COMMANDED) else TUNED.position_rounds):
            requested = self._requested(space, transform, heading, speed)
            complete = np.where(np.isnan(requested), (box.low + box.high) / 2, requested)
            goal = np.clip(complete, box.low, box.high)
            if np.abs(goal - parameters).max() < TUNED.settled:
                break
            # After the first step, half steps are used, because full steps oscillate about the goal.
            parameters = (parameters + goal) / 2 if number else goal
            motion = make_motion(space, parameters)
            seam = self._seam(box, motion, space.examples.joints)
            transform = self.transform @ seam.transform
        self.chosen.append(Chosen(node, requested, parameters, motion.values, seam.cost))
        rest = self._transformed(self._decision, seam.leave - HALF)
        source = self.transform.apply_motion(seam.source)
        self.node = node
        self.parameters = parameters
        self.current = motion
        self.transform = transform
        mixed = blend(source, transform.apply_motion(seam.target), cubic_weights(WINDOW))
        self._play([*rest, mixed], WINDOW, seam.enter + HALF + 1)

    def _seam(self, box: TargetBox, motion: MadeMotion, joints: list[int]) -> _Seam:
        """Align a motion with the current one by their windows about the frames to enter and to leave."""
        leave = max(self.current.frame(box.leave), self._decision + HALF)
        enter = motion.frame(box.enter)
        source = self.current.motion[leave - HALF : leave + HALF + 1]
        target = motion.motion[enter - HALF : enter + HALF + 1]
        source_points = joint_positions(source)[:, joints].reshape(-1, 3)
        target_points = joint_positions(target)[:, joints].reshape(-1, 3)
        transform = align(source_points, target_points)
        differences = source_points - transform.apply_points(target_points)
        cost = float(np.sqrt((differences**2).sum(axis=1).mean()))
        return _Seam(leave, enter, source, target, transform, cost)

    def _requested(self, space: Space, start: PlanarTransform, heading: float, speed: float) -> Array:
        """Return the parameters that obey the command from a start, or NaN for those without a request."""
        turn = (heading - start.angle - space.examples.offset + np.pi) % (2 * np.pi) - np.pi
        target = start.inverse().apply_points(self.target)
        requests = {"turn": turn, "speed": speed, **dict(zip(TARGET, target, strict=True))}
        return np.array([requests.get(name, np.nan) for name in space.parameters])

    def _next_node(self, label: str, heading: float, speed: float) -> str:
        """Choose the next node, on the shortest path to the label or with the box nearest to the command."""
        graph = self.graph
        if label and label not in graph:
            raise NoWalk(f"There is no node '{label}'; there are: {', '.join(graph)}.")
        goals = {label} if label else self._commanded_nodes()
        if not label:
            candidates = [node for node in self.boxes if node in goals or not goals]
            if candidates:
                return min(candidates, key=lambda node: self._shortfall(node, heading, speed))
        lengths = nx.multi_source_dijkstra_path_length(graph.reverse(copy=False), goals)
        candidates = [node for node in self.boxes if node in lengths]
        if not candidates:
            raise NoWalk(f"No motions lead from '{self.node}' to '{label or 'one that walks'}'.")
        return min(candidates, key=lambda node: lengths[node])

    def _commanded_nodes(self) -> set[str]:
        """Return the nodes that obey commands and have a successor that also obeys them."""
        spaces = self.graph.nodes(data="space")
        obeying = {node for node, space in spaces if not set(space.parameters).isdisjoint(COMMANDED)}
        return {node for node in obeying if obeying & set(self.graph.successors(node))}

    def _shortfall(self, node: str, heading: float, speed: float) -> float:
        """Sum the differences in turn, radians, and speed, m/s, between the command and a node's box."""
        space: Space = self.graph.nodes[node]["space"]
        box = self.boxes[node]
        requested = self._requested(space, self.end, heading, speed)
        differences = np.abs(requested - np.clip(requested, box.low, box.high))
        by_name = dict(zip(space.parameters, differences, strict=True))
        usual = np.abs(np.median(space.examples.values[:, 1]) - speed)
        return float(by_name.get("turn", 0.0) + by_name.get("speed", usual))
