"""A graph comes back from its file bit for bit, no other file is one; a summary counts what a walk meets."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocap.body import Skeleton, resample
from mocap.body.planar import IDENTITY
from mocap.datasets.clip_origins import Origin
from mocap.datasets.samples import FRAMES_IN_0_1, sample
from mocap.errors import FormatError, MocapError, MocapWarning
from mocap.files import load_save
from mocap.graphs import build, from_transitions, prune, storage, summary
from mocap.graphs.graph_summary import write_graphml
from mocap.matching.transitions import Transition
from tests.refusals import refused
from tests.strategies import ends, wave

MARK = {"walk": np.arange(90) < 60, "stroll": np.arange(90) > 40}
CLIPS = [replace(wave(90, name="a"), labels=MARK), wave(70, phase=1.0, name="b ü", seed=1)]
WHOLE = build(CLIPS, window=8, threshold=0.05)
GRAPH = prune(WHOLE)
PLAIN = build([wave(30)], window=8, threshold=1e-9)


@pytest.fixture
def saved(tmp_path):
    storage.save(GRAPH, tmp_path / "graph.npz")
    return tmp_path / "graph.npz"


def changed(path, **arrays):
    """Write the file again with other arrays; None takes one out."""
    with np.load(path) as archive:
        new = {**archive, **arrays}
    np.savez(path, **{key: array for key, array in new.items() if array is not None})
    return path


@pytest.mark.parametrize("graph", [WHOLE, GRAPH, PLAIN], ids=["whole", "pruned", "no transitions, no labels"])
def test_it_comes_back_bit_for_bit(tmp_path, graph):
    storage.save(graph, tmp_path / "graph.npz")
    back = storage.load(tmp_path / "graph.npz", graph.clips[::-1])
    assert list(back.graph.nodes) == list(graph.graph.nodes)
    assert list(back.graph.edges(keys=True, data=True)) == list(graph.graph.edges(keys=True, data=True))
    types = [{k: type(v) for k, v in d.items()} for g in (back, graph) for *_, d in g.graph.edges(data=True)]
    assert types[: len(types) // 2] == types[len(types) // 2 :]
    assert (back.clips, back.window) == (graph.clips, graph.window)
    again = tmp_path / "again.npz"
    storage.save(back, again)
    assert again.read_bytes() == (tmp_path / "graph.npz").read_bytes()


def test_last_digits_do_not_matter_and_what_an_older_version_saved_opens(saved):
    same = [replace(clip, root_positions=clip.root_positions * (1 + 1e-12)) for clip in CLIPS]
    assert storage.load(saved, same).clips == tuple(same)
    older = changed(saved, version=np.array(1), fingerprints=np.array(["of all digits"] * 2))
    with pytest.warns(MocapWarning, match="cannot tell whether its clips have changed"):
        assert nx.utils.graphs_equal(storage.load(older, CLIPS).graph, GRAPH.graph)


def test_roles_are_those_with_which_the_graph_was_saved(tmp_path):
    bodies = [replace(clip.skeleton, roles={"head": "hand", "left tip": "side"}) for clip in CLIPS]
    clips = [replace(clip, skeleton=body) for clip, body in zip(CLIPS, bodies, strict=True)]
    graph = build(clips, window=8, threshold=0.05)
    storage.save(graph, tmp_path / "graph.npz")
    other = [replace(clip, skeleton=replace(clip.skeleton, roles={"neck": "elbow"})) for clip in CLIPS]
    for passed in (CLIPS, clips, other):
        assert storage.load(tmp_path / "graph.npz", passed).clips == graph.clips
    older = changed(tmp_path / "graph.npz", version=np.array(2), roles=None)
    assert storage.load(older, other).clips == tuple(other)


def test_a_file_tells_something_without_its_clips(saved):
    found = storage.read(saved)
    assert (found.fps, found.window, found.names, found.frames) == (30.0, 8, ["a", "b ü"], [90, 70])
    assert summary(found.graph, fps=found.fps) == summary(GRAPH.graph, fps=30.0)


def test_files_of_the_first_format_still_open(saved):
    assert storage.read(changed(saved, format=np.array("mocap motion graph"))).names == ["a", "b ü"]


def test_clips_that_changed_are_named(saved):
    a, b = CLIPS
    nudged = a.rotations.copy()
    nudged[7, 1] = np.roll(nudged[7, 1], 1)
    longer = Skeleton(a.skeleton.names, a.skeleton.parents, a.skeleton.offsets * 1.1)
    for other in (
        replace(a, rotations=nudged),
        replace(a, labels={}),
        replace(a, labels={"walk": MARK["stroll"], "stroll": MARK["walk"]}),
        replace(a, skeleton=longer),
        replace(a[:89]),
    ):
        named = r"built of another 'a': (90 frames then, 89 now|other poses, bones or units)"
        refused(named, storage.load, saved, [other, b])
    refused("needs the clip 'b ü'; given are: a", storage.load, saved, [a])
    same = replace(a, contacts={}, name="a")
    assert storage.load(saved, [same, b]).clips[0] is same


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_graph_of_the_clips_of_mocap_0_1_is_refused_by_that_name(tmp_path, fps):
    straight = resample(sample("walk_straight"), fps)
    graph = build([straight], window=8, threshold=1e-9)
    storage.save(graph, tmp_path / "graph.npz")
    assert storage.load(tmp_path / "graph.npz").clips[0].name == "walk_straight"
    frames = (FRAMES_IN_0_1["walk_straight"] - 1) * fps // 120 + 1
    nodes = np.array([[0, 0], [0, frames]])
    edges = np.array([[0, 1, 0, frames]])
    older = changed(tmp_path / "graph.npz", frames=np.array([frames]), nodes=nodes, edges=edges)
    words = "built of the clips of mocap 0.1, .* Build it anew, or load it with mocap 0.1"
    refused(words, storage.load, older)
    refused(words, storage.load, older, [straight])


MISFITS = [
    ({"nodes": None}, "one without nodes"),
    ({"nodes": np.zeros((3, 3), int)}, "'nodes' to fit"),
    ({"nodes": np.zeros((3, 2))}, "'nodes' to fit"),
    ({"costs": np.zeros(2)}, "'transforms' to fit"),
    ({"window": 0}, "the window is above 0"),
    ({"fps": np.inf}, "the rate is above 0"),
    ({"names": ["a", "a"]}, "names of their own"),
    ({"names": ["a"]}, "'frames' to fit"),
    ({"names": np.array([{}, []], object)}, "'names' to fit"),  # nothing is unpickled
    ({"version": 4, "nodes": None}, "version 4, which a newer mocap wrote"),
    ({"format": "mocap motion"}, "npz of another kind"),
    ({"origins": ["not JSON"]}, "origins are"),
    ({"origins": ["{}", "{}"]}, "origins are"),
    ({"roles": None}, "one without roles"),
    ({"roles": ["{}"]}, "'roles' to fit"),
    ({"roles": ["{}", '{"left toe": "hand"}']}, "roles are names of joints"),
    ({"roles": ["[", "{}"]}, "roles are names of joints"),
]


@pytest.mark.parametrize(("arrays", "words"), MISFITS)
def test_arrays_that_do_not_fit_are_named(saved, arrays, words):
    with pytest.raises(FormatError, match=words):
        storage.read(changed(saved, **{k: v if v is None else np.array(v) for k, v in arrays.items()}))


@pytest.mark.parametrize("key", ["nodes", "edges", "costs", "transforms", "is_transition"])
@pytest.mark.parametrize("wrong", [-1, 10**6, np.nan])
def test_numbers_that_cannot_be_are_refused(saved, key, wrong):
    with np.load(saved) as archive:
        array = archive[key]
    if array.dtype.kind == "b":
        array = ~array
    elif array.dtype.kind == "f" or not np.isnan(wrong):
        array.reshape(-1)[-1 if key != "edges" else 0] = wrong if key != "transforms" else np.nan
    else:
        array = np.concatenate([array, array])
    if key == "costs" and wrong == 10**6:
        array[-1] = np.inf
    refused(r"damaged file|to fit", storage.read, changed(saved, **{key: array}), kind=FormatError)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.integers(0, 10**6), st.integers(1, 255))
def test_a_flipped_byte_is_refused_or_does_no_harm(saved, place, flip):
    data = bytearray(saved.read_bytes())
    data[place % len(data)] ^= flip
    path = saved.with_name("flipped.npz")
    path.write_bytes(data)
    try:
        found = storage.read(path)
    except MocapError:
        return
    assert nx.utils.graphs_equal(found.graph, GRAPH.graph)


def test_clips_are_found_where_they_were_and_where_they_moved_together(tmp_path):
    clips = tmp_path / "project" / "clips"
    clips.mkdir(parents=True)
    load_save.save(wave(60, name="p"), clips / "p.bvh")
    graph = build([load_save.load(clips / "p.bvh", scale=0.0254)], window=8, threshold=0.13)
    file = tmp_path / "project" / "graph.npz"
    storage.save(graph, file, [Origin(clips / "p.bvh", scale=0.0254)])

    def found(place):
        return storage.load(place).clips[0]

    assert found(file).root_positions == pytest.approx(graph.clips[0].root_positions)  # in its own unit
    moved = (tmp_path / "project").rename(tmp_path / "moved")
    assert len(found(moved / "graph.npz")) == 60  # seen from the graph's folder
    alone = tmp_path / "elsewhere" / "graph.npz"
    alone.parent.mkdir()
    (moved / "graph.npz").rename(alone)
    moved.rename(tmp_path / "project")
    assert len(found(alone)) == 60  # seen from the root
    (clips / "p.bvh").unlink()
    refused("The clip 'p' is no longer where", storage.load, alone)


BARE = [replace(clip, labels={}) for clip in CLIPS]
WINDOW = 8


@given(ends)
def test_waits_are_those_of_a_walk_along_the_clip(rows):
    found = [Transition(*row, 0.01, IDENTITY) for row in rows]
    graph = from_transitions(BARE, found, window=WINDOW)
    waits = []
    for clip, motion in enumerate(BARE):
        leaves = [t.leave for t in found if t.source == clip]
        for frame in range(len(motion)):
            waits.append(min((leave - frame for leave in leaves if leave >= frame), default=np.inf))
    told = summary(graph.graph, fps=30.0)
    assert told.frames == len(waits) == 160
    assert told.mean_wait == pytest.approx(np.mean(waits) / 30)
    assert told.worst_wait == pytest.approx(np.max(waits) / 30)


def test_a_pruned_graph_is_told_in_a_few_lines():
    graph = prune(build(BARE, window=WINDOW, threshold=0.05))
    told = summary(graph.graph, fps=30.0)
    assert (told.nodes, told.edges) == (len(graph.graph), graph.graph.number_of_edges())
    played = sum(edge["frames"] for *_, edge in graph.graph.edges(data=True) if edge["kind"] == "clip")
    assert (told.transitions, told.frames) == (graph.count("transition"), played)
    assert told.seconds == pytest.approx(told.frames / 30)
    assert told.out_degree == pytest.approx(np.mean([degree for _, degree in graph.graph.out_degree()]))
    assert 0 < told.mean_wait < told.worst_wait < 3
    assert [line.split()[0] for line in told.table().splitlines()] == ["frames", "nodes", "edges", "turn-off"]
    whole = summary(build(BARE, window=WINDOW, threshold=0.05).graph, fps=30.0)
    assert whole.table().endswith("turn-off     none before the end of some clip")


def test_it_tells_which_labels_can_be_reached():
    clips = [
        replace(clip, labels={label: np.ones(len(clip), bool)})
        for clip, label in zip(BARE, ("walk", "run"), strict=True)
    ]
    walk, run = frozenset({"walk"}), frozenset({"run"})
    one_way = from_transitions(clips, [Transition(0, 82, 1, 20, 0.01, IDENTITY)], window=WINDOW)
    assert summary(one_way.graph, fps=30.0).reachable == {walk: {run}, run: set()}
    assert "walk         leads to run" in summary(one_way.graph, fps=30.0).table()
    assert "run          leads to nothing else" in summary(one_way.graph, fps=30.0).table()


def test_graphml_holds_every_node_and_edge(tmp_path):
    path = tmp_path / "graph.graphml"
    write_graphml(GRAPH, path)
    back = nx.read_graphml(path, force_multigraph=True)
    assert len(back) == len(GRAPH.graph)
    assert back.number_of_edges() == GRAPH.graph.number_of_edges()
    for (a, leave), (b, enter), edge in GRAPH.graph.edges(data=True):
        found = back[f"{GRAPH.clips[a].name}:{leave}"][f"{GRAPH.clips[b].name}:{enter}"].values()
        match = next(e for e in found if e["kind"] == edge["kind"])
        assert match["frames"] == edge["frames"]
        if edge["kind"] == "transition":
            assert match["cost"] == edge["cost"]
            assert (match["angle"], match["x"], match["z"]) == edge["transform"]
    assert ET.parse(path).getroot().tag.endswith("graphml")
    refused(r"written as .graphml, got", write_graphml, GRAPH, tmp_path / "graph.xml")
