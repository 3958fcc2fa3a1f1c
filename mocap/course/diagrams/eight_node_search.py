"""Branch and bound on a graph small enough to draw: the walks as a tree, step by step [KGP02, 4.2]."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from math import dist, inf
from typing import NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap.course.diagrams.pens import disc
from mocap.course.diagrams.small_graphs import EIGHT_PLACES
from mocap.plotting.graph_drawing import node_link
from mocap.plotting.style import CURVES, PATH, QUIET

Walk = tuple[int, ...]
Lengths = Mapping[int, Mapping[int, float]]
"""`lengths[a][b]` is the length of the edge from a to b."""

FATES = {
    **{"expanded": CURVES[0], "complete": PATH, "cut": CURVES[1]},
    **{"a dead end": "#000000", "too long": "#666666", "waiting": QUIET},
}
"""What may happen to a walk, and its colour."""


class Event(NamedTuple):
    """A walk that the search takes up: its nodes, its cost, what happens to it, and the walks it adds."""

    walk: Walk
    cost: float
    fate: str
    added: list[tuple[float, Walk]]


def search_events(lengths: Lengths, start: int, goal: int, longest: int) -> list[Event]:
    """Search for the shortest walk depth first, the cheapest edge first, and note what happens to each walk.

    Parameters
    ----------
    lengths : of the edges.
    start, goal : where the walk begins, and where it is complete.
    longest : a walk of so many edges is not expanded.

    Examples
    --------
    >>> events = search_events({1: {2: 1.0, 3: 3.0}, 2: {2: 1.0}, 3: {}}, 1, 3, longest=2)
    >>> [(event.walk, event.fate) for event in events]
    [((1,), 'expanded'), ((1, 2), 'expanded'), ((1, 2, 2), 'too long'), ((1, 3), 'complete')]

    Notebook: 07-walks-and-search
    """
    events: list[Event] = []
    waiting: list[tuple[float, Walk]] = [(0.0, (start,))]
    best = inf
    while waiting:
        cost, walk = waiting.pop()
        added: list[tuple[float, Walk]] = []
        if cost >= best:
            fate = "cut"
        elif walk[-1] == goal:
            fate, best = "complete", cost
        else:
            if len(walk) <= longest:
                added = [(cost + more, (*walk, node)) for node, more in lengths[walk[-1]].items()]
            fate = "expanded" if added else "a dead end" if len(walk) <= longest else "too long"
        waiting += sorted(added, key=lambda child: child[0], reverse=True)
        events.append(Event(walk, cost, fate, added))
    return events


def search_steps(
    graph: nx.MultiDiGraph, start: int, goal: int, *, longest: int = 8, step: int | None = None
) -> Figure:
    """Draw the search for the shortest walk between two nodes of the eight-node graph, after some steps.

    On the left stands the graph with the best walk so far, on the right the tree of all walks that the search
    has met. A walk costs its length as it is drawn.

    Parameters
    ----------
    graph : `graphs.notes_example()`, or a part of it.
    start, goal : where the walk begins and ends.
    longest : a walk of so many edges is not expanded.
    step : how many walks the search has taken up; by default all.

    Examples
    --------
    >>> from mocap import graphs
    >>> figure = search_steps(graphs.notes_example(), 6, 2, step=3)
    >>> figure.axes[1].get_title()
    'step 3: 6 → 7 → 8 is expanded'

    Notebook: 07-walks-and-search
    """
    events = search_events(edge_lengths(graph), start, goal, longest)
    shown = events[: len(events) if step is None else step]
    best = min((e for e in shown if e.fate == "complete"), key=lambda e: e.cost, default=None)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
    _draw_graph(left, graph, best.walk if best else ())
    left.set_title(f"best so far: {best.cost:.2f} long" if best else "no complete walk yet", fontsize=10)
    fates = {walk: "waiting" for event in shown for _, walk in event.added} | {e.walk: e.fate for e in shown}
    _draw_tree(right, fates, _columns(events))
    if shown:
        named = " → ".join(map(str, shown[-1].walk))
        right.set_title(f"step {len(shown)}: {named} is {shown[-1].fate}", fontsize=10)
    return figure


def edge_lengths(graph: nx.MultiDiGraph) -> dict[int, dict[int, float]]:
    """Measure the edges of the eight-node graph as it is drawn; a loop at a node counts 0.5.

    Examples
    --------
    >>> from mocap import graphs
    >>> lengths = edge_lengths(graphs.notes_example())
    >>> round(lengths[3][1], 2), lengths[4]
    (1.41, {4: 0.5})

    Notebook: 07-walks-and-search
    """
    at = EIGHT_PLACES
    return {a: {b: dist(at[a], at[b]) or 0.5 for b in sorted(graph.successors(a))} for a in graph}


def _draw_graph(ax: Axes, graph: nx.MultiDiGraph, walk: Walk) -> None:
    """Draw the graph, the length of each edge beside it, and a walk in orange."""
    _, arrows = node_link(graph, places=EIGHT_PLACES, ax=ax)
    ends = list(graph.edges())
    for pair in pairwise(walk):
        arrows[ends.index(pair)].set(color=PATH, linewidth=3)
    for a, row in edge_lengths(graph).items():
        for b, length in row.items():
            (x, z), (u, v) = EIGHT_PLACES[a], EIGHT_PLACES[b]
            middle = ((x + u) / 2, (z + v) / 2 + 0.75 * (a == b))
            box = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
            ax.text(*middle, f"{length:.1f}", fontsize=8, ha="center", va="center", bbox=box)
    ax.margins(0.1)


def _columns(events: list[Event]) -> dict[Walk, float]:
    """Give each leaf of the whole tree a column, and each other walk the middle of those below it."""
    children = {event.walk: [walk for _, walk in sorted(event.added)] for event in events}
    columns: dict[Walk, float] = {}
    count = 0

    def place(walk: Walk) -> float:
        nonlocal count
        below = [place(child) for child in children.get(walk, ())]
        count += not below
        columns[walk] = sum(below) / len(below) if below else float(count)
        return columns[walk]

    if events:
        place(events[0].walk)
    return columns


def _draw_tree(ax: Axes, fates: Mapping[Walk, str], columns: Mapping[Walk, float]) -> None:
    """Draw walks as discs with the name of their last node, each below the walk that it lengthens."""
    for walk, fate in fates.items():
        x, y = columns[walk], 1 - len(walk)
        if len(walk) > 1:
            ax.plot([columns[walk[:-1]], x], [y + 1, y], color=FATES[fate], linewidth=1.5, zorder=1)
        face = "white" if fate == "waiting" else FATES[fate]
        ax.plot(x, y, "o", markersize=15, color=face, markeredgecolor=FATES[fate], zorder=2)
        ink = "black" if fate in {"waiting", "complete"} else "white"
        ax.text(x, y, str(walk[-1]), color=ink, ha="center", va="center", fontsize=9, zorder=3)
    ends = min(columns.values()), max(columns.values())
    ax.set(xlim=(ends[0] - 0.6, ends[1] + 0.6), ylim=(0.5 - max(map(len, columns)), 0.5))
    ax.set_axis_off()
    faces = {fate: "white" if fate == "waiting" else colour for fate, colour in FATES.items()}
    dots = [disc(face, markeredgecolor=FATES[fate]) for fate, face in faces.items()]
    ax.legend(dots, FATES, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=3, frameon=False, fontsize=8)
