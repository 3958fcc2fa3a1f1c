"""Random walks through a motion graph, of any length.

A long walk is written in pieces while it is generated: motion dumping [KGP02, 5.3].
"""

from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import numpy as np

from mocap._shared.arguments import called_as
from mocap._shared.arrays import Array
from mocap._shared.progress import Progress
from mocap._shared.quantities import check_number
from mocap._shared.records import NamedTuple
from mocap.body.concatenation import concatenate
from mocap.body.motion import Motion, rotating_joints
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.toes import lowest_heights
from mocap.errors import MocapError, NoWalk
from mocap.files import bvh
from mocap.files.formats import WRITTEN, enumerated
from mocap.files.load_save import save
from mocap.graphs.edge_tables import Edge, edge_table, require_node
from mocap.graphs.motion_graph import MotionGraph, Node, require_graph
from mocap.synthesis.tuned import TUNED
from mocap.synthesis.walk_to_motion import to_motion, transforms_along, with_footplants

COST_OFFSET = 1e-3  # metres, added to the costs of transitions, so that none is infinitely likely
DRAWN = 1000  # random numbers that are drawn at a time
LONGEST = 3600.0  # seconds of a walk that is made in memory


@called_as("synthesis.random_walk(graph, seconds=5)")
def random_walk(
    motion_graph: MotionGraph,
    *,
    seconds: float,
    seed: int = 0,
    settle: float = 1.0,
    start: Node | None = None,
) -> list[Edge]:
    """Draw a random walk of a given duration through a graph.

    If at least `settle` seconds of clip have passed since the last transition, the walk takes one of the
    transitions that leave its node. Otherwise it stays in the clip. At the end of a clip it takes a
    transition in any case. The probability of a transition is proportional to 1 / (cost + 1 mm).

    Parameters
    ----------
    motion_graph : a pruned graph, in which every walk can be continued.
    seconds : the least duration of the motion.
    seed : seed of the random numbers. The same seed gives the same walk.
    settle : seconds of clip between two transitions, if the graph allows this.
    start : the first node, by default a random one.

    Returns
    -------
    The edges of the walk, whose frames last `seconds` or slightly longer.

    Raises
    ------
    NoWalk : for a start that is not in the graph, and if the walk reaches a dead end.
    MocapError : for a duration that is not above 0.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> walk = random_walk(graph, seconds=5, seed=1)
    >>> sum(graph.graph.edges[edge]["frames"] for edge in walk) >= 5 * 30
    True

    Notebook: 07-walks-and-search
    """
    require_graph(motion_graph)
    edges = wander(motion_graph, seed=seed, settle=settle, start=start)
    return next(cut_walk(motion_graph, edges, seconds))


def cut_walk(
    motion_graph: MotionGraph, edges: Iterator[Edge], seconds: float, piece: float = np.inf
) -> Iterator[list[Edge]]:
    """Divide an infinite walk into pieces of at least `piece` seconds, and end it after `seconds`."""
    check_number(seconds, "seconds")
    if not 0 < seconds < np.inf:
        raise MocapError(f"A walk must last longer than 0 s, got {seconds} s.")
    fps = motion_graph.fps
    stored = motion_graph.graph.edges(keys=True, data="frames")
    frames_of = {(start, end, key): count for start, end, key, count in stored}
    yielded = 0  # frames of the pieces that have been yielded
    frames = 0  # of the piece
    walk: list[Edge] = []
    for edge in edges:
        walk.append(edge)
        frames += frames_of[edge]
        ends = yielded + frames >= seconds * fps
        if ends or frames >= piece * fps:
            yield walk
            walk = []
            yielded += frames
            frames = 0
        if ends:
            return


def wander(
    motion_graph: MotionGraph, *, seed: int = 0, settle: float = 1.0, start: Node | None = None
) -> Iterator[Edge]:
    """Yield the edges of an infinite random walk. The parameters are those of `random_walk`.

    Examples
    --------
    In a clip with a transition back, the walk is periodic:

    >>> from itertools import islice
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.prune(graphs.from_transitions([clip], [back], window=10))
    >>> [end for _, end, _ in islice(wander(graph, start=(0, 20)), 4)]
    [(0, 60), (0, 20), (0, 60), (0, 20)]
    """
    graph = motion_graph.graph
    fps = motion_graph.fps
    random = np.random.default_rng(seed)
    node = sorted(graph)[random.integers(len(graph))] if start is None else start
    require_node(motion_graph, node)
    settle_frames = settle * fps
    draws = _draws(random)
    frames = 0
    since = 0  # frames of clip since the last transition
    exits_of: dict[Node, tuple[_Exits, _Exits]] = {}  # of the nodes visited so far
    while True:
        if node not in exits_of:
            exits_of[node] = _exits(graph, node, "clip"), _exits(graph, node, "transition")
        onward, leaving = exits_of[node]
        exits = leaving if leaving.edges and (since >= settle_frames or not onward.edges) else onward
        if not exits.edges:
            raise NoWalk(f"The walk ends at node {node} after {frames / fps:.1f} s: prune the graph first.")
        number = bisect_right(exits.cumulative, next(draws))
        edge = exits.edges[number]
        yield edge
        _, node, _ = edge
        frames += exits.frames[number]
        since = since + exits.frames[number] if exits is onward else 0


