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
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap import plain
from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion, require_alike
from mocap.body.skeleton import Skeleton
from mocap.course.lab.adopting import NAMES as NAMES
from mocap.course.lab.adopting import Tools, whose
from mocap.course.lab.adopting import tools as tools
from mocap.errors import MocapError
from mocap.plain import Edge, Found, Ground, Lay, Node, Walk

WINDOW, BELOW = 10, 0.05  # of the transitions: frames, and metres
AHEAD = 1.5  # seconds that a choice looks ahead: with less, no turn is seen
WIDTH, SEAM = 60, 0.05  # walks that go on from a layer, and the price of a seam in m²
LEAST = 0.1  # metres per second: the least progress
PLACE, TURN = 0.1, 0.1  # metres and radians: walks that agree so far stand alike
OwnWalk = tuple[list[Edge], complex, complex]  # edges, and how the first clip is placed, p ↦ turn · p + move


def pages_of(by: Tools | None, window: int, below: float = 0.0) -> Any:  # noqa: ANN401 (a module)
    """Copy `mocap.plain`, with functions of exercises in the places of its own, if any are given.

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

    The exercises move by (angle, x, z), and plain by (turn, move).
    """

    def __init__(self, by: Tools, window: int) -> None:
        self._by, self._window = by, window

    def joint_positions(self, clip: Motion) -> Array:
        """Let each joint climb to the root."""
        joints, frames = range(len(clip.skeleton)), zip(clip.root_positions, clip.rotations, strict=True)
        climb = self._by.climb
        body = clip.skeleton
        return np.array([[at + climb(body, turns, joint) for joint in joints] for at, turns in frames])

    def distance_grid(self, a: Array, b: Array) -> Array:
        """Compare all windows by sums along diagonals."""
        return np.sqrt(squared_distances(a, b, self._window, self._by.window_sums))

    def local_minima(self, grid: Array, below: float) -> list[tuple[int, int]]:
        """Find the minima inside of a grid."""
        return [(int(i), int(j)) for i, j in self._by.inner_minima(grid, below)]

    def align(self, p: Array, q: Array) -> Lay:
        """Find the best angle, then the best shift."""
        angle = float(self._by.best_angle(p, q))
        return _to_lay(angle, *map(float, self._by.best_shift(p, q, angle)))

    def undo(self, turn: complex, move: complex) -> Lay:
        """Undo a transform."""
        return _to_lay(*self._by.undo(*_to_angle(turn, move)))

    def product(self, first: Lay, then: Lay) -> Lay:
        """Multiply two transforms."""
        return _to_lay(*self._by.product_of(np.array([_to_angle(*first), _to_angle(*then)])))

    def lay(self, clip: Motion, frames: slice, turn: complex, move: complex) -> tuple[Array, Array]:
        """Turn the root about the vertical by a product."""
        roots, turns = plain.lay(clip, frames, turn, move)
        half = np.angle(turn) / 2
        about_y = np.array([np.cos(half), 0, np.sin(half), 0])
        turns[:, 0] = [self._by.hamilton(about_y, own) for own in clip.rotations[frames, 0]]
        return roots, turns

    def cubic_weights(self) -> Array:
        """Weigh by the polynomial of degree five."""
        return np.asarray(self._by.quintic(self._window))

    def blend(self, one: tuple[Array, Array], other: tuple[Array, Array]) -> tuple[Array, Array]:
        """Mix two windows, as motions of any body."""
        count = one[1].shape[1]
        body = Skeleton(list(map(str, range(count))), np.arange(-1, count - 1), np.zeros((count, 3)))
        first, second = (Motion(body, *poses, plain.FPS) for poses in (one, other))
        roots, turns = self._by.mix(first, second, self.cubic_weights())
        return np.asarray(roots), np.asarray(turns)

    def cut_and_join(self, clips: Sequence[Motion], transitions: Found) -> nx.MultiDiGraph:
        """Cut at the choice points, and join by what follows each."""
        points = []
        for clip, motion in enumerate(clips):
            leaves = [leave for a, leave, *_ in transitions if a == clip]
            enters = [enter for _, _, b, enter, *_ in transitions if b == clip]
            points.append(self._by.choice_points(len(motion), leaves, enters, self._window))
        following = self._by.successors_of(points, [found[:4] for found in transitions], self._window)
        graph = nx.MultiDiGraph(following=following)
        graph.add_nodes_from(sorted(following))
        for clip, frames in enumerate(points):
            for start, end in pairwise(frames):
                about = {"kind": "clip", "frames": end - start, "cost": 0.0, "lay": (1, 0)}
                graph.add_edge((clip, start), (clip, end), **about)
        for a, i, b, j, cost, lay in transitions:
            about = {"kind": "transition", "frames": self._window, "cost": cost, "lay": lay}
            graph.add_edge((a, i), (b, j + self._window), **about)
        return graph

    def components(self, graph: nx.MultiDiGraph) -> Any:  # noqa: ANN401
        """Find the components as Tarjan does."""
        sys.setrecursionlimit(max(sys.getrecursionlimit(), 4 * len(graph) + 1000))
        return self._by.tarjan(graph.graph["following"])

    def prune(self, graph: nx.MultiDiGraph) -> nx.MultiDiGraph:
        """Keep one component."""
        played = [(a, b, b[1] - a[1]) for a, b, kind in graph.edges(data="kind") if kind == "clip"]
        return graph.subgraph(self._by.component_to_keep(self.components(graph), played)).copy()


