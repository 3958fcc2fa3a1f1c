"""What is asked is got; what is near in parameters is near in motion; boxes hold good targets."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from walking import generate_walk

from mocap.body import joint_positions, resample
from mocap.datasets import sample
from mocap.errors import MocapError, NoWalk, SkeletonMismatch
from mocap.matching.distance_grids import distance_grid
from mocap.methods.match_webs import weights_for
from mocap.methods.parametric_graphs import (
    build_parametric,
    cut_strides,
    made_motions,
    make_space,
    parametric_edges,
)
from mocap.methods.parametric_graphs.examples import register_cuts
from mocap.methods.parametric_graphs.made_motions import make_motion, near_end, optimal_transitions
from mocap.methods.parametric_graphs.parametric_edges import build_edge, shrink_box
from mocap.methods.parametric_graphs.stride_spaces import (
    bell_weights,
    draw_parameters,
    measure_mixes,
    parameter_text,
    spread_parameters,
)
from mocap.methods.parametric_graphs.tuned import TUNED
from tests.bundled import clips
from tests.editing.wishes import bones
from tests.methods.parametric_graphs import built
from tests.refusals import refusals, refused

HALF, SPAN, WINDOW = made_motions.HALF, TUNED.span, made_motions.WINDOW


@pytest.mark.parametrize("feet", ["lrl", "lr", "rl"])
def test_what_is_asked_is_got(feet):
    """As in [HG07, nodes]."""
    tested = built.space(feet)
    off = built.missed(tested, draw_parameters(tested, 300, np.random.default_rng(5)))
    assert off.max() <= 0.1 and off.mean() <= 0.01


def test_sources_are_placed_evenly_and_at_the_ends():
    """For several parameters only where the space reaches: the corners of its range may hold no stride."""
    one, both = built.space(), built.by_turn_and_speed()
    np.testing.assert_allclose(spread_parameters(one, 9), np.linspace(one.low, one.high, 9))
    at = spread_parameters(both, 40)
    assert built.missed(both, at)[:, 0].max() < 2
    for end in ("min", "max"):
        np.testing.assert_array_equal(getattr(at, end)(axis=0), getattr(both.reached, end)(axis=0))

    def nearest(some):
        gaps = np.linalg.norm((both.reached[:, None] - some) / both.scale, axis=-1)
        return gaps.min(axis=1).max()

    drawn = [draw_parameters(both, 40, np.random.default_rng(seed)) for seed in range(10)]
    assert len(at) == 40 and nearest(at) < 0.7 * min(map(nearest, drawn))


def test_the_range_is_cut_to_what_the_strides_come_to_and_weights_never_reach_beyond():
    wide, tested = make_space(built.strides(), 0.2, -9.0, 9.0), built.space()
    assert wide.low[0] > -2.5 and wide.high[0] < 2.5
    far = weights_for(tested, [[-9.0], [9.0]])
    np.testing.assert_allclose(far.sum(axis=1), 1)
    ends = measure_mixes(tested.examples, far)[:, 0]
    assert tested.values.min() - 0.02 <= ends[0] < ends[1] <= tested.values.max() + 0.02


def test_a_change_of_two_degrees_changes_the_clip_by_millimetres():
    """Where windows are compared; of raw strides, the nearest few, it does by more than a centimetre."""
    asked = np.linspace(-1.1, 1.1, 60)[:, None]
    one, other = (near_end(built.space(), a, 0.0)[0] for a in (asked, asked + np.radians(2)))
    assert 100 * np.median(np.sqrt(((one - other) ** 2).sum(axis=-1).mean(axis=(1, 2)))) < 0.4


def some(count, spread=1.0):
    """Strides evenly spread over the turns, as many as asked for."""
    turns = built.strides().values[:, 0]
    wanted = np.linspace(-spread, spread, count)[:, None]
    return built.strides().take(np.isin(np.arange(len(turns)), np.abs(turns - wanted).argmin(axis=1)))


def made(some=built.strides, low=-0.5, high=0.5):
    return make_space(some(), 0.2, low, high)


test_what_makes_no_sense_is_refused = refusals(
    ("A range has ends low < high", lambda: made(low=0.5)),
    ("A range has ends low < high", lambda: made(high=np.nan)),
    (r"Only 0 of 120 .*: they come to a turn of 88° to 88°\.", lambda: made(low=20.0, high=21.0)),
    ("that vary, got 1 with .*: add clips that vary in their turn", lambda: made(lambda: some(1))),
    (
        "got 7 with a turn of -1° to 1°: add a clip that turns to the left, and one",
        made,
        lambda: cut_strides([clips()[3]]),
    ),
)


def test_it_turns_as_asked_and_its_bones_are_whole():
    for asked in (-0.9, 0.0, 0.6):
        made = make_motion(built.space(), np.array([asked]))
        turn = made.heading[made.frame(1.0)] - made.heading[made.frame(0.0)]
        assert abs(turn - asked) < np.radians(3)  # frames beside phases
        assert bones(made.motion) < 1e-9


def test_it_is_the_mix_that_its_weights_say_and_knows_what_it_came_to():
    tested, asked = built.space(), np.array([0.4])
    made, weights = make_motion(tested, asked), weights_for(tested, asked)
    assert made.values == pytest.approx(asked, abs=1e-6)
    assert measure_mixes(tested.examples, weights[None])[0, 0] == pytest.approx(0.4, abs=2e-3)
    frame, blend = made.frame(0.0), tested.examples.blend(weights)
    assert np.abs(made.motion.rotations[frame] - blend.rotations[0]).max() < 0.02
    assert blend.duration == pytest.approx((made.frame(1.0) - frame) / 30, abs=0.04)


@pytest.mark.parametrize(("source", "target"), [("lrl", "lrl"), ("lr", "rl")])
def test_costs_are_those_of_a_distance_grid(source, target):
    """As in [HG07, 3.1]."""
    first, second = built.space(source), built.space(target)
    at, to = np.array([[-0.2], [0.0], [0.3]]), np.array([[0.1], [-0.4]])
    costs, leave, enter = optimal_transitions(first, second, at, to)
    for row, asked in enumerate(at):
        one = make_motion(first, asked)
        centre = int(np.round(np.interp(1.0, one.phases, np.arange(len(one.phases)))))
        for column, other in enumerate(to):
            two = make_motion(second, other)
            into = int(np.round(np.interp(0.0, two.phases, np.arange(len(two.phases)))))
            some = [m.motion[c - HALF - SPAN : c + HALF + SPAN + 1] for m, c in ((one, centre), (two, into))]
            grid = np.sqrt(np.maximum(distance_grid(*some, window=WINDOW), 0))
            assert costs[row, column] == pytest.approx(grid.min(), abs=2e-4)
            i, j = np.unravel_index(grid.argmin(), grid.shape)
            best = one.phases[centre - SPAN + i], two.phases[into - SPAN + j]
            assert (leave[row, column], enter[row, column]) == pytest.approx(best, abs=0.02)


def test_only_the_frames_near_a_strike_are_made():
    tested = built.space()
    points, phases = near_end(tested, np.array([[0.2]]), 0.0)
    made = make_motion(tested, np.array([0.2]))
    frames = 2 * (HALF + SPAN) + 1
    assert points.shape[:2] == phases.shape == (1, frames)
    middle = made.frame(phases[0, HALF + SPAN])
    window = joint_positions(made.motion[middle - HALF : middle + HALF + 1])[:, tested.examples.joints]
    np.testing.assert_allclose(points[0, SPAN:-SPAN], window, atol=2e-3)


def test_windows_that_run_off_the_margins_of_quick_strides_are_refused():
    """A quiet `np.interp` would hold the last frame; with half a stride beyond its strikes a jog has room."""
    jogs = [resample(generate_walk([[0, 0], [s, 6], [5 * s, 12]], style="jog"), 30) for s in (-2, 0, 2)]
    tight, wide = (make_space(cut_strides(jogs, margin=m), 0.2, -0.3, 0.3) for m in (0.3, 0.5))
    for phase in (0.0, 1.0):
        with pytest.raises(MocapError, match=r"A window runs 0.04 s off a motion of 1.22 s, margins and all"):
            near_end(tight, np.zeros((1, 1)), phase)
    assert np.ptp(near_end(wide, np.zeros((1, 1)), 1.0)[1]) > 0.6


PLACES = st.floats(-10, 10).map(lambda v: round(v, 2))


def test_few_sources_leave_bad_targets_in_the_boxes_between_them_and_few_targets_leave_boxes_small():
    """As in [HG07, 4], with means of few strides each, so that costs are uneven."""
    source, samples = built.space(degrees=6), ((5, 300), (50, 300), (5, 20))
    few, many, small = (build_edge(source, source, good=0.02, sampling=sampling) for sampling in samples)
    assert len(many.sources) == 50 and (small.high - small.low).mean() < 0.95 * (few.high - few.low).mean()
    assert built.bad_ones(source, source, few, TUNED.bad * 0.02)[0] > 0.12
    assert built.bad_ones(source, source, many, TUNED.bad * 0.02)[0] < 0.03


def test_with_d_plus_1_neighbours_boxes_jump():
    """The paper's k gives the nearest source alone; d + 4 of sources placed evenly move [HG07, Eqs. 1-3]."""
    edge = built.walking().edges["walk", "walk"]["edge"]
    fine = np.radians(np.arange(-70, 70, 0.1))[:, None]
    sides = {k: np.array([edge.look_up(asked, k).low[0] for asked in fine]) for k in (2, 3, None)}
    jumps = {k: np.degrees(np.abs(np.diff(side)).max()) for k, side in sides.items()}
    assert len(np.unique(sides[2].round(9))) <= 50 < 500 < len(np.unique(sides[3].round(9)))
    assert jumps[2] > 10 > 5 * jumps[None] and jumps[2] > jumps[3] > jumps[None]


