"""Functions of `mocap.plain`, rewritten so that they call the exercises of the course.

The names, arguments and results are those of `mocap.plain`. `program` writes these functions in place of
plain's, and gives them the student's `climb`, `hamilton` and so on; here these names are the package's
functions. The exercises write a transform as (angle, x, z), and plain as (rotation, translation).
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np

from mocap import plain
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.checks import all_checks
from mocap.plain import BEAM_WIDTH, CELL, CELL_HEADING, FPS, LOOK, RESCUE, SEAM, K, Walk, ground, to_motion

if TYPE_CHECKING:
    from mocap.plain import Array, Edge, Ground, Transform, Transitions

LEAST_STEP = 0.1 / FPS  # metres: the least progress along a line in a frame, for a body that stands


def _package(name: str) -> Any:  # noqa: ANN401 (a function of any arguments)
    return all_checks()[name].truth


climb = _package("climb")
window_sums = _package("window_sums")
inner_minima = _package("inner_minima")
best_angle = _package("best_angle")
best_shift = _package("best_shift")
undo = _package("undo")
choice_points = _package("choice_points")
successors_of = _package("successors_of")
tarjan = _package("tarjan")
component_to_keep = _package("component_to_keep")
lengthen = _package("lengthen")
look_ahead = _package("look_ahead")
survivors = _package("survivors")
product_of = _package("product_of")
hamilton = _package("hamilton")
quintic = _package("quintic")
mix = _package("mix")


def joint_positions(clip: Motion) -> Array:
    """Compute the position of each joint in each frame by a climb to the root, by `climb`."""
    frames = []
    for root, rotations in zip(clip.root_positions, clip.rotations, strict=True):
        joints = range(len(clip.skeleton))
        frames.append([root + climb(clip.skeleton, rotations, joint) for joint in joints])
    return np.array(frames)  # (F, J, 3)


def frames_of(windows: Array) -> Array:
    """Return each frame of a clip once, from all its windows: shape (F, n / K, 3)."""
    parts = np.split(windows, K, axis=1)  # the first frames of all windows, the second ones, ...
    return np.concatenate([parts[0], *(part[-1:] for part in parts[1:])])


def distance_grid(a: Array, b: Array) -> Array:
    """Compute the distances between the windows of two clips by sums along diagonals, by `window_sums`.

    With points on the ground as complex numbers g = z + ix, and means over a window's points,
    D = S + S' - 2 mean(y y') - 2 |mean(g ḡ') - mean(g) mean(ḡ')|: the grid of notebook 02b.
    """
    points = a.shape[1]
    origin = a.mean(axis=(0, 1)) * [1, 0, 1]  # numbers near 0 lose no digits
    first = a - origin
    second = b - origin
    first_mean = ground(first).mean(1)
    second_mean = ground(second).mean(1)
    first_size = (first**2).sum(-1).mean(-1) - abs(first_mean) ** 2
    second_size = (second**2).sum(-1).mean(-1) - abs(second_mean) ** 2
    first_frames = frames_of(first)
    second_frames = frames_of(second)
    products = ground(first_frames) @ ground(second_frames).conj().T
    covariance = window_sums(products.real, K) + 1j * window_sums(products.imag, K)
    horizontal = np.abs(covariance / points - first_mean[:, None] * second_mean.conj())
    vertical = window_sums(first_frames[..., 1] @ second_frames[..., 1].T, K) / points
    squares = first_size[:, None] + second_size - 2 * vertical - 2 * horizontal
    return np.asarray(np.sqrt(np.maximum(squares, 0)))


def local_minima(grid: Array, below: float) -> list[tuple[int, int]]:
    """Find the minima inside a grid that are below a threshold, by `inner_minima`."""
    return [(int(i), int(j)) for i, j in inner_minima(grid, below)]


def to_transform(angle: float, x: float, z: float) -> Transform:
    """Convert three numbers to a rotation and a translation."""
    rotation: complex = np.exp(1j * angle)
    return rotation, np.complex128(complex(z, x))


def to_angle(rotation: complex, translation: complex) -> tuple[float, float, float]:
    """Convert a rotation and a translation to three numbers: angle, x and z."""
    return float(np.angle(rotation)), translation.imag, translation.real


def align(p: Array, q: Array) -> Transform:
    """Find the transform that best aligns the points q with p, by `best_angle` and `best_shift`."""
    angle = float(best_angle(p, q))
    return to_transform(angle, *map(float, best_shift(p, q, angle)))


def inverse(rotation: complex, translation: complex) -> Transform:
    """Return the inverse of a planar rigid transform, by `undo`."""
    return to_transform(*undo(*to_angle(rotation, translation)))


def compose(first: Transform, second: Transform) -> Transform:
    """Compose two transforms, by `product_of`: p ↦ first(second(p))."""
    return to_transform(*product_of(np.array([to_angle(*first), to_angle(*second)])))


def to_unit(quaternion: Array) -> Array:
    """Return a quaternion of length 1, because a wrong product may have another length; 0 becomes 1."""
    length = np.linalg.norm(quaternion)
    return quaternion / length if length > 0 else np.array([1.0, 0.0, 0.0, 0.0])


def transform_clip(
    clip: Motion, frames: slice, rotation: complex, translation: complex
) -> tuple[Array, Array]:
    """Apply a transform to frames of a clip, by `hamilton`: roots (F, 3), rotations (F, J, 4)."""
    roots = clip.root_positions[frames].copy()
    rotations = clip.rotations[frames].copy()
    transformed = rotation * ground(roots) + translation
    roots[:, 2] = transformed.real
    roots[:, 0] = transformed.imag
    half = np.angle(rotation) / 2
    about_y = np.array([np.cos(half), 0, np.sin(half), 0])
    for frame, root in enumerate(clip.rotations[frames, 0]):
        rotations[frame, 0] = to_unit(hamilton(about_y, root))
    return roots, rotations


def cubic_weights() -> Array:
    """Return the weight of the first clip in each frame of a window, by `quintic` in place of the cubic."""
    return np.asarray(quintic(K))


def blend(first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
    """Blend two windows, by `mix`, which takes motions: here of a chain of as many joints."""
    joints = first[1].shape[1]
    names = [str(joint) for joint in range(joints)]
    parents = np.arange(-1, joints - 1)
    chain = Skeleton(names, parents, np.zeros((joints, 3)))
    roots, rotations = mix(Motion(chain, *first, FPS), Motion(chain, *second, FPS), cubic_weights())
    return np.asarray(roots), np.asarray(rotations)


def cut_and_join(clips: Sequence[Motion], transitions: Transitions) -> nx.MultiDiGraph:
    """Cut the clips and join the pieces into a graph, by `choice_points` and `successors_of`."""
    points = []
    for clip, motion in enumerate(clips):
        leaves = [leave for a, leave, *_ in transitions if a == clip]
        enters = [enter for _, _, b, enter, *_ in transitions if b == clip]
        points.append(choice_points(len(motion), leaves, enters, K))
    following = successors_of(points, [transition[:4] for transition in transitions], K)
    graph = nx.MultiDiGraph(following=following)
    graph.add_nodes_from(sorted(following))
    for clip, frames in enumerate(points):
        for start, end in pairwise(frames):
            if end <= start:  # a walk on a piece without frames would never end
                raise ValueError(f"Clip {clip}: {end} follows {start}. List each node once, in order.")
            fields = {"kind": "clip", "frames": end - start, "cost": 0.0, "transform": (1, 0)}
            graph.add_edge((clip, start), (clip, end), **fields)
    for a, i, b, j, cost, transform in transitions:
        fields = {"kind": "transition", "frames": K, "cost": cost, "transform": transform}
        graph.add_edge((a, i), (b, j + K), **fields)
    return graph


def components(graph: nx.MultiDiGraph) -> Any:  # noqa: ANN401
    """Find the strongly connected components, by `tarjan`."""
    sys.setrecursionlimit(max(sys.getrecursionlimit(), 4 * len(graph) + 1000))
    return tarjan(graph.graph["following"])


def prune(graph: nx.MultiDiGraph) -> nx.MultiDiGraph:
    """Keep one component, by `component_to_keep`: in it, every walk can continue."""
    played = []
    for start, end, kind in graph.edges(data="kind"):
        if kind == "clip":
            played.append((start, end, end[1] - start[1]))
    return graph.subgraph(component_to_keep(components(graph), played)).copy()


class Search(plain.Search):
    """A beam search for a walk along a line, by `look_ahead`, `lengthen` and `survivors`."""

    def __init__(self, clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> None:
        """Prepare a search; `line` holds points of the ground, 1 cm apart."""
        self.graph = graph
        self.line = line
        self.end = (len(line) - 1) / 100  # metres
        self.roots = [ground(clip.root_positions) for clip in clips]
        self.ahead = {(clip, frame): self.roots[clip][frame : frame + LOOK] for clip, frame in graph}
        self.numbers = {node: number for number, node in enumerate(graph)}
        self.roots_before = {(clip, frame): self.roots[clip][max(frame - 1, 0)] for clip, frame in graph}
        self.tracks = {edge: ground(to_motion(clips, graph, [edge])[0]) for edge in graph.edges(keys=True)}

    def point_at(self, along: Array) -> Ground:
        """Return the points of the line at arc lengths in metres, as complex numbers."""
        numbers = np.clip(100 * along, 0, len(self.line) - 1).astype(int)
        return np.asarray(self.line[numbers])

    def row_at(self, along: Array) -> Array:
        """Return the points of the line at arc lengths in metres, as rows (x, z)."""
        points = self.point_at(along)
        return np.stack([points.imag, points.real], axis=1)

    def look_ahead(self, walk: Walk) -> Walk:
        """Set the expected cost, by the exercise `look_ahead`."""
        ahead = np.append(self.roots_before[walk.node], self.ahead[walk.node])
        state = (walk.rotation, walk.translation, walk.along, walk.cost)
        return walk._replace(expected=look_ahead(state, ahead, self.point_at, RESCUE))

    def lengthen(self, walk: Walk, edge: Edge) -> Walk:
        """Extend a walk by one edge, by the exercise `lengthen`: its cost is that of Eq. 9."""
        data = self.graph.edges[edge]
        price = SEAM if data["kind"] == "transition" else 0.0
        track = np.append(self.roots_before[walk.node], self.tracks[edge])
        state = (walk.rotation, walk.translation, walk.along, walk.cost)
        edges = [(edge[1], track, *data["transform"], price)]
        ((node, rotation, translation, along, cost),) = lengthen(state, edges, self.row_at, LEAST_STEP)
        return self.look_ahead(Walk(cost, 0, along, node, rotation, translation, edge, walk))

    def best_of(self, walks: list[Walk]) -> list[Walk]:
        """Keep the best walks of a layer, by `survivors`."""
        cells = []
        for walk in walks:
            position = walk.rotation * self.ahead[walk.node][0] + walk.translation
            heading = np.angle(walk.rotation)
            cell = position.real / CELL, position.imag / CELL, heading / CELL_HEADING
            cells.append([self.numbers[walk.node], *map(round, cell)])
        scores = np.array([walk.cost + walk.expected for walk in walks])
        return [walks[number] for number in survivors(np.array(cells), scores, BEAM_WIDTH)]
