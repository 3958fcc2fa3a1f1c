"""Branch and bound, step by step on eight nodes, and its walks on the ground [KGP02, 4.2]."""

from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise
from math import dist, inf
from typing import NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from mocap._shared.arrays import Points
from mocap.course.diagrams.pens import disc, say
from mocap.course.diagrams.small_graphs import BOX, EIGHT_PLACES, eight_node_graph
from mocap.plotting import ASKED, COLOURS, CURVES, PATH, QUIET
from mocap.plotting.charts import seen_from_above

Walk = tuple[int, ...]
Lengths = Mapping[int, Mapping[int, float]]  # lengths[a][b] is that of the edge from a to b

LONG = 7  # nodes of a walk of which only the first and last are written
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
            fate = "complete"
            best = cost
        elif len(walk) > longest:
            fate = "too long"
        else:
            successors = lengths[walk[-1]]
            added = [(cost + length, (*walk, node)) for node, length in successors.items()]
            fate = "expanded" if added else "a dead end"
        waiting += sorted(added, key=lambda child: child[0], reverse=True)
        events.append(Event(walk, cost, fate, added))
    return events


def search_steps(
    graph: nx.MultiDiGraph, start: int, goal: int, *, longest: int = 8
) -> Callable[[int], list[Artist]]:
    """Draw the search for the shortest walk between two nodes of the eight-node graph, step by step.

    On the left stands the graph with the best walk so far, on the right the tree of all walks that the search
    has met. A walk costs its length as it is drawn.

    Parameters
    ----------
    graph : `graphs.notes_example()`, or a part of it.
    start, goal : where the walk begins and ends.
    longest : a walk of so many edges is not expanded.

    Returns
    -------
    A function for `explore`: it takes how many walks the search has taken up, and gives what it moved.

    Examples
    --------
    >>> from mocap import graphs
    >>> search_steps(graphs.notes_example(), 6, 2)(3)[-1].get_text()
    'step 3: 6 → 7 → 8 is expanded'

    Notebook: 07-walks-and-search
    """
    lengths = edge_lengths(graph)
    events = search_events(lengths, start, goal, longest)
    _, (graph_axes, tree_axes) = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
    arrows = eight_node_graph(graph, ax=graph_axes).patches
    _write_lengths(graph_axes, lengths)
    colour_tree = _draw_tree(tree_axes, events)

    def draw(step: int) -> list[Artist]:
        shown = events[:step]
        best = min((e for e in shown if e.fate == "complete"), key=lambda e: e.cost, default=None)
        _highlight(arrows, graph.edges(), best.walk if best else ())
        graph_axes.title.set_text(f"best so far: {best.cost:.2f} long" if best else "no complete walk yet")
        tree_axes.title.set_text(f"step {len(shown)}: {_described(shown[-1])}" if shown else "")
        return [*colour_tree(shown), graph_axes.title, tree_axes.title]

    return draw


def _write_lengths(ax: Axes, lengths: Lengths) -> None:
    """Write the length of each edge beside its middle, and that of a loop above its node."""
    for a, row in lengths.items():
        for b, length in row.items():
            middle = complex(*np.add(EIGHT_PLACES[a], EIGHT_PLACES[b]) / 2)
            position = middle + 0.75j if a == b else middle
            say(ax, position, f"{length:.1f}", bbox=BOX)


def _highlight(arrows: Iterable[Patch], edges: Iterable[tuple[int, int]], walk: Walk) -> None:
    """Draw the edges of a walk thick and orange, and all others as they were."""
    highlighted = [*pairwise(walk)]
    for arrow, edge in zip(arrows, edges, strict=True):
        width = 3 if edge in highlighted else 1.2
        if width != arrow.get_linewidth():
            arrow.set(color=PATH if edge in highlighted else COLOURS["middle"], linewidth=width)


def _described(event: Event) -> str:
    """Return the nodes of a walk, of a long one the first and last, and what happens to it."""
    nodes: tuple[object, ...] = event.walk
    if len(event.walk) >= LONG:
        nodes = (*event.walk[:3], "…", *event.walk[-2:])
    return f"{' → '.join(map(str, nodes))} is {event.fate}"


