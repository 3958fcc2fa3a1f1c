"""After a cut the offset fades as the quintic says, for roots and for joints."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.inertialization import inertialize
from mocap.blending.joining import lay_window_on
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from tests.strategies import random_motion, seeds, wave

A, B = wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)


def test_an_inertialized_cut_keeps_pose_and_velocity():
    cut = inertialize(A, 60, B, 20, 16)
    now, own = joint_positions(cut), joint_positions(A)
    assert now[60] == pytest.approx(own[60], abs=1e-9)
    # Frame 61 is a's own, but for half a frame's difference in acceleration.
    assert now[61] == pytest.approx(own[61], abs=0.03)
    assert rotations.angle_between(cut.rotations[60], A.rotations[60]) == pytest.approx(0, abs=1e-6)


def test_the_offset_dies_away_by_the_quintic():
    laid = lay_window_on(A, 60, B, 20, 16)
    gap = A.root_positions[59:62] - laid.root_positions[19:22]
    x, v = gap[1], (gap[2] - gap[0]) / 2
    # Six coefficients from six equations: place and speed at u = 0; at u = 1 all zero, up to the jerk.
    falling = [np.polynomial.Polynomial.basis(n) for n in range(6)]
    at = [[p.deriv(order)(1.0) for p in falling] for order in range(4)]
    coefficients = np.linalg.solve(
        np.array([np.eye(6)[0], np.eye(6)[1], *at]), [x, 16 * v, *np.zeros((4, 3))]
    )
    wanted = (np.arange(16)[:, None] / 16) ** np.arange(6) @ coefficients
    offset = inertialize(A, 60, B, 20, 16).root_positions[60:76] - laid.root_positions[20:36]
    assert offset == pytest.approx(wanted, abs=1e-9)


@given(seeds, st.integers(1, 5))
def test_any_two_poses_can_be_cut_without_a_spin(seed, window):
    a = random_motion(seed, frames=10)
    b = random_motion(seed + 1, frames=10, skeleton=a.skeleton)
    cut = inertialize(a, 3, b, 2, window)
    assert cut.root_positions[3] == pytest.approx(a.root_positions[3], abs=1e-9)
    assert rotations.angle_between(cut.rotations[3], a.rotations[3]) == pytest.approx(0, abs=1e-6)


AXES = np.array([[1, 0, 0], [0.6, 0, 0.8]])  # about which the knee and the foot turn


def leg(angles):
    """A leg whose knee and foot turn by these angles (F, 2), radians."""
    bones = Skeleton(["hip", "knee", "foot"], [-1, 0, 1], [[0, 0, 0], [0, -1, 0], [0, -1, 0]])
    turns = np.zeros((len(angles), 3, 3))
    turns[:, 1:] = angles[..., None] * AXES
    return Motion(bones, np.zeros((len(angles), 3)), rotations.from_rotvec(turns), 30.0)


@pytest.mark.parametrize(("i", "j", "before"), [(4, 3, 1), (1, 1, 1), (0, 3, 0), (4, 0, 0), (0, 0, 0)])
@pytest.mark.parametrize("gap", [0.5, -0.5, np.pi - 0.05, np.pi + 0.05, 5.0])
def test_the_turn_of_a_joint_fades_by_the_quintic_from_its_angle_and_speed(i, j, before, gap):
    """The speed is measured from the frame before the cut, where both clips have one, to that after it."""
    window, time = 6, np.arange(20.0)[:, None]
    a = np.array([gap, 0.3]) + [0.1, 0.2] * (time - i) + 0.005 * (time - i) ** 2
    b = [0.02, -0.01] * (time - j) ** 2
    offset = (np.array([gap, 0.3]) + np.pi) % (2 * np.pi) - np.pi  # the short way round
    speed = ((a[i + 1] - b[j + 1]) - (a[i - before] - b[j - before])) / (before + 1)
    u = np.arange(window)[:, None] / window
    fading = (1 - u) ** 4 * (offset + (4 * offset + speed * window) * u)
    cut = inertialize(leg(a), i, leg(b), j, window)
    wanted = leg(np.concatenate([a[:i], b[j : j + window] + fading, b[j + window :]]))
    gaps = rotations.angle_between(cut.rotations[:, 1:], wanted.rotations[:, 1:])
    assert gaps == pytest.approx(0, abs=1e-6)


def test_over_a_window_of_one_frame_only_that_frame_is_the_first_clip_s():
    cut, laid = inertialize(A, 60, B, 20, 1), lay_window_on(A, 60, B, 20, 1)
    assert cut.root_positions[60] == pytest.approx(A.root_positions[60], abs=1e-12)
    assert np.array_equal(cut.root_positions[61:], laid.root_positions[21:])


def test_a_cut_at_the_last_frames_of_both_clips_needs_no_frame_after_them():
    cut = inertialize(A, 119, B, 89, 1)
    assert len(cut) == 120
    assert cut.root_positions == pytest.approx(A.root_positions, abs=1e-12)
