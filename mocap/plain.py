"""Motion graphs in one file, in reading order: build a graph from clips, and synthesise a walk along a line.

    python -m mocap.plain my-clips/ path.csv -o walk.bvh

Each function is a simple and slow version of a fast one elsewhere in the package. Tests check that the
results of both are equal. In the comments F is the number of frames, J of joints and n of points. A window is
K frames. A point on the ground is the complex number z + ix. A rotation about the vertical axis is then a
multiplication, and the rigid transform p ↦ rotation · p + translation aligns one clip with another. A node of
the graph is a pair (clip, frame), the frame to be played next. An edge of kind "clip" plays the frames
between two nodes of a clip. An edge of kind "transition" blends K frames of one clip into another.

Notebooks: 01-skeletons-and-clips to 08-path-synthesis.

The paper: [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002.
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Callable, Hashable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mocap.body.motion import Motion

FPS = 30  # frames per second
K = 10  # frames in a window: a third of a second
BELOW = 0.04  # metres: the windows of a transition have a smaller RMS distance

Array = NDArray[np.float64]
Ground = NDArray[np.complexfloating[Any, Any]]
Transform = tuple[complex, complex]  # rotation and translation
Node = tuple[int, int]  # clip and frame
Edge = tuple[Node, Node, int]
State = Any
Step = Callable[[State, Any], tuple[float, State]]
Transitions = list[tuple[int, int, int, int, float, Transform]]  # clip, frame, clip, frame, metres, transform


# 1. Bodies -------------------------------------------------------------------------------------------------


def rotate(q: Array, v: Array) -> Array:
    """Rotate vectors v (..., 3) by unit quaternions q = (w, u) (..., 4): v + 2w u × v + 2 u × (u × v)."""
    w = q[..., :1]
    u = q[..., 1:]
    across = 2 * np.cross(u, v)
    return np.asarray(v + w * across + np.cross(u, across))


def multiply(p: Array, q: Array) -> Array:
    """Multiply quaternions (..., 4): the rotation q, followed by the rotation p."""
    w = p[..., :1]
    u = p[..., 1:]
    s = q[..., :1]
    v = q[..., 1:]
    real = w * s - (u * v).sum(-1, keepdims=True)
    imaginary = w * v + s * u + np.cross(u, v)
    return np.concatenate([real, imaginary], -1)


def joint_positions(clip: Motion) -> Array:
    """Compute joint positions by forward kinematics: the parent's position plus the rotated offset."""
    positions = [clip.root_positions]  # (F, 3) for each joint
    rotations = [clip.rotations[:, 0]]  # (F, 4) for each joint
    for joint in range(1, len(clip.skeleton.parents)):
        parent = clip.skeleton.parents[joint]
        positions.append(positions[parent] + rotate(rotations[parent], clip.skeleton.offsets[joint]))
        rotations.append(multiply(rotations[parent], clip.rotations[:, joint]))
    return np.stack(positions, 1)  # (F, J, 3)


# 2. Which frames are similar? -------------------------------------------------------------------------------


def ground(points: Array) -> Ground:
    """Project points (..., 3) onto the ground: complex numbers z + ix, shape (...)."""
    return np.asarray(points[..., 2] + 1j * points[..., 0])


def windows(clip: Motion) -> Array:
    """Return the point clouds of all windows of a clip: in each, the joints of K frames."""
    points = joint_positions(clip)
    _, joints = np.unique(points[0].round(6), axis=0, return_index=True)  # one joint for each position
    joints = np.sort(joints)
    starts = range(len(points) - K + 1)
    return np.array([points[i : i + K, joints].reshape(-1, 3) for i in starts])  # (F - K + 1, n, 3)


