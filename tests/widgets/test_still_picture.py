"""The picture of a player without scripts: who is in it, where, in which colour, and under which name."""

import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image, ImageDraw

import mocap
from mocap import datasets
from mocap.plotting.bodies import bodies_along
from mocap.plotting.style import SOURCES
from mocap.widgets import play
from mocap.widgets.filmed_scene import FilmedScene
from mocap.widgets.still_bodies import FORESHORTENED, bodies_in_rows
from tests.refusals import refused
from tests.strategies import wave

WALK = mocap.resample(datasets.sample("walk_straight"), 30)[:150]


def shifted(motion, x, z=0.0):
    """Move a motion over the ground."""
    return replace(motion, root_positions=np.add(motion.root_positions, [x, 0, z]))


def rows_of(*motions):
    return bodies_in_rows(FilmedScene(play(*motions).scene))


def pixels_of(player):
    return np.asarray(Image.open(io.BytesIO(player.picture)).convert("RGB"))


def hues_in(picture, colour):
    """Count pixels whose channels are in the proportions of a colour, in light or shade."""
    pixels = picture.reshape(-1, 3).astype(float)
    bright = pixels[(pixels.min(axis=1) < 160) & (pixels.max(axis=1) > 60)]
    wanted = np.array(to_rgb(colour))
    cosines = bright @ wanted / np.linalg.norm(bright, axis=1) / np.linalg.norm(wanted)
    return int((cosines > 0.99).sum())


@pytest.fixture
def written(monkeypatch):
    """Collect the texts that are written on pictures."""
    texts = []
    write = ImageDraw.ImageDraw.text

    def noted(pen, place, text, *rest, **options):
        texts.append(text)
        return write(pen, place, text, *rest, **options)

    monkeypatch.setattr(ImageDraw.ImageDraw, "text", noted)
    return texts


@pytest.mark.parametrize("beside", [0.0, 0.3])
def test_motions_at_the_same_positions_have_a_row_each(beside):
    rows = rows_of(WALK, shifted(WALK, beside))
    assert [{body.number for body in row} for row in rows] == [{0}, {1}]


def test_motions_apart_from_each_other_share_a_picture():
    (row,) = rows_of(WALK, shifted(WALK, 2.0), shifted(WALK, 4.0))
    assert {body.number for body in row} == {0, 1, 2}


def test_no_body_of_a_walk_hides_another():
    film = FilmedScene(play(WALK, shifted(WALK, 1.5)).scene)
    (row,) = bodies_in_rows(film)
    roots = np.array([film.pose(body.number, body.time)[0] for body in row])
    apart = (roots[:, None] - roots) * [FORESHORTENED, 1, 1]  # the walk is along z, seen from the side
    apart[..., 1] = 0
    distances = np.linalg.norm(apart, axis=-1) + 9 * np.eye(len(roots))
    assert distances.min() > 0.8


@pytest.mark.parametrize("count", [2, 5, 7])
def test_each_character_has_a_body(count):
    rows = rows_of(*(shifted(WALK[:40], 0.9 * k, 0.2 * k) for k in range(count)))
    assert {body.number for row in rows for body in row} == set(range(count))


def test_a_motion_that_stays_is_a_row_of_poses_over_its_whole_time():
    (row,) = rows_of(wave(31))
    assert row[0].time == 0 and row[-1].time == pytest.approx(1.0)
    steps = np.diff([body.moved for body in row], axis=0)
    assert np.linalg.norm(steps, axis=-1).min() > 0.7


@pytest.mark.parametrize("beside", [0.0, 2.0])
def test_two_motions_of_one_name_are_told_apart(written, beside):
    player = play(WALK, shifted(WALK, beside))
    picture = pixels_of(player)
    assert {"walk_straight (1)", "walk_straight (2)"} <= set(written)
    names = [character["name"] for character in player.scene["characters"]]
    assert names == ["walk_straight (1)", "walk_straight (2)"]
    assert all(hues_in(picture, colour) > 500 for colour in SOURCES[:2])


def test_names_of_ones_own_are_written(written):
    pixels_of(play(WALK, shifted(WALK, 2.0), names=["original", "copy"]))
    assert {"original", "copy"} <= set(written)


@pytest.mark.parametrize("names", ["ab", ["a"], ["a", "b", "c"]])
def test_there_is_one_name_for_each_motion(names):
    refused("names= is a list of 2 names", lambda: play(WALK, WALK, names=names))


@pytest.mark.parametrize("count", [2, 6, 9])
def test_a_legend_loses_no_figure_and_no_source(written, count):
    motions = [shifted(WALK[:40], 1.5 * k) for k in range(count)]
    pixels_of(play(*motions, sources=[(0, "walk_straight"), (20, "jog")], seams=[20], path=[(0, 0), (0, 3)]))
    names = {f"walk_straight ({number})" for number in range(1, count + 1)}
    assert names | {"walk_straight", "jog", "seam", "requested path"} <= set(written)


def test_no_other_character_has_the_colour_of_a_source():
    scene = play(WALK, shifted(WALK, 2), sources=[(0, "walk"), (9, "jog"), (20, "sneak")]).scene
    first, second = scene["characters"]
    assert second["colour"] not in {source["colour"] for source in first["sources"]}


def test_the_lines_of_bodies_along_have_all_names():
    figure = bodies_along(WALK, shifted(WALK, 2), sources=[(0, "walk_straight (2)"), (75, "jog")])
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert sorted(names) == ["jog", "walk_straight (2)", "walk_straight (2)"]


@pytest.mark.parametrize("frames", [1, 2])
def test_a_motion_of_a_frame_has_a_picture(frames):
    assert pixels_of(play(wave(frames))).shape[1] >= 640


def test_a_body_without_limbs_has_a_picture():
    body = mocap.Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], [0, 0.3, 0]])
    turns = np.tile([1.0, 0, 0, 0], (9, 2, 1))
    stick = mocap.Motion(body, np.zeros((9, 3)), turns, 30.0)
    assert np.ptp(pixels_of(play(stick)).astype(int)) > 100


def test_stills_are_small():
    for player in (play(WALK), play(*(shifted(WALK, 1.2 * k, 0.4 * k) for k in range(6)))):
        assert len(player.picture) < 100_000
