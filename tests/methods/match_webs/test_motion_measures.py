import numpy as np
import pytest
from walking import generate_walk

from mocap.body import PlanarTransform, Skeleton, arcs, rotations
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.methods.match_webs import hand_target, mean_speed, turn


def walk(degrees, speed=1.2):
    return generate_walk(arcs((0, 0), 0, [(5, np.radians(degrees))]).points, speed=speed)


@pytest.mark.parametrize("degrees", [-240, -60, 0, 90, 300])
def test_a_turn_counts_past_half_a_circle_and_to_the_left(degrees):
    assert np.degrees(turn(walk(degrees))) == pytest.approx(degrees, abs=15)


@pytest.mark.parametrize("speed", [0.7, 1.4])
def test_the_speed_is_that_of_the_path(speed):
    assert mean_speed(walk(90, speed)) == pytest.approx(speed, rel=0.05)


def test_one_frame_has_no_speed_and_no_turn():
    frame = walk(0)[:1]
    assert mean_speed(frame) == turn(frame) == 0


def test_measures_do_not_depend_on_where_a_clip_was_captured():
    here = walk(70)
    there = PlanarTransform(2.0, 50.0, -9.0).apply_motion(here)
    for measure in (turn, mean_speed, hand_target):
        assert np.allclose(measure(here), measure(there), atol=1e-9)


def test_the_hand_is_measured_where_the_arm_is_longest():
    arm = Skeleton(["root", "s", "e", "h"], [-1, 0, 1, 2], [[0, 0, 0], [0, 1, 0], [0, 0, 0.3], [0, 0, 0.3]])
    bend = np.tile(rotations.IDENTITY, (3, 4, 1))
    bend[[0, 2], 2] = rotations.about_y(1.0)
    bend[:, 0] = rotations.about_y(0.7)
    punch = Motion(arm, [[5, 0.2, 5]] * 3, bend, 30.0)
    assert hand_target(punch, "h", "s") == pytest.approx([0, 1.2, 0.6])
    with pytest.raises(MocapError, match="rhand"):
        hand_target(punch)
