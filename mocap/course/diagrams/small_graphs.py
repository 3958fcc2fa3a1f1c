"""Small graphs, step by step: the homework's segments in rows, and Tarjan's search with its low links."""

from collections.abc import Hashable, Mapping, Sequence
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from mocap._shared.arrays import Array
from mocap.course.diagrams.pens import disc
from mocap.plotting.graph_drawing import node_link
from mocap.plotting.style import MARK, QUIET, SOURCES

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
    _draw_lines(ax, np.array([(at[a], at[b]) for a, b in taken], float).reshape(-1, 2, 2))
    _frame(ax, names, max(x for x, _ in at.values()))
    return figure


def _draw_lines(ax: Axes, ends: Array) -> None:
    """Draw lines from the end of a box to the start of another, (N, 2, 2), from edge to edge."""
    down = np.sign(ends[:, 0, 1] - ends[:, 1, 1])
    leave = ends[:, 0] + np.stack([np.full(len(down), BOX), -GAP * down], axis=1)
    enter = ends[:, 1] + np.stack([np.full(len(down), 0.1), GAP * down], axis=1)
    few = len(ends) < 20
    lines = list(np.stack([leave, enter], axis=1))
    ax.add_collection(LineCollection(lines, colors=MARK, linewidths=1.8 if few else 0.7, zorder=0.5))
    for sign, marker in ((1, "v"), (-1, "^")):
        ax.plot(*enter[down == sign].T, marker, color=MARK, markersize=6 if few else 4, zorder=3)


def _frame(ax: Axes, names: list[str], last: int) -> None:
    ax.set_yticks([-2 * row for row in range(len(names))], names)
    ax.set(xlim=(-0.5, last + 1.5), ylim=(-2 * len(names) + 1, 1), xlabel="segment of the clip, in order")
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(left=False)
    match = Line2D([], [], color=MARK, marker="v", markersize=5, label="a match: may follow")
    dead = Rectangle((0, 0), 1, 1, facecolor=QUIET, edgecolor="black", linewidth=3, label="nothing follows")
    ax.legend(
        handles=[match, dead], ncols=2, loc="lower right", bbox_to_anchor=(1, 1), fontsize=8, frameon=False
    )


Node = Hashable

EIGHT_PLACES: dict[Node, tuple[float, float]] = {
    **{1: (0, 1), 2: (1, 2), 3: (1, 0), 4: (-0.2, -0.6)},
    **{5: (3.6, 2.4), 6: (2.2, 2), 7: (3, 1), 8: (2.2, 0)},
}
"""Where the nodes of `graphs.notes_example` stand in the pictures of the course."""

ON_STACK, UNSEEN = "#F3E9B8", "#FFFFFF"


class SearchState(NamedTuple):
    """What Tarjan's algorithm knows after a step.

    message : what it has just done.
    node : where it stands.
    number, low : the index and the low link of each node that it has seen.
    stack : the nodes seen whose component is not complete, the oldest first.
    components : those that are complete, in this order.
    """

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
    index, low = dict[Node, int](), dict[Node, int]()
    stack: list[Node] = []
    components: list[set[Node]] = []
    states: list[SearchState] = []

    def note(message: str, node: Node) -> None:
        states.append(SearchState(message, node, dict(index), dict(low), list(stack), list(components)))

    def visit(node: Node) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        note(f"enter {node}", node)
        for child in successors[node]:
            if child not in index:
                visit(child)
                low[node] = min(low[node], low[child])
                note(f"back in {node} from {child}", node)
            elif child in stack:
                low[node] = min(low[node], index[child])
                note(f"{node} → {child} closes a cycle", node)
        if low[node] == index[node]:
            at = stack.index(node)
            components.append(set(stack[at:]))
            del stack[at:]
            note(f"{node} is the first of its component", node)

    for node in successors:
        if node not in index:
            visit(node)
    return states


def tarjan_step(
    graph: nx.MultiDiGraph, *, places: Mapping[Node, tuple[float, float]] = EIGHT_PLACES, step: int = 0
) -> Figure:
    """Draw Tarjan's algorithm on a small graph after some of its steps.

    Beside each node stand its index and its low link; the stack stands on the right. The search begins at the
    first node and takes successors in the order of their names.

    Parameters
    ----------
    graph : the graph.
    places : where to put the nodes; by default those of the eight-node example.
    step : the number of steps, from 0 on; the last one where it is too large.

    Examples
    --------
    >>> from mocap import graphs
    >>> figure = tarjan_step(graphs.notes_example(), step=15)
    >>> figure.axes[0].get_title()
    'step 15: 8 → 3 closes a cycle'

    Notebook: 06-pruning
    """
    states = tarjan_states({node: sorted(graph.successors(node)) for node in sorted(graph)})
    step = min(step, len(states) - 1)
    state = states[step]
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.5, 4.4), layout="constrained", width_ratios=(5, 1))
    discs, _ = node_link(graph, places=places, ax=left)
    done = {node: SOURCES[n] for n, part in enumerate(state.components) for node in part}
    discs.set_facecolor([done.get(n, ON_STACK if n in state.stack else UNSEEN) for n in graph])
    discs.set_linewidth([4 if node == state.node else 1 for node in graph])
    for name, node in zip(left.texts, graph, strict=True):
        name.set_color("white" if node in done else "black")
    _write_numbers(left, state, places)
    left.set_title(f"step {step}: {state.message}", fontsize=11)
    left.margins(0.12)
    _legend(left, len(state.components))
    _draw_stack(right, state.stack, len(graph))
    return figure


def _write_numbers(ax: Axes, state: SearchState, places: Mapping[Node, tuple[float, float]]) -> None:
    """Write the index and the low link beside each node that the search has seen."""
    for node in state.number:
        x, y = places[node]
        numbers = ax.text(x + 0.2, y - 0.36, f"{state.number[node]} / {state.low[node]}", fontsize=9)
        numbers.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8})


def _legend(ax: Axes, components: int) -> None:
    faces = {"not seen yet": UNSEEN, "on the stack": ON_STACK}
    faces |= {f"component {n + 1}, complete": SOURCES[n] for n in range(components)}
    look: dict[str, Any] = {"markersize": 9, "markeredgecolor": "black"}
    discs = [disc(face, label=name, **look) for name, face in faces.items()]
    discs.append(disc("white", label="the search stands here", markeredgewidth=3, **look))
    where: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "ncols": 3}
    words: dict[str, Any] = {"title": "beside a node: index / low link", "title_fontsize": 9, "fontsize": 8}
    ax.legend(handles=discs, frameon=False, **where, **words)


def _draw_stack(ax: Axes, stack: Sequence[Node], most: int) -> None:
    """Draw the stack as boxes, the oldest node at the bottom."""
    for at, node in enumerate(stack):
        ax.barh(at, 1, height=0.9, color=ON_STACK, edgecolor="black", linewidth=0.8)
        ax.text(0.5, at, str(node), ha="center", va="center", fontsize=10)
    ax.set(xlim=(-0.3, 1.3), ylim=(-0.8, most), xticks=[], yticks=[])
    ax.set_title("stack" if stack else "stack: empty", fontsize=10)
    ax.spines[["top", "left", "right"]].set_visible(False)
    ax.spines["bottom"].set_color(QUIET)
