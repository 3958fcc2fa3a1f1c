import numpy as np


def likelier_when_worse(costs, chance):
    return int(np.searchsorted(np.cumsum(costs / costs.sum()), chance))


def always_the_cheapest(costs, chance):
    return list(costs).index(min(costs))


def all_alike(costs, chance):
    return int(np.floor(chance * len(costs)))


def never_shared(costs, chance):
    running = np.cumsum(1 / (costs + 0.001))
    return int(np.argmax(running > chance))


def from_one(costs, chance):
    odds = 1 / (costs + 0.001)
    return sum(np.cumsum(odds / odds.sum()) <= chance) + 1


def nearest_share(costs, chance):
    odds = 1 / (costs + 0.001)
    return np.argmin(abs(odds / odds.sum() - chance))


def added(transforms):
    return tuple(np.sum(transforms, axis=0))


def with_its_own(transforms):
    angle, x, z = 0.0, 0.0, 0.0
    for turn, dx, dz in transforms:
        angle += turn
        x += dx * np.cos(angle) + dz * np.sin(angle)
        z += dz * np.cos(angle) - dx * np.sin(angle)
    return angle, x, z


def wrong_sign(transforms):
    angle, x, z = 0.0, 0.0, 0.0
    for turn, dx, dz in transforms:
        x += dx * np.cos(angle) - dz * np.sin(angle)
        z += dz * np.cos(angle) + dx * np.sin(angle)
        angle += turn
    return angle, x, z


def other_order(transforms):
    angle, x, z = 0.0, 0.0, 0.0
    for turn, dx, dz in transforms:
        cos, sin = np.cos(turn), np.sin(turn)
        angle, x, z = angle + turn, x * cos + z * sin + dx, z * cos - x * sin + dz
    return angle, x, z


def walks(lengths, start, longest):
    """Yield every walk of at most so many edges, shortest edges first."""
    stack = [(0.0, [start])]
    while stack:
        cost, walk = stack.pop()
        yield cost, walk
        if len(walk) <= longest:
            row = sorted(lengths[walk[-1]].items(), key=lambda pair: -pair[1])
            stack += [(cost + g, [*walk, node]) for node, g in row]


def complete(lengths, start, goal, longest):
    return [(cost, walk) for cost, walk in walks(lengths, start, longest) if walk[-1] == goal]


def the_first(lengths, start, goal, longest):
    return next(iter(complete(lengths, start, goal, longest)), (np.inf, []))


def the_shortest_edge(lengths, start, goal, longest):
    cost, walk = 0.0, [start]
    while walk[-1] != goal and len(walk) <= longest:
        node = min(lengths[walk[-1]], key=lengths[walk[-1]].get)
        cost, walk = cost + lengths[walk[-1]][node], [*walk, node]
    return (cost, walk) if walk[-1] == goal else (np.inf, [])


def each_node_once(lengths, start, goal, longest):
    best, met, stack = (np.inf, []), set(), [(0.0, [start])]
    while stack:
        cost, walk = stack.pop()
        if walk[-1] in met or cost >= best[0]:
            continue
        met.add(walk[-1])
        if walk[-1] == goal:
            best = (cost, walk)
        elif len(walk) <= longest:
            row = sorted(lengths[walk[-1]].items(), key=lambda pair: pair[1], reverse=True)
            stack.extend((cost + g, [*walk, node]) for node, g in row)
    return best


def one_edge_short(lengths, start, goal, longest):
    return min(complete(lengths, start, goal, longest - 1), default=(np.inf, []))


def one_edge_more(lengths, start, goal, longest):
    return min(complete(lengths, start, goal, longest + 1), default=(np.inf, []))


def fewest_edges(lengths, start, goal, longest):
    found = complete(lengths, start, goal, longest)
    return min(found, key=lambda pair: (len(pair[1]), pair[0]), default=(np.inf, []))


def without_the_start(lengths, start, goal, longest):
    cost, walk = min(complete(lengths, start, goal, longest), default=(np.inf, []))
    return cost, walk[1:]


WRONG = {
    "choose_transition": [
        (likelier_when_worse, "homework's slip"),
        (always_the_cheapest, "always take the cheapest"),
        (all_alike, "use the costs"),
        (never_shared, "divide by the sum"),
        (from_one, "count from 1"),
        (nearest_share, "end to end"),
    ],
    "product_of": [
        (added, "you add the steps as they are"),
        (with_its_own, "its own angle too"),
        (wrong_sign, "wrong direction"),
        (other_order, "the other order"),
    ],
    "shortest_walk": [
        (the_first, "first complete walk"),
        (the_shortest_edge, "only the shortest edge"),
        (each_node_once, "met before"),
        (one_edge_short, "one edge too early"),
        (one_edge_more, "one edge too many"),
        (fewest_edges, "add up the lengths"),
        (without_the_start, "start belongs"),
    ],
}
