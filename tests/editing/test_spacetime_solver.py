"""All frames at once: as good as SciPy, exact where nothing is asked, and linear in time by its structure."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from scipy.optimize import least_squares

from mocap.body.kinematics import joint_positions
from mocap.editing import spacetime_solver
from mocap.editing.displacements import spline_basis
from mocap.editing.linear_bodies import body_of, linear
from mocap.editing.pins import pin, pin_errors, plant_pins
from mocap.editing.reaching import cost, pared
from mocap.editing.spacetime_solver import Splines, refined, spacetime
from mocap.errors import MocapError, MocapWarning
from tests.editing.wishes import bar, bones, captured, hand_at, smoothness, stone, walk
from tests.strategies import seeds


def by_scipy(clip, pins, body, basis, weight=300.0):
    """Return SciPy's least cost, and how far it leaves the worst joint coordinate, metres."""
    small, own, wishes = pared(clip, body, pins, slice(None))
    shape, root_price = (basis.shape[1], len(own.price)), np.sqrt(own.price)

    def residuals(c):
        x = basis @ c.reshape(shape)
        return np.append((x * root_price).ravel(), weight * linear(small, own, x, wishes).gap.ravel())

    def slopes(c):
        here = linear(small, own, basis @ c.reshape(shape), wishes)
        many = sparse.block_diag(list(here.slopes)) @ sparse.kron(basis, sparse.identity(shape[1]))
        return sparse.vstack([sparse.kron(basis, sparse.diags(root_price)), -weight * many]).tocsr()

    start = np.zeros(shape[0] * shape[1])
    return least_squares(residuals, start, slopes, tr_solver="lsmr", x_scale="jac", max_nfev=60).cost * 2


def check_against_scipy(clip, height):
    pins = stone(clip, height, 0)
    solved = spacetime(clip, pins)
    gaps = linear(clip, solved.body, solved.change, pins).gap
    own = cost(solved.body, solved.change, gaps, 300.0).sum()
    oracle = by_scipy(clip, pins, solved.body, spline_basis(len(clip), 0.125 * clip.fps))
    assert own <= oracle * (1 + 1e-3)


def test_the_cost_is_scipys():
    check_against_scipy(walk()[130:250], 0.1)


def test_the_cost_is_scipys_on_a_captured_walk(real_data):
    check_against_scipy(captured(real_data)[130:250], 0.1)


@given(seeds, st.integers(1, 40), st.floats(1.5, 20))
@settings(max_examples=15)
def test_the_banded_solution_is_that_of_the_whole_system(seed, frames, spacing):
    random = np.random.default_rng(seed)
    basis = spline_basis(frames, spacing)
    roots = random.normal(size=(frames, 2, 3))
    matrix = np.swapaxes(roots, 1, 2) @ roots + 0.5 * np.eye(3)
    pull = random.normal(size=(frames, 3))
    dense = basis.toarray()
    whole = np.einsum("fk,fl,fij->kilj", dense, dense, matrix).reshape(3 * dense.shape[1], -1)
    whole += spacetime_solver.RIDGE * whole.max() * np.eye(len(whole))
    control = np.linalg.solve(whole, (dense.T @ pull).ravel()).reshape(-1, 3)
    np.testing.assert_allclose(Splines(basis).solve(matrix, pull), dense @ control, atol=1e-6)


def test_the_work_is_linear_in_the_frames():
    """Each frame touches four splines, and each spline the three next to it: the band does not grow."""
    for frames in (500, 5000):
        splines = Splines(spline_basis(frames, 15))
        assert splines.basis.nnz <= 4 * frames
        assert sum(pair.nnz for pair in splines.pairs) <= 10 * frames
        assert len(splines.pairs) == 4


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_a_stone_is_met_to_millimetres_and_nothing_jolts(fps):
    clip = walk(fps)
    pins = stone(clip, 0.15)
    solved = spacetime(clip, pins)
    assert pin_errors(solved.motion, pins).max() < 0.003
    assert smoothness(solved.motion, clip) < 1.15
    assert bones(solved.motion) < 1e-12
    assert solved.worst[-1] == pytest.approx(pin_errors(solved.motion, pins).max())


