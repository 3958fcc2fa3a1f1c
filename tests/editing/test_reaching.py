"""Each frame is brought to its pins by itself, as near as SciPy brings it; the frames between jump."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from mocap.body.kinematics import joint_positions
from mocap.editing.linear_bodies import Body, body_of, linear
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.editing.reaching import Solved, cost, reach
from mocap.errors import MocapError, MocapWarning
from tests.editing.wishes import bones, hand_at, smoothness, stone, walk


def reached(clip, pins, **options) -> Solved:
    return reach(clip, pins, body_of(walk(), pins.joints), **options)


def test_a_frame_is_as_near_as_scipy_brings_it():
    clip = walk()[240:241]
    wrist = clip.skeleton.index("rwrist")
    place = joint_positions(clip)[0, wrist] + [-0.1, 0.3, 0.2]
    pins = join_pins(plant_pins(walk()).at(slice(240, 241)), pin(clip, wrist, [0], place))
    solved = reached(clip, pins, weight=100, passes=30)
    body = solved.body

    def residuals(x):
        return np.append(np.sqrt(body.price) * x, 100 * linear(clip, body, x[None], pins).gap)

    oracle = least_squares(residuals, np.zeros(len(body.price)), xtol=1e-12, ftol=1e-12)
    own = cost(body, solved.change, linear(clip, body, solved.change, pins).gap, 100.0).sum()
    assert own <= 2 * oracle.cost * (1 + 1e-3)


def test_frames_with_pins_meet_them_and_the_others_stay_to_the_last_bit():
    clip, pins = walk(), stone(walk(), 0.3)
    solved = reached(clip, pins)
    assert solved.worst[-1] < 0.001
    alone = ~pins.asked.any(axis=1)
    few = pins.only(slice(200, 300))
    solved = reached(clip, few)
    alone = np.ones(len(clip), bool)
    alone[200:300] = False
    np.testing.assert_allclose(solved.motion.rotations[alone], clip.rotations[alone], atol=1e-15)
    assert not solved.change[alone].any()
    assert bones(solved.motion) < 1e-12


@pytest.mark.parametrize(("fps", "least"), [(120.0, 5), (30.0, 3)])
def test_each_frame_by_itself_jolts(fps, least):
    clip = walk(fps)
    solved = reached(clip, stone(clip, 0.2))
    assert solved.worst[-1] < 0.001
    assert smoothness(solved.motion, clip) > least


def test_one_frame_of_a_hand_is_met_to_a_hundredth_of_a_millimetre():
    clip = walk()
    pins = hand_at(clip, [240]).only([240])
    assert reached(clip, pins, weight=1000).worst[-1] < 1e-5


def test_nothing_asked_changes_nothing():
    clip = walk()
    solved = reach(clip, pin(clip, "lfoot", [], [0, 0, 0]))
    assert np.array_equal(solved.motion.rotations, clip.rotations) and solved.worst == [0.0]


def test_what_is_missed_is_said():
    clip = walk()
    wrist, elbow = (clip.skeleton.index(name) for name in ("rwrist", "rradius"))
    at = joint_positions(clip)[240]
    pins = join_pins(
        pin(clip, wrist, [240], at[wrist] + [0, 0.1, 0]), pin(clip, elbow, [240], at[elbow] - [0, 0.1, 0])
    )
    with pytest.warns(MocapWarning, match=r"'walk_straight', frame 240: 'r\w+' is [\d.]+ mm off its pin"):
        reach(clip, pins)


def test_bad_input():
    clip, pins = walk(), plant_pins(walk())
    for call, words in (
        (lambda: reach(clip, pins, passes=0), "at least one pass, got 0"),
        (lambda: reach(clip, pins, weight=0.0), "weight of pins is above 0"),
        (lambda: reach(clip, pins, weight=np.inf), "weight of pins is above 0"),
        (lambda: reach(clip[:9], pins), "has 9 frames, its pins have 500"),
        (lambda: reach(clip, pins, Body((99,), (np.eye(3),), np.ones(6))), "turns joints that"),
    ):
        with pytest.raises(MocapError, match=words):
            call()
