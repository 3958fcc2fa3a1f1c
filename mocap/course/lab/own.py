"""A motion graph of one's own: `mocap.plain`, made of the functions that students write in 01 to 08.

The functions of `mocap.plain` are the exercises of the course, in their order, and they call each other by
name. So a copy of these pages whose names are the exercises' functions is a program made of them: the
student's functions where they passed their checks, else the package's. Nothing here is quick.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap import plain
from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion, require_compatible
from mocap.body.skeleton import Skeleton
from mocap.course.lab.adopting import NAMES as NAMES
from mocap.course.lab.adopting import Tools
from mocap.course.lab.adopting import as_written as as_written
from mocap.course.lab.adopting import tools as tools
from mocap.course.lab.slots import whose_run
from mocap.errors import MocapError
from mocap.plain import Edge, Ground, Node, Transform, Transitions, Walk

WINDOW = 10  # frames in a window of a transition
BELOW = 0.05  # metres: the threshold of the transitions
AHEAD = 1.5  # seconds that a choice looks ahead: with less, no turn is seen
BEAM_WIDTH = 60  # walks that are kept in a layer
SEAM = 0.05  # m²: the price of a seam
LEAST_SPEED = 0.1  # metres per second: the least progress along a path
CELL = 0.1  # metres: walks count as equal if their positions agree to this,
CELL_HEADING = 0.1  # radians: and their headings to this
OwnWalk = tuple[
    list[Edge], complex, complex
]  # edges, and the first clip's transform, p ↦ rotation · p + translation


def pages_of(by: Tools | None, window: int, below: float = 0.0) -> Any:  # noqa: ANN401 (a module)
    """Copy `mocap.plain`, with functions of exercises in place of its own, if any are given.

    Notebook: 04-blending
    """
    spec = importlib.util.find_spec("mocap.plain")
    assert spec is not None and spec.loader is not None
    pages = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pages)
    if by:
        places = Places(by, window)
        vars(pages).update({name: getattr(places, name) for name in vars(Places) if name[0] != "_"})
        vars(pages)["Search"] = type("Search", (OwnSearch, vars(pages)["Search"]), {"by": by})
    vars(pages).update(K=window, BELOW=below)
    return pages


class Places:
    """Functions of `mocap.plain` by name, each made of an exercise's; arguments and results are plain's.

    The exercises write a transform as (angle, x, z), and plain as (rotation, translation).
    """

    def __init__(self, by: Tools, window: int) -> None:
        self._by = by
        self._window = window

    def joint_positions(self, clip: Motion) -> Array:
        """Compute the position of each joint by a climb to the root."""
        climb = self._by.climb
        body = clip.skeleton
        frames = []
        for root, rotations in zip(clip.root_positions, clip.rotations, strict=True):
            frames.append([root + climb(body, rotations, joint) for joint in range(len(body))])
        return np.array(frames)

    def distance_grid(self, a: Array, b: Array) -> Array:
        """Compare all windows by sums along diagonals."""
        return np.sqrt(squared_distances(a, b, self._window, self._by.window_sums))

    def local_minima(self, grid: Array, below: float) -> list[tuple[int, int]]:
        """Find the minima inside of a grid."""
        return [(int(i), int(j)) for i, j in self._by.inner_minima(grid, below)]

    def align(self, p: Array, q: Array) -> Transform:
        """Find the best angle, then the best translation."""
        angle = float(self._by.best_angle(p, q))
        return _to_transform(angle, *map(float, self._by.best_shift(p, q, angle)))

    def inverse(self, rotation: complex, translation: complex) -> Transform:
        """Invert a transform."""
        return _to_transform(*self._by.undo(*_to_angle(rotation, translation)))

    def compose(self, first: Transform, second: Transform) -> Transform:
        """Compose two transforms."""
        return _to_transform(*self._by.product_of(np.array([_to_angle(*first), _to_angle(*second)])))

    def transform_clip(
        self, clip: Motion, frames: slice, rotation: complex, translation: complex
    ) -> tuple[Array, Array]:
        """Rotate the root about the vertical axis by a product."""
        roots, rotations = plain.transform_clip(clip, frames, rotation, translation)
        half = np.angle(rotation) / 2
        about_y = np.array([np.cos(half), 0, np.sin(half), 0])
        rotations[:, 0] = [_to_unit(self._by.hamilton(about_y, root)) for root in clip.rotations[frames, 0]]
        return roots, rotations

    def cubic_weights(self) -> Array:
        """Weigh by the polynomial of degree five."""
        return np.asarray(self._by.quintic(self._window))

    def blend(self, first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
        """Mix two windows, as motions of a chain of as many joints."""
        joints = first[1].shape[1]
        body = Skeleton(list(map(str, range(joints))), np.arange(-1, joints - 1), np.zeros((joints, 3)))
        first_motion = Motion(body, *first, plain.FPS)
        second_motion = Motion(body, *second, plain.FPS)
        roots, rotations = self._by.mix(first_motion, second_motion, self.cubic_weights())
        return np.asarray(roots), np.asarray(rotations)

    def cut_and_join(self, clips: Sequence[Motion], transitions: Transitions) -> nx.MultiDiGraph:
        """Cut the clips at the choice points, and join them by the successors of each."""
        points = []
        for clip, motion in enumerate(clips):
            leaves = [leave for a, leave, *_ in transitions if a == clip]
            enters = [enter for _, _, b, enter, *_ in transitions if b == clip]
            points.append(self._by.choice_points(len(motion), leaves, enters, self._window))
        windows = [transition[:4] for transition in transitions]
        following = self._by.successors_of(points, windows, self._window)
        graph = nx.MultiDiGraph(following=following)
        graph.add_nodes_from(sorted(following))
        for clip, frames in enumerate(points):
            for start, end in pairwise(frames):
                fields = {"kind": "clip", "frames": end - start, "cost": 0.0, "transform": (1, 0)}
                graph.add_edge((clip, start), (clip, end), **fields)
        for a, i, b, j, cost, transform in transitions:
            fields = {"kind": "transition", "frames": self._window, "cost": cost, "transform": transform}
            graph.add_edge((a, i), (b, j + self._window), **fields)
        return graph

    def components(self, graph: nx.MultiDiGraph) -> Any:  # noqa: ANN401
        """Find the strongly connected components."""
        sys.setrecursionlimit(max(sys.getrecursionlimit(), 4 * len(graph) + 1000))
        return self._by.tarjan(graph.graph["following"])

    def prune(self, graph: nx.MultiDiGraph) -> nx.MultiDiGraph:
        """Keep one component."""
        played = []
        for start, end, kind in graph.edges(data="kind"):
            if kind == "clip":
                played.append((start, end, end[1] - start[1]))
        kept = self._by.component_to_keep(self.components(graph), played)
        return graph.subgraph(kept).copy()


class OwnSearch:
    """The search of `mocap.plain` by `look_ahead`, `lengthen` and `survivors`, for roots alone."""

    by: Tools
    graph: nx.MultiDiGraph
    roots: list[Ground]
    tracks: dict[Edge, Ground]
    ahead: dict[Node, Ground]

    def __init__(self, clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> None:
        roots = [
            SimpleNamespace(root_positions=clip.root_positions, rotations=clip.rotations[:, :1])
            for clip in clips
        ]
        search: Any = super()
        search.__init__(roots, graph, line)
        self.path = GroundPath(np.stack([line.imag, line.real], axis=1))
        self.least_step = LEAST_SPEED / clips[0].fps  # metres
        self.numbers = {node: number for number, node in enumerate(graph)}
        self.starts_of_nodes = {(clip, frame): self.roots[clip][max(frame - 1, 0)] for clip, frame in graph}
        for edge, track in self.tracks.items():
            self.tracks[edge] = np.append(self.starts_of_nodes[edge[0]], track)

    def look_ahead(self, walk: Walk) -> Walk:
        """Estimate the cost of the frames ahead as the exercise does."""
        ahead = np.append(self.starts_of_nodes[walk.node], self.ahead[walk.node])
        expected = self.by.look_ahead(_state_of(walk), ahead, self._point_at, plain.RESCUE)
        return walk._replace(expected=expected)

    def _point_at(self, length: ArrayLike) -> Ground:
        """Return the points of the path at arc lengths, as complex numbers."""
        return np.asarray(self.path.at(length) @ [1j, 1], complex)

    def lengthen(self, walk: Walk, edge: Edge) -> Walk:
        """Extend a walk by one edge."""
        data = self.graph.edges[edge]
        price = SEAM if data["kind"] == "transition" else 0.0
        edges = [(edge[1], self.tracks[edge], *data["transform"], price)]
        longer = self.by.lengthen(_state_of(walk), edges, self.path.at, self.least_step)
        ((_, rotation, translation, along, cost),) = longer
        return self.look_ahead(Walk(cost, 0, along, edge[1], rotation, translation, edge, walk))

    def best_of(self, walks: list[Walk]) -> list[Walk]:
        """Keep the survivors of a layer."""
        cells = []
        for walk in walks:
            position = walk.rotation * self.ahead[walk.node][0] + walk.translation
            heading = np.angle(walk.rotation)
            cell = position.real / CELL, position.imag / CELL, heading / CELL_HEADING
            cells.append([self.numbers[walk.node], *map(round, cell)])
        costs = np.array([walk.cost + walk.expected for walk in walks])
        return [walks[number] for number in self.by.survivors(np.array(cells), costs, BEAM_WIDTH)]


def _state_of(walk: Walk) -> tuple[complex, complex, float, float]:
    """Return a walk as the exercises take it: rotation, translation, metres along the line, cost."""
    return walk.rotation, walk.translation, walk.along, walk.cost


def squared_distances(a: Array, b: Array, window: int, window_sums: Callable[[Array, int], Array]) -> Array:
    """Measure D between all windows of two clips, shapes (N, n, 3) and (M, n, 3): shape (N, M), m².

    With points on the ground as complex numbers g = z + ix, and means over a window's points,
    D = S + S' - 2 mean(y y') - 2 |mean(g ḡ') - mean(g) mean(ḡ')|: the grid of notebook 02b.
    """
    points = a.shape[1]
    origin = a.mean(axis=(0, 1)) * [1, 0, 1]  # numbers near 0 lose no digits
    first = a - origin
    second = b - origin
    first_mean = plain.ground(first).mean(1)
    second_mean = plain.ground(second).mean(1)
    first_size = (first**2).sum(-1).mean(-1) - abs(first_mean) ** 2
    second_size = (second**2).sum(-1).mean(-1) - abs(second_mean) ** 2
    first_frames = _frames_of(first, window)
    second_frames = _frames_of(second, window)
    products = plain.ground(first_frames) @ plain.ground(second_frames).conj().T
    covariance = window_sums(products.real, window) + 1j * window_sums(products.imag, window)
    horizontal = np.abs(covariance / points - first_mean[:, None] * second_mean.conj())
    vertical = window_sums(first_frames[..., 1] @ second_frames[..., 1].T, window) / points
    return np.asarray(np.maximum(first_size[:, None] + second_size - 2 * vertical - 2 * horizontal, 0))


def _frames_of(windows: Array, window: int) -> Array:
    """Return each frame of a clip once, from all its windows: shape (F, n / window, 3)."""
    slots = np.split(windows, window, axis=1)  # the first frames of all windows, the second ones, ...
    return np.concatenate([slots[0], *(slot[-1:] for slot in slots[1:])])


def _to_transform(angle: float, x: float, z: float) -> Transform:
    rotation: complex = np.exp(1j * angle)
    return rotation, np.complex128(complex(z, x))


def _to_unit(quaternion: Array) -> Array:
    """Return a quaternion of length 1, since a wrong product may have another length; 0 becomes 1."""
    length = np.linalg.norm(quaternion)
    return quaternion / length if length > 0 else np.array([1.0, 0.0, 0.0, 0.0])


def _to_angle(rotation: complex, translation: complex) -> tuple[float, float, float]:
    return float(np.angle(rotation)), translation.imag, translation.real


class OwnGraph:
    """A motion graph of clips, of which the component that plays most frames is kept, and walks on it.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window, threshold : of the transitions: frames, and metres.
    by : whose functions work; None for those of `mocap.plain`.

    Attributes
    ----------
    pages : the copy of `mocap.plain` which calls these functions.
    transitions, graph : all transitions, and the nodes and edges that are kept, as in `mocap.plain`.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, clips that differ in skeleton or rate or are shorter than the
        window, and where there is no loop: the threshold is too low.

    Notebook: 08b-steering
    """

    def __init__(self, clips: Sequence[Motion], window: int, threshold: float, by: Tools | None) -> None:
        self.clips = require_compatible(clips)
        self.pages = pages_of(by, window, threshold)
        self.by = by or Tools()
        if not 2 <= window <= min(map(len, self.clips)):
            raise MocapError(f"A graph takes a window of two frames up to the shortest clip, got {window}.")
        self.transitions = self.pages.find_transitions(self.clips)
        whole = self.pages.cut_and_join(self.clips, self.transitions)
        self.graph: nx.MultiDiGraph = self.pages.prune(whole)
        if len(self.graph) < 2:
            raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")

    def follow(self, path: ArrayLike) -> OwnWalk:
        """Find a walk along a path: all walks advance layer by layer, as in notebook 08 [KGP02, Eq. 9].

        Parameters
        ----------
        path : corners on the ground (x, z), shape (N, 2), metres.

        Raises
        ------
        ValueError : if no walk reaches the end of the path.
        """
        line = self.pages.points_along(np.asarray(path, float))
        walk: OwnWalk = self.pages.Search(self.clips, self.graph, line).walk()
        return walk

    def steer(self, command: Callable[[float], tuple[float, float]], seconds: float) -> OwnWalk:
        """Walk for some seconds, and choose at each node the edge that fits the command of that moment.

        Parameters
        ----------
        command : from the time in seconds to a heading in radians (0 is +z, π/2 is +x) and a speed, metres
            per second.
        seconds : how long to walk.
        """
        fps = self.clips[0].fps
        frames_ahead = round(AHEAD * fps)
        search = self.pages.Search(self.clips, self.graph, self.pages.points_along(np.eye(2)))
        node = min(self.graph)
        transform = (1 + 0j, 0j)
        walk: list[Edge] = []
        frames = 0
        while frames < seconds * fps:
            edges = list(self.graph.out_edges(node, keys=True))
            tracks = [self._track_ahead(search, edge)[: frames_ahead + 1] for edge in edges]
            number = self.by.next_edge(transform[0], tracks, *command(frames / fps), fps)
            edge = edges[int(number)]
            walk.append(edge)
            frames += len(search.tracks[edge]) - 1
            transform = self.pages.compose(transform, self.graph.edges[edge]["transform"])
            node = edge[1]
        return walk, 1, 0

    def _track_ahead(self, search: Any, edge: Edge) -> Ground:  # noqa: ANN401 (of a copied module)
        """Return the root's track on an edge, and then to the end of the clip that the edge leads into."""
        clip, frame = edge[1]
        rotation, translation = self.graph.edges[edge]["transform"]
        onward = rotation * search.roots[clip][frame:] + translation
        return np.concatenate([search.tracks[edge], onward])

    def play(self, walk: OwnWalk) -> Motion:
        """Play a walk, shape (F, ...): copy stretches of clip, blend transitions [KGP02, Eqs. 5 and 6]."""
        roots, rotations = self.pages.to_motion(self.clips, self.graph, *walk)
        return Motion(self.clips[0].skeleton, roots, rotations, self.clips[0].fps, "my walk")


