"""Notebook 01: inputs, right answers and mistakes of `hamilton` and `climb`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.skeleton import Skeleton
from mocap.course.checks.answers.common import Arguments, normalised

# ---- hamilton
#
# In formulas, a = (w, u) and b = (w', u') are scalar parts and vector parts, and a* is the conjugate of a.


def draw_hamilton(rng: np.random.Generator) -> Arguments:
    """Draw two rotations: mostly different ones, sometimes equal, nearly equal, opposite, or no turn."""
    a, b = normalised(rng.normal(size=(2, 4)))
    nearly_a = normalised(a + 1e-9 * b)
    special = [a, nearly_a, -a, rotations.inverse(a), rotations.IDENTITY]
    return a, np.array([*special, *[b] * 15][rng.integers(20)])


def right_hamilton(a: Array, b: Array) -> Array:
    """Multiply two quaternions, or two arrays of them."""
    return rotations.multiply(a, b)


def mistake_reversed_order(a: Array, b: Array) -> object:
    """Return the product of the quaternions in the opposite order, b a."""
    return rotations.multiply(b, a)


def mistake_no_cross_product(a: Array, b: Array) -> object:
    """Return (w w' - u · u', w u' + w' u), a product that does not depend on the order."""
    number, *_ = right_hamilton(a, b)
    return np.append(number, a[0] * b[1:] + b[0] * a[1:])


def mistake_dot_product_added(a: Array, b: Array) -> object:
    """Return the product with w w' + u · u' as its scalar part."""
    return right_hamilton(a, b) + np.array([2 * (a[1:] @ b[1:]), 0, 0, 0])


def mistake_negated(a: Array, b: Array) -> object:
    """Return the negative of the product, -a b, which is the same rotation."""
    return -right_hamilton(a, b)


def mistake_number_by_number(a: Array, b: Array) -> object:
    """Return the four products of the components, (w w', x x', y y', z z')."""
    return a * b


def mistake_vector_by_number_missing(a: Array, b: Array) -> object:
    """Return (w w' - u · u', u × u'): the terms w u' and w' u of the vector are missing."""
    number, *_ = right_hamilton(a, b)
    return np.append(number, np.cross(a[1:], b[1:]))


def mistake_second_vector_missing(a: Array, b: Array) -> object:
    """Return the product without the second term of its vector, w' u: (w w' - u · u', w u' + u × u')."""
    return right_hamilton(a, b) - np.append(0, b[0] * a[1:])


def mistake_first_vector_missing(a: Array, b: Array) -> object:
    """Return the product without the first term of its vector, w u': (w w' - u · u', w' u + u × u')."""
    return right_hamilton(a, b) - np.append(0, a[0] * b[1:])


def mistake_dot_product_missing(a: Array, b: Array) -> object:
    """Return the product with w w' alone as its scalar part."""
    return right_hamilton(a, b) + np.array([a[1:] @ b[1:], 0, 0, 0])


def mistake_number_last(a: Array, b: Array) -> object:
    """Return the components of the product in the order (x, y, z, w)."""
    return np.roll(right_hamilton(a, b), -1)


def mistake_conjugated_second(a: Array, b: Array) -> object:
    """Return a b*, the product with the conjugate of the second quaternion."""
    return rotations.multiply(a, rotations.inverse(b))


def mistake_conjugated_first(a: Array, b: Array) -> object:
    """Return a* b, the product with the conjugate of the first quaternion."""
    return rotations.multiply(rotations.inverse(a), b)


# ---- climb
#
# In formulas, o_j is the offset of joint j, R_j its rotation relative to its parent, and p starts at 0.


def draw_climb(rng: np.random.Generator) -> Arguments:
    """Draw a tree of joints, how they are turned, and its last joint."""
    count = int(rng.integers(4, 9))
    parents = np.array([-1, 0, *(rng.integers(joint - 2, joint) for joint in range(2, count))])
    skeleton = Skeleton([f"joint {n}" for n in range(count)], parents, rng.normal(size=(count, 3)))
    turns = rng.normal(size=(count, 4))
    return skeleton, turns / np.linalg.norm(turns, axis=1, keepdims=True), count - 1


def right_climb(skeleton: Skeleton, turns: Array, joint: int) -> Array:
    """Go from the joint to the root; each parent turns all that hangs below it."""
    point = np.zeros(3)
    matrices = rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset = skeleton.offsets[joint]
        parent = int(skeleton.parents[joint])
        point = matrices[parent] @ (point + offset)
        joint = parent
    return point


def mistake_turned_by_joint(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Repeat p ← R_j (p + o_j) up to the root: each joint rotates its own offset and all below it."""
    point = np.zeros(3)
    matrices = rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset = skeleton.offsets[joint]
        parent = int(skeleton.parents[joint])
        point = matrices[joint] @ (point + offset)
        joint = parent
    return point


def mistake_root_not_turned(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return the position along the root's own axes, with the identity as the root's rotation."""
    return right_climb(skeleton, np.vstack([rotations.IDENTITY, turns[1:]]), joint)


def mistake_parent_alone(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return Σ R_parent(j) o_j: each offset is rotated by its parent, but not by the joints above."""
    point = np.zeros(3)
    matrices = rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset = skeleton.offsets[joint]
        parent = int(skeleton.parents[joint])
        point = point + matrices[parent] @ offset
        joint = parent
    return point


def mistake_rest_pose(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return Σ o_j, the position in the rest pose, without any rotation."""
    point = np.zeros(3)
    while joint > 0:
        point = point + skeleton.offsets[joint]
        joint = int(skeleton.parents[joint])
    return point


def mistake_turned_by_joint_alone(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return Σ R_j o_j: each offset is rotated by its own joint, and by no other."""
    point = np.zeros(3)
    matrices = rotations.to_matrix(turns)  # one by one takes ten times as long
    while joint > 0:
        offset = skeleton.offsets[joint]
        parent = int(skeleton.parents[joint])
        point = point + matrices[joint] @ offset
        joint = parent
    return point


def mistake_single_step(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return R_parent o_j, a single step from the joint to its parent."""
    parent = int(skeleton.parents[joint])
    return rotations.rotate(turns[parent], skeleton.offsets[joint])


def mistake_root_offset_included(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return the position plus the offset of the root."""
    return right_climb(skeleton, turns, joint) + skeleton.offsets[0]


def mistake_turned_backwards(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Return the position in the pose whose joints have the inverse rotations."""
    return right_climb(skeleton, rotations.inverse(turns), joint)


def mistake_offset_of_joint_not_turned(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Repeat p ← R_parent(j) p + o_j up to the root: the offset is added after the rotation."""
    point = np.zeros(3)
    matrices = rotations.to_matrix(turns)
    while joint > 0:
        parent = int(skeleton.parents[joint])
        point = matrices[parent] @ point + skeleton.offsets[joint]
        joint = parent
    return point


def mistake_offset_of_parent(skeleton: Skeleton, turns: Array, joint: int) -> object:
    """Repeat p ← R_parent(j) (p + o_parent(j)): each joint contributes the offset of its parent."""
    offsets = np.vstack([skeleton.offsets[skeleton.parents[1:]], np.zeros((1, 3))])
    moved = Skeleton(skeleton.names, skeleton.parents, np.roll(offsets, 1, axis=0))
    return right_climb(moved, turns, joint)
