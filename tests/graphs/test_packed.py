"""A packed graph carries its clips without their paths; damaged ones are refused, moved clips found."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mocap.body import resample
from mocap.datasets.clip_origins import Origin
from mocap.datasets.packed_clips import as_packed, packing_error
from mocap.datasets.samples import sample
from mocap.editing import mirror
from mocap.errors import FormatError
from mocap.graphs import build, prune, storage
from mocap.synthesis import random_walk, to_motion
from tests.refusals import refused
from tests.strategies import wave

CLIPS = [
    replace(wave(90, name="a"), labels={"walk": np.arange(90) < 60}),
    wave(70, phase=1.0, name="b", seed=1),
]
GRAPH = prune(build(CLIPS, window=8, threshold=0.05))


@pytest.fixture
def packed(tmp_path):
    origins = [Origin(Path("/home/someone/a.bvh"), licence="CC0"), Origin(Path("/home/someone/b.bvh"))]
    storage.save(GRAPH, tmp_path / "graph.npz", origins, pack=True)
    return tmp_path / "graph.npz"


def test_a_packed_graph_needs_no_clips_and_walks_almost_the_same(packed):
    back = storage.load(packed)
    assert list(back.graph.edges(keys=True, data=True)) == list(GRAPH.graph.edges(keys=True, data=True))
    walk = random_walk(GRAPH, seconds=5, seed=1)
    assert packing_error([to_motion(GRAPH, walk)], [to_motion(back, walk)]) < 2e-4
    assert [sorted(clip.labels) for clip in back.clips] == [["walk"], []]
    assert packing_error(GRAPH.clips, back.clips) == packing_error(GRAPH.clips, as_packed(GRAPH.clips)) < 1e-4


def test_it_stores_licences_and_no_paths(packed):
    with np.load(packed) as archive:
        assert not any("someone" in text for text in archive["origins"].tolist())
    assert storage.licences_in(packed) == {"a": "CC0", "b": ""}
    assert storage.find_origins(packed) == []


def test_packing_again_moves_joints_by_no_more(packed, tmp_path):
    again = tmp_path / "again.npz"
    first = storage.load(packed)
    storage.save(first, again, pack=True)
    assert packing_error(first.clips, storage.load(again).clips) < 1e-4


def test_clips_are_not_given_to_a_graph_that_carries_them(packed):
    refused("graph.npz carries its clips", storage.load, packed, CLIPS)


@pytest.mark.parametrize(
    ("key", "change"),
    [
        ("quaternions", lambda array: array * 0),
        ("roots", lambda array: array * np.float32(np.inf)),
        ("roots", lambda array: array[:-1]),
        ("parents", lambda array: array + 1),
        ("contact_names", lambda array: np.array(["tail"])),
        ("offsets", lambda array: array * np.nan),
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_damaged_file_is_refused(packed, key, change):
    with np.load(packed) as archive:
        new = {**archive}
    new[key] = change(new[key])
    if key == "contact_names":
        new["clip_contacts"] = np.zeros((len(new["roots"]), 1), bool)
    np.savez(packed, **new)
    with pytest.raises(FormatError):
        storage.load(packed)


def test_moved_and_renamed_clips_and_their_mirror_images_are_found_by_their_content(tmp_path):
    clip = resample(sample("walk_curve_1"), 30)[:200]
    clips = [replace(clip, name="one", labels={}), mirror(replace(clip, name="one", labels={}))]
    graph = prune(build(clips, window=10, threshold=0.06))
    origins = [Origin(Path("one.bvh")), Origin(Path("one.bvh"), mirrored=True)]
    storage.save(graph, tmp_path / "graph.npz", origins)
    moved = [replace(clip, name="renamed", labels={}), replace(clip[:150], name="other", labels={})]
    assert storage.load(tmp_path / "graph.npz", moved).clips == graph.clips
    refused("needs the clip 'one'; given are: other", storage.load, tmp_path / "graph.npz", moved[1:])
