"""Notebook 06: inputs, right answers and mistakes of `tarjan` and `component_to_keep`."""

from collections import Counter
from typing import Any

import networkx as nx
import numpy as np

from mocap.course.checks.answers.common import Arguments, draw_graph
from mocap.plain import components

Successors = dict[int, list[int]]


class Search:
    """Tarjan's search, with what students forget in it.

    Parameters
    ----------
    successors : the nodes to which the edges of each node lead.
    finished_count : nodes whose component is complete count, too.
    passes_low : a node takes over the low link of the next one.
    is_whole : a component has all nodes from its first one on.
    """

    def __init__(
        self,
        successors: Successors,
        *,
        finished_count: bool = False,
        passes_low: bool = True,
        is_whole: bool = True,
    ) -> None:
        self.successors = successors
        self.finished_count = finished_count
        self.passes_low = passes_low
        self.is_whole = is_whole
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
                self.low[node] = min(self.low[node], self.number[successor])
        return complete + self.leave(node)

    def leave(self, node: int) -> list[set[int]]:
        """Return the component whose first node this is, if it is one."""
        if self.low[node] != self.number[node]:
            return []
        first = self.waiting.index(node)
        component = set(self.waiting[first:]) if self.is_whole else {node}
        del self.waiting[first:]
        return [component]


# ---- tarjan


def draw_tarjan(rng: np.random.Generator) -> Arguments:
    return (draw_graph(rng),)


def right_tarjan(successors: Successors) -> list[set[int]]:
    return components(nx.DiGraph(successors))  # type: ignore[return-value]  # of any nodes


def same_tarjan(answer: Any, wanted: list[set[int]]) -> bool:  # noqa: ANN401
    return Counter(map(frozenset, answer)) == Counter(map(frozenset, wanted))


def mistake_all_visited(successors: Successors) -> object:
    return Search(successors, finished_count=True).components()


def mistake_low_not_passed(successors: Successors) -> object:
    return Search(successors, passes_low=False).components()


def mistake_single_node(successors: Successors) -> object:
    return Search(successors, is_whole=False).components()


def mistake_single_nodes(successors: Successors) -> object:
    return [{node} for node in successors]


def mistake_undirected(successors: Successors) -> object:
    return [set(part) for part in nx.connected_components(nx.DiGraph(successors).to_undirected())]


def mistake_no_component(successors: Successors) -> object:
    return []


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
    return max(components, key=lambda part: sum(f for a, b, f in edges if {a, b} <= part))


def mistake_nodes_counted(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    return max(components, key=len)


def mistake_leaving_edges(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    return max(components, key=lambda part: sum(f for a, b, f in edges if a in part))


def mistake_entering_edges(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    return max(components, key=lambda part: sum(f for a, b, f in edges if b in part))


def mistake_edges_counted(components: list[set[int]], edges: list[tuple[int, int, int]]) -> object:
    return max(components, key=lambda part: sum(1 for a, b, f in edges if {a, b} <= part))
