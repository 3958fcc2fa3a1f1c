"""Quaternions and Euler angles against SciPy's rotations, an independent implementation; and gimbal lock."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from mocap.body import rotations
from mocap.body.euler import continuous, from_euler, to_euler
from tests.strategies import random_quaternions, seeds

AXES = np.eye(4)[1:]  # the vectors x, y, z, as quaternions (0, v)
TINY = [0.0, 1e-300, 1e-160, 1e-20, 1e-9, 1e-4]


def units(seed: int, *shape: int) -> np.ndarray:
    """Return random unit quaternions, evenly over the sphere: of each rotation both, q and -q."""
    quaternions = np.random.default_rng(seed).normal(size=(*shape, 4))
    return quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True)


def scipys(quaternions: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.reshape(quaternions, (-1, 4)), scalar_first=True)


def turned(start: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Turn on from `start` by an angle about one of its own axes, with SciPy."""
    vector = angle * axis / np.linalg.norm(axis)
    return (scipys(start) * Rotation.from_rotvec(vector)).as_quat(scalar_first=True)[0]


def test_z_up_turns_z_upwards_and_y_backwards():
    turned_axes = rotations.rotate(rotations.Z_UP, np.eye(3))
    assert turned_axes == pytest.approx(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), abs=1e-15)


@given(seeds)
def test_multiply_is_scipys_product_broadcasts_and_has_inverses_and_an_identity(seed):
    a, b = units(seed, 2, 7)
    product = rotations.multiply(a, b)
    assert product == pytest.approx((scipys(a) * scipys(b)).as_quat(scalar_first=True), abs=4e-15)
    assert rotations.multiply(-a, b) == pytest.approx(-product, abs=4e-15)
    table = rotations.multiply(a[:, None], b)
    assert table.shape == (7, 7, 4)
    assert table[1, 2] == pytest.approx(rotations.multiply(a[1], b[2]), abs=0)
    for back in (rotations.multiply(a, rotations.inverse(a)), rotations.multiply(rotations.inverse(a), a)):
        assert back == pytest.approx(np.tile(rotations.IDENTITY, (7, 1)), abs=4e-15)
    assert np.array_equal(rotations.multiply(a, rotations.IDENTITY), a)


@given(seeds, st.floats(0.5, 2))
def test_to_matrix_does_what_two_products_do(seed, length):
    q = units(seed, 2, 3)
    turned = rotations.multiply(rotations.multiply(q[..., None, :], AXES), rotations.inverse(q[..., None, :]))
    columns = np.swapaxes(turned[..., 1:], -1, -2)
    for same in (q, -q, length * q):
        assert rotations.to_matrix(same) == pytest.approx(columns, abs=1e-14)
    assert rotations.to_matrix(q[0, 0]) == pytest.approx(columns[0, 0], abs=1e-14)


@given(seeds)
def test_continuous_quaternions_follow_two_whole_turns(seed):
    """After one whole turn a quaternion is -q: neighbours are compared, not all frames with the first."""
    halves = np.linspace(0, 2 * np.pi, 30)
    about_x = np.stack([np.cos(halves), np.sin(halves), 0 * halves, 0 * halves], axis=-1)
    followed = np.stack([about_x, about_x[::-1]], axis=1)  # two joints
    signs = np.random.default_rng(seed).choice([-1.0, 1.0], (30, 2, 1))
    signs[0] = 1.0
    assert np.array_equal(rotations.continuous(signs * followed), followed)


def test_a_quaternion_half_a_turn_away_keeps_its_sign():
    half_a_turn = np.eye(4)[:2]
    assert np.array_equal(rotations.continuous(half_a_turn), half_a_turn)


@given(seeds)
def test_rotation_vectors_are_scipys(seed):
    q = units(seed, 9)
    assert rotations.to_rotvec(q) == pytest.approx(scipys(q).as_rotvec(), abs=1e-14)
    vectors = np.random.default_rng(seed).normal(size=(9, 3)) * 4  # of more than a full turn, too
    expected = Rotation.from_rotvec(vectors).as_quat(scalar_first=True)
    assert rotations.from_rotvec(vectors) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("angle", [*TINY, 1.0, np.pi - 1e-9, np.pi])
@pytest.mark.parametrize("sign", [1, -1])
def test_rotation_vectors_keep_the_smallest_and_the_largest_turns(angle, sign):
    vector = sign * angle * np.array([0.6, 0.0, 0.8])
    q = rotations.from_rotvec(vector)
    assert np.linalg.norm(q) == pytest.approx(1, abs=4e-15)
    for same in (q, 1.5 * q):
        assert rotations.to_rotvec(same) == pytest.approx(vector, rel=1e-13, abs=0)
    assert rotations.to_rotvec(-q) == pytest.approx(vector, rel=1e-13, abs=0) or angle == np.pi


def test_scalar_first():
    assert rotations.about_y(np.pi) == pytest.approx([0, 0, 1, 0])
    assert rotations.rotate(rotations.about_y(np.pi / 2), [[0, 0, 1], [1, 0, 0]]) == (
        pytest.approx(np.array([[1, 0, 0], [0, 0, -1]]))
    )