def test_a_box_reaches_further_to_the_side_one_turns_to():
    edge = built.walking().edges["walk", "walk"]["edge"]
    left, right = (edge.look_up(np.array([side])) for side in (0.7, -0.7))
    assert left.low + left.high > right.low + right.high


def test_costs_at_the_looked_up_phases_are_nearly_the_best():
    """As in [HG07, Eq. 3]."""
    source = built.space()
    edge, random = built.walking().edges["walk", "walk"]["edge"], np.random.default_rng(3)
    at = draw_parameters(source, 30, random)
    leave = np.array([edge.look_up(asked).leave for asked in at])
    best = optimal_transitions(source, source, at, np.zeros((1, 1)))[1][:, 0]
    assert np.abs(leave - best).mean() < 0.06  # phases: two frames


@given(arrays(float, (6, 2), elements=PLACES), arrays(float, (4, 2), elements=PLACES))
def test_a_shrunk_box_holds_no_bad_target_and_lies_in_the_good_ones(good, bad):
    """As in [HG07, 3.2]."""
    scale = np.array([2.0, 5.0])
    low, high = shrink_box(good, bad, scale, eps=0.01)
    assert (low >= good.min(axis=0)).all() and (high <= good.max(axis=0)).all()
    if (low <= high).all():
        assert not ((bad > low) & (bad < high)).all(axis=1).any()


