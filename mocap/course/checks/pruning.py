"""Checks of notebook 06. A graph is {node: the nodes that its edges lead to}."""

from collections.abc import Iterable, Mapping

import networkx as nx
import numpy as np

from mocap.course.check import Check, Mistake

Successors = dict[int, list[int]]


def _graph(rng: np.random.Generator) -> Successors:
    count = int(rng.integers(3, 9))
    joined = rng.random((count, count)) < 1.2 / count
    return {node + 1: (np.flatnonzero(row) + 1).tolist() for node, row in enumerate(joined)}


def _digraph(successors: Mapping[int, Iterable[int]]) -> nx.DiGraph:
    return nx.DiGraph({node: list(ends) for node, ends in successors.items()})


def _after(successors: Successors, start: int) -> set[int]:
    return {int(node) for node in nx.descendants(_digraph(successors), start)}


def _on_cycle(successors: Successors, node: int) -> bool:
    return any(node in _after(successors, end) | {end} for end in successors[node])


def _off_cycles(successors: Successors) -> set[int]:
    return {node for node in successors if not _on_cycle(successors, node)}


def _stripped(successors: Successors, both_ways: bool) -> set[int]:
    """Remove nodes without a successor, or without a predecessor, until none are left."""
    left = _digraph(successors)
    while poor := [n for n in left if not left.out_degree(n) or (both_ways and not left.in_degree(n))]:
        left.remove_nodes_from(poor)
    return set(successors) - set(left)


def _same_members(given: Iterable[object], wanted: set[object]) -> bool:
    return set(given) == wanted


reachable = Check(
    name="reachable",
    asks="the set of nodes that a walk from `start` can reach, `start` included",
    start="keep the nodes seen so far, and a list of those whose successors you have not looked at yet.",
    draw=lambda rng: (_graph(rng), int(rng.integers(1, 4))),
    truth=lambda successors, start: {start} | _after(successors, start),
    same=_same_members,
    mistakes=[
        Mistake(
            lambda successors, start: {start, *successors[start]},
            "that is one step; go on from the nodes you have found.",
        ),
        Mistake(
            lambda successors, start: {*successors[start]}.union(*map(successors.get, successors[start])),
            "that is two steps; go on until no step finds a new node.",
        ),
        Mistake(
            lambda successors, start: set().union(*({e, *_after(successors, e)} for e in successors[start])),
            "`start` belongs to the set even if no way leads back to it.",
        ),
        Mistake(
            lambda successors, start: {start} | set(nx.ancestors(_digraph(successors), start)),
            "these are the nodes that lead to `start`: you go against the arrows.",
        ),
        Mistake(
            lambda successors, start: set(
                nx.node_connected_component(_digraph(successors).to_undirected(), start)
            ),
            "an edge leads in one direction only; you follow it in both.",
        ),
    ],
)

on_no_cycle = Check(
    name="on_no_cycle",
    asks="the set of nodes that lie on no cycle",
    start="a node is on a cycle if a way leads from one of its successors back to it.",
    draw=lambda rng: (_graph(rng),),
    truth=_off_cycles,
    same=_same_members,
    mistakes=[
        Mistake(
            lambda successors: {node for node, ends in successors.items() if not ends},
            "a node with successors can still be on no cycle: where do they lead?",
        ),
        Mistake(
            lambda successors: _stripped(successors, both_ways=False),
            "a node that no way leads back to is on no cycle, even if a walk from it never ends.",
        ),
        Mistake(
            lambda successors: _stripped(successors, both_ways=True),
            "you miss the nodes on the way from one cycle to another: they are on neither.",
        ),
        Mistake(
            lambda successors: {
                n for n in successors if not any(n in _after(successors, e) - {e} for e in successors[n])
            },
            "a node with an edge to itself is on a cycle, of one edge.",
        ),
    ],
)


def _same_sets(given: Iterable[Iterable[object]], wanted: Iterable[set[int]]) -> bool:
    parts = list(map(frozenset, given))
    return set(parts) == set(map(frozenset, wanted)) and len(set(parts)) == len(parts)


def _tarjan(successors: Successors, slip: str = "") -> list[set[int]]:
    """Find the strongly connected components as Tarjan does, or with one typical slip."""
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    components: list[set[int]] = []

    def visit(node: int) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        for child in successors[node]:
            if child not in index:
                visit(child)
                if slip != "never taken back":
                    low[node] = min(low[node], low[child])
            elif child in stack or slip == "stack not asked":
                low[node] = min(low[node], index[child])
        if low[node] == index[node]:
            at = stack.index(node)
            components.append({node} if slip == "first alone" else set(stack[at:]))
            del stack[at:]

    for node in successors:
        if node not in index:
            visit(node)
    return components


tarjan = Check(
    name="tarjan",
    asks="the list of strongly connected components, each as a set of nodes",
    start="an edge to a new node: visit it, then low[node] = min(low[node], low[child]).",
    draw=lambda rng: (_graph(rng),),
    truth=_tarjan,
    same=_same_sets,
    mistakes=[
        Mistake(
            lambda successors: _tarjan(successors, "stack not asked"),
            "a node that has left the stack belongs to another component: ignore the edge to it.",
        ),
        Mistake(
            lambda successors: _tarjan(successors, "never taken back"),
            "after visit(child), node must take over the low link of child if it is lower.",
        ),
        Mistake(
            lambda successors: _tarjan(successors, "first alone"),
            "a component is everything on the stack from its first node upwards, not this node alone.",
        ),
        Mistake(
            lambda successors: [{node} for node in successors],
            "these are single nodes; does an edge to a node on the stack lower a low link?",
        ),
        Mistake(
            lambda successors: [
                set(part) for part in nx.connected_components(_digraph(successors).to_undirected())
            ],
            "an edge leads in one direction only; you follow it in both.",
        ),
        Mistake(lambda successors: [], "no component is added: where is low[node] still index[node]?"),
    ],
)
