"""Planar transforms form a group, and do to a motion what they do to its points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap import rotations
from mocap.transforms import IDENTITY, PlanarTransform, heading
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
    body = rotations.multiply(rotations.about_y(angle), rotations.from_euler("x", [lean]))
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
