"""Scenes of players drawn without a browser."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import mocap
from mocap import datasets
from mocap.body.kinematics import joint_positions
from mocap.plotting.style import COLOURS, SOURCES
from mocap.widgets import play
from mocap.widgets.filmed_scene import stored_scene
from mocap.widgets.shaded_picture import ShadedPicture

CLIP = mocap.resample(datasets.sample("walk_circle"), 30)[:90]
SIZE = (320, 200)


@pytest.fixture(scope="module")
def scene():
    return stored_scene(play(CLIP, sources=[(0, "a"), (45, "b")], seams=[45], path=[[0, 0], [0, 3]]).html())


def test_the_joints_are_those_of_the_motion_between_its_frames_and_after_its_end(scene):
    places = joint_positions(CLIP)[:, 0]
    for time, root in ((1.0, places[30]), (1.25, places[37:39].mean(axis=0)), (9.0, places[-1])):
        assert np.abs(scene.pose(0, time)[0] - root).max() < 1e-3
    assert scene.seconds == pytest.approx(89 / 30)


def test_what_is_no_player_has_no_scene():
    assert stored_scene("<img>") is None


def has(picture, colour):
    """Whether more than a few pixels have a colour, in light or in shade."""
    pixels = picture.reshape(-1, 3) / 255
    shades = pixels / np.maximum(pixels.max(axis=1, keepdims=True), 1e-6)
    wanted = np.array(to_rgb(colour)) / max(to_rgb(colour))
    return (np.abs(shades - wanted).max(axis=1) < 0.25).sum() > 8


def test_left_and_right_keep_their_colours_and_time_goes_round(scene):
    picture = scene.picture(1.0, SIZE)
    assert has(picture, COLOURS["left"]) and has(picture, COLOURS["right"])
    assert (picture != scene.picture(2.0, SIZE)).any()
    assert (picture == scene.picture(1.0 + scene.seconds, SIZE)).all()


def test_several_are_followed_near_or_far():
    far = replace(CLIP, root_positions=CLIP.root_positions + np.array([40.0, 0.0, 0.0]))
    for players in (play(CLIP, CLIP[:40], follow=False), play(CLIP, far)):
        assert has(stored_scene(players.html()).picture(2.9, SIZE), SOURCES[1])


@pytest.mark.parametrize("seed", range(6))
def test_rays_meet_the_nearest_of_the_balls_between_a_capsules_ends(seed):
    """Against four hundred balls; a capsule may be flat, blunt, seen from its end, or one ball in another."""
    rng = np.random.default_rng(seed)
    page = ShadedPicture((48, 36), np.array([0.0, 1.0, 0.0]), 2.0)
    a, b = (
        rng.normal(scale=0.3, size=(2, 3)) * (seed != 5)
        + [0, 1, 0]
        - [[0], [0.3 * (seed == 4)]] * page.axes[2]
    )
    ra, rb, flat = *rng.uniform(0.05, 0.3, 2), rng.uniform(0.6, 1.0)
    ahead = np.cross(b - a, rng.normal(size=3)) if seed != 5 else np.array([0.0, 0, 1])
    ahead /= np.linalg.norm(ahead)
    met = np.full((3, 72, 96), np.inf, np.float32)
    page._meet(np.array([*a, ra, *b, rb, *ahead, flat]), 0, met)
    right, up = page._rays((slice(0, 72), slice(0, 96)), 2)
    rays = np.stack(np.broadcast_arrays(right, up, 1), -1) @ page.axes
    metric = np.eye(3) + (flat**-2 - 1) * np.outer(ahead, ahead)
    nearest = np.full((72, 96), np.inf)
    for u in np.linspace(0, 1, 400):
        away, r = a + u * (b - a) - page.eye, ra + u * (rb - ra)
        dd, half = ((rays @ metric) * rays).sum(-1), rays @ metric @ away
        inside = half**2 - dd * (away @ metric @ away - r * r)
        nearest = np.minimum(nearest, np.where(inside > 0, (half - np.sqrt(np.abs(inside))) / dd, np.inf))
    both = np.isfinite(nearest) & np.isfinite(met[0])
    assert both.sum() > 100 and (np.isfinite(nearest) != np.isfinite(met[0])).sum() <= 6
    assert np.abs(nearest[both] - met[0][both]).max() < 2e-3
