"""Plants get places that foot and leg can keep; what holds them bends least; what cannot be held is told."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import runs
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet import ankle_targets, least_bending
from mocap.feet.ankle_targets import FLAT, band_product, bending_bands, foot_target, place_plants, smooth_fill
from mocap.feet.hip_heights import find_pelvis
from mocap.feet.least_bending import MOST, MOST_LIST, UNSEEN, hold_plants
from mocap.feet.leg_track import UP, track_leg
from tests.strategies import seeds
from tests.tuning import tune

WALK = sample("walk_straight")[200:500]
POSES = forward_kinematics(WALK)
TRACKS = [track_leg(WALK, leg, POSES) for leg in find_legs(WALK.skeleton)]
LEFT = TRACKS[0].leg
MARKS = np.array([WALK.contacts[name] for name in ("lfoot", "ltoes", "rfoot", "rtoes")]).reshape(2, 2, -1)
TARGETS = [foot_target(track, marks, {}) for track, marks in zip(TRACKS, MARKS, strict=True)]
PELVIS = find_pelvis(WALK, find_legs(WALK.skeleton), POSES)


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
    whole, target = np.zeros((3, 7, 3, 7)), np.einsum("kmf,mf->kf", slopes, pull)
    for m, weight in enumerate(weights):
        whole += np.einsum("kf,fg,jg->kfjg", slopes[:, m], dense(weight, 0.5), slopes[:, m])
    damping = random.random((3, 7))
    whole = whole.reshape(21, 21) + np.diag(damping.ravel())
    step = least_bending._gauss_newton(slopes, bands, target, damping, np.zeros((2, 7), bool))
    assert step.ravel() == pytest.approx(np.linalg.solve(whole, target.ravel()), rel=1e-5, abs=1e-7)
    held = np.array([np.arange(7) < 3, np.arange(7) > 4])
    step = least_bending._gauss_newton(slopes, bands, target, damping, held)
    free = np.flatnonzero(~np.concatenate([held.ravel(), np.zeros(7, bool)]))
    rest = np.linalg.solve(whole[np.ix_(free, free)], target.ravel()[free])
    assert step.ravel()[free] == pytest.approx(rest, rel=1e-5, abs=1e-7)
    assert step[:2][held] == pytest.approx(0, abs=1e-7)


def test_feet_that_stand_change_nothing():
    found = hold_plants(TARGETS, PELVIS)
    assert np.abs(found.rise).max() < 1e-7
    assert np.abs(found.angle).max() < 1e-6
    for (bend, _), track in zip(found.poses, TRACKS, strict=True):
        assert bend == pytest.approx(track.flexion, abs=1e-5)
    assert found.excesses == []


def test_no_other_change_bends_less(monkeypatch):
    tune(monkeypatch, least_bending, steps=40, gain=1e-9)
    targets, random = shifted([0, 0.006, 0.01], [0, 0.002, 0]), np.random.default_rng(0)
    found = least_bending._least_bent(targets, PELVIS)
    bands, _ = least_bending._bands(2, len(WALK), WALK.fps)

    def cost(change):
        return least_bending._cost(bands, least_bending._corrections(targets, PELVIS, change))

    others = 1e-4 * np.cumsum(random.normal(size=(20, *found.shape)), axis=-1)
    assert cost(found) < min(cost(found + other) for other in others)
    assert cost(found) < 0.5 * cost(np.zeros_like(found))


@pytest.mark.parametrize("height", [-0.01, 0.01])
def test_the_root_follows_two_feet_up_and_down_but_not_all_the_way(height):
    """As in [KSG02, step 3]."""
    moved = shifted([0, height, 0], [0, height, 0], marks=np.full((2, 300), True))
    found = hold_plants(moved, PELVIS)
    assert 0.2 < (found.rise / height).min() <= (found.rise / height).max() <= 1.5
    assert found.excesses == []


def test_the_pelvis_lists_if_one_foot_is_raised_and_no_further_than_its_bound():
    marks = np.full((2, len(WALK)), True)
    raised = hold_plants(shifted(0.004 * UP, 0 * UP, marks=marks), PELVIS)
    assert raised.angle[100:200].min() > 0
    far = hold_plants(shifted(0.05 * UP, -0.05 * UP, marks=marks), PELVIS)
    assert np.abs(far.angle).max() <= MOST_LIST


def test_what_cannot_be_held_is_told():
    """One foot leaps, and both are out of reach: a knee jolts, or the root is too far."""
    leap = np.zeros((len(WALK), 3))
    leap[150, 1] = 0.06
    marks = np.full((2, len(WALK)), True)
    _, jolt = hold_plants(shifted(leap, 0 * UP, marks=marks), PELVIS).excesses[-1]
    assert abs(int(jolt.argmax()) - 150) <= 8
    assert jolt.max() > 0.2 * UNSEEN * TRACKS[0].length
    low = hold_plants(shifted(-0.1 * UP, -0.1 * UP, marks=marks), PELVIS)
    _, amount = low.excesses[0]
    assert amount.max() == pytest.approx(np.abs(low.rise).max() - MOST * TRACKS[0].length)
    far = hold_plants(shifted([0.9, 0, 0], 0 * UP, marks=marks), PELVIS)
    assert [amount.max() > 0.05 for legs, amount in far.excesses if legs == slice(0, 1)] == [True]


def test_one_leg_alone_has_no_list():
    pelvis = find_pelvis(WALK, [LEFT], POSES)
    found = hold_plants([TARGETS[0]._replace(ankle=TARGETS[0].ankle + 0.004 * UP)], pelvis)
    assert np.abs(found.angle).max() == 0
    assert np.abs(found.rise).max() > 0.0005


@pytest.mark.parametrize("faster", [1.0, 1.2])
def test_the_places_say_where_an_ankle_is(faster):
    """As in [KSG02, step 2]: a foot that stands stays as it is; a ball that stands holds it by its length."""
    motion = replace(WALK, root_positions=WALK.root_positions * [1, 1, faster])
    track, (flat, down) = track_leg(motion, LEFT, forward_kinematics(motion)), MARKS[0]
    places = place_plants((track.ankle, track.ball), (flat, down), length := LEFT.lengths(WALK.skeleton)[2])
    target = foot_target(track, MARKS[0], {})
    assert target.ankle[flat] == pytest.approx(places[0, flat], abs=1e-9)
    assert np.linalg.norm(target.ankle - places[1], axis=-1)[down] == pytest.approx(length, abs=1e-9)
    moved, turned = (np.abs(values).max() for values in (target.ankle - track.ankle, target.turn))
    assert (moved < 1e-7 and turned < 1e-6) if faster == 1 else moved > 0.02
    assert np.array_equal(target.planted, MARKS[0].any(axis=0))


def test_a_foot_rolls_no_further_than_hip_ankle_and_ball_make_a_triangle():
    target = TARGETS[0]
    hip = TRACKS[0].hip[target.rolls]
    ball = target.places[1, target.rolls]
    foot = np.linalg.norm(ball - target.ankle[target.rolls], axis=1)
    far = np.linalg.norm(ball - hip, axis=1)
    for asked, kept in ((9.0, far + foot - FLAT), (0.0, far - foot + FLAT)):
        ways = target.rolled(hip, np.full(len(hip), asked))
        assert np.linalg.norm(ways, axis=1) == pytest.approx(kept, abs=1e-9)


def test_plants_of_a_leg_that_lies_are_drawn_within_its_reach():
    # On the back, the leg stretched out level; the hip moves away from the foot by a centimetre.
    positions = POSES.positions[:1].repeat(len(WALK), axis=0).copy()
    thigh, shank, foot = LEFT.lengths(WALK.skeleton)
    moved = np.linspace(0, 0.01, len(WALK))[:, None] * [1.0, 0, 0]
    matrices = np.broadcast_to(np.eye(3), POSES.matrices.shape)
    positions[:, LEFT.hip] = moved + np.array([0, 0.1, 0])
    positions[:, LEFT.knee] = positions[:, LEFT.hip] + thigh * np.array([-np.cos(0.05), np.sin(0.05), 0])
    positions[:, LEFT.ankle] = positions[:, LEFT.knee] + shank * np.array([-np.cos(0.05), -np.sin(0.05), 0])
    positions[:, LEFT.ball] = positions[:, LEFT.ankle] + [0, foot, 0]
    lying = track_leg(WALK, LEFT, GlobalPoses(positions, matrices))
    target = foot_target(lying, np.ones_like(MARKS[0]), {})
    before = np.linalg.norm(positions[:, LEFT.ankle] - positions[:, LEFT.hip], axis=-1)
    assert np.ptp(target.ankle, axis=0) == pytest.approx(0, abs=1e-12)
    after = np.linalg.norm(target.ankle - positions[:, LEFT.hip], axis=-1)
    assert after.max() <= before.max() + 1e-9
    assert np.all(after <= lying.limit)
    assert np.linalg.norm(positions[:, LEFT.ankle].mean(axis=0) - positions[-1, LEFT.hip]) > before.max()


@given(seeds)
def test_the_filled_curve_keeps_what_is_known_and_bends_least(seed):
    """As in [KSG02, step 5]."""
    random = np.random.default_rng(seed)
    values, known = random.normal(size=(14, 2)), random.random(14) < 0.4
    filled = smooth_fill(values, known, 30.0)
    assert np.array_equal(filled[known], values[known])

    def cost(c):
        c = c.reshape(-1, 2)
        return (np.diff(c, 2, axis=0) ** 2).sum() + ankle_targets.TUNED.fade_frames**-4 * (c**2).sum()

    for _ in range(5):
        other = filled + (~known)[:, None] * random.normal(size=filled.shape) * 1e-3
        assert cost(other) >= cost(filled)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_few_frames_can_be_filled(frames):
    known = np.arange(frames) == 0
    filled = smooth_fill(np.ones((frames, 3)), known, 120.0)
    assert np.all(filled[0] == 1) and np.isfinite(filled).all()
    assert np.all(smooth_fill(np.ones((frames, 3)), ~known & False, 120.0) == 0)


@given(seeds, st.floats(0.05, 0.3))
def test_plants_that_overlap_are_a_foot_s_length_apart(seed, length):
    """As in [KSG02, step 1]."""
    random = np.random.default_rng(seed)
    ankle = random.normal(size=(40, 3)) * 0.01
    direction = random.normal(size=(40, 3)) * 0.1 + [0, 0, 1]
    ball = ankle + length * direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    flat, down = np.zeros((2, 40), bool)
    flat[5:20], flat[26:33] = True, True
    down[10:30] = True
    places = place_plants((ankle, ball), (flat, down), length)
    both = flat & down
    assert np.linalg.norm((places[1] - places[0])[both], axis=-1) == pytest.approx(length)
    for kind, marks in enumerate((flat, down)):
        for start, stop in runs(marks):
            assert np.ptp(places[kind, start:stop], axis=0) == pytest.approx(0)
    assert places[0, 5:20] == pytest.approx(np.tile(ankle[5:20].mean(axis=0), (15, 1)))
