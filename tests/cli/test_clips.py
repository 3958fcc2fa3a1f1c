"""The commands for clip files, as a person types them, and `files.conversion`."""

import json
import math
import os
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import numpy as np
import pytest
from PIL import Image

from mocap.body import Motion, concatenate, joint_positions, resample, rotations
from mocap.cli.clips import arranged
from mocap.datasets import samples
from mocap.files import conversion, load_save
from tests.files.acclaim_clips import write_acclaim
from tests.files.test_bvh import two_bodies
from tests.files.test_rigid_bones import chain, six_channels
from tests.files.test_spaces import with_offset
from tests.refusals import refused
from tests.strategies import wave


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Stand where a folder `clips` holds a clip, and a folder with another."""
    (tmp_path / "clips" / "more").mkdir(parents=True)
    load_save.save(wave(40, name="a"), tmp_path / "clips" / "a.bvh")
    load_save.save(wave(30, name="b"), tmp_path / "clips" / "more" / "b.BVH")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def same(one, other):
    names = ["root", "elbow", "hand", "side"]
    a, b = (
        joint_positions(m)[:, [m.skeleton.index(n) for n in names]] for m in map(load_save.load, (one, other))
    )
    return np.abs(a - b).max() < 1e-6


def test_info_tells_length_and_flaws_or_the_joints(folder, run):
    told = run("info clips/a.bvh --read-fps 60").out
    assert "40 at 60 Hz, 0.65 s" in told and "flaws " in told and "scale" not in told
    names = wave(40).skeleton.names
    told = run("info clips/a.bvh --joints").out
    assert told.splitlines()[-len(names) :][:2] == [f"# {names[0]}", f"#   {names[1]}"]
    assert "# No legs found among" in told
    assert set(tomllib.loads(told).values()) == {""}
    assert "m: is its scale right?" in run("info clips/a.bvh --scale 0.0001").out


@pytest.mark.parametrize("opens", [True, False])
def test_view_opens_a_page_of_the_clip_or_says_where_it_is(folder, run, monkeypatch, opens):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or opens)
    said = run("view clips/a.bvh")
    page = Path(url2pathname(urlsplit(opened[0]).path))
    assert "A figure plays a" in page.read_text("utf-8")
    assert str(page) in said.out
    assert ("open that page yourself" in said.err) == (not opens)


def test_view_keeps_a_file_and_opens_nothing(folder, run, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda address: pytest.fail("opened"))
    run("view clips/a.bvh -o a.png")
    assert (folder / "a.png").read_bytes().startswith(b"\x89PNG")


def with_rest_poses(motion, before, after=0):
    """Put the rest pose before the first frame, or after the last one, as many converters of files do."""
    still = rotations.IDENTITY * np.ones((before + after, len(motion.skeleton), 1))
    turns = np.concatenate([still[:before], motion.rotations, still[before:]])
    roots = motion.root_positions[np.clip(np.arange(-before, len(motion) + after), 0, len(motion) - 1)]
    return Motion(motion.skeleton, roots, turns, motion.fps)


def test_info_tells_how_to_cut_a_rest_pose_off(folder, run):
    walk = resample(samples.sample("walk_straight"), 30)[:60]
    load_save.save(with_rest_poses(walk, 1), "first.bvh")
    load_save.save(with_rest_poses(walk, 2, 3), "both.bvh")
    load_save.save(walk, "walk.bvh")
    assert "rest pose in frame 0 (cut it by mocap cut --from 1)" in run("info first.bvh").out
    told = run("info both.bvh").out
    assert "rest pose in frame 0-1, 62-64 (cut it by mocap cut --from 2 --to 62)" in told
    for line in ("cut first.bvh --from 1 -o cut.bvh", "cut both.bvh --from 2 --to 62 -o cut.bvh"):
        run(line)
        assert "rest pose" not in run("info cut.bvh").out
        assert np.allclose(load_save.load("cut.bvh").positions, load_save.load("walk.bvh").positions)


def test_convert_acclaim(folder, run):
    write_acclaim(load_save.load("clips/a.bvh"), folder / "one.amc")
    assert run("convert one.amc other.BVH --read-fps 30").out == "converted    1 of 1 to other.BVH\n"
    assert same("clips/a.bvh", "other.BVH")
    assert load_save.load("other.BVH").fps == 30.0


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_convert_from_amass_and_to_gltf(folder, run):
    (folder / "in").mkdir()
    poses = np.random.default_rng(0).normal(size=(5, 66))
    np.savez("in/walk.npz", poses=poses, trans=np.zeros((5, 3)), betas=np.ones(10), mocap_framerate=60.0)
    run("convert in out --to glb")
    assert (folder / "out" / "walk.glb").read_bytes()[:4] == b"glTF"
    assert "betas, the shape of the body, are ignored" in run("convert in/walk.npz walk.bvh").err
    ours, theirs = load_save.load("walk.bvh"), load_save.load("in/walk.npz")
    order = [ours.skeleton.index(name) for name in theirs.skeleton.names]
    assert np.abs(joint_positions(ours)[:, order] - joint_positions(theirs)).max() < 1e-6
    run("info in/walk.npz")


def test_convert_a_folder_and_name_what_failed(folder, run):
    (folder / "clips" / "broken.bvh").write_text("HIERARCHY\n")
    (folder / "clips" / "notes.txt").write_text("no clip")
    told = run("convert clips out", 2)
    assert told.out == "converted    2 of 3 to .bvh, in out\n"
    assert "mocap: clips/broken.bvh: expected a line 'MOTION'" in told.err
    made = sorted(str(p.relative_to("out")) for p in Path("out").rglob("*.*"))
    assert made == ["a.bvh", "more/b.bvh"]
    assert same("out/more/b.bvh", "clips/more/b.BVH")


def test_each_of_two_bodies_in_a_file_is_converted_by_its_number(folder, run):
    load_save.save(wave(40, seed=1), "other.bvh")
    first = Path("clips/a.bvh").read_text()
    Path("both.bvh").write_text(two_bodies(first, Path("other.bvh").read_text()))
    said = "both.bvh: 2 bodies with the roots 'root', 'root': the first one is read. --body chooses another."
    assert said in run("convert both.bvh first.bvh").err
    assert run("convert both.bvh second.bvh --body 2").err == ""
    assert same("first.bvh", "clips/a.bvh") and same("second.bvh", "other.bvh")
    assert not same("first.bvh", "second.bvh")
    assert "--body of mocap convert chooses another" in run("graph both.bvh -o g.npz", 2).err


def test_positions_relative_to_the_offset_of_the_root_are_told_and_a_graph_remembers_them(folder, run):
    load_save.save(resample(samples.sample("walk_straight"), 30), "walk.bvh")
    with_offset(Path("walk.bvh"), np.array([0.0, 93.0, 0.0]), relative=True)
    told = run("info walk.bvh")
    assert "space    1 cm a unit, y up, the root's OFFSET added" in told.out
    assert "the root's OFFSET added. --scale, --up and --root-offset overrule it." in told.err
    assert run("info walk.bvh --root-offset add").err == ""
    assert "under the floor" in run("info walk.bvh --root-offset ignore").out
    run("graph walk.bvh -o g.npz")
    assert "walked " in run("walk g.npz --random 2s -o w.bvh").out


def write_poses(path):
    """Write an AMASS archive without a frame rate."""
    np.savez(path, poses=np.zeros((60, 66)), trans=np.zeros((60, 3)))


def test_what_fails_names_options_not_arguments(folder, run):
    for name in ("rest/a.npz", "rest/b.npz"):
        (folder / "rest").mkdir(exist_ok=True)
        write_poses(name)
    for line in ("convert rest/a.npz arm.glb", "convert rest out", "judge rest", "info rest/a.npz"):
        said = run(line, 2)
        assert "a.npz: expected 'mocap_framerate', got none: give --read-fps" in said.out + said.err


def test_a_remedy_that_a_command_lacks_is_another_command(folder, run):
    """`mocap graph --fps` is the rate of the graph, not of its clips."""
    write_poses("a.npz")
    for line in ("graph a.npz -o g.npz", "find a.npz a.npz"):
        assert run(line, 2).err.endswith("'mocap_framerate', got none: give --read-fps to mocap convert\n")


def test_the_former_name_of_the_rate_that_is_read_warns(folder, run):
    said = run("convert clips/a.bvh slow.bvh --fps 15")
    assert "--fps is read as --read-fps, which does not resample; mocap cut --rate resamples." in said.err
    assert load_save.load("slow.bvh").fps == 15.0 and len(load_save.load("slow.bvh")) == 40
    assert run("convert clips/a.bvh slow.bvh --read-fps 15").err == ""
    assert "give --read-fps alone" in run("info clips/a.bvh --fps 15 --read-fps 15", 2).err


def test_info_says_that_the_rate_of_an_amc_is_assumed(folder, run):
    write_acclaim(wave(3), folder / "clips" / "c.amc")
    said = "assumed  120 Hz, as an .amc says no rate; --read-fps (once --fps) sets another"
    assert said in run("info clips/c.amc").out
    assert "assumed" not in run("info clips/c.amc --read-fps 60").out
    assert "assumed" not in run("info clips/a.bvh").out


def test_a_folder_with_one_bad_file_is_read_without_it_and_that_is_said(folder, run):
    bad = folder / "clips" / "more" / "bad.bvh"
    bad.write_text("HIERARCHY\n")
    graph = "graph clips --threshold 50 --whole -o graph.npz"
    said = run(graph)
    assert "Left out: " in said.err and "bad.bvh" in said.err
    assert run("graph info graph.npz").out.count("clip ") == 2
    run(f"{graph} {bad}", 2)
    for name in ("a.bvh", "more/b.BVH"):
        (folder / "clips" / name).unlink()
    assert "Left out" not in run(graph, 2).err
    for number in range(5):
        bad.with_name(f"{number}.bvh").write_text("ROOT\n")
    load_save.save(wave(40, name="a"), folder / "clips" / "a.bvh")
    assert "Left out: 3 more files" in run(graph).err


def test_clips_of_one_name_in_several_folders_are_told_apart(folder, run):
    for name in ("01", "02"):
        (folder / "set" / name).mkdir(parents=True)
    for name, seed in (("01", 1), ("02", 2)):
        load_save.save(wave(40 + seed), folder / "set" / name / "walk.bvh")
    run("graph set --threshold 50 --whole -o graph.npz")
    assert re.findall(r"clip +(\S+): (\d+) frames", run("graph info graph.npz").out) == [
        ("01-walk", "41"),
        ("02-walk", "42"),
    ]
    run("walk graph.npz --random 0.2s -o walk.bvh")
    run("walk graph.npz --clips set --random 0.2s -o again.bvh")
    assert (folder / "walk.bvh").read_bytes() == (folder / "again.bvh").read_bytes()


def test_plans_that_make_no_sense_are_refused(folder, run):
    (folder / "empty").mkdir()
    assert "holds no .amc (with .asf), .bvh" in run("convert empty out", 2).err
    write_acclaim(wave(20), folder / "clips" / "a.amc")
    refused(r"a.amc and .*a.bvh would both become .*a.bvh", conversion.plan, "clips", "out")


def test_an_interruption_ends_the_conversion(folder):
    def interrupt(items):
        yield items[0]
        raise KeyboardInterrupt

    pairs = conversion.plan("clips", "out")
    with pytest.raises(KeyboardInterrupt):
        conversion.convert(pairs, load_save.load, progress=interrupt)


def die(*_):
    os._exit(1)


def test_a_worker_that_dies_is_told(folder, monkeypatch):
    monkeypatch.setattr(conversion, "_convert", die)
    pairs = conversion.plan("clips", "out")
    refused("ended from outside: is there enough memory", conversion.convert, pairs, load_save.load)


def test_the_list_of_data(run):
    told = run("data list --subject 127 --kind walk").out
    assert "127_04" in told and "127_03" not in told
    assert "may not resell" in told.replace("\n", " ")


def test_judge_ranks_files_and_names_what_it_could_not(folder, run):
    walk = resample(samples.sample("walk_straight"), 30)[:200]
    load_save.save(walk, "good.bvh")
    load_save.save(replace(walk, root_positions=walk.root_positions * [0.7, 1, 0.7]), "glides.bvh")
    load_save.save(concatenate([walk[:90], walk[120:]]), "cut.bvh")
    Path("broken.bvh").write_text("HIERARCHY")
    Path("path.csv").write_text("0,0\n0,9\n")
    head, *rows = run("judge glides.bvh cut.bvh good.bvh --path path.csv").out.splitlines()
    assert head.split()[:4] == ["name", "score", "height", "jolt"]
    assert {"path", "bones", "size"} <= set(head.split())
    assert rows[0].split()[:2] == ["good", "0.0"]
    assert {row.split()[0] for row in rows[1:]} == {"glides", "cut"}
    said = run("judge cut.bvh good.bvh clips/a.bvh broken.bvh --json", 2)
    found = {row["name"]: row for row in json.loads(said.out)}
    assert set(found) == {"good", "cut", "a"}
    assert found["good"]["score"] == 0 < found["cut"]["score"]
    assert "broken.bvh: expected a line 'MOTION'" in said.err
    assert "feet and knees: No legs found" in said.err
    (against,) = json.loads(run("judge cut.bvh --against good.bvh --json").out)
    ratios = {row["name"]: row["ratio"] for row in against["measures"] if row["ratio"] > 1}
    assert {"jolt", "cut"} <= set(ratios)
    assert run("judge broken.bvh", 2).out == ""


def test_judge_shows_bones_that_stretch_and_looks_into_folders(tmp_path, run):
    """A file whose bones stretch beyond what `load` fits is judged all the same, and says so."""
    path = tmp_path / "deep" / "stretched.bvh"
    path.parent.mkdir()
    path.write_text(six_channels(*chain(0.058)))
    refused(r"'spine' in one place below its parent, but for 0.02 m", load_save.load, path)
    said = run(f"judge {tmp_path} --json")
    (judged,) = json.loads(said.out)
    (bones,) = (row for row in judged["measures"] if row["name"] == "bones")
    assert bones["value"] == pytest.approx(58) and bones["where"] == "'spine'"
    assert judged["score"] > 3 and judged["height"] == pytest.approx(0.829, abs=1e-3)
    assert judged["bones"]["head"] == pytest.approx(0.4)
    assert "bones change length by up to 58 mm" in said.err
    assert load_save.read(path, None, None, None, math.inf).stretch["head"] == 0
    refused("stretch must be 0 or more metres, got nan", load_save.load, path, stretch=float("nan"))


@pytest.fixture
def walks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walks").mkdir()
    for name in ("walk_straight", "stop_and_go"):
        load_save.save(resample(samples.sample(name), 60)[:600], f"walks/{name}.bvh")
    return "find walks/walk_straight.bvh:120-185"


def test_matches_are_listed_and_cut_out_as_files(walks, run):
    told = run(f"{walks} walks --below 4 -o out")
    head, *rows, found, wrote = told.out.splitlines()
    assert head.split() == ["clip", "frames", "seconds", "cm", "step"]
    assert found == f"found        {len(rows)} in 2 clips" and len(rows) >= 6
    assert wrote == f"wrote        {len(rows)} files to out"
    names = set()
    for row in rows:
        clip, frames, seconds, cost, step = row.split()
        first, last = map(int, frames.split("-"))
        assert float(seconds) == pytest.approx((last - first) / 60, abs=0.01)
        assert 0 < float(cost) <= 4 and int(step) >= 1
        names.add(f"{clip}_{frames}.bvh")
        assert len(load_save.load(f"out/{clip}_{frames}.bvh")) == last - first
    assert {path.name for path in Path("out").iterdir()} == names
    assert told.err == ""


def test_a_query_from_elsewhere_is_not_among_its_matches(walks, run):
    told = run(f"{walks} walks/stop_and_go.bvh").out
    assert "walk_straight" not in told and "stop_and_go" in told and "wrote" not in told


def test_a_query_that_finds_nothing_says_so(walks, run):
    told = run(f"{walks} walks --below 0.01")
    assert told.out.splitlines()[-1] == "found        0 in 0 clips"
    assert "only itself" in told.err


# .npz and .csv ----------------------------------------------------------------------------------------------


def test_convert_to_arrays_and_tables_and_back(folder, run):
    assert run("convert clips/a.bvh -o a.npz").out == "converted    1 of 1 to a.npz\n"
    run("convert a.npz back.bvh")
    run("convert a.npz a.csv")
    assert same("back.bvh", "clips/a.bvh")
    assert load_save.load("a.npz").name == "a"
    assert np.array_equal(load_save.load("a.npz").rotations, load_save.load("clips/a.bvh").rotations)
    header, *rows = (folder / "a.csv").read_text("utf-8").splitlines()
    assert header.startswith("time,root_x,root_y,root_z,") and len(rows) == 40
    for suffix in ("npz", "csv"):
        run(f"convert clips out --to {suffix}")
        assert sorted(path.name for path in (folder / "out").rglob(f"*.{suffix}")) == [
            f"a.{suffix}",
            f"b.{suffix}",
        ]


def test_other_commands_write_and_read_arrays(folder, run):
    clip = replace(wave(40), labels={"walk": np.arange(40) > 20})
    load_save.save(clip, "a.npz")
    run("cut a.npz --from 10 -o cut.npz")
    cut = load_save.load("cut.npz")
    assert len(cut) == 30 and cut.labels["walk"].sum() == 19 and cut.contacts.keys() == clip.contacts.keys()
    (folder / "set").mkdir()
    for number in range(2):
        clip = replace(wave(90, seed=number), labels={"walk": True})
        load_save.save(clip, f"set/{number}.npz")
    run("graph set --threshold 50 -o set/graph.npz")
    run("walk set/graph.npz --random 0.2s -o walk.npz")
    assert "walk" in load_save.load("walk.npz").labels
    run("walk set/graph.npz --random 0.2s -o walk.csv")
    assert (folder / "walk.csv").read_text("utf-8").startswith("time,root_x")


def test_a_file_that_is_read_is_not_replaced_by_a_table_or_an_archive(folder, run):
    run("graph clips --threshold 50 --whole -o graph.npz")
    before = (folder / "graph.npz").read_bytes()
    assert "is one of the files to read" in run("walk graph.npz --random 1s -o graph.npz", 2).err
    assert (folder / "graph.npz").read_bytes() == before


@pytest.mark.parametrize("line", ["convert {} out.{}", "cut {} -o out.{}"])
@pytest.mark.parametrize("suffix", ["bvh", "npz"])
def test_plain_names_are_written_on_request(folder, run, line, suffix):
    skeleton = replace(wave(9).skeleton, names=["rig:hips", "rig.hips", "a b", "side"])
    load_save.save(replace(wave(9), skeleton=skeleton, contacts={}), "odd.bvh")
    run(line.format("odd.bvh", suffix))
    assert "rig:hips" in load_save.load(f"out.{suffix}").skeleton.names
    run(f"{line.format('odd.bvh', suffix)} --plain-names")
    names = load_save.load(f"out.{suffix}").skeleton.names
    assert sorted(names) == ["a_b", "righips", "righips_2", "side"]


def test_plain_names_of_a_folder(folder, run):
    (folder / "in").mkdir()
    skeleton = replace(wave(9).skeleton, names=["rig:hips", "b", "c", "d"])
    for name in ("a", "b"):
        load_save.save(replace(wave(9), skeleton=skeleton, contacts={}), f"in/{name}.bvh")
    run("convert in out --to glb --plain-names")
    for name in ("a", "b"):
        assert b'"righips"' in (folder / "out" / f"{name}.glb").read_bytes()


# JSON -------------------------------------------------------------------------------------------------------

# The keys of a clip, which `mocap/STABLE.md` promises.
KEYS = ["file", "name", "frames", "fps", "duration", "joints", "labels", "contacts", "height"]
KEYS += ["heading_change", "path", "flaws", "scale", "up", "doubt", "assumed"]


def document(text):
    """Parse JSON strictly: without NaN, and without a key that comes twice."""

    def pairs(items):
        assert len(dict(items)) == len(items)
        return dict(items)

    return json.loads(text, object_pairs_hook=pairs, parse_constant=lambda name: pytest.fail(name))


def test_info_as_json_has_the_same_keys_for_a_file_and_a_folder(folder, run):
    (folder / "clips" / "bad.bvh").write_text("HIERARCHY\n")
    (folder / "clips" / "worse.npz").write_bytes(b"PK")
    write_acclaim(wave(3), folder / "clips" / "Füße.amc")
    clip = replace(wave(20, name="hand made"), labels={"walk": True})
    load_save.save(clip, "clips/c.npz")
    said = run("info clips --json", 2)
    listed = document(said.out)
    assert list(listed) == ["clips", "failed"]
    assert [row["file"] for row in listed["clips"]] == [
        str(Path("clips", *parts)) for parts in (["Füße.amc"], ["a.bvh"], ["c.npz"], ["more", "b.BVH"])
    ]
    assert all(list(row) == KEYS for row in listed["clips"])
    amc, bvh, npz, _ = listed["clips"]
    assert amc["assumed"].startswith("120 Hz, as an .amc says no rate; --read-fps")
    assert (bvh["frames"], bvh["fps"], bvh["joints"], bvh["scale"]) == (40, 30.0, 4, 0.01)
    assert (npz["name"], npz["labels"], npz["contacts"]) == ("hand made", ["walk"], ["hand"])
    assert (npz["scale"], npz["up"]) == (None, None)
    failed, damaged = listed["failed"]
    assert damaged["file"] == str(Path("clips", "worse.npz")) and "a damaged one" in damaged["error"]
    assert failed == {
        "file": str(Path("clips", "bad.bvh")),
        "error": f"{failed['file']}: expected a line 'MOTION', got none",
    }
    assert failed["error"] in said.err
    alone = run("info clips/a.bvh --json")
    assert document(alone.out) == {"clips": [bvh], "failed": []} and alone.err == ""


def test_info_as_json_has_stretches_of_flaws(folder, run):
    frozen = concatenate([wave(20), *[wave(1)] * 9])
    load_save.save(frozen, "clips/frozen.bvh")
    (row,) = document(run("info clips/frozen.bvh --json").out)["clips"]
    flaws = {flaw["kind"]: flaw for flaw in row["flaws"]}
    assert list(flaws["frozen"]) == ["kind", "stretches", "detail"]
    assert flaws["frozen"]["stretches"] == [[21, 29]]


def test_info_as_json_of_a_single_frame_and_of_odd_names(folder, run):
    load_save.save(wave(1, name="é\n\x1b[31m"), "clips/one.npz")
    (row,) = document(run("info clips/one.npz --json").out)["clips"]
    assert (row["frames"], row["duration"], row["path"]) == (1, 0.0, 0.0)
    assert row["name"] == "é\n\x1b[31m"


def test_a_folder_of_bad_files_is_a_document_too(folder, run):
    (folder / "bad").mkdir()
    (folder / "bad" / "a.bvh").write_text("ROOT\n")
    listed = document(run("info bad --json", 2).out)
    assert listed["clips"] == [] and len(listed["failed"]) == 1


def test_the_promised_keys_are_those_of_the_page():
    page = (Path(conversion.__file__).parents[1] / "STABLE.md").read_text("utf-8")
    table = page.split("## JSON of `mocap info --json`")[1].split("## ")[0]
    named = [
        name
        for row in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", row)
    ]
    assert named == KEYS


def test_several_clips_are_shown_beside_or_upon_each_other_with_their_names(folder, run):
    clips = folder / "clips"
    (clips / "more" / "b.BVH").rename(clips / "b.bvh")
    motions = [load_save.load(clips / f"{name}.bvh") for name in "ab"]
    apart, together = (arranged(motions, layout) for layout in ("beside", "upon"))
    starts = [[motion.root_positions[0, [0, 2]] for motion in placed] for placed in (apart, together)]
    assert np.allclose(np.subtract(*starts[0]), (1.2, 0)) and np.allclose(starts[1], 0)
    assert arranged(motions, "as-is") == motions
    run("view clips/a.bvh clips/b.bvh --camera 90 -o both.html")
    page = (folder / "both.html").read_text("utf-8")
    assert all(text in page for text in ('"name":"a"', '"name":"b"', f'"yaw":{math.pi / 2}'))
    run("view clips/a.bvh clips/b.bvh --size 160x90 --rate 5 -o both.gif")
    with Image.open(folder / "both.gif") as film:
        assert film.size == (160, 90) and film.n_frames > 4
