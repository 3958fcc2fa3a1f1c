"""Blends are drawn evenly and measured as clips are; turns are found from one, and asked for by angle."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d
from scipy.stats import kstest
from walking import generate_walk

from mocap import load
from mocap._shared.arrays import runs
from mocap.blending import mix, register
from mocap.body import Motion, PlanarTransform, Skeleton, arcs, heading, rotations
from mocap.methods.match_webs import (
    blend_of,
    hand_target,
    heading_change,
    mean_speed,
    sample_space,
    weights_for,
)
from mocap.methods.match_webs.motion_spaces import MotionSpace, random_weights
from mocap.methods.match_webs.target_weights import nearest_samples, neighbour_weights
from tests.methods.match_webs.spaces_of_walks import gait, space
from tests.refusals import refusals, refused, told

METHODS = ("convex", "neighbours")


def linear_space(numbers=2, seed=0, count=120):
    """A space whose values are a linear map of the weights."""
    rng = np.random.default_rng(seed)
    examples = rng.normal(size=(numbers + 4, numbers))
    weights = np.concatenate([np.eye(len(examples)), random_weights(examples, count, seed=seed)])
    return MotionSpace(None, weights, weights @ examples, np.ones(numbers))


@settings(max_examples=15)
@given(st.integers(1, 3), st.integers(0, 99), st.sampled_from(METHODS))
def test_weights_add_up_to_one_and_stay_in_range_for_every_target(numbers, seed, method):
    made = linear_space(numbers, seed)
    reach = 10 * np.abs(made.values).max()
    for target in np.random.default_rng(seed).uniform(-reach, reach, (70, numbers)):
        weights = weights_for(made, target, method=method)
        assert abs(weights.sum() - 1) < 1e-12
        assert weights.min() >= -0.1 - 1e-12 and weights.max() <= 1.1 + 1e-12


def test_convex_weights_are_exact_for_a_linear_measure_and_those_of_neighbours_are_not():
    """As in [KG04, request]."""
    made = linear_space()
    rng = np.random.default_rng(5)
    off = {method: [] for method in METHODS}
    for _ in range(40):
        near = nearest_samples(made.values[[rng.integers(6, 126)]], made.values, made.scale, 12)[0][0]
        target = rng.dirichlet(np.ones(4)) @ made.values[near[:4]]  # inside the hull of the nearest
        for method in METHODS:
            got = weights_for(made, target, method=method) @ made.values[:6]
            off[method].append(np.linalg.norm(got - target))
    assert max(off["convex"]) < 1e-6
    assert np.mean(off["neighbours"]) > 1e-2


def test_a_hit_gives_that_sample():
    made = linear_space()
    for number in (0, 7, 50):
        for method in METHODS:
            got = weights_for(made, made.values[number], method=method)
            assert got @ made.values[:6] == pytest.approx(made.values[number], abs=1e-5)
    hit = weights_for(made, made.values[50], method="neighbours")
    assert hit == pytest.approx(made.weights[50], abs=1e-12)  # room for rounding where the weights are mixed


def test_the_weights_of_neighbours_are_those_of_the_paper():
    """As in [HG07, Eqs. 1-2]."""
    assert neighbour_weights([1, 2, 4]) == pytest.approx([3 / 4, 1 / 4, 0])
    assert neighbour_weights([2, 2, 2]).tolist() == [1, 0, 0]
    assert neighbour_weights([3]).tolist() == [1]
    assert neighbour_weights([0.01, 1, 1])[0] == 1


def obtained(made, targets, **how):
    """Scaled distances from targets to what the blends do."""
    got = [gait(blend_of(made.examples, weights_for(made, target, **how), fps=30)) for target in targets]
    return np.linalg.norm((np.array(got) - targets) / made.scale, axis=1)


def test_walks_turn_and_go_as_asked():
    """Wishes are what other blends do; the unit is 10° and 0.1 m/s."""
    made = space(100)
    rows = random_weights(made.values[: len(made.examples.clips)], 25, spread=0, seed=9)
    targets = np.array([gait(blend_of(made.examples, row, fps=30)) for row in rows])
    convex, plain = (obtained(made, targets, method=method).mean() for method in METHODS)
    assert convex <= 0.1
    assert plain >= 3 * convex


def test_out_of_reach_the_blend_stays_at_the_edge():
    made = space(100)
    targets = np.array([[90.0, 1.1], [0, 2.2], [-70, 0.4], [60, 2.0]])
    nearest = nearest_samples(targets, made.values, made.scale, 1)[1][:, 0]
    for method in METHODS:
        assert (obtained(made, targets, method=method) <= 1.1 * nearest).all()


def test_asked_without_an_example_the_others_turn_as_it_does():
    """Leave one out: each example that the others enclose is asked for, and got within 2° on average."""
    made = space(100)
    off = []
    for out in range(len(made.examples.clips)):
        keep = np.abs(made.weights[:, out]) < 1e-12
        others = MotionSpace(made.examples, made.weights[keep], made.values[keep], made.scale)
        weights = weights_for(others, made.values[out])
        assert weights[out] == 0
        off.append(gait(blend_of(made.examples, weights, fps=30))[0] - made.values[out, 0])
    assert np.abs(off).mean() <= 2


test_hostile_targets_are_one_sentence = refusals(
    (r"A target in this space has 2 finite numbers, got \[1.0\]", weights_for, linear_space(), [1.0]),
    ("in this space has 2 finite numbers", weights_for, linear_space(), [1.0, np.nan]),
    ('"convex" or "neighbours", got \'rbf\'', lambda: weights_for(linear_space(), [1.0, 2], method="rbf")),
)


# Real people.


ANGLES = (45, 90, 180, -45, -90, -180)
AROUND = 10  # frames at 30 Hz before and after the body turns by more than 25° per second


def degrees(motion):
    return np.degrees(heading_change(motion))


@pytest.fixture(scope="module")
def walker(real_data):
    """The six clips, and the turns in them by the angle to which they are nearest: (clip, frames)."""
    folder = real_data / "bvh" / "puppy0512_motion_graph"
    clips = [load(path) for path in sorted(folder.glob("*.bvh"))]
    turns = {angle: [] for angle in (*ANGLES, 0)}
    for number, clip in enumerate(clips):
        angle = gaussian_filter1d(np.degrees(np.unwrap(heading(clip.rotations[:, 0]))), 8)
        for a, b in runs(np.abs(np.gradient(angle)) * 30 > 25).tolist():
            turned = angle[b - 1] - angle[a]
            inside = a >= AROUND and b + AROUND < len(clip) and b - a > 8 and abs(turned) > 20
            kind = min(ANGLES, key=lambda each: abs(each - 1.07 * turned))
            if inside and abs(kind - 1.07 * turned) < 25:
                turns[kind].append((number, slice(a - AROUND, b + AROUND)))
    return clips, turns


@pytest.mark.parametrize(
    ("side", "count"),
    [(1, 20), *(pytest.param(*case, marks=pytest.mark.sweep) for case in ((-1, 18), (0, 40)))],
)
def test_turns_are_got_as_asked_without_the_one_that_is_asked_for(walker, side, count):
    clips, turns = walker
    cuts = [clips[n][part] for angle in ANGLES if angle * side >= 0 for n, part in turns[angle]]
    assert len(cuts) >= count
    middle = int(np.argsort([len(cut) for cut in cuts])[len(cuts) // 2])
    registered = told("may not be the same kind of motion", register, cuts, slack=0, reference=middle)
    made = sample_space(registered, degrees, count=100)
    off = []
    for out, asked in enumerate(made.values[: len(cuts)]):
        others = np.abs(made.weights[:, out]) < 1e-12
        known = MotionSpace(registered, made.weights[others], made.values[others], made.scale)
        off.append(degrees(blend_of(registered, weights_for(known, asked))) - float(asked[0]))
    assert np.abs(off).mean() <= 2


@cache
def speeds():
    return register([generate_walk([[0, 0], [0, 3]], speed=speed) for speed in (0.8, 1.0, 1.2)])


def test_examples_are_samples_and_all_samples_are_what_their_blends_do():
    """As in [KG04, sampling]."""
    made = space(100)
    count = len(made.examples.clips)
    assert np.array_equal(made.weights[:count], np.eye(count))
    assert repr(made) == f"MotionSpace({count} examples, {count + 100} samples of 2 numbers)"
    for number in (0, 5, count, count + 50):
        blend = blend_of(made.examples, made.weights[number], fps=30, rounds=0)
        assert gait(blend) == pytest.approx(made.values[number], abs=1e-6)
    with pytest.raises(ValueError, match="read-only"):
        made.values[0] = 0


def test_a_blend_by_few_is_the_blend_of_all():
    few = blend_of(speeds(), [0, 0.3, 0.7])
    every = mix(speeds(), [0, 0.3, 0.7])
    assert np.abs(few.rotations - every.rotations)[:, 1:].max() < 1e-9
    assert few.contacts.keys() == every.contacts.keys()
    step = [np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) for motion in (few, every)]
    assert np.allclose(*step, atol=1e-9)
    assert len(blend_of(speeds(), [0, 1, 0])) == len(mix(speeds(), [0, 1, 0]))


def test_without_a_scale_numbers_count_by_how_much_they_vary():
    made = sample_space(speeds(), lambda motion: (mean_speed(motion), 7.0), count=4)
    assert made.scale == pytest.approx([np.ptp(made.values[:, 0]) / 2, 1.0])


def sampled(measure):
    return sample_space(speeds(), measure, count=3)


test_hostile_input_is_one_sentence = refusals(
    ("A measure of 3 numbers needs 4 examples, got 3", sampled, lambda m: (1.0, 2.0, 3.0)),
    (r"1 finite numbers for each blend; .* gave \[nan\]", sampled, lambda m: np.nan),
    ("gives 1 finite numbers for each blend", sampled, lambda m: [1.0] * (1 + (mean_speed(m) > 1))),
    ("finite numbers for each blend", sampled, lambda m: [[1.0]]),
    ("A blend of 3 clips needs 3 weights", lambda: blend_of(speeds(), [0.5, 0.5])),
    ("A measure of 2 numbers needs 3 examples, got 2.", random_weights, [[1.0, 2], [3, 4]], 5),
    (r"Examples need finite values of shape \(C, d\), got shape \(2,\)", random_weights, [1.0, 2], 5),
    ("Examples need finite values", random_weights, [[np.nan], [1]], 5),
)


VALUES = np.random.default_rng(3).normal(size=(9, 2)) * [20, 0.3]


@given(st.integers(1, 4), st.integers(0, 6), st.floats(0, 0.5), st.integers(0, 99))
def test_weights_add_up_to_one_and_stay_within_the_spread(numbers, more, spread, seed):
    """As in [KG04, accessible region]."""
    values = np.random.default_rng(seed).normal(size=(numbers + 1 + more, numbers))
    weights = random_weights(values, 30, spread=spread, seed=seed)
    assert np.allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert weights.min() >= -spread - 1e-12 and weights.max() <= 1 + spread + 1e-12
    assert ((weights != 0).sum(axis=1) <= numbers + 1).all()


def test_two_weights_are_even_over_what_is_allowed():
    """Also a little beyond the examples [KG04, accessible region]."""
    weights = random_weights([[0.0], [1.0]], 4000, spread=0.1)[:, 0]
    assert kstest((weights + 0.1) / 1.2, "uniform").pvalue > 0.01


def test_partners_are_the_nearest_by_scaled_values():
    """As in [KG04, accessible region]."""
    weights = random_weights(VALUES, 200, neighbours=3, seed=1)
    scaled = VALUES / VALUES.std(axis=0)
    distance = np.linalg.norm(scaled[:, None] - scaled, axis=-1)
    ranks = distance.argsort(axis=1).argsort(axis=1)
    for row in weights:
        chosen = np.flatnonzero(row)
        assert min(ranks[first][chosen].max() for first in chosen) <= 3


def test_a_seed_gives_the_same_again_and_another_one_others():
    one, same, other = (random_weights(VALUES, 5, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


def walk(degrees, speed=1.2):
    return generate_walk(arcs((0, 0), 0, [(5, np.radians(degrees))]).points, speed=speed)


@pytest.mark.parametrize("degrees", [-240, -60, 0, 90, 300])
def test_a_turn_counts_past_half_a_circle_and_to_the_left(degrees):
    assert np.degrees(heading_change(walk(degrees))) == pytest.approx(degrees, abs=15)


def test_measures_do_not_depend_on_where_a_clip_was_captured():
    here = walk(70)
    there = PlanarTransform(2.0, 50.0, -9.0).apply_motion(here)
    for measure in (heading_change, mean_speed, hand_target):
        assert np.allclose(measure(here), measure(there), atol=1e-9)


def test_the_hand_is_measured_where_the_arm_is_longest():
    arm = Skeleton(["root", "s", "e", "h"], [-1, 0, 1, 2], [[0, 0, 0], [0, 1, 0], [0, 0, 0.3], [0, 0, 0.3]])
    bend = np.tile(rotations.IDENTITY, (3, 4, 1))
    bend[[0, 2], 2] = rotations.about_y(1.0)
    bend[:, 0] = rotations.about_y(0.7)
    punch = Motion(arm, [[5, 0.2, 5]] * 3, bend, 30.0)
    assert hand_target(punch, "h", "s") == pytest.approx([0, 1.2, 0.6])
    refused("rhand", hand_target, punch)