@pytest.mark.parametrize(
    ("bad", "low", "high"),
    [
        ([[10.5, 5], [-0.5, 5], [5, 12], [5, -2]], [0, 0], [10, 10]),
        ([[10.25, 5], [-0.25, 5], [5, 11], [5, -1]], [0.25, 1], [9.75, 9]),
    ],
)
def test_a_box_keeps_a_tenth_of_each_unit_from_bad_targets(bad, low, high):
    box = shrink_box(np.array([[0.0, 0], [10, 10]]), np.array(bad), np.array([5.0, 20]), eps=0.1)
    assert [side.tolist() for side in box] == [low, high]


def test_weights_below_a_thousandth_of_the_largest_are_dropped():
    weights = bell_weights(np.array([[0.0], [3.7], [3.75]]), np.array([[0.0], [0.05]]), 1.0)
    expected = [[0.9989, 0.0011, 0], [0.9977, 0.0013, 0.0011]]
    np.testing.assert_allclose(weights, expected, atol=5e-5)
    assert weights[0, 2] == 0


def test_three_samples_or_three_strides_make_a_space():
    walk = cut_strides([resample(sample("walk_curve_2"), 30)])
    assert len(make_space(walk, 0.4, 0.0, 0.04).reached) == 3
    three = make_space(walk.take(np.argsort(walk.values[:, 0])[12:15]), 0.4, -0.8, 0.8)
    assert np.degrees([*three.low, *three.high]).round().tolist() == [-17, 18]


def test_the_side_that_loses_least_moves_and_shares_count_not_metres():
    """As in [HG07, 3.2]."""
    good, bad = np.array([[0.0, 0], [10, 1]]), np.array([[5.0, 0.9]])
    _, high = shrink_box(good, bad, np.array([5.0, 0.5]))
    assert high[1] < 0.9 and high[0] == 10  # of the second half range 0.2 is lost, of the first 1
    low, _ = shrink_box(good, bad, np.array([500.0, 0.5]))
    assert low[0] > 5  # the first is measured in hundreds


def test_the_smallest_threshold_is_the_smallest():
    """As in [HG07, no edge]."""
    source = built.space()
    least = build_edge(source, source, good=np.inf, sampling=built.SMALL).smallest_good
    build_edge(source, source, good=1.001 * least, sampling=built.SMALL)
    with pytest.raises(NoWalk, match=r"Nothing follows turn -?\d+° below 1.0 cm \(the best costs"):
        build_edge(source, source, good=0.01, sampling=built.SMALL)
    assert build_edge(source, source, good=0.05, sampling=built.SMALL).smallest_good == pytest.approx(least)


