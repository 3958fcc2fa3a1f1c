"""Small graphs: nodes and edges on two clips, and Tarjan's search on the eight nodes of Figure 4 [KGP02]."""

from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from itertools import cycle, pairwise
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import networkx as nx
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from mocap.course.diagrams.pens import arrow, disc, say, show_program
from mocap.plotting import COLOURS, MARK, PATH, QUIET, SOURCES, node_link

Leap = tuple[int, float, int, float]

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
MATCHED = 1  # the step that draws a match
PRUNED = 4  # the step from which pieces are grey
WALKED = 5  # the step that draws a walk
SELF_BEND = 0.28  # of the arrow of a transition into its own clip
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

    Notebook: 05-motion-graph
    """
    figure, ax = plt.subplots(figsize=(7, 3), layout="constrained")
    leaps = LEAPS[: (0, 0, 1, 3, 3, 3)[step]]
    for clip in range(len(LENGTHS)):
        _draw_clip(ax, clip, leaps, is_pruned=step >= PRUNED)
    if step == MATCHED:
        _draw_match(ax)
    if step == WALKED:
        _draw_walk(ax)
    for source, leaves, target, enters in leaps:
        bend = SELF_BEND if source == target else 0
        look: dict[str, Any] = {"connectionstyle": f"arc3,rad={bend}", "shrinkA": 6, "shrinkB": 6}
        colour = PATH if step == WALKED else MARK
        arrow(ax, leaves - 1j * source, enters - 1j * target, colour, **look).set_zorder(3)
    ax.set_title(STEPS[step], fontsize=10, loc="left")
    ax.set(xlabel="time in the clip (s)", xlim=(-0.2, 6.2), ylim=(-1.75, 0.95))
    ax.set_yticks([0, -1], ["clip A", "clip B"])
    ax.tick_params(left=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    return figure


def _draw_clip(ax: Axes, clip: int, leaps: Sequence[Leap], *, is_pruned: bool) -> None:
    """Draw a clip as a bar, cut by nodes; if it is pruned, its ends are grey."""
    length = LENGTHS[clip]
    nodes = {leaves for source, leaves, _, _ in leaps if source == clip}
    nodes |= {enters for _, _, target, enters in leaps if target == clip}
    times = sorted({0.0, length} | nodes)
    for start, end in pairwise(times):
        is_kept = not is_pruned or 0 < start < end < length
        colour = SOURCES[clip] if is_kept else "#DDDDDD"
        ax.plot([start, end], [-clip] * 2, color=colour, linewidth=9, solid_capstyle="butt", zorder=1)
    for time in times:
        edge = COLOURS["middle"] if not is_pruned or time in nodes else QUIET
        ax.plot(time, -clip, "o", color="white", markeredgecolor=edge, markersize=9, zorder=4)


def _draw_match(ax: Axes) -> None:
    """Draw two windows in which both clips do nearly the same."""
    for clip, start, height in MATCH:
        ax.plot([start, start + 0.33], [-clip] * 2, color=MARK, linewidth=17, solid_capstyle="butt", zorder=2)
        ax.text(start + 0.16, height, "window", ha="center", color=COLOURS["middle"])


def _draw_walk(ax: Axes) -> None:
    """Draw the edges of a walk as numbered arrows."""
    for number, (height, start, end) in enumerate(WALK, 1):
        arrow(ax, start + 1j * height, end + 1j * height, PATH, 2.2, shrinkA=2, shrinkB=2)
        say(ax, start - 0.12 + 1j * height, str(number))


Node = Hashable
EIGHT_X = (0.0, 1.0, 1.0, -0.2, 3.6, 2.2, 3.0, 2.2)  # of the nodes 1 to 8
EIGHT_Y = (1.0, 2.0, 0.0, -0.6, 2.4, 2.0, 1.0, 0.0)
EIGHT_PLACES: dict[Node, tuple[float, float]] = dict(enumerate(zip(EIGHT_X, EIGHT_Y, strict=True), 1))
"""Where the nodes of `graphs.notes_example` stand in the pictures of the course."""

ON_STACK = "#F3E9B8"  # the colour of nodes
UNSEEN = "#FFFFFF"  # the colour of nodes
BOX = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85}


PROGRAM = """visit(node):
    number it, put it on the stack
    for each successor:
        if it is new:
            visit it, take over its low link
        if it is on the stack:
            take over its number
        if it has left the stack:
            nothing
    if low link = number:
        a component is complete: take it off""".splitlines()
"""Tarjan's visit to a node; the pictures mark the line that has just run."""


