"""Random input and answers, right and wrong, for `01-skeletons-and-clips.toml`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.skeleton import Skeleton


def hand(upper: float, fore: float, shoulder: float, elbow: float) -> Array:
    return upper * np.array([np.cos(shoulder), np.sin(shoulder)]) + fore * np.array(
        [np.cos(elbow), np.sin(elbow)]
    )


def product(a: Array, b: Array, dot: float = -1.0, cross: float = 1.0) -> Array:
    vector = a[0] * b[1:] + b[0] * a[1:] + cross * np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] + dot * (a[1:] @ b[1:]), *vector])


def unit(axis: Array) -> Array:
    return np.asarray(axis / np.linalg.norm(axis))


def draw_hamilton(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw two rotations: mostly different ones, sometimes equal, nearly equal, opposite, or no turn."""
    a, b = map(unit, rng.normal(size=(2, 4)))
    special = [a, unit(a + 1e-9 * b), -a, rotations.inverse(a), rotations.IDENTITY]
    return a, np.array([*special, *[b] * 15][rng.integers(20)])


def draw_climb(rng: np.random.Generator) -> tuple[Skeleton, Array, int]:
    count = int(rng.integers(4, 9))
    parents = np.array([-1, 0, *(rng.integers(joint - 2, joint) for joint in range(2, count))])
    skeleton = Skeleton([f"joint {n}" for n in range(count)], parents, rng.normal(size=(count, 3)))
    turns = rng.normal(size=(count, 4))
    return skeleton, turns / np.linalg.norm(turns, axis=1, keepdims=True), count - 1


def climb(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    """Go from a joint to the root; each parent turns all that hangs below it."""
    point = np.zeros(3)
    while joint > 0:
        offset, parent = skeleton.offsets[joint], int(skeleton.parents[joint])
        point = rotations.rotate(turns[parent], point + offset)
        joint = parent
    return point
