"""The inspector: which windows are looked at, what its page unpacks, and what a cell shows of it."""

import io
import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import to_hex
from PIL import Image

from mocap.body import GroundPath, Motion, PlanarTransform, Skeleton, joint_positions, resample
from mocap.course import lab
from mocap.course.lab.choices import EACH, LONGEST, margin_frames, of_clips, of_graph, of_walk
from mocap.course.lab.showing import STEP, TABS, Inspector, inspector, packed_clip, packed_skeleton
from mocap.datasets.samples import sample
from mocap.graphs import compile_graph, from_transitions
from mocap.matching import distance_grid
from mocap.matching.point_clouds import rms_distance
from mocap.steering.path_following import follow_path
from mocap.synthesis import random_walk, seams
from mocap.widgets.embedding import joined
from tests.bundled import bundled
from tests.course.lab.students import written
from tests.refusals import refusals, refused

WALKS = [resample(sample(f"walk_curve_{n}"), 30)[:120] for n in (1, 2)]


@pytest.fixture(scope="module")
def graph():
    return bundled("walk_circle", "walk_curve_1")


def test_of_two_clips_the_lowest_minimum_comes_first():
    choices = of_clips(WALKS, 10, None)
    grid = distance_grid(*WALKS, window=10)
    assert grid[choices.pick.i, choices.pick.j] == grid.min()
    assert list(choices.minima) == sorted(choices.minima, key=lambda place: grid[place])


def test_the_readers_functions_make_the_grid_and_its_minima_and_it_is_said():
    theirs = of_clips(WALKS, 10, None)
    assert theirs.by == "" and "The grid by" not in Inspector(theirs, ("windows",)).scene["key"]
    sums, inner = lab.mine(written("window_sums")), lab.mine(written("inner_minima"))
    ours = of_clips(WALKS, 10, None)
    assert sums.yours and inner.yours
    assert np.allclose(ours.grid, theirs.grid, atol=1e-6)
    assert ours.pick == theirs.pick and {*ours.minima} - {*theirs.minima} == set()
    said = Inspector(ours, ("windows",)).scene["key"]
    assert said.endswith(" The grid by window_sums, inner_minima: yours.")


def test_where_the_readers_function_fails_the_packages_makes_the_grid(capsys):
    lab.mine(written("window_sums")).adopted = lambda numbers, window: 1 / 0
    assert np.allclose(of_clips(WALKS, 10, None).grid, distance_grid(*WALKS, window=10), atol=1e-6)
    assert "window_sums: yours raised ZeroDivisionError" in capsys.readouterr().out
    assert of_clips(WALKS, 10, None).by == ""


def test_of_a_graph_the_cheapest_from_each_clip_to_each_clip_can_be_pointed_at(graph):
    choices = of_graph(graph)
    assert choices.costs[0] == min(cost for *_, cost in graph.graph.edges(data="cost") if cost)
    pairs = [(pick.first, pick.second) for pick in choices.transitions]
    assert max(map(pairs.count, pairs)) == EACH


def test_seams_of_a_walk_come_with_the_frames_that_the_walk_has_around_them(graph):
    walk = random_walk(graph, seconds=15, seed=3)
    found = seams(graph, walk)
    choices = of_walk(graph, walk)
    assert [pick.frame for pick in choices.seams] == [seam.frame for seam in found]
    assert choices.pick.seam == np.argmax([seam.cost for seam in found])
    for one, after in zip(choices.seams, choices.seams[1:], strict=False):
        assert one.frame + graph.window + one.margin_after <= after.frame
        assert after.margin_before <= min(margin_frames(30), after.frame - one.frame - graph.window)
    for seam, taken in enumerate(choices.seams):
        assert taken.seam == seam and choices.transitions[taken.number][:4] == taken[:4]


def test_a_walk_without_seams_has_nothing_to_inspect(graph):
    walk = random_walk(graph, seconds=8, seed=3)
    clip = [edge for edge in walk if graph.graph.edges[edge]["kind"] == "clip"][:1]
    refused("no transition", of_walk, graph, clip)


WALK = WALKS[0][:90]


def plants(motion):
    return packed_clip(motion, 0, np.ones(len(motion), bool))[0]["plants"]


def unpacked(motion, about, block):
    """Undo the packing, as the script does."""
    planes = np.frombuffer(block, np.uint8).reshape(4, about["channels"], about["frames"])
    changes = np.moveaxis(planes, 0, -1).copy().view("<i4")[..., 0].T.astype(np.int64)
    numbers = np.cumsum(np.cumsum(changes, axis=0), axis=0) * STEP
    x, z = about["origin"]
    roots, turns = numbers[:, :3] + [x, 0, z], numbers[:, 3:].reshape(len(motion), -1, 4)
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    return replace(motion, root_positions=roots, rotations=turns)


