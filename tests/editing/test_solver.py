"""The solver is as good as SciPy, its banded step as the plain one; each frame alone jolts."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse
from scipy.linalg import block_diag
from scipy.optimize import least_squares

from mocap.editing import solver
from mocap.editing.bodies import body_of
from mocap.editing.constraint_checks import pin_errors
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.pins import join_pins, keep_turned, limit_turns, pin, plant_pins
from mocap.editing.poses import poses_of
from mocap.editing.solver import solve
from mocap.editing.stages import REACH, Curve, Stage, closing_stages
from tests.editing.wishes import bar, bones, captured, smoothness, stone, walk
from tests.refusals import refusals, told
from tests.strategies import seeds
from tests.tuning import tune

SPLINES = Stage(knots=0.125)


def linear(clip, body, change, pins):
    """Return residuals and Jacobian of a clip with a change."""
    displacement = body.displacement(change, len(clip.skeleton))
    poses = poses_of(displaced(clip, displacement))
    return pins.linearised(poses, body.world_axes(poses, displacement))


def worst(gap):
    return np.linalg.norm(gap.reshape(-1, 3), axis=-1).max()


@given(seeds)
@settings(max_examples=5)
def test_slopes_are_those_of_finite_differences(seed):
    random = np.random.default_rng(seed)
    clip, whole = walk()[::50], walk()
    limits = limit_turns(whole, ["lowerneck", "thorax", "ltibia"], margin=0.0)[::50]
    pins = join_pins(bar(clip, 1.3, 3), limits, keep_turned(clip, "head", [1, 2]))
    body = body_of(whole, pins)
    x = random.normal(size=(len(clip), len(body.price))) * 0.3
    gap, toward = linear(clip, body, x, pins)
    active = toward.any(axis=-1)
    assert (active[:, :24] >= pins.held[:, :8].reshape(len(clip), 24)).all()
    assert active[[1, 2], -3:].all() and not active[3:, -3:].any()
    assert worst(gap) == pytest.approx(pin_errors(displaced(clip, body.displacement(x, 38)), pins).max())
    for column in range(x.shape[1]):
        step = np.zeros(x.shape)
        step[:, column] = 1e-6
        there, _ = linear(clip, body, x + step, pins)
        both = active & (gap != 0) & (there != 0)
        slopes = np.where(both, (gap - there) / 1e-6, 0.0)
        np.testing.assert_allclose(np.where(both, toward[..., column], 0), slopes, atol=2e-5)


def test_a_rail_and_a_free_joint_give_rows_of_zeros():
    clip = walk()[:3]
    rail = pin(clip, "lwrist", [0, 1], [0.3, 1, -np.inf], [0.3, 1, np.inf])
    body = body_of(walk(), rail)
    gap, slopes = linear(clip, body, np.zeros((3, len(body.price))), rail)
    assert not slopes[:, 2].any() and not slopes[2].any()
    assert slopes[:2, :2].any(axis=-1).all()
    assert worst(gap) == pytest.approx(pin_errors(clip, rail).max())


@given(seeds, st.integers(1, 12), st.sampled_from([0.0, 1.5, 4.0, 20.0]), st.floats(0, 5), st.floats(0, 9))
def test_the_banded_step_is_the_plain_one(seed, frames, knots, calm, damping):
    """As in [Gle98, objective]."""
    random = np.random.default_rng(seed)
    price = random.uniform(1, 9, 3)
    curve = Curve(Stage(knots, calm, weight=30.0), frames, 1.0, price)
    c = random.normal(size=(curve.basis.shape[1], 3))
    gap, slopes = random.normal(size=(frames, 6)), random.normal(size=(frames, 6, 3))
    if c.shape[0] > frames:
        return  # some splines are unseen, and the plain system is singular
    both = np.vstack([curve.basis.toarray(), curve.bends.toarray()])
    P = np.kron(both.T @ both, np.diag(price))
    J = curve.weight * block_diag(*slopes) @ np.kron(curve.basis.toarray(), np.eye(3))
    pull = J.T @ (curve.weight * gap.ravel() + J @ c.ravel()) + damping * P @ c.ravel()
    plain = np.linalg.solve(J.T @ J + (1 + damping) * P, pull).reshape(c.shape)
    np.testing.assert_allclose(curve.step(c, gap, slopes, np.array([[damping]])), plain, atol=1e-6)
    cost = curve.cost(c, gap)
    assert cost.shape == ((frames, 1) if curve.is_framewise else (1, 1))


def by_scipy(clip, pins, body, basis, weight):
    """Return the least cost that SciPy finds."""
    shape, root_price = (basis.shape[1], len(body.price)), np.sqrt(body.price)

    def residuals(c):
        x = basis @ c.reshape(shape)
        return np.append((x * root_price).ravel(), weight * linear(clip, body, x, pins)[0].ravel())

    def slopes(c):
        _, here = linear(clip, body, basis @ c.reshape(shape), pins)
        many = sparse.block_diag(list(here)) @ sparse.kron(basis, sparse.identity(shape[1]))
        return sparse.vstack([sparse.kron(basis, sparse.diags(root_price)), -weight * many]).tocsr()

    start = np.zeros(shape[0] * shape[1])
    return least_squares(residuals, start, slopes, tr_solver="lsmr", x_scale="jac", max_nfev=60).cost * 2


@pytest.mark.parametrize("real", [False, pytest.param(True, marks=pytest.mark.sweep)])
def test_the_cost_is_scipys(real, request):
    """As in [Gle98, objective]."""
    clip = (captured(request.getfixturevalue("real_data")) if real else walk())[130:250]
    pins = stone(clip, 0.1, 0)
    body, change = body_of(clip, pins), solve(clip, pins, [SPLINES]).change
    gaps, _ = linear(clip, body, change, pins)
    own = (change**2 @ body.price).sum() + 300.0**2 * (gaps**2).sum()
    assert own <= by_scipy(clip, pins, body, spline_basis(len(clip), 15), 300.0) * (1 + 1e-3)


def test_frames_with_pins_meet_them_and_the_others_stay_to_the_last_bit():
    """As in [LS99, inverse kinematics]."""
    clip = walk()
    few = stone(clip, 0.3).limited_to(slice(200, 300))
    solved = solve(clip, few, [REACH], body_of(clip, few))
    assert solved.worst[-1] < 0.001
    alone = np.ones(len(clip), bool)
    alone[200:300] = False
    assert np.array_equal(solved.motion.rotations[alone], clip.rotations[alone])
    assert not solved.change[alone].any()
    assert bones(solved.motion) < 1e-12


@pytest.mark.parametrize("fps", [120.0, 30.0])
def test_all_frames_at_once_do_not_jolt(fps):
    """By itself each frame meets its pins as well, and accelerations are three to five times as large."""
    clip = walk(fps)
    pins = stone(clip, 0.15)
    solved = solve(clip, pins, [SPLINES])
    # Room for a pass more or less under other arithmetic: 2.9 mm and 1.09 were measured at most.
    assert pin_errors(solved.motion, pins).max() < 0.0035
    assert smoothness(solved.motion, clip) < 1.15
    assert bones(solved.motion) < 1e-12
    assert solved.worst[-1] == pytest.approx(pin_errors(solved.motion, pins).max())


LED = replace(SPLINES, lead=0.5)


@pytest.mark.parametrize("stages", [[REACH], [SPLINES], [LED], [LED, *closing_stages()]])
def test_the_solver_knows_the_errors_of_its_result(stages):
    """They are those of its last iterate: in frames it left alone, under bars, and on axes that are led."""
    clip = walk(30.0)
    turned = keep_turned(clip, "thorax", range(40, 60))
    pins = join_pins(bar(clip, 1.3, 50), stone(clip, 0.15), turned)
    few = [replace(stage, passes=5) for stage in stages]
    solved = solve(clip, pins, few, quiet=True, frames=slice(20, 90))
    assert 1e-12 < solved.errors.max() < pin_errors(clip, pins).max()
    np.testing.assert_allclose(solved.errors, pin_errors(solved.motion, pins), atol=1e-12)


def test_few_knots_leave_centimetres_and_many_jolt(real_data):
    """As in [Gle98, smooth change; finer knots]."""
    clip = captured(real_data)
    pins = stone(clip, 0.2)
    solved = {}
    for knots in (0.5, 0.125, 0.03):
        motion = solve(clip, pins, [Stage(knots)], quiet=True).motion
        solved[knots] = (pin_errors(motion, pins).max(), smoothness(motion, clip))
    assert solved[0.5][0] > 1.5 * solved[0.125][0] > 1.5 * solved[0.03][0]
    assert solved[0.125][0] < 0.0035 and solved[0.125][1] < 1.06
    assert solved[0.03][1] > 3
    motion = solve(clip, pins, [Stage(knots) for knots in (0.5, 0.25, 0.125)]).motion
    assert pin_errors(motion, pins).max() < 0.0016
    assert smoothness(motion, clip) < 1.07


def test_a_bar_needs_a_weight_that_rises(real_data, monkeypatch):
    clip = captured(real_data)
    pins = bar(clip, 1.35, 230)
    solved = solve(clip, pins, [SPLINES])
    assert solved.worst[-1] < 0.0025
    assert smoothness(solved.motion, clip) < 1.05
    tune(monkeypatch, solver, bar_damping=0.0)
    assert told("mm off its pin", solve, clip, pins, [replace(SPLINES, passes=4)]).worst[-1] > 0.05


def test_nothing_asked_and_nothing_missed_change_nothing():
    clip = walk()
    empty = pin(clip, "lwrist", [], [0, 0, 0])
    for stage in (SPLINES, REACH, closing_stages()[0], replace(REACH, damping=0.0)):
        solved = solve(clip, empty, [stage])
        assert np.array_equal(solved.motion.rotations, clip.rotations)
        assert np.array_equal(solved.motion.root_positions, clip.root_positions)
        assert solved.worst == [0.0]
    assert np.abs(solve(clip, plant_pins(clip), [SPLINES]).change).max() < 1e-7  # as the clip is stored


test_what_cannot_be_solved_is_refused = refusals(
    ("a stage or more, got none", solve, walk(), plant_pins(walk()), []),
    ("above 0, got passes=0", lambda: replace(REACH, passes=0)),
    ("above 0, got weight=0.0", lambda: Stage(weight=0.0)),
    ("0 or more, got damping=-1.0", lambda: Stage(damping=-1.0)),
    ("0 or more, got knots=nan", lambda: Stage(knots=np.nan)),
    ("0 or more, got decay=-1.0", lambda: Stage(decay=-1.0)),
    ("has 9 frames, its pins have 500", solve, walk()[:9], plant_pins(walk()), [SPLINES]),
)