def walk_along(
    clips: Sequence[Motion], window: int, threshold: float, path: ArrayLike, by: Tools | None
) -> tuple[Motion, int]:
    """Build a graph of clips, and walk along a path.

    Parameters
    ----------
    clips, window, threshold, by : as for `OwnGraph`.
    path : corners on the ground (x, z), shape (N, 2), metres.

    Returns
    -------
    The motion, and its number of transitions.

    Notebook: 08-path-synthesis
    """
    graph = OwnGraph(clips, window, threshold, by)
    walk = graph.follow(path)
    seams = sum(graph.graph.edges[edge]["kind"] == "transition" for edge in walk[0])
    return graph.play(walk), seams


def my_walk(clips: Sequence[Motion], window: int, threshold: float, path: ArrayLike) -> tuple[Motion, int]:
    """Walk along a path by the student's functions as they stand, right or wrong, and print whose they are.

    If functions that do not pass do not fit together, which is printed, those that pass walk without them.

    Parameters
    ----------
    clips, window, threshold, path : as for `walk_along`.

    Returns
    -------
    The motion, and its number of transitions.

    Notebook: 08-path-synthesis
    """
    by = as_written()
    try:
        walk = walk_along(clips, window, threshold, path, by)
    except Exception as error:  # whatever functions that do not pass lead to
        by = tools()
        problem = f"{type(error).__name__}: {error}"
        print(f"As you wrote them, your functions do not fit together. {problem}"[:200])
        walk = walk_along(clips, window, threshold, path, by)
    print(whose_run(vars(by)[name] for name in NAMES[:-1]))  # the last one steers, in 08b
    return walk


