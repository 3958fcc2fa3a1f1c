"""Quaternions against matrices, and against SciPy's own slerp."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from mocap.body import euler, rotations
from tests.strategies import random_quaternions, seeds


@given(seeds)
def test_multiply_is_the_product_of_the_matrices(seed):
    a, b = random_quaternions(np.random.default_rng(seed), 2, 3, 4)
    product = rotations.to_matrix(a) @ rotations.to_matrix(b)
    assert rotations.to_matrix(rotations.multiply(a, b)) == pytest.approx(product, abs=1e-12)


@given(seeds)
def test_group_axioms(seed):
    a, b, c = random_quaternions(np.random.default_rng(seed), 3, 5)
    left = rotations.multiply(rotations.multiply(a, b), c)
    right = rotations.multiply(a, rotations.multiply(b, c))
    assert rotations.angle_between(left, right) == pytest.approx(0, abs=1e-7)
    assert rotations.angle_between(rotations.multiply(a, rotations.inverse(a)), rotations.IDENTITY) == (
        pytest.approx(0, abs=1e-7)
    )


@given(seeds)
def test_every_form_goes_there_and_back(seed):
    q = random_quaternions(np.random.default_rng(seed), 2, 7)
    for back in (
        rotations.from_matrix(rotations.to_matrix(q)),
        rotations.from_rotvec(rotations.to_rotvec(q)),
        euler.from_euler("ZXY", euler.to_euler("ZXY", q)),
        euler.from_euler("xyz", euler.to_euler("xyz", q)),
    ):
        assert rotations.angle_between(q, back) == pytest.approx(0, abs=1e-6)


def test_euler_orders_are_products_of_single_turns():
    angles = a, b, c = 0.3, -0.7, 1.1
    single = [euler.from_euler(axis, [v]) for axis, v in zip("xyz", angles, strict=True)]
    x, y, z = rotations.to_matrix(single)
    assert rotations.to_matrix(euler.from_euler("xyz", [a, b, c])) == pytest.approx(z @ y @ x)
    assert rotations.to_matrix(euler.from_euler("ZXY", [c, a, b])) == pytest.approx(z @ x @ y)


ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XY", "ZX", "Y"]


@given(seeds, st.sampled_from([*ORDERS, *map(str.lower, ORDERS)]))
def test_from_euler_and_to_matrix_agree_with_scipy(seed, order):
    angles = np.random.default_rng(seed).uniform(-7, 7, (2, 3, len(order)))
    expected = Rotation.from_euler(order, angles.reshape(6, -1))
    found = euler.from_euler(order, angles)
    assert rotations.angle_between(found.reshape(6, 4), expected.as_quat(scalar_first=True)).max() < 1e-12
    assert rotations.to_matrix(1.001 * found).reshape(6, 3, 3) == pytest.approx(expected.as_matrix())


def test_gimbal_lock_keeps_the_rotation():
    locked = euler.from_euler("ZXY", [0.4, np.pi / 2, 0.3])
    back = euler.from_euler("ZXY", euler.to_euler("ZXY", locked))
    assert rotations.angle_between(locked, back) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("order", [*ORDERS[:6], *map(str.lower, ORDERS[:6])])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("start", [0, 150])
def test_angles_stay_continuous_through_gimbal_lock(order, sign, start):
    """The second angle stays at ±90° for a long while, and may begin there, as the others turn on."""
    time = np.linspace(0, 1, 401)[start:]
    second = sign * np.minimum(1.3 + 0.9 * time - 4 * np.maximum(time - 0.7, 0), np.pi / 2)
    angles = np.stack([2 * time + 1, second, 0.9 * np.sin(3 * time) + 0.5], axis=-1)
    assert (np.abs(second) == np.pi / 2).sum() > 100
    turns = euler.from_euler(order, angles)
    found = euler.continuous(order, euler.to_euler(order, turns))
    assert rotations.angle_between(euler.from_euler(order, found), turns).max() < 1e-12
    leave = (np.abs(second) == np.pi / 2).nonzero()[0].max()  # where the third angle is free no more
    steps = np.abs(np.diff(found, axis=0))
    assert np.delete(steps, leave, axis=0).max() < 0.05
    assert steps[leave].max() < 0.5


def test_scalar_first():
    assert rotations.about_y(np.pi) == pytest.approx([0, 0, 1, 0])
    assert rotations.rotate(rotations.about_y(np.pi / 2), [[0, 0, 1], [1, 0, 0]]) == (
        pytest.approx(np.array([[1, 0, 0], [0, 0, -1]]))
    )


@given(seeds)
def test_slerp_is_scipys(seed):
    random = np.random.default_rng(seed)
    ends = random_quaternions(random, 2)
    amounts = random.random(6)
    oracle = Slerp([0, 1], Rotation.from_quat(ends, scalar_first=True))(amounts).as_matrix()
    assert rotations.to_matrix(rotations.slerp(*ends, amounts)) == pytest.approx(oracle, abs=1e-9)


@given(seeds)
def test_slerp_takes_the_short_way_whatever_the_signs(seed):
    a, b = random_quaternions(np.random.default_rng(seed), 2)
    middle = rotations.slerp(a, -b, 0.5)
    assert rotations.angle_between(a, middle) == pytest.approx(rotations.angle_between(a, b) / 2, abs=1e-6)


@given(seeds)
def test_between_is_the_shortest_turn_onto_a_direction(seed):
    a, b = np.random.default_rng(seed).normal(size=(2, 5, 3))
    turn = rotations.between(a, b)
    units = [v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (a, b)]
    assert rotations.rotate(turn, units[0]) == pytest.approx(units[1], abs=1e-9)
    angles = np.arccos(np.clip((units[0] * units[1]).sum(-1), -1, 1))
    assert rotations.angle_between(turn, rotations.IDENTITY) == pytest.approx(angles, abs=1e-6)


def test_no_rotations_at_all_are_fine():
    none, vectors = np.empty((0, 4)), np.empty((0, 3))
    assert rotations.multiply(none, rotations.IDENTITY).shape == (0, 4)
    assert rotations.slerp(none, none, np.empty(0)).shape == (0, 4)
    assert rotations.to_rotvec(none).shape == (0, 3)
    assert rotations.from_rotvec(vectors).shape == (0, 4)
    assert rotations.rotate(none, vectors).shape == (0, 3)
    assert rotations.angle_between(none, none).shape == (0,)
