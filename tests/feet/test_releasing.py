"""Plants that cannot be held are shortened where their joints are furthest from where they stand."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import runs
from mocap.body import find_legs
from mocap.body.kinematics import forward_kinematics
from mocap.datasets.samples import sample
from mocap.feet.ankle_targets import foot_target
from mocap.feet.footplants import least_frames, settle
from mocap.feet.leg_track import track_leg
from mocap.feet.releasing import plant_deviations, release
from tests.strategies import seeds

FPS = 60.0
SPAN = least_frames(FPS)
ALL_LEGS = slice(None)


def peak(frames, at, size=1.0):
    amount = np.zeros(frames)
    amount[at] = size
    return amount


@given(seeds, st.floats(20, 200), st.floats(0, 1))
def test_each_round_unmarks_a_planted_frame_so_the_rounds_end(seed, fps, share):
    random = np.random.default_rng(seed)
    span = least_frames(fps)
    noise = random.random((2, 2, random.integers(1, 60))) < share
    marks = np.array([[settle(row, span) for row in leg] for leg in noise])
    while marks.any():
        amount = random.normal(size=marks.shape[-1])
        amount[random.integers(len(amount))] = 1.0  # something goes beyond its bound, or there is no round
        planted = [ALL_LEGS, *(slice(n, n + 1) for n in range(2) if marks[n].any())]
        legs = planted[random.integers(len(planted))]
        deviations = np.round(random.random(marks.shape), random.integers(3)) * marks  # with ties
        fewer = release(marks, [(legs, amount)], deviations, fps)
        assert not np.any(fewer & ~marks)
        assert fewer[legs].sum() < marks[legs].sum()
        assert all(np.array_equal(settle(row, span), row) for leg in fewer for row in leg)
        marks = fewer


def test_the_frame_with_the_largest_deviation_near_an_excess_is_released_and_those_around_it():
    marks = np.zeros((1, 2, 60), bool)
    marks[0, 0, 10:40] = True
    deviations = np.abs(np.arange(60) - 20.0) * marks
    fewer = release(marks, [(ALL_LEGS, peak(60, 36))], deviations, FPS)
    assert runs(fewer[0, 0]).tolist() == [[10, 39 - SPAN]]


def test_the_foot_that_is_far_from_its_place_is_released_and_not_the_one_that_stands():
    marks = np.zeros((2, 2, 60), bool)
    marks[0, 1, :30] = True
    marks[1, 1, 20:50] = True
    deviations = np.zeros(marks.shape)
    deviations[1, 1, 20:24] = 0.1
    fewer = release(marks, [(ALL_LEGS, peak(60, 26))], deviations, FPS)
    assert np.array_equal(fewer[0], marks[0])
    assert runs(fewer[1, 1])[0, 0] > 22


def test_if_no_frame_deviates_the_nearest_one_is_released():
    marks = np.zeros((1, 2, 60), bool)
    marks[0, 0, 2:10] = True
    marks[0, 1, 30:50] = True
    fewer = release(marks, [(ALL_LEGS, peak(60, 24))], np.zeros(marks.shape), FPS)
    assert np.array_equal(fewer[0, 0], marks[0, 0])
    assert runs(fewer[0, 1]).tolist() == [[31 + SPAN, 50]]


def test_deviations_are_from_the_median_and_of_a_held_joint_from_where_it_is_held():
    walk = sample("walk_straight")[200:300]
    track = track_leg(walk, find_legs(walk.skeleton)[0], forward_kinematics(walk))
    marks = np.array([walk.contacts[name] for name in ("lfoot", "ltoes")])
    late = marks.copy()
    start, stop = runs(marks[1])[0]
    late[1, start : stop + 10] = True
    free = plant_deviations([foot_target(track, late, {})], {})
    assert free[0, 1, start:stop].max() < 0.002
    assert free[0, 1, stop + 9] > 0.02
    assert not free[0][~late].any()
    held = {track.leg.ball: track.ball + np.array([0.05, 0, 0])}
    asked = plant_deviations([foot_target(track, marks, held)], held)
    assert np.allclose(asked[0, 1, start:stop].min(), 0.05, atol=0.005)
