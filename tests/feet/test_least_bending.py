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


def dense(weight, near):
    bends = np.diff(np.eye(len(weight)), 2, axis=0) if len(weight) > 2 else np.zeros((0, len(weight)))
    return bends.T @ np.diag(weight[1:-1]) @ bends + near * np.eye(len(weight))


@pytest.mark.parametrize("frames", [1, 2, 3, 9])
def test_bands_are_those_of_the_whole_matrix(frames):
    random = np.random.default_rng(frames)
    weight, curves = random.random(frames), random.normal(size=(frames, 3))
    assert band_product(bending_bands(weight, 0.3), curves) == pytest.approx(dense(weight, 0.3) @ curves)


@given(seeds)
def test_a_step_solves_the_least_squares(seed):
    """Against all equations in one dense matrix."""
    random = np.random.default_rng(seed)
    slopes, weights = random.normal(size=(3, 4, 7, 3)), random.random((4, 7))
    pull = random.normal(size=(4, 7, 3))
    bands = np.array([bending_bands(weight, 0.5) for weight in weights])
    step = least_bending._gauss_newton(slopes, bands, pull, 0.0)
    whole, target = np.zeros((3, 7, 3, 7)), np.einsum("kmfc,mfc->kf", slopes, pull)
    for m, weight in enumerate(weights):
        whole += np.einsum("kfc,fg,jgc->kfjg", slopes[:, m], dense(weight, 0.5), slopes[:, m])
    assert step.ravel() == pytest.approx(
        np.linalg.solve(whole.reshape(21, 21), target.ravel()), rel=1e-5, abs=1e-7
    )


def test_feet_that_stand_change_nothing():
    rise, bends, excesses = hold_plants(TRACKS, TARGETS)
    assert np.abs(rise).max() < 1e-7
    assert all(bend == pytest.approx(track.own, abs=1e-5) for bend, track in zip(bends, TRACKS, strict=True))
    assert excesses == []


def test_no_other_change_bends_less():
    targets, random = shifted([0, 0.006, 0.01], [0, 0.002, 0]), np.random.default_rng(0)
    legs, ones = list(zip(TRACKS, targets, strict=True)), np.ones((3, len(WALK)))
    least_bending.STEPS, before = 40, least_bending.STEPS
    try:
        found = least_bending._least_bent(legs, ones, np.zeros((3, len(WALK))), 0.0)
    finally:
        least_bending.STEPS = before
    near = (least_bending.NEAR * WALK.fps) ** -4.0
    bands = [bending_bands(ones[0], near)] * 3 + [bending_bands(0 * ones[0], 900 * near)] * 3

    def cost(change):
        moved = least_bending._displacements(legs, change)
        return (moved * band_product(np.array(bands), moved)).sum()

    top = min(cost(found + 1e-3 * np.cumsum(random.normal(size=found.shape), axis=1) / 10) for _ in range(20))
    assert cost(found) < top
    assert cost(found) < 0.5 * cost(np.zeros_like(found))


@pytest.mark.parametrize("height", [-0.01, 0.01])
def test_the_root_follows_two_feet_up_and_down_but_not_all_the_way(height):
    """As in [KSG02, step 3]."""
    rise, _, excesses = hold_plants(
        TRACKS, shifted([0, height, 0], [0, height, 0], planted=np.full(300, True))
    )
    assert 0.2 < (rise / height).min() <= (rise / height).max() <= 1.5
    assert excesses == []


def test_what_cannot_be_held_is_told():
    """One foot leaps, and both are out of reach: a knee jolts, or the root is too far."""
    leap = np.zeros((len(WALK), 3))
    leap[150, 1] = 0.03
    planted = np.full(len(WALK), True)
    jolt = hold_plants(TRACKS, shifted(leap, 0 * UP, planted=planted))[2][-1][1]
    assert abs(int(jolt.argmax()) - 150) <= 8
    assert jolt.max() > 0.2 * UNSEEN * TRACKS[0].length
    rise, _, excesses = hold_plants(TRACKS, shifted(-0.1 * UP, -0.1 * UP, planted=planted))
    assert excesses[0][1].max() == pytest.approx(np.abs(rise).max() - MOST * TRACKS[0].length)
    far = shifted([0.9, 0, 0], 0 * UP, planted=planted)
    assert [legs for legs, amount in hold_plants(TRACKS, far)[2] if amount.max() > 0.1][-1] == slice(0, 1)
