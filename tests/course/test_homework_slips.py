"""Each slip of the homework shows, and so does its fix."""

from itertools import pairwise

import numpy as np
import pytest

from mocap.body import euler, rotations
from mocap.body.motion import concatenate
from mocap.body.planar import PlanarTransform, lay_on
from mocap.course.homework_slips import chain_on_last, euler_from_zero_to_pi, lay_in_full, turn_in_place
from mocap.datasets.samples import sample

CLIP = sample("walk_straight")
LOW = int(CLIP.root_positions[:600, 1].argmin())
SLICE = CLIP[LOW : LOW + 200]  # starts low in the stride


def lay_on_ground(motion, target, frame):
    return lay_on(motion, target, frame).apply_motion(motion)


def test_laid_in_full_a_clip_drifts_up_and_on_the_ground_it_does_not():
    start = SLICE.root_positions[0, 1]
    step = SLICE.root_positions[:, 1].max() - start
    assert step > 0.02
    full = ground = SLICE
    for visit in range(1, 4):
        full = lay_in_full(SLICE, full, int(full.root_positions[:, 1].argmax()))
        ground = lay_on_ground(SLICE, ground, int(ground.root_positions[:, 1].argmax()))
        assert full.root_positions[0, 1] == pytest.approx(start + visit * step)
        assert np.array_equal(ground.root_positions[:, 1], SLICE.root_positions[:, 1])


def test_both_ways_agree_on_the_ground():
    full, ground = (lay(SLICE, CLIP, 700) for lay in (lay_in_full, lay_on_ground))
    assert full.root_positions[:, [0, 2]] == pytest.approx(ground.root_positions[:, [0, 2]])
    assert full.root_positions[0] == pytest.approx(CLIP.root_positions[700])


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


def test_turned_in_place_the_clip_is_another_one_at_the_second_visit():
    stored = CLIP.root_positions.copy()
    first, second = (turn_in_place(stored, 0.5).copy() for _ in range(2))
    assert np.abs(first - second).max() > 1
    turn = PlanarTransform(0.5, 0.0, 0.0)
    visits = [turn.apply_motion(CLIP).root_positions for _ in range(2)]
    assert all(np.array_equal(a, b) for a, b in pairwise(visits))
    with pytest.raises(ValueError, match="read-only"):
        turn_in_place(CLIP.root_positions, 0.5)