def align(p: Array, q: Array) -> tuple[Ground, Ground]:
    """Find the transform that best aligns the points q (..., n, 3) with p [KGP02, Eqs. 2-4]."""
    g = ground(p)
    h = ground(q)
    g_mean = g.mean(-1)
    h_mean = h.mean(-1)
    rotation = (np.conj(h - h_mean[..., None]) * (g - g_mean[..., None])).sum(-1)
    rotation = np.exp(1j * np.angle(rotation))
    return rotation, g_mean - rotation * h_mean


def window_distance(p: Array, q: Array) -> Array:
    """Compute the RMS distance in metres between points p and q (..., n, 3), once aligned [KGP02, Eq. 1]."""
    rotation, translation = align(p, q)
    horizontal = ground(p) - rotation[..., None] * ground(q) - translation[..., None]
    vertical = p[..., 1] - q[..., 1]
    return np.asarray(np.sqrt(np.mean(abs(horizontal) ** 2 + vertical**2, -1)))


def distance_grid(a: Array, b: Array) -> Array:
    """Compute all distances between the windows of two clips, (N, n, 3) and (M, n, 3): shape (N, M)."""
    return np.array([window_distance(window, b) for window in a])


def local_minima(grid: Array, below: float) -> list[tuple[int, int]]:
    """Find the cells below a threshold that are not higher than any of their neighbours [KGP02, 3.2]."""
    padded = np.pad(grid, 1, constant_values=np.inf)
    minima = []
    for i, j in np.argwhere(grid < below).tolist():
        neighbours = padded[i : i + 3, j : j + 3]  # (i, j) is their centre
        if grid[i, j] == neighbours.min():
            minima.append((i, j))
    return minima


def inverse(rotation: complex, translation: complex) -> Transform:
    """Return the inverse of a planar rigid transform."""
    return 1 / rotation, -translation / rotation


def find_transitions(clips: Sequence[Motion]) -> Transitions:
    """List the frames at which a walk may pass from one clip into another, with the aligning transforms."""
    points = [windows(clip) for clip in clips]
    transitions: Transitions = []
    for a in range(len(clips)):
        for b in range(a, len(clips)):
            for i, j in local_minima(distance_grid(points[a], points[b]), BELOW):
                if a == b and j < i + K:
                    continue  # overlapping windows, or the reverse of a pair (j, i)
                cost = float(window_distance(points[a][i], points[b][j]))
                rotation, translation = map(complex, align(points[a][i], points[b][j]))
                transitions.append((a, i, b, j, cost, (rotation, translation)))
                transitions.append((b, j, a, i, cost, inverse(rotation, translation)))
    return sorted(transitions, key=lambda transition: transition[:4])


# 3. From one clip into another -----------------------------------------------------------------------------


def transform_clip(
    clip: Motion, frames: slice, rotation: complex, translation: complex
) -> tuple[Array, Array]:
    """Apply a transform to frames of a clip: roots (F, 3), rotations (F, J, 4)."""
    roots = clip.root_positions[frames].copy()
    rotations = clip.rotations[frames].copy()
    transformed = rotation * ground(roots) + translation
    roots[:, 2] = transformed.real
    roots[:, 0] = transformed.imag
    half = np.angle(rotation) / 2
    about_y = np.array([np.cos(half), 0, np.sin(half), 0])
    rotations[:, 0] = multiply(about_y, rotations[:, 0])
    return roots, rotations


def slerp(p: Array, q: Array, fraction: Array | float) -> Array:
    """Spherical linear interpolation (slerp) from p to q (..., 4), along the shorter arc [KGP02, Eq. 6]."""
    cosine = (p * q).sum(-1, keepdims=True)
    q = np.where(cosine < 0, -q, q)
    angle = np.arccos(np.minimum(abs(cosine), 1))
    is_tiny = angle < 1e-7
    sine = np.where(is_tiny, 1, np.sin(angle))
    part_of_p = np.sin((1 - fraction) * angle) * p
    part_of_q = np.sin(fraction * angle) * q
    return np.where(is_tiny, p, (part_of_p + part_of_q) / sine)


