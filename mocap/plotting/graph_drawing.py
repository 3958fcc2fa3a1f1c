"""Pictures of graphs: large ones as bars and arcs over time, small ones as nodes and arrows."""

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

Positions = Mapping[Any, Sequence[float]]

MOST_NODES = 100
"""With more nodes, the arrows of `node_link` cover each other."""

POINTS = 13  # points of an arc
LIFT = 0.45  # rows, the height of the middle of an arc above its clip's bar
PALE = "#E8E8E8"  # the colour of nodes that pruning removes


# reads: name: `most` and `each` are public parameters
def timeline(
    motion_graph: MotionGraph, *, most: int = 1000, each: int | None = None, ax: Axes | None = None
) -> LineCollection:
    """Draw a motion graph: one bar per clip, over time, and one arc per transition.

    Arcs within a clip are bent, and arcs to another clip are straight. If not all transitions are drawn, a
    note below the axes states the selection and its size.

    Parameters
    ----------
    motion_graph : the graph. Parts of its clips that are not in the graph are drawn as thin lines.
    most : the largest number of transitions to draw, in ascending order of cost.
    each : the largest number of transitions for each pair of clips, in ascending order of cost. These are
        drawn with the nodes that they leave and enter. Unlimited by default.
    ax : axes, by default new ones.

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
    clips = motion_graph.clips
    fps = clips[0].fps
    ax = ax or plt.figure(figsize=(9, 0.55 * len(clips) + 1), layout="constrained").add_subplot()
    frames = np.array(list(motion_graph.graph.edges(keys=False)), int).reshape(-1, 2, 2)  # (clip, frame)
    edges = [edge for _, _, edge in motion_graph.graph.edges(data=True)]
    in_clip = np.array([edge["kind"] == "clip" for edge in edges], bool)
    _draw_bars(motion_graph, frames[in_clip], ax)
    if len(motion_graph.graph) <= MOST_NODES:
        x, y = _on_timeline(np.array(motion_graph.graph.nodes).reshape(-1, 2), fps).T
        ax.plot(x, y, "o", color="white", markeredgecolor=COLOURS["middle"], markersize=5)
    costs = np.array([edge.get("cost", 0.0) for edge in edges])[~in_clip]
    transitions = frames[~in_clip]
    drawn = sorted(islice(cheapest(transitions[..., 0], costs, each), most))
    arcs = _arcs(_on_timeline(transitions[drawn], fps))
    opacity = min(1.0, 0.06 + 60 / (len(arcs) + 1))
    lines = LineCollection(list(arcs), colors=MARK, linewidths=0.7, alpha=opacity, zorder=1.5)
    ax.add_collection(lines)
    if each is not None:
        _draw_ends(arcs, ax)
    if len(arcs) < len(costs):
        note = f"drawn: {_selection(each)}, {len(arcs)} of {len(costs)} transitions"
        ax.annotate(note, (1, 0), (0, -48), "axes fraction", "offset points", ha="right", va="top", size=9)
    ax.set_yticks([-clip for clip in range(len(clips))], [motion.name for motion in clips])
    ax.set(xlabel="time in the clip (s)", ylim=(0.4 - len(clips), 0.7))
    ax.spines[["top", "right", "left"]].set_visible(False)
    return lines


def _on_timeline(frames: Indices, fps: float) -> Array:
    """Return the positions (seconds, row) of frames (clip, frame), shape (..., 2)."""
    return np.asarray(frames[..., ::-1] / [fps, -1])


def _draw_bars(motion_graph: MotionGraph, stretches: Indices, ax: Axes) -> None:
    """Draw clips as thin lines, and on them the stretches in the graph, (E, 2, 2), as bars."""
    clips = motion_graph.clips
    fps = clips[0].fps
    lines = [[(0, -clip), (len(motion) / fps, -clip)] for clip, motion in enumerate(clips)]
    ax.add_collection(LineCollection(lines, colors=QUIET, linewidths=1, zorder=0))
    colours = [SOURCES[clip % len(SOURCES)] for clip in stretches[:, 0, 0]]
    bars = list(_on_timeline(stretches, fps))
    ax.add_collection(LineCollection(bars, colors=colours, linewidths=5, capstyle="butt"))


def _selection(each: int | None) -> str:  # reads: name: as in `timeline`
    """Describe the selection of transitions that are drawn."""
    if each is None:
        return "the cheapest"
    number = f"{each} " if each > 1 else ""
    return f"the {number}cheapest from each clip to each clip"


# reads: name: as in `timeline`
def cheapest(pairs: Indices, costs: Array, each: int | None) -> Iterator[int]:
    """Yield the numbers of transitions in ascending order of cost, at most `each` for each pair of clips.

    Parameters
    ----------
    pairs : shape (E, 2), the clips that a transition leaves and enters.
    costs : shape (E,).
    each : the largest number for each ordered pair of clips, or None for all.
    """
    counts: Counter[tuple[int, ...]] = Counter()
    for number in np.argsort(costs, kind="stable").tolist():
        pair = tuple(pairs[number].tolist())
        counts[pair] += 1
        if each is None or counts[pair] <= each:
            yield number


def _draw_ends(arcs: Array, ax: Axes) -> None:
    """Draw the ends of arcs: rings for nodes that transitions leave, discs for nodes that they enter."""
    for point, face, label in ((0, "white", "leaves"), (-1, MARK, "enters")):
        x, y = arcs[:, point].T
        ax.plot(x, y, "o", color=face, markeredgecolor=MARK, markersize=4.5, label=label, zorder=2)
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, fontsize=9)


def _arcs(ends: Array) -> Array:
    """Sample arcs between the ends of lines (E, 2, 2), (E, 13, 2), bent upwards if both are in one clip."""
    t = np.linspace(0, 1, POINTS)[:, None]
    start = ends[:, :1]
    end = ends[:, 1:]
    lift = np.where(start[..., 1:] == end[..., 1:], [0, LIFT], 0)
    return start + t * (end - start) + 4 * t * (1 - t) * lift


def node_link(
    graph: nx.DiGraph,
    *,
    positions: Positions | None = None,
    kept: nx.DiGraph | None = None,
    ax: Axes | None = None,
) -> tuple[PathCollection, list[FancyArrowPatch]]:
    """Draw a small directed graph: nodes as discs with their names, edges as bent arrows.

    Parameters
    ----------
    graph : a graph of 1 to 100 nodes.
    positions : the positions of the nodes, {node: (x, y)}, by default on a circle.
    kept : the graph after pruning. Other nodes are drawn pale, and other edges dashed.
    ax : axes, by default new ones.

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
    positions = positions or nx.circular_layout(graph)
    kept = graph if kept is None else kept
    discs = _draw_nodes(graph, positions, kept, ax)
    arrows = []
    for start, end in graph.edges():
        arrow = _arrow(positions[start], positions[end], is_kept=kept.has_edge(start, end))
        ax.add_patch(arrow)
        arrows.append(arrow)
    ax.set(aspect="equal")
    ax.margins(0.2)
    ax.set_axis_off()
    return discs, arrows


