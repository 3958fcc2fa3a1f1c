"""What jolts is smoothed, what does not jolt is left alone."""

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.knee_smoothing import LOST_IN_POSES, NEAR, QUIET, USUAL, _solve_changes, smooth_knees
from mocap.feet.leg_track import UP, bend_and_swing, track_leg

WALK = sample("walk_straight")[200:500]
POSES = forward_kinematics(WALK)
TRACKS = [track_leg(WALK, leg, POSES) for leg in find_legs(WALK.skeleton)]
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
    tracks = [track_leg(WALK[:2], track.leg, poses) for track in TRACKS]
    still = [FootTarget(track.ankle, NOTHING[:2], FREE[:2]) for track in tracks]
    _, rise, jolts = smooth_knees(tracks, still, np.array([0.0, 0.01]))
    assert rise.tolist() == [0.0, 0.01]
    assert jolts.tolist() == [0.0, 0.0]


def test_changes_solve_the_least_squares():
    """Against all equations in one dense matrix."""
    random = np.random.default_rng(0)
    knees, slopes = random.normal(size=(2, 9, 3)), random.normal(size=(3, 2, 9, 3))
    excess, before = np.maximum(random.normal(size=(2, 7)), 0), random.normal(size=(3, 9))
    bends = []
    for kind, frame in np.ndindex(3, 9):
        moved = np.zeros((2, 9, 3))
        moved[:, frame] = slopes[kind, :, frame]
        bends.append(np.diff(moved, 2, axis=1).ravel())
    weight = np.sqrt(np.where(excess > 0, 1.0, QUIET)).repeat(3)
    aim = -(excess[..., None] * np.diff(knees, 2, axis=1)).ravel()
    rows = np.concatenate([np.transpose(bends) * weight[:, None], np.sqrt(NEAR) * np.eye(27)])
    solution = np.linalg.lstsq(rows, np.concatenate([weight * aim, -np.sqrt(NEAR) * before.ravel()]))[0]
    assert _solve_changes(knees, slopes, excess, before).ravel() == pytest.approx(solution)


def knee_of(track, target, rise):
    hip = track.hip + rise[:, None] * UP
    return hip + rotations.rotate(bend_and_swing(track, target.ankle - hip)[1], track.knee - track.hip)


def test_the_worst_knee_counts():
    """All frames are planted, and one foot leaps: its knee jolts most, and smoothing cannot help it."""
    leap = np.zeros((len(WALK), 3))
    leap[150, 1] = 0.01
    wanted = targets(leap, 0.0, planted=np.ones(len(WALK), bool))
    smoothed, rise, jolts = smooth_knees(TRACKS, wanted, np.zeros(len(WALK)))
    knees = [knee_of(track, target, rise) for track, target in zip(TRACKS, smoothed, strict=True)]
    own = np.linalg.norm(np.diff([track.knee for track in TRACKS], 2, axis=1), axis=-1)
    bound = np.maximum(own, np.percentile(own, USUAL, method="lower")) + LOST_IN_POSES
    now = np.linalg.norm(np.diff(knees, 2, axis=1), axis=-1) / bound - 1
    assert jolts[1:-1] == pytest.approx(now.max(axis=0))
    assert now[0].max() > now[1].max() + 0.1
