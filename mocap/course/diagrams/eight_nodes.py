"""Searches on eight nodes, step by step: Tarjan's with its low links, and branch and bound [KGP02, 4.2]."""

from collections.abc import Collection, Hashable, Mapping, Sequence
from itertools import count, pairwise
from math import dist, inf
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap.course.diagrams.pens import disc, say, show_program
from mocap.plotting import CURVES, PATH, QUIET, SOURCES, node_link

Node = Hashable
EIGHT_PLACES: dict[Node, tuple[float, float]] = {
    **{1: (0, 1), 2: (1, 2), 3: (1, 0), 4: (-0.2, -0.6)},
    **{5: (3.6, 2.4), 6: (2.2, 2), 7: (3, 1), 8: (2.2, 0)},
}
"""Where the nodes of `graphs.notes_example` stand in the pictures of the course."""

ON_STACK, UNSEEN = "#F3E9B8", "#FFFFFF"
BOX = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85}


PROGRAM = """visit(node):
    give it the next number, put it on the stack
    for each successor:
        if it is new:
            visit it, then take over its low link
        if it is on the stack:
            take over its number
        if it has left the stack:
            nothing
    if low link = number:
        a component is complete: take it off""".splitlines()
"""Tarjan's visit to a node; the pictures mark the line that has just run."""


class SearchState(NamedTuple):
    """What Tarjan's algorithm knows after a step.

    line : the number of the line of `PROGRAM` that has just run.
    message : what it has just done.
    node : where it stands.
    number, low : the number and the low link of each node that it has seen.
    stack : the nodes seen whose component is not complete, the oldest first.
    components : those that are complete, in this order.
    """

    line: int
    message: str
    node: Node
    number: dict[Node, int]
    low: dict[Node, int]
    stack: list[Node]
    components: list[set[Node]]


def tarjan_states(successors: Mapping[Node, Sequence[Node]]) -> list[SearchState]:
    """Run Tarjan's algorithm on a graph, and keep its state after each step.

    Parameters
    ----------
    successors : for each node those that its edges lead to; the search takes them in this order.

    Examples
    --------
    >>> states = tarjan_states({1: [2], 2: [1, 3], 3: []})
    >>> states[-1].components
    [{3}, {1, 2}]
    >>> [state.message for state in states][:3]
    ['enter 1', 'enter 2', '2 → 1 closes a cycle']

    Notebook: 06-pruning
    """
    number, low = dict[Node, int](), dict[Node, int]()
    stack: list[Node] = []
    components: list[set[Node]] = []
    states: list[SearchState] = []

    def note(line: int, message: str, node: Node) -> None:
        known = dict(number), dict(low), list(stack), list(components)
        states.append(SearchState(line, message, node, *known))

    def visit(node: Node) -> None:
        number[node] = low[node] = len(number)
        stack.append(node)
        note(1, f"enter {node}", node)
        for child in successors[node]:
            if child not in number:
                visit(child)
                low[node] = min(low[node], low[child])
                note(4, f"back in {node} from {child}", node)
            elif child in stack:
                low[node] = min(low[node], number[child])
                note(6, f"{node} → {child} closes a cycle", node)
            else:
                note(8, f"{node} → {child} leads to a complete component", node)
        if low[node] == number[node]:
            at = stack.index(node)
            components.append(set(stack[at:]))
            del stack[at:]
            note(10, f"{node} is the first of its component", node)

    for node in successors:
        if node not in number:
            visit(node)
    return states


def eight_node_graph(
    graph: nx.MultiDiGraph,
    *,
    beside: Mapping[Node, object] | None = None,
    thick: Collection[tuple[Node, Node]] = (),
    parts: Sequence[Collection[Node]] = (),
    ax: Axes | None = None,
) -> Axes:
    """Draw the eight-node graph, or a part of it.

    Parameters
    ----------
    graph : the graph.
    beside : what to write beside nodes.
    thick : edges (start, end) to draw thick and orange.
    parts : sets of nodes, each of which gets a colour; other nodes stay white.
    ax : axes; new ones by default.

    Examples
    --------
    >>> from mocap import graphs, plotting
    >>> ax = eight_node_graph(graphs.notes_example(), beside={1: "first"}, parts=[{4}, {5}])
    >>> plotting.show(ax, alt="Eight nodes, of which 4 and 5 are coloured.")
    Picture('Eight nodes, of which 4 and 5 are coloured.')

    Notebook: 06-pruning
    """
    ax = ax or plt.figure(figsize=(4.8, 3.5), layout="constrained").add_subplot()
    discs, arrows = node_link(graph, places=EIGHT_PLACES, ax=ax)
    colour = {node: SOURCES[n % len(SOURCES)] for n, part in enumerate(parts) for node in part}
    discs.set_facecolor([colour.get(node, UNSEEN) for node in graph])
    discs.set_edgecolor("black")
    for name, node in zip(ax.texts, graph, strict=True):
        name.set_color("white" if node in colour else "black")
    for node, words in (beside or {}).items():
        at = complex(*EIGHT_PLACES[node]) + 0.2 - 0.36j
        say(ax, at, str(words), fontsize=9, ha="left", bbox=BOX)
    for arrow, edge in zip(arrows, graph.edges(), strict=True):
        if edge in thick:
            arrow.set(color=PATH, linewidth=3)
    ax.margins(0.12)
    return ax


