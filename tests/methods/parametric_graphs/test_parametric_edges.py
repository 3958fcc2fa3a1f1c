"""Boxes hold good targets, on samples that the edge has never seen; refusals say what would help."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mocap.errors import NoWalk, SkeletonMismatch
from mocap.methods.parametric_graphs import build_parametric
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.parametric_edges import BAD, build_edge, shrink_box
from mocap.methods.parametric_graphs.stride_spaces import draw_parameters
from tests.methods.parametric_graphs.built import SMALL, bad_ones, space, walk_and_jog, walking
from tests.refusals import refusals

PLACES = st.floats(-10, 10).map(lambda v: round(v, 2))


def test_few_sources_leave_bad_targets_in_the_boxes_between_them_and_few_targets_leave_boxes_small():
    """As in [HG07, 4]."""
    source, samples = space(), ((5, 300), (50, 300), (5, 20))
    few, many, small = (build_edge(source, source, good=0.03, sampling=sampling) for sampling in samples)
    assert len(many.at) == 50 and (small.high - small.low).mean() < 0.95 * (few.high - few.low).mean()
    assert bad_ones(source, source, few, BAD * 0.03)[0] > 0.12
    assert bad_ones(source, source, many, BAD * 0.03)[0] < 0.03


def test_with_d_plus_1_neighbours_boxes_jump():
    """The paper's k gives the nearest source alone; d + 4 of sources placed evenly move [HG07, Eqs. 1-2]."""
    edge = walking().edges["walk", "walk"]["edge"]
    fine = np.radians(np.arange(-70, 70, 0.1))[:, None]
    sides = {k: np.array([edge.look_up(asked, k).low[0] for asked in fine]) for k in (2, 3, None)}
    jumps = {k: np.degrees(np.abs(np.diff(side)).max()) for k, side in sides.items()}
    assert len(np.unique(sides[2].round(9))) <= 50 < 500 < len(np.unique(sides[3].round(9)))
    assert jumps[2] > 10 > 5 * jumps[None] and jumps[2] > jumps[3] > jumps[None]


def test_a_box_reaches_further_to_the_side_one_turns_to():
    edge = walking().edges["walk", "walk"]["edge"]
    left, right = (edge.look_up(np.array([side])) for side in (0.7, -0.7))
    assert left.low + left.high > right.low + right.high


def test_costs_at_the_looked_up_phases_are_nearly_the_best():
    """As in [HG07, Eq. 3]."""
    source = space()
    edge, random = walking().edges["walk", "walk"]["edge"], np.random.default_rng(3)
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


def test_the_side_that_loses_least_moves_and_shares_count_not_metres():
    """As in [HG07, 3.2]."""
    good, bad = np.array([[0.0, 0], [10, 1]]), np.array([[5.0, 0.9]])
    _, high = shrink_box(good, bad, np.array([5.0, 0.5]))
    assert high[1] < 0.9 and high[0] == 10  # of the second half range 0.2 is lost, of the first 1
    low, _ = shrink_box(good, bad, np.array([500.0, 0.5]))
    assert low[0] > 5  # the first is measured in hundreds


def test_the_smallest_threshold_is_the_smallest():
    """As in [HG07, no edge]."""
    source = space()
    least = build_edge(source, source, good=np.inf, sampling=SMALL).least
    build_edge(source, source, good=1.001 * least, sampling=SMALL)
    with pytest.raises(NoWalk, match=r"Nothing follows turn -?\d+° below 1.0 cm \(the best costs"):
        build_edge(source, source, good=0.01, sampling=SMALL)
    assert build_edge(source, source, good=0.05, sampling=SMALL).least == pytest.approx(least)


def test_good_targets_with_bad_ones_all_around_leave_a_box_of_one():
    source = space()
    least = build_edge(source, source, good=np.inf, sampling=SMALL).least
    tight = build_edge(source, source, good=1.0001 * least, bad=1.0001 * least, sampling=SMALL)
    assert (tight.low <= tight.high + 1e-9).all()


def changed(**parts):
    return replace(space(), examples=replace(space().examples, **parts))


def edge_to(target=None, good=0.04, **settings):
    return build_edge(space(), target or space(), good=good, **settings)


def built(edges=None, good=0.03, **spaces):
    return build_parametric({"walk": space(), **spaces}, edges, good=good, sampling=SMALL)


BONES = replace(space().examples.skeleton, offsets=1.2 * space().examples.skeleton.offsets)

test_what_cannot_be_built_is_refused = refusals(
    ("T_GOOD <= T_BAD", lambda: edge_to(bad=0.03)),
    ("T_GOOD <= T_BAD", lambda: edge_to(good=np.nan)),
    ("lack head", lambda: edge_to(changed(contact_names=("lfoot", "rfoot", "ltoes", "head")))),
    ("one rate, got 30 and 60 Hz", lambda: edge_to(changed(fps=60.0))),
    (SkeletonMismatch, "sits", lambda: edge_to(changed(skeleton=BONES))),
    ("There is no space 'run'; there are: walk", built, [("walk", "run")]),
    (NoWalk, r"walk → walk: Nothing .* raise T_GOOD to 1.\d cm", built, [("walk", "walk")], 0.005),
    (NoWalk, "Nothing follows 'walk' below 0.5 cm", built, None, 0.005),
    ("one rate, got 30 and 60 Hz", lambda: built([("walk", "walk"), ("b", "b")], b=changed(fps=60.0))),
)


def test_by_default_all_edges_that_can_be_had_are_there():
    """As in [HG07, graph]."""
    some = {name: walk_and_jog().nodes[name]["space"] for name in ("walk", "jog")}
    graph = build_parametric(some, good=0.05, sampling=SMALL)
    assert set(graph.edges) == {("walk", "walk"), ("jog", "jog")}
