import math
from itertools import pairwise

import numpy as np


def no_start(points):
    total, found = 0.0, []
    for a, b in pairwise(points):
        total += math.dist(a, b)
        found.append(total)
    return found


def summed(points, length):
    total, found = 0.0, [0.0]
    for a, b in pairwise(points):
        total += length(b - a)
        found.append(total)
    return found


def squares(points):
    return summed(points, lambda step: step @ step)


def added(points):
    return summed(points, lambda step: abs(step[0]) + abs(step[1]))


def beeline(points):
    return [math.dist(points[0], point) for point in points]


def single_steps(points):
    return [0.0] + [math.dist(a, b) for a, b in pairwise(points)]


def matrix(angle, x, z):
    """Turn about +y, then move, of (x, z, 1)."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([[cos, sin, x], [-sin, cos, z], [0, 0, 1]])


def by_matrices(points, old, new, product):
    rows = zip(points, old, new, strict=True)
    return [(product(matrix(*a), matrix(*b)) @ [*point, 1])[:2] for point, a, b in rows]


def mirrored(points, old, new):
    flip = [-1, 1, 1]
    return by_matrices(points, old * flip, new * flip, lambda a, b: b @ np.linalg.inv(a))


def wrong_order(points, old, new):
    return by_matrices(points, old, new, lambda a, b: np.linalg.inv(a) @ b)


def a_crab(points, old, new):
    return points - old[:, 1:] + new[:, 1:]


def about_the_origin(points, old, new):
    angles = new[:, 0] - old[:, 0]
    turned = [matrix(angle, 0, 0)[:2, :2] @ point for angle, point in zip(angles, points, strict=True)]
    return np.array(turned) + new[:, 1:] - old[:, 1:]


def backwards(points, old, new):
    return by_matrices(points, old, new, lambda a, b: a @ np.linalg.inv(b))


def still_on_the_cart(points, old, new):
    return by_matrices(points, old, new, lambda a, b: np.linalg.inv(a))


def z_before_x(points, old, new):
    return np.array(by_matrices(points, old, new, lambda a, b: b @ np.linalg.inv(a)))[:, ::-1]


def of_the_swing_too(positions, planted):
    return sum(positions) / len(positions)


def first(positions, planted):
    return positions[list(planted).index(True)]


def last(positions, planted):
    return positions[np.flatnonzero(planted)[-1]]


def middle(positions, planted):
    frames = np.flatnonzero(planted)
    return positions[frames[len(frames) // 2]]


def on_the_floor(positions, planted):
    x, _, z = positions[planted].mean(axis=0)
    return [x, 0.0, z]


def as_high_as_on_average(positions, planted):
    x, _, z = positions[planted].mean(axis=0)
    return [x, positions[:, 1].mean(), z]


WRONG = {
    "arc_length": [
        (no_start, "the start is missing"),
        (squares, "take the root of each step"),
        (added, "x and z are not added"),
        (beeline, "the straight way from the start"),
        (single_steps, "add up all that come before"),
    ],
    "carry": [
        (mirrored, "it turns the other way round"),
        (wrong_order, "the old cart is undone first"),
        (a_crab, "the carts also turn"),
        (about_the_origin, "it turns about the origin"),
        (backwards, "back from the new path"),
        (still_on_the_cart, "now put the cart on the new path"),
        (z_before_x, "x and z are swapped"),
    ],
    "plant_place": [
        (of_the_swing_too, "the mean over all frames"),
        (first, "the first planted frame's place"),
        (last, "the last planted frame's place"),
        (middle, "the middle frame's place"),
        (on_the_floor, "some centimetres above the floor"),
        (as_high_as_on_average, "averaged with the swing"),
    ],
}
