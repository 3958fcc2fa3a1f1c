"""What jolts is smoothed, what does not jolt is left alone."""

import numpy as np
import pytest

from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.knee_smoothing import smooth_knees
from mocap.feet.leg_track import LegTrack

WALK = sample("walk_straight")[200:500]
POSES = forward_kinematics(WALK)
TRACKS = [LegTrack(WALK, leg, POSES) for leg in find_legs(WALK.skeleton)]
FREE = np.arange(len(WALK)) >= 150
NOTHING = np.zeros((len(WALK), 3))


def targets(*shifts, planted=~FREE):
    return [
        FootTarget(track.ankle + shift, NOTHING, planted) for track, shift in zip(TRACKS, shifts, strict=True)
    ]


def test_knees_that_do_not_jolt_are_left_alone():
    wanted = targets(0.0, 0.0)
    smoothed, rise, jolts = smooth_knees(TRACKS, wanted, np.zeros(len(WALK)))
    assert np.all(rise == 0)
    assert all(np.array_equal(a.ankle, b.ankle) for a, b in zip(wanted, smoothed, strict=True))
    assert jolts.max() <= 0


@pytest.mark.parametrize("frame", [60, 220])
def test_a_root_that_starts_is_smoothed_and_changed_only_around(frame):
    start = np.zeros(len(WALK))
    start[frame] = -0.003  # 120 Hz: the root and both knees jolt with some 40 m/s²
    wanted = targets(0.0, 0.0)
    smoothed, rise, jolts = smooth_knees(TRACKS, wanted, start)
    assert np.abs(np.diff(rise, 2)).max() < 0.7 * np.abs(np.diff(start, 2)).max()
    assert jolts.max() <= 0.001
    near = np.abs(np.arange(len(WALK)) - frame) < 40
    assert np.abs((rise - start)[~near]).max() < 1e-3
    assert all(np.array_equal(a.ankle[~FREE], b.ankle[~FREE]) for a, b in zip(wanted, smoothed, strict=True))


def test_two_frames_cannot_jolt():
    poses = forward_kinematics(WALK[:2])
    tracks = [LegTrack(WALK[:2], track.leg, poses) for track in TRACKS]
    still = [FootTarget(track.ankle, NOTHING[:2], FREE[:2]) for track in tracks]
    _, rise, jolts = smooth_knees(tracks, still, np.array([0.0, 0.01]))
    assert rise.tolist() == [0.0, 0.01]
    assert jolts.tolist() == [0.0, 0.0]