class SearchState(NamedTuple):
    """The state of Tarjan's algorithm after a step.

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
    number: dict[Node, int] = {}
    low: dict[Node, int] = {}
    stack: list[Node] = []
    components: list[set[Node]] = []
    states: list[SearchState] = []

    def note(line: int, message: str, node: Node) -> None:
        states.append(SearchState(line, message, node, dict(number), dict(low), [*stack], [*components]))

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
                note(8, f"{child} has left the stack", node)
        if low[node] == number[node]:
            first = stack.index(node)
            components.append(set(stack[first:]))
            del stack[first:]
            note(10, f"{node} is the first of its component", node)

    for node in successors:
        if node not in number:
            visit(node)
    return states


# reads: name: notebooks use `beside`
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
    discs, arrows = node_link(graph, positions=EIGHT_PLACES, ax=ax)
    colour = {node: SOURCES[n % len(SOURCES)] for n, part in enumerate(parts) for node in part}
    discs.set_facecolor([colour.get(node, UNSEEN) for node in graph])
    discs.set_edgecolor("black")
    for name, node in zip(ax.texts, graph, strict=True):
        name.set_color("white" if node in colour else "black")
    for node, words in (beside or {}).items():
        position = complex(*EIGHT_PLACES[node]) + 0.2 - 0.36j
        say(ax, position, str(words), ha="left", bbox=BOX)
    for drawn, edge in zip(arrows, graph.edges(), strict=True):
        if edge in thick:
            drawn.set(color=PATH, linewidth=3)
    ax.margins(0.12)
    return ax


def tarjan_steps(graph: nx.MultiDiGraph) -> Callable[[int], list[Artist]]:
    """Draw Tarjan's algorithm on the eight-node graph, step by step.

    Beside each node stand its number and low link, on the right the stack, and the line that has just run.

    Parameters
    ----------
    graph : the graph, or one with the same nodes.

    Returns
    -------
    A function for `explore`: it takes the number of steps, from 0 on, and gives what it moved; the last step
    where there are no more.

    Examples
    --------
    >>> from mocap import graphs
    >>> tarjan_steps(graphs.notes_example())(16)[-1].get_text()
    'step 16: 8 → 3 closes a cycle'

    Notebook: 06-pruning
    """
    states = tarjan_states({node: sorted(graph.successors(node)) for node in sorted(graph)})
    figure, (graph_axes, stack_axes, code) = plt.subplots(1, 3, figsize=(11, 4.4), width_ratios=(9, 2, 12))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.93, bottom=0.23, wspace=0.04)
    eight_node_graph(graph, beside=dict.fromkeys(graph, ""), ax=graph_axes)
    discs = graph_axes.collections[0]
    names = graph_axes.texts[: len(graph)]
    numbers = graph_axes.texts[len(graph) :]
    boxes, words = _draw_stack(stack_axes, len(graph))
    mark = show_program(code, PROGRAM, 0)
    _explain(figure, len(states[-1].components))

    def draw(step: int) -> list[Artist]:
        state = states[min(step, len(states) - 1)]
        coloured = zip(state.components, cycle(SOURCES), strict=False)
        parts = {node: colour for part, colour in coloured for node in part}
        face = dict.fromkeys(graph, UNSEEN) | dict.fromkeys(state.stack, ON_STACK) | parts
        discs.set(facecolor=[face[node] for node in graph])
        discs.set(linewidth=[4 if node == state.node else 1 for node in graph])
        for node, name, links in zip(graph, names, numbers, strict=True):
            name.set_color("white" if node in parts else "black")
            links.set_text(f"{state.number[node]} / {state.low[node]}" if node in state.number else "")
        _fill_stack(boxes, words, state.stack)
        stack_axes.title.set_text("stack" if state.stack else "empty")
        graph_axes.title.set_text(f"step {states.index(state)}: {state.message}")
        mark.set_y(state.line - 0.5)
        return [discs, *names, *numbers, *boxes, *words, mark, stack_axes.title, graph_axes.title]

    return draw


def _fill_stack(boxes: Sequence[Rectangle], words: Sequence[Text], stack: Sequence[Node]) -> None:
    """Show the nodes of the stack in its boxes."""
    for place, (box, word) in enumerate(zip(boxes, words, strict=True)):
        box.set_visible(place < len(stack))
        word.set_text("".join(map(str, stack[place : place + 1])))


def _draw_stack(ax: Axes, height: int) -> tuple[list[Rectangle], list[Text]]:
    """Draw the stack as boxes with words, the oldest node at the bottom."""
    ax.set(xlim=(-0.3, 1.3), ylim=(-0.8, height), xticks=[], yticks=[])
    ax.spines[["top", "left", "right"]].set_visible(False)
    ax.spines["bottom"].set_color(QUIET)
    boxes = ax.barh(range(height), 1, height=0.9, color=ON_STACK, edgecolor="black", linewidth=0.8)
    words = [ax.text(0.5, place, "", ha="center", va="center") for place in range(height)]
    return [*boxes], words


def _explain(figure: Figure, parts: int) -> None:
    """Write what the colours of the nodes mean."""
    named = {"not seen yet": UNSEEN, "on the stack": ON_STACK}
    named |= {f"component {n + 1}, complete": SOURCES[n % len(SOURCES)] for n in range(parts)}
    look: dict[str, Any] = {"markersize": 9, "markeredgecolor": "black"}
    keys = [disc(face, label=name, **look) for name, face in named.items()]
    keys.append(disc("white", label="the search stands here", markeredgewidth=3, **look))
    title = "beside a node: number / low link"
    figure.legend(handles=keys, title=title, frameon=False, loc="lower left", ncols=3, alignment="left")
