"""Standing frames as part of a graph: nodes at which a walk can start, wait and end.

Pruning removes the start and the end of a clip if no transition returns there, and with them the moments at
which people start to walk and stop. `with_standing` adds them again, and joins all standing stretches to each
other, so that a walk can also wait.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.collector import uncollected
from mocap._shared.records import dataclass
from mocap.body.kinematics import joint_positions
from mocap.body.legs import heading_by_hips
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, on_ground
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.edge_tables import clip_rows
from mocap.graphs.motion_graph import MotionGraph, Node, labels_between
from mocap.matching.minima import fit
from mocap.matching.transitions import join_clouds
from mocap.quality.label_proposals import standing_frames
from mocap.steering.tuned import TUNED
from mocap.steering.waiting import Edges, standing_edges

ARRIVALS = 2  # nodes of a stretch at which a walk may arrive. With more, walks stand before they arrive
SKIPPED = 6  # frames between the seams that skip the rest of a stretch
LAST_START = 0.3  # seconds before the end of a stretch at which a seam enters that skips most of it
MOVES = 0.2  # m/s of the root, above which a body moves, as in `quality.label_proposals`
STAND = "stand"  # a label, by which a person corrects which frames stand


@dataclass(frozen=True, eq=False)
class StandingGraph:
    """A motion graph with its standing stretches, and the nodes of these.

    Parameters
    ----------
    graph : the graph, whose walks may have dead ends.
    nodes : the nodes in standing frames.
    arriving : those at which a body has stood for a fifth of a second, and not for much longer.
    leaving : those in the last half second of a standing stretch within a clip, from which a walk starts.
    stretches : the first frame in which the body hardly moves around each node, and the frame after the last.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample("stop_and_go"), 30)]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> standing = with_standing(graph)
    >>> len(standing.nodes) > len(standing.leaving) > 0
    True
    """

    graph: MotionGraph
    nodes: frozenset[Node]
    arriving: frozenset[Node]
    leaving: frozenset[Node]
    stretches: Mapping[Node, tuple[int, int]]

    def stood(self, node: Node) -> int:
        """Return for how many frames the body has stood at a standing node, in its clip."""
        return node[1] - self.stretches[node][0]

    def stands_on(self, node: Node) -> int:
        """Return for how many more frames the body stands at a standing node, in its clip."""
        return self.stretches[node][1] - node[1]

    @cached_property
    def compiled(self) -> CompiledGraph:
        """The graph as arrays, for searches."""
        return compile_graph(self.graph)

    @cached_property
    def edges(self) -> Edges:
        """The edges between standing nodes."""
        return standing_edges(self.graph, self.nodes)

    @cached_property
    def edges_back(self) -> Edges:
        """The same, followed backwards."""
        return standing_edges(self.graph, self.nodes, backwards=True)

    @cached_property
    def waiting(self) -> frozenset[Node]:
        """The standing nodes from which a walk can go on after a wait: those with a way to `leaving`."""
        waiting_nodes = set(self.leaving)
        new = list(waiting_nodes)
        while new:
            node = new.pop()
            sources = {edge.node for edge in self.edges_back.get(node, ())} - waiting_nodes
            waiting_nodes |= sources
            new += sources
        return frozenset(waiting_nodes)

    @cached_property
    def paces(self) -> tuple[float, float]:
        """The median speed of the frames that walk, and the one that a tenth of them exceeds, m/s."""
        speeds = self.compiled.step * self.graph.fps
        walking = speeds[speeds > TUNED.walking_speed]
        usual, fast = np.percentile(walking if len(walking) else speeds, TUNED.pace_percentiles)
        return float(max(usual, TUNED.slowest)), float(max(fast, TUNED.slowest))

    @cached_property
    def headings(self) -> tuple[Array, Array]:
        """The headings of the body by its hips, at the N nodes and in the T frames of `compiled`, radians.

        In a transition, the heading is that of the clip that it leaves.
        """
        clips = self.graph.clips
        legs = find_legs(clips[0].skeleton)
        of_clips = np.concatenate([heading_by_hips(joint_positions(clip), legs) for clip in clips])
        nodes = np.array(self.compiled.nodes)
        return of_clips[clip_rows(clips, nodes)], of_clips[clip_rows(clips, self.compiled.here)]


@uncollected()
def with_standing(graph: MotionGraph) -> StandingGraph:
    """Add the standing stretches of the clips to a graph, with transitions between them.

    A stretch gets a node every third frame, and the frames between it and the nearest nodes
    of its clip. Transitions join the end of each stretch with the start of each one whose windows differ by
    no more than those of the graph's worst transition. The graph may have none: `nodes` is then empty. Clips
    without any node in the graph are left out,
    because no transition leads to them. Frames with the label "stand" are those that stand, in clips that
    have any such frame; else the pace decides, as in `quality.propose_labels`.

    Notebook: 08b-steering
    """
    used = {clip for clip, _ in graph.graph}
    stretches = []
    for number in sorted(used):
        stretches += [(number, start, stop) for start, stop in standing_stretches(graph.clips[number])]
    extended = graph.graph.copy()
    added: set[Node] = set()
    for clip, start, stop in stretches:
        added |= {(clip, frame) for frame in range(start, stop, TUNED.standing_nodes)}
        added.add((clip, stop))
    for clip in {clip for clip, _, _ in stretches}:
        _insert(extended, graph.clips[clip], clip, added)
    _join(extended, graph, stretches, added)
    whole = MotionGraph(graph.clips, graph.window, extended)
    return _with_nodes_of(stretches, whole)


def _with_nodes_of(stretches: Sequence[tuple[int, int, int]], graph: MotionGraph) -> StandingGraph:
    """Return a graph with the nodes in its standing stretches, and those at which walks arrive and leave."""
    settled = round(TUNED.settled_seconds * graph.fps)
    last = round(TUNED.starting_seconds * graph.fps)
    of_nodes: dict[Node, tuple[int, int]] = {}
    arriving: set[Node] = set()
    leaving: set[Node] = set()
    for clip, start, stop in stretches:
        inside = sorted(node for node in graph.graph if node[0] == clip and start <= node[1] <= stop)
        of_nodes |= dict.fromkeys(inside, (start, stop))
        # A seam to another stretch starts no later than a window before the end of this one.
        first = max(start, min(start + settled, stop - graph.window))
        arriving.update([node for node in inside if node[1] >= first][:ARRIVALS])
        if stop < len(graph.clips[clip]):
            leaving.update(node for node in inside if node[1] >= stop - last)
    # Walks may also arrive by a transition into the middle of a stretch.
    for start_node, end_node, kind in graph.graph.edges(data="kind"):
        enters = end_node in of_nodes and start_node not in of_nodes
        if kind == "transition" and enters:
            arriving.add(end_node)
    return StandingGraph(graph, frozenset(of_nodes), frozenset(arriving), frozenset(leaving), of_nodes)


def standing_stretches(clip: Motion) -> list[tuple[int, int]]:
    """Return the standing stretches of a clip, each as its first frame and the one after its last.

    They are the frames with the label "stand", or those that stand by their pace, which is an average over
    half a second, and those around them in which the root hardly moves.
    """
    is_labelled = STAND in clip.labels
    mark: Mask = clip.labels[STAND] if is_labelled else standing_frames(clip)
    shortest = TUNED.standing_seconds * clip.fps
    stretches = [(start, stop) for start, stop in runs(mark).tolist() if stop - start >= shortest]
    if is_labelled:
        return stretches
    speed = np.abs(np.diff(on_ground(clip.root_positions), prepend=np.nan)) * clip.fps
    speed[0] = 0.0
    longer = (_still_around(speed, start, stop) for start, stop in stretches)
    return [(start, stop) for start, stop in dict.fromkeys(longer)]


def _still_around(speed: Array, start: int, stop: int) -> tuple[int, int]:
    """Return a stretch with the frames around it in which the speed of the root is at most `MOVES`."""
    moving = np.flatnonzero(speed > MOVES)
    first, last = moving.searchsorted([start, stop])
    longer_start = int(moving[first - 1]) + 1 if first > 0 else 0
    longer_stop = int(moving[last]) if last < len(moving) else len(speed)
    return longer_start, longer_stop


def _insert(graph: nx.MultiDiGraph, motion: Motion, clip: int, added: set[Node]) -> None:
    """Insert nodes into the stretches of a clip, and join those outside to the nearest nodes."""
    present = sorted(node for node in graph if node[0] == clip)
    frames = {frame for number, frame in added if number == clip}
    for start, end, key, edge in list(graph.out_edges(present, keys=True, data=True)):
        if edge["kind"] == "clip" and any(start[1] < frame < end[1] for frame in frames):
            graph.remove_edge(start, end, key)
    graph.add_nodes_from((clip, frame) for frame in sorted(frames))
    nodes = sorted(node for node in graph if node[0] == clip)
    for start, end in pairwise(nodes):
        is_new = start[1] in frames or end[1] in frames
        between = graph.get_edge_data(start, end) or {}
        joined = any(edge["kind"] == "clip" for edge in between.values())
        if is_new and not joined:
            labels = labels_between(motion, start[1], end[1])
            graph.add_edge(start, end, kind="clip", frames=end[1] - start[1], labels=labels)


def _join(
    graph: nx.MultiDiGraph,
    source: MotionGraph,
    stretches: Sequence[tuple[int, int, int]],
    added: set[Node],
) -> None:
    """Add transitions from the end of each standing stretch to the start of each that fits."""
    window = source.window
    leave = [(clip, stop - window) for clip, start, stop in stretches if stop - start >= window]
    enter = [(clip, start) for clip, start, stop in stretches if stop - start >= window]
    pairs = [(a, b) for a in leave for b in enter if _are_apart(a, b, window)]
    pairs += _skips(source, stretches)
    if not pairs:
        return
    costs = [cost for *_, cost in source.graph.edges(data="cost") if cost is not None]
    limit = max([*costs, TUNED.standing_seam])
    clips = sorted({clip for pair in pairs for clip, _ in pair})
    cloud = join_clouds([source.clips[clip] for clip in clips], None, window, 0, np.float64)
    lengths = [len(source.clips[clip]) for clip in clips]
    first = dict(zip(clips, np.cumsum([0, *lengths]).tolist(), strict=False))
    rows = np.array([[first[clip] + frame for clip, frame in pair] for pair in pairs])
    fits = fit(cloud, cloud, *rows.T).T.tolist()
    joined = []
    for (a, (clip, frame)), (cost, *transform) in zip(pairs, fits, strict=True):
        if cost < limit:
            joined.append((a, (clip, frame + window), cost, PlanarTransform(*transform)))
    ends = {node for a, b, *_ in joined for node in (a, b)}
    for clip in {clip for clip, _ in ends}:
        _insert(graph, source.clips[clip], clip, added | ends)
    for a, b, cost, transform in joined:
        labels = labels_between(source.clips[a[0]], a[1], a[1] + window)
        labels |= labels_between(source.clips[b[0]], b[1] - window, b[1])
        if graph.has_edge(a, b):
            continue
        graph.add_edge(a, b, kind="transition", frames=window, labels=labels, cost=cost, transform=transform)


def _skips(graph: MotionGraph, stretches: Sequence[tuple[int, int, int]]) -> list[tuple[Node, Node]]:
    """Return seams that skip most of a stretch, so that a body can stand for less time than the clip does.

    They enter a stretch shortly before the body moves, from the same stretch or from one at the end of a
    clip, in which no walk starts.
    """
    settled = round(TUNED.settled_seconds * graph.fps)
    entered: dict[int, list[Node]] = {}
    for number, (clip, _, stop) in enumerate(stretches):
        if stop < len(graph.clips[clip]):
            entered[number] = [(clip, stop - round(LAST_START * graph.fps) - graph.window)]
    everywhere = [node for nodes in entered.values() for node in nodes]
    pairs: list[tuple[Node, Node]] = []
    for number, (clip, start, stop) in enumerate(stretches):
        last = stop - graph.window
        frames = {start + graph.window, *range(start + settled, last, SKIPPED)}
        fitting = [(clip, frame) for frame in sorted(frames) if start <= frame <= last]
        for a in fitting:
            pairs += [(a, b) for b in entered.get(number, everywhere) if _leads_on(a, b, graph.window)]
    return pairs


def _leads_on(a: Node, b: Node, window: int) -> bool:
    """Return whether a seam leads to another clip or to a later frame."""
    return a[0] != b[0] or b[1] - a[1] >= window


def _are_apart(a: Node, b: Node, window: int) -> bool:
    """Return whether the windows that start at two nodes do not overlap."""
    return a[0] != b[0] or abs(a[1] - b[1]) >= window
