"""Motions on the spot."""

import numpy as np
import pytest

from mocap.body import joint_positions
from mocap.editing import in_place, repeated
from tests.strategies import wave


def test_all_but_the_travel_stays():
    motion = wave(81, period=40)
    spot = in_place(motion)
    offsets = joint_positions(motion) - motion.root_positions[:, None]
    np.testing.assert_allclose(joint_positions(spot) - spot.root_positions[:, None], offsets, atol=1e-12)
    np.testing.assert_array_equal(spot.root_positions[:, 1], motion.root_positions[:, 1])
    np.testing.assert_array_equal(spot.rotations, motion.rotations)
    np.testing.assert_allclose(
        spot.root_positions[[0, -1]][:, [0, 2]], motion.root_positions[[0, 0]][:, [0, 2]]
    )
    assert np.ptp(motion.root_positions[:, 2]) > 1.5 and np.ptp(spot.root_positions[:, 2]) < 0.01
    assert np.ptp(spot.root_positions[:, 0]) == pytest.approx(0.1, abs=0.01)  # the sway
    assert motion.contacts and spot.contacts == {}


def test_on_the_spot_nothing_changes_but_contacts():
    spot = in_place(wave(81))
    np.testing.assert_allclose(in_place(spot).root_positions, spot.root_positions, atol=1e-12)
    np.testing.assert_array_equal(in_place(spot[:1]).root_positions, spot.root_positions[:1])


def test_copies_of_a_cycle_stay_over_the_same_point():
    rounds = repeated(in_place(wave(41)), 5)
    assert np.ptp(rounds.root_positions[:, [0, 2]], axis=0).max() < 0.15
