"""`mocap retarget`, as a person types it."""

import numpy as np
import pytest

from mocap import load
from mocap.body.kinematics import joint_positions
from mocap.cli.main import main
from mocap.editing.copied_motion import copied
from mocap.editing.stances import stance_of
from mocap.files import load_save
from tests.cli.refused import check_refused
from tests.editing.bodies import adult, along_x, child, rested, walk


@pytest.fixture
def clips(tmp_path):
    """Give a folder with two clips of an adult; beside it, a child's walk and skeleton."""
    folder = tmp_path / "clips"
    folder.mkdir()
    load_save.save(walk()[:200], folder / "a.bvh")
    load_save.save(walk()[100:260], folder / "b.bvh")
    load_save.save(copied(walk(), adult(), child()), tmp_path / "child.amc", widen=True)
    return folder


def onto_the_child(clips, place):
    return ["retarget", str(clips), "--to", str(place / "child.amc"), "-o", str(place / "out")]


def written(folder):
    return sorted(path.name for path in folder.rglob("*") if path.is_file())


def test_a_folder_of_clips_on_the_body_of_a_clip(clips, tmp_path, capsys):
    assert main(onto_the_child(clips, tmp_path)) == 0
    assert capsys.readouterr().out == f"retargeted   2 of 2, in {tmp_path / 'out'}\n"
    assert written(tmp_path / "out") == ["a.bvh", "b.bvh"]
    worn = load(tmp_path / "out" / "a.bvh")
    assert len(worn) == 200
    assert stance_of(load(tmp_path / "out" / "b.bvh")).leg == pytest.approx(child().leg, abs=1e-5)
    ball = worn.skeleton.index("ltoes")
    standing = joint_positions(worn)[walk()[:200].contacts["ltoes"], ball, 1]
    assert np.ptp(standing) < 1e-4
    assert standing.mean() == pytest.approx(child().heights["left ball"], abs=0.003)


def test_a_skeleton_other_formats_and_longer_steps(clips, tmp_path):
    way = []
    for steps in ("1", "1.3"):
        out = tmp_path / steps
        words = ["retarget", str(clips / "a.bvh"), "--to", str(tmp_path / "child.asf"), "-o", str(out)]
        assert main([*words, "--format", "amc", "--widen", "--steps", steps]) == 0
        assert written(out) == ["a.amc", "a.asf"]
        way.append(np.ptp(load(out / "a.amc", fps=120).root_positions[:, 2]))
    assert way[1] == pytest.approx(1.3 * way[0], rel=0.02)


def test_what_fails_is_named_and_the_others_are_written(clips, tmp_path, capsys):
    (clips / "broken.bvh").write_text("HIERARCHY\n")
    assert main(onto_the_child(clips, tmp_path)) == 2
    told = capsys.readouterr().out
    assert told.startswith("retargeted   2 of 3, in ")
    assert f"failed       {clips / 'broken.bvh'}: expected" in told
    assert written(tmp_path / "out") == ["a.bvh", "b.bvh"]
    assert all(len(line) < 320 for line in told.splitlines())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["{clips}", "--to", "{up}/gone.bvh", "-o", "{up}/out"], "Cannot read"),
        (["{clips}", "--to", "{up}/child.asf", "-o", "{up}/out", "--to-scale", "2"], "--to-scale is"),
        (["{clips}", "--to", "{up}/flat.bvh", "-o", "{up}/out"], "flat.bvh: "),
        (["{clips}", "--to", "{clips}/a.bvh", "-o", "{clips}"], "is one of the files to read"),
        (["{clips}/a.bvh", "{up}/a.bvh", "--to", "{up}/child.asf", "-o", "{up}/out"], "both become"),
        (["{clips}", "--to", "{up}/child.asf", "-o", "{clips}/a.bvh/x"], "Cannot make the folder"),
        (["{clips}", "--to", "{up}/child.asf", "-o", "{up}/out", "--steps", "0"], "from 0.1 to 10"),
        (["{clips}", "--to", "{up}/child.asf"], "required: -o"),
    ],
)
def test_bad_input_is_one_sentence_and_nothing_is_written(clips, tmp_path, capsys, words, message):
    load_save.save(rested(walk(), along_x(walk().skeleton))[:4], tmp_path / "flat.bvh")
    words = [word.format(clips=clips, up=tmp_path) for word in words]
    check_refused(tmp_path, capsys, ["retarget", *words], message)


def test_a_rest_pose_that_does_not_stand_asks_for_a_clip(clips, tmp_path, capsys):
    load_save.save(rested(walk(), along_x(walk().skeleton)), tmp_path / "flat.amc", widen=True)
    words = ["retarget", str(clips / "a.bvh"), "-o", str(tmp_path / "out"), "--to"]
    assert main([*words, str(tmp_path / "flat.asf")]) == 2
    assert "does not stand" in capsys.readouterr().out
    assert not (tmp_path / "out").exists()
    assert main([*words, str(tmp_path / "flat.amc")]) == 0


def test_a_single_pose_says_whose_body_it_is(clips, tmp_path):
    load_save.save(copied(walk(), adult(), child())[:1], tmp_path / "pose.bvh")
    out = tmp_path / "out"
    assert main(["retarget", str(clips / "a.bvh"), "--to", str(tmp_path / "pose.bvh"), "-o", str(out)]) == 0
    assert stance_of(load(out / "a.bvh")).leg == pytest.approx(child().leg, abs=1e-5)


def test_an_interruption_leaves_whole_files_only(clips, tmp_path, monkeypatch, capsys):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("mocap.files.save", interrupt)
    assert main(onto_the_child(clips, tmp_path)) == 130
    assert "no half-written file" in capsys.readouterr().err
    assert written(tmp_path / "out") == []