def main(file: str) -> int:
    """Walk along a line by the functions in a file as they stand, right or wrong.

    The arguments on the command line are those of `python -m mocap.plain`: clips, a path, and -o.

    Returns
    -------
    The exit status: 0, or 2 if there is no walk.
    """
    os.environ["MOCAP_MINE"] = file
    by = as_written()
    print(f"{whose_run(vars(by)[name] for name in NAMES[:-1])}.")
    pages = pages_of(by, WINDOW, BELOW)
    pages.joint_positions = _counted(pages.joint_positions, "clips measured")
    pages.distance_grid = _counted(pages.distance_grid, "pairs of clips compared")
    pages.Search.best_of = _counted(pages.Search.best_of, "layers searched")
    try:
        return int(pages.main())
    except Exception as error:  # functions that do not pass may not fit together
        problem = f"{type(error).__name__}: {error}"
        print(f"{Path(file).name}: its functions do not fit together. {problem}"[:200], file=sys.stderr)
        return 2


def _counted(function: Callable[..., Any], label: str) -> Callable[..., Any]:
    """Return a function that also shows on a terminal how often it has been called."""
    from tqdm import tqdm  # no notebook needs it

    bar = tqdm(bar_format="{n} {desc}, {elapsed}", desc=label, delay=1.0, leave=False, disable=None)

    def call(*arguments: Any) -> Any:  # noqa: ANN401 (as the function has it)
        result = function(*arguments)
        bar.update()
        return result

    return call
