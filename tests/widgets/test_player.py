"""What plays on a page and in a film; what the player sends, unpacked again. What is seen: tests/browser."""

import base64
import io
import json
import re
import sys
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from PIL import Image

import mocap
from mocap import datasets
from mocap.body import joint_positions, place
from mocap.course.lab.showing import inspector
from mocap.errors import MocapError
from mocap.plotting import COLOURS, SOURCES, bones
from mocap.plotting.picture import Picture
from mocap.plotting.props import boxes_with
from mocap.widgets import film, play
from mocap.widgets.embedding import Embedded
from mocap.widgets.filmed_scene import FilmedScene, stored_scene
from mocap.widgets.shaded_picture import TWICE, ShadedPicture
from tests.refusals import refused
from tests.strategies import random_motion, seeds, wave

SCENE = {"name": "</script>", "data": b"waves"}
KINDS = {"player": play(wave(30)), "inspector": inspector(wave(60), at=(5, 30), window=6)}


class Ship(Embedded):
    alt, picture, scene, scripts = 'A <ship> & "sea".', b"PNG", SCENE, ()


@pytest.mark.parametrize("kind", KINDS)
def test_the_scripts_of_each_kind_start_its_class_and_need_no_network(kind):
    page = KINDS[kind].page()
    assert not re.search(r"""(src|href)=["'](?!data:)|https?://|@import|fetch\(|import\(""", page)
    assert f'<div class="mocap-{kind}">' in page
    assert f"class {kind.title()} " in page and f"start({kind.title()});" in page
    assert page.count("function start(") == 1


def test_a_page_holds_the_scene_the_picture_and_the_sentence():
    page, alt = Ship().page(), "A &lt;ship&gt; &amp; &quot;sea&quot;."
    scene = json.loads(re.search(r'<script type="application/json">(.*?)</script>', page)[1])
    assert scene == SCENE | {"data": "d2F2ZXM="}
    assert f"<title>{alt}</title>" in page and "<h1>" not in page
    assert f'<div class="mocap-ship"><img alt="{alt}" src="data:image/png;base64,UE5H">' in page
    assert repr(Ship()) == f"Ship({Ship.alt!r})"
    bundle, metadata = Ship()._repr_mimebundle_()
    still, same = Picture(b"PNG", Ship.alt, fitted=False)._repr_mimebundle_()
    assert bundle == still | {"text/html": Ship().html()} and metadata == same


def unpacked(player, number=0):
    """Give a character of a scene, and where its joints are, shape (F, J, 3)."""
    return player.scene["characters"][number], FilmedScene(player.scene).clouds[number]


@given(seeds, st.floats(-1e4, 1e4))
def test_places_are_sent_to_a_65535th_of_the_clip(seed, away):
    motion = random_motion(seed, frames=7, joints=9)
    motion = replace(motion, root_positions=motion.root_positions + np.array([away, 0, 0]))
    true = joint_positions(motion) + np.array(
        [0, seed % 2, 0]
    )  # where a function of the reader's puts the joints
    character, places = unpacked(play(motion, positions=[true]))
    starts, ends, _ = bones(motion.skeleton)
    for (a, b, _), start, end in zip(character["bones"], starts, ends, strict=True):
        assert places[:, a] == pytest.approx(true[:, start], abs=0.51 * max(character["step"]))
        assert places[:, b] == pytest.approx(true[:, end], abs=0.51 * max(character["step"]))
    assert places[:, 0] == pytest.approx(true[:, 0], abs=0.51 * max(character["step"]))


def test_of_a_fast_clip_every_second_frame_is_sent_and_all_are_counted():
    fast = replace(wave(241), fps=120.0)
    player = play(fast)
    character, places = unpacked(player)
    assert (character["fps"], character["frames"]) == (60.0, 121)
    assert (player.scene["fps"], player.scene["frames"]) == (120.0, 241)
    assert places[:, 0] == pytest.approx(joint_positions(fast)[::2, 0], abs=1e-4)


