from itertools import combinations, permutations

import networkx as nx


def closure(successors, start):
    seen, waiting = {start}, [start]
    while waiting:
        new = set(successors[waiting.pop()]) - seen
        seen |= new
        waiting += new
    return seen


def one_step(successors, start):
    return set(successors[start]) | {start}


def two_steps(successors, start):
    found = set(successors[start])
    for node in successors[start]:
        found.update(successors[node])
    return found


def start_forgotten(successors, start):
    found = set()
    for node in successors[start]:
        found |= closure(successors, node)
    return found


def against_the_arrows(successors, start):
    return {node for node in successors if start in closure(successors, node)}


def both_ways(successors, start):
    both = {node: list(ends) for node, ends in successors.items()}
    for node, ends in successors.items():
        for end in ends:
            both[end].append(node)
    return closure(both, start)


def nothing_follows(successors):
    return {node for node in successors if len(successors[node]) == 0}


def walks_end(successors):
    left, changed = {n: set(ends) for n, ends in successors.items()}, True
    while changed:
        gone = {n for n, ends in left.items() if not ends & set(left)}
        left = {n: ends for n, ends in left.items() if n not in gone}
        changed = bool(gone)
    return set(successors) - set(left)


def small_components(successors):
    graph = nx.DiGraph(successors)
    return {n for part in nx.strongly_connected_components(graph) if len(part) == 1 for n in part}


def peeled(successors):
    graph = nx.DiGraph(successors)
    while True:
        gone = [n for n in graph if graph.in_degree(n) == 0 or graph.out_degree(n) == 0]
        if not gone:
            return set(successors) - set(graph)
        graph.remove_nodes_from(gone)


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
    "reachable": [
        (one_step, "that is one step"),
        (two_steps, "that is two steps"),
        (start_forgotten, "`start` belongs"),
        (against_the_arrows, "against the arrows"),
        (both_ways, "one direction only"),
    ],
    "on_no_cycle": [
        (nothing_follows, "where do they lead"),
        (walks_end, "no way leads back"),
        (small_components, "an edge to itself"),
        (peeled, "from one cycle to another"),
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
