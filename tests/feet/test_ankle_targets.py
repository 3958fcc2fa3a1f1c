"""Plants get places that foot and leg can keep, and the way from one place to the next bends least."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import runs
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import FADE, foot_target, place_plants, smooth_fill
from mocap.feet.leg_track import track_leg
from tests.strategies import seeds

WALK = sample("walk_straight")[200:400]
LEFT = find_legs(WALK.skeleton)[0]
POSES = forward_kinematics(WALK)
MARKS = np.array([WALK.contacts[joint] for joint in ("lfoot", "ltoes")])


@pytest.mark.parametrize("faster", [1.0, 1.2])
def test_the_places_say_where_an_ankle_is(faster):
    """As in [KSG02, step 2]: a foot that stands stays as it is; a ball that stands holds it by its length."""
    motion = replace(WALK, root_positions=WALK.root_positions * [1, 1, faster])
    track, (flat, down) = track_leg(motion, LEFT, forward_kinematics(motion)), MARKS
    places = place_plants((track.ankle, track.ball), (flat, down), length := LEFT.lengths(WALK.skeleton)[2])
    target = foot_target(track, MARKS, {})
    assert target.ankle[flat] == pytest.approx(places[0, flat], abs=1e-9)
    assert np.linalg.norm(target.ankle - places[1], axis=-1)[down] == pytest.approx(length, abs=1e-9)
    moved, turned = (np.abs(values).max() for values in (target.ankle - track.ankle, target.turn))
    assert (moved < 1e-7 and turned < 1e-6) if faster == 1 else moved > 0.02
    assert np.array_equal(target.planted, MARKS.any(axis=0))


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
    target = foot_target(lying, np.ones_like(MARKS), {})
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
        return (np.diff(c, 2, axis=0) ** 2).sum() + (FADE * 30) ** -4 * (c**2).sum()

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
