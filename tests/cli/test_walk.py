"""`mocap walk`, as a person types it."""

import pytest

from mocap.cli.main import main
from mocap.files import load_save
from mocap.graphs import storage
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from tests.bundled import bundled
from tests.cli.refused import check_refused
from tests.files.glb_reader import Glb
from tests.strategies import wave


@pytest.fixture
def folder(tmp_path):
    storage.save(bundled("walk_circle", "walk_curve_1"), tmp_path / "graph.npz")
    (tmp_path / "path.csv").write_text("0,0\n0,3\n0.5,5\n")
    (tmp_path / "path.svg").write_text('<svg><path d="M0 0 L 0 -400"/></svg>')
    return tmp_path


def test_it_walks_along_a_path(folder, capsys, monkeypatch):
    monkeypatch.chdir(folder)
    command = ["walk", "graph.npz", "--path", "path.csv", "-o", "out.bvh", "--label", "0:walk", "--clean"]
    assert main(command) == 0
    assert "walked" in capsys.readouterr().out
    assert len(load_save.load("out.bvh")) > 90


def test_it_wanders(folder, capsys):
    out = folder / "out.bvh"
    assert main(["walk", str(folder / "graph.npz"), "--random", "0.1min", "-o", str(out)]) == 0
    assert len(load_save.load(out)) >= 180
    assert "at random" in capsys.readouterr().out


@pytest.mark.parametrize("way", [["--random", "5s"], ["--path", "path.svg"]])
def test_it_writes_gltf_for_engines(folder, monkeypatch, way):
    monkeypatch.chdir(folder)
    assert main(["walk", "graph.npz", *way, "-o", "walk.glb", "--clean"]) == 0
    read = Glb((folder / "walk.glb").read_bytes())
    assert read.nodes[0]["name"] == "root"
    assert max(times[-1] for times, _ in read.curves().values()) > 3


def test_clips_are_found_beside_the_graph(tmp_path):
    for clip in (wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)):
        load_save.save(clip, tmp_path / f"{clip.name}.bvh")
    clips = [load_save.load(tmp_path / f"{name}.bvh") for name in "ab"]
    storage.save(prune(build(clips, window=8, threshold=0.05)), tmp_path / "graph.npz")
    command = ["walk", str(tmp_path / "graph.npz"), "--random", "5s", "-o", str(tmp_path / "out.bvh")]
    assert main(command) == 0
    assert main([*command, "--clips", str(tmp_path / "a.bvh"), str(tmp_path / "b.bvh")]) == 0
    (tmp_path / "b.bvh").unlink()
    assert main(command) == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--path", "{f}/nowhere.csv"], "nowhere.csv"),
        (["--random", "soon"], "Write 60s, 10min or 1h"),
        (["--random", "0s"], "Write 60s"),
        (["--path", "{f}/path.csv", "--label", "walk"], "METRES:LABEL"),
        (["--path", "{f}/path.csv", "--label", "0:fly"], "there are: walk"),
        (["--path", "{f}/path.csv", "--unit", "5000"], "is it in metres?"),
        (["--path", "{f}/path.csv", "-o", "{f}/walk.fbx"], "as .bvh or .glb"),
    ],
)
def test_bad_input_is_one_sentence_and_status_2(folder, capsys, options, message):
    options = [option.format(f=folder) for option in options]
    out = [] if "-o" in options else ["-o", str(folder / "out.bvh")]
    check_refused(folder, capsys, ["walk", str(folder / "graph.npz"), *options, *out], message)
