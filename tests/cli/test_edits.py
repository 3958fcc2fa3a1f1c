"""`mocap bend`, `loop`, `blend`, `retarget` and `warp`, as a person types them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mocap import load
from mocap.body import Motion, Skeleton, joint_positions, resample, rotations
from mocap.datasets.samples import sample
from mocap.editing import copied, stance_of
from mocap.files import load_save
from mocap.files.path_files import load_path
from mocap.graphs import storage
from tests.blending.registered import walks
from tests.bundled import bundled
from tests.editing.bodies import adult, child, walk
from tests.files.acclaim_clips import write_acclaim
from tests.files.glb_reader import Glb
from tests.strategies import wave


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    place = tmp_path_factory.mktemp("edits")
    load_save.save(resample(sample("walk_straight"), 30), place / "walk.bvh")
    load_save.save(resample(sample("walk_circle"), 30)[:400], place / "circle.bvh")
    for name, speed in (("slow", 0.8), ("brisk", 1.4), ("middling", 1.1)):
        load_save.save(resample(walks()[speed, 0], 60.0), place / f"{name}.bvh")
    (place / "line.csv").write_text("0,0\n0,3\n1.8,0.6\n1.8,6.6\n")
    (place / "line.svg").write_text('<svg><path d="M0 0 C 0 -200 200 -200 200 -400"/></svg>')
    storage.save(bundled("walk_circle", "walk_curve_1"), place / "graph.npz")
    load_save.save(sample("walk_straight")[:361], place / "three.bvh")
    load_save.save(wave(60), place / "arm.bvh")
    return place


@pytest.fixture
def folder(made, monkeypatch):
    monkeypatch.chdir(made)
    return made


def off(file, line):
    roots = load(file).root_positions[:, [0, 2]]
    return cKDTree(load_path(line).resampled(0.01).points).query(roots)[0]


@pytest.mark.parametrize(("line", "out"), [("line.csv", "new.bvh"), ("line.svg", "new.glb")])
def test_a_walk_is_laid_on_a_line(folder, run, line, out):
    said = run(f"bend walk.bvh --along {line} -o {out}").out
    assert said.startswith("bent         ") and said.endswith(f"wrote        {out}\n")
    assert "cm off on average" in said
    assert ("rounded at" in said) == (line == "line.csv")
    assert out == "new.glb" or np.median(off(out, line)) < 0.03


def test_the_limit_and_the_unit_count(folder, run):
    said = run("bend walk.bvh --along line.csv -o x.bvh --limit 40").out
    assert re.search("turned by up to (3[89]|4[01])° per second", said)
    assert "of 24.0 m" in run("bend walk.bvh --along line.csv -o x.bvh --unit 2").out
    assert "of 17.0 m" in run("bend walk.bvh --along line.csv -o x.bvh --length 17").out


def test_the_line_of_a_picture_is_named_and_chosen(folder, run):
    (folder / "two.svg").write_text('<svg><line id="a" x2="800"/><path id="b" d="M0 0V-700"/></svg>')
    done = run("bend walk.bvh --along two.svg -o x.bvh")
    assert "of 8.0 m" in done.out and "choose another by --id." in done.err
    done = run("bend walk.bvh --along two.svg -o x.bvh --id b")
    assert "of 7.0 m" in done.out and "--id" not in done.err


@pytest.mark.parametrize("more", ["", "--straight --clean --times 3"])
def test_a_loop_is_closed(folder, run, more):
    told = run(f"loop circle.bvh -o loop.bvh {more}").out
    assert "cycle        frames " in told and "wrote        loop.bvh" in told
    assert (" by 0°" in told) == ("--straight" in more)
    assert 1 < load("loop.bvh").duration / (3 if "--times" in more else 1) < 1.6


@pytest.mark.parametrize(
    ("held", "shortest", "said"),
    [(0, "1.5", "cm apart: it may leap there."), (60, "0.4", "away: it may hold no whole cycle.")],
)
def test_a_loop_that_leaps_or_holds_a_pose_is_a_warning(folder, run, held, shortest, said):
    """Of an arm that swings once, and rises where it was held for some frames before."""
    body = Skeleton(["root", "arm", "hand"], [-1, 0, 1], [[0, 1, 0], [0.1, 0, 0], [0.6, 0, 0]])
    count = 30 if held else 60
    turned, roots = np.tile(rotations.IDENTITY, (held + count, 3, 1)), np.zeros((held + count, 3))
    turned[held:, 1] = rotations.about_y(np.linspace(0, 3, count))
    roots[held:, 1] = np.linspace(0, held / 60, count)
    load_save.save(Motion(body, roots, turned, 30.0, "arm"), "swing.bvh")
    assert said in run(f"loop swing.bvh --shortest {shortest} -o out.bvh").err


def test_clips_are_blended_half_and_half_or_by_weights(folder, run):
    said = run("blend slow.bvh brisk.bvh").out
    assert "registered   2 clips, 4." in said and "wrote        blend.bvh" in said
    assert 3 < load("blend.bvh").duration < 5
    for name, weights in (("a", "1 0 0"), ("b", "0 1 0")):
        run(f"blend slow.bvh brisk.bvh middling.bvh --weights {weights} -o {name}.bvh")
    slow, brisk = (load(f"{name}.bvh") for name in "ab")
    assert slow.duration > brisk.duration + 0.1


def test_one_clip_passes_into_another(folder, run):
    assert "blended      5." in run("blend slow.bvh brisk.bvh --fade 1 -o faster.glb").out
    assert (folder / "faster.glb").read_bytes()[:4] == b"glTF"


def test_bodies_that_differ_are_one_short_sentence_that_says_what_to_do(tmp_path, run):
    for name in ("one_who_walks", "one_who_runs"):
        names = ["root", *(f"{name}_joint_{joint}" for joint in range(20))]
        body = Skeleton(names, range(-1, 20), np.tile([0, 0.1, 0], (21, 1)))
        turned = np.tile(rotations.IDENTITY, (60, 21, 1))
        load_save.save(Motion(body, np.zeros((60, 3)), turned, 30.0, name), tmp_path / f"{name}.bvh")
    told = run(f"blend {tmp_path}/one_who_walks.bvh {tmp_path}/one_who_runs.bvh -o {tmp_path}/x.bvh", 2).err
    assert "mocap retarget lets one body wear both." in told and len(told) <= 200


@pytest.fixture
def child_s(tmp_path, monkeypatch):
    """Stand in a folder with two clips of an adult, in `clips`, and a child's walk, skeleton and pose."""
    (tmp_path / "clips").mkdir()
    load_save.save(walk()[:200], tmp_path / "clips" / "a.bvh")
    load_save.save(walk()[100:260], tmp_path / "clips" / "b.bvh")
    worn = copied(walk(), adult(), child())
    write_acclaim(worn, tmp_path / "child.amc")
    load_save.save(worn[:1], tmp_path / "pose.bvh")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(folder):
    return sorted(path.name for path in folder.rglob("*") if path.is_file())


