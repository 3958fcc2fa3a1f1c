"""Forward kinematics against a recursion written down once more, one joint at a time."""

import numpy as np
import pytest
from hypothesis import given

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, velocities
from tests.refusals import refused
from tests.strategies import random_motion, seeds


def global_pose(motion, frame, joint):
    """Walk up the tree: the position and the rotation matrix of one joint in one frame."""
    own = rotations.to_matrix(motion.rotations[frame, joint])
    if joint == 0:
        return motion.root_positions[frame], own
    position, matrix = global_pose(motion, frame, motion.skeleton.parents[joint])
    return position + matrix @ motion.skeleton.offsets[joint], matrix @ own


@given(seeds)
def test_every_joint_is_where_the_recursion_puts_it(seed):
    motion = random_motion(seed, frames=2)
    poses = forward_kinematics(motion)
    for frame in range(2):
        for joint in range(len(motion.skeleton)):
            position, matrix = global_pose(motion, frame, joint)
            assert poses.positions[frame, joint] == pytest.approx(position, abs=1e-12)
            assert poses.matrices[frame, joint] == pytest.approx(matrix, abs=1e-12)


def test_velocities_of_a_parabola_are_exact_inside():
    t = np.arange(10) / 50
    assert velocities(t**2, 50.0)[1:-1] == pytest.approx(2 * t[1:-1])

    refused("at least two frames, got 1", velocities, np.zeros((1, 4, 3)), 30.0)
