"""Characters led by commands keep near paths."""

import numpy as np
import pytest

from mocap.body.ground_path import SHAPES, GroundPath, circle
from mocap.body.planar import PlanarTransform, on_ground
from mocap.errors import MocapError
from mocap.steering import Controller, pursue
from tests.bundled import walking
from tests.steering.test_judged_control import CHARACTERS


@pytest.mark.parametrize("path", [GroundPath([[3, 1], [3, 9]]), circle(2.5)], ids=["line", "circle"])
def test_it_is_led_along_a_path(path):
    led = pursue(Controller(walking()), path, speed=0.8)
    assert led.progress == 1 and led.off.mean() < 0.35
    line, track = on_ground(path.resampled(0.02).points), on_ground(led.motion.root_positions)
    np.testing.assert_allclose(led.off[30:], np.abs(track[30:, None] - line).min(axis=1), atol=0.3)
    assert np.abs(track[0] - line[0]) < 1e-9 and len(led.off) == len(led.motion)


def sweep(*case):
    return pytest.param(*case, marks=pytest.mark.sweep)


class Turned:
    """A character that is turned by 100° against where another one is."""

    def __init__(self, character):
        self.character, self.skeleton, self.fps = character, character.skeleton, character.fps
        self.place = PlanarTransform(np.radians(100), 3.0, -2.0)

    def step(self, heading, speed):
        pose = self.character.step(heading - np.radians(100), speed)
        turns = pose.rotations.copy()
        turns[0] = self.place.apply_orientations(turns[0])
        return pose._replace(root_position=self.place.apply_points(pose.root_position), rotations=turns)


@pytest.mark.parametrize("towards", [0.5, 2.0, -2.5])
def test_it_does_not_matter_which_way_a_path_and_a_character_start(towards):
    """Both start alike: else the turn at the start would count as if the character did not obey."""
    end = [8 * np.sin(towards), 8 * np.cos(towards)]
    ahead, aside, turned = (
        pursue(make(walking()), GroundPath([[0, 0], to]), speed=0.8).off
        for make, to in (
            (Controller, [0, 8]),
            (Controller, end),
            (lambda graph: Turned(Controller(graph)), end),
        )
    )
    np.testing.assert_allclose(aside[:240], ahead[:240], atol=1e-3)
    assert turned.max() < ahead.max() + 0.1  # its first command, 0, is 100° aside of its way


@pytest.mark.parametrize(("name", "off"), [("matching", 0.15), sweep("strides", 0.7), sweep("steps", 0.2)])
def test_every_character_is_led_along_every_shape(name, off):
    make = CHARACTERS[name]
    for shape in SHAPES.values():
        led = pursue(make(), shape(), speed=0.8)
        assert led.progress == 1 and led.off.mean() < off


def test_it_ends_where_the_time_is_over():
    led = pursue(Controller(walking()), GroundPath([[0, 0], [0, 20]]), speed=0.8, limit=0.3)
    assert led.progress < 0.6


@pytest.mark.parametrize("settings", [{"speed": 0.0}, {"ahead": -1.0}, {"limit": np.nan}])
def test_settings_that_make_no_sense_are_refused(settings):
    with pytest.raises(MocapError, match="are above 0"):
        pursue(Controller(walking()), circle(2.0), **settings)
