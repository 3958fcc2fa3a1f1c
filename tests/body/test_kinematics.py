"""Forward kinematics against the recursion written down once more, one joint at a time."""

import numpy as np
import pytest
from hypothesis import given

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, velocities
from tests.refusals import refused
from tests.strategies import random_motion, seeds


@given(seeds)
def test_every_joint_is_where_the_recursion_puts_it(seed):
    motion = random_motion(seed, frames=2)
    poses, own = forward_kinematics(motion), rotations.to_matrix(motion.rotations)
    positions, matrices = [motion.root_positions], [own[:, 0]]
    for joint, parent in enumerate(motion.skeleton.parents[1:], 1):
        positions.append(positions[parent] + matrices[parent] @ motion.skeleton.offsets[joint])
        matrices.append(matrices[parent] @ own[:, joint])
    assert poses.positions == pytest.approx(np.stack(positions, axis=1), abs=1e-12)
    assert poses.matrices == pytest.approx(np.stack(matrices, axis=1), abs=1e-12)


def test_velocities_of_a_parabola_are_exact_inside():
    t = np.arange(10) / 50
    assert velocities(t**2, 50.0)[1:-1] == pytest.approx(2 * t[1:-1])

    refused("at least two frames, got 1", velocities, np.zeros((1, 4, 3)), 30.0)