def _draws(random: np.random.Generator) -> Iterator[float]:
    """Yield uniform random numbers, drawn many at a time: the same ones as one at a time."""
    while True:
        yield from random.random(DRAWN).tolist()


class _Exits(NamedTuple):
    """The edges of one kind that leave a node, their frames, and the cumulative probabilities of a walk."""

    edges: list[Edge]
    frames: list[int]
    cumulative: list[float]


def _exits(graph: nx.MultiDiGraph, node: Node, kind: str) -> _Exits:
    """List the edges of a kind that leave a node. A walk takes a cheap transition more often than others."""
    exits = [edge for edge in graph.out_edges(node, keys=True, data=True) if edge[-1]["kind"] == kind]
    edges = [(start, end, key) for start, end, key, _ in exits]
    odds = np.array([1 / (data.get("cost", 0.0) + COST_OFFSET) for *_, data in exits])
    # As `Generator.choice` does with probabilities, which are computed once for each node here.
    cumulative = np.cumsum(odds / odds.sum())
    cumulative /= cumulative[-1:]
    return _Exits(edges, [data["frames"] for *_, data in exits], cumulative.tolist())


def stream(motion_graph: MotionGraph, *, seconds: float, seed: int = 0) -> Iterator[Motion]:
    """Generate the motion of a random walk in pieces, with only one of them in memory.

    Parameters
    ----------
    motion_graph : a pruned graph, in which every walk can be continued.
    seconds : the least total duration.
    seed : as for `synthesis.random_walk`, of the same walk.

    Yields
    ------
    Motions of 30 s or more, each of which continues the previous one.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> sum(len(part) for part in stream(graph, seconds=90)) >= 90 * 30
    True
    """
    place = IDENTITY
    for walk in cut_walk(motion_graph, wander(motion_graph, seed=seed), seconds, TUNED.piece):
        yield to_motion(motion_graph, walk, start=place)
        ends = transforms_along(edge_table(motion_graph, walk), place)
        place = PlanarTransform(*(float(np.asarray(numbers)[-1]) for numbers in ends))


def cleaned(pieces: Iterator[Motion], lowest: Array) -> Iterator[Motion]:
    """Remove footskate from consecutive pieces of a motion, as `synthesis.to_motion` does from the whole.

    Each piece is cleaned together with the last 2 · `TUNED.margin` of the motion before it, and its own last
    `TUNED.margin` is yielded with the next piece. Every frame is therefore cleaned with all frames on which
    it depends, and the boundaries are not visible. `lowest` has the lowest height of each joint in the clips,
    (J,), metres.
    """
    waiting = next(pieces)
    cleaned_frames = 0  # of `waiting`, that have been yielded
    margin = round(TUNED.margin * waiting.fps)
    for piece in pieces:
        if len(waiting) - cleaned_frames > margin:
            yield clean_feet(waiting, lowest)[cleaned_frames:-margin]
            cleaned_frames = min(len(waiting) - margin, margin)
            waiting = waiting[-2 * margin :]
        waiting = concatenate([waiting, piece])
    yield clean_feet(waiting, lowest)[cleaned_frames:]


def dump(  # noqa: PLR0913 (a walk, a file, a duration, and options)
    motion_graph: MotionGraph,
    path: str | Path,
    *,
    seconds: float,
    seed: int = 0,
    clean: bool = False,
    progress: Progress = iter,
) -> int:
    """Write a random walk to a `.bvh` file while it is generated, in constant memory.

    In the paper: [KGP02, 5.3].

    A `.glb` file is built in memory, and limited to an hour.

    Parameters
    ----------
    motion_graph, seconds, seed : as for `stream`.
    path : the file, which is created once it is complete.
    clean : whether to remove footskate, as in `synthesis.to_motion`.
    progress : wraps the iterable of pieces, to show a progress bar.

    Returns
    -------
    The number of frames written.

    Raises
    ------
    MocapError : for another format, a file that cannot be written, or a duration that is not above 0.

    Examples
    --------
    >>> import tempfile
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("walk_curve_1"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     dump(graph, f"{folder}/long.bvh", seconds=20) >= 20 * 30
    True
    """
    suffix = Path(path).suffix.lower()
    if suffix not in WRITTEN:
        raise MocapError(f"A long walk is written as {enumerated(WRITTEN)}, got '{path}'.")
    if suffix != ".bvh" and seconds > LONGEST:
        raise MocapError(f"A {suffix} of a walk may last {LONGEST:g} s, not {seconds:g}: write .bvh.")
    # The header of a .bvh file contains the number of frames, which is known from the same walk.
    walks = cut_walk(motion_graph, wander(motion_graph, seed=seed), seconds, TUNED.piece)
    counts = [sum(motion_graph.graph.edges[edge]["frames"] for edge in walk) for walk in walks]
    pieces = stream(with_footplants(motion_graph) if clean else motion_graph, seconds=seconds, seed=seed)
    pieces = cleaned(pieces, lowest_heights(motion_graph.clips)) if clean else pieces
    shown = (next(pieces) for _ in progress(counts))
    if suffix != ".bvh":
        save(concatenate(list(shown)), path)
        return sum(counts)
    rotates = np.any([rotating_joints(clip) for clip in motion_graph.clips], axis=0)
    bvh.write(shown, path, frames=sum(counts), rotates=rotates)
    return sum(counts)
