"""Feet that slide by a millimetre are put back, and nothing else moves."""

from dataclasses import replace

import numpy as np

from mocap.body import joint_positions, resample
from mocap.datasets import samples
from mocap.feet import clean_up
from mocap.methods.in_betweening.planted_feet import put_back
from tests.editing.test_path_editing import slide


def test_feet_that_slide_are_put_back_without_the_root():
    walk = clean_up(resample(samples.sample("walk_straight"), 30)[:120])
    drift = 0.001 * np.sin(np.arange(120) / 9)[:, None] * [0, 0, 1]
    drift[[0, -1]] = 0
    sliding = replace(walk, root_positions=walk.root_positions + drift)
    found = put_back(sliding)
    assert slide(sliding) > 5e-4
    assert slide(found) < slide(sliding) / 2  # 0.34 times: a straight leg does not reach all the way
    np.testing.assert_array_equal(found.root_positions, sliding.root_positions)
    np.testing.assert_array_equal(found.rotations[[0, -1]], sliding.rotations[[0, -1]])
    assert np.abs(joint_positions(found) - joint_positions(sliding)).max() < 0.02  # knees
