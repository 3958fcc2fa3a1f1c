"""Out of the graph: random walks, and the motions that walks stand for."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap import rotations
from mocap.errors import MocapError, NoWalk
from mocap.footskate import clean_up
from mocap.motion import Motion
from mocap.motion_graph import MotionGraph, Node
from mocap.plants import mark_plants
from mocap.transforms import IDENTITY, PlanarTransform
from mocap.walks import Edge, EdgeTable, FrameTable, edge_table, frame_table, require_node, require_walk

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


class Seam(NamedTuple):
    """A transition on a walk: the `frame` of the motion at which it starts, and its `cost` in metres."""

    frame: int
    cost: float


def random_walk(
    motion_graph: MotionGraph,
    *,
    seconds: float,
    seed: int = 0,
    settle: float = 1.0,
    start: Node | None = None,
) -> list[Edge]:
    """Wander through a graph for a while.

    Where the last transition is `settle` seconds past, the walk takes one of the transitions at hand, the
    likelier the less it costs; else it goes on along the clip. Where the clip does not go on, it must leave.

    Parameters
    ----------
    motion_graph : the graph, pruned, so that a walk never ends.
    seconds : how long the motion shall be at least.
    seed : the same seed gives the same walk.
    settle : seconds of clip between two transitions, where the graph allows.
    start : the first node; by default one drawn at random.

    Returns
    -------
    Edges, as many as needed.

    Raises
    ------
    NoWalk : for a start that the graph lacks, and where the walk runs into a dead end.

    Notebook: 07-walks-and-search
    """
    if not (np.isfinite(seconds) and seconds > 0):
        raise MocapError(f"A walk must last longer than 0 s, got {seconds} s.")
    walk: list[Edge] = []
    frames = 0
    for edge in wander(motion_graph, seed=seed, settle=settle, start=start):
        walk.append(edge)
        frames += motion_graph.graph.edges[edge]["frames"]
        if frames >= seconds * motion_graph.clips[0].fps:
            break
    return walk


def wander(
    motion_graph: MotionGraph, *, seed: int = 0, settle: float = 1.0, start: Node | None = None
) -> Iterator[Edge]:
    """Give the edges of a random walk one by one, for ever; see `random_walk`.

    Notebook: 07-walks-and-search
    """
    graph, fps = motion_graph.graph, motion_graph.clips[0].fps
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))] if start is None else start
    require_node(motion_graph, node)
    frames, since = 0, 0
    while True:
        edges = list(graph.out_edges(node, keys=True, data=True))
        onward = [edge for edge in edges if edge[3]["kind"] == "clip"]
        leaving = [edge for edge in edges if edge[3]["kind"] == "transition"]
        choices = leaving if leaving and (since >= settle * fps or not onward) else onward
        if not choices:
            raise NoWalk(f"The walk ends at node {node} after {frames / fps:.1f} s: prune the graph first.")
        odds = np.array([1 / (edge[3].get("cost", 0.0) + 1e-3) for edge in choices])
        start_, node, key, data = choices[random.choice(len(choices), p=odds / odds.sum())]
        yield start_, node, key
        frames += data["frames"]
        since = since + data["frames"] if data["kind"] == "clip" else 0


def to_motion(
    motion_graph: MotionGraph,
    walk: Sequence[Edge],
    *,
    name: str = "walk",
    place: PlanarTransform = IDENTITY,
    clean: bool = False,
) -> Motion:
    """Play a walk: stretches of clip as they are, transitions blended, each placed where the last one led.

    Every frame is moved by the product of the transforms of the transitions passed so far [KGP02, 4.1]. All
    frames are gathered, placed and blended at once, so the time is linear in the walk's length. A walk that
    passes no transition repeats its clip bit for bit.

    Parameters
    ----------
    motion_graph : the graph.
    walk : edges, each starting where the one before ends.
    name : the new motion's name.
    place : moves the whole motion; by default it starts where its first clip is.
    clean : whether to make planted feet stand still, by `footskate.clean_up`; where no clip tells when its
        feet stand, that is found out first.

    Returns
    -------
    As many frames as the edges have together; labels and contacts are those of the clips, in a transition
    those of the clip with the larger weight.

    Raises
    ------
    NoWalk : for an empty walk, an edge that the graph lacks, or one that starts elsewhere.

    Notebook: 07-walks-and-search
    """
    require_walk(motion_graph, walk)
    if clean:
        motion_graph = with_plants(motion_graph)
    edges = edge_table(motion_graph, walk)
    table = frame_table(edges, motion_graph.window)
    before = places(edges, place)
    roots, turns = _placed(motion_graph, table.here, before, table.edge)
    mixed = edges.blended[table.edge]
    # The clip that a transition enters stays, from its blend on, where the transition put it.
    there, turned = _placed(motion_graph, table.there[mixed], before, table.edge[mixed] + 1)
    alpha = table.alpha[mixed, None]
    roots[mixed] = alpha * roots[mixed] + (1 - alpha) * there
    turns[mixed] = rotations.slerp(turned, turns[mixed], alpha)
    labels, contacts = (_marks(motion_graph, table, kind) for kind in ("labels", "contacts"))
    clip = motion_graph.clips[0]
    motion = Motion(clip.skeleton, roots, turns, clip.fps, name, labels, contacts)
    return clean_up(motion) if clean else motion


def with_plants(motion_graph: MotionGraph) -> MotionGraph:
    """Find out when feet stand, where no clip tells."""
    if any(clip.contacts for clip in motion_graph.clips):
        return motion_graph
    return replace(motion_graph, clips=tuple(map(mark_plants, motion_graph.clips)))


def places(edges: EdgeTable, place: PlanarTransform = IDENTITY) -> PlanarTransform:
    """Multiply up the transforms along a walk of n edges: n + 1 places, the last where it ends.

    Angles add up, and so do the steps t_i, each turned by the angles before it: with a ground point as the
    complex number z + ix, a turn by θ is a product with exp(iθ), and both are running sums.

    Notebook: 07-walks-and-search
    """
    angle = np.cumsum(np.concatenate([[place.angle], np.asarray(edges.transform.angle)]))
    steps = (edges.transform.z + 1j * np.asarray(edges.transform.x)) * np.exp(1j * angle[:-1])
    moved = np.cumsum([place.z + 1j * place.x, *steps])
    return PlanarTransform(angle, moved.imag, moved.real)


def _placed(
    motion_graph: MotionGraph, frames: Indices, places: PlanarTransform, chosen: Indices
) -> tuple[Array, Array]:
    """Gather frames (F, 2) and move each by one of the places: root positions and rotations."""
    joints = len(motion_graph.clips[0].skeleton)
    roots, turns = np.empty((len(frames), 3)), np.empty((len(frames), joints, 4))
    for clip in np.unique(frames[:, 0]):
        of_clip = frames[:, 0] == clip
        roots[of_clip] = motion_graph.clips[clip].root_positions[frames[of_clip, 1]]
        turns[of_clip] = motion_graph.clips[clip].rotations[frames[of_clip, 1]]
    place = PlanarTransform(*(np.asarray(numbers)[chosen] for numbers in places))
    turned = place.angle != 0  # what is not turned keeps its last digits
    turns[turned, 0] = rotations.multiply(rotations.about_y(place.angle)[turned], turns[turned, 0])
    return place.points(roots), turns


def _marks(motion_graph: MotionGraph, table: FrameTable, kind: str) -> dict[str, NDArray[np.bool_]]:
    """Carry the labels or contacts over, of the frame with the larger weight."""
    owner = np.where(table.alpha[:, None] >= 0.5, table.here, table.there)
    marks: dict[str, NDArray[np.bool_]] = {}
    for clip in np.unique(owner[:, 0]):
        of_clip = owner[:, 0] == clip
        for name, mark in getattr(motion_graph.clips[clip], kind).items():
            marks.setdefault(name, np.zeros(len(owner), bool))[of_clip] = mark[owner[of_clip, 1]]
    return marks


def seams(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[Seam]:
    """List the transitions that a walk passes.

    Notebook: 07-walks-and-search
    """
    edges = edge_table(motion_graph, walk)
    first = np.cumsum(edges.frames) - edges.frames
    return [Seam(int(first[i]), float(edges.cost[i])) for i in np.flatnonzero(edges.blended)]


def sources(motion_graph: MotionGraph, walk: Sequence[Edge]) -> list[tuple[int, str]]:
    """Tell which clip a walk plays from which frame on; within a transition it changes half-way.

    Notebook: 07-walks-and-search
    """
    found, frame = [(0, motion_graph.clips[walk[0][0][0]].name)], 0
    for start, end, key in walk:
        data = motion_graph.graph.edges[start, end, key]
        if data["kind"] == "transition" and end[0] != start[0]:
            found.append((frame + data["frames"] // 2, motion_graph.clips[end[0]].name))
        frame += data["frames"]
    return found
