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


def searched(successors, take_back=True, ask_stack=True, alone=False):
    index, low, stack, parts = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for child in successors[node]:
            if child not in index:
                visit(child)
                low[node] = min(low[node], low[child] if take_back else low[node])
            elif not ask_stack or child in stack:
                low[node] = min(low[node], index[child])
        if low[node] == index[node]:
            part = stack[stack.index(node) :]
            parts.append({node} if alone else set(part))
            del stack[len(stack) - len(part) :]

    for node in successors:
        if node not in index:
            visit(node)
    return parts


def low_links_not_taken_back(successors):
    return searched(successors, take_back=False)


def stack_not_asked(successors):
    return searched(successors, ask_stack=False)


def first_node_alone(successors):
    return searched(successors, alone=True)


def every_node_alone(successors):
    return [[node] for node in successors]


def directions_ignored(successors):
    return [frozenset(part) for part in nx.weakly_connected_components(nx.DiGraph(successors))]


def nothing_added(successors):
    return []


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
    "tarjan": [
        (low_links_not_taken_back, "take over the low link"),
        (stack_not_asked, "has left the stack"),
        (first_node_alone, "from its first node upwards"),
        (every_node_alone, "single nodes"),
        (directions_ignored, "one direction only"),
        (nothing_added, "no component is added"),
    ],
}