def _draw_tree(ax: Axes, events: list[Event]) -> Callable[[list[Event]], list[Artist]]:
    """Draw all walks as discs with their last node, each below the walk that it lengthens.

    Returned is a function that shows those met so far, each in the colour of its fate.
    """
    walks = [event.walk for event in events]  # each before those that lengthen it, from left to right
    parents = {walk[:-1] for walk in walks}
    leaves = [walk for walk in walks if walk not in parents]
    columns = {walk: float(column) for column, walk in enumerate(leaves)}
    for walk in reversed([walk for walk in walks if walk in parents]):  # above the middle of its children
        columns[walk] = float(np.mean([columns[child] for child in walks if child[:-1] == walk]))
    faces = FATES | {"waiting": "white"}
    drawn: dict[Walk, tuple[Line2D, Line2D, Text]] = {}
    for walk, x in columns.items():
        y = 1 - len(walk)
        top = y + 1 if len(walk) > 1 else y
        parent_x = columns.get(walk[:-1], x)
        (line,) = ax.plot([parent_x, x], [top, y], linewidth=1.5, zorder=1)
        (dot,) = ax.plot(x, y, "o", markersize=15, zorder=2)
        word = ax.text(x, y, str(walk[-1]), ha="center", va="center", zorder=3)
        drawn[walk] = line, dot, word
    first = min(columns.values())
    last = max(columns.values())
    ax.set(xlim=(first - 0.6, last + 0.6), ylim=(0.5 - max(map(len, columns)), 0.5))
    ax.set_axis_off()
    happening = {"waiting", *(event.fate for event in events)}
    named = {fate: face for fate, face in faces.items() if fate in happening}
    dots = [disc(face, markeredgecolor=FATES[fate]) for fate, face in named.items()]
    ax.legend(dots, named, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=3, frameon=False)

    def colour(shown: list[Event]) -> list[Artist]:
        fates = {walk: "waiting" for event in shown for _, walk in event.added}
        fates |= {event.walk: event.fate for event in shown}
        for walk, (line, dot, word) in drawn.items():
            fate = fates.get(walk, "")
            for part in (line, dot, word):
                part.set_visible(bool(fate))
            line.set_color(FATES.get(fate, QUIET))
            dot.set(color=faces.get(fate, QUIET), markeredgecolor=FATES.get(fate, QUIET))
            word.set_color("black" if fate in {"waiting", "complete"} else "white")
        return [part for parts in drawn.values() for part in parts]

    return colour


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
    lengths: dict[int, dict[int, float]] = {}
    for a in graph:
        successors = sorted(graph.successors(a))
        lengths[a] = {b: dist(EIGHT_PLACES[a], EIGHT_PLACES[b]) or 0.5 for b in successors}
    return lengths


def from_above(
    pieces: Iterable[Points],
    *,
    tried: Iterable[Points] = (),
    goal: complex | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw pieces of a walk on the ground, thick and orange, above what a search tried, thin and grey.

    Parameters
    ----------
    pieces, tried : arrays of ground points z + ix, metres.
    goal : where the walk should lead; a star.
    ax : axes; new ones by default.

    Examples
    --------
    >>> ax = from_above([np.array([0, 1j])], tried=[np.array([0, 1])], goal=1j)
    >>> [len(lines.get_segments()) for lines in ax.collections]
    [1, 1]

    Notebook: 07-walks-and-search
    """
    ax = ax or plt.figure(figsize=(4.6, 4), layout="constrained").add_subplot()
    joined: list[Points] = []
    for piece in pieces:  # those that meet make one line
        meets = joined and abs(piece[0] - joined[-1][-1]) < 0.1
        joined.append(np.concatenate([joined.pop(), piece]) if meets else piece)
    looks = {"tried": (tried, QUIET, 0.5), "walk": (joined, PATH, 3)}
    for name, (lines, colour, width) in looks.items():
        segments = [np.stack([line.imag, line.real], axis=1) for line in lines]
        if segments:
            ax.add_collection(LineCollection(segments, colors=colour, linewidths=width, label=name))
    if goal is not None:
        ax.plot(goal.imag, goal.real, "*", color=ASKED, markersize=16, label="goal")
    ax.autoscale_view()
    return seen_from_above(ax)
