"""Notebook 07b: inputs, right answers and mistakes of `count_walks`, `least_cost` and `price_on_the_way`."""

from functools import reduce

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.course.checks.answers.common import Arguments

Graph = dict[int, list[int]]
"""The ends of the edges that leave each node."""

# ---- count_walks


def draw_count_walks(rng: np.random.Generator) -> Arguments:
    """Draw a graph of two to six nodes, with up to three edges each, two of which may lead to one node."""
    count = int(rng.integers(2, 7))
    graph = {node: rng.integers(0, count, rng.integers(1, 4)).tolist() for node in range(count)}
    return graph, int(rng.integers(count)), int(rng.integers(1, 8))


def right_count_walks(graph: Graph, node: int, edges: int) -> int:
    """Count walks from the end: those of n edges start with one edge, and n - 1 are left."""
    walks = dict.fromkeys(graph, 1)  # the empty walk
    for _ in range(edges):
        walks = {n: sum(walks[end] for end in ends) for n, ends in graph.items()}
    return walks[node]


def mistake_shorter_walks_too(graph: Graph, node: int, edges: int) -> object:
    """Count the walks of at most so many edges: the sum of the counts for 0, 1, …, n edges."""
    return sum(right_count_walks(graph, node, fewer) for fewer in range(edges + 1))


def mistake_edges_merged(graph: Graph, node: int, edges: int) -> object:
    """Count walks in the graph in which parallel edges are merged into one."""
    walks = dict.fromkeys(graph, 1)  # the empty walk
    for _ in range(edges):
        walks = {n: sum(walks[end] for end in set(ends)) for n, ends in graph.items()}
    return walks[node]


def mistake_edge_too_many(graph: Graph, node: int, edges: int) -> object:
    """Count the walks of n + 1 edges."""
    return right_count_walks(graph, node, edges + 1)


def mistake_edge_too_few(graph: Graph, node: int, edges: int) -> object:
    """Count the walks of n - 1 edges."""
    return right_count_walks(graph, node, edges - 1)


def mistake_ends_counted(graph: Graph, node: int, edges: int) -> object:
    """Count the different nodes at which walks of n edges end."""
    return len(reduce(lambda ends, _: {end for start in ends for end in graph[start]}, range(edges), {node}))


def mistake_power(graph: Graph, node: int, edges: int) -> object:
    """Return dⁿ, where d is the number of edges that leave the first node."""
    return len(graph[node]) ** edges


# ---- least_cost


def draw_least_cost(rng: np.random.Generator) -> Arguments:
    """Draw a place, a goal, 0 to 7 steps, and the length of a stride, 0.7 m."""
    return rng.normal(size=2) * 3, rng.normal(size=2) * 3, int(rng.integers(0, 8)), 0.7


def right_least_cost(place: Array, goal: Array, steps: int, stride: float) -> float:
    """Return the square of the distance that remains if every step leads to the goal."""
    return float(max(0.0, np.hypot(*goal - place) - steps * stride) ** 2)


def mistake_no_early_stop(place: Array, goal: Array, steps: int, stride: float) -> object:
    """Return (distance - steps · stride)², also if the steps lead past the goal."""
    return float((np.hypot(*goal - place) - steps * stride) ** 2)


def mistake_no_steps(place: Array, goal: Array, steps: int, stride: float) -> object:
    """Return the squared distance from the place to the goal, as if no step were left."""
    return float(np.sum((goal - place) ** 2))


def mistake_not_squared(place: Array, goal: Array, steps: int, stride: float) -> object:
    """Return max(0, distance - steps · stride) in metres, without the square."""
    return float(max(0.0, np.hypot(*goal - place) - steps * stride))


def mistake_difference_of_squares(place: Array, goal: Array, steps: int, stride: float) -> object:
    """Return max(0, distance² - (steps · stride)²)."""
    return float(max(0.0, np.sum((goal - place) ** 2) - (steps * stride) ** 2))


# ---- price_on_the_way


def draw_price_on_the_way(rng: np.random.Generator) -> Arguments:
    """Draw the root's places on an edge, the frames before it, a goal, and the frames of the walk."""
    count = int(rng.integers(1, 12))
    points = rng.normal(size=count) + 1j * rng.normal(size=count)
    walked = int(rng.integers(0, 60))
    goal = complex(*rng.normal(size=2) * 3)
    return points, walked, goal, int(rng.integers(30, 60))


def right_price_on_the_way(points: Points, walked: int, goal: complex, frames: int) -> float:
    """Add up the squared distances from a point that walks straight to the goal in so many frames."""
    frame_numbers = walked + np.arange(1, len(points) + 1)
    wanted = goal * np.minimum(1, frame_numbers / frames)
    return float((np.abs(points - wanted) ** 2).sum())


def mistake_goal_itself(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Add up the squared distances between the root and the goal, which does not move."""
    return float((np.abs(points - goal) ** 2).sum())


def mistake_restarts_at_edge(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Count frames from the start of the edge, so that the wanted point leaves the origin again."""
    return right_price_on_the_way(points, 0, goal, frames)


def mistake_frame_late(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Compare frame i of the edge with the wanted point of the frame before it."""
    return right_price_on_the_way(points, walked - 1, goal, frames)


def mistake_past_the_goal(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Compare with a point that goes on at constant velocity beyond the goal."""
    frame_numbers = walked + np.arange(1, len(points) + 1)
    wanted = goal * frame_numbers / frames
    return float((np.abs(points - wanted) ** 2).sum())


def mistake_distances(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Add up the distances in metres from the wanted point, not their squares."""
    frame_numbers = walked + np.arange(1, len(points) + 1)
    wanted = goal * np.minimum(1, frame_numbers / frames)
    return float((np.abs(points - wanted)).sum())


def mistake_last_frame(points: Points, walked: int, goal: complex, frames: int) -> object:
    """Return the squared distance from the wanted point in the last frame of the edge alone."""
    frame_numbers = walked + np.arange(1, len(points) + 1)
    wanted = goal * np.minimum(1, frame_numbers / frames)
    return float((np.abs(points - wanted) ** 2)[-1])
