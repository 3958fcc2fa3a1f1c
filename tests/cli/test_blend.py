"""`mocap blend`, as a person types it."""

import pytest

from mocap.body.motion import resample
from mocap.cli.main import main
from mocap.files import load_save
from tests.blending.registered import slides, walks


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, speed in (("slow", 0.8), ("brisk", 1.4), ("middling", 1.1)):
        load_save.save(resample(walks()[speed, 0], 60.0), tmp_path / f"{name}.bvh")
    return tmp_path


def test_clips_are_blended_half_and_half_by_default(folder, capsys):
    assert main(["blend", "slow.bvh", "brisk.bvh"]) == 0
    said = capsys.readouterr().out
    assert "registered   2 clips, 3." in said and "wrote        blend.bvh" in said
    assert 3 < load_save.load("blend.bvh").duration < 5


def test_weights_say_how_much_of_each(folder):
    for name, weights in (("a", ["1", "0", "0"]), ("b", ["0", "1", "0"])):
        clips = ["slow.bvh", "brisk.bvh", "middling.bvh"]
        assert main(["blend", *clips, "--weights", *weights, "-o", f"{name}.amc"]) == 0
    slow, brisk = (load_save.load(f"{name}.amc", fps=60.0) for name in "ab")
    assert slow.duration > brisk.duration + 0.1


def test_one_clip_passes_into_another(folder, capsys):
    assert main(["blend", "slow.bvh", "brisk.bvh", "--fade", "1", "--at", "2", "-o", "faster.glb"]) == 0
    assert "blended      4." in capsys.readouterr().out
    assert (folder / "faster.glb").read_bytes()[:4] == b"glTF"


def test_planted_feet_stand_still_when_asked(folder):
    assert main(["blend", "slow.bvh", "brisk.bvh", "--clean", "--slack", "1"]) == 0
    from mocap.feet import mark_plants

    assert slides(mark_plants(load_save.load("blend.bvh"))).mean() < 1.0


def test_clips_of_different_bodies_are_refused(folder, capsys):
    from tests.strategies import wave

    load_save.save(wave(90), "arm.bvh")
    assert main(["blend", "slow.bvh", "arm.bvh", "--fps", "30"]) == 2
    assert "skeletons differ" in capsys.readouterr().err
    assert not (folder / "blend.bvh").exists()
