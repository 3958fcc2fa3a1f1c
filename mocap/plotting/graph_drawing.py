"""Pictures of graphs: clips along time with arcs for transitions, and nodes with arrows for small ones."""

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.patches import FancyArrowPatch
from matplotlib.path import Path
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.errors import MocapError
from mocap.graphs.motion_graph import MotionGraph
from mocap.plotting.style import COLOURS, MARK, QUIET

Places = Mapping[Any, Sequence[float]]

MOST_NODES = 100
"""A drawing of nodes and arrows with more is a ball of wool, and takes seconds to lay out."""


def timeline(motion_graph: MotionGraph, *, most: int = 1000, ax: Axes | None = None) -> LineCollection:
    """Draw a motion graph: a bar a clip, along time, and a line a transition, bent where it stays in a clip.

    Parameters
    ----------
    motion_graph : the graph; what its clips hold beside it is drawn thin.
    most : transitions to show at most; where there are more, those that cost least.
    ax : axes; new ones by default.

    Returns
    -------
    The arcs.

    Notebook: 00-quickstart
    """
    clips, fps = motion_graph.clips, motion_graph.clips[0].fps
    ax = ax or plt.figure(figsize=(7, 0.7 * len(clips) + 1), layout="constrained").add_subplot()
    edges = [edge for _, _, edge in motion_graph.graph.edges(data=True)]
    ends = np.array([(start, end) for start, end in motion_graph.graph.edges()]).reshape(-1, 2, 2)
    ends = ends[..., ::-1] / [fps, -1]  # (E, 2, 2): (clip, frame) → (seconds, row)
    stays = np.array([edge["kind"] == "clip" for edge in edges], bool)
    costs = np.array([edge.get("cost", 0.0) for edge in edges])[~stays]
    arcs = _arcs(ends[~stays][np.sort(np.argsort(costs, kind="stable")[:most])])
    whole = [[(0, -clip), (len(motion) / fps, -clip)] for clip, motion in enumerate(clips)]
    ax.add_collection(LineCollection(whole, colors=QUIET, linewidths=1, zorder=0))
    ax.add_collection(
        LineCollection(list(ends[stays]), colors=COLOURS["left"], linewidths=5, capstyle="butt")
    )
    fade = min(1.0, 0.06 + 60 / (len(arcs) + 1))
    transitions = LineCollection(list(arcs), colors=MARK, linewidths=0.7, alpha=fade, zorder=1.5)
    ax.add_collection(transitions)
    nodes = np.array(motion_graph.graph.nodes).reshape(-1, 2)
    if len(nodes) <= MOST_NODES:
        ax.plot(
            nodes[:, 1] / fps,
            -nodes[:, 0],
            "o",
            color="white",
            markeredgecolor=COLOURS["middle"],
            markersize=5,
        )
    ax.set_yticks([-clip for clip in range(len(clips))], [motion.name for motion in clips])
    ax.set(xlabel="time in the clip (s)", ylim=(0.4 - len(clips), 0.7))
    ax.spines[["top", "right", "left"]].set_visible(False)
    return transitions


def _arcs(ends: Array) -> Array:
    """Bend lines (E, 2, 2) upwards where both ends lie in one clip, so that they are seen: (E, 13, 2)."""
    t = np.linspace(0, 1, 13)[:, None]
    start, end = ends[:, :1], ends[:, 1:]
    lift = np.where(start[..., 1:] == end[..., 1:], [0, 0.45], 0)
    return start + t * (end - start) + 4 * t * (1 - t) * lift


def node_link(
    graph: nx.DiGraph,
    *,
    places: Places | None = None,
    kept: nx.DiGraph | None = None,
    ax: Axes | None = None,
) -> tuple[PathCollection, list[FancyArrowPatch]]:
    """Draw a small directed graph: nodes as discs with their names, edges as bent arrows.

    Parameters
    ----------
    graph : up to a hundred nodes.
    places : where to put the nodes, {node: (x, y)}; on a circle by default.
    kept : what is left of the graph after pruning; the rest is drawn pale, its edges dashed.
    ax : axes; new ones by default.

    Returns
    -------
    The discs, and an arrow an edge.

    Raises
    ------
    MocapError : for more nodes, or none.

    Notebook: 06-pruning
    """
    if not 0 < len(graph) <= MOST_NODES:
        raise MocapError(
            f"Nodes and arrows show graphs of 1 to {MOST_NODES} nodes, this one has {len(graph)}: "
            "`plotting.timeline` shows large ones."
        )
    ax = ax or plt.figure(figsize=(4, 4), layout="constrained").add_subplot()
    places = places or nx.circular_layout(graph)
    kept = graph if kept is None else kept
    at = np.array([places[node] for node in graph], float)
    faces = [COLOURS["left"] if node in kept else "#E8E8E8" for node in graph]
    discs = ax.scatter(at[:, 0], at[:, 1], s=420, c=faces, edgecolors=COLOURS["middle"], zorder=2)
    for node, place in zip(graph, at, strict=True):
        colour = "white" if node in kept else COLOURS["middle"]
        ax.annotate(_name(node), place, ha="center", va="center", color=colour, fontsize=9, zorder=3)
    arrows = [_arrow(places[a], places[b], kept.has_edge(a, b)) for a, b in graph.edges()]
    for arrow in arrows:
        ax.add_patch(arrow)
    ax.set(aspect="equal")
    ax.margins(0.2)
    ax.set_axis_off()
    return discs, arrows


def _name(node: object) -> str:
    return ",".join(map(str, node)) if isinstance(node, tuple) else str(node)


def _arrow(start: Sequence[float], end: Sequence[float], kept: bool) -> FancyArrowPatch:
    """Bend an arrow to its left, so that there and back are two; one to its own start goes round above."""
    return FancyArrowPatch(
        (start[0], start[1]),
        (end[0], end[1]),
        connectionstyle=_round_above if np.array_equal(start, end) else "arc3,rad=0.15",  # type: ignore[arg-type]  # any callable will do
        arrowstyle="-|>",
        mutation_scale=12,
        shrinkA=11,
        shrinkB=11,
        color=COLOURS["middle"] if kept else QUIET,
        linestyle="-" if kept else "--",
        linewidth=1.2,
        zorder=1,
    )


def _round_above(start: Sequence[float], _: object, *, shrinkA: float, **__: object) -> Path:
    """Lead a loop round the top of a disc of radius `shrinkA`, pixels."""
    corners = np.array([(-0.5, 0.8), (-1.5, 2.8), (1.5, 2.8), (0.5, 0.95)])
    return Path(start + shrinkA * corners, [Path.MOVETO, Path.CURVE4, Path.CURVE4, Path.CURVE4])


def before_and_after(
    whole: MotionGraph, pruned: MotionGraph, *, axes: ArrayLike | None = None
) -> tuple[LineCollection, LineCollection]:
    """Draw a motion graph before and after pruning, one above the other.

    Parameters
    ----------
    whole, pruned : the graph before and after.
    axes : two; new ones by default.

    Returns
    -------
    The arcs of both.

    Notebook: 06-pruning
    """
    if axes is None:
        size = (7, 1.4 * len(whole.clips) + 1.6)
        axes = plt.figure(figsize=size, layout="constrained").subplots(2, 1, sharex=True)
    before, after = np.ravel(np.asarray(axes, object))
    arcs = timeline(whole, ax=before), timeline(pruned, ax=after)
    for ax, graph, when in ((before, whole, "before"), (after, pruned, "after")):
        ax.set_title(
            f"{when}: {graph.graph.number_of_nodes()} nodes, {graph.count('transition')} transitions"
        )
    return arcs
