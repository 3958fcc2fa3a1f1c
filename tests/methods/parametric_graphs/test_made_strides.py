"""A stride that was made is a motion: whole, with feet that stand, and as long as its weights say."""

import numpy as np

from mocap.body.kinematics import joint_positions
from mocap.methods.parametric_graphs.made_strides import make_stride
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes
from tests.methods.parametric_graphs.built import space


def test_it_turns_as_asked_and_its_bones_are_whole():
    for asked in (-0.9, 0.0, 0.6):
        made = make_stride(space(), np.array([asked]))
        turn = made.heading[made.frame(1.0)] - made.heading[made.frame(0.0)]
        assert abs(turn - asked) < np.radians(3)  # frames beside phases
        motion = made.motion
        points = joint_positions(motion)
        bones = np.linalg.norm(points[:, 1:] - points[:, motion.skeleton.parents[1:]], axis=-1)
        lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1)
        np.testing.assert_allclose(bones, np.tile(lengths, (len(points), 1)), atol=1e-9)


def test_feet_hardly_slide_while_they_are_planted():
    made = make_stride(space(), np.array([0.3]))
    points, skeleton = joint_positions(made.motion), made.motion.skeleton
    for name, mark in made.motion.contacts.items():
        planted = points[mark, skeleton.index(name)][:, [0, 2]]
        assert mark.any()
        steps = np.linalg.norm(np.diff(planted, axis=0), axis=-1)
        assert np.median(steps) * 30 < 0.15  # m/s


def test_it_is_the_mix_that_its_weights_say_and_knows_what_it_came_to():
    """Mixes of sampled mixes, kept in single precision, against the weights of all strides."""
    tested, asked = space(), np.array([0.4])
    strides, made = tested.strides, make_stride(tested, asked)
    weights = tested.weights(asked)
    np.testing.assert_allclose(made.values, measure_mixes(strides, weights)[0], atol=1e-12)
    poses = np.tensordot(weights[0], strides.poses, 1)
    poses /= np.linalg.norm(poses, axis=-1, keepdims=True)
    frame = made.frame(0.0)
    at = int(np.abs(strides.grid - made.phases[frame]).argmin())
    near = np.abs(made.motion.rotations[frame, 1:] - poses[at - 1 : at + 2, 1:]).min(axis=0)
    assert near.max() < 0.02
