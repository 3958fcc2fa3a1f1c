"""Statistics of a motion graph, and its export to GraphML."""

from pathlib import Path

import networkx as nx
import numpy as np

from mocap._shared.atomic import replacing
from mocap._shared.quantities import check_number
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError, printable
from mocap.graphs.components import Labels, reached
from mocap.graphs.motion_graph import MotionGraph, Node, require_graph
from mocap.graphs.pruning import name


class Summary(NamedTuple):
    """The size of a motion graph, its waiting times, and the reachability of its kinds of motion.

    `frames` and `seconds` : the part of the clips that is in the graph.
    `nodes`, `edges`, `transitions` : their numbers. Transitions are also counted as edges.
    `out_degree` : the mean number of edges that leave a node.
    `mean_wait`, `worst_wait` : seconds from a frame of a clip until the next transition, infinite if the clip
    ends first.
    `reachable` : for each label set the others that are reachable from it.
    """

    frames: int
    seconds: float
    nodes: int
    edges: int
    transitions: int
    out_degree: float
    mean_wait: float
    worst_wait: float
    reachable: dict[Labels, frozenset[Labels]]

    def table(self) -> str:
        """Format the summary as lines of text."""
        wait = "none before the end of some clip"
        if np.isfinite(self.worst_wait):
            wait = f"{self.mean_wait:.2f} s away on average, {self.worst_wait:.2f} s at worst"
        frames = f"{self.frames} of the clips, {self.seconds:.1f} s"
        nodes = f"{self.nodes}, with {self.out_degree:.2f} edges out of each"
        edges = f"{self.edges}, of them {self.transitions} transitions"
        rows = [("frames", frames), ("nodes", nodes), ("edges", edges), ("turn-off", wait)]
        if len(self.reachable) > 1:
            for labels, successors in self.reachable.items():
                names = ", ".join(sorted(map(name, successors))) or "nothing else"
                rows.append((name(labels), f"leads to {names}"))
        return "\n".join(f"{printable(heading):<12} {printable(text)}" for heading, text in rows)


def summary(graph: MotionGraph | nx.MultiDiGraph, *, fps: float | None = None) -> Summary:
    """Compute the statistics of a motion graph.

    Parameters
    ----------
    graph : a motion graph, pruned or not, or a networkx graph such as `MotionGraph.graph`.
    fps : frames per second of the clips of a networkx graph. A `MotionGraph` stores its own.

    Raises
    ------
    MocapError : for a networkx graph without `fps`, and for other types.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> graph = graphs.prune(graph)
    >>> print(summary(graph).table())
    frames       40 of the clips, 1.3 s
    nodes        2, with 1.00 edges out of each
    edges        2, of them 1 transitions
    turn-off     0.68 s away on average, 1.33 s at worst

    Notebook: 05b-choice-points
    """
    if not isinstance(graph, nx.MultiDiGraph):
        fps = fps or require_graph(graph).fps
        graph = graph.graph
    if fps is None:
        raise MocapError("A networkx graph has no frame rate: pass the MotionGraph itself, or fps=.")
    check_number(fps, "fps")
    kinds = [kind for _, _, kind in graph.edges(data="kind")]
    waits = _waits(graph)
    frames = len(waits)
    # reads: statement: one field a line
    return Summary(
        frames=frames,
        seconds=frames / fps,
        nodes=len(graph),
        edges=len(kinds),
        transitions=kinds.count("transition"),
        out_degree=len(kinds) / max(len(graph), 1),
        mean_wait=sum(waits) / max(frames, 1) / fps,
        worst_wait=max(waits, default=0.0) / fps,
        reachable=_reachable(graph),
    )


def _waits(graph: nx.MultiDiGraph) -> list[float]:
    """Return the number of frames until the next transition, for each frame of a clip."""
    kinds = list(graph.edges(data="kind"))
    stretches = [(start, end) for start, end, kind in kinds if kind == "clip"]
    node_waits: dict[Node, float] = {node: 0.0 for node, _, kind in kinds if kind == "transition"}
    waits: list[float] = []
    for start, end in sorted(stretches, reverse=True):  # from the end: the wait at `end` is known
        frames_to_end = np.arange(end[1] - start[1], 0, -1)
        stretch_waits = node_waits.get(end, np.inf) + frames_to_end
        node_waits.setdefault(start, float(stretch_waits[0]))
        waits += [node_waits[start], *stretch_waits[1:].tolist()]
    return waits


def _reachable(graph: nx.MultiDiGraph) -> dict[Labels, frozenset[Labels]]:
    """Return for each label set the others that are reachable from its stretches of clip."""
    starts: dict[Labels, set[Node]] = {}
    for start, _, edge in graph.edges(data=True):
        if edge["kind"] == "clip":
            starts.setdefault(edge["labels"], set()).add(start)
    reachable = {}
    for labels, nodes in starts.items():
        successors = reached(graph, nodes)
        reachable[labels] = frozenset(
            target for target in starts if target != labels and starts[target] & successors
        )
    return reachable


def write_graphml(motion_graph: MotionGraph, path: str | Path) -> None:
    """Export a motion graph as GraphML, for tools such as Gephi, yEd or Cytoscape (mocap cannot read it).

    Nodes have `clip`, `frame` and `seconds`; edges have `kind`, `frames` and `labels`; transitions also have
    `cost` (m), `angle` (rad), `x` and `z` (m).

    Raises
    ------
    MocapError : for another suffix, and a file that cannot be written.

    Notebook: 05b-choice-points
    """
    if Path(path).suffix.lower() != ".graphml":
        raise MocapError(f"This graph is written as .graphml, got '{path}'.")
    plain = motion_graph.graph.copy()
    node_names = {}
    for (clip, frame), fields in plain.nodes(data=True):
        clip_name = motion_graph.clips[clip].name
        fields.update(clip=clip_name, frame=frame, seconds=frame / motion_graph.fps)
        node_names[clip, frame] = f"{clip_name}:{frame}"
    for *_, edge in plain.edges(data=True):
        edge["labels"] = "+".join(sorted(edge["labels"]))
        if edge["kind"] == "transition":
            numbers = {"cost": edge["cost"], **edge.pop("transform")._asdict()}
            edge.update((name, float(number)) for name, number in numbers.items())
    plain = nx.relabel_nodes(plain, node_names)
    with replacing(path) as temporary:
        nx.write_graphml_xml(plain, temporary)