def tarjan_step(graph: nx.MultiDiGraph, *, step: int = 0) -> Figure:
    """Draw Tarjan's algorithm on the eight-node graph after some of its steps.

    Beside each node stand its number and low link, on the right the stack, and the line that has just run.

    Parameters
    ----------
    graph : the graph, or one with the same nodes.
    step : the number of steps, from 0 on; the last one where it is too large.

    Examples
    --------
    >>> from mocap import graphs
    >>> figure = tarjan_step(graphs.notes_example(), step=16)
    >>> figure.axes[0].get_title()
    'step 16: 8 → 3 closes a cycle'

    Notebook: 06-pruning
    """
    states = tarjan_states({node: sorted(graph.successors(node)) for node in sorted(graph)})
    step = min(step, len(states) - 1)
    state = states[step]
    figure, (left, right, code) = plt.subplots(
        1, 3, figsize=(11, 4.4), layout="constrained", width_ratios=(5, 1, 5)
    )
    beside = {node: f"{number} / {state.low[node]}" for node, number in state.number.items()}
    eight_node_graph(graph, beside=beside, parts=state.components, ax=left)
    discs = left.collections[0]
    faces = zip(graph, discs.get_facecolors(), strict=True)
    discs.set_facecolor([ON_STACK if node in state.stack else face for node, face in faces])
    discs.set_linewidth([4 if node == state.node else 1 for node in graph])
    left.set_title(f"step {step}: {state.message}", fontsize=11)
    named = {"not seen yet": UNSEEN, "on the stack": ON_STACK}
    named |= {f"component {n + 1}, complete": SOURCES[n] for n in range(len(state.components))}
    look: dict[str, Any] = {"markersize": 9, "markeredgecolor": "black"}
    keys = [disc(face, label=name, **look) for name, face in named.items()]
    keys.append(disc("white", label="the search stands here", markeredgewidth=3, **look))
    where: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "ncols": 3}
    words: dict[str, Any] = {"title": "beside a node: number / low link", "title_fontsize": 9, "fontsize": 8}
    left.legend(handles=keys, frameon=False, **where, **words)
    _draw_stack(right, state.stack, len(graph))
    show_program(code, PROGRAM, state.line)
    return figure


def _draw_stack(ax: Axes, stack: Sequence[Node], most: int) -> None:
    """Draw the stack as boxes, the oldest node at the bottom."""
    for at, node in enumerate(stack):
        ax.barh(at, 1, height=0.9, color=ON_STACK, edgecolor="black", linewidth=0.8)
        ax.text(0.5, at, str(node), ha="center", va="center", fontsize=10)
    ax.set(xlim=(-0.3, 1.3), ylim=(-0.8, most), xticks=[], yticks=[])
    ax.set_title("stack" if stack else "stack: empty", fontsize=10)
    ax.spines[["top", "left", "right"]].set_visible(False)
    ax.spines["bottom"].set_color(QUIET)


Walk = tuple[int, ...]
Lengths = Mapping[int, Mapping[int, float]]  # lengths[a][b] is that of the edge from a to b

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
    lengths = edge_lengths(graph)
    events = search_events(lengths, start, goal, longest)
    shown = events[: len(events) if step is None else step]
    best = min((e for e in shown if e.fate == "complete"), key=lambda e: e.cost, default=None)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
    eight_node_graph(graph, thick=[*pairwise(best.walk if best else ())], ax=left)
    for a, row in lengths.items():
        for b, length in row.items():
            middle = complex(*np.add(EIGHT_PLACES[a], EIGHT_PLACES[b]) / 2) + 0.75j * (a == b)
            say(left, middle, f"{length:.1f}", fontsize=8, bbox=BOX)
    left.set_title(f"best so far: {best.cost:.2f} long" if best else "no complete walk yet", fontsize=10)
    _draw_tree(right, events, shown)
    if shown:
        named = " → ".join(map(str, shown[-1].walk))
        right.set_title(f"step {len(shown)}: {named} is {shown[-1].fate}", fontsize=10)
    return figure


def _draw_tree(ax: Axes, events: list[Event], shown: list[Event]) -> None:
    """Draw the walks met so far as discs with their last node, each below the walk that it lengthens."""
    children = {event.walk: [walk for _, walk in sorted(event.added)] for event in events}
    columns: dict[Walk, float] = {}  # a leaf of the whole tree has its own, other walks the middle of theirs
    leaves = count(1)

    def place(walk: Walk) -> float:
        below = [place(child) for child in children.get(walk, ())]
        columns[walk] = sum(below) / len(below) if below else float(next(leaves))
        return columns[walk]

    place(events[0].walk)
    fates = {walk: "waiting" for event in shown for _, walk in event.added} | {e.walk: e.fate for e in shown}
    faces = FATES | {"waiting": "white"}
    for walk, fate in fates.items():
        x, y = columns[walk], 1 - len(walk)
        if len(walk) > 1:
            ax.plot([columns[walk[:-1]], x], [y + 1, y], color=FATES[fate], linewidth=1.5, zorder=1)
        ax.plot(x, y, "o", markersize=15, color=faces[fate], markeredgecolor=FATES[fate], zorder=2)
        ink = "black" if fate in {"waiting", "complete"} else "white"
        ax.text(x, y, str(walk[-1]), color=ink, ha="center", va="center", fontsize=9, zorder=3)
    ends = min(columns.values()), max(columns.values())
    ax.set(xlim=(ends[0] - 0.6, ends[1] + 0.6), ylim=(0.5 - max(map(len, columns)), 0.5))
    ax.set_axis_off()
    dots = [disc(face, markeredgecolor=FATES[fate]) for fate, face in faces.items()]
    ax.legend(dots, FATES, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=3, frameon=False, fontsize=8)


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
