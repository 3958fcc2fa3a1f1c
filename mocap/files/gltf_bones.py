"""The axes of the bones of a `.glb` file: y along the bone, as Blender and other rigging programs expect.

glTF stores joints and no bones. A program that shows bones takes the y axis of a joint for the direction of
its bone. The joints of motion files have the axes of the world in the rest pose.
"""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.limb_partners import limb_partners
from mocap.body.limbs import has_named_legs
from mocap.body.skeleton import Skeleton, reaches

UP = np.array([0.0, 1.0, 0.0])
FORWARD = np.array([0.0, 0.0, 1.0])
NEAR_FORWARD = np.cos(np.radians(45))  # least cosine with ±z of a bone that runs forward or backward
REVERSED = np.cos(np.radians(135))  # largest cosine of a bone that runs back along the bone of its parent
SHORT = 1e-6  # metres: a bone of this length or less has no direction
CANCELLED = 0.1  # fraction of their lengths: bones with a shorter sum have no common direction


def bone_axes(skeleton: Skeleton) -> Array:
    """Compute the orientation of each joint's axes in the rest pose: y runs along the bone.

    The twist about the bone is that for which z points forward, as near to the world's +z as possible. Then x
    is the axis about which spines, knees, and elbows of a T-pose bend, and left and right limbs mirror each
    other. Bones within 45° of ±z, such as feet, have no such twist: they take the axes of their parent by the
    shortest rotation, so that z points up in a foot. If their parent runs the other way, or at the root, z is
    as near to +y as possible.

    Parameters
    ----------
    skeleton : J joints. Its rest pose faces +z.

    Returns
    -------
    Quaternions, shape (J, 4).

    Examples
    --------
    A knee, below which y points down and z forward, and an ankle, with z up:

    >>> leg = Skeleton(["knee", "ankle", "toe"], [-1, 0, 1], [[0, 0, 0], [0, -0.4, 0], [0, 0, 0.2]])
    >>> axes = bone_axes(leg)
    >>> rotations.rotate(axes, [0, 1, 0]).round(6)[:2] + 0.0
    array([[ 0., -1.,  0.],
           [ 0.,  0.,  1.]])
    >>> rotations.rotate(axes, [0, 0, 1]).round(6)[:2] + 0.0
    array([[0., 0., 1.],
           [0., 1., 0.]])
    """
    directions = bone_directions(skeleton)
    axes = np.empty((len(skeleton), 4))
    for joint, direction in enumerate(directions):
        parent = skeleton.parents[joint]
        if abs(direction @ FORWARD) < NEAR_FORWARD:
            axes[joint] = _with_z_near(FORWARD, direction)
        elif joint and direction @ directions[parent] > REVERSED:
            axes[joint] = rotations.multiply(rotations.between(directions[parent], direction), axes[parent])
        else:
            axes[joint] = _with_z_near(UP, direction)
    return axes


def bone_directions(skeleton: Skeleton) -> Array:
    """Compute the direction of the bone that starts at each joint in the rest pose: unit vectors (J, 3).

    A bone with one child points at it. With several children it points at the one that continues the limb or
    the spine: the one with the longest limb below, apart from pairs of left and right limbs. If there are
    only such pairs, it points between them. At the end of a limb a bone continues the one that leads to it.

    Examples
    --------
    >>> offsets = [[0, 0, 0], [0.1, -0.1, 0], [-0.1, -0.1, 0], [0, 0.2, 0]]
    >>> bone_directions(Skeleton(["hips", "left", "right", "chest"], [-1, 0, 0, 0], offsets))[0]
    array([0., 1., 0.])
    """
    vectors = np.zeros((len(skeleton), 3))
    images = _images(skeleton)
    limbs = reaches(skeleton) + np.linalg.norm(skeleton.offsets, axis=-1)  # from each joint's parent
    for joint in reversed(range(len(skeleton))):  # a joint on its child points where the child does
        vectors[joint] = _along_children(skeleton, joint, images, limbs, vectors)
    for joint in range(len(skeleton)):
        vectors[joint] = _unit(vectors[joint])
        if not vectors[joint].any():
            vectors[joint] = _unit(skeleton.offsets[joint]) if joint else UP
        if not vectors[joint].any():
            vectors[joint] = vectors[skeleton.parents[joint]]
    return vectors


def _along_children(skeleton: Skeleton, joint: int, images: list[int], limbs: Array, vectors: Array) -> Array:
    """Return the vector of the bone that starts at a joint, (3,), metres; 0 if nothing defines one."""
    children = skeleton.children(joint)
    offsets: dict[int, Array] = {child: skeleton.offsets[child] for child in children}
    distant = [child for child, offset in offsets.items() if np.linalg.norm(offset) > SHORT]
    if len(distant) == 1:
        return offsets[distant[0]]
    bones = {child: offsets[child] if child in distant else vectors[child] for child in children}
    bones = {child: bone for child, bone in bones.items() if bone.any()}
    middle = [child for child in bones if images[child] == child or images[child] not in children]
    if middle:
        return bones[max(middle, key=lambda child: float(limbs[child]))]
    total = np.sum([*bones.values()], axis=0) if bones else np.zeros(3)
    lengths = sum(np.linalg.norm(bone) for bone in bones.values())
    return total if np.linalg.norm(total) > CANCELLED * lengths else np.zeros(3)


def _images(skeleton: Skeleton) -> list[int]:
    """Return the mirror image of each joint by the roles of limbs, else by name; itself if it has none."""
    images = [skeleton.partner(joint) for joint in range(len(skeleton))]
    if has_named_legs(skeleton):
        for left, right in limb_partners(skeleton).items():
            images[left] = right
            images[right] = left
    return images


def _unit(vector: Array) -> Array:
    """Scale a vector to length 1, or return 0 for a length without a direction."""
    length = np.linalg.norm(vector)
    return vector / length if length > SHORT else np.zeros(3)


def _with_z_near(target: Array, direction: Array) -> Array:
    """Return the axes with y along a direction and z as near to a target as possible, a quaternion (4,)."""
    x = np.cross(direction, target)
    x = x / np.linalg.norm(x)
    return rotations.from_matrix(np.stack([x, direction, np.cross(x, direction)], axis=1))
