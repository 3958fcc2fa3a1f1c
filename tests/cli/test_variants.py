"""`mocap loop`, and `mocap graph --mirror`."""

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.motion import resample
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.datasets.clip_origins import Origin, find_again, is_origin
from mocap.files import load_save
from mocap.graphs import storage


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("variants")
    load_save.save(resample(samples.sample("walk_circle"), 30)[:400], place / "walk.bvh")
    return place


@pytest.mark.parametrize("more", [[], ["--straight", "--clean", "--times", "3"], ["--inertialize"]])
def test_loop(folder, tmp_path, capsys, more):
    out = tmp_path / "loop.bvh"
    assert main(["loop", str(folder / "walk.bvh"), "-o", str(out), *more]) == 0
    told = capsys.readouterr().out
    assert "cycle        frames " in told
    assert f"wrote        {out}" in told
    assert (" by 0°" in told) == ("--straight" in more)
    seconds = load_save.load(out).duration
    assert 1 < seconds / (3 if "--times" in more else 1) < 1.6


def test_a_loop_that_cannot_be_is_refused(folder, tmp_path, capsys):
    clip = str(folder / "walk.bvh")
    assert main(["loop", clip, "--shortest", "60", "--longest", "60"]) == 2
    assert "a cycle takes 60.2 s or more" in capsys.readouterr().err
    assert main(["loop", clip, "--shortest", "2", "--longest", "1"]) == 2
    assert main(["loop", clip, "-o", str(tmp_path / "nowhere" / "a.bvh")]) == 2


def test_a_graph_with_mirror_images_finds_its_clips_again(folder, tmp_path, capsys):
    graph = tmp_path / "graph.npz"
    assert main(["graph", str(folder / "walk.bvh"), "--mirror", "-o", str(graph), "--fps", "30"]) == 0
    assert storage.read(graph).names == ("walk", "walk_mirrored")
    clip, image = storage.find_clips(graph)
    assert np.allclose(joint_positions(image)[:, 0], joint_positions(clip)[:, 0] * [-1, 1, 1])
    for more in ([], ["--clips", str(folder / "walk.bvh")]):
        out = tmp_path / "out.bvh"
        assert main(["walk", str(graph), "--random", "5s", "-o", str(out), *more]) == 0
    assert "walk_mirrored: " in (main(["graph", "info", str(graph)]), capsys.readouterr().out)[1]


def test_a_mirrored_origin_is_checked(tmp_path):
    (tmp_path / "a.bvh").write_text("")
    text = Origin(tmp_path / "a.bvh", mirrored=True).text(tmp_path)
    assert is_origin(text)
    assert find_again(text, tmp_path).mirrored
    assert not is_origin(text.replace("true", "1"))
    assert not is_origin("[]")
