"""Notebook 06: inputs, right answers and mistakes of `tarjan` and `component_to_keep`."""

from collections import Counter
from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np

from mocap.course.checks.answers.common import Arguments, draw_graph
from mocap.plain import components

Successors = dict[int, list[int]]


Lowered = Callable[[int, int], int]
"""From a node's low link, and the number of a successor on the stack, to its new low link."""

Taken = Callable[[list[int], int, int], tuple[list[int], list[int]]]
"""From the stack, the place of a component's first node and its number to the component and the rest."""


def from_first(stack: list[int], first: int, _: int) -> tuple[list[int], list[int]]:
    """Take the nodes from the first one on, as is right."""
    return stack[first:], stack[:first]


def first_alone(stack: list[int], first: int, _: int) -> tuple[list[int], list[int]]:
    """Take the nodes from the first one on, and call the first one the component."""
    return stack[first : first + 1], stack[:first]


def itself(stack: list[int], first: int, _: int) -> tuple[list[int], list[int]]:
    """Take the first node, from the middle of the stack."""
    return stack[first : first + 1], stack[:first] + stack[first + 1 :]


def whole(stack: list[int], *_: int) -> tuple[list[int], list[int]]:
    """Take all nodes."""
    return stack, []


def nothing(stack: list[int], first: int, _: int) -> tuple[list[int], list[int]]:
    """Leave the component on the stack."""
    return stack[first:], stack


def all_but_first(stack: list[int], first: int, _: int) -> tuple[list[int], list[int]]:
    """Take the nodes from the first one on, and leave it out of the component."""
    return stack[first + 1 :], stack[:first]


def last(stack: list[int], *_: int) -> tuple[list[int], list[int]]:
    """Take one node."""
    return stack[-1:], stack[:-1]


def by_number(stack: list[int], _: int, number: int) -> tuple[list[int], list[int]]:
    """Take the number of a node for its place on the stack."""
    return stack[number:], stack[:number]


class Search:
    """Tarjan's search, with what students forget in it.

    Parameters
    ----------
    successors : the nodes to which the edges of each node lead.
    finished_count : nodes whose component is complete count, too.
    passes_low : a node takes over the low link of the next one.
    lowered : the new low link of a node with an edge to a node on the stack.
    takes : what is taken off the stack.
    """

    def __init__(
        self,
        successors: Successors,
        *,
        finished_count: bool = False,
        passes_low: bool = True,
        lowered: Lowered = min,
        takes: Taken = from_first,
    ) -> None:
        self.successors = successors
        self.finished_count = finished_count
        self.passes_low = passes_low
        self.lowered = lowered
        self.takes = takes
        self.number: dict[int, int] = {}
        self.low: dict[int, int] = {}
        self.waiting: list[int] = []

    def components(self) -> list[set[int]]:
        """Return the components."""
        return [part for node in self.successors if node not in self.number for part in self.visit(node)]

    def visit(self, node: int) -> list[set[int]]:
        """Return the components that are complete after a node and those that follow it."""
        complete = []
        self.number[node] = self.low[node] = len(self.number)
        self.waiting.append(node)
        for successor in self.successors[node]:
            if successor not in self.number:
                complete += self.visit(successor)
                if self.passes_low:
                    self.low[node] = min(self.low[node], self.low[successor])
            elif self.finished_count or successor in self.waiting:
                self.low[node] = self.lowered(self.low[node], self.number[successor])
        return complete + self.leave(node)

    def leave(self, node: int) -> list[set[int]]:
        """Return the component whose first node this is, if it is one."""
        if self.low[node] != self.number[node]:
            return []
        first = self.waiting.index(node) if node in self.waiting else len(self.waiting)
        component, self.waiting = self.takes(self.waiting, first, self.number[node])
        return [set(component)]


# ---- tarjan


def draw_tarjan(rng: np.random.Generator) -> Arguments:
    """Draw a graph as the successors of each node."""
    return (draw_graph(rng),)


def right_tarjan(successors: Successors) -> list[set[int]]:
    """Return the strongly connected components."""
    return components(nx.DiGraph(successors))  # type: ignore[return-value]  # of any nodes


def same_tarjan(answer: Any, wanted: list[set[int]]) -> bool:  # noqa: ANN401
    """Check whether two lists contain the same components, in any order."""
    if wanted and not isinstance(wanted[0], set):  # what a mistake returns
        return Counter(answer) == Counter(wanted)
    return Counter(map(frozenset, answer)) == Counter(map(frozenset, wanted))


def mistake_all_visited(successors: Successors) -> object:
    """Lower low links also by edges to nodes whose component is complete."""
    return Search(successors, finished_count=True).components()


