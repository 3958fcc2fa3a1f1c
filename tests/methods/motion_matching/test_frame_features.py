"""Features belong to the body: they do not change where a clip was captured, and which way it faces."""

import numpy as np
import pytest

from mocap.body.planar import heading, place
from mocap.errors import MocapError
from mocap.methods.motion_matching.frame_features import AHEAD, GROUPS, body_track, features
from tests.methods.motion_matching.matched import clips
from tests.strategies import wave


def test_they_are_the_same_wherever_a_clip_is_placed():
    (clip,) = clips("walk_curve_1")
    moved = place(clip, 2.5, [100.0, -30.0])
    np.testing.assert_allclose(features(moved), features(clip), atol=1e-9)


def test_they_say_where_the_body_will_be():
    """Placed by the track, the places ahead are the track itself some frames later."""
    (clip,) = clips("walk_circle")
    (ground, facing), values = body_track(clip), features(clip)
    ahead = values[:, GROUPS["places ahead"]].reshape(-1, 3, 2) @ [1j, 1]
    frames = np.arange(len(clip) - 30)
    for number, later in enumerate(np.round(AHEAD * 30).astype(int)):
        there = ground[frames] + np.exp(1j * facing[frames]) * ahead[frames, number]
        np.testing.assert_allclose(there, ground[frames + later], atol=1e-9)


def test_the_smoothed_track_does_not_sway():
    """Walking straight, the pelvis turns to and fro by 8 degrees; the track by half of it."""
    (clip,) = clips("walk_straight")
    swings = [np.ptp(track[30:200]) for track in (heading(clip.rotations[:, 0]), body_track(clip)[1])]
    assert swings[1] < 0.6 * swings[0]


def test_feet_on_the_left_are_left():
    (clip,) = clips("walk_straight")
    feet = features(clip)[:, GROUPS["feet"]]
    assert feet[:, 0].mean() > 0.03 > -0.03 > feet[:, 3].mean()


def test_a_body_without_legs_is_refused():
    with pytest.raises(MocapError, match="No legs found"):
        features(wave(40))