@pytest.mark.parametrize("broken", [False, True])
def test_a_folder_of_clips_on_the_body_of_a_clip(child_s, run, broken):
    if broken:
        (child_s / "clips" / "broken.bvh").write_text("HIERARCHY\n")
    told = run("retarget clips --to child.amc -o out", 2 * broken)
    assert told.out.startswith(f"retargeted   2 of {2 + broken}, in out\n")
    assert ("mocap: clips/broken.bvh: expected" in told.err) == broken
    assert all(len(line) < 320 for line in (told.out + told.err).splitlines())
    assert written(child_s / "out") == ["a.bvh", "b.bvh"]
    worn = load("out/a.bvh")
    assert len(worn) == 200
    assert stance_of(worn).leg == pytest.approx(child().leg, abs=1e-5)
    standing = joint_positions(worn)[walk()[:200].contacts["ltoes"], worn.skeleton.index("ltoes"), 1]
    assert np.ptp(standing) < 1e-4
    assert standing.mean() == pytest.approx(child().heights["left ball"], abs=0.003)


def test_the_unit_of_the_clips_is_not_that_of_the_body_and_each_is_stated_with_its_option(child_s, run):
    clip = load_save.load("clips/a.bvh")
    small = replace(clip.skeleton, offsets=0.01 * clip.skeleton.offsets)  # files are in centimetres
    load_save.save(replace(clip, skeleton=small, root_positions=0.01 * clip.root_positions), "in_m.bvh")
    err = run("retarget in_m.bvh --to clips/b.bvh --scale 1 -o out").err
    assert "is its scale right?" not in err
    err = run("retarget clips/a.bvh --to in_m.bvh --scale 0.01 -o back").err
    assert "in_m.bvh: read as 1 m a unit, y up: 1.7" in err and "--to-scale and --to-up overrule it." in err