def test_several_characters_share_the_numbers():
    first, second = wave(30, name="a"), wave(50, phase=1, name="b")
    player = play(first, second)
    for number, motion in enumerate((first, second)):
        character, places = unpacked(player, number)
        assert character["name"] == motion.name
        assert places[:, 0] == pytest.approx(joint_positions(motion)[:, 0], abs=1e-4)
    assert player.scene["frames"] == 50
    assert len({c["colour"] for c in player.scene["characters"]}) == 2


def test_sources_and_prints_are_in_seconds():
    scene = play(wave(80), sources=[(0, "walk"), (30, "turn"), (60, "walk")]).scene
    sources = scene["characters"][0]["sources"]
    assert [(s["start"], s["name"]) for s in sources] == [(0, "walk"), (1, "turn"), (2, "walk")]
    assert sources[0]["colour"] == sources[2]["colour"] != sources[1]["colour"]
    assert all(0 <= start < end <= 80 / 30 for start, end, *_ in scene["characters"][0]["prints"])


def test_a_sentence_of_ones_own_is_the_players_and_changes_no_number():
    said, unsaid = play(wave(30), alt='Who <waves> & "moves"?').scene, KINDS["player"].scene
    assert said == unsaid | {"alt": 'Who <waves> & "moves"?'}


def test_page_picture_and_sentence_are_one_bundle():
    player = play(wave(30))
    data, metadata = player._repr_mimebundle_()
    assert list(data) == ["text/html", "image/png", "text/plain"]
    assert data["text/plain"] == "A figure plays wave, 1.0 s." == metadata["image/png"]["alt"]
    strip = Image.open(io.BytesIO(base64.b64decode(data["image/png"])))
    assert strip.width > 3 * strip.height
    assert play(wave(30))._repr_mimebundle_()[0] == data  # the same each time


def test_there_must_be_a_motion():
    refused("no motion to play", play)


def test_a_film_has_one_frame_per_time_step(tmp_path):
    motion = wave(16)  # half a second
    path = film.save_animation(motion, tmp_path / "wave.gif", fps=20)
    with Image.open(path) as gif:
        assert gif.n_frames == 11
        assert gif.info["duration"] == 50
        first = np.asarray(gif.convert("RGB"))
        gif.seek(5)
        assert np.any(np.asarray(gif.convert("RGB")) != first)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_nothing_is_written_and_no_figure_left_when_drawing_is_interrupted(tmp_path, ending):
    if ending == "mp4":
        pytest.importorskip("imageio_ffmpeg", reason="pip install '.[video]'")

    def interrupted(items):
        yield items[0]
        raise KeyboardInterrupt

    plt.close("all")
    with pytest.raises(KeyboardInterrupt):
        film.save_animation(wave(30), tmp_path / f"wave.{ending}", progress=interrupted)
    assert list(tmp_path.iterdir()) == []
    assert plt.get_fignums() == []


def test_a_film_is_read_back_as_mp4(tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="pip install '.[video]'")
    path = film.save_animation(wave(16), tmp_path / "wave.mp4", fps=20)
    frames, seconds = ffmpeg.count_frames_and_secs(str(path))
    assert frames == 11
    assert seconds == pytest.approx(11 / 20, abs=0.06)


def test_without_imageio_ffmpeg_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    refused(r'pip install "\.\[video\]"', film.save_animation, wave(9), tmp_path / "wave.mp4")
    assert list(tmp_path.iterdir()) == []


def test_a_strip_and_a_page_are_the_players(tmp_path):
    motion, discs = wave(30), [[0, 1.23456, 0.5]]
    strip = film.save_animation(motion, tmp_path / "wave.png", discs=discs)
    page = film.save_animation(motion, tmp_path / "wave.HTML", discs=discs)
    player = play(motion, discs=discs)
    assert player.scene["obstacles"] == [[0, 1.235, 0.5]]
    assert strip.read_bytes() == player.picture
    assert page.read_text("utf-8") == player.page()


def test_another_ending_and_nobody_are_refused(tmp_path):
    with pytest.raises(MocapError, match=r"written as \.gif, \.mp4, \.png or \.html, got"):
        film.save_animation(wave(9), tmp_path / "wave.mov")
    refused("There is no motion to show", film.save_animation, [], tmp_path / "none.gif")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("reads", [True, False])
