"""The inspector in a notebook: its sentence, its picture, and a page that loads nothing."""

import io
import re

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import to_hex
from PIL import Image

from mocap.body.ground_path import GroundPath
from mocap.body.motion import resample
from mocap.course.lab.choices import LONGEST
from mocap.course.lab.showing import TABS, Inspector, inspector
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import compile_graph
from mocap.steering.path_following import follow_path
from mocap.widgets.embedding import joined
from tests.bundled import bundled

WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]


@pytest.fixture(scope="module")
def graph():
    return bundled("walk_circle", "walk_curve_1")


@pytest.mark.parametrize("depth", range(1, 5))
def test_each_depth_has_a_picture_a_sentence_and_a_page(depth):
    shown = inspector(*WALKS, at=(56, 20), show=TABS[:depth])
    bundle, metadata = shown._repr_mimebundle_()
    assert set(bundle) == {"text/html", "image/png", "text/plain"}
    assert metadata["image/png"]["alt"] == bundle["text/plain"] == shown.alt
    assert ("θ" in shown.alt) == (depth > 1)
    assert Image.open(io.BytesIO(shown.picture)).width > 900
    still, _ = shown.still()._repr_mimebundle_()
    assert still["image/png"] == bundle["image/png"] and "script" not in still["text/html"]
    assert shown.scene["tabs"] == list(TABS[:depth])
    without = re.sub(r"base64,[^\"]*", "", bundle["text/html"])
    assert not re.search(r"https?://(?!www\.w3\.org)", without)


def test_graphs_walks_and_paths_bring_their_maps(graph):
    found = follow_path(compile_graph(graph), GroundPath(np.array([[0.0, 0], [0, 3], [2, 5]])))
    for shown, maps in (
        (inspector(*WALKS), {"grid"}),
        (inspector(graph), {"graph"}),
        (inspector(found), {"graph", "walk"}),
    ):
        assert {name for name in ("grid", "graph", "walk") if shown.scene[name]} == maps
        assert shown.picture[1:4] == b"PNG"
    assert shown.scene["walk"]["asked"][-1] == [2.0, 5.0]


def test_one_clip_is_compared_with_itself():
    shown = inspector(WALKS[0], at=(10, 45))
    assert [clip["name"] for clip in shown.scene["clips"]] == ["walk_curve_1"] * 2


def test_a_large_grid_is_sent_in_blocks_that_keep_its_minima():
    walk = resample(sample("walk_circle"), 30)
    grid = inspector(walk, window=10).scene["grid"]
    assert grid["every"] == 2 and grid["rows"] <= 600 and grid["rows"] * 2 >= len(walk) - 9


@pytest.mark.parametrize(
    ("what", "more", "said"),
    [
        ((), {}, "one or two clips, a graph"),
        ((1,), {}, "one or two clips, a graph"),
        ((*WALKS, WALKS[0]), {}, "one or two clips, a graph"),
        (WALKS, {"show": ["seam"]}, "shows windows, turn, weights, seam, or the first of these"),
        (WALKS, {"show": []}, "or the first of these"),
        (WALKS, {"show": None}, "or the first of these"),
        (WALKS, {"window": 0}, "window"),
        (WALKS, {"window": 999}, "window"),
    ],
)
def test_what_cannot_be_shown_gets_one_sentence(what, more, said):
    with pytest.raises(MocapError) as refused:
        inspector(*what, **more)
    assert said in str(refused.value) and len(str(refused.value)) <= 200


def test_more_than_a_page_can_hold_is_refused_before_anything_is_measured():
    long = resample(sample("walk_circle"), 200)
    with pytest.raises(MocapError, match=f"holds {LONGEST} frames of clips, not {2 * len(long)}"):
        inspector(long)


def test_the_scripts_shades_are_those_of_the_pictures():
    stops = (
        re.search(r"CIVIDIS = \[(.*?)\]", joined(*Inspector.scripts)).group(1).replace('"', "").split(", ")
    )
    wanted = [to_hex(colormaps["cividis"](at)) for at in np.linspace(0, 1, len(stops))]
    for stop, exact in zip(stops, wanted, strict=True):
        apart = [int(stop[k : k + 2], 16) - int(exact[k : k + 2], 16) for k in (1, 3, 5)]
        assert np.abs(apart).max() <= 12, (stop, exact)
