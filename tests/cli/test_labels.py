"""Labels from a table reach a graph, its walks, and the tables made of them."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import resample
from mocap.datasets import sample
from mocap.files import load_save
from mocap.files.label_tables import LabelRow, label_clips, load_labels, save_labels
from mocap.graphs import storage

ROWS = [LabelRow("a", "", "", "left step"), LabelRow("b", "10", "1.5s", "hop")]


def test_labels_of_a_table_are_those_of_the_graph_and_its_walks(clips, run):
    save_labels(clips / "labels.csv", ROWS)
    run("graph a.bvh b.bvh --threshold 5 --fps 20 --labels labels.csv -o g.npz")
    graph = storage.load(clips / "g.npz")
    wanted = label_clips([load_save.load(clips / f"{name}.bvh") for name in "ab"], ROWS)
    for clip, source in zip(graph.clips, wanted, strict=True):
        assert sorted(clip.labels) == sorted(source.labels)
    assert any("hop" in edge["labels"] for *_, edge in graph.graph.edges(data=True))
    run("walk g.npz --random 4s -o w.npz")
    assert "left step" in load_save.load(clips / "w.npz").labels


@pytest.fixture
def people(clips):
    """Two short walks of a body with left and right limbs, in place of the clips without."""
    for name, start in (("a", 0), ("b", 200)):
        walk = resample(sample("walk_curve_1"), 30)[start : start + 60]
        load_save.save(replace(walk, labels={}, contacts={}), clips / f"{name}.bvh")
    return clips


def test_labels_stay_if_the_clips_are_given_again_and_change_sides_in_the_mirror(people, run):
    clips = people
    save_labels(clips / "labels.csv", ROWS)
    run("graph a.bvh b.bvh --mirror --threshold 5 --fps 20 --labels labels.csv -o g.npz")
    for line in ("walk g.npz --random 2s -o w.npz", "walk g.npz --random 2s --clips a.bvh b.bvh -o x.npz"):
        run(line)
    motions = [load_save.load(clips / name) for name in ("w.npz", "x.npz")]
    for label in motions[0].labels:
        assert np.array_equal(motions[0].labels[label], motions[1].labels[label])
    graph = storage.load(clips / "g.npz")
    assert {label for clip in graph.clips for label in clip.labels} == {"left step", "right step", "hop"}


def test_a_walk_in_an_archive_gives_its_labels_back(clips, run):
    save_labels(clips / "labels.csv", ROWS)
    run("graph a.bvh b.bvh --threshold 5 --fps 20 --labels labels.csv -o g.npz")
    run("walk g.npz --random 4s -o w.npz")
    run("label w.npz -o back.csv")
    motion = replace(load_save.load(clips / "w.npz"), name="w")
    again = label_clips([motion], load_labels(clips / "back.csv"))[0]
    for label, mark in motion.labels.items():
        assert (again.labels.get(label, False) == mark).all()


def test_corrections_are_not_overwritten(clips, run):
    (clips / "labels.csv").write_text("mine")
    assert "labels.csv exists, and may contain corrections" in run("label a.bvh", 2).err
    assert (clips / "labels.csv").read_text() == "mine"


def test_a_licence_is_recorded_once_for_all_clips_or_by_a_table(clips, run):
    (clips / "terms.csv").write_text("clip,licence\nb,CC BY-NC 4.0\n")
    told = run("graph a.bvh b.bvh --threshold 5 --fps 20 --licence terms.csv -o g.npz").out
    assert "unknown for 1 of 2 clips; --licence records it" in told
    assert [origin.licence for origin in storage.find_origins(clips / "g.npz")] == ["", "CC BY-NC 4.0"]
    told = run("graph a.bvh b.bvh --threshold 5 --fps 20 --licence CC0 -o h.npz").out
    assert "licence" not in told
    assert {origin.licence for origin in storage.find_origins(clips / "h.npz")} == {"CC0"}
