"""What a blend adds is right where it is known in closed form, and grows where the clips differ more."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.blending import cubic_weights, inertialize, join, lay_window_on, linear_weights
from mocap.body.motion import Motion, resample
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.quality.blend_measures import BlendJolts, added_jolt, blend_jolts, ground_slides, knee_turns
from mocap.quality.seam_measures import jumps

WALK = sample("walk_straight")


def glide(path: np.ndarray, fps: float = 30.0) -> Motion:
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    return Motion(
        dot, path[:, None] * [1.0, 0, 0] + [0, 1, 0], np.tile([1.0, 0, 0, 0], (len(path), 1, 1)), fps
    )


def passage(window: int, weights=cubic_weights) -> tuple[Motion, Motion, Motion]:
    """Blend two moments of a walk; the window starts at frame 10 of 100."""
    second = lay_window_on(WALK, 500, WALK, 233, window)
    joined = join(WALK, 500, WALK, 233, window, weights=weights)
    return joined[490:590], WALK[490:590], second[223:323]


def test_two_straight_lines_give_the_jolt_of_the_weights():
    t = np.arange(30) / 30
    first, second = glide(0.0 * t), glide(2.0 * t)
    alpha = np.concatenate([np.ones(10), linear_weights(10), np.zeros(10)])
    result = glide(2.0 * t * (1 - alpha))
    seen = blend_jolts(result, first, second, 10, linear_weights(10))
    # the clips' own accelerations are 0: all that is there, the blend has added
    assert seen.own == pytest.approx(0)
    assert seen.added == pytest.approx(jumps(result)[0][9:21])
    assert seen.stands_out


def test_what_the_clips_do_themselves_is_not_added():
    t = np.arange(30) / 30
    both = glide(t**3)
    seen = blend_jolts(both, both, both, 5, cubic_weights(20))
    assert seen.added == pytest.approx(0)
    assert seen.result == pytest.approx(jumps(both)[0][4:26])
    assert not seen.stands_out


def test_the_jolts_cover_the_window_and_a_frame_on_either_side():
    result, first, second = passage(20)
    assert len(blend_jolts(result, first, second, 10, cubic_weights(20)).added) == 22
    assert len(blend_jolts(result[10:], first[10:], second[10:], 0, cubic_weights(20)).added) == 20


def test_outside_the_window_a_join_adds_nothing():
    result, first, second = passage(20)
    start, wider = 5, np.concatenate([np.ones(5), cubic_weights(20), np.zeros(5)])
    added = blend_jolts(result, first, second, start, wider).added
    assert added[:4] == pytest.approx(0, abs=1e-9)
    assert added[-4:] == pytest.approx(0, abs=1e-9)
    assert added.max() == pytest.approx(added_jolt(result, first, second, 10, cubic_weights(20)))


def test_longer_blends_add_less_and_linear_weights_add_more():
    added = [added_jolt(*passage(window), 10, cubic_weights(window)) for window in (2, 4, 10, 20, 40)]
    assert added == sorted(added, reverse=True)
    assert added_jolt(*passage(40, linear_weights), 10, linear_weights(40)) > 2 * added[-1]


def test_inertialization_is_measured_against_the_second_clip():
    second = lay_window_on(WALK, 500, WALK, 233, 40)[223:323]
    result = inertialize(WALK, 500, WALK, 233, 40)[490:590]
    assert added_jolt(result, WALK[490:590], second, 10, np.zeros(40)) < 0.2
    assert added_jolt(second, second, second, 10, np.zeros(40)) == pytest.approx(0)


def test_a_result_stands_out_when_it_exceeds_both_clips():
    at = np.array([0.1, 0.2])
    assert BlendJolts(at + 0.2, at, at + 0.1, at).stands_out
    assert not BlendJolts(at + 0.1, at, at + 0.2, at).stands_out


@pytest.mark.parametrize(("start", "window"), [(-1, 10), (95, 10), (10, 0)])
def test_a_window_that_runs_off_is_refused(start, window):
    with pytest.raises(MocapError, match="no window"):
        added_jolt(*passage(10), start, np.zeros(window))


def test_motions_of_different_lengths_are_refused():
    result, first, second = passage(10)
    with pytest.raises(MocapError, match="as many frames"):
        added_jolt(result, first[1:], second, 10, cubic_weights(10))


def test_a_slide_is_the_distance_over_the_ground_while_a_joint_is_planted():
    walk = resample(WALK, 30)
    drift = walk.root_positions + np.arange(len(walk))[:, None] * [0.003, 0.01, 0.004]  # 5 mm per frame
    slid = ground_slides(replace(walk, root_positions=drift))
    planted = sum(int((on[1:] & on[:-1]).sum()) for on in walk.contacts.values())
    assert slid.sum() == pytest.approx(0.5 * planted)
    assert slid[slid > 0.1] == pytest.approx(0.5)


def test_a_slide_needs_contacts():
    with pytest.raises(MocapError, match="mark_plants"):
        ground_slides(replace(WALK, contacts={}))


def test_a_knee_that_is_turned_by_hand_turns_as_far():
    knee = WALK.skeleton.index("ltibia")
    rotations = WALK.rotations.copy()
    rotations[600:, knee] = rotations[599, knee]
    still = knee_turns(replace(WALK, rotations=rotations))
    assert still[600:, 0] == pytest.approx(0, abs=1e-5)
    half = np.sqrt(0.5)
    rotations[700:, knee] = [half, half, 0, 0]
    rotations[699, knee] = [1, 0, 0, 0]
    assert knee_turns(replace(WALK, rotations=rotations))[699, 0] == pytest.approx(90)
