"""The curve against graphs built and pruned at each threshold."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.planar import PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.motion_graph import from_transitions
from mocap.graphs.pruning import prune
from mocap.graphs.thresholds import ThresholdCurve, threshold_curve, velocity_gaps
from mocap.matching.transitions import Transitions, find_transitions
from tests.refusals import refusals, refused
from tests.strategies import planar, seeds, wave

CLIPS = [wave(90, name="a"), wave(70, phase=1.0, name="b", seed=1)]
WINDOW = 8


def made_up(seed, count):
    random = np.random.default_rng(seed)
    source, target = random.integers(0, 2, (2, count))
    leave, enter = random.integers(0, 60, (2, count))
    zeros = np.zeros(count)
    cost = random.integers(1, 6, count) / 100  # often the same
    return Transitions(source, leave, target, enter, cost, PlanarTransform(zeros, zeros, zeros))


def kept_frames(graph):
    try:
        return prune(graph).frames
    except NoWalk:
        return 0


@pytest.mark.filterwarnings("ignore:0 frames of clip stay")
@given(seeds, st.integers(0, 20))
def test_the_curve_is_what_building_and_pruning_gives(seed, count):
    found = made_up(seed, count)
    gaps = velocity_gaps(CLIPS, found, window=WINDOW)
    curve = threshold_curve(CLIPS, found, window=WINDOW, thresholds=[0, 0.02, 0.035, 0.05, 1])
    for row in zip(*curve, strict=True):
        close = found.cost < row[0]
        graph = from_transitions(CLIPS, found[close], window=WINDOW)
        size = graph.count("transition"), len(graph.graph), graph.graph.number_of_edges()
        assert row[1:5] == (*size, kept_frames(graph))
        means = [column[close].mean() if close.any() else 0.0 for column in (found.cost, gaps)]
        np.testing.assert_allclose(row[5:], means, atol=1e-12)


def test_it_ends_with_all_transitions():
    found = find_transitions(CLIPS, window=WINDOW, below=0.1)
    curve = threshold_curve(CLIPS, found, window=WINDOW, thresholds=np.linspace(0, 0.1, 31))
    assert curve.transitions[-1] == len(found)
    assert curve.frames[-1] == kept_frames(from_transitions(CLIPS, found, window=WINDOW)) > 0
    assert all(np.all(np.diff(column) >= 0) for column in curve[:6])


def test_the_suggestion_is_the_lowest_that_keeps_enough():
    levels, rest = np.array([1.0, 2, 3, 4]), np.arange(4)
    curve = ThresholdCurve(levels, rest, rest, rest, np.array([0, 50, 95, 100]), levels, levels)
    assert curve.suggest() == 3 and curve._replace(frames=np.array([0, 90, 89, 100])).suggest() == 2
    refused("At none of these", curve._replace(frames=np.zeros(4, int)).suggest, kind=NoWalk)


def curve_of(found, clips=CLIPS, window=WINDOW, thresholds=(0.05,)):
    return threshold_curve(clips, found, window=window, thresholds=thresholds)


test_what_makes_no_curve = refusals(
    ("Thresholds must be numbers", lambda: curve_of(made_up(0, 5), thresholds=[0.1, np.nan])),
    ("windows that lie outside", curve_of, made_up(0, 5), CLIPS[:1]),
    ("windows that lie outside", curve_of, made_up(0, 5), CLIPS, 80),
)


def gaps_of(clips, ways):
    """Measure transitions from frame 30 of clip 0 to frame 30 of clip 1, laid by each of some transforms."""
    count = len(ways)
    zero, thirty = np.zeros(count, int), np.full(count, 30)
    found = Transitions(zero, thirty, zero + 1, thirty, np.zeros(count), PlanarTransform(*np.array(ways).T))
    return velocity_gaps(clips, found, window=WINDOW)


@given(planar)
def test_a_copy_moves_as_the_original(transform):
    back = transform.inverse()
    turned = back._replace(angle=back.angle + np.pi)
    right, wrong = gaps_of([CLIPS[0], transform.apply_motion(CLIPS[0])], [back, turned])
    assert right == pytest.approx(0, abs=1e-9)
    assert wrong > 0.5


def test_a_gap_is_in_metres_a_second():
    away = np.outer(np.arange(90) / 30, [3.0, 0, 0])
    faster = replace(CLIPS[0], root_positions=CLIPS[0].root_positions + away)
    assert gaps_of([CLIPS[0], faster], [PlanarTransform(0.0, 0.0, 0.0)]) == pytest.approx(3.0)
