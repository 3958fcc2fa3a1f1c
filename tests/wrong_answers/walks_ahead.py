import numpy as np


def every_walk(graph, node, edges):
    if edges == 0:
        return [[node]]
    return [[node, *rest] for after in graph[node] for rest in every_walk(graph, after, edges - 1)]


def with_shorter_ones(graph, node, edges):
    return sum(len(every_walk(graph, node, count)) for count in range(edges + 1))


def as_sets(graph, node, edges):
    return len(every_walk({n: sorted(set(after)) for n, after in graph.items()}, node, edges))


def one_more(graph, node, edges):
    return len(every_walk(graph, node, edges + 1))


def one_fewer(graph, node, edges):
    return len(every_walk(graph, node, edges - 1))


def different_ends(graph, node, edges):
    return len({walk[-1] for walk in every_walk(graph, node, edges)})


def power(graph, node, edges):
    return len(graph[node]) ** edges


def overshooting(place, goal, steps, stride):
    x, z = goal - place
    return (np.sqrt(x**2 + z**2) - steps * stride) ** 2


def no_steps(place, goal, steps, stride):
    return np.linalg.norm(place - goal) ** 2


def metres(place, goal, steps, stride):
    return max(np.linalg.norm(place - goal) - steps * stride, 0)


def squares_subtracted(place, goal, steps, stride):
    return max(np.linalg.norm(place - goal) ** 2 - (steps * stride) ** 2, 0)


def wanted(before, count, goal, frames):
    return goal * np.clip((before + np.arange(count) + 1) / frames, 0, 1)


def from_the_goal(points, before, goal, frames):
    return sum(abs(point - goal) ** 2 for point in points)


def own_clock(points, before, goal, frames):
    return (abs(points - wanted(0, len(points), goal, frames)) ** 2).sum()


def a_frame_late(points, before, goal, frames):
    return (abs(points - wanted(before - 1, len(points), goal, frames)) ** 2).sum()


def past_the_goal(points, before, goal, frames):
    return sum(abs(p - goal * (before + i + 1) / frames) ** 2 for i, p in enumerate(points))


def in_metres(points, before, goal, frames):
    return abs(points - wanted(before, len(points), goal, frames)).sum()


def at_the_end(points, before, goal, frames):
    return abs(points - wanted(before, len(points), goal, frames))[-1] ** 2


WRONG = {
    "count_walks": [
        (with_shorter_ones, "shorter walks too"),
        (as_sets, "into a set"),
        (one_more, "one edge too many"),
        (one_fewer, "one edge too few"),
        (different_ends, "at which walks end"),
        (power, "as many edges as the first"),
    ],
    "least_cost": [
        (overshooting, "can stop there"),
        (no_steps, "no lower bound"),
        (metres, "square metres"),
        (squares_subtracted, "difference of squares"),
    ],
    "price_on_the_way": [
        (from_the_goal, "to the goal itself"),
        (own_clock, "starts again"),
        (a_frame_late, "one frame late"),
        (past_the_goal, "past the goal"),
        (in_metres, "their squares"),
        (at_the_end, "last frame of the edge"),
    ],
}
