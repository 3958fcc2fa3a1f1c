"""Control on a parametric motion graph: one decision per motion, and no search [HG07, 5]."""

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, concatenate
from mocap.body.planar import PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.matching.point_clouds import align
from mocap.methods.parametric_graphs.made_motions import HALF, WINDOW, make_motion
from mocap.methods.parametric_graphs.parametric_edges import Way
from mocap.methods.parametric_graphs.stride_spaces import Space
from mocap.steering.characters import Pose, require_command

TARGET = ("left", "up", "ahead")  # the parameters of a place of the world, as the body sees it at phase 0
COMMANDED = ("turn", "speed")  # the parameters that a command sets
ROUNDS = 8  # of asking for a place, at most: where a motion comes to lie depends on what is asked
CLOSE = 0.002  # metres: then no more rounds


class Chosen(NamedTuple):
    """A decision: the node, what was wished of it, what its box allows, what it came to, the seam's cost, m.

    What nobody asks for is nan in `wished`: there the middle of the box is taken. Asked by turn and speed, a
    box has corners that no clip fills; there `got` differs from `taken`.

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
    """A character on a parametric motion graph; it fits `steering.Character` [HG07, 5; seam].

    Five frames before a motion is left, it reads which box of targets may follow, takes the parameters in it
    that are nearest to the command, makes that motion, and blends over 11 frames. All frames until the next
    decision are made at once, so that most steps only read. Nodes asked by "left", "up" and "ahead" are told
    their place of the world by `aim`, and are entered by their label [ours].

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
        self.skeleton, self.fps = space.examples.skeleton, space.examples.fps
        usual = {"turn": 0.0, "speed": float(np.median(space.examples.values[:, 1]))}
        middle = np.median(space.reached, axis=0)
        asked = [usual.get(name, own) for name, own in zip(space.parameters, middle, strict=True)]
        self.parameters = np.clip(asked, space.low, space.high)
        self.chosen: list[Chosen] = []
        self.made, self.place = make_motion(space, self.parameters), PlanarTransform(0.0, 0.0, 0.0)
        self._play([], 0, self.made.frame(0.0))

    @property
    def end(self) -> PlanarTransform:
        """Where and how the body stands when the motion that plays is over, to aim from there."""
        at = self.made.frame(1.0)
        x, _, z = self.made.motion.root_positions[at]
        return self.place @ PlanarTransform(float(self.made.heading[at]), x, z)

    @property
    def frames_left(self) -> int:
        """The frames until the next decision."""
        return len(self._frames) - self._next

    def aim(self, place: ArrayLike) -> None:
        """Say where in the world (x, y, z), metres, the hand is to be in the motions that are asked by it.

        Raises
        ------
        MocapError : for a place that is not three finite numbers.
        """
        target = np.asarray(place, float)
        if target.shape != (3,) or not np.isfinite(target).all():
            raise MocapError(f"A place of the world is three finite numbers, got {target.tolist()}."[:200])
        self.target = target

    def step(self, heading: float, speed: float, label: str = "") -> Pose:
        """Walk on by one frame.

        Parameters
        ----------
        heading : the direction to go in, radians; 0 is +z, π/2 is +x.
        speed : metres per second.
        label : the node to go to, by the fewest motions; "" for any that walks.

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
        """Put the frames of the motion from `first` to its decision behind others, whose last are blended."""
        edges = self.graph.edges(self.node, data="edge")
        self.way: dict[str, Way] = {after: edge.look_up(self.parameters) for _, after, edge in edges}
        soonest = min(self.made.frame(way.leave) for way in self.way.values()) - HALF
        self._next, self._at = 0, max(soonest, first)
        start = sum(map(len, before)) - blended
        self._blended = range(start, start + blended)
        self._frames = concatenate([*before, *self._laid(first, self._at)])

    def _laid(self, first: int, stop: int) -> list[Motion]:
        """Place some frames of the motion: one motion, or none."""
        return [self.place.apply_motion(self.made.motion[first:stop])] if first < stop else []

    def _choose(self, heading: float, speed: float, label: str) -> None:
        """Choose the next motion, make it, and blend into it."""
        node = self._towards(label, heading, speed)
        space, way, place = self.graph.nodes[node]["space"], self.way[node], self.end
        taken = np.full(len(way.low), np.inf)
        for number in range(1 if set(space.parameters) <= set(COMMANDED) else ROUNDS):
            wished = self._wish(space, place, heading, speed)
            asked = np.where(np.isnan(wished), (way.low + way.high) / 2, wished)
            goal = np.clip(asked, way.low, way.high)
            if np.abs(goal - taken).max() < CLOSE:
                break
            taken = (taken + goal) / 2 if number else goal  # half of the way: else they swing about the goal
            made = make_motion(space, taken)
            centre, into = max(self.made.frame(way.leave), self._at + HALF), made.frame(way.enter)
            pair = (self.made, centre), (made, into)
            parts = [one.motion[middle - HALF : middle + HALF + 1] for one, middle in pair]
            window, facing = (joint_positions(p)[:, space.examples.joints].reshape(-1, 3) for p in parts)
            lay = align(window, facing)
            place = self.place @ lay
        cost = float(np.sqrt(((window - lay.apply_points(facing)) ** 2).sum(axis=1).mean()))
        self.chosen.append(Chosen(node, wished, taken, made.values, cost))
        rest, old = self._laid(self._at, centre - HALF), self.place.apply_motion(parts[0])
        self.node, self.parameters, self.made, self.place = node, taken, made, place
        mixed = blend(old, self.place.apply_motion(parts[1]), cubic_weights(WINDOW))
        self._play([*rest, mixed], WINDOW, into + HALF + 1)

    def _wish(self, space: Space, start: PlanarTransform, heading: float, speed: float) -> Array:
        """Say which parameters would obey, for a body that stands at `start`: nan for what is not asked."""
        missing = (heading - start.angle - space.examples.offset + np.pi) % (2 * np.pi) - np.pi
        seen = start.inverse().apply_points(self.target)
        known = {"turn": missing, "speed": speed, **dict(zip(TARGET, seen, strict=True))}
        return np.array([known.get(name, np.nan) for name in space.parameters])

    def _towards(self, label: str, heading: float, speed: float) -> str:
        """Choose the node: one on the way to the label, or the one whose box comes nearest to the wish."""
        graph, spaces = self.graph, self.graph.nodes(data="space")
        if label and label not in graph:
            raise NoWalk(f"There is no node '{label}'; there are: {', '.join(graph)}.")
        # All that obey commands, if one that does may follow.
        obey = {node for node, space in spaces if not set(space.parameters).isdisjoint(COMMANDED)}
        goals = [label] if label else [node for node in obey if obey & set(graph.successors(node))]
        if not label and (ways := [node for node in self.way if node in goals or not goals]):
            return min(ways, key=lambda node: self._missed(node, heading, speed))
        far = nx.multi_source_dijkstra_path_length(graph.reverse(copy=False), goals)
        if not (ways := [node for node in self.way if node in far]):
            raise NoWalk(f"No motions lead from '{self.node}' to '{label or 'one that walks'}'.")
        return min(ways, key=lambda node: far[node])

    def _missed(self, node: str, heading: float, speed: float) -> float:
        """Measure how far the best of a box is from the wish, in radians and m/s together."""
        space, way = self.graph.nodes[node]["space"], self.way[node]
        wished = self._wish(space, self.end, heading, speed)
        off = dict(zip(space.parameters, np.abs(wished - np.clip(wished, way.low, way.high)), strict=True))
        usual = np.abs(np.median(space.examples.values[:, 1]) - speed)
        return float(off.get("turn", 0.0) + off.get("speed", usual))
