"""What plays on a page; what the player sends, unpacked again. What is seen is tested in tests/browser."""

import base64
import io
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from mocap.body.kinematics import joint_positions
from mocap.course.lab.showing import inspector
from mocap.plotting.bodies import bones
from mocap.plotting.picture import Picture
from mocap.widgets.embedding import Embedded
from mocap.widgets.filmed_scene import FilmedScene
from mocap.widgets.player import play
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
    still, same = Picture(b"PNG", Ship.alt)._repr_mimebundle_()
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
    character, places = unpacked(play(motion, places=[true]))
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
