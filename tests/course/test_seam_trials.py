"""Walks by a matrix, and blends of matches drawn at random."""

import numpy as np
import pytest

from mocap.blending import align_window, cubic_weights, inertialize, join, linear_weights
from mocap.blending.joining import blend, splice
from mocap.body import resample
from mocap.course.seam_trials import Passage, choose_matches, passage, walk_costs
from mocap.datasets.samples import sample
from mocap.matching import find_transitions
from mocap.quality import jumps
from tests.strategies import glide

CLIPS = [resample(sample(name), 30) for name in ("walk_straight", "stop_and_go")]
WALK = sample("walk_straight")
FOUND = find_transitions(CLIPS, window=10, below=0.12)


def test_random_walks_take_the_steps_of_their_matrix_and_end_where_it_has_none():
    odds = np.array([[0, 0.5, 0.5, 0], [0, 0, 0, 1.0], [0.2, 0, 0, 0.8], [0, 0, 0, 0]])
    costs = np.array([[0, 1, 3.0, 0], [0, 0, 0, 1], [8.0, 0, 0, 1], [0] * 4])
    rows = walk_costs(odds, costs, walks=4000, seed=1)
    visits = np.linalg.inv(np.eye(4) - odds).mean(axis=0)  # of all steps, without a limit
    for cost, share in ((3, visits[0] * 0.5), (8, visits[2] * 0.2)):
        assert (rows == cost).sum() / 4000 == pytest.approx(share, rel=0.05)
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
    assert blended.jolts[3].max() > 0
    lengths = np.linalg.norm(blended.gap.reshape(48, -1, 3), axis=-1)
    assert blended.size(blended.gap) == pytest.approx(30 * np.sqrt((lengths**2).mean(axis=1)))


def walked(window, weights=cubic_weights):
    """Blend two moments of a walk; the window starts at frame 10 of 100."""
    second = align_window(WALK, 500, WALK, 242, window)
    mixed = blend(WALK[500 : 500 + window], second[242 : 242 + window], weights(window))
    joined = splice(WALK, 500, mixed, second, 242 + window)
    return Passage(joined[490:590], WALK[490:590], second[232:332], 10, weights(window))


def test_two_straight_lines_give_the_jolt_of_the_weights():
    t, weights = np.arange(30) / 30, linear_weights(10)
    result = glide(2.0 * t * (1 - np.concatenate([np.ones(10), weights, np.zeros(10)])))
    seen = Passage(result, glide(0.0 * t), glide(2.0 * t), 10, weights).jolts
    # the clips' own accelerations are 0: all that is there, the blend has added
    assert seen[1:3] == pytest.approx(0)
    assert seen[3] == pytest.approx(jumps(result)[9:21])
    assert seen[0] == pytest.approx(seen[3])


def test_what_the_clips_do_themselves_is_not_added():
    both = glide((np.arange(30) / 30) ** 3)
    seen = Passage(both, both, both, 5, cubic_weights(20)).jolts
    assert seen[3] == pytest.approx(0)
    assert seen[0] == pytest.approx(jumps(both)[4:26])


def test_outside_the_window_and_a_frame_on_either_side_a_join_adds_nothing():
    blended = walked(20)
    seen = blended.jolts[3]
    assert len(seen) == 22
    late = Passage(*(motion[10:] for motion in blended[:3]), 0, blended.weights)
    assert len(late.jolts[3]) == 20
    wider = np.concatenate([np.ones(5), cubic_weights(20), np.zeros(5)])
    added = blended._replace(start=5, weights=wider).jolts[3]
    assert added[[0, 1, 2, 3, -4, -3, -2, -1]] == pytest.approx(0, abs=1e-9)
    assert added.max() == pytest.approx(seen.max())


def test_longer_blends_add_less_and_linear_weights_add_more():
    added = [walked(window).jolts[3].max() for window in (2, 4, 10, 20, 40)]
    assert added == sorted(added, reverse=True)
    assert walked(40, linear_weights).jolts[3].max() > 2 * added[-1]


def test_inertialization_is_measured_against_the_second_clip():
    first, second = walked(40)[1:3]
    result = inertialize(WALK, 500, WALK, 242, 40)[490:590]
    assert Passage(result, first, second, 10, np.zeros(40)).jolts[3].max() < 0.2
    assert Passage(second, second, second, 10, np.zeros(40)).jolts[3] == pytest.approx(0)
