"""`mocap info`, `mocap convert` and `mocap data`, as a person types them, and `files.conversion`."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.motion import concatenate, resample
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.errors import MocapError
from mocap.files import conversion, load_save
from tests.strategies import wave


@pytest.fixture
def clips(tmp_path):
    folder = tmp_path / "clips"
    (folder / "more").mkdir(parents=True)
    load_save.save(wave(40, name="a"), folder / "a.bvh")
    load_save.save(wave(30, name="b"), folder / "more" / "b.BVH")
    return folder


def same(one, other):
    names = ["root", "elbow", "hand", "side"]
    a, b = (
        joint_positions(m)[:, [m.skeleton.index(n) for n in names]] for m in map(load_save.load, (one, other))
    )
    return np.abs(a - b).max() < 1e-6


def test_info(clips, capsys):
    assert main(["info", str(clips / "a.bvh"), "--fps", "60"]) == 0
    told = capsys.readouterr().out
    assert "40 at 60 Hz, 0.65 s" in told
    assert "flaws " in told
    assert main(["info", str(clips / "gone.bvh")]) == 2
    assert capsys.readouterr().err.startswith("mocap: Cannot read")


@pytest.mark.parametrize("first", ["amc", "bvh"])
@pytest.mark.parametrize("second", ["amc", "bvh"])
def test_convert_every_pair(clips, tmp_path, first, second, capsys):
    start, one, other = clips / "a.bvh", tmp_path / f"one.{first}", tmp_path / f"other.{second.upper()}"
    assert main(["convert", str(start), str(one)]) == 0
    assert main(["convert", str(one), str(other)]) == 0
    assert same(start, other)
    assert load_save.load(other).fps == 30.0
    assert capsys.readouterr().out.endswith("converted    1 of 1\n")


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_convert_from_amass_and_to_gltf(tmp_path, capsys):
    clip, frames = tmp_path / "clips" / "walk.npz", 5
    clip.parent.mkdir()
    poses = np.random.default_rng(0).normal(size=(frames, 66))
    np.savez(clip, poses=poses, trans=np.zeros((frames, 3)), betas=np.ones(10), mocap_framerate=60.0)
    assert main(["convert", str(clip.parent), str(tmp_path / "out"), "--to", "glb"]) == 0
    assert (tmp_path / "out" / "walk.glb").read_bytes()[:4] == b"glTF"
    assert main(["convert", str(clip), str(tmp_path / "walk.bvh")]) == 0
    assert "betas, the shape of the body, are ignored" in capsys.readouterr().err
    ours, theirs = load_save.load(tmp_path / "walk.bvh"), load_save.load(clip)
    order = [ours.skeleton.index(name) for name in theirs.skeleton.names]
    assert np.abs(joint_positions(ours)[:, order] - joint_positions(theirs)).max() < 1e-6
    assert main(["info", str(clip)]) == 0


def test_convert_a_folder_and_name_what_failed(clips, tmp_path, capsys):
    (clips / "broken.bvh").write_text("HIERARCHY\n")
    (clips / "notes.txt").write_text("no clip")
    assert main(["convert", str(clips), str(tmp_path / "out"), "--to", "amc"]) == 2
    told = capsys.readouterr().out
    assert "converted    2 of 3\n" in told
    assert f"failed       {clips / 'broken.bvh'}: expected a line 'MOTION'" in told
    made = sorted(str(p.relative_to(tmp_path / "out")) for p in (tmp_path / "out").rglob("*.*"))
    assert made == ["a.amc", "a.asf", "more/b.amc", "more/b.asf"]
    assert same(tmp_path / "out/more/b.amc", clips / "more/b.BVH")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["{clips}/a.bvh", "{clips}/a.fbx"], "mocap writes .amc"),
        (["{clips}/a.bvh", "{clips}/a.bvh/b.bvh"], "Cannot make the folder"),
        (["{clips}/gone.bvh", "{clips}/b.bvh"], "Cannot read"),
    ],
)
def test_a_single_failure_is_a_failure(clips, capsys, arguments, message):
    assert main(["convert", *[argument.format(clips=clips) for argument in arguments]]) == 2
    assert message in capsys.readouterr().out


def test_plans_that_make_no_sense_are_refused(clips, tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    assert main(["convert", str(tmp_path / "empty"), str(tmp_path / "out")]) == 2
    assert "holds no .amc, .bvh or AMASS .npz file" in capsys.readouterr().err
    load_save.save(wave(20), clips / "a.amc")
    with pytest.raises(MocapError, match=r"a.amc and .*a.bvh would both become .*a.bvh"):
        conversion.plan(clips, tmp_path / "out")


def test_an_interruption_ends_the_conversion(clips, tmp_path):
    def interrupt(items):
        yield items[0]
        raise KeyboardInterrupt

    pairs = conversion.plan(clips, tmp_path / "out")
    with pytest.raises(KeyboardInterrupt):
        conversion.convert(pairs, conversion.Options(), interrupt)


def die(*_):
    os._exit(1)


def test_a_worker_that_dies_is_told(clips, tmp_path, monkeypatch):
    monkeypatch.setattr(conversion, "_convert", die)
    with pytest.raises(MocapError, match="ended from outside: is there enough memory"):
        conversion.convert(conversion.plan(clips, tmp_path / "out"), conversion.Options())


def test_real_folders(real_data, tmp_path):
    pairs = conversion.plan(real_data / "odd", tmp_path, ".bvh")
    outcomes = conversion.convert(pairs, conversion.Options())
    assert len(outcomes) == len(pairs) == 10
    for outcome in outcomes:
        assert (outcome.problem is None) == outcome.target.exists()
    good = {outcome.source.name for outcome in outcomes if outcome.problem is None}
    assert good == {"16_12.amc", "16_15.amc", "11_01_fb_comment.amc"}


def test_the_list_of_data(capsys):
    assert main(["data", "list", "--subject", "127", "--kind", "walk"]) == 0
    told = capsys.readouterr().out
    assert "127_04" in told
    assert "127_03" not in told
    assert "may not resell" in told.replace("\n", " ")
    assert main(["data", "list", "--subject", "5"]) == 2
    assert "No trial of subject 5" in capsys.readouterr().err


def test_judge_ranks_files_and_names_what_it_could_not(clips, tmp_path, capsys):
    walk = resample(samples.sample("walk_straight"), 30)[:200]
    load_save.save(walk, tmp_path / "good.bvh")
    gliding = replace(walk, root_positions=walk.root_positions * [0.7, 1, 0.7])
    load_save.save(gliding, tmp_path / "glides.bvh")
    load_save.save(concatenate([walk[:90], walk[120:]]), tmp_path / "cut.bvh")
    (tmp_path / "broken.bvh").write_text("HIERARCHY")
    (tmp_path / "path.csv").write_text("0,0\n0,9\n")
    names = [str(tmp_path / f"{name}.bvh") for name in ("glides", "cut", "good")]
    assert main(["judge", *names, "--path", str(tmp_path / "path.csv")]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head.split()[:4] == ["name", "score", "height", "jolt"]
    assert {"path", "bones", "size"} <= set(head.split())
    assert rows[0].split()[:2] == ["good", "0.0"]
    assert {row.split()[0] for row in rows[1:]} == {"glides", "cut"}
    assert main(["judge", *names, str(clips / "a.bvh"), str(tmp_path / "broken.bvh"), "--json"]) == 2
    said = capsys.readouterr()
    found = {row["name"]: row for row in json.loads(said.out)}
    assert set(found) == {"good", "glides", "cut", "a"}
    assert found["good"]["score"] == 0 < found["cut"]["score"]
    assert "broken.bvh: expected a line 'MOTION'" in said.err
    assert "feet and knees: No legs found" in said.err
    assert main(["judge", names[1], "--against", names[2]]) == 0
    assert "jolt" in capsys.readouterr().out.splitlines()[1].split("0.0")[-1]
    assert main(["judge", str(tmp_path / "broken.bvh")]) == 2
    assert capsys.readouterr().out == ""


STRETCHING = """HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
JOINT Leg
{
OFFSET 0 -90 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 0 10
}
}
JOINT Spine
{
OFFSET 0 50 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 30 0
}
}
}
MOTION
Frames: 30
Frame Time: 0.0333333
"""


def test_judge_shows_bones_that_stretch_and_looks_into_folders(tmp_path, capsys):
    """A file whose bones stretch beyond what `load` fits is judged all the same, and says so."""
    path = tmp_path / "deep" / "stretched.bvh"
    path.parent.mkdir()
    rows = [f"0 90 {frame} 0 0 0 0 0 0 0 {50 + frame / 5} 0 0 0 0\n" for frame in range(30)]
    path.write_text(STRETCHING + "".join(rows))
    with pytest.raises(MocapError, match=r"'Spine' in one place below its parent, but for 0.02 m"):
        load_save.load(path)
    assert main(["judge", str(tmp_path), "--json"]) == 0
    said = capsys.readouterr()
    (judged,) = json.loads(said.out)
    (bones,) = (row for row in judged["measures"] if row["name"] == "bones")
    assert bones["value"] == pytest.approx(58) and bones["where"] == "'Spine'"
    assert judged["score"] > 3 and judged["height"] == pytest.approx(1.729, abs=1e-3)
    assert judged["bones"]["Leg"] == pytest.approx(0.9)
    assert "bones change length by up to 58 mm" in said.err
    assert load_save.bone_stretch(path)["Leg"] == 0
    with pytest.raises(MocapError, match="stretch must be 0 or more metres, got nan"):
        load_save.load(path, stretch=float("nan"))