def mistake_low_not_passed(successors: Successors) -> object:
    """Never lower a node's low link to that of a child."""
    return Search(successors, passes_low=False).components()


def mistake_single_node(successors: Successors) -> object:
    """Return the first node of each component, and drop the others with it from the stack."""
    return Search(successors, takes=first_alone).components()


def mistake_single_nodes(successors: Successors) -> object:
    """Return each node as a component of its own."""
    return [{node} for node in successors]


def mistake_undirected(successors: Successors) -> object:
    """Return the weakly connected components."""
    return [set(part) for part in nx.connected_components(nx.DiGraph(successors).to_undirected())]


def mistake_no_component(successors: Successors) -> object:
    """Return an empty list."""
    return []


def mistake_removed_alone(successors: Successors) -> object:
    """Take the first node of a component alone off the stack, and leave those above it there."""
    return Search(successors, takes=itself).components()


def mistake_whole_stack(successors: Successors) -> object:
    """Take all nodes off the stack for each component, also those below its first node."""
    return Search(successors, takes=whole).components()


def mistake_not_popped(successors: Successors) -> object:
    """Return each component, and leave its nodes on the stack, as if it were not complete."""
    return Search(successors, takes=nothing).components()


def mistake_first_node_missing(successors: Successors) -> object:
    """Return each component without its first node."""
    return Search(successors, takes=all_but_first).components()


def mistake_last_node_alone(successors: Successors) -> object:
    """Take the top node alone off the stack as a component."""
    return Search(successors, takes=last).components()


def mistake_stack_cut_by_number(successors: Successors) -> object:
    """Cut the stack at the number of the first node instead of at its position."""
    return Search(successors, takes=by_number).components()


def mistake_low_assigned(successors: Successors) -> object:
    """Set a node's low link to the number of each successor on the stack, even if that is higher."""
    return Search(successors, lowered=lambda _, number: number).components()


def mistake_nodes_not_in_sets(successors: Successors) -> object:
    """Return the nodes of all components in one list."""
    return [node for part in right_tarjan(successors) for node in part]


def mistake_largest_alone(successors: Successors) -> object:
    """Return a list of one component, that of most nodes."""
    return [max(right_tarjan(successors), key=len)]


# ---- component_to_keep


def draw_component_to_keep(rng: np.random.Generator) -> Arguments:
    """Draw the components of a graph, and its edges with the frames that they play."""
    parts: list[set[int]] = []
    edges: list[tuple[int, int, int]] = []
    while not any({a, b} <= part for a, b, _ in edges for part in parts):
        graph = nx.DiGraph(draw_graph(rng))
        parts = list(nx.strongly_connected_components(graph))
        edges = [(a, b, int(rng.integers(5, 400))) for a, b in graph.edges]
    return parts, edges


def right_component_to_keep(components: list[set[int]], edges: list[tuple[int, int, int]]) -> set[int]:
    """Return the component whose inner edges have the most frames."""
    return max(components, key=lambda part: sum(f for a, b, f in edges if {a, b} <= part))


def mistake_nodes_counted(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component with the most nodes."""
    return max(components, key=len)


def mistake_leaving_edges(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component with the most frames on the edges that start in it."""
    return max(components, key=lambda part: sum(f for a, b, f in edges if a in part))


def mistake_entering_edges(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component with the most frames on the edges that end in it."""
    return max(components, key=lambda part: sum(f for a, b, f in edges if b in part))


def mistake_edges_counted(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component with the most inner edges."""
    return max(components, key=lambda part: sum(1 for a, b, f in edges if {a, b} <= part))


def mistake_frames_themselves(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the number of frames of the right component's inner edges."""
    part = right_component_to_keep(components, edges)
    return sum(f for a, b, f in edges if {a, b} <= part)


def mistake_index_of_component(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the index of the right component in the list."""
    return components.index(right_component_to_keep(components, edges))


def mistake_either_end(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component with the most frames on the edges that start or end in it."""
    return max(components, key=lambda part: sum(f for a, b, f in edges if {a, b} & part))


def mistake_longest_edge(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component that has the inner edge of most frames."""
    return max(components, key=lambda part: max((f for a, b, f in edges if {a, b} <= part), default=0))


def mistake_fewest_frames(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the component whose inner edges have the fewest frames."""
    return min(components, key=lambda part: sum(f for a, b, f in edges if {a, b} <= part))


def mistake_all_but_the_best(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    """Return the list of all components except the right one."""
    best = right_component_to_keep(components, edges)
    return [part for part in components if part is not best]
