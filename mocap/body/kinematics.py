"""Forward kinematics of a motion, velocities, and the detection of hinge joints."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.joint_trees import GlobalPoses as GlobalPoses
from mocap.body.joint_trees import place_joints
from mocap.body.joint_trees import velocities as velocities
from mocap.body.motion import Motion, require_motion
from mocap.body.skeleton import Skeleton
from mocap.body.tuned import TUNED


def forward_kinematics(motion: Motion) -> GlobalPoses:
    """Compute the positions and rotations of all joints in the world, from the root down the tree.

    R_j = R_parent · L_j and p_j = p_parent + R_parent · offset_j, where L_j is the joint's local rotation.

    Parameters
    ----------
    motion : F frames of J joints.

    Returns
    -------
    Positions (F, J, 3), metres, and rotation matrices (F, J, 3, 3).

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> arm = Skeleton(["shoulder", "hand"], [-1, 0], [[0, 0, 0], [0, 0, 1]])
    >>> rotated = Motion(arm, [[0, 2, 0]], [[rotations.about_y(np.pi / 2), [1, 0, 0, 0]]], 30.0)
    >>> forward_kinematics(rotated).positions[0, 1].round(6) + 0.0
    array([1., 2., 0.])

    Notebook: 13-retargeting
    """
    require_motion(motion)
    return place_joints(motion.skeleton, motion.root_positions, motion.rotations)


def joint_positions(motion: Motion) -> Array:
    """Compute the positions of all joints by `forward_kinematics`, shape (F, J, 3), metres.

    `Motion.positions` computes them once and caches them.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> joint_positions(sample("walk_straight")[:10]).shape
    (10, 38, 3)

    Notebook: 01-skeletons-and-clips
    """
    return forward_kinematics(motion).positions


def positions_of(motion: Motion, joints: Sequence[int]) -> Array:
    """Compute the positions of N joints alone, shape (F, N, 3), metres: only joints above them are placed.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:10]
    >>> bool((positions_of(walk, [5, 3]) == joint_positions(walk)[:, [5, 3]]).all())
    True
    """
    skeleton = motion.skeleton
    placed = sorted({above for joint in joints for above in skeleton.path_to_root(joint)})
    row = {joint: number for number, joint in enumerate(placed)}
    names = [skeleton.names[joint] for joint in placed]
    parents = [row.get(int(skeleton.parents[joint]), -1) for joint in placed]
    limbs = Skeleton(names, parents, skeleton.offsets[placed])
    world = place_joints(limbs, motion.root_positions, motion.rotations[:, placed])
    return world.positions[:, [row[joint] for joint in joints]]


def hinge_of(motion: Motion, joint: int) -> Array | None:
    """Estimate the axis of a hinge joint, a unit vector in the joint's frame; None for other joints.

    A joint is a hinge if its rotation vectors, relative to the mean rotation, vary along one direction only
    (by their singular values). A joint that hardly rotates in the clip is a hinge if its file has one axis
    for it. Edited as a ball joint, a knee satisfies its constraints equally well, but twists by up to 19°.

    Parameters
    ----------
    motion : F frames.
    joint : the index of the joint.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> hinge_of(sample("walk_straight"), 3).round(6) + 0.0  # the left knee
    array([1., 0., 0.])
    """
    quaternions = motion.rotations[:, joint]
    vectors = rotations.difference(rotations.mean(quaternions), quaternions)
    _, spread, axes = np.linalg.svd(vectors - vectors.mean(axis=0), full_matrices=False)
    if len(vectors) > 3 and spread[0] > TUNED.still * np.sqrt(len(vectors)):
        return np.asarray(axes[0]) if spread[1] < TUNED.hinge * spread[0] else None
    dofs = motion.skeleton.dofs[joint]
    if len(dofs) != 1:
        return None
    return rotations.rotate(motion.skeleton.axes[joint], np.eye(3)["xyz".index(dofs)])