def test_the_axis_of_the_body_is_said_by_an_option(child_s, run):
    clip = load_save.load("clips/b.bvh")
    lay = rotations.inverse(rotations.Z_UP)
    body = replace(clip.skeleton, offsets=rotations.rotate(lay, clip.skeleton.offsets))
    turned = rotations.multiply(rotations.multiply(lay, clip.rotations), rotations.inverse(lay))
    places = rotations.rotate(lay, clip.root_positions)
    load_save.save(Motion(body, places, turned, clip.fps), "z_up.bvh")
    run("retarget clips/a.bvh --to clips/b.bvh -o by_y")
    assert "--to-up" not in run("retarget clips/a.bvh --to z_up.bvh --to-up z -o by_z").err
    by_y, by_z = (joint_positions(load_save.load(f"{folder}/a.bvh")) for folder in ("by_y", "by_z"))
    assert np.abs(by_y - by_z).max() < 1e-4


def test_a_skeleton_and_another_format_with_steps_as_long_as_the_legs(child_s, run):
    run("retarget clips/a.bvh --to child.asf -o out --format glb")
    assert written(child_s / "out") == ["a.glb"]
    places = Glb((child_s / "out" / "a.glb").read_bytes()).curves()[0, "translation"][1]
    own = np.ptp(walk()[:200].root_positions[:, 2])
    assert np.ptp(places[:, 2]) == pytest.approx(own * child().leg / adult().leg, rel=0.02)


def test_a_single_pose_in_a_stride_gives_the_body_and_its_rest_pose_with_a_warning(child_s, run):
    err = run("retarget clips/a.bvh --to pose.bvh -o out").err
    assert "does not stand: one ankle is" in err
    assert "The rest pose of its skeleton is taken as the stance." in err
    assert stance_of(load("out/a.bvh")).leg == pytest.approx(child().leg, abs=1e-5)


def test_a_standing_pose_of_two_frames_says_how_high_the_feet_are(child_s, run):
    """Here the feet of the hierarchy lie level, and those of the pose are tilted by 31°."""
    body = child().skeleton
    offsets = body.offsets.copy()
    turns = np.tile([1.0, 0, 0, 0], (2, len(body), 1))
    for side in "lr":
        ball = body.index(f"{side}toes")
        offsets[ball] = [0, 0, np.linalg.norm(offsets[ball])]
        for joint, angle in ((f"{side}foot", 31.0), (f"{side}toes", -31.0)):
            turns[:, body.index(joint)] = rotations.from_rotvec([np.radians(angle), 0, 0])
    pose = Motion(replace(body, offsets=offsets), np.zeros((2, 3)), turns, 30.0, "bind")
    rise = 0.01 - joint_positions(pose)[..., 1].min()
    pose = replace(pose, root_positions=np.array([[0, rise, 0]] * 2))
    load_save.save(pose, "bind.bvh")
    assert not run("retarget clips/a.bvh --to bind.bvh -o out").err
    ankle = body.index("lfoot")
    standing = joint_positions(load("out/a.bvh"))[walk()[:200].contacts["lfoot"], ankle, 1]
    assert standing == pytest.approx(joint_positions(pose)[0, ankle, 1], abs=0.003)


def test_a_hand_is_raised_and_the_clip_lasts_longer(folder, run):
    Path("post.txt").write_text("# to the post\n\nat 1.5s lhand 0.1 0.25 0.05\ntime 0 0\ntime 4 3\n")
    said = run("warp three.bvh --keys post.txt -o new.bvh").out
    assert said == "keys         1 of poses, 2 of time\nwrote        new.bvh: 481 frames, 4.00 s\n"
    made, walk = (load_save.load(f"{name}.bvh") for name in ("new", "three"))
    hand = [joint_positions(m)[f, m.skeleton.index("lhand")] for m, f in ((made, 240), (walk, 180))]
    assert hand[0] - hand[1] == pytest.approx([0.1, 0.25, 0.05], abs=0.012)  # the walk faces +z, nearly


def test_without_feet_another_body_can_be_warped(folder, run):
    Path("arm.txt").write_text("at 30 hand 0 0.1 0")
    run("warp arm.bvh --keys arm.txt -o arm2.bvh --loose-feet")
    assert len(load_save.load("arm2.bvh")) == 60
