"""`mocap cut`, as a person types it."""

import numpy as np
import pytest

from mocap import body, editing
from mocap.body import Motion, heading, resample, rotations
from mocap.datasets.samples import sample
from mocap.files import load_save
from tests.files.glb_reader import Glb


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    place = tmp_path_factory.mktemp("cut")
    load_save.save(resample(sample("walk_curve_1"), 60)[:241], place / "curve.bvh")
    straight = resample(sample("walk_straight"), 60)[:241]
    load_save.save(straight, place / "straight.bvh")
    load_save.save(editing.loop(straight), place / "cycle.bvh")
    (place / "folder").mkdir()
    load_save.save(resample(straight, 30), place / "folder" / "straight.bvh")
    return place


@pytest.fixture
def folder(made, monkeypatch):
    monkeypatch.chdir(made)
    return made


def same(motion: Motion, expected: Motion) -> None:
    """Compare two motions, except for the rounding of numbers in files."""
    assert len(motion) == len(expected) and motion.fps == pytest.approx(expected.fps)
    np.testing.assert_allclose(motion.root_positions, expected.root_positions, atol=1e-6)
    assert rotations.angle_between(motion.rotations, expected.rotations).max() < 1e-6


@pytest.mark.parametrize(
    ("options", "frames"),
    [
        ("", slice(None)),
        ("--from 1", slice(1, None)),
        ("--from 60 --to 90", slice(60, 90)),
        ("--from 1s --to 1.5s", slice(60, 90)),
        ("--to 241", slice(None)),
        ("--from 240", slice(240, None)),
    ],
)
def test_frames_from_the_first_up_to_the_last_are_kept(folder, run, options, frames):
    said = run(f"cut curve.bvh {options} -o part.bvh")
    same(load_save.load("part.bvh"), load_save.load("curve.bvh")[frames])
    assert said.err == "" and said.out.endswith("wrote        part.bvh\n")


def test_a_rate_resamples_and_the_motion_keeps_its_speed(folder, run):
    run("cut curve.bvh --from 1s --rate 30 -o slow.bvh")
    clip = load_save.load("curve.bvh")[60:]
    slow = load_save.load("slow.bvh")
    same(slow, resample(clip, 30))
    assert slow.duration == pytest.approx(clip.duration)


def test_the_rate_that_is_read_and_the_rate_that_is_written_differ(folder, run):
    run("cut curve.bvh --read-fps 30 --rate 15 -o slow.bvh")
    assert load_save.load("slow.bvh").duration == pytest.approx(8.0)


def test_a_mirror_image_at_the_origin(folder, run):
    run("cut curve.bvh --mirror --home -o mirrored.bvh")
    mirrored = load_save.load("mirrored.bvh")
    same(mirrored, body.place(editing.mirror(load_save.load("curve.bvh")), 0.0, [0, 0]))
    assert np.abs(mirrored.root_positions[0, [0, 2]]).max() < 1e-6
    assert abs(heading(mirrored.rotations[0, 0])) < 1e-6


def test_a_cycle_is_repeated_without_a_leap(folder, run):
    said = run("cut cycle.bvh --times 3 -o long.bvh")
    cycle = load_save.load("cycle.bvh")
    long = load_save.load("long.bvh")
    same(long, editing.repeated(cycle, 3))
    assert said.err == "" and len(long) == 3 * (len(cycle) - 1) + 1
    assert "the copies leap there. mocap loop" in run("cut curve.bvh --to 40 --times 2 -o leaps.bvh").err


def test_a_cycle_stays_in_place_however_often(folder, run):
    run("cut cycle.bvh --in-place --times 4 --home -o spot.bvh")
    spot = load_save.load("spot.bvh")
    cycle = load_save.load("cycle.bvh")
    travel = np.ptp(cycle.root_positions[:, [0, 2]], axis=0).max()
    assert travel > 1 and np.ptp(spot.root_positions[:, [0, 2]], axis=0).max() < 0.1
    np.testing.assert_allclose(spot.root_positions[: len(cycle), 1], cycle.root_positions[:, 1], atol=1e-6)


def test_clips_are_animations_of_one_glb(folder, run):
    said = run("cut curve.bvh straight.bvh folder -o all.glb --from 0.5s --home").out
    read = Glb((folder / "all.glb").read_bytes())
    names = [animation["name"] for animation in read.document["animations"]]
    assert len(set(names)) == 3 and names[0] == "curve" and said.count("cut  ") == 3
    clocks = [
        read.arrays[animation["samplers"][0]["input"]].ravel() for animation in read.document["animations"]
    ]
    assert [len(clock) for clock in clocks] == [211, 211, 106]
    assert [clock[-1] for clock in clocks] == pytest.approx([3.5, 3.5, 3.5])
    assert len({len(animation["channels"]) for animation in read.document["animations"]}) == 1


def test_one_clip_of_a_folder_may_be_a_bvh(folder, run):
    run("cut folder -o one.bvh")
    same(load_save.load("one.bvh"), load_save.load("folder/straight.bvh"))


def test_a_joint_on_the_floor_is_added_for_engines(folder, run):
    run("cut straight.bvh --root -o rooted.glb")
    read = Glb((folder / "rooted.glb").read_bytes())
    parents = read.parents()
    assert parents[0] == read.joints[-1] and parents[read.joints[-1]] == -1
