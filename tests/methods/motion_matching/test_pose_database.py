"""Features belong to the body, the table has a scale per group, and the nearest frame is a loop's."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from mocap.body import concatenate, heading, place
from mocap.datasets.samples import sample
from mocap.errors import SkeletonMismatch
from mocap.methods.motion_matching import GROUPS, features
from mocap.methods.motion_matching import pose_database as db
from mocap.methods.motion_matching.nearest_frames import FrameSearch, fade, foresee, spring, spring_way
from tests.bundled import clips
from tests.methods.motion_matching.matched import walks
from tests.refusals import refusals, refused
from tests.strategies import wave


@given(st.fixed_dictionaries({name: st.floats(0.1, 10) for name in GROUPS}))
def test_each_group_spreads_as_its_weight_in_whatever_unit_it_is(units):
    unit = np.concatenate([np.full(columns.stop - columns.start, units[n]) for n, columns in GROUPS.items()])
    values, mean, scale = db.standardise(walks().values * unit)
    for name, columns in GROUPS.items():
        assert values[:, columns].std(axis=0).mean() == pytest.approx(db.WEIGHTS[name])
        assert len(set(scale[columns])) == 1
    np.testing.assert_allclose(values * scale + mean, walks().values * unit, atol=1e-9)


def test_rows_are_the_frames_of_the_clips_and_the_last_second_of_each_is_left_out():
    table = walks()
    lengths = [len(clip) for clip in table.clips]
    assert len(table) == sum(lengths)
    start = lengths[0] + 7
    np.testing.assert_array_equal(table.motion.rotations[start], table.clips[1].rotations[7])
    assert table.last[start] == lengths[0] + lengths[1] - 1
    assert (np.flatnonzero(~table.usable)[:30] == np.arange(lengths[0] - 30, lengths[0])).all()
    own = (features(table.clips[1])[7] - table.mean) / table.scale
    np.testing.assert_allclose(table.values[start], own, atol=1e-12)


def test_marks_that_a_clip_lacks_are_off_there():
    bare, marked = (replace(clip, contacts={}, labels={}) for clip in clips("walk_circle", "walk_curve_1"))
    marked = replace(marked, labels={"odd": np.ones(len(marked), bool)})
    table = db.tabulate([bare, marked])
    assert (
        table.motion.labels["odd"].sum() == len(marked) and not table.motion.labels["odd"][: len(bare)].any()
    )


def test_turn_speeds_are_those_of_a_steady_turn():
    (clip,) = clips("walk_circle")
    spun = replace(clip, rotations=np.tile([1.0, 0, 0, 0], (*clip.rotations.shape[:2], 1)))
    angle = np.arange(len(clip)) * 0.1 / 2
    turns = spun.rotations.copy()
    turns[:, 3] = np.stack([np.cos(angle), 0 * angle, np.sin(angle), 0 * angle], axis=-1)
    speeds = db.turn_speeds(replace(spun, rotations=turns))
    np.testing.assert_allclose(speeds[:, 3], [[0, 0.1 * clip.fps, 0]] * len(clip), atol=1e-9)
    assert not speeds[:, 4].any()


CLIP = clips("walk_circle")[0]
LARGE = replace(CLIP, skeleton=replace(CLIP.skeleton, offsets=2 * CLIP.skeleton.offsets))

test_what_makes_no_sense_is_refused_in_one_sentence = refusals(
    ("one clip or more, got none", db.tabulate, []),
    ("resample", db.tabulate, [sample("walk_circle"), CLIP]),
    (SkeletonMismatch, "bone", db.tabulate, [CLIP, LARGE]),
    ("No legs found", features, wave(40)),
    (r"longest, 'walk_circle', lasts 1.00", db.tabulate, [CLIP[:31]]),
    ("at least two frames", db.tabulate, [CLIP, CLIP[:1]]),
    ("never vary", db.tabulate, [concatenate([CLIP[:1]] * 60)]),
)


def test_they_are_the_same_wherever_a_clip_is_placed():
    (clip,) = clips("walk_curve_1")
    moved = place(clip, 2.5, [100.0, -30.0])
    np.testing.assert_allclose(features(moved), features(clip), atol=1e-9)


def test_they_say_where_the_body_will_be():
    """Placed by the track, the places ahead are the track itself some frames later."""
    (clip,) = clips("walk_circle")
    (ground, facing), values = db.body_track(clip), features(clip)
    ahead = values[:, GROUPS["places ahead"]].reshape(-1, 3, 2) @ [1j, 1]
    frames = np.arange(len(clip) - 30)
    for number, later in enumerate(np.round(db.AHEAD * 30).astype(int)):
        there = ground[frames] + np.exp(1j * facing[frames]) * ahead[frames, number]
        np.testing.assert_allclose(there, ground[frames + later], atol=1e-9)


def test_the_smoothed_track_does_not_sway():
    """Walking straight, the pelvis turns to and fro by 8 degrees; the track by half of it."""
    (clip,) = clips("walk_straight")
    swings = [np.ptp(track[30:200]) for track in (heading(clip.rotations[:, 0]), db.body_track(clip)[1])]
    assert swings[1] < 0.6 * swings[0]


def queries(count, seed=0):
    """Real poses with other futures: what a character asks."""
    table, random = walks(), np.random.default_rng(seed)
    rows = table.values[random.integers(0, len(table), count)].copy()
    rows[:, db.FUTURE] = table.values[random.integers(0, len(table), count)][:, db.FUTURE]
    return rows


@pytest.mark.parametrize("future", [1.0, 0.25])
def test_the_tree_finds_what_a_loop_finds(future):
    table, weigh = walks(), np.ones(27)
    search = FrameSearch(table, future=future)
    weigh[db.FUTURE] = future
    for number, query in enumerate(queries(30)):
        now = 37 * number
        costs = (((query - table.values) * weigh) ** 2).sum(axis=1)
        costs[~table.usable | (np.abs(np.arange(len(table)) - now) < 6)] = np.inf
        found, paid = search.nearest(query, lambda frames, now=now: np.abs(frames - now) >= 6)
        assert found == costs.argmin()
        assert search.cost(query, found) == paid == pytest.approx(costs[found])


def test_only_allowed_frames_are_found_and_where_none_is_minus_one():
    """The nearest of all is found as well if hundreds of nearer ones are not allowed."""
    table = walks()
    search = FrameSearch(table)
    assert search.nearest(table.values[200], lambda frames: frames >= 0)[0] == 200
    assert abs(search.nearest(table.values[200], lambda f: np.abs(f - 200) >= 6)[0] - 200) >= 6
    first = int(search.frames[-5])
    costs = [search.cost(table.values[200], frame) for frame in search.frames[-5:].tolist()]
    found, paid = search.nearest(table.values[200], lambda frames: frames >= first)
    assert (found, paid) == (search.frames[-5:][np.argmin(costs)], min(costs))
    assert search.nearest(table.values[50], lambda frames: frames < 0) == (-1, np.inf)


def test_to_go_on_as_the_clip_does_is_to_foresee_its_future():
    """Walking straight at one speed, the springs and the clip agree on the next second to 3 cm, but for sway.

    The means are those of a stride, whose sway is none.
    """
    table = walks()
    start = sum(len(clip) for clip in table.clips[:3])
    stride = np.arange(100, 132)
    goals = table.drift[start + stride] * np.exp(-1j * table.heading[start + stride])
    foreseen = [foresee(table, start + n, complex(g), 0.27) for n, g in zip(stride, goals, strict=True)]
    ahead = np.mean(foreseen, axis=0) * table.scale[db.FUTURE] + table.mean[db.FUTURE]
    np.testing.assert_allclose(ahead[:6], features(table.clips[3])[stride, 15:21].mean(axis=0), atol=0.03)


def test_told_to_stop_it_keeps_facing_as_it_does():
    table = walks()
    ahead = foresee(table, 100, 0j, 0.27) * table.scale[db.FUTURE] + table.mean[db.FUTURE]
    assert np.hypot(*ahead[4:6]) < 0.4 and ahead[11] > 0.9


def test_a_search_among_no_frames_is_refused():
    table = replace(walks(), usable=np.zeros(len(walks()), bool))
    refused("No frame '' can be found", FrameSearch, table)


def test_after_its_half_life_0_597_of_a_gap_is_left_and_half_after_1_211():
    assert spring(1.0, 0.0, 0.0, 0.3, 0.3) == pytest.approx((1 + 2 * np.log(2)) / 4)
    assert spring(1.0, 0.0, 0.0, 0.3, 1.21067 * 0.3) == pytest.approx(0.5, abs=1e-4)


def test_it_solves_the_equation_of_a_critically_damped_spring():
    pull = 2 * np.log(2) / 0.27
    solved = solve_ivp(
        lambda t, x: [x[1], -2 * pull * x[1] - pull**2 * (x[0] - 3)],
        (0, 1.5),
        [1.0, -4.0],
        rtol=1e-9,
        atol=1e-10,
    )
    assert spring(1.0, -4.0, 3.0, 0.27, 1.5) == pytest.approx(solved.y[0, -1], abs=1e-7)


def test_the_way_is_the_integral_of_the_velocity_also_of_complex_ones():
    speed, goal, seconds = 0.4 - 1j, 1.2 + 0.3j, 0.8
    parts = [
        quad(lambda t, p=part: p(spring(speed, 0.0, goal, 0.27, t)), 0, seconds)[0]
        for part in (np.real, np.imag)
    ]
    assert spring_way(speed, goal, 0.27, seconds) == pytest.approx(complex(*parts), abs=1e-9)


def test_two_short_fades_are_one_long_fade_and_leave_nothing():
    offset, speed = np.array([0.3, -0.2]), np.array([1.0, 2.0])
    twice = fade(*fade(offset, speed, 0.1, 0.05), 0.1, 0.05)
    np.testing.assert_allclose(twice, fade(offset, speed, 0.1, 0.1), atol=1e-12)
    np.testing.assert_allclose(fade(offset, speed, 0.1, 0.1)[0], spring(offset, speed, 0.0, 0.1, 0.1))
    assert np.abs(fade(offset, speed, 0.1, 3.0)).max() < 1e-12
