"""What jolts is eased, what does not is left alone."""

import numpy as np
import pytest

from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.knee_smoothing import smooth_knees

WALK = sample("walk_straight")[200:500]
LEGS = find_legs(WALK.skeleton)
POSES = forward_kinematics(WALK)
FREE = np.arange(len(WALK)) >= 150
NOTHING = np.zeros((len(WALK), 3))


def targets(*shifts, planted=~FREE):
    return [
        FootTarget(POSES.positions[:, leg.ankle] + shift, NOTHING, planted)
        for leg, shift in zip(LEGS, shifts, strict=True)
    ]


def test_calm_knees_are_left_alone():
    wanted = targets(0.0, 0.0)
    rise, eased, jolts = smooth_knees(WALK, LEGS, POSES, wanted, np.zeros(len(WALK)))
    assert np.all(rise == 0)
    assert all(np.array_equal(a.ankle, b.ankle) for a, b in zip(wanted, eased, strict=True))
    assert jolts.max() <= 0


@pytest.mark.parametrize("frame", [60, 220])
def test_a_root_that_starts_is_calmed_and_changed_only_around(frame):
    start = np.zeros(len(WALK))
    start[frame] = -0.003  # 120 Hz: the root and both knees jolt with some 40 m/s²
    wanted = targets(0.0, 0.0)
    rise, eased, jolts = smooth_knees(WALK, LEGS, POSES, wanted, start)
    assert np.abs(np.diff(rise, 2)).max() < 0.7 * np.abs(np.diff(start, 2)).max()
    assert jolts.max() <= 0.001
    near = np.abs(np.arange(len(WALK)) - frame) < 40
    assert np.abs((rise - start)[~near]).max() < 1e-3
    assert all(np.array_equal(a.ankle[~FREE], b.ankle[~FREE]) for a, b in zip(wanted, eased, strict=True))


def test_two_frames_cannot_jolt():
    short = WALK[:2]
    poses = forward_kinematics(short)
    still = [FootTarget(poses.positions[:, leg.ankle], NOTHING[:2], FREE[:2]) for leg in LEGS]
    rise, _, jolts = smooth_knees(short, LEGS, poses, still, np.array([0.0, 0.01]))
    assert rise.tolist() == [0.0, 0.01]
    assert jolts.tolist() == [0.0, 0.0]
