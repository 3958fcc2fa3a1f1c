"""Motion graphs on a few pages: clips in, a walk along a line out. Slow, right, and in reading order.

    python -m mocap.plain my-clips/ path.csv -o walk.bvh

Each function is the plain form of a quick one in the rooms of the package, and a test holds the two equal. In
the comments F counts frames, J joints and n points; a window is K frames. A point of the ground is the
complex number z + ix, so that turning about the vertical is a product, and p ↦ turn · p + move lays one clip
on another. A node of the graph is (clip, frame): "this frame comes next". An edge of kind "clip" plays the
frames between two nodes; one of kind "transition" blends K frames, from one clip into another.

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
BELOW = 0.04  # metres: windows that are more apart than this make no transition

Array = NDArray[np.float64]
Ground = NDArray[np.complexfloating[Any, Any]]
Lay = tuple[complex, complex]  # turn and move
Node = tuple[int, int]  # clip and frame
Edge = tuple[Node, Node, int]
State = Any
Step = Callable[[State, Any], tuple[float, State]]
Found = list[tuple[int, int, int, int, float, Lay]]  # clip, frame, clip, frame, metres, how to lay


# 1. Bodies -------------------------------------------------------------------------------------------------


def rotate(q: Array, v: Array) -> Array:
    """Turn vectors v (..., 3) by unit quaternions q = (w, u) (..., 4): v + 2w (u × v) + 2 u × (u × v)."""
    w, u = q[..., :1], q[..., 1:]
    across = 2 * np.cross(u, v)
    return np.asarray(v + w * across + np.cross(u, across))


def multiply(p: Array, q: Array) -> Array:
    """Multiply quaternions (..., 4): the turn that does q first, then p."""
    w, u = p[..., :1], p[..., 1:]
    s, v = q[..., :1], q[..., 1:]
    real = w * s - (u * v).sum(-1, keepdims=True)
    imaginary = w * v + s * u + np.cross(u, v)
    return np.concatenate([real, imaginary], -1)


def joint_positions(clip: Motion) -> Array:
    """Go down the tree: a joint stands at its parent's place plus its offset, turned as the parent is."""
    places = [clip.root_positions]  # (F, 3) for each joint
    turns = [clip.rotations[:, 0]]  # (F, 4) for each joint
    for joint in range(1, len(clip.skeleton.parents)):
        parent = clip.skeleton.parents[joint]
        places.append(places[parent] + rotate(turns[parent], clip.skeleton.offsets[joint]))
        turns.append(multiply(turns[parent], clip.rotations[:, joint]))
    return np.stack(places, 1)  # (F, J, 3)


# 2. Which moments are alike? -------------------------------------------------------------------------------


def ground(points: Array) -> Ground:
    """Look at points (..., 3) from above: complex numbers z + ix, shape (...)."""
    return np.asarray(points[..., 2] + 1j * points[..., 0])


def windows(clip: Motion) -> Array:
    """Give the points of all windows of a clip: K frames of joints in each."""
    points = joint_positions(clip)
    _, joints = np.unique(points[0].round(6), axis=0, return_index=True)  # one of those at the same place
    joints = np.sort(joints)
    starts = range(len(points) - K + 1)
    return np.array([points[i : i + K, joints].reshape(-1, 3) for i in starts])  # (F - K + 1, n, 3)


def align(p: Array, q: Array) -> tuple[Ground, Ground]:
    """Find the turn and the move that lay the points q (..., n, 3) on p best [KGP02, Eqs. 2-4]."""
    g = ground(p)
    h = ground(q)
    g_mean = g.mean(-1)
    h_mean = h.mean(-1)
    turn = (np.conj(h - h_mean[..., None]) * (g - g_mean[..., None])).sum(-1)
    turn = np.exp(1j * np.angle(turn))
    return turn, g_mean - turn * h_mean


