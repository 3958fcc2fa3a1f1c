"""Pictures of graphs: large ones as bars and arcs along time, small ones as nodes and arrows."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.patches import FancyArrowPatch
from matplotlib.path import Path

from mocap._shared.arrays import Array, Indices
from mocap.errors import MocapError
from mocap.graphs.motion_graph import MotionGraph
from mocap.plotting.style import COLOURS, MARK, QUIET, SOURCES

Places = Mapping[Any, Sequence[float]]

MOST_NODES = 100
"""With more nodes, the arrows of `node_link` cover each other."""


def timeline(
    motion_graph: MotionGraph, *, most: int = 1000, each: int | None = None, ax: Axes | None = None
) -> LineCollection:
    """Draw a motion graph: one bar per clip, along time, and one arc per transition.

    Arcs within a clip are bent, arcs to another clip are straight. Where not all transitions are drawn, a
    line below the axes says which, and how many of how many.

    Parameters
    ----------
    motion_graph : the graph; parts of its clips that are not in the graph are drawn thin.
    most : how many transitions to show at most; of more, those of least cost.
    each : how many to show from each clip to each clip, those of least cost, with the nodes where they leave
        and enter; by default, as many as there are.
    ax : axes; new ones by default.

    Returns
    -------
    The arcs.

    Examples
    --------
    >>> from mocap import datasets, graphs, plotting, resample
    >>> clips = [resample(datasets.sample("walk_circle"), 30)]
    >>> arcs = timeline(graphs.build(clips, window=10, threshold=0.03), most=200)
    >>> len(arcs.get_segments()), arcs.axes.texts[0].get_text()
    (200, 'drawn: the cheapest, 200 of 1044 transitions')
    >>> plotting.show(arcs, alt="A clip with arcs from each moment to moments like it.")
    Picture('A clip with arcs from each moment to moments like it.')

    Notebook: 00-quickstart
    """
    clips, fps = motion_graph.clips, motion_graph.clips[0].fps
    ax = ax or plt.figure(figsize=(9, 0.55 * len(clips) + 1), layout="constrained").add_subplot()
    frames = np.array(list(motion_graph.graph.edges(keys=False)), int).reshape(-1, 2, 2)  # (clip, frame)
    ends = frames[..., ::-1] / [fps, -1]  # (E, 2, 2): (seconds, row)
    edges = [edge for _, _, edge in motion_graph.graph.edges(data=True)]
    stays = np.array([edge["kind"] == "clip" for edge in edges], bool)
    whole = [[(0, -clip), (len(motion) / fps, -clip)] for clip, motion in enumerate(clips)]
    ax.add_collection(LineCollection(whole, colors=QUIET, linewidths=1, zorder=0))
    colours = [SOURCES[clip % len(SOURCES)] for clip in frames[stays, 0, 0]]
    ax.add_collection(LineCollection(list(ends[stays]), colors=colours, linewidths=5, capstyle="butt"))
    if len(motion_graph.graph) <= MOST_NODES:
        x, y = np.array(motion_graph.graph.nodes).reshape(-1, 2)[:, ::-1].T / [[fps], [-1]]
        ax.plot(x, y, "o", color="white", markeredgecolor=COLOURS["middle"], markersize=5)
    costs = np.array([edge.get("cost", 0.0) for edge in edges])[~stays]
    chosen = sorted(islice(cheapest(frames[~stays, :, 0], costs, each), most))
    arcs = _arcs(ends[~stays][chosen])
    fade = min(1.0, 0.06 + 60 / (len(arcs) + 1))
    transitions = LineCollection(list(arcs), colors=MARK, linewidths=0.7, alpha=fade, zorder=1.5)
    ax.add_collection(transitions)
    if each is not None:
        _draw_ends(arcs, ax)
    if len(arcs) < len(costs):
        which = f"the {each} cheapest" if each and each > 1 else "the cheapest"
        which += "" if each is None else " from each clip to each clip"
        note = f"drawn: {which}, {len(arcs)} of {len(costs)} transitions"
        ax.annotate(note, (1, 0), (0, -48), "axes fraction", "offset points", ha="right", va="top", size=9)
    ax.set_yticks([-clip for clip in range(len(clips))], [motion.name for motion in clips])
    ax.set(xlabel="time in the clip (s)", ylim=(0.4 - len(clips), 0.7))
    ax.spines[["top", "right", "left"]].set_visible(False)
    return transitions


def cheapest(pairs: Indices, costs: Array, each: int | None) -> Iterator[int]:
    """Give the numbers of transitions by cost, the lowest first; from each clip to each, at most `each`."""
    seen: Counter[tuple[int, ...]] = Counter()
    for number in np.argsort(costs, kind="stable").tolist():
        pair = tuple(pairs[number].tolist())
        seen[pair] += 1
        if each is None or seen[pair] <= each:
            yield number


def _draw_ends(arcs: Array, ax: Axes) -> None:
    """Draw the nodes of arcs: rings where they leave, discs where they enter."""
    for at, face, label in ((0, "white", "leaves"), (-1, MARK, "enters")):
        x, y = arcs[:, at].T
        ax.plot(x, y, "o", color=face, markeredgecolor=MARK, markersize=4.5, label=label, zorder=2)
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, fontsize=9)


def _arcs(ends: Array) -> Array:
    """Bend lines (E, 2, 2) upwards where both ends lie in one clip, off its bar: (E, 13, 2)."""
    t = np.linspace(0, 1, 13)[:, None]
    start, end = ends[:, :1], ends[:, 1:]
    lift = np.where(start[..., 1:] == end[..., 1:], [0, 0.45], 0)
    return start + t * (end - start) + 4 * t * (1 - t) * lift


def node_link(
    graph: nx.DiGraph, *, places: Places | None = None, kept: nx.DiGraph | None = None, ax: Axes | None = None
) -> tuple[PathCollection, list[FancyArrowPatch]]:
    """Draw a small directed graph: nodes as discs with their names, edges as bent arrows.

    Parameters
    ----------
    graph : 1 to 100 nodes.
    places : where to put the nodes, {node: (x, y)}; on a circle by default.
    kept : the graph after pruning; nodes that are not in it are drawn pale, such edges dashed.
    ax : axes; new ones by default.

    Returns
    -------
    The discs, and one arrow per edge.

    Raises
    ------
    MocapError : for more nodes, or none.

    Examples
    --------
    >>> from mocap import plotting
    >>> discs, arrows = node_link(nx.DiGraph([(1, 2), (2, 1), (2, 3)]))
    >>> len(discs.get_offsets()), len(arrows)
    (3, 3)
    >>> plotting.show(discs, alt="1 and 2 lead to each other, 2 leads to 3.")
    Picture('1 and 2 lead to each other, 2 leads to 3.')

    Notebook: 05-motion-graph
    """
    if not 0 < len(graph) <= MOST_NODES:
        nodes = f"1 to {MOST_NODES} nodes, this one has {len(graph)}"
        raise MocapError(f"Nodes and arrows show graphs of {nodes}: `plotting.timeline` shows large ones.")
    ax = ax or plt.figure(figsize=(4, 4), layout="constrained").add_subplot()
    places, ink = places or nx.circular_layout(graph), COLOURS["middle"]
    kept = graph if kept is None else kept
    at = np.array([places[node] for node in graph], float)
    faces = [ink if node in kept else "#E8E8E8" for node in graph]
    discs = ax.scatter(at[:, 0], at[:, 1], s=420, c=faces, edgecolors=ink, zorder=2)
    words: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 9, "zorder": 3}
    for node, place in zip(graph, at, strict=True):
        name = ",".join(map(str, node)) if isinstance(node, tuple) else str(node)
        ax.annotate(name, place, color="white" if node in kept else ink, **words)
    arrows = []
    for a, b in graph.edges():
        # An arrow bends to its left, so that it and the arrow back are apart; a loop goes over its node.
        way: Any = _round_above if np.array_equal(places[a], places[b]) else "arc3,rad=0.15"
        shape: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 12, "shrinkA": 11, "shrinkB": 11}
        arrow = FancyArrowPatch(places[a], places[b], connectionstyle=way, linewidth=1.2, zorder=1, **shape)  # type: ignore[arg-type]
        stays = kept.has_edge(a, b)
        arrow.set(color=ink if stays else QUIET, linestyle="-" if stays else "--")
        ax.add_patch(arrow)
        arrows.append(arrow)
    ax.set(aspect="equal")
    ax.margins(0.2)
    ax.set_axis_off()
    return discs, arrows


def _round_above(start: Sequence[float], _: object, *, shrinkA: float, **__: object) -> Path:
    """Draw a loop over the top of a disc of radius `shrinkA`, pixels."""
    corners = np.array([(-0.5, 0.8), (-1.5, 2.8), (1.5, 2.8), (0.5, 0.95)])
    return Path(start + shrinkA * corners, [Path.MOVETO, Path.CURVE4, Path.CURVE4, Path.CURVE4])
