"""A graph comes back from its file bit for bit, and whatever is not such a file is refused by name."""

import xml.etree.ElementTree as ET
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError
from mocap.graphs import storage
from mocap.graphs.graph_summary import summary
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.synthesis.random_walks import random_walk
from mocap.synthesis.walk_to_motion import to_motion
from tests.strategies import wave

MARK = {"walk": np.arange(90) < 60, "stroll": np.arange(90) > 40}
CLIPS = [replace(wave(90, name="a"), labels=MARK), wave(70, phase=1.0, name="b ü", seed=1)]
WHOLE = build(CLIPS, window=8, threshold=0.05)
GRAPH = prune(WHOLE)


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


@pytest.mark.parametrize("graph", [WHOLE, GRAPH], ids=["whole", "pruned"])
def test_it_comes_back_bit_for_bit(tmp_path, graph):
    storage.save(graph, tmp_path / "graph.npz")
    back = storage.load(tmp_path / "graph.npz", CLIPS[::-1])
    assert list(back.graph.nodes) == list(graph.graph.nodes)
    assert list(back.graph.edges(keys=True, data=True)) == list(graph.graph.edges(keys=True, data=True))
    types = [
        {k: type(v) for k, v in data.items()} for g in (back, graph) for *_, data in g.graph.edges(data=True)
    ]
    assert types[: len(types) // 2] == types[len(types) // 2 :]
    assert (back.clips, back.window) == (graph.clips, graph.window)
    again = tmp_path / "again.npz"
    storage.save(back, again)
    assert again.read_bytes() == (tmp_path / "graph.npz").read_bytes()


def test_the_same_seed_walks_the_same_way(saved):
    back = storage.load(saved, CLIPS)
    walks = [to_motion(graph, random_walk(graph, seconds=9, seed=3)) for graph in (GRAPH, back)]
    np.testing.assert_array_equal(walks[0].rotations, walks[1].rotations)


def test_a_file_tells_something_without_its_clips(saved):
    found = storage.read(saved)
    assert (found.fps, found.window, found.names, found.frames) == (30.0, 8, ("a", "b ü"), (90, 70))
    assert summary(found.graph, fps=found.fps) == summary(GRAPH.graph, fps=30.0)


def test_clips_that_changed_are_named(saved):
    a, b = CLIPS
    nudged = a.rotations.copy()
    nudged[7, 1] = np.roll(nudged[7, 1], 1)
    longer = Skeleton(a.skeleton.names, a.skeleton.parents, a.skeleton.offsets * 1.1)
    for other in (
        replace(a, rotations=nudged),
        replace(a, root_positions=a.root_positions + 1e-12),
        replace(a, fps=60.0),
        replace(a, labels={}),
        replace(a, labels={"walk": MARK["stroll"], "stroll": MARK["walk"]}),
        replace(a, skeleton=longer),
        replace(a[:89]),
    ):
        with pytest.raises(MocapError, match="built of another 'a' than this: 90 frames at 30 Hz then"):
            storage.load(saved, [other, b])
    with pytest.raises(MocapError, match="needs the clip 'b ü'; given are: a"):
        storage.load(saved, [a])
    same = replace(a, contacts={}, name="a")
    assert storage.load(saved, [same, b]).clips[0] is same


def test_what_is_no_graph_is_refused(tmp_path, saved):
    text, empty, array, other = (tmp_path / f"{name}.npz" for name in ("text", "empty", "array", "other"))
    text.write_text("HIERARCHY")
    empty.touch()
    with array.open("wb") as file:
        np.save(file, np.arange(3))
    np.savez(other, a=1)
    half = tmp_path / "half.npz"
    half.write_bytes(saved.read_bytes()[:-200])
    for path in (text, empty, array, other, half):
        with pytest.raises(FormatError, match="expected a motion graph saved by mocap, version 1, got"):
            storage.read(path)
    for path, words in ((tmp_path / "none.npz", "No such file"), (tmp_path, "Is a directory")):
        with pytest.raises(MocapError, match=words):
            storage.read(path)


def test_a_newer_version_and_another_format_are_named(saved):
    with pytest.raises(FormatError, match="version 2, which a newer mocap wrote"):
        storage.read(changed(saved, version=2, nodes=None))
    with pytest.raises(FormatError, match="npz of another kind"):
        storage.read(changed(saved, format="mocap motion"))


def test_nothing_is_unpickled(saved):
    with pytest.raises(FormatError, match="damaged"):
        storage.read(changed(saved, names=np.array([{}, []], object)))


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"nodes": None}, "one without nodes"),
        ({"nodes": np.zeros((3, 3), int)}, "'nodes' to fit"),
        ({"nodes": np.zeros((3, 2))}, "'nodes' to fit"),
        ({"costs": np.zeros(2)}, "'transforms' to fit"),
        ({"window": 0}, "window and rate"),
        ({"fps": np.inf}, "window and rate"),
        ({"names": ["a", "a"]}, "names of their own"),
        ({"names": ["a"]}, "'frames' to fit"),
    ],
)
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
    with pytest.raises(FormatError, match=r"damaged file|to fit"):
        storage.read(changed(saved, **{key: array}))


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


def test_a_failed_write_leaves_the_old_file(saved, monkeypatch):
    before = saved.read_bytes()

    def interrupted(*_args, **_kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "savez_compressed", interrupted)
    with pytest.raises(KeyboardInterrupt):
        storage.save(WHOLE, saved)
    assert saved.read_bytes() == before
    assert list(saved.parent.iterdir()) == [saved]


def test_only_its_own_suffix_is_written(tmp_path):
    with pytest.raises(MocapError, match=r"written as .npz, got"):
        storage.save(GRAPH, tmp_path / "graph.json")
    with pytest.raises(MocapError, match=r"written as .graphml, got"):
        storage.write_graphml(GRAPH, tmp_path / "graph.xml")
    with pytest.raises(MocapError, match="Cannot write"):
        storage.save(GRAPH, tmp_path / "nowhere" / "graph.npz")


def test_graphml_holds_every_node_and_edge(tmp_path):
    path = tmp_path / "graph.graphml"
    storage.write_graphml(GRAPH, path)
    back = nx.read_graphml(path, force_multigraph=True)
    assert len(back) == len(GRAPH.graph)
    assert back.number_of_edges() == GRAPH.graph.number_of_edges()
    for (a, leave), (b, enter), edge in GRAPH.graph.edges(data=True):
        told = back[f"{CLIPS[a].name}:{leave}"][f"{CLIPS[b].name}:{enter}"].values()
        match = next(e for e in told if e["kind"] == edge["kind"])
        assert match["frames"] == edge["frames"]
        if edge["kind"] == "transition":
            assert match["cost"] == edge["cost"]
            assert (match["angle"], match["x"], match["z"]) == edge["transform"]
    assert ET.parse(path).getroot().tag.endswith("graphml")
    odd = replace(GRAPH, clips=(replace(CLIPS[0], name="a\x01"), CLIPS[1]))
    with pytest.raises(MocapError, match="cannot hold the clip's name"):
        storage.write_graphml(odd, path)


def test_an_unlabelled_graph_without_transitions(tmp_path):
    graph = build([wave(30)], window=8, threshold=1e-9)
    storage.save(graph, tmp_path / "graph.npz")
    back = storage.load(tmp_path / "graph.npz", [wave(30)])
    assert list(back.graph.edges(data=True)) == list(graph.graph.edges(data=True))