def window_distance(p: Array, q: Array) -> Array:
    """Lay the points q (..., n, 3) on p, and measure how far apart they are: RMS, metres [KGP02, Eq. 1]."""
    turn, move = align(p, q)
    aside = ground(p) - turn[..., None] * ground(q) - move[..., None]
    above = p[..., 1] - q[..., 1]
    return np.asarray(np.sqrt(np.mean(abs(aside) ** 2 + above**2, -1)))


def distance_grid(a: Array, b: Array) -> Array:
    """Compare each window of one clip (N, n, 3) with all windows of another (M, n, 3): shape (N, M)."""
    return np.array([window_distance(window, b) for window in a])


def local_minima(grid: Array, below: float) -> list[tuple[int, int]]:
    """Find the cells below a threshold that are as low as all their eight neighbours [KGP02, 3.2]."""
    padded = np.pad(grid, 1, constant_values=np.inf)
    minima = []
    for i, j in np.argwhere(grid < below).tolist():
        neighbours = padded[i : i + 3, j : j + 3]  # (i, j) is their centre
        if grid[i, j] == neighbours.min():
            minima.append((i, j))
    return minima


def undo(turn: complex, move: complex) -> Lay:
    """Give the turn and the move that lay back what these lay."""
    return 1 / turn, -move / turn


def find_transitions(clips: Sequence[Motion]) -> Found:
    """List where a walk may leave a clip and enter one, and how the second clip is laid on the first."""
    points = [windows(clip) for clip in clips]
    transitions: Found = []
    for a in range(len(clips)):
        for b in range(a, len(clips)):
            for i, j in local_minima(distance_grid(points[a], points[b]), BELOW):
                if a == b and j < i + K:
                    continue  # a window is like itself; and what lies below the diagonal is the way back
                cost = float(window_distance(points[a][i], points[b][j]))
                turn, move = map(complex, align(points[a][i], points[b][j]))
                transitions.append((a, i, b, j, cost, (turn, move)))
                transitions.append((b, j, a, i, cost, undo(turn, move)))
    return sorted(transitions, key=lambda transition: transition[:4])


# 3. From one clip into another -----------------------------------------------------------------------------


def lay(clip: Motion, frames: slice, turn: complex, move: complex) -> tuple[Array, Array]:
    """Take frames of a clip, laid elsewhere on the ground: roots (F, 3), rotations (F, J, 4)."""
    roots = clip.root_positions[frames].copy()
    turns = clip.rotations[frames].copy()
    laid = turn * ground(roots) + move
    roots[:, 2], roots[:, 0] = laid.real, laid.imag
    half = np.angle(turn) / 2
    about_y = np.array([np.cos(half), 0, np.sin(half), 0])
    turns[:, 0] = multiply(about_y, turns[:, 0])
    return roots, turns


def slerp(p: Array, q: Array, share: Array | float) -> Array:
    """Go a share of the way from p to q (..., 4), the short way round, at constant speed [KGP02, Eq. 6]."""
    cosine = (p * q).sum(-1, keepdims=True)
    q = np.where(cosine < 0, -q, q)
    angle = np.arccos(np.minimum(abs(cosine), 1))
    is_tiny = angle < 1e-7
    sine = np.where(is_tiny, 1, np.sin(angle))
    part_of_p = np.sin((1 - share) * angle) * p
    part_of_q = np.sin(share * angle) * q
    return np.where(is_tiny, p, (part_of_p + part_of_q) / sine)


def cubic_weights() -> Array:
    """Give the first clip's weight in each frame of a window: from nearly 1 to 0, smoothly [KGP02, Eq. 7]."""
    t = np.arange(1, K + 1) / K
    return 2 * t**3 - 3 * t**2 + 1


