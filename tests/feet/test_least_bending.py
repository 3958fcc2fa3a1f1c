"""What holds the plants bends least, and what cannot be held is told."""

import numpy as np
import pytest
from hypothesis import given

from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet import least_bending
from mocap.feet.ankle_targets import band_product, bending_bands, foot_target
from mocap.feet.least_bending import MOST, UNSEEN, hold_plants
from mocap.feet.leg_track import UP, track_leg
from tests.strategies import seeds

WALK = sample("walk_straight")[200:500]
POSES = forward_kinematics(WALK)
TRACKS = [track_leg(WALK, leg, POSES) for leg in find_legs(WALK.skeleton)]
MARKS = [[WALK.contacts[name] for name in pair] for pair in (("lfoot", "ltoes"), ("rfoot", "rtoes"))]
TARGETS = [foot_target(track, np.array(marks), {}) for track, marks in zip(TRACKS, MARKS, strict=True)]


def shifted(*shifts, **more):
    """Give the walk's targets moved by metres."""
    return [t._replace(ankle=t.ankle + shift, **more) for t, shift in zip(TARGETS, shifts, strict=True)]


def dense(weight, near, span=1):
    bends = least_bending._jumps(np.eye(len(weight)), span).T
    return bends.T @ np.diag(weight) @ bends + near * np.eye(len(weight))


@pytest.mark.parametrize("frames", [1, 2, 3, 9])
def test_bands_are_those_of_the_whole_matrix(frames):
    random = np.random.default_rng(frames)
    weight, curves = random.random(frames), random.normal(size=(3, frames))
    assert band_product(bending_bands(weight, 0.3), curves) == pytest.approx(curves @ dense(weight, 0.3))


@given(seeds)
def test_a_step_solves_the_least_squares(seed):
    """Against all equations in one dense matrix."""
    random = np.random.default_rng(seed)
    slopes, weights = random.normal(size=(3, 12, 7)), random.random((12, 7))
    pull = random.normal(size=(12, 7))
    bands = np.array([bending_bands(weight, 0.5) for weight in weights])
    jolts = np.array([bending_bands(weight, 0.0, 2) for weight in weights[:2]])
    whole, target = np.zeros((3, 7, 3, 7)), np.einsum("kmf,mf->kf", slopes, pull)
    for m, weight in enumerate(weights):
        matrix = dense(weight, 0.5) + (dense(weight, 0.0, 2) if m < 2 else 0.0)
        whole += np.einsum("kf,fg,jg->kfjg", slopes[:, m], matrix, slopes[:, m])
    terms = ((slopes, bands, 1), (slopes[:, :2], jolts, 2))
    step = least_bending._gauss_newton(terms, target, 0.0, np.zeros(7, bool))
    assert step.ravel() == pytest.approx(
        np.linalg.solve(whole.reshape(21, 21), target.ravel()), rel=1e-5, abs=1e-7
    )
    held = np.arange(7) < 3
    step = least_bending._gauss_newton(terms, target, 0.0, held)
    free = np.flatnonzero(~np.concatenate([held, np.zeros(14, bool)]))
    rest = np.linalg.solve(whole.reshape(21, 21)[np.ix_(free, free)], target.ravel()[free])
    assert step.ravel()[free] == pytest.approx(rest, rel=1e-5, abs=1e-7)
    assert step[0, :3] == pytest.approx(0, abs=1e-7)


def test_feet_that_stand_change_nothing():
    rise, _, poses, excesses = hold_plants(TARGETS)
    assert np.abs(rise).max() < 1e-7
    for (bend, _), track in zip(poses, TRACKS, strict=True):
        assert bend == pytest.approx(track.own, abs=1e-5)
    assert excesses == []


def test_no_other_change_bends_less():
    targets, random = shifted([0, 0.006, 0.01], [0, 0.002, 0]), np.random.default_rng(0)
    ones, start = np.ones(len(WALK)), np.zeros((3, len(WALK)))
    least_bending.STEPS, before = 40, least_bending.STEPS
    try:
        found = least_bending._least_bent(targets, start, np.zeros((2, 3, 300)), np.full((2, 300), 1.0), 4)
    finally:
        least_bending.STEPS = before
    near = (least_bending.NEAR * WALK.fps) ** -4.0
    leg = [bending_bands(ones, near)] * 6 + [bending_bands(0 * ones, 900 * near)]
    bands = [leg[0], *leg, *leg]

    def cost(change):
        moved = least_bending._displacements(targets, change)
        return (moved * band_product(np.array(bands), moved)).sum()

    top = min(cost(found + 1e-3 * np.cumsum(random.normal(size=found.shape), axis=1) / 10) for _ in range(20))
    assert cost(found) < top
    assert cost(found) < 0.5 * cost(start)


@pytest.mark.parametrize("height", [-0.01, 0.01])
def test_the_root_follows_two_feet_up_and_down_but_not_all_the_way(height):
    """As in [KSG02, step 3]."""
    moved = shifted([0, height, 0], [0, height, 0], marks=np.full((2, 300), True))
    rise, _, _, excesses = hold_plants(moved)
    assert 0.2 < (rise / height).min() <= (rise / height).max() <= 1.5
    assert excesses == []


def test_what_cannot_be_held_is_told():
    """One foot leaps, and both are out of reach: a knee jolts, or the root is too far."""
    leap = np.zeros((len(WALK), 3))
    leap[150, 1] = 0.03
    marks = np.full((2, len(WALK)), True)
    jolt = hold_plants(shifted(leap, 0 * UP, marks=marks))[-1][-1][1]
    assert abs(int(jolt.argmax()) - 150) <= 8
    assert jolt.max() > 0.2 * UNSEEN * TRACKS[0].length
    rise, _, _, excesses = hold_plants(shifted(-0.1 * UP, -0.1 * UP, marks=marks))
    assert excesses[0][1].max() == pytest.approx(np.abs(rise).max() - MOST * TRACKS[0].length)
    far = shifted([0.9, 0, 0], 0 * UP, marks=marks)
    assert [legs for legs, amount in hold_plants(far)[-1] if amount.max() > 0.1][-1] == slice(0, 1)


def test_a_knee_that_jolts_is_no_longer_bent_backwards_for_the_whole_run():
    side, jolts = np.ones(len(WALK)), np.arange(len(WALK)) == 15
    side[10:20] = side[40:50] = -1.0
    eased = least_bending._eased(TARGETS[0]._replace(side=side), jolts)
    assert np.array_equal(np.flatnonzero(eased.side < 0), np.arange(40, 50))