def test_few_knots_leave_centimetres_and_many_jolt(real_data):
    clip = captured(real_data)
    pins = stone(clip, 0.2)
    solved = {}
    for knots in (0.5, 0.125, 0.03):
        motion = spacetime_solver.solved_in_time(
            clip, pins, body_of(clip, pins.joints), (knots, 300.0)
        ).motion
        solved[knots] = (pin_errors(motion, pins).max(), smoothness(motion, clip))
    assert solved[0.5][0] > 1.5 * solved[0.125][0] > 1.5 * solved[0.03][0]
    assert solved[0.125][0] < 0.0035 and solved[0.125][1] < 1.06
    assert solved[0.03][1] > 3


def test_denser_knots_after_fewer_come_nearer(real_data):
    clip = captured(real_data)
    pins = stone(clip, 0.2)
    motion = refined(clip, pins)
    assert pin_errors(motion, pins).max() < 0.0016
    assert smoothness(motion, clip) < 1.07


def test_a_bar_needs_a_weight_that_rises(real_data, monkeypatch):
    clip = captured(real_data)
    pins = bar(clip, 1.35, 230)
    solved = spacetime(clip, pins)
    assert solved.worst[-1] < 0.0025
    assert smoothness(solved.motion, clip) < 1.05
    monkeypatch.setattr(spacetime_solver, "RAMP", (1.0,))
    monkeypatch.setattr(spacetime_solver, "LAST", 4)
    with pytest.warns(MocapWarning, match=r"'16_15', frame \d+: '\w+' is [\d.]+ mm off its pin"):
        at_once = spacetime(clip, pins)
    assert at_once.worst[-1] > 0.05
    assert smoothness(at_once.motion, clip) > 1.5


def test_a_hand_at_three_frames_while_the_feet_stand():
    clip = walk()
    pins = hand_at(clip, (180, 240, 300))
    solved = spacetime(clip, pins)
    assert solved.worst[-1] < 0.002
    # Narrow splines carry the hand out and back in half a second; wide ones first, and it rises slowly.
    slow = refined(clip, pins)
    assert pin_errors(slow, pins).max() < 0.001
    assert smoothness(slow, clip) < 1.05 < 2 < smoothness(solved.motion, clip)


def test_nothing_asked_changes_nothing():
    clip = walk()
    empty = pin(clip, "lwrist", [], [0, 0, 0])
    for motion in (spacetime(clip, empty).motion, refined(clip, empty)):
        assert np.array_equal(motion.rotations, clip.rotations)
        assert np.array_equal(motion.root_positions, clip.root_positions)


def test_pins_that_are_met_already_change_nothing_that_shows():
    clip = walk()
    assert np.abs(spacetime(clip, plant_pins(clip)).change).max() < 1e-9


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
def test_a_few_frames_are_enough(frames):
    clip = walk()[:frames]
    wrist = joint_positions(clip)[0, clip.skeleton.index("lwrist")]
    solved = spacetime(clip, pin(clip, "lwrist", [0], wrist + np.array([0, 0.1, 0])))
    assert solved.worst[-1] < 0.001
    assert len(solved.motion) == frames


def test_bad_input():
    clip, pins = walk(), plant_pins(walk())
    for call, words in (
        (lambda: spacetime(clip, pins, knots=0.0), "above 0 seconds apart, got 0"),
        (lambda: spacetime(clip, pins, knots=np.nan), "above 0 seconds apart, got nan"),
        (lambda: spacetime(clip, pins, weight=-1.0), "weight of pins is above 0"),
        (lambda: refined(clip, pins, knots=()), "takes knots"),
        (lambda: spacetime(clip[:9], pins), "has 9 frames, its pins have 500"),
    ):
        with pytest.raises(MocapError, match=words):
            call()
