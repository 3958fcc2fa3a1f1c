"""From local rotations to where every joint is: forward kinematics, velocities, and hinges."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.joint_trees import GlobalPoses as GlobalPoses
from mocap.body.joint_trees import place_joints
from mocap.body.joint_trees import velocities as velocities
from mocap.body.motion import Motion

# A joint is a hinge if its second singular value is below this share of the first. The knees of six sources
# have 0.8 % at most; puppy's, which are no hinges, 45 %.
HINGE = 0.05

# Radians (rms): a joint that turns less in a clip does not show its axis; then the file's axes count.
STILL = 0.01


def forward_kinematics(motion: Motion) -> GlobalPoses:
    """Place every joint in the world, from the root down the tree.

    R_j = R_parent · L_j and p_j = p_parent + R_parent · offset_j, where L_j is the joint's own rotation.

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
    >>> turn = Motion(arm, [[0, 2, 0]], [[rotations.about_y(np.pi / 2), [1, 0, 0, 0]]], 30.0)
    >>> forward_kinematics(turn).positions[0, 1].round(6) + 0.0
    array([1., 2., 0.])

    Notebook: 13-retargeting
    """
    return place_joints(motion.skeleton, motion.root_positions, motion.rotations)


def joint_positions(motion: Motion) -> Array:
    """Return only the positions of `forward_kinematics`, shape (F, J, 3), metres.

    `Motion.positions` keeps them.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> joint_positions(sample("walk_straight")[:10]).shape
    (10, 38, 3)

    Notebook: 01-skeletons-and-clips
    """
    return forward_kinematics(motion).positions


def hinge_of(motion: Motion, joint: int) -> Array | None:
    """Find the one axis about which a joint turns, a unit vector in its own frame, or None.

    A joint is a hinge if its rotation vectors from their mean spread along one direction. Where it hardly
    turns in the clip, it is one if its file gives it one axis. A knee that may turn about three axes meets
    its pins as well, and twists by up to 19°.

    Parameters
    ----------
    motion : the clip that shows it.
    joint : its index.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> hinge_of(sample("walk_straight"), 3).round(6) + 0.0  # the left knee
    array([1., 0., 0.])
    """
    turns = motion.rotations[:, joint]
    deviations = rotations.difference(rotations.mean(turns), turns)
    spread, axes = np.linalg.svd(deviations - deviations.mean(axis=0), full_matrices=False)[1:]
    if len(deviations) > 3 and spread[0] > STILL * np.sqrt(len(deviations)):
        return np.asarray(axes[0]) if spread[1] < HINGE * spread[0] else None
    free = motion.skeleton.dofs[joint]
    if len(free) != 1:
        return None
    return rotations.rotate(motion.skeleton.axes[joint], np.eye(3)["xyz".index(free)])
