"""`mocap bend` and `mocap walk --bend`, as a person types them."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mocap.body.motion import resample
from mocap.cli.main import main
from mocap.datasets.samples import sample
from mocap.files import load_save
from mocap.files.path_files import load_path
from mocap.graphs import storage
from tests.bundled import bundled
from tests.cli.refused import contents
from tests.strategies import wave

WALK = resample(sample("walk_straight"), 30)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("bends")
    load_save.save(WALK, place / "walk.bvh")
    load_save.save(WALK[:9], place / "stands.bvh")
    load_save.save(wave(60), place / "arm.bvh")
    (place / "line.csv").write_text("0,0\n0,3\n3,3\n3,9\n")
    (place / "line.svg").write_text('<svg><path d="M0 0 C 0 -200 200 -200 200 -400"/></svg>')
    (place / "bad.csv").write_text("0,0\n0,oops\n")
    storage.save(bundled("walk_circle", "walk_curve_1"), place / "graph.npz")
    return place


def off(motion, line):
    return cKDTree(line.resampled(0.01).points).query(motion.root_positions[:, [0, 2]])[0]


@pytest.mark.parametrize(
    ("line", "suffix"), [("line.csv", ".bvh"), ("line.svg", ".bvh"), ("line.svg", ".glb")]
)
def test_a_walk_is_laid_on_a_line(folder, capsys, monkeypatch, line, suffix):
    monkeypatch.chdir(folder)
    assert main(["bend", "walk.bvh", "--along", line, "-o", f"new{suffix}"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("bent         ")
    assert "cm off on average" in said
    assert ("rounded at" in said) == (line == "line.csv")
    assert said.endswith(f"wrote        new{suffix}\n")
    if suffix == ".bvh":
        made = load_save.load(folder / "new.bvh")
        assert np.median(off(made, load_path(folder / line))) < 0.03


def test_the_limit_and_the_unit_count(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    words = ["bend", "walk.bvh", "--along", "line.csv", "-o", "new.bvh"]
    assert main([*words, "--limit", "30"]) == 0
    assert "turned by up to 31° per second" in capsys.readouterr().out
    assert main([*words, "--unit", "2"]) == 0
    assert "of 24.0 m" in capsys.readouterr().out


def test_a_walk_from_a_graph_is_laid_on_a_line(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    words = ["walk", "graph.npz", "--path", "line.svg", "-o", "graph.bvh"]
    assert main([*words, "--bend"]) == 0
    assert "turned by up to" in capsys.readouterr().out
    made = load_save.load(folder / "graph.bvh")
    assert off(made, load_path(folder / "line.svg")).max() < 0.08
    assert main([*words, "--bend", "20", "--label", "0:walk"]) == 0
    assert "turned by up to" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["bend", "walk.bvh", "--along", "bad.csv", "-o", "x.bvh"], "bad.csv, line 2"),
        (["bend", "walk.bvh", "--along", "gone.csv", "-o", "x.bvh"], "gone.csv"),
        (["bend", "walk.bvh", "--along", "walk.bvh", "-o", "x.bvh"], "Cannot read a path from walk.bvh"),
        (["bend", "gone.bvh", "--along", "line.csv", "-o", "x.bvh"], "gone.bvh"),
        (["bend", "stands.bvh", "--along", "line.csv", "-o", "x.bvh"], "it stands; there is no path to edit"),
        (["bend", "arm.bvh", "--along", "line.csv", "-o", "x.bvh"], "legs"),
        (["bend", "walk.bvh", "--along", "line.csv", "-o", "x.mp4"], "is written as .bvh, .glb or .amc"),
        (["bend", "walk.bvh", "--along", "line.csv", "-o", "walk.bvh"], "is one of the files to read"),
        (["bend", "walk.bvh", "--along", "line.csv", "-o", "nowhere/x.bvh"], "Cannot write nowhere"),
        (["bend", "walk.bvh", "--along", "line.csv", "-o", "x.bvh", "--limit", "0"], "'0' is not a number"),
        (["bend", "walk.bvh", "--along", "line.csv", "-o", "x.bvh", "--skeleton", "a.asf"], ".amc clips"),
        (["bend", "walk.bvh", "-o", "x.bvh"], "--along"),
        (["walk", "graph.npz", "--random", "1s", "--bend", "-o", "x.bvh"], "belong to --path"),
        (
            ["walk", "graph.npz", "--path", "line.csv", "--bend", "nan", "-o", "x.bvh"],
            "'nan' is not a number",
        ),
        (["walk", "graph.npz", "--path", "line.csv", "--bend", "0", "-o", "x.bvh"], "'0' is not a number"),
    ],
)
def test_bad_input_is_one_sentence_and_leaves_nothing(folder, monkeypatch, capsys, words, message):
    monkeypatch.chdir(folder)
    before = contents(folder)
    assert main(words) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert message in said
    assert len(said) <= 220
    assert contents(folder) == before
