"""Short gaps run along cubic curves, which continue the motion on both sides."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from mocap.body import joint_positions, resample, rotations
from mocap.datasets import samples
from mocap.errors import MocapError
from mocap.methods.in_betweening import interpolate


def test_the_root_runs_along_the_spline_of_another_library():
    walk = resample(samples.sample("walk_curve_1"), 30)
    first, second, frames = walk[:60], walk[67:], 8
    ends = np.stack([first.root_positions[-1], second.root_positions[0]])
    speeds = np.stack([np.diff(walk.root_positions[a : a + 2], axis=0)[0] for a in (58, 67)])
    spline = CubicHermiteSpline([0, frames], ends, speeds)
    found = interpolate(first, second, frames)
    np.testing.assert_allclose(found.root_positions, spline(np.arange(frames + 1)), atol=1e-12)


def test_single_poses_are_joined_by_a_straight_line_and_by_slerp():
    walk = resample(samples.sample("walk_curve_1"), 30)
    found = interpolate(walk[59:60], walk[65:66], 6)
    share = np.arange(7) / 6
    line = walk.root_positions[59] + share[:, None] * (walk.root_positions[65] - walk.root_positions[59])
    np.testing.assert_allclose(found.root_positions, line, atol=1e-12)
    amounts = np.broadcast_to(share[:, None], (7, len(walk.skeleton)))
    turns = rotations.slerp(walk.rotations[59], walk.rotations[65], amounts)
    assert rotations.angle_between(found.rotations, turns).max() < 1e-6


def test_a_gap_is_filled_nearer_to_what_was_there_than_by_a_straight_line():
    """The mean distance of joints over gaps of five frames; it is 0.5 to 0.7 times that of the line."""
    walk = resample(samples.sample("walk_curve_2"), 30)
    places = joint_positions(walk)
    errors = {"cubic": [], "line": []}
    for start in range(20, len(walk) - 20, 9):
        curve = interpolate(walk[: start + 1], walk[start + 6 :], 6)
        line = interpolate(walk[start : start + 1], walk[start + 6 : start + 7], 6)
        for name, motion in (("cubic", curve), ("line", line)):
            off = np.linalg.norm(joint_positions(motion) - places[start : start + 7], axis=-1)
            errors[name].append(off.mean())
    assert np.mean(errors["cubic"]) < 0.85 * np.mean(errors["line"])


def test_two_rates_and_no_frame_are_refused():
    walk = samples.sample("walk_straight")
    for first, second, frames in ((walk, resample(walk, 30), 5), (walk, walk, 0)):
        with pytest.raises(MocapError, match=r"one rate and a frame or more, got 120 and (30|120) Hz"):
            interpolate(first, second, frames)