class OwnSearch:
    """What the search of `mocap.plain` does by `look_ahead`, `lengthen` and `survivors`, for roots alone."""

    by: Tools
    graph: nx.MultiDiGraph
    roots: list[Ground]
    tracks: dict[Edge, Ground]
    ahead: dict[Node, Ground]

    def __init__(self, clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> None:
        roots = [
            SimpleNamespace(root_positions=c.root_positions, rotations=c.rotations[:, :1]) for c in clips
        ]
        search: Any = super()
        search.__init__(roots, graph, line)
        self.path, self.least = GroundPath(np.stack([line.imag, line.real], axis=1)), LEAST / clips[0].fps
        self.numbers = {node: number for number, node in enumerate(graph)}
        self.before = {(clip, frame): self.roots[clip][max(frame - 1, 0)] for clip, frame in graph}
        self.tracks = {edge: np.append(self.before[edge[0]], way) for edge, way in self.tracks.items()}

    def look_ahead(self, walk: Walk) -> Walk:
        """Expect what the exercise expects."""
        ahead = np.append(self.before[walk.node], self.ahead[walk.node])
        stands = walk.turn, walk.move, walk.along, walk.cost
        expected = self.by.look_ahead(stands, ahead, lambda s: self.path.at(s) @ [1j, 1], plain.RESCUE)
        return walk._replace(expected=expected)

    def lengthen(self, walk: Walk, edge: Edge) -> Walk:
        """Lengthen a walk by one edge."""
        data = self.graph.edges[edge]
        edges = [(edge[1], self.tracks[edge], *data["lay"], SEAM * (data["kind"] == "transition"))]
        stands = walk.turn, walk.move, walk.along, walk.cost
        ((_, turn, move, along, cost),) = self.by.lengthen(stands, edges, self.path.at, self.least)
        return self.look_ahead(Walk(cost, 0, along, edge[1], turn, move, edge, walk))

    def best_of(self, walks: list[Walk]) -> list[Walk]:
        """Let the survivors go on."""
        stand = []
        for walk in walks:
            here = walk.turn * self.ahead[walk.node][0] + walk.move
            cell = here.real / PLACE, here.imag / PLACE, np.angle(walk.turn) / TURN
            stand.append([self.numbers[walk.node], *map(round, cell)])
        costs = np.array([walk.cost + walk.expected for walk in walks])
        return [walks[number] for number in self.by.survivors(np.array(stand), costs, WIDTH)]


def squared_distances(a: Array, b: Array, window: int, window_sums: Callable[[Array, int], Array]) -> Array:
    """Measure D between all windows of two clips, shapes (N, n, 3) and (M, n, 3): shape (N, M), m².

    With points on the ground as complex numbers g = z + ix, and means over a window's points,
    D = S + S' - 2 mean(y y') - 2 |mean(g ḡ') - mean(g) mean(ḡ')|: the grid of notebook 02b.
    """
    origin, points = a.mean(axis=(0, 1)) * [1, 0, 1], a.shape[1]  # numbers near 0 lose no digits
    pair = a - origin, b - origin
    means = [plain.ground(windows).mean(1) for windows in pair]
    sizes = [(w**2).sum(-1).mean(-1) - abs(mean) ** 2 for w, mean in zip(pair, means, strict=True)]
    firsts = [np.split(windows, window, axis=1) for windows in pair]  # of each window, frame by frame
    frames = [np.concatenate([of[0], *(late[-1:] for late in of[1:])]) for of in firsts]  # each frame once
    products = plain.ground(frames[0]) @ plain.ground(frames[1]).conj().T
    both = window_sums(products.real, window) + 1j * window_sums(products.imag, window)
    turned = np.abs(both / points - means[0][:, None] * means[1].conj())
    level = window_sums(frames[0][..., 1] @ frames[1][..., 1].T, window) / points
    return np.asarray(np.maximum(sizes[0][:, None] + sizes[1] - 2 * level - 2 * turned, 0))


def _to_lay(angle: float, x: float, z: float) -> Lay:
    return np.exp(1j * angle), np.complex128(complex(z, x))


def _to_angle(turn: complex, move: complex) -> tuple[float, float, float]:
    return float(np.angle(turn)), move.imag, move.real


class OwnGraph:
    """A motion graph of clips, of which the component that plays most frames is kept, and walks on it.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window, threshold : of the transitions: frames, and metres.
    by : whose functions work; None for those of `mocap.plain`.

    Attributes
    ----------
    pages : the copy of `mocap.plain` in which these functions have their places.
    found, graph : all transitions, and the nodes and edges that are kept, as in `mocap.plain`.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, clips that differ in skeleton or rate or are shorter than the
        window, and where there is no loop: the threshold is too low.

    Notebook: 08b-steering
    """

    def __init__(self, clips: Sequence[Motion], window: int, threshold: float, by: Tools | None) -> None:
        self.clips, self.pages = require_alike(clips), pages_of(by, window, threshold)
        self.by = by or Tools()
        if not 2 <= window <= min(map(len, self.clips)):
            raise MocapError(f"A graph takes a window of two frames up to the shortest clip, got {window}.")
        self.found = self.pages.find_transitions(self.clips)
        self.graph: nx.MultiDiGraph = self.pages.prune(self.pages.cut_and_join(self.clips, self.found))
        if len(self.graph) < 2:
            raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")

    def follow(self, path: ArrayLike) -> OwnWalk:
        """Find a walk along a path: all walks advance layer by layer, as in notebook 08 [KGP02, Eq. 9].

        Parameters
        ----------
        path : corners on the ground (x, z), shape (N, 2), metres.

        Raises
        ------
        ValueError : where no walk comes to the end of the path.
        """
        search = self.pages.Search(self.clips, self.graph, self.pages.points_along(np.asarray(path, float)))
        found: OwnWalk = search.walk()
        return found

    def steer(self, command: Callable[[float], tuple[float, float]], seconds: float) -> OwnWalk:
        """Walk for some seconds, and choose at each node the edge that fits the command of that moment.

        Parameters
        ----------
        command : from the time in seconds to a heading in radians (0 is +z, π/2 is +x) and a speed, metres
            per second.
        seconds : how long to walk.
        """
        fps, pages = self.clips[0].fps, self.pages
        search, soon = pages.Search(self.clips, self.graph, pages.points_along(np.eye(2))), round(AHEAD * fps)
        node, lay, edges, frames = min(self.graph), (1 + 0j, 0j), [], 0
        while frames < seconds * fps:
            ways, tracks = list(self.graph.out_edges(node, keys=True)), []
            for way in ways:
                (clip, frame), (turn, move) = way[1], self.graph.edges[way]["lay"]
                there = turn * search.roots[clip][frame : frame + soon] + move
                tracks.append(np.concatenate([search.tracks[way], there])[: soon + 1])
            edges.append(ways[int(self.by.next_edge(lay[0], tracks, *command(frames / fps), fps))])
            frames += len(search.tracks[edges[-1]]) - 1
            node, lay = edges[-1][1], pages.product(lay, self.graph.edges[edges[-1]]["lay"])
        return edges, 1, 0

    def play(self, walk: OwnWalk) -> Motion:
        """Play a walk, shape (F, ...): copy stretches of clip, blend transitions [KGP02, Eqs. 5 and 6]."""
        roots, turns = self.pages.to_motion(self.clips, self.graph, *walk)
        return Motion(self.clips[0].skeleton, roots, turns, self.clips[0].fps, "my walk")


def main(file: str) -> int:
    """Walk along a line by the functions in a file, as `python -m mocap.plain` does: clips, a path, -o."""
    os.environ["MOCAP_MINE"] = file
    print(f"{whose(*NAMES[:-1])}.")
    return int(pages_of(tools(), WINDOW, BELOW).main())