def test_what_ffmpeg_complains_of_is_the_error_and_the_old_film_stays(tmp_path, monkeypatch, reads):
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="pip install '.[video]'")
    fake = tmp_path / "ffmpeg"
    rest = "cat > /dev/null\n" if reads else ""
    fake.write_text(
        f"#!/bin/sh\n{rest}echo '[out#0/mp4 @ 0x5f] av_write: No space left on device' >&2\nexit 1\n"
    )
    fake.chmod(0o755)
    monkeypatch.setattr(ffmpeg, "get_ffmpeg_exe", lambda: str(fake))
    old = tmp_path / "wave.mp4"
    old.write_bytes(b"an old film")
    refused("cannot write the film: av_write: No space left on device", film.save_animation, wave(9), old)
    assert old.read_bytes() == b"an old film"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ffmpeg", "wave.mp4"]


def test_several_characters_are_in_one_film_until_the_last_has_come_to_its_end(tmp_path):
    far = place(wave(31), 0.0, [3.0, 0.0])
    path = film.save_animation([wave(16), far], tmp_path / "two.gif", fps=20)
    with Image.open(path) as gif:
        assert gif.n_frames == 21
        gif.seek(20)
        colours = {tuple(pixel) for pixel in np.asarray(gif.convert("RGB")).reshape(-1, 3)}
    for colour in SOURCES[:2]:
        wanted = np.round(255 * np.array(to_rgb(colour)))
        assert min(np.abs(wanted - pixel).max() for pixel in colours) < 60


@pytest.mark.parametrize(
    ("disc", "grey"),
    [((0.0, 0.5, 0.8), (0.02, 0.3)), ((2.6, 3.1, 1.5), (0, 0.001))],
    ids=["in sight", "around the camera"],
)
def test_obstacles_lie_on_the_ground(disc, grey):
    """What is beside and behind the camera must not fill the picture."""
    picture = FilmedScene(play(wave(9), discs=[disc]).scene).picture(0.0, (500, 500)).astype(int)
    share = (np.abs(picture - 0x99) < 3).all(axis=-1).mean()
    assert grey[0] <= share <= grey[1]


def test_a_box_shows_its_top_brighter_than_its_sides():
    scene = FilmedScene(play(wave(9), boxes=[[0.4, 0, -0.4, 1.2, 0.5, 0.4]]).scene)
    empty = FilmedScene(play(wave(9)).scene)
    page, plain_page = (ShadedPicture((500, 500), np.zeros(3), 5.0) for _ in range(2))
    scene.draw_props(page)
    empty.draw_props(plain_page)
    top, side = (page.pixels([place])[0][0] * TWICE for place in ([0.8, 0.5, 0.0], [0.8, 0.25, 0.4]))
    on_top, on_side = (page.paper.getpixel((round(across), round(down))) for across, down in (top, side))
    assert min(np.subtract(on_top, on_side)) > 20
    assert plain_page.paper.getpixel(tuple(np.round(top).astype(int).tolist())) != on_top


def test_a_box_hides_the_bodies_behind_it_and_no_others():
    def drawn(*boxes):
        scene = FilmedScene(play(wave(9), wave(9), boxes=boxes, yaw=0.0).scene)
        picture = scene.picture(0.0, (300, 300)).astype(int)
        return (np.ptp(picture, axis=-1) > 40).sum()  # pixels in the colours of the bodies

    whole = drawn()
    assert whole > 400
    assert drawn([-2, 0, 0.6, 2, 3, 0.7]) < 0.1 * whole  # between the camera and the body
    assert drawn([-2, 0, -0.7, 2, 3, -0.6]) > 0.9 * whole


def test_bodies_beside_each_other_have_a_box_each():
    corners = boxes_with([[0, 0, 0, 1, 1, 1]], [[0, 0, 0], [3, 0, 0]])
    assert corners[:, :, 0].tolist() == [[0, 1], [3, 4]]
    assert len(boxes_with([], [[0, 0, 0]])) == 0


def test_boxes_of_other_shapes_are_refused():
    refused("A box has six numbers, x, y, z of two corners, got shape", play, wave(9), boxes=[[0, 0, 1]])
    refused("begins at its lowest corner, got", play, wave(9), boxes=[[0, 0, 0, 1, -1, 1]])


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
