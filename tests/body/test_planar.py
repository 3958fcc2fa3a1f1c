"""Planar transforms form a group, and do to a motion what they do to its points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import euler, rotations
from mocap.body.kinematics import joint_positions
from mocap.body.planar import IDENTITY, PlanarTransform, facing, heading, place
from mocap.errors import MocapError
from tests.strategies import planar, random_motion, seeds

POINTS = np.random.default_rng(0).normal(size=(4, 5, 3))


@given(planar, planar)
def test_after_is_one_then_the_other(second, first):
    assert second.after(first).points(POINTS) == pytest.approx(second.points(first.points(POINTS)), abs=1e-9)


@given(planar)
def test_the_inverse_undoes(transform):
    for both in (transform.after(transform.inverse()), transform.inverse().after(transform)):
        assert both == pytest.approx(IDENTITY, abs=1e-9)


@given(planar)
def test_heights_and_distances_stay(transform):
    moved = transform.points(POINTS)
    assert moved[..., 1] == pytest.approx(POINTS[..., 1])
    assert np.linalg.norm(moved[0] - moved[1], axis=-1) == (
        pytest.approx(np.linalg.norm(POINTS[0] - POINTS[1], axis=-1))
    )


@given(planar, seeds)
def test_orientations_turn_as_vectors_do(transform, seed):
    motion = random_motion(seed)
    turn = transform._replace(x=0.0, z=0.0)
    forward = rotations.rotate(motion.rotations[:, 0], [0, 0, 1])
    assert rotations.rotate(transform.motion(motion).rotations[:, 0], [0, 0, 1]) == (
        pytest.approx(turn.points(forward), abs=1e-9)
    )


@given(st.floats(-3.1, 3.1), st.floats(-1.2, 1.2))
def test_heading_of_a_turned_body_leaning_forward(angle, lean):
    body = rotations.multiply(rotations.about_y(angle), euler.from_euler("x", [lean]))
    assert heading(body) == pytest.approx(angle, abs=1e-9)


@given(planar, st.floats(-3.1, 3.1))
def test_a_transform_adds_its_angle_to_the_heading(transform, angle):
    after = heading(transform.orientations(rotations.about_y(angle)))
    assert np.exp(1j * after) == pytest.approx(np.exp(1j * (transform.angle + angle)), abs=1e-9)


def test_many_transforms_at_once():
    many = PlanarTransform(np.array([0.1, 0.2]), np.array([1.0, 2.0]), np.array([3.0, 4.0]))
    both = many.after(many.inverse())
    assert np.stack(both) == pytest.approx(np.zeros((3, 2)), abs=1e-12)
    one = PlanarTransform(0.2, 2.0, 4.0)
    assert many.points(POINTS[0, 0])[1] == pytest.approx(one.points(POINTS[0, 0]))


lean = st.builds(
    lambda axis, angle: rotations.from_rotvec([angle * np.cos(axis), 0.0, angle * np.sin(axis)]),
    st.floats(-3.1, 3.1),
    st.floats(0.0, 3.0),
)


@given(planar, planar, planar)
def test_composition_is_associative_and_the_identity_neutral(a, b, c):
    left, right = a.after(b).after(c), a.after(b.after(c))
    assert left.points(POINTS) == pytest.approx(right.points(POINTS), abs=1e-9)
    for same in (a.after(IDENTITY), IDENTITY.after(a)):
        assert same.points(POINTS) == pytest.approx(a.points(POINTS), abs=1e-9)


@given(planar, seeds)
def test_a_moved_motion_puts_its_joints_where_its_moved_points_are(transform, seed):
    motion = random_motion(seed)
    assert joint_positions(transform.motion(motion)) == (
        pytest.approx(transform.points(joint_positions(motion)), abs=1e-9)
    )


@given(st.floats(-3.1, 3.1), lean)
def test_facing_is_the_turn_beside_any_lean(angle, lean):
    assert facing(rotations.multiply(rotations.about_y(angle), lean)) == pytest.approx(angle, abs=1e-9)


@given(st.floats(-3.1, 3.1), lean, planar)
def test_turning_a_body_turns_its_facing_even_where_it_lies_down(angle, lean, transform):
    body = rotations.multiply(rotations.about_y(angle), lean)
    turned = facing(transform.orientations(body))
    assert np.exp(1j * turned) == pytest.approx(np.exp(1j * (angle + transform.angle)), abs=1e-9)


@given(seeds)
def test_facing_is_the_same_for_both_quaternions_of_a_rotation(seed):
    quaternions = random_motion(seed).rotations
    assert facing(-quaternions) == pytest.approx(facing(quaternions), abs=1e-12)


def test_looking_up_the_homework_s_heading_is_lost_and_facing_is_not():
    on_the_side = rotations.multiply(rotations.about_y(0.7), euler.from_euler("z", [np.pi / 2]))
    nearly = rotations.multiply(on_the_side, rotations.from_rotvec([0.0, 1e-9, 0.0]))
    assert abs(heading(on_the_side) - heading(nearly)) > 0.1
    assert facing(on_the_side) == pytest.approx(0.7)
    assert facing(nearly) == pytest.approx(0.7)


def test_upside_down_there_is_no_facing_and_it_is_0():
    assert facing([0.0, 1.0, 0.0, 0.0]) == 0


@given(seeds, st.floats(-3.1, 3.1), st.floats(-50, 50), st.floats(-50, 50))
def test_a_placed_motion_stands_and_faces_where_it_should(seed, angle, x, z):
    motion = random_motion(seed)
    placed = place(motion, angle, (x, z))
    assert placed.root_positions[0] == pytest.approx([x, motion.root_positions[0, 1], z])
    assert np.exp(1j * facing(placed.rotations[0, 0])) == pytest.approx(np.exp(1j * angle), abs=1e-6)
    assert placed.root_positions[:, 1] == pytest.approx(motion.root_positions[:, 1])


@pytest.mark.parametrize(("angle", "position"), [(np.nan, (0, 0)), (0.0, (np.inf, 0)), (0.0, (1, 2, 3))])
def test_a_place_must_be_one(angle, position):
    with pytest.raises(MocapError, match="finite heading and position"):
        place(random_motion(0), angle, position)
