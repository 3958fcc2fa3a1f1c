from itertools import combinations, permutations

import networkx as nx


def reach(successors, node):
    return nx.descendants(nx.DiGraph(successors), node)


def on_cycle(successors, node):
    return any(node == child or node in reach(successors, child) for child in successors[node])


def reasons(successors, kept, dead="dead end", sink="sink", unreached="unreached"):
    found = {}
    for node in successors:
        if node not in kept:
            after = unreached if reach(successors, node) & kept else sink
            found[node] = after if on_cycle(successors, node) else dead
    return found


def ends_only(successors, kept):
    dead = {n: "dead end" for n in successors if n not in kept and not successors[n]}
    right = reasons(successors, kept)
    return {n: dead.get(n, "sink" if why == "dead end" else why) for n, why in right.items()}


def two_reasons(successors, kept):
    return reasons(successors, kept, unreached="sink")


def exchanged(successors, kept):
    return reasons(successors, kept, sink="unreached", unreached="sink")


def all_nodes(successors, kept):
    return dict.fromkeys(kept, "sink") | reasons(successors, kept)


def no_dead_ends(successors, kept):
    return reasons(successors, kept, dead="sink")


def most_nodes(components, edges):
    return sorted(components, key=len, reverse=True)[0]


def leaving_too(components, edges):
    best = max(sum(f for a, b, f in edges if a in part) for part in components)
    return next(p for p in components if sum(f for a, b, f in edges if a in p) == best)


def entering_too(components, edges):
    best = max(sum(f for a, b, f in edges if b in part) for part in components)
    return next(p for p in components if sum(f for a, b, f in edges if b in p) == best)


def most_edges(components, edges):
    return max(components, key=lambda part: len([1 for a, b, _ in edges if {a, b} <= part]))


def no_way(graph, here, there):
    return not any(nx.has_path(graph, a, b) for a in here for b in there)


def one_order(graph, kinds):
    return {(a, b) for a, b in combinations(kinds, 2) if no_way(graph, kinds[a], kinds[b])}


def undirected(graph, kinds):
    plain = nx.Graph(graph)
    return {(a, b) for a, b in permutations(kinds, 2) if no_way(plain, kinds[a], kinds[b])}


def turned_round(graph, kinds):
    return {(a, b) for a, b in permutations(kinds, 2) if no_way(graph, kinds[b], kinds[a])}


def single_edges(graph, kinds):
    joined = {(a, b) for a in kinds for b in kinds for u, v in graph.edges if u in kinds[a] and v in kinds[b]}
    return set(permutations(kinds, 2)) - joined


def with_a_way(graph, kinds):
    return {(a, b) for a, b in permutations(kinds, 2) if not no_way(graph, kinds[a], kinds[b])}


WRONG = {
    "why_removed": [
        (ends_only, "can be on no cycle too"),
        (two_reasons, "is no sink"),
        (exchanged, "are exchanged"),
        (all_nodes, "the nodes that stay"),
        (no_dead_ends, "even if only sinks follow"),
    ],
    "component_to_keep": [
        (most_nodes, "most nodes"),
        (leaving_too, "leaves the component"),
        (entering_too, "enters the component"),
        (most_edges, "most edges"),
    ],
    "missing_ways": [
        (one_order, "try both orders"),
        (undirected, "follow them in both"),
        (turned_round, "are reversed"),
        (single_edges, "through other nodes"),
        (with_a_way, "pairs with a way"),
    ],
}
