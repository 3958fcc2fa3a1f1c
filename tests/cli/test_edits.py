"""`mocap bend`, `loop`, `blend`, `retarget` and `warp`, with its files of keys, as a person types them."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from mocap import load
from mocap.body import Motion, Skeleton, joint_positions, resample, rotations
from mocap.datasets.samples import sample
from mocap.editing import copied, stance_of
from mocap.editing.warp_plans import load_plan, warp
from mocap.errors import FormatError, MocapError
from mocap.files import load_save
from mocap.files.path_files import load_path
from mocap.graphs import storage
from tests.blending.registered import walks
from tests.bundled import bundled
from tests.editing.bodies import adult, child, walk
from tests.editing.test_path_editing import slide
from tests.files.acclaim_clips import write_acclaim
from tests.files.glb_reader import Glb
from tests.refusals import refused, refused_texts
from tests.strategies import wave

WALK = sample("walk_straight")[:361]  # 3 s
HAND = WALK.skeleton.index("lhand")


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
    load_save.save(WALK, place / "three.bvh")
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
    said = run("bend walk.bvh --along line.csv -o x.bvh --limit 30").out
    assert re.search("turned by up to (29|3[01])° per second", said)
    assert "of 24.0 m" in run("bend walk.bvh --along line.csv -o x.bvh --unit 2").out


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
    assert "registered   2 clips, 3." in said and "wrote        blend.bvh" in said
    assert 3 < load("blend.bvh").duration < 5
    for name, weights in (("a", "1 0 0"), ("b", "0 1 0")):
        run(f"blend slow.bvh brisk.bvh middling.bvh --weights {weights} -o {name}.bvh")
    slow, brisk = (load(f"{name}.bvh") for name in "ab")
    assert slow.duration > brisk.duration + 0.1


def test_one_clip_passes_into_another(folder, run):
    assert "blended      4." in run("blend slow.bvh brisk.bvh --fade 1 -o faster.glb").out
    assert (folder / "faster.glb").read_bytes()[:4] == b"glTF"


def test_bodies_that_differ_are_one_short_sentence_that_says_what_to_do(tmp_path, run):
    for name in ("one_who_walks", "one_who_runs"):
        names = ["root", *(f"{name}_joint_{joint}" for joint in range(20))]
        body = Skeleton(names, range(-1, 20), np.tile([0, 0.1, 0], (21, 1)))
        turned = np.tile(rotations.IDENTITY, (60, 21, 1))
        load_save.save(Motion(body, np.zeros((60, 3)), turned, 30.0, name), tmp_path / f"{name}.bvh")
    told = run(f"blend {tmp_path}/one_who_walks.bvh {tmp_path}/one_who_runs.bvh -o {tmp_path}/x.bvh", 2).err
    assert "Retarget one first." in told and len(told) <= 200


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
    told = run("retarget clips --to child.amc -o out", 2 * broken).out
    assert told.startswith(f"retargeted   2 of {2 + broken}, in out\n")
    assert ("failed       clips/broken.bvh: expected" in told) == broken
    assert all(len(line) < 320 for line in told.splitlines())
    assert written(child_s / "out") == ["a.bvh", "b.bvh"]
    worn = load("out/a.bvh")
    assert len(worn) == 200
    assert stance_of(worn).leg == pytest.approx(child().leg, abs=1e-5)
    standing = joint_positions(worn)[walk()[:200].contacts["ltoes"], worn.skeleton.index("ltoes"), 1]
    assert np.ptp(standing) < 1e-4
    assert standing.mean() == pytest.approx(child().heights["left ball"], abs=0.003)


def test_a_skeleton_and_another_format_with_steps_as_long_as_the_legs(child_s, run):
    run("retarget clips/a.bvh --to child.asf -o out --format glb")
    assert written(child_s / "out") == ["a.glb"]
    places = Glb((child_s / "out" / "a.glb").read_bytes()).curves()[0, "translation"][1]
    own = np.ptp(walk()[:200].root_positions[:, 2])
    assert np.ptp(places[:, 2]) == pytest.approx(own * child().leg / adult().leg, rel=0.02)


def test_a_single_pose_says_whose_body_it_is(child_s, run):
    run("retarget clips/a.bvh --to pose.bvh -o out")
    assert stance_of(load("out/a.bvh")).leg == pytest.approx(child().leg, abs=1e-5)


@pytest.fixture
def plan(tmp_path):
    """Return a function that writes a plan for a motion, and reads it."""

    def write(text, motion=WALK):
        (tmp_path / "keys.txt").write_text(text)
        return load_plan(tmp_path / "keys.txt", motion)

    return write


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


def test_the_move_is_by_the_bodys_own_directions(plan):
    turned = sample("walk_circle")[1200:1500]
    key = plan("at 150 lhand 0.10 0.2 0.05", turned)
    moved = joint_positions(warp(turned, key))[150, HAND] - joint_positions(turned)[150, HAND]
    assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm([0.1, 0.2, 0.05]), abs=1e-5)
    assert moved[1] == pytest.approx(0.2, abs=1e-5)
    assert np.abs(moved - [0.1, 0.2, 0.05]).max() > 0.02


def test_the_motion_is_as_it_was_outside_the_window_unless_the_plan_says_from_when(plan):
    at = joint_positions(WALK)[:, HAND]

    def changed(text, window=0.5):
        warped = warp(WALK, plan(text), window=window, feet=False)
        return np.flatnonzero(np.linalg.norm(joint_positions(warped)[:, HAND] - at, axis=-1) > 1e-9)

    plain = changed("at 1.5s lhand 0 0.1 0")
    assert plain[[0, -1]].tolist() == [121, 239]
    assert changed("at 1.5s lhand 0 0.1 0", 1.0)[[0, -1]].tolist() == [61, 299]
    assert changed("at 1.5s lhand 0 0.1 0\nat 170 same\nat 190 level")[[0, -1]].tolist() == [171, 189]
    assert changed("at 0.1s lhand 0 0.1 0")[[0, -1]].tolist() == [0, 71]
    assert len(changed("at 90 same\nat 100 same")) == 0


def test_a_hand_at_its_place_leaves_the_feet_at_theirs(plan):
    warped = warp(WALK, plan("at 1.5s lhand 0.1 0.3 0.1\nat 2s root 0 -0.1 0"))
    assert slide(warped) < 1e-3
    hand = joint_positions(warped)[180, HAND] - joint_positions(WALK)[180, HAND]
    assert np.linalg.norm(hand) == pytest.approx(np.linalg.norm([0.1, 0.3, 0.1]), abs=1e-5)


def test_between_two_level_poses_the_hand_stays(plan):
    wide, level = (
        joint_positions(warp(WALK, plan(f"at 1s lhand 0 0.3 0{end}\nat 2s lhand 0 0.3 0{end}"), feet=False))
        for end in ("", " level")
    )
    rise = [(at[120:241, HAND] - joint_positions(WALK)[120:241, HAND])[:, 1] for at in (wide, level)]
    assert rise[1] == pytest.approx(0.3, abs=0.06)
    assert np.ptp(rise[1]) < np.ptp(rise[0])


test_a_file_of_another_form_names_the_line = refused_texts(
    lambda file: load_plan(file, WALK),
    "keys.txt",
    ("", "expected some text, got an empty file"),
    ("# nothing", "or 'time NEW OLD', got no key"),
    ("at 5 same\nmove lhand", "line 2: expected 'at MOMENT JOINT LEFT UP AHEAD .*got 'move lhand'"),
    ("at 5", "line 1: expected 'at MOMENT .*got 'at 5'"),
    ("at 5 lhand", "line 1: .*got 'at 5 lhand'"),
    ("at 5 same 1 2 3", "line 1: .*got 'at 5 same 1 2 3'"),
    ("at 5 lhand 1 2 level", "line 1: expected LEFT UP AHEAD.*got 'level' as number 3"),
    ("at", "line 1: .*got 'at'"),
    ("at -5 same", "line 1: .*got 'at -5 same'"),
    (f"at {'9' * 400} same", "line 1: expected a moment, all below 1e[+]09"),
    ("\n\nat 5 lhand 1 nan 3", "line 3: expected LEFT UP AHEAD, in metres.*got 'nan' as number 2"),
    ("time 1 x", "line 1: expected time NEW OLD, in seconds, got 'x' as number 2"),
    ("time 0 0", "line 1: expected two lines or more about time, got one"),
    ("time 0 0\n\ntime 2 2\ntime 3 1", "line 4: expected two seconds after 2 and 2, .* line 3, got 3 and 1"),
    ("time 0 0\ntime 0 1", "line 2: expected two seconds after 0 and 0, .* line 1, got 0 and 1"),
    ("\0", "a zero byte"),
    kind=FormatError,
)
test_a_plan_that_the_clip_cannot_follow = refused_texts(
    lambda file: warp(WALK, load_plan(file, WALK)),
    "keys.txt",
    ("at 361 same", r"line 1: expected a moment up to frame 360, or second 3, got frame 361"),
    ("at 5s same", "got frame 600"),
    ("at 5 hand 0 0 0", r"line 1: expected a joint, such as rhand, lhand, .*got 'hand'"),
    ("at 1s same\nat 120 level", "line 2: expected one wish for a joint at frame 120, got 'level' beside"),
    ("at 1s lhand 0 0 0\nat 120 lhand 0 1 0", "line 2: .*'lhand' beside 'lhand' of line 1"),
    ("at 1s lhand 0 9 0", r"keys.txt, line 1: Frame 120: '\w+' would be .* m from"),
    ("time 0 0\ntime 1 9", "line 2: expected an old second up to 3, the clip's last, got 9"),
    ("time 0 -1\ntime 1 2", "line 1: expected an old second up to 3, the clip's last, got -1"),
    ("time 0 0\ntime 1e8 2", r"ask for 1.2e\+10 frames"),
)


@pytest.mark.parametrize("window", [0.0, np.nan, -1.0])
def test_a_window_lasts_a_frame(plan, window):
    refused("A change takes a frame or more", warp, WALK, plan("at 5 same"), window=window)


words = st.sampled_from(
    ["at", "time", "same", "level", "lhand", "1s", "7", "0.1", "-1", "nan", "é", "#", "9" * 99]
)


@given(st.lists(st.lists(words, max_size=7).map(" ".join), max_size=4).map("\n".join))
def test_any_words_are_a_plan_or_one_sentence(tmp_path_factory, text):
    path = tmp_path_factory.getbasetemp() / "any.txt"
    path.write_text(text, encoding="utf-8")
    try:
        warp(WALK[:40], load_plan(path, WALK[:40]), feet=False)
    except MocapError as error:
        assert "\n" not in str(error)
        assert len(str(error)) <= 200 + len(str(path))
