"""What a motion graph is: nodes and edges on two clips' timelines, and the homework's segments."""

from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from mocap.course.diagrams.pens import arrow, say
from mocap.plotting.style import COLOURS, MARK, PATH, QUIET, SOURCES

LENGTHS = (6.0, 5.0)  # seconds
LEAPS = ((0, 3.6, 1, 1.4), (1, 3.2, 0, 1.8), (0, 4.8, 0, 1.0))
"""Transitions: which clip they leave, when, which clip they enter, when."""

STEPS = (
    "Two clips: each can only be played from its start to its end.",
    "A match: in these two windows both clips do nearly the same.",
    "A transition joins them. Where it leaves and enters, a node cuts the clip.",
    "More matches: every piece of clip is an edge, every transition is an edge.",
    "Pruned: the grey pieces lead to an end, or nothing leads to them.",
    "A walk: any sequence of edges in which each begins where the last one ends.",
)
MATCH = ((0, 3.6, 0.32), (1, 1.07, -1.42))  # its windows: clip, from, height of the word
WALK = ((-0.18, 1.0, 3.6), (-1.18, 1.4, 3.2), (-0.32, 1.8, 4.8), (-0.46, 1.0, 3.6))  # height, from, to


def nodes_and_edges(step: int = 5) -> Figure:
    """Draw how two clips become a motion graph, with as many of six steps as are asked for.

    Parameters
    ----------
    step : 0 to 5: the clips, a match, its transition, all transitions, the pruned graph, a walk.

    Returns
    -------
    The figure; its title says what the step is.

    Examples
    --------
    >>> from mocap import plotting
    >>> plotting.show(nodes_and_edges(step=2), alt="Two bars, and an arrow from a node to a node.")
    Picture('Two bars, and an arrow from a node to a node.')

    Notebook: 05b-choice-points
    """
    figure, ax = plt.subplots(figsize=(7, 3), layout="constrained")
    leaps = LEAPS[: (0, 0, 1, 3, 3, 3)[step]]
    for clip, length in enumerate(LENGTHS):
        nodes = {leaves for source, leaves, _, _ in leaps if source == clip}
        nodes |= {enters for _, _, target, enters in leaps if target == clip}
        times = sorted({0.0, length} | nodes)
        for start, end in pairwise(times):
            colour = SOURCES[clip] if step < 4 or 0 < start < end < length else "#DDDDDD"
            ax.plot([start, end], [-clip] * 2, color=colour, linewidth=9, solid_capstyle="butt", zorder=1)
        for time in times:
            edge = COLOURS["middle"] if step < 4 or time in nodes else QUIET
            ax.plot(time, -clip, "o", color="white", markeredgecolor=edge, markersize=9, zorder=4)
    for clip, at, below in MATCH if step == 1 else ():
        ax.plot([at, at + 0.33], [-clip] * 2, color=MARK, linewidth=17, solid_capstyle="butt", zorder=2)
        ax.text(at + 0.16, below, "window", ha="center", color=COLOURS["middle"], fontsize=9)
    for number, (lift, start, end) in enumerate(WALK if step == 5 else (), 1):
        arrow(ax, start + 1j * lift, end + 1j * lift, PATH, 2.2, shrinkA=2, shrinkB=2)
        say(ax, start - 0.12 + 1j * lift, str(number), fontsize=9)
    for source, leaves, target, enters in leaps:
        bend, colour = f"arc3,rad={0.28 * (source == target)}", PATH if step == 5 else MARK
        look: dict[str, Any] = {"connectionstyle": bend, "shrinkA": 6, "shrinkB": 6}
        arrow(ax, leaves - 1j * source, enters - 1j * target, colour, **look).set_zorder(3)
    ax.set_title(f"{step}. {STEPS[step]}", fontsize=10, loc="left")
    ax.set(xlabel="time in the clip (s)", xlim=(-0.2, 6.2), ylim=(-1.75, 0.95))
    ax.set_yticks([0, -1], ["clip A", "clip B"])
    ax.tick_params(left=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    return figure


BOX, GAP = 0.9, 0.42  # a box's width where segments are 1 apart; its height where rows are 2 apart


def segments_in_rows(graph: nx.DiGraph, names: list[str], *, step: int | None = None) -> Figure:
    """Draw a graph of segments: a row of numbered boxes per clip, and a line per transition.

    A transition leaves the end of a box and enters the start of another. That a segment is followed by its
    neighbour on the right is not drawn. Segments that nothing follows have a thick rim.

    Parameters
    ----------
    graph : from `graphs.segment_graph`.
    names : the clips' names.
    step : draw the transitions of this segment only; by default those of all.

    Examples
    --------
    >>> from mocap import datasets, graphs
    >>> clips = [datasets.sample(name)[:1200] for name in ("walk_circle", "walk_curve_1")]
    >>> figure = segments_in_rows(graphs.segment_graph(clips, threshold=250), ["circle", "curve"])
    >>> len(figure.axes[0].patches)  # six segments of each clip
    12

    Notebook: 05-motion-graph
    """
    nodes = dict(graph.nodes(data=True))
    firsts = {part["clip"]: node for node, part in reversed(nodes.items())}
    at = {node: (node - firsts[part["clip"]], -2 * part["clip"]) for node, part in nodes.items()}
    figure, ax = plt.subplots(figsize=(9, 0.9 * len(names) + 1.3), layout="constrained")
    for node, (x, y) in at.items():
        dead = not graph.out_degree(node)
        box = Rectangle((x, y - GAP), BOX, 2 * GAP, facecolor=SOURCES[nodes[node]["clip"]], zorder=1)
        box.set(edgecolor="black" if dead else "white", linewidth=3 if dead else 0.5)
        ax.add_patch(box)
        ax.text(x + BOX / 2, y, str(node), ha="center", va="center", fontsize=7, color="white", zorder=4)
    taken = [(a, b) for a, b, kind in graph.edges(data="kind") if kind == "transition" and step in (None, a)]
    ends = np.array([(at[a], at[b]) for a, b in taken], float).reshape(-1, 2, 2)
    down = np.sign(ends[:, 0, 1] - ends[:, 1, 1])[:, None]
    ends += np.stack([down * [0, -GAP] + [BOX, 0], down * [0, GAP] + [0.1, 0]], axis=1)  # from edge to edge
    few = len(ends) < 20
    ax.add_collection(LineCollection(list(ends), colors=MARK, linewidths=1.8 if few else 0.7, zorder=0.5))
    for sign, marker in ((1, "v"), (-1, "^")):
        tips = ends[down[:, 0] == sign, 1]
        ax.plot(*tips.T, marker, color=MARK, markersize=6 if few else 4, zorder=3)
    _frame(ax, names, max(x for x, _ in at.values()))
    return figure


def _frame(ax: Axes, names: list[str], last: int) -> None:
    ax.set_yticks([-2 * row for row in range(len(names))], names)
    ax.set(xlim=(-0.5, last + 1.5), ylim=(-2 * len(names) + 1, 1), xlabel="segment of the clip, in order")
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(left=False)
    match = Line2D([], [], color=MARK, marker="v", markersize=5, label="a match: may follow")
    dead = Rectangle((0, 0), 1, 1, facecolor=QUIET, edgecolor="black", linewidth=3, label="nothing follows")
    look: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1, 1), "fontsize": 8, "frameon": False}
    ax.legend(handles=[match, dead], ncols=2, **look)
