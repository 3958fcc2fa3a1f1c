"""Checks of notebook 01."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.skeleton import Skeleton
from mocap.course.check import Check, Mistake, close_rotations


def _hand(upper: float, fore: float, shoulder: float, elbow: float) -> Array:
    return upper * np.array([np.cos(shoulder), np.sin(shoulder)]) + fore * np.array(
        [np.cos(elbow), np.sin(elbow)]
    )


hand = Check(
    name="hand",
    asks="the position (x, y) of the hand",
    start="find the elbow first; the hand is one forearm further, in the direction shoulder + elbow.",
    draw=lambda rng: (*rng.uniform(0.1, 0.5, 2), *rng.uniform(-3, 3, 2)),
    truth=lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder + elbow),
    mistakes=[
        Mistake(
            _hand,
            "the elbow's angle is measured from the upper arm, which the shoulder has turned already: both "
            "angles act on the forearm.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(0, fore, shoulder, shoulder + elbow),
            "that is the hand as seen from the elbow; add the position of the elbow itself.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder + elbow)[::-1],
            "x and y are swapped: at angle 0 the arm points along x.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder - elbow),
            "the sign of the elbow's angle is wrong: it turns in the same direction as the shoulder's.",
        ),
    ],
)


def _product(a: Array, b: Array, dot: float = -1.0, cross: float = 1.0) -> Array:
    vector = a[0] * b[1:] + b[0] * a[1:] + cross * np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] + dot * (a[1:] @ b[1:]), *vector])


def _unit(axis: Array) -> Array:
    return np.asarray(axis / np.linalg.norm(axis))


def _two_quaternions(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw two rotations: mostly different ones, sometimes equal, nearly equal, opposite, or no turn."""
    a, b = map(_unit, rng.normal(size=(2, 4)))
    special = [a, _unit(a + 1e-9 * b), -a, rotations.inverse(a), rotations.IDENTITY]
    return a, np.array([*special, *[b] * 15][rng.integers(20)])


hamilton = Check(
    name="hamilton",
    asks="the product a b, four numbers (w, x, y, z)",
    start="split each into its number and its vector: a[0] and a[1:]. np.cross makes the cross product.",
    draw=_two_quaternions,
    truth=lambda a, b: rotations.multiply(a, b),
    mistakes=[
        Mistake(
            lambda a, b: _product(b, a),
            "that is b a: the cross product changes its sign with the order.",
        ),
        Mistake(
            lambda a, b: _product(a, b, cross=0.0),
            "the cross product is missing: without it the order would not matter, but it does for rotations.",
        ),
        Mistake(
            lambda a, b: _product(a, b, dot=1.0),
            "the sign of the dot product is wrong: i² = -1, so two vectors give minus their dot product.",
        ),
        Mistake(
            lambda a, b: a * b,
            "that multiplies number by number; in the product, each number depends on all eight.",
        ),
    ],
    same=close_rotations,
)


def _tree(rng: np.random.Generator) -> tuple[Skeleton, Array, int]:
    count = int(rng.integers(4, 9))
    parents = np.array([-1, 0, *(rng.integers(joint - 2, joint) for joint in range(2, count))])
    skeleton = Skeleton([f"joint {n}" for n in range(count)], parents, rng.normal(size=(count, 3)))
    turns = rng.normal(size=(count, 4))
    return skeleton, turns / np.linalg.norm(turns, axis=1, keepdims=True), count - 1


def _climb(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    point = np.zeros(3)
    while joint > 0:
        point = point + skeleton.offsets[joint]
        joint = int(skeleton.parents[joint])
        point = rotations.rotate(turns[joint], point)
    return point


def _by_own_turns(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    point = np.zeros(3)
    while joint > 0:
        point = rotations.rotate(turns[joint], point + skeleton.offsets[joint])
        joint = int(skeleton.parents[joint])
    return point


def _rootless(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    return _climb(skeleton, np.vstack([rotations.IDENTITY, turns[1:]]), joint)


def _each_alone(skeleton: Skeleton, turns: Array, joint: int, turned: bool = True) -> Array:
    point = np.zeros(3)
    while joint > 0:
        offset, joint = skeleton.offsets[joint], int(skeleton.parents[joint])
        point = point + (rotations.rotate(turns[joint], offset) if turned else offset)
    return point


climb = Check(
    name="climb",
    asks="the position (x, y, z) of the joint relative to the root, along the axes of the world",
    start="start at (0, 0, 0); while joint > 0, add its offset, go to its parent, and turn by the parent.",
    draw=_tree,
    truth=_climb,
    mistakes=[
        Mistake(
            _by_own_turns,
            "a joint does not turn its own offset: go to the parent first, then turn by the parent.",
        ),
        Mistake(_rootless, "the root turns too, and everything with it: stop after its turn, not before."),
        Mistake(
            _each_alone,
            "each offset is turned by its parent alone, but all joints above turn it: turn the whole sum.",
        ),
        Mistake(
            lambda skeleton, turns, joint: _each_alone(skeleton, turns, joint, turned=False),
            "that is the body at rest: no joint has turned.",
        ),
    ],
)