def cubic_weights() -> Array:
    """Return the weight of the first clip in each frame of a window, falling from 1 to 0 [KGP02, Eq. 7]."""
    t = np.arange(1, K + 1) / K
    return 2 * t**3 - 3 * t**2 + 1


def blend(first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
    """Blend two windows: roots by linear interpolation, rotations by slerp [KGP02, Eqs. 5-6]."""
    alpha = cubic_weights()[:, None]
    first_roots, first_rotations = first
    second_roots, second_rotations = second
    roots = alpha * first_roots + (1 - alpha) * second_roots
    return roots, slerp(second_rotations, first_rotations, alpha[..., None])


def join(a: Motion, i: int, b: Motion, j: int) -> tuple[Array, Array]:
    """Play a up to frame i, blend K frames of both, and continue with b, aligned with a [KGP02, 3.3]."""
    rotation, translation = map(complex, align(windows(a)[i], windows(b)[j]))
    start = transform_clip(a, slice(0, i), 1, 0)
    leaving = transform_clip(a, slice(i, i + K), 1, 0)
    entering = transform_clip(b, slice(j, j + K), rotation, translation)
    end = transform_clip(b, slice(j + K, None), rotation, translation)
    roots, rotations = zip(start, blend(leaving, entering), end, strict=True)
    return np.concatenate(roots), np.concatenate(rotations)


# 4. The graph ----------------------------------------------------------------------------------------------


def cut_and_join(clips: Sequence[Motion], transitions: Transitions) -> nx.MultiDiGraph:
    """Cut the clips where transitions leave and enter, and join the pieces into a graph [KGP02, 3]."""
    graph = nx.MultiDiGraph()
    for clip, motion in enumerate(clips):
        graph.add_nodes_from([(clip, 0), (clip, len(motion))])
    for a, i, b, j, cost, transform in transitions:
        graph.add_edge((a, i), (b, j + K), kind="transition", frames=K, cost=cost, transform=transform)
    for (clip, start), (next_clip, end) in pairwise(sorted(graph)):
        if clip == next_clip:
            frames = end - start
            graph.add_edge((clip, start), (clip, end), kind="clip", frames=frames, cost=0.0, transform=(1, 0))
    return graph


def components(graph: nx.MultiDiGraph) -> list[set[Node]]:
    """Find the strongly connected components: each node can be reached from every other [Tarjan 1972]."""
    number: dict[Node, int] = {}  # order of discovery
    low: dict[Node, int] = {}  # the smallest number known to be reachable from a node
    waiting: list[Node] = []  # discovered, and in no component yet
    complete: list[set[Node]] = []
    sys.setrecursionlimit(max(sys.getrecursionlimit(), 2 * len(graph) + 1000))

    def visit(node: Node) -> None:
        number[node] = low[node] = len(number)
        waiting.append(node)
        for successor in graph.successors(node):
            if successor not in number:
                visit(successor)
                low[node] = min(low[node], low[successor])
            elif successor in waiting:
                low[node] = min(low[node], number[successor])
        if low[node] == number[node]:  # no earlier node is reachable, therefore the component is complete
            first = waiting.index(node)
            complete.append(set(waiting[first:]))
            del waiting[first:]

    for node in graph:
        if node not in number:
            visit(node)
    return complete


def prune(graph: nx.MultiDiGraph) -> nx.MultiDiGraph:
    """Keep the component with the most frames of clips: in it, every walk can continue [KGP02, 3.4]."""

    def frames(nodes: set[Node]) -> int:
        inside = graph.subgraph(nodes).edges(data=True)
        return sum(edge["frames"] for _, _, edge in inside if edge["kind"] == "clip")

    return graph.subgraph(max(components(graph), key=frames)).copy()


# 5. Walks --------------------------------------------------------------------------------------------------


def random_walk(graph: nx.MultiDiGraph, seconds: float, seed: int) -> list[Edge]:
    """Draw a random walk: after at least a second of a clip a transition, with odds inverse to its cost."""
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))]
    walk: list[Edge] = []
    frames = 0
    frames_of_clip = 0  # since the last transition
    while frames < seconds * FPS and graph.out_degree(node):  # a walk ends at a dead end
        edges = list(graph.out_edges(node, keys=True))
        onward = [edge for edge in edges if graph.edges[edge]["kind"] == "clip"]
        leaving = [edge for edge in edges if graph.edges[edge]["kind"] == "transition"]
        may_leave = frames_of_clip >= FPS or not onward
        choices = leaving if leaving and may_leave else onward
        odds = np.array([1 / (graph.edges[edge]["cost"] + 0.001) for edge in choices])
        edge = choices[random.choice(len(choices), p=odds / odds.sum())]
        walk.append(edge)
        _, node, _ = edge
        played = graph.edges[edge]["frames"]
        frames += played
        if graph.edges[edge]["kind"] == "clip":
            frames_of_clip += played
        else:
            frames_of_clip = 0
    return walk


