"""The curve against graphs built and pruned at each threshold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.errors import MocapError, NoWalk
from mocap.motion_graph import from_transitions, prune
from mocap.thresholds import ThresholdCurve, threshold_curve
from mocap.transforms import PlanarTransform
from mocap.transitions import Transitions, find_transitions
from tests.strategies import seeds, wave

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


@settings(max_examples=50)
@given(seeds, st.integers(0, 20))
def test_the_curve_is_what_building_and_pruning_gives(seed, count):
    found = made_up(seed, count)
    curve = threshold_curve(CLIPS, found, window=WINDOW, thresholds=[0, 0.02, 0.035, 0.05, 1])
    for row in zip(*curve, strict=True):
        graph = from_transitions(CLIPS, found[found.cost < row[0]], window=WINDOW)
        assert row[1:] == (graph.count("transition"), len(graph.graph), kept_frames(graph))


def test_by_default_it_ends_with_all_transitions():
    found = find_transitions(CLIPS, window=WINDOW, below=0.1)
    curve = threshold_curve(CLIPS, found, window=WINDOW)
    assert len(curve.threshold) == 30
    assert curve.transitions[-1] == len(found)
    assert curve.frames[-1] == kept_frames(from_transitions(CLIPS, found, window=WINDOW)) > 0
    assert all(np.all(np.diff(column) >= 0) for column in curve)


def test_the_suggestion_is_the_lowest_that_keeps_enough():
    curve = ThresholdCurve(
        np.array([1.0, 2, 3, 4]), *np.array([[1, 2, 3, 4], [4, 5, 6, 7], [0, 50, 95, 100]])
    )
    assert [curve.suggest(keep) for keep in (0.3, 0.9, 0.95, 1.0)] == [2, 3, 3, 4]
    for keep in (0, 1.1, np.nan):
        with pytest.raises(MocapError, match="keep must be a share"):
            curve.suggest(keep)
    with pytest.raises(NoWalk, match="At none of these"):
        curve._replace(frames=np.zeros(4, int)).suggest()


def test_what_makes_no_curve():
    found = made_up(0, 5)
    with pytest.raises(NoWalk, match="no transitions"):
        threshold_curve(CLIPS, found[:0], window=WINDOW)
    with pytest.raises(MocapError, match="Thresholds must be numbers"):
        threshold_curve(CLIPS, found, window=WINDOW, thresholds=[0.1, np.nan])
    with pytest.raises(MocapError, match="do not have the windows of"):
        threshold_curve(CLIPS[:1], found, window=WINDOW)
    with pytest.raises(MocapError, match="do not have the windows of"):
        threshold_curve(CLIPS, found, window=80)
