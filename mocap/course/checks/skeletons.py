"""Checks of notebook 01."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.skeleton import Skeleton
from mocap.course.check import Check, Mistake, close_rotations


def _hand(upper: float, fore: float, shoulder: float, elbow: float) -> Array:
    return upper * np.array([np.cos(shoulder), np.sin(shoulder)]) + fore * np.array(
        [np.cos(elbow), np.sin(elbow)]
    )


hand = Check(
    name="hand",
    asks="the place (x, y) of the hand",
    start="place the elbow first; the hand lies one forearm further on, in the direction shoulder + elbow.",
    draw=lambda rng: (*rng.uniform(0.1, 0.5, 2), *rng.uniform(-3, 3, 2)),
    truth=lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder + elbow),
    mistakes=[
        Mistake(
            _hand,
            "the elbow's angle counts from the upper arm, which the shoulder has turned already: both act on "
            "the forearm.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(0, fore, shoulder, shoulder + elbow),
            "that is the hand as seen from the elbow; the elbow itself is somewhere, too.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder + elbow)[::-1],
            "x and y are swapped: at angle 0 the arm points along x.",
        ),
        Mistake(
            lambda upper, fore, shoulder, elbow: _hand(upper, fore, shoulder, shoulder - elbow),
            "the sign of the elbow's angle: it turns the same way round as the shoulder's.",
        ),
    ],
)


def _quaternion(axis: Array, half: float) -> Array:
    return np.array([np.cos(half), *np.sin(half) * axis])


def _unit(axis: Array) -> Array:
    return np.asarray(axis / np.linalg.norm(axis))


axis_angle = Check(
    name="axis_angle",
    asks="the unit quaternion (w, x, y, z) of a turn by angle radians about axis, of whatever length",
    start="make the axis a unit vector n; then (cos θ/2, n sin θ/2).",
    draw=lambda rng: (rng.normal(size=3), rng.uniform(-3, 3)),
    truth=lambda axis, angle: _quaternion(_unit(axis), angle / 2),
    mistakes=[
        Mistake(
            lambda axis, angle: _quaternion(_unit(axis), angle),
            "that turns twice as far: q acts from both sides of v, so each holds half the angle.",
        ),
        Mistake(
            lambda axis, angle: _quaternion(axis, angle / 2),
            "your quaternion has not length 1: the axis may come in any length.",
        ),
        Mistake(
            lambda axis, angle: np.roll(_quaternion(_unit(axis), angle / 2), -1),
            "the order of the numbers: here the cosine, w, stands first.",
        ),
        Mistake(
            lambda axis, angle: _quaternion(_unit(axis), np.radians(angle) / 2),
            "the angle comes in radians already.",
        ),
    ],
    same=close_rotations,
)


def _product(a: Array, b: Array, dot: float = -1.0, cross: float = 1.0) -> Array:
    vector = a[0] * b[1:] + b[0] * a[1:] + cross * np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] + dot * (a[1:] @ b[1:]), *vector])


def _two_quaternions(rng: np.random.Generator) -> tuple[Array, Array]:
    a, b = rng.normal(size=(2, 4))
    return _unit(a), _unit(b)


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
            "the cross product is missing: without it the order would not matter, and in space it does.",
        ),
        Mistake(
            lambda a, b: _product(a, b, dot=1.0),
            "the sign of the dot product: i² = -1, so two vectors give minus their dot product.",
        ),
        Mistake(lambda a, b: a * b, "that multiplies number by number; quaternions mix theirs."),
    ],
    same=close_rotations,
)


own_axes = Check(
    name="own_axes",
    asks="the quaternion of R = Rz Rx Ry, from degrees",
    start="make three quaternions, one an axis, with from_rotvec; multiply them in the order of the formula.",
    draw=lambda rng: tuple(rng.uniform(-80, 80, 3)),
    truth=lambda z, x, y: euler.from_euler("ZXY", np.radians([z, x, y])),
    mistakes=[
        Mistake(
            lambda z, x, y: euler.from_euler("zxy", np.radians([z, x, y])),
            "that is Ry Rx Rz: the first channel of the file stands leftmost in the product.",
        ),
        Mistake(
            lambda z, x, y: euler.from_euler("ZXY", [z, x, y]),
            "the file's angles are degrees; sine and cosine want radians.",
        ),
        Mistake(
            lambda z, x, y: euler.from_euler("XYZ", np.radians([x, y, z])),
            "that is Rx Ry Rz, the order of the alphabet; this file's channels stand in another.",
        ),
        Mistake(
            lambda z, x, y: rotations.from_rotvec(np.radians([x, y, z])),
            "that is one turn about the axis (x, y, z); three turns one after the other are another thing.",
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
    asks="where the joint lies as seen from the root's place, (x, y, z) in the world's directions",
    start="start at (0, 0, 0); while joint > 0, add its offset, go to its parent, and turn by the parent.",
    draw=_tree,
    truth=_climb,
    mistakes=[
        Mistake(
            _by_own_turns,
            "a joint does not turn its own offset, which lies in the parent's frame: go up first, then turn.",
        ),
        Mistake(_rootless, "the root turns too, and everything with it: stop after its turn, not before."),
        Mistake(
            _each_alone,
            "each offset is turned by its parent alone; but all joints above turn it, so turn the whole sum.",
        ),
        Mistake(
            lambda skeleton, turns, joint: _each_alone(skeleton, turns, joint, turned=False),
            "that is the body at rest: no joint has turned.",
        ),
    ],
)
