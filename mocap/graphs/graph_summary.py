"""A graph for people: what it can play, how soon a walk can turn off; and as GraphML for other tools."""

from pathlib import Path

import networkx as nx
import numpy as np

from mocap._shared.atomic import replacing
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError, printable
from mocap.graphs.components import Labels, reached
from mocap.graphs.motion_graph import MotionGraph, Node
from mocap.graphs.pruning import name


class Summary(NamedTuple):
    """What a motion graph can play.

    `frames` and `seconds` : what it plays of the clips.
    `nodes`, `edges`, `transitions` : their numbers; transitions count as edges too.
    `out_degree` : the mean number of edges that leave a node.
    `mean_wait`, `worst_wait` : seconds from a frame of a clip until a transition leaves the clip; infinite
    where the clip ends first.
    `reachable` : for each label set the others that a walk can reach from it.
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
        """Write the summary as lines of text."""
        wait = f"{self.mean_wait:.2f} s away on average, {self.worst_wait:.2f} s at worst"
        rows = [
            ("frames", f"{self.frames} of the clips, {self.seconds:.1f} s"),
            ("nodes", f"{self.nodes}, with {self.out_degree:.2f} edges out of each"),
            ("edges", f"{self.edges}, of them {self.transitions} transitions"),
            ("turn-off", wait if np.isfinite(self.worst_wait) else "none before the end of some clip"),
        ]
        if len(self.reachable) > 1:
            for here, there in self.reachable.items():
                rows.append((name(here), f"leads to {', '.join(sorted(map(name, there))) or 'nothing else'}"))
        return "\n".join(f"{printable(what):<12} {printable(text)}" for what, text in rows)


def summary(graph: nx.MultiDiGraph, *, fps: float) -> Summary:
    """Sum up the graph of a `MotionGraph`.

    Parameters
    ----------
    graph : its `graph`, pruned or not.
    fps : frames per second of its clips.

    Examples
    --------
    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> graph = graphs.from_transitions([clip], [back], window=10)
    >>> graph = graphs.prune(graph)
    >>> print(summary(graph.graph, fps=30).table())
    frames       40 of the clips, 1.3 s
    nodes        2, with 1.00 edges out of each
    edges        2, of them 1 transitions
    turn-off     0.68 s away on average, 1.33 s at worst

    Notebook: 05b-choice-points
    """
    kinds = [kind for _, _, kind in graph.edges(data="kind")]
    turn_offs = {node for node, _, kind in graph.edges(data="kind") if kind == "transition"}
    stretches = [(a, b) for a, b, kind in graph.edges(data="kind") if kind == "clip"]
    ahead: dict[Node, float] = dict.fromkeys(turn_offs, 0.0)  # from a node to the next turn-off
    waits = list[float]()  # from each frame of clip
    for start, end in sorted(stretches, reverse=True):  # from the end, so that the next stretch is known
        own = ahead.get(end, np.inf) + np.arange(end[1] - start[1], 0, -1)
        ahead.setdefault(start, float(own[0]))
        waits += [ahead[start], *own[1:].tolist()]
    frames, nodes, degree = len(waits), len(graph), len(kinds) / max(len(graph), 1)
    counts = (frames, frames / fps, nodes, len(kinds), kinds.count("transition"), degree)
    starts: dict[Labels, set[Node]] = {}
    for start, _, edge in graph.edges(data=True):
        if edge["kind"] == "clip":
            starts.setdefault(edge["labels"], set()).add(start)
    ways = {labels: reached(graph, nodes) for labels, nodes in starts.items()}
    reachable = {
        here: frozenset(there for there in starts if there != here and starts[there] & ways[here])
        for here in starts
    }
    return Summary(*counts, sum(waits) / max(frames, 1) / fps, max(waits, default=0.0) / fps, reachable)


def write_graphml(motion_graph: MotionGraph, path: str | Path) -> None:
    """Write a motion graph as GraphML, for tools such as Gephi, yEd or Cytoscape; mocap does not read it.

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
    for (clip, frame), fields in plain.nodes(data=True):
        seconds = frame / motion_graph.fps
        fields.update(clip=motion_graph.clips[clip].name, frame=frame, seconds=seconds)
    for *_, edge in plain.edges(data=True):
        edge["labels"] = "+".join(sorted(edge["labels"]))
        if edge["kind"] == "transition":
            numbers = {"cost": edge["cost"], **edge.pop("transform")._asdict()}
            edge.update((name, float(number)) for name, number in numbers.items())
    plain = nx.relabel_nodes(plain, {node: f"{motion_graph.clips[node[0]].name}:{node[1]}" for node in plain})
    with replacing(path) as beside:
        nx.write_graphml_xml(plain, beside)