def compose(first: Transform, second: Transform) -> Transform:
    """Compose two transforms: p ↦ first(second(p))."""
    return first[0] * second[0], first[0] * second[1] + first[1]


def to_motion(
    clips: Sequence[Motion],
    graph: nx.MultiDiGraph,
    walk: Sequence[Edge],
    rotation: complex = 1,
    translation: complex = 0,
) -> tuple[Array, Array]:
    """Convert a walk to motion, composing the transforms of its transitions [KGP02, 4.1]."""
    pieces = []
    for start, end, key in walk:
        a, i = start
        b, j = end
        edge = graph.edges[start, end, key]
        piece = transform_clip(clips[a], slice(i, i + edge["frames"]), rotation, translation)
        rotation, translation = compose((rotation, translation), edge["transform"])
        if edge["kind"] == "transition":
            piece = blend(piece, transform_clip(clips[b], slice(j - K, j), rotation, translation))
        pieces.append(piece)
    roots, rotations = zip(*pieces, strict=True)
    return np.concatenate(roots), np.concatenate(rotations)


def branch_and_bound(
    graph: nx.MultiDiGraph, node: Hashable, state: State, step: Step, is_complete: Callable[[State], bool]
) -> tuple[float, list[Edge]] | None:
    """Find the complete walk of least cost from a node, depth first, low costs first [KGP02, Eq. 8, 4.2].

    step(state, edge) returns the cost of an edge, 0 or more, and the next state. is_complete(state) returns
    whether a walk is complete. Costs never decrease, therefore a branch that costs as much as the best
    complete walk is pruned.
    """
    best: tuple[float, list[Edge]] | None = None
    branches: list[Any] = [(0.0, node, state, [])]
    while branches:
        cost, node, state, walk = branches.pop()
        if best and cost >= best[0]:
            continue
        if is_complete(state):
            best = cost, walk
            continue
        longer = []
        for edge in graph.out_edges(node, keys=True):
            price, next_state = step(state, edge)
            longer.append((cost + price, edge[1], next_state, [*walk, edge]))
        branches += sorted(longer, key=lambda branch: branch[0], reverse=True)  # the lowest cost comes last
    return best


# 6. A walk along a line ------------------------------------------------------------------------------------

BEAM_WIDTH = 150  # walks kept in each layer
LAYER = 0.15  # metres of the line in a layer
LOOK = 22  # frames: the horizon of the expected cost
RESCUE = 1.5  # m²: upper limit of the expected cost, because a transition may leave the clip before
SEAM = 0.15  # m²: the price of a transition
# Walks at the same node, in the same cell of the ground and with similar headings are duplicates: only the
# one of least cost is kept.
CELL = 0.1  # metres
CELL_HEADING = 0.1  # radians


