import numpy as np


def likelier_when_worse(costs):
    return np.array([cost / sum(costs) for cost in costs])


def never_shared(costs):
    return np.array([1 / (cost + 0.001) for cost in costs])


def no_millimetre(costs):
    odds = costs**-1.0
    return odds / odds.sum()


def all_alike(costs):
    return np.ones(len(costs)) / len(costs)


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


def recursive(tree, cut=True, key=lambda way: way[0]):
    best, visited = np.inf, 0

    def go(node, cost):
        nonlocal best, visited
        visited += 1
        if not tree[node]:
            best = min(best, cost)
        for g, child in sorted(tree[node], key=key):
            if not cut or cost + g < best:
                go(child, cost + g)

    go(0, 0.0)
    return best, visited


def everything(tree):
    return recursive(tree, cut=False)


def most_expensive_first(tree):
    return recursive(tree, key=lambda way: -way[0])


def as_they_stand(tree):
    best, visited, stack = float("inf"), 0, [(0.0, 0)]
    while stack:
        cost, node = stack.pop()
        if cost < best:
            visited += 1
            if tree[node] == []:
                best = cost
            for g, child in tree[node]:
                stack.append((cost + g, child))
    return best, visited


def counted_too_soon(tree):
    best, visited, stack = float("inf"), 0, [(0.0, 0)]
    while stack:
        cost, node = stack.pop()
        visited += 1
        if cost < best:
            if tree[node] == []:
                best = cost
            stack += sorted([(cost + g, child) for g, child in tree[node]])[::-1]
    return best, visited


def greedy(tree):
    cost, node, visited = 0.0, 0, 1
    while tree[node]:
        g, node = min(tree[node])
        cost, visited = cost + g, visited + 1
    return cost, visited


def overshooting(place, goal, steps, stride):
    x, z = goal - place
    return (np.sqrt(x**2 + z**2) - steps * stride) ** 2


def no_steps(place, goal, steps, stride):
    return np.linalg.norm(place - goal) ** 2


def metres(place, goal, steps, stride):
    return max(np.linalg.norm(place - goal) - steps * stride, 0)


def squares_subtracted(place, goal, steps, stride):
    return max(np.linalg.norm(place - goal) ** 2 - (steps * stride) ** 2, 0)


WRONG = {
    "choice_odds": [
        (likelier_when_worse, "homework's slip"),
        (never_shared, "add up to 1"),
        (no_millimetre, "add the millimetre"),
        (all_alike, "use the costs"),
    ],
    "product_of": [
        (added, "you add the steps as they are"),
        (with_its_own, "its own angle too"),
        (wrong_sign, "wrong direction"),
        (other_order, "the other order"),
    ],
    "cheapest_way": [
        (everything, "visit every node"),
        (most_expensive_first, "most expensive child first"),
        (as_they_stand, "in any order"),
        (counted_too_soon, "is not visited"),
        (greedy, "a greedy search"),
    ],
    "least_cost": [
        (overshooting, "can stop there"),
        (no_steps, "no lower bound"),
        (metres, "square metres"),
        (squares_subtracted, "difference of squares"),
    ],
}