def test_good_targets_with_bad_ones_all_around_leave_a_box_of_one():
    source = built.space()
    least = build_edge(source, source, good=np.inf, sampling=built.SMALL).smallest_good
    tight = build_edge(source, source, good=1.0001 * least, bad=1.0001 * least, sampling=built.SMALL)
    assert (tight.low <= tight.high + 1e-9).all()


def changed(**parts):
    return replace(built.space(), examples=replace(built.space().examples, **parts))


def edge_to(target=None, good=0.04, **settings):
    return build_edge(built.space(), target or built.space(), good=good, **settings)


def graph_of(edges=None, good=0.03, **spaces):
    return build_parametric({"walk": built.space(), **spaces}, edges, good=good, sampling=built.SMALL)


BONES = replace(built.space().examples.skeleton, offsets=1.2 * built.space().examples.skeleton.offsets)

test_what_cannot_be_built_is_refused = refusals(
    ("T_GOOD <= T_BAD", lambda: edge_to(bad=0.03)),
    ("T_GOOD <= T_BAD", lambda: edge_to(good=np.nan)),
    ("lack head", lambda: edge_to(changed(contact_names=("lfoot", "rfoot", "ltoes", "head")))),
    ("one rate, got 30 and 60 Hz", lambda: edge_to(changed(fps=60.0))),
    (SkeletonMismatch, "sits", lambda: edge_to(changed(skeleton=BONES))),
    ("There is no space 'run'; there are: walk", graph_of, [("walk", "run")]),
    (NoWalk, r"walk → walk: Nothing .* raise T_GOOD to 1.\d cm", graph_of, [("walk", "walk")], 0.005),
    (NoWalk, "Nothing follows 'walk' below 0.5 cm", graph_of, None, 0.005),
    ("one rate, got 30 and 60 Hz", lambda: graph_of([("walk", "walk"), ("b", "b")], b=changed(fps=60.0))),
)


def test_by_default_all_edges_that_can_be_had_are_there():
    """As in [HG07, graph]."""
    some = {name: built.walk_and_jog().nodes[name]["space"] for name in ("walk", "jog to walk")}
    graph = build_parametric(some, good=0.05, sampling=built.SMALL)
    assert set(graph.edges) == {("walk", "walk"), ("jog to walk", "walk")}


def test_the_example_that_sets_the_clock_keeps_its_frames():
    walks = [resample(generate_walk([[0, 0], [x, 2.5], [2 * x, 4]]), 30) for x in (0.0, 0.5, 1.0)]
    cuts = [(walk, np.linspace(10, 60, 11)) for walk in walks]
    clocked = register_cuts(cuts, (2, 8))
    _, frames = clocked[1]  # its turn is the median
    assert frames == pytest.approx(cuts[1][1], abs=1e-6)


def test_where_bad_targets_are_all_around_the_best_target_is_the_whole_box(monkeypatch):
    space = built.space()
    count = 5
    leave = np.linspace(0.9, 1.1, count)
    enter = np.linspace(-0.1, 0.1, count)
    best = 3
    costs = np.full(count, 0.2)
    costs[best] = 0.01
    crowded = np.linspace(0.3, 0.3 + 1e-3 * space.scale[0], count)[:, None]
    monkeypatch.setattr(parametric_edges, "draw_parameters", lambda *_: crowded)
    monkeypatch.setattr(
        parametric_edges,
        "optimal_transitions",
        lambda _, __, at, ___: [np.tile(row, (len(at), 1)) for row in (costs, leave, enter)],
    )
    edge = build_edge(space, space, good=0.02, sampling=(6, count))
    assert np.array_equal(edge.low, np.tile(crowded[best], (len(edge.sources), 1)))
    assert np.array_equal(edge.high, edge.low)
    assert edge.leave == pytest.approx(leave[best])
    assert edge.enter == pytest.approx(enter[best])


def test_the_source_that_nothing_follows_is_named(monkeypatch):
    space = built.space()

    def costs_that_rise(_source, _target, at, to):
        costs = np.repeat(np.linspace(0.01, 0.03, len(at))[:, None], len(to), axis=1)
        return costs, costs, costs

    monkeypatch.setattr(parametric_edges, "optimal_transitions", costs_that_rise)
    name = space.parameters[0]
    worst = parameter_text(name, spread_parameters(space, 6)[-1, 0])
    refused(
        f"Nothing follows {name} {re.escape(worst)} below 2.0 cm",
        lambda: build_edge(space, space, good=0.02, sampling=(6, 5)),
        kind=NoWalk,
    )
