"""Control on a parametric motion graph: one decision per stride, and no search [HG07, 5]."""

from typing import NamedTuple

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, concatenate
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, NoWalk
from mocap.matching.point_clouds import align
from mocap.methods.parametric_graphs.made_strides import HALF, WINDOW, make_stride
from mocap.methods.parametric_graphs.parametric_edges import Way
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph
from mocap.methods.parametric_graphs.stride_spaces import StrideSpace
from mocap.steering.characters import Pose, require_command


class Chosen(NamedTuple):
    """A decision: the node, what was wished of it, what its box allows, what it came to, the seam's cost, m.

    Asked by turn and speed, a box has corners that no clip fills; there `got` differs from `taken`.

    Examples
    --------
    >>> Chosen("walk", np.array([1.2]), np.array([0.8]), np.array([0.8]), 0.02).node
    'walk'
    """

    node: str
    wished: Array
    taken: Array
    got: Array
    cost: float


class ParametricController:
    """A character on a parametric motion graph; it fits `steering.Character` [HG07, 5].

    Five frames before a stride is left, it reads which box of targets may follow, takes the parameters in it
    that are nearest to the command, makes that stride, and blends over 11 frames. All frames until the next
    decision are made at once, so that most steps only read.

    Parameters
    ----------
    graph : of spaces that may follow one another for ever.
    start : the first node; by default the first of the graph.

    Raises
    ------
    MocapError : for a start that is not in the graph.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.parametric_motion_graphs import build_parametric
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> graph = build_parametric({"walk": make_space(strides, 0.4, -0.8, 0.8)}, good=0.05)
    >>> ParametricController(graph).step(heading=0.5, speed=0.8).rotations.shape
    (38, 4)

    Notebook: 17-parametric-graphs
    """

    def __init__(self, graph: ParametricGraph, *, start: str | None = None) -> None:
        self.graph = graph
        self.node = next(iter(graph.graph)) if start is None else start
        if self.node not in graph.graph:
            raise MocapError(f"There is no node '{self.node}'; there are: {', '.join(graph.graph)}.")
        space = graph.space(self.node)
        for name in graph.graph:  # now, not at the first stride of each
            _ = graph.space(name).sampled_poses
        straight = np.array([0.0, np.median(space.strides.values[:, 1])])[space.columns]
        self.parameters = space.clipped(straight)
        self.chosen: list[Chosen] = []
        self.stride, self.place = make_stride(space, self.parameters), PlanarTransform(0.0, 0.0, 0.0)
        self._play([], 0, self.stride.frame(0.0))

    @property
    def skeleton(self) -> Skeleton:
        """The joints of the graph's strides."""
        return self.graph.space(self.node).strides.skeleton

    @property
    def fps(self) -> float:
        """Frames per second, those of the graph."""
        return self.graph.fps

    @property
    def frames_left(self) -> int:
        """The frames until the next decision."""
        return len(self._frames) - self._next

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame.

        Parameters
        ----------
        heading : the direction to go in, radians; 0 is +z, π/2 is +x.
        speed : metres per second.
        label : the node to go to, by the fewest strides; "" for any.

        Raises
        ------
        MocapError : for a heading or speed that is no finite number, or a speed below 0.
        NoWalk : for a node that is not in the graph, or cannot be reached.
        """
        require_command(heading, speed)
        if not self.frames_left:
            self._choose(heading, speed, label)
        frame, motion = self._next, self._frames
        self._next += 1
        marks = {name: bool(mark[frame]) for name, mark in motion.contacts.items()}
        return Pose(motion.root_positions[frame], motion.rotations[frame], frame in self._blended, marks)

    def _play(self, before: list[Motion], blended: int, first: int) -> None:
        """Put the frames of the stride from `first` to its decision behind others, whose last are blended."""
        self.way: dict[str, Way] = {
            node: self.graph.edge(self.node, node).look_up(self.parameters)
            for node in self.graph.graph.successors(self.node)
        }
        soonest = min(self.stride.frame(way.leave) for way in self.way.values()) - HALF
        self._next, self._at = 0, max(soonest, first)
        start = sum(map(len, before)) - blended
        self._blended = range(start, start + blended)
        self._frames = concatenate([*before, *self._laid(first, self._at)])

    def _laid(self, first: int, stop: int) -> list[Motion]:
        """Place some frames of the stride: one motion, or none."""
        return [self.place.apply_motion(self.stride.motion[first:stop])] if first < stop else []

    def _choose(self, heading: float, speed: float, label: str) -> None:
        """Choose the next stride, make it, and blend into it."""
        node = self._towards(label, heading, speed)
        space, way = self.graph.space(node), self.way[node]
        wished = self._wish(space, heading, speed)
        taken = np.clip(wished, way.low, way.high)
        made, centre = make_stride(space, taken), max(self.stride.frame(way.leave), self._at + HALF)
        into, rest = made.frame(way.enter), self._laid(self._at, centre - HALF)
        parts = [
            stride.motion[middle - HALF : middle + HALF + 1]
            for stride, middle in ((self.stride, centre), (made, into))
        ]
        joints = space.strides.joints
        window, facing = (joint_positions(part)[:, joints].reshape(-1, 3) for part in parts)
        lay = align(window, facing)
        cost = float(np.sqrt(((window - lay.apply_points(facing)) ** 2).sum(axis=-1).mean()))
        self.chosen.append(Chosen(node, wished, taken, made.values[space.columns], cost))
        old = self.place.apply_motion(parts[0])
        self.node, self.parameters, self.stride, self.place = node, taken, made, self.place @ lay
        mixed = blend(old, self.place.apply_motion(parts[1]), cubic_weights(WINDOW))
        self._play([*rest, mixed], WINDOW, into + HALF + 1)

    def _wish(self, space: StrideSpace, heading: float, speed: float) -> Array:
        """Say which parameters would obey the command: the turn still missing, and the speed."""
        at = self.stride.frame(1.0)
        now = self.place.angle + self.stride.heading[at] + space.strides.offset
        missing = (heading - now + np.pi) % (2 * np.pi) - np.pi
        return np.array([missing, speed])[space.columns]

    def _towards(self, label: str, heading: float, speed: float) -> str:
        """Choose the node: one on the way to the label, or the one whose box comes nearest to the wish."""
        if label:
            if label not in self.graph.graph:
                raise NoWalk(f"There is no node '{label}'; there are: {', '.join(self.graph.graph)}.")
            try:
                route = nx.shortest_path(self.graph.graph, self.node, label)
            except nx.NetworkXNoPath as error:
                raise NoWalk(f"No strides lead from '{self.node}' to '{label}'.") from error
            if len(route) > 1:
                return str(route[1])
            if label in self.way:
                return label
            return min(self.way, key=lambda node: nx.shortest_path_length(self.graph.graph, node, label))
        return min(self.way, key=lambda node: self._missed(node, heading, speed))

    def _missed(self, node: str, heading: float, speed: float) -> float:
        """Measure how far the best of a box is from the wish, in radians and m/s together."""
        space, way = self.graph.space(node), self.way[node]
        wished = self._wish(space, heading, speed)
        off = dict(zip(space.parameters, np.abs(wished - np.clip(wished, way.low, way.high)), strict=True))
        usual = np.abs(np.median(space.strides.values[:, 1]) - speed)
        return float(off.get("turn", 0.0) + off.get("speed", usual))