@given(seeds)
def test_slerp_is_scipys(seed):
    start, end = units(seed, 2)
    amounts = np.random.default_rng(seed).random(6)
    oracle = Slerp([0, 1], scipys([start, end]))(amounts).as_quat(scalar_first=True)
    found = rotations.slerp(start, end, amounts)
    assert rotations.angle_between(found, oracle).max() < 1e-14
    assert np.linalg.norm(found, axis=-1) == pytest.approx(np.ones(6), abs=1e-12)
    table = rotations.slerp(units(seed, 4, 1), units(seed + 1, 6), amounts)  # which broadcasts
    one = rotations.slerp(units(seed, 4, 1)[3, 0], units(seed + 1, 6)[2], amounts[2])
    assert table[3, 2] == pytest.approx(one, abs=4e-15)


ANGLES = st.sampled_from([*TINY, *(np.pi - angle for angle in TINY)]) | st.floats(0, np.pi)


@given(seeds, ANGLES, st.floats(0, 1))
def test_slerp_takes_the_short_way_whatever_the_signs_and_angles(seed, angle, amount):
    random = np.random.default_rng(seed)
    start, axis = units(seed), random.normal(size=3)
    end = turned(start, axis, angle)
    for last in (end, -end):
        part = rotations.slerp(start, last, amount)
        assert np.linalg.norm(part) == pytest.approx(1, abs=1e-12)
        # Room for other last bits: up to 2.7e-15 was measured.
        assert rotations.angle_between(start, part) == pytest.approx(amount * angle, abs=1e-14)
        assert rotations.angle_between(part, last) == pytest.approx((1 - amount) * angle, abs=1e-14)
        assert np.sum(start * part) >= -1e-15  # on the same side of the sphere as the start


@given(seeds)
def test_between_is_the_shortest_turn_onto_a_direction(seed):
    a, b = np.random.default_rng(seed).normal(size=(2, 5, 3))
    turn = rotations.between(a, b)
    units = [v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (a, b)]
    assert rotations.rotate(turn, units[0]) == pytest.approx(units[1], abs=1e-9)
    angles = np.arccos(np.clip((units[0] * units[1]).sum(-1), -1, 1))
    assert rotations.angle_between(turn, rotations.IDENTITY) == pytest.approx(angles, abs=1e-6)


@given(seeds)
def test_the_angle_between_is_scipys(seed):
    a, b = units(seed, 2, 5)
    expected = (scipys(a).inv() * scipys(b)).magnitude()
    assert rotations.angle_between(a, b) == pytest.approx(expected, abs=1e-14)


@given(seeds)
def test_rounds_lead_to_the_rotation_from_which_the_others_cancel_out(seed):
    rng = np.random.default_rng(seed)
    near = rotations.from_rotvec(rng.normal(size=(5, 4, 3)) * 0.5) * rng.choice([-1, 1], (5, 4, 1))
    weights = rng.dirichlet(np.ones(4), 5)
    mean = rotations.mean(near, weights, rounds=20)
    away = rotations.to_rotvec(rotations.multiply(rotations.inverse(mean)[:, None], near))
    np.testing.assert_allclose((weights[..., None] * away).sum(axis=1), 0, atol=1e-9)
    once = rotations.mean(near, weights)
    bare = rotations.mean(near, weights, rounds=0)
    assert rotations.angle_between(once, mean).max() <= max(rotations.angle_between(bare, mean).max(), 1e-9)


ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XY", "ZX", "Y"]


@given(seeds, st.sampled_from([*ORDERS, *map(str.lower, ORDERS)]))
def test_from_euler_is_scipys(seed, order):
    angles = np.random.default_rng(seed).uniform(-7, 7, (2, 3, len(order)))
    expected = Rotation.from_euler(order, angles.reshape(6, -1)).as_quat(scalar_first=True)
    found = from_euler(order, angles)
    assert found.shape == (2, 3, 4)
    assert rotations.angle_between(found.reshape(6, 4), expected).max() < 1e-12


@given(seeds, st.sampled_from(["ZXY", "xyz"]))
def test_there_and_back(seed, order):
    q = random_quaternions(np.random.default_rng(seed), 2, 7)
    back = from_euler(order, to_euler(order, q))
    assert rotations.angle_between(q, back) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("order", [*ORDERS[:6], *map(str.lower, ORDERS[:6])])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("start", [0, 150])
def test_angles_stay_continuous_through_gimbal_lock(order, sign, start):
    """The second angle stays at ±90° for a long while, and may begin there, while the others turn on."""
    time = np.linspace(0, 1, 401)[start:]
    second = sign * np.minimum(1.3 + 0.9 * time - 4 * np.maximum(time - 0.7, 0), np.pi / 2)
    angles = np.stack([2 * time + 1, second, 0.9 * np.sin(3 * time) + 0.5], axis=-1)
    assert (np.abs(second) == np.pi / 2).sum() > 100
    turns = from_euler(order, angles)
    found = continuous(order, to_euler(order, turns))
    assert rotations.angle_between(from_euler(order, found), turns).max() < 1e-12
    leave = (np.abs(second) == np.pi / 2).nonzero()[0].max()  # from here on the third angle matters again
    steps = np.abs(np.diff(found, axis=0))
    assert np.delete(steps, leave, axis=0).max() < 0.05
    assert steps[leave].max() < 0.5
