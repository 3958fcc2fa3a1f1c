"""Forward kinematics and velocities of arrays of poses.

`Motion.positions` and `kinematics.forward_kinematics` both call this module.
"""

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError


class GlobalPoses(NamedTuple):
    """World poses of all joints: `positions` (F, J, 3), metres, and rotation `matrices` (F, J, 3, 3).

    Examples
    --------
    >>> GlobalPoses(np.zeros((1, 2, 3)), np.tile(np.eye(3), (1, 2, 1, 1))).matrices[0, 1, 2]
    array([0., 0., 1.])
    """

    positions: Array
    matrices: Array


def place_joints(skeleton: Skeleton, root_positions: Array, local: Array) -> GlobalPoses:
    """Compute the world poses of all joints by forward kinematics, from the root down the tree.

    R_j = R_parent · L_j and p_j = p_parent + R_parent · offset_j, where L_j is the joint's local rotation.

    Parameters
    ----------
    skeleton : J joints.
    root_positions : shape (F, 3), metres.
    local : shape (F, J, 4), unit quaternions (w, x, y, z) relative to the parent's frame.

    Returns
    -------
    Positions (F, J, 3), metres, and rotation matrices (F, J, 3, 3).

    Examples
    --------
    An arm of 1 m at a shoulder that is rotated by 90° about y:

    >>> arm = Skeleton(["shoulder", "hand"], [-1, 0], [[0, 0, 0], [0, 0, 1]])
    >>> pose = np.array([[rotations.about_y(np.pi / 2), [1, 0, 0, 0]]])
    >>> place_joints(arm, np.array([[0.0, 2.0, 0.0]]), pose).positions[0, 1].round(6) + 0.0
    array([1., 2., 0.])
    """
    matrices = rotations.to_matrix(np.swapaxes(local, 0, 1))  # L_j, and R_j from the root down
    positions = np.empty(matrices.shape[:-1])
    positions[0] = root_positions
    # All of one joint at a time: the matrices of its parent are still in the processor's cache.
    for joint in range(1, len(skeleton)):
        parent = skeleton.parents[joint]
        np.einsum("fxy,y->fx", matrices[parent], skeleton.offsets[joint], out=positions[joint])
        positions[joint] += positions[parent]
        matrices[joint] = matrices[parent] @ matrices[joint]
    return GlobalPoses(np.swapaxes(positions, 0, 1), np.swapaxes(matrices, 0, 1))


def world_positions(parents: Indices, positions: Array, local: Array) -> Array:
    """Compute the world positions of joints whose positions in their parents' frames may vary, (F, J, 3).

    Parameters
    ----------
    parents : shape (J,), -1 for the root, each before its children.
    positions : shape (F, J, 3), of the joints in their parents' frames, and of the root in the world.
    local : shape (F, J, 4), unit quaternions relative to the parents' frames.

    Examples
    --------
    >>> pose = np.array([[rotations.about_y(np.pi / 2), [1, 0, 0, 0]]])
    >>> positions = np.array([[[0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]])
    >>> world_positions(np.array([-1, 0]), positions, pose)[0, 1].round(6) + 0.0
    array([1., 2., 0.])
    """
    matrices = rotations.to_matrix(np.swapaxes(local, 0, 1))
    for joint in range(1, len(parents)):
        matrices[joint] = matrices[parents[joint]] @ matrices[joint]
    bones = np.swapaxes(positions, 0, 1)[..., None]
    world = bones[..., 0].copy()
    world[1:] = (matrices[parents[1:]] @ bones[1:])[..., 0]
    for joint in range(1, len(parents)):
        world[joint] += world[parents[joint]]
    return np.ascontiguousarray(np.swapaxes(world, 0, 1))


def velocities(positions: Array, fps: float) -> Array:
    """Differentiate positions over frames: central differences, one-sided at both ends.

    Parameters
    ----------
    positions : shape (F, ...), metres, with at least two frames.
    fps : frames per second.

    Returns
    -------
    Shape (F, ...), metres per second.

    Raises
    ------
    MocapError : for fewer than two frames.

    Examples
    --------
    >>> velocities(np.array([0.0, 1.0, 2.0]), 30.0)
    array([30., 30., 30.])

    Notebook: 01b-motion-files
    """
    if len(positions) < 2:
        raise MocapError(f"A velocity needs at least two frames, got {len(positions)}.")
    return np.asarray(np.gradient(positions, 1 / fps, axis=0))
