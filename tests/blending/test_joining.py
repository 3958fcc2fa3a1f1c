"""Own frames around a smooth passage, by a join and by a cut; what a blend keeps; how an offset fades."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.joining import align_window, blend, inertialize, join
from mocap.blending.weights import cubic_weights, linear_weights, sine_weights
from mocap.body import Motion, Skeleton, rotations
from mocap.errors import MocapError, SkeletonMismatch
from mocap.matching import distance_grid, point_cloud
from tests.refusals import refusals
from tests.strategies import planar, random_motion, wave

A, B = wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)
GRIDS = {window: distance_grid(A, B, window=window) for window in (1, 8)}
GRID = GRIDS[8][20:90, 20:60]
LEAVE, ENTER = (20 + int(n) for n in np.unravel_index(GRID.argmin(), GRID.shape))
both = pytest.mark.parametrize("way", [join, inertialize])


@both
@given(i=st.integers(0, 100), j=st.integers(0, 70), window=st.integers(1, 20))
def test_before_the_window_it_is_a_and_after_it_b_laid_on(way, i, j, window):
    joined = way(A, i, B, j, window)
    laid = align_window(A, i, B, j, window)
    assert len(joined) == i + len(B) - j
    assert np.array_equal(joined.root_positions[:i], A.root_positions[:i])
    assert np.array_equal(joined.rotations[:i], A.rotations[:i])
    assert np.array_equal(joined.root_positions[i + window :], laid.root_positions[j + window :])
    assert np.array_equal(joined.rotations[i + window :], laid.rotations[j + window :])


def test_a_join_is_the_blend_of_the_two_windows():
    """As in [KGP02, 3.3], [WP95, joining]."""
    laid = align_window(A, LEAVE, B, ENTER, 8)
    joined = join(A, LEAVE, B, ENTER, 8)
    mixed = blend(A[LEAVE : LEAVE + 8], laid[ENTER : ENTER + 8], cubic_weights(8))
    assert np.array_equal(joined.rotations[LEAVE : LEAVE + 8], mixed.rotations)


@given(st.sampled_from([*GRIDS]), st.integers(0, 112), st.integers(0, 82), planar)
def test_the_windows_agree_as_well_as_the_distance_grid_says(window, i, j, transform):
    """As in [KGP02, Eqs. 2-4]."""
    laid = align_window(A, i, transform.apply_motion(B), j, window)
    gaps = point_cloud(A)[i : i + window] - point_cloud(laid)[j : j + window]
    assert (gaps**2).sum(-1).mean() == pytest.approx(GRIDS[window][i, j], abs=1e-9)


def pair(seed):
    a = random_motion(seed)
    return a, random_motion(seed + 1, skeleton=a.skeleton)


def test_marks_come_from_the_larger_weight():
    """As in [KGP02, 3.3]."""
    a, b = pair(3)
    a = replace(a, contacts={"joint5": True}, labels={"walk": True})
    b = replace(b, contacts={"joint5": False}, labels={"run": True})
    mixed = blend(a, b, [1.0, 0.6, 0.5, 0.4, 0.0])
    assert mixed.contacts["joint5"].tolist() == [True, True, True, False, False]
    assert mixed.labels["walk"].tolist() == [True, True, True, False, False]
    assert mixed.labels["run"].tolist() == [False, False, False, True, True]


def test_the_offset_dies_away_by_the_quintic():
    laid = align_window(A, 60, B, 20, 16)
    gap = A.root_positions[59:62] - laid.root_positions[19:22]
    x, v = gap[1], (gap[2] - gap[0]) / 2
    # Six coefficients from six equations: place and speed at u = 0; at u = 1 all zero, up to the jerk.
    falling = [np.polynomial.Polynomial.basis(n) for n in range(6)]
    at = [[p.deriv(order)(1.0) for p in falling] for order in range(4)]
    rows = np.array([np.eye(6)[0], np.eye(6)[1], *at])
    coefficients = np.linalg.solve(rows, [x, 16 * v, *np.zeros((4, 3))])
    wanted = (np.arange(16)[:, None] / 16) ** np.arange(6) @ coefficients
    offset = inertialize(A, 60, B, 20, 16).root_positions[60:76] - laid.root_positions[20:36]
    assert offset == pytest.approx(wanted, abs=1e-9)


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


@given(st.sampled_from([cubic_weights, linear_weights]), st.integers(1, 60))
def test_weights_fall_from_one_to_zero_alike_from_both_ends(weights, window):
    alpha = np.array([1.0, *weights(window)])  # with α(-1) in front
    assert alpha[-1] == pytest.approx(0, abs=1e-12)
    assert alpha + alpha[::-1] == pytest.approx(1)
    assert np.all(np.diff(alpha) < 0)
    assert np.all((alpha[1:] >= 0) & (alpha[1:] <= 1))


def slope_and_curve(weights, window):
    """Measure the first and second derivative at the start, by t, from the weights themselves."""
    one, two = weights(window)[:2]
    return (one - 1) * window, (two - 2 * one + 1) * window**2


def test_the_slopes_at_the_ends_are_those_promised():
    """As in [KGP02, Eq. 7]."""
    many = 20_000
    assert slope_and_curve(linear_weights, many)[0] == pytest.approx(-1)
    assert slope_and_curve(cubic_weights, many) == (pytest.approx(0, abs=1e-3), pytest.approx(-6, abs=1e-2))


def test_sine_weights_are_the_homework_s():
    u = [(1 + np.sin(np.pi * i / 49 - np.pi / 2)) / 2 for i in range(50)]
    assert 1 - sine_weights(50) == pytest.approx(u)
    for window in (2, 50):
        assert sine_weights(window)[[0, -1]] == pytest.approx([1, 0], abs=1e-12)


test_what_cannot_be_joined_blended_or_weighed_is_refused = refusals(
    *(
        (kind, sentence, way, A, i, b, j, window)
        for way in (join, inertialize)
        for kind, sentence, i, b, j, window in (
            (MocapError, "frames from frame 113 runs off 'a', which has 120", 113, B, 0, 8),
            (MocapError, "frames from frame 83 runs off 'b', which has 90", 0, B, 83, 8),
            (MocapError, "frames from frame -1 runs off 'a'", -1, B, 0, 8),
            (MocapError, "resample one first", 0, replace(B, fps=60.0), 0, 5),
            (MocapError, "at least one frame, got 0", 0, B, 0, 0),
            (SkeletonMismatch, "joint", 0, random_motion(0, frames=20), 0, 5),
        )
    ),
    (r"got 5, 5, \(4,\)", blend, *pair(0), [0.5] * 4),
    *((r"lie in \[0, 1\]", blend, *pair(0), [0.5] * 4 + [last]) for last in (1.001, -0.001, np.nan)),
    ("at least two frames, got 1", sine_weights, 1),
    ("got 0", cubic_weights, 0),
)
