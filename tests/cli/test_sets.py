"""Several clips in one command: those that belong together are read in one unit, with one axis up."""

import numpy as np
import pytest

from mocap import datasets
from mocap.body import resample
from mocap.files import load_save
from tests.files.test_spaces import written

WALK = resample(datasets.sample("walk_straight"), 30)
JOG = resample(datasets.sample("jog"), 30)[400:520]
SAID = "set/jog.bvh and 2 more: read as 1 inch a unit, z up: 1.7"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Stand beside a set of three clips in inches with z up, of which one does not show it alone."""
    (tmp_path / "set").mkdir()
    for name, clip in {"jog": JOG, "short": WALK[:40], "walk": WALK[40:]}.items():
        written(clip, tmp_path / "set" / f"{name}.bvh", 0.0254, "z")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def heights(*paths):
    """Return the height of the body in the first frame of each file, metres."""
    return [np.ptp(load_save.load(path, scale=0.01, up="y").positions[0, :, 1]) for path in paths]


def test_a_clip_alone_is_read_otherwise(folder, run):
    assert "0.6" in run("info set/jog.bvh").err


def test_a_folder_is_converted_in_the_space_of_the_set_which_is_stated_once(folder, run):
    said = run("convert set out").err
    assert said.startswith(f"mocap: {SAID}")
    assert said.count("read as") == 1
    assert heights("out/jog.bvh", "out/short.bvh", "out/walk.bvh") == pytest.approx([1.7] * 3, abs=0.15)


def test_options_overrule_the_set(folder, run):
    assert run("convert set out --scale 0.0254 --up z").err == ""
    assert heights("out/jog.bvh") == pytest.approx([1.7], abs=0.15)
    said = run("convert set out --scale 0.01").err
    assert "z up: 0.6" in said and said.endswith("--up overrules it.\n")
    assert heights("out/walk.bvh") == pytest.approx([1.7 / 2.54], abs=0.1)


LINES = {
    "judge": "judge set/jog.bvh --against set/walk.bvh set/short.bvh",
    "retarget": "retarget set/jog.bvh set/short.bvh --to set/walk.bvh -o worn",
    "blend": "blend set/jog.bvh set/short.bvh set/walk.bvh --slack 5 -o blend.bvh",
    "inbetween": "inbetween set/jog.bvh set/short.bvh --clips set/walk.bvh --seconds 0.2 -o between.bvh",
}


@pytest.mark.parametrize("command", LINES)
def test_clips_in_different_arguments_of_a_command_belong_together(folder, run, command):
    said = run(LINES[command]).err
    assert said.startswith(f"mocap: {SAID}")
    assert said.count("read as") == 1


def test_clips_of_one_file_have_one_space(folder, run):
    assert run("cut set -o all.glb").err.startswith(f"mocap: {SAID}")


def test_clips_of_one_skeleton_that_contradict_each_other_are_read_by_themselves_and_that_is_stated(
    folder, run
):
    load_save.save(WALK, "set/other.bvh")
    said = run("convert set out").err
    assert "Clips of the same joints are read differently: set/jog.bvh and 2 more as 1 inch a unit" in said
    assert "and set/other.bvh as 1 cm a unit, y up" in said
    assert heights("out/jog.bvh", "out/other.bvh") == pytest.approx([1.7] * 2, abs=0.15)
