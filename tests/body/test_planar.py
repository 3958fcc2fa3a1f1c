"""Kinematics by the recursion written down; transforms do to a motion what they do to its points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import euler, rotations
from mocap.body.kinematics import forward_kinematics, joint_positions, velocities
from mocap.body.planar import IDENTITY, PlanarTransform, align_frames, from_ground, heading, on_ground, place
from tests.refusals import refusals, refused
from tests.strategies import planar, random_motion, seeds

POINTS = np.random.default_rng(0).normal(size=(4, 5, 3))


@given(planar, planar, planar)
def test_transforms_form_a_group_and_keep_heights_and_distances(a, b, c):
    moved = b.apply_points(POINTS)
    assert (a @ b).apply_points(POINTS) == pytest.approx(a.apply_points(moved), abs=1e-9)
    assert moved[..., 1] == pytest.approx(POINTS[..., 1])
    apart, before = (np.linalg.norm(points[0] - points[1], axis=-1) for points in (moved, POINTS))
    assert apart == pytest.approx(before)
    for both in (a @ a.inverse(), a.inverse() @ a):
        assert both == pytest.approx(IDENTITY, abs=1e-9)
    left, right = (a @ b) @ c, a @ (b @ c)
    assert left.apply_points(POINTS) == pytest.approx(right.apply_points(POINTS), abs=1e-9)
    for same in (a @ IDENTITY, IDENTITY @ a):
        assert same.apply_points(POINTS) == pytest.approx(a.apply_points(POINTS), abs=1e-9)
    assert a.rotation * on_ground(POINTS) + a.translation == pytest.approx(
        on_ground(a.apply_points(POINTS)), abs=1e-9
    )
    both = PlanarTransform.from_complex(a.rotation * b.rotation, a.rotation * b.translation + a.translation)
    assert both.apply_points(POINTS) == pytest.approx((a @ b).apply_points(POINTS), abs=1e-9)
    assert from_ground(on_ground(POINTS)) == pytest.approx(POINTS[..., [0, 2]])


lean = st.builds(
    lambda axis, angle: rotations.from_rotvec([angle * np.cos(axis), 0.0, angle * np.sin(axis)]),
    st.floats(-3.1, 3.1),
    st.floats(0.0, 3.0),
)


@given(planar, seeds)
def test_a_moved_motion_puts_its_joints_where_its_moved_points_are(transform, seed):
    motion = random_motion(seed)
    assert joint_positions(transform.apply_motion(motion)) == (
        pytest.approx(transform.apply_points(joint_positions(motion)), abs=1e-9)
    )


@given(st.floats(-3.1, 3.1), lean, planar)
def test_heading_is_the_turn_beside_any_lean_and_turns_with_the_body(angle, lean, transform):
    body = rotations.multiply(rotations.about_y(angle), lean)
    for same in (body, -body):
        assert heading(same) == pytest.approx(angle, abs=1e-9)
    turned = heading(transform.apply_frames(np.zeros(3), body[None])[1][0])
    assert np.exp(1j * turned) == pytest.approx(np.exp(1j * (angle + transform.angle)), abs=1e-9)


def test_looking_up_the_homework_s_heading_is_lost_and_heading_is_not():
    on_the_side = rotations.multiply(rotations.about_y(0.7), euler.from_euler("z", [np.pi / 2]))
    nearly = rotations.multiply(on_the_side, rotations.from_rotvec([0.0, 1e-9, 0.0]))
    lefts = [rotations.to_matrix(q)[..., 0] for q in (on_the_side, nearly)]  # the homework's formula
    assert abs(np.subtract(*(np.arctan2(-left[2], left[0]) for left in lefts))) > 0.1
    assert heading(on_the_side) == pytest.approx(0.7)
    assert heading(nearly) == pytest.approx(0.7)
    assert heading([0.0, 1.0, 0.0, 0.0]) == 0  # upside down there is none


@given(seeds, st.floats(-3.1, 3.1), st.floats(-50, 50), st.floats(-50, 50))
def test_a_placed_motion_stands_and_faces_where_it_should(seed, angle, x, z):
    motion = random_motion(seed)
    placed = place(motion, angle, (x, z))
    assert placed.root_positions[0] == pytest.approx([x, motion.root_positions[0, 1], z])
    assert np.exp(1j * heading(placed.rotations[0, 0])) == pytest.approx(np.exp(1j * angle), abs=1e-6)
    assert placed.root_positions[:, 1] == pytest.approx(motion.root_positions[:, 1])


test_a_place_must_be_one = refusals(
    ("finite direction and position", place, random_motion(0), np.nan, (0, 0)),
    ("finite direction and position", place, random_motion(0), 0.0, (np.inf, 0)),
    ("finite direction and position", place, random_motion(0), 0.0, (1, 2, 3)),
)


@given(seeds, seeds)
def test_a_motion_laid_on_another_has_its_heading_and_place(seed, other):
    motion, target = random_motion(seed), random_motion(other)
    laid = align_frames(motion, target, 2).apply_motion(motion)
    assert laid.root_positions[0, [0, 2]] == pytest.approx(target.root_positions[2, [0, 2]], abs=1e-9)
    turned = np.exp(1j * heading(laid.rotations[0, 0]))
    assert turned == pytest.approx(np.exp(1j * heading(target.rotations[2, 0])), abs=1e-6)


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