def blend(first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
    """Mix two windows: roots on straight lines, turns by slerp [KGP02, Eqs. 5-6]."""
    alpha = cubic_weights()[:, None]
    first_roots, first_turns = first
    second_roots, second_turns = second
    roots = alpha * first_roots + (1 - alpha) * second_roots
    return roots, slerp(second_turns, first_turns, alpha[..., None])


def join(a: Motion, i: int, b: Motion, j: int) -> tuple[Array, Array]:
    """Play a up to frame i, blend K frames of both, and play on with b, laid on a [KGP02, 3.3]."""
    turn, move = map(complex, align(windows(a)[i], windows(b)[j]))
    start = lay(a, slice(0, i), 1, 0)
    leaving = lay(a, slice(i, i + K), 1, 0)
    entering = lay(b, slice(j, j + K), turn, move)
    end = lay(b, slice(j + K, None), turn, move)
    roots, turns = zip(start, blend(leaving, entering), end, strict=True)
    return np.concatenate(roots), np.concatenate(turns)


# 4. The graph ----------------------------------------------------------------------------------------------


def cut_and_join(clips: Sequence[Motion], transitions: Found) -> nx.MultiDiGraph:
    """Cut the clips where transitions leave and enter, and join the pieces to a graph [KGP02, 3]."""
    graph = nx.MultiDiGraph()
    for clip, motion in enumerate(clips):
        graph.add_nodes_from([(clip, 0), (clip, len(motion))])
    for a, i, b, j, cost, laid in transitions:
        graph.add_edge((a, i), (b, j + K), kind="transition", frames=K, cost=cost, lay=laid)
    for (clip, start), (next_clip, end) in pairwise(sorted(graph)):
        if clip == next_clip:
            graph.add_edge((clip, start), (clip, end), kind="clip", frames=end - start, cost=0.0, lay=(1, 0))
    return graph


def components(graph: nx.MultiDiGraph) -> list[set[Node]]:
    """Find the sets in which each node can be reached from each other one [Tarjan 1972]."""
    number: dict[Node, int] = {}  # the order in which nodes are met
    low: dict[Node, int] = {}  # the smallest number that a node leads back to
    waiting: list[Node] = []  # met, and in no component yet
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
        if low[node] == number[node]:  # nothing in it leads further back: a component is complete
            first = waiting.index(node)
            complete.append(set(waiting[first:]))
            del waiting[first:]

    for node in graph:
        if node not in number:
            visit(node)
    return complete


def prune(graph: nx.MultiDiGraph) -> nx.MultiDiGraph:
    """Keep the component that plays most frames of clip: in it a walk can go on for ever [KGP02, 3.4]."""

    def frames(nodes: set[Node]) -> int:
        inside = graph.subgraph(nodes).edges(data=True)
        return sum(edge["frames"] for _, _, edge in inside if edge["kind"] == "clip")

    return graph.subgraph(max(components(graph), key=frames)).copy()


# 5. Walks --------------------------------------------------------------------------------------------------


def random_walk(graph: nx.MultiDiGraph, seconds: float, seed: int) -> list[Edge]:
    """Walk at random: a second or more of clip, then a transition; cheap ones are likelier than dear ones."""
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))]
    walk: list[Edge] = []
    frames = 0
    frames_of_clip = 0  # since the last transition
    while frames < seconds * FPS and graph.out_degree(node):  # at a dead end the walk is over
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


def product(first: Lay, then: Lay) -> Lay:
    """Give the turn and the move of p ↦ first(then(p))."""
    return first[0] * then[0], first[0] * then[1] + first[1]


def to_motion(
    clips: Sequence[Motion],
    graph: nx.MultiDiGraph,
    walk: Sequence[Edge],
    turn: complex = 1,
    move: complex = 0,
) -> tuple[Array, Array]:
    """Play a walk: each clip is laid by the product of all transitions before it [KGP02, 4.1]."""
    pieces = []
    for start, end, key in walk:
        a, i = start
        b, j = end
        edge = graph.edges[start, end, key]
        piece = lay(clips[a], slice(i, i + edge["frames"]), turn, move)
        turn, move = product((turn, move), edge["lay"])
        if edge["kind"] == "transition":
            piece = blend(piece, lay(clips[b], slice(j - K, j), turn, move))
        pieces.append(piece)
    roots, turns = zip(*pieces, strict=True)
    return np.concatenate(roots), np.concatenate(turns)


