"""Walks by a matrix, matches drawn at random, and what is measured of their blends."""

import numpy as np
import pytest

from mocap.blending import cubic_weights, join
from mocap.body import resample
from mocap.course.seam_trials import choose_matches, measure_blends, passage, visit, walk_costs
from mocap.datasets.samples import sample
from mocap.matching import find_transitions

CLIPS = [resample(sample(name), 30) for name in ("walk_straight", "stop_and_go")]
FOUND = find_transitions(CLIPS, window=10, below=0.12)


def test_all_walks_at_once_take_as_many_transitions_as_many_walks_at_random():
    odds = np.array([[0, 0.5, 0.5, 0], [0, 0, 0, 1.0], [0.2, 0, 0, 0.8], [0, 0, 0, 0]])
    jumps = odds * [[0, 0, 1, 0], [0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]]
    costs = np.array([[0, 0, 3.0, 0], [0] * 4, [8.0, 0, 0, 0], [0] * 4])
    rows = walk_costs(odds, costs * (jumps > 0), walks=4000)
    steps, taken = (~np.isnan(rows)).sum(), rows > 0
    assert visit(odds, jumps, costs) == pytest.approx((taken.sum() / steps, rows[taken].mean()), rel=0.05)
    assert np.isnan(rows[:, -1]).all()
    assert np.isnan(walk_costs(np.zeros((1, 1)), np.zeros((1, 1)))).all()  # nothing can walk


@pytest.mark.parametrize("beside", [24, 34])
def test_chosen_matches_have_room_and_costs_as_asked(beside):
    some = choose_matches(CLIPS, FOUND, (0.05, 0.1), beside=beside)
    assert 5 < len(some) <= 30
    assert all(0.05 <= match.cost < 0.1 and match.source != match.target for match in some)
    assert {len(passage(CLIPS, match, 40, beside=beside).result) for match in some} == {2 * beside}


@pytest.mark.parametrize("window", [4, 20])
def test_a_passage_is_the_join_at_the_middle_of_the_match(window):
    match = choose_matches(CLIPS, FOUND, (0, 0.1), count=1)[0]
    blended, half = passage(CLIPS, match, window), window // 2
    leave, enter = match.leave + 5 - half, match.enter + 5 - half
    whole = join(CLIPS[match.source], leave, CLIPS[match.target], enter, window)
    part = whole[leave + half - 24 : leave + half + 24]
    assert blended.result.root_positions == pytest.approx(part.root_positions)
    assert blended.alpha[24 - half : 24 - half + window] == pytest.approx(cubic_weights(window))
    assert blended.jolts.added.max() > 0
    lengths = np.linalg.norm(blended.gap.reshape(48, -1, 3), axis=-1)
    assert blended.size(blended.gap) == pytest.approx(30 * np.sqrt((lengths**2).mean(axis=1)))


def test_blends_are_measured_one_by_one():
    some = choose_matches(CLIPS, FOUND, (0, 0.1), count=3)
    measured = measure_blends(CLIPS, some, [4, 10], lambda gap, alpha: (gap, 2 * gap))
    again = [[passage(CLIPS, match, window) for match in some] for window in (4, 10)]
    assert measured.added.tolist() == [[p.jolts.added.max() for p in row] for row in again]
    assert measured.slide.tolist() == [[p.slide for p in row] for row in again]
    assert measured.leads.all()
    assert measured.stands_out.shape == (2, 3)