@pytest.mark.parametrize("far", [0.0, 1e5])
def test_a_clip_comes_back_to_a_tenth_of_a_millimetre(far):
    walk = PlanarTransform(2.0, far, -far).apply_motion(WALK)
    back = unpacked(walk, *packed_clip(walk, 0, np.ones(len(walk), bool)))
    assert np.abs(joint_positions(back) - joint_positions(walk)).max() < 1e-4


def test_flipped_signs_of_quaternions_are_smoothed():
    signs = np.where(np.arange(len(WALK)) % 2, 1.0, -1.0)[:, None, None]
    flipped = replace(WALK, rotations=WALK.rotations * signs)
    back = unpacked(flipped, *packed_clip(flipped, 0, np.ones(len(WALK), bool)))
    assert ((back.rotations[1:] * back.rotations[:-1]).sum(-1) > 0).all()


def test_frames_that_nobody_looks_at_take_no_room():
    needed = np.arange(len(WALK)) < 30
    back = unpacked(WALK, *packed_clip(WALK, 0, needed))
    assert np.abs(back.rotations[30:] - back.rotations[29]).max() == 0


def test_feet_without_marks_are_marked_and_a_body_without_legs_has_none():
    bare = replace(WALK, contacts={})
    assert set(plants(bare)) <= set("0246") and "2" in plants(bare)
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    still = Motion(dot, np.zeros((5, 3)), np.tile([1.0, 0, 0, 0], (5, 1, 1)), 30.0)
    assert plants(still) == "00000"
    assert packed_skeleton(dot)["feet"] == [] and packed_skeleton(dot)["head"] is None


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


def test_a_large_grid_is_sent_in_blocks_that_keep_its_minima():
    walk = resample(sample("walk_circle"), 30)
    grid = inspector(walk, window=10).scene["grid"]
    assert grid["every"] == 3 and grid["rows"] <= 600 and grid["rows"] * 3 >= len(walk) - 9


NOWHERE_TO_LOOK = (
    ((0, 111), "Windows start at frames 0 to 110 and 0 to 110, not 0 and 111."),
    ((-1, 0), "not -1 and 0"),
    ("here", "at=(i, j), not by 'here'"),
    (7, "at=(i, j), not by 7"),
    ((1, 2, 3), "at=(i, j)"),
    ((1.5, 2), "at=(i, j)"),
)
NOT_TO_BE_SHOWN = (
    ((), {}, "one or two clips, a graph"),
    ((1,), {}, "one or two clips, a graph"),
    ((*WALKS, WALKS[0]), {}, "one or two clips, a graph"),
    (WALKS, {"show": ["seam"]}, "shows windows, turn, weights, seam, or the first of these"),
    (WALKS, {"show": []}, "or the first of these"),
    (WALKS, {"show": None}, "or the first of these"),
    (WALKS, {"window": 0}, "window"),
    (WALKS, {"window": 999}, "window"),
    ((bundled("walk_circle", "walk_curve_1"),), {"at": (0, 0)}, "of their own: leave out at="),
)
LONG = resample(sample("walk_circle"), 200)

test_what_cannot_be_shown_gets_one_sentence = refusals(
    *((re.escape(said), of_clips, WALKS, 10, at) for at, said in NOWHERE_TO_LOOK),
    ("no transitions", of_graph, from_transitions(WALKS[:1], [], window=10)),
    *((re.escape(said), partial(inspector, *what, **more)) for what, more, said in NOT_TO_BE_SHOWN),
    (f"holds {LONGEST} frames of clips, not {2 * len(LONG)}", inspector, LONG),
)


def test_the_scripts_shades_are_those_of_the_pictures():
    (listed,) = re.findall(r"CIVIDIS = \[(.*?)\]", joined(*Inspector.scripts), re.DOTALL)
    stops = re.findall(r'"(.*?)"', listed)
    wanted = [to_hex(colormaps["cividis"](at)) for at in np.linspace(0, 1, len(stops))]
    for stop, exact in zip(stops, wanted, strict=True):
        apart = [int(stop[k : k + 2], 16) - int(exact[k : k + 2], 16) for k in (1, 3, 5)]
        assert np.abs(apart).max() <= 12, (stop, exact)


def test_the_distance_that_a_storyboard_tells_is_that_of_the_grid():
    distance = rms_distance(*of_clips(WALKS, 10, (56, 20)).pair)
    assert distance == pytest.approx(np.sqrt(distance_grid(*WALKS, window=10)[56, 20]))