def branch_and_bound(
    graph: nx.MultiDiGraph, node: Hashable, state: State, step: Step, is_complete: Callable[[State], bool]
) -> tuple[float, list[Edge]] | None:
    """Find the cheapest walk from a node on: depth first, cheap edges first [KGP02, Eq. 8, 4.2].

    step(state, edge) gives what an edge costs, 0 or more, and the next state; is_complete(state) says when a
    walk is complete. A walk that costs as much as the best complete one cannot become better: it is cut.
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
        branches += sorted(longer, key=lambda branch: branch[0], reverse=True)  # the cheapest is popped first
    return best


# 6. A walk along a line ------------------------------------------------------------------------------------

WIDTH = 150  # walks that go on from each layer of the line
LAYER = 0.15  # metres of the line in a layer
LOOK = 22  # frames that each walk looks ahead
RESCUE = 1.5  # m²: what lies ahead costs no more than this, since a transition can leave it
SEAM = 0.15  # m²: the price of a transition
CELL = 0.1  # metres: of two walks at one node and in one cell of the ground, the cheaper one goes on
CELL_TURN = 0.1  # radians: if their headings are in one interval as well


class Walk(NamedTuple):
    """A walk of the search: what it costs, how far it has come (metres), and how its next clip is laid."""

    cost: float
    expected: float
    along: float
    node: Node
    turn: complex
    move: complex
    edge: Edge | None = None
    previous: Walk | None = None  # the walk without its last edge


def lay_on(track: Ground, line: Ground) -> Lay:
    """Lay the start of a track on the start of a line, so that both lead the same way."""
    line_direction = line[-1] - line[0]
    track_direction = track[-1] - track[0]
    turn = np.exp(1j * np.angle(line_direction / track_direction))
    return turn, line[0] - turn * track[0]


class Search:
    """All walks advance along a line together, layer by layer; the best of each layer go on [KGP02, 5.1]."""

    def __init__(self, clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> None:
        """Prepare a search; `line` holds points of the ground, 1 cm apart."""
        self.graph = graph
        self.line = line
        self.end = (len(line) - 1) / 100  # metres
        self.roots = [ground(clip.root_positions) for clip in clips]
        self.tracks = {edge: ground(to_motion(clips, graph, [edge])[0]) for edge in graph.edges(keys=True)}
        self.ahead = {(clip, frame): self.roots[clip][frame : frame + LOOK] for clip, frame in graph}

    def price(self, walk: Walk, track: Ground) -> tuple[float, float]:
        """Give what a track costs [KGP02, Eq. 9], and how far it comes: root and line, at equal lengths."""
        clip, frame = walk.node
        start = self.roots[clip][max(frame - 1, 0)]
        along = walk.along + np.cumsum(abs(np.diff(track, prepend=start)))
        wanted = self.line[np.clip(100 * along, 0, len(self.line) - 1).astype(int)]
        errors = abs(walk.turn * track + walk.move - wanted) ** 2  # m² in each frame
        return float((errors + 100 * errors**2).sum()), float(along[-1])  # 10 cm cost twice what Eq. 9 says

    def look_ahead(self, walk: Walk) -> Walk:
        """Expect what the walk will cost if its clip plays on."""
        return walk._replace(expected=min(self.price(walk, self.ahead[walk.node])[0], RESCUE))

    def lengthen(self, walk: Walk, edge: Edge) -> Walk:
        """Let a walk take one more edge."""
        cost, along = self.price(walk, self.tracks[edge])
        if self.graph.edges[edge]["kind"] == "transition":
            cost += SEAM
        turn, move = product((walk.turn, walk.move), self.graph.edges[edge]["lay"])
        return self.look_ahead(Walk(walk.cost + cost, 0, along, edge[1], turn, move, edge, walk))

    def lengthened(self, walks: list[Walk]) -> Iterator[Walk]:
        """Yield each walk with one more edge, for each edge of its node."""
        for walk in walks:
            for edge in self.graph.out_edges(walk.node, keys=True):
                yield self.lengthen(walk, edge)

    def starts(self) -> list[Walk]:
        """Start at each node from which the root goes somewhere: at the line's start, and along it."""
        walks = []
        for node, track in self.ahead.items():
            if len(track) == LOOK and abs(track[-1] - track[0]) > 0.3:
                walks.append(self.look_ahead(Walk(0, 0, 0, node, *lay_on(track, self.line[:31]))))
        return walks

    def best_of(self, walks: list[Walk]) -> list[Walk]:
        """Cross out what stands where another one stands and costs more; keep the best of the others."""
        kept: dict[Hashable, Walk] = {}
        for walk in sorted(walks, key=lambda walk: walk.cost + walk.expected):
            place = walk.turn * self.ahead[walk.node][0] + walk.move
            heading = np.angle(walk.turn)
            cell = (walk.node, place.real // CELL, place.imag // CELL, heading // CELL_TURN)
            kept.setdefault(cell, walk)
        return list(kept.values())[:WIDTH]

    def layers(self) -> Iterator[tuple[list[Walk], Walk | None]]:
        """Search: in each layer yield the walks that go on, and the best one at the line's end so far."""
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
        """Give the edges of the best walk, and how the first one's clip is laid."""
        *_, (_, walk) = self.layers()
        if walk is None:
            raise ValueError("No walk comes to the end of the line.")
        edges = []
        while walk.previous and walk.edge:
            edges.append(walk.edge)
            walk = walk.previous
        return edges[::-1], walk.turn, walk.move


def follow(clips: Sequence[Motion], graph: nx.MultiDiGraph, line: Ground) -> tuple[Array, Array]:
    """Walk along a line: the frames of the best walk, roots (F, 3) and rotations (F, J, 4)."""
    return to_motion(clips, graph, *Search(clips, graph, line).walk())


def points_along(corners: Array) -> Ground:
    """Lay points on a line, 1 cm apart, from its corners (x, z), shape (N, 2)."""
    corner = corners[:, 1] + 1j * corners[:, 0]
    along = np.cumsum(abs(np.diff(corner, prepend=corner[0])))
    return np.asarray(np.interp(np.arange(0, along[-1], 0.01), along, corner))


def main(arguments: Sequence[str] | None = None) -> int:
    """Read clips and a line, and write a walk along it."""
    from mocap import MocapError, Motion, load, resample, save  # files and their checks are the package's
    from mocap.body.motion import require_alike
    from mocap.files.conversion import find_files
    from mocap.files.path_files import load_path

    parser = argparse.ArgumentParser(prog="python -m mocap.plain", description=main.__doc__)
    parser.add_argument("clips", nargs="+", type=Path, help="motion files, or folders of them")
    parser.add_argument("path", type=Path, help="where to walk: .csv with points x, z in metres, or .svg")
    parser.add_argument("-o", "--out", type=Path, default=Path("walk.bvh"), help="the file to write")
    options = parser.parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a name may hold letters that a pipe of Windows lacks
    try:
        line = points_along(load_path(options.path).points)
        loaded = [load(path) for path in find_files(options.clips)]
        long = [clip for clip in (resample(clip, FPS) for clip in loaded) if len(clip) > K]
        if not long:
            raise MocapError(f"A window takes {K} frames, and no clip is longer.")
        clips = require_alike(long)
        graph = prune(cut_and_join(clips, find_transitions(clips)))
        print(f"{len(clips)} clips make a graph of {len(graph)} nodes and {graph.size()} edges.")
        roots, turns = follow(clips, graph, line)
        errors = [abs(line - point).min() for point in ground(roots)]
        save(Motion(clips[0].skeleton, roots, turns, FPS, "walk"), options.out)
    except (MocapError, ValueError) as error:
        print(f"mocap.plain: {error}", file=sys.stderr)
        return 2
    print(f"{options.out}: {len(roots) / FPS:.1f} s, {100 * np.mean(errors):.1f} cm off the line on average.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
