"""Stored players read and drawn."""

from dataclasses import replace

import numpy as np
import pytest

import mocap
from mocap import datasets
from mocap.body.kinematics import joint_positions
from mocap.course.teaching.moving_figures import stored_figures
from mocap.widgets import play

CLIP = mocap.resample(datasets.sample("walk_circle"), 30)[:90]


@pytest.fixture(scope="module")
def figures():
    return stored_figures(play(CLIP, sources=[(0, "a"), (45, "b")], seams=[45], path=[[0, 0], [0, 3]]).html())


def test_the_joints_are_those_of_the_motion(figures):
    (cloud,) = figures.points
    assert cloud.shape[0] == 90
    assert np.abs(cloud[:, 0] - joint_positions(CLIP)[:, 0]).max() < 1e-3
    assert figures.seconds == pytest.approx(89 / 30)


def test_what_is_no_player_has_no_figures():
    assert stored_figures("<img>") is None


def shades(picture):
    return {tuple(colour) for _, colour in picture.getcolors(1 << 20)}


def test_left_and_right_keep_their_colours_and_time_goes_round(figures):
    picture = figures.picture(1.0, (320, 200))
    assert {(0, 114, 178), (213, 94, 0)} <= shades(picture)
    assert picture.tobytes() != figures.picture(2.0, (320, 200)).tobytes()
    assert picture.tobytes() == figures.picture(1.0 + figures.seconds, (320, 200)).tobytes()


def test_several_are_followed_near_or_far():
    far = replace(CLIP, root_positions=CLIP.root_positions + np.array([40.0, 0.0, 0.0]))
    for page in (play(CLIP, CLIP[:40], follow=False), play(CLIP, far)):
        assert (0, 114, 178) in shades(stored_figures(page.html()).picture(2.9, (320, 200)))
