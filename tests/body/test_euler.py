"""Euler angles against SciPy's; two names for one rotation, and gimbal lock."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mocap.body import rotations
from mocap.body.euler import continuous, from_euler, to_euler
from tests.strategies import random_quaternions, seeds

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
