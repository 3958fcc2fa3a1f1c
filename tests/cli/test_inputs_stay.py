"""No command writes over a file that it reads."""

import numpy as np
import pytest

from mocap.cli.main import main

KEPT = "is one of the files to read: choose another name with -o."


def of_walks(folder):
    (folder / "b.bvh").rename(folder / "walk.bvh")
    return [str(folder / "a.bvh"), str(folder / "walk.bvh")]


@pytest.mark.parametrize(
    "words",
    [
        ["loop", "walk.bvh", "-o", "./walk.bvh"],
        ["demo", ".", "-o", "."],
        ["walk", "graph.npz", "--random", "2s"],
        ["walk", "graph.npz", "--random", "2s", "--clips", "a.bvh", "walk.bvh"],
    ],
)
def test_clips_stay_as_they_are(clips, monkeypatch, capsys, words):
    monkeypatch.chdir(clips)
    of_walks(clips)
    assert main(["graph", "a.bvh", "walk.bvh", "-o", "graph.npz"]) == 0
    before = (clips / "walk.bvh").read_bytes()
    assert main(words) == 2
    assert KEPT in capsys.readouterr().err
    assert (clips / "walk.bvh").read_bytes() == before


def test_a_walk_may_bear_the_name_of_a_clip_elsewhere(clips, monkeypatch):
    words = of_walks(clips)
    (clips / "work").mkdir()
    monkeypatch.chdir(clips / "work")
    assert main(["graph", *words, "-o", "graph.npz"]) == 0
    for _ in range(2):  # and it replaces an old result
        assert main(["walk", "graph.npz", "--random", "2s"]) == 0


def test_an_archive_of_poses_is_not_replaced_by_its_graph(tmp_path, capsys):
    poses = np.random.default_rng(0).normal(0, 0.01, (60, 66))
    file = tmp_path / "walk.npz"
    np.savez(file, poses=poses, trans=np.zeros((60, 3)), mocap_framerate=30.0)
    before = file.read_bytes()
    assert main(["graph", str(file), "-o", str(file)]) == 2
    assert KEPT in capsys.readouterr().err
    assert file.read_bytes() == before