def _draw_nodes(graph: nx.DiGraph, positions: Positions, kept: nx.DiGraph, ax: Axes) -> PathCollection:
    """Draw nodes as discs with their names, pale if they are not in `kept`."""
    ink = COLOURS["middle"]
    centres = np.array([positions[node] for node in graph], float)
    faces = [ink if node in kept else PALE for node in graph]
    discs = ax.scatter(centres[:, 0], centres[:, 1], s=420, c=faces, edgecolors=ink, zorder=2)
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 9, "zorder": 3}
    for node, centre in zip(graph, centres, strict=True):
        name = ",".join(map(str, node)) if isinstance(node, tuple) else str(node)
        ax.annotate(name, centre, color="white" if node in kept else ink, **look)
    return discs


def _arrow(start: Sequence[float], end: Sequence[float], *, is_kept: bool) -> FancyArrowPatch:
    """Create the arrow of an edge, dashed if it is not kept.

    It bends to its left, so that it does not cover the arrow in the other direction. A loop is above its
    node.
    """
    look: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 12, "shrinkA": 11, "shrinkB": 11}
    look |= {"linewidth": 1.2, "zorder": 1}
    look["connectionstyle"] = _loop if np.array_equal(start, end) else "arc3,rad=0.15"
    look["color"] = COLOURS["middle"] if is_kept else QUIET
    look["linestyle"] = "-" if is_kept else "--"
    return FancyArrowPatch(start, end, **look)  # type: ignore[arg-type]


def _loop(start: Sequence[float], _: object, *, shrinkA: float, **__: object) -> Path:
    """Return the path of a loop above a disc of radius `shrinkA`, pixels."""
    corners = np.array([(-0.5, 0.8), (-1.5, 2.8), (1.5, 2.8), (0.5, 0.95)])
    return Path(start + shrinkA * corners, [Path.MOVETO, Path.CURVE4, Path.CURVE4, Path.CURVE4])
