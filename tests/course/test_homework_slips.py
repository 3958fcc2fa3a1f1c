"""Each slip of the homework shows, and so does its fix."""

import numpy as np
import pytest

from mocap.body import euler, rotations
from mocap.body.motion import concatenate
from mocap.course.homework_slips import chain_on_last, euler_from_zero_to_pi
from mocap.datasets.samples import sample

CLIP = sample("walk_straight")
LOW = int(CLIP.root_positions[:600, 1].argmin())
SLICE = CLIP[LOW : LOW + 200]  # starts low in the stride


def test_euler_angles_from_zero_to_pi_are_right_and_cannot_be_blended():
    rock = euler.from_euler("zyx", np.array([[0.05, 0.3, 0.1], [-0.05, 0.3, 0.1]]))
    angles = euler_from_zero_to_pi(rock)
    assert np.all((angles[:, 0] >= 0) & (angles[:, 0] < np.pi))
    back = euler.from_euler("xyz", angles[:, ::-1])
    assert rotations.angle_between(back, rock) == pytest.approx(0, abs=1e-9)
    truth = rotations.slerp(rock[0], rock[1], 0.5)
    slip = euler.from_euler("xyz", angles.mean(axis=0)[::-1])
    assert rotations.angle_between(slip, truth) > 1.0
    assert rotations.angle_between(rock[0], truth) < 0.1


def test_chained_on_its_last_frame_a_clip_stutters_and_as_it_is_it_does_not():
    slices = [CLIP[start : start + 100] for start in (0, 100, 200)]
    steps = [
        np.linalg.norm(np.diff(chain(slices).root_positions, axis=0)[:, [0, 2]], axis=-1)
        for chain in (chain_on_last, concatenate)
    ]
    assert steps[0][[99, 199]] == pytest.approx(0, abs=1e-12)
    assert np.all(steps[1] > 0.005)
    ends = [chain(slices).root_positions[-1, 2] for chain in (chain_on_last, concatenate)]
    assert ends[0] < ends[1] - 0.015