class Walk(NamedTuple):
    """A partial walk: its cost, the expected cost ahead, its length along the line in metres, and its end.

    The end is a node, with the transform of the clip that is played from there.
    """

    cost: float
    expected: float
    along: float
    node: Node
    rotation: complex
    translation: complex
    edge: Edge | None = None
    previous: Walk | None = None  # without its last edge


def align_start(track: Ground, line: Ground) -> Transform:
    """Align the start of a track with the start of a line, in position and direction."""
    line_direction = line[-1] - line[0]
    track_direction = track[-1] - track[0]
    rotation = np.exp(1j * np.angle(line_direction / track_direction))
    return rotation, line[0] - rotation * track[0]


class Search:
    """A beam search for a walk along a line: each layer of the line keeps the best walks [KGP02, 5.1]."""

    def __init__(self, clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> None:
        """Prepare a search; `line` holds points of the ground, 1 cm apart."""
        self.graph = graph
        self.line = line
        self.end = (len(line) - 1) / 100  # metres
        self.roots = [ground(clip.root_positions) for clip in clips]
        self.tracks = {edge: ground(to_motion(clips, graph, [edge])[0]) for edge in graph.edges(keys=True)}
        self.ahead = {(clip, frame): self.roots[clip][frame : frame + LOOK] for clip, frame in graph}

    def price(self, walk: Walk, track: Ground) -> tuple[float, float]:
        """Return the cost of a track, and its end along the line in metres.

        Each point is compared with the point of the line at the same arc length [KGP02, Eq. 9].
        """
        clip, frame = walk.node
        start = self.roots[clip][max(frame - 1, 0)]
        along = walk.along + np.cumsum(abs(np.diff(track, prepend=start)))
        wanted = self.line[np.clip(100 * along, 0, len(self.line) - 1).astype(int)]
        errors = abs(walk.rotation * track + walk.translation - wanted) ** 2  # m² in each frame
        # The second term is not in Eq. 9: it doubles the cost of a frame that is 10 cm off the line.
        return float((errors + 100 * errors**2).sum()), float(along[-1])

    def look_ahead(self, walk: Walk) -> Walk:
        """Set the expected cost: that of the frames ahead if the walk stays in its clip, at most `RESCUE`."""
        return walk._replace(expected=min(self.price(walk, self.ahead[walk.node])[0], RESCUE))

    def lengthen(self, walk: Walk, edge: Edge) -> Walk:
        """Extend a walk by one edge."""
        cost, along = self.price(walk, self.tracks[edge])
        if self.graph.edges[edge]["kind"] == "transition":
            cost += SEAM
        transform = self.graph.edges[edge]["transform"]
        rotation, translation = compose((walk.rotation, walk.translation), transform)
        return self.look_ahead(Walk(walk.cost + cost, 0, along, edge[1], rotation, translation, edge, walk))

    def lengthened(self, walks: list[Walk]) -> Iterator[Walk]:
        """Yield all extensions of the walks by one edge."""
        for walk in walks:
            for edge in self.graph.out_edges(walk.node, keys=True):
                yield self.lengthen(walk, edge)

    def starts(self) -> list[Walk]:
        """Return an empty walk at each node from which the body moves, aligned with the start of the line."""
        walks = []
        for node, track in self.ahead.items():
            if len(track) == LOOK and abs(track[-1] - track[0]) > 0.3:
                walks.append(self.look_ahead(Walk(0, 0, 0, node, *align_start(track, self.line[:31]))))
        return walks

    def best_of(self, walks: list[Walk]) -> list[Walk]:
        """Keep the best walk of each cell, and of these the `BEAM_WIDTH` best, by cost plus expected cost."""
        kept: dict[Hashable, Walk] = {}
        for walk in sorted(walks, key=lambda walk: walk.cost + walk.expected):
            position = walk.rotation * self.ahead[walk.node][0] + walk.translation
            heading = np.angle(walk.rotation)
            cell = (walk.node, position.real // CELL, position.imag // CELL, heading // CELL_HEADING)
            kept.setdefault(cell, walk)
        return list(kept.values())[:BEAM_WIDTH]

    def layers(self) -> Iterator[tuple[list[Walk], Walk | None]]:
        """Run the search: for each layer, yield the kept walks and the best complete walk so far."""
        waiting: dict[int, list[Walk]] = {0: self.starts()}
        best: Walk | None = None
        while waiting:
            layer = min(waiting)
            kept = self.best_of(waiting.pop(layer))
            for walk in self.lengthened(kept):
                if best and walk.cost >= best.cost:
                    continue
                if walk.along >= self.end:
                    best = walk
                else:
                    waiting.setdefault(max(int(walk.along / LAYER), layer), []).append(walk)
            yield kept, best

    def walk(self) -> tuple[list[Edge], complex, complex]:
        """Return the edges of the best walk, and the transform of its first clip."""
        *_, (_, walk) = self.layers()
        if walk is None:
            raise ValueError("No walk reaches the end of the line.")
        edges = []
        while walk.previous and walk.edge:
            edges.append(walk.edge)
            walk = walk.previous
        return edges[::-1], walk.rotation, walk.translation


def follow(clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> tuple[Array, Array]:
    """Synthesise a walk along a line: return the roots (F, 3) and rotations (F, J, 4) of the best walk."""
    return to_motion(clips, graph, *Search(clips, graph, line).walk())


def points_along(corners: Array) -> Ground:
    """Sample a polyline every 1 cm, given its corners (x, z), shape (N, 2)."""
    corner = corners[:, 1] + 1j * corners[:, 0]
    along = np.cumsum(abs(np.diff(corner, prepend=corner[0])))
    return np.asarray(np.interp(np.arange(0, along[-1], 0.01), along, corner))


def main(arguments: Sequence[str] | None = None) -> int:
    """Read clips and a line, and write a walk along it."""
    from mocap import MocapError, Motion, load, resample, save  # reads and checks files
    from mocap.body.concatenation import require_compatible
    from mocap.files.conversion import find_files
    from mocap.files.path_files import load_path

    parser = argparse.ArgumentParser(prog="python -m mocap.plain", description=main.__doc__)
    parser.add_argument("clips", nargs="+", type=Path, help="motion files, or folders of them")
    parser.add_argument("path", type=Path, help="where to walk: .csv with points x, z in metres, or .svg")
    parser.add_argument("-o", "--out", type=Path, default=Path("walk.bvh"), help="the file to write")
    options = parser.parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a pipe of Windows may not encode every letter of a name
    try:
        line = points_along(load_path(options.path).points)
        loaded = [load(path) for path in find_files(options.clips)]
        long = [clip for clip in (resample(clip, FPS) for clip in loaded) if len(clip) > K]
        if not long:
            raise MocapError(f"A window takes {K} frames, and no clip is longer.")
        clips = require_compatible(long)
        graph = prune(cut_and_join(clips, find_transitions(clips)))
        print(f"{len(clips)} clips make a graph of {len(graph)} nodes and {graph.size()} edges.")
        roots, rotations = follow(clips, graph, line)
        errors = [abs(line - point).min() for point in ground(roots)]
        save(Motion(clips[0].skeleton, roots, rotations, FPS, "walk"), options.out)
    except (MocapError, ValueError) as error:
        print(f"mocap.plain: {error}", file=sys.stderr)
        return 2
    print(f"{options.out}: {len(roots) / FPS:.1f} s, {100 * np.mean(errors):.1f} cm off the line on average.")
    return 0


def __getattr__(name: str) -> Any:  # noqa: ANN401 (Python asks it for names that this file lacks)
    from mocap._shared import renamed  # which names functions that had other names

    raise renamed.missing(__name__, name)


if __name__ == "__main__":
    sys.exit(main())
