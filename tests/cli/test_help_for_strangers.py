"""What a person who knows none of it is shown: examples, names of joints, doubts, arguments as options."""

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.files import load_save
from tests.strategies import wave

COMMANDS = ["graph", "walk", "blend", "judge", "convert", "warp", "bend", "loop", "find", "retarget", "crowd"]


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_gives_an_example(capsys, command):
    with pytest.raises(SystemExit, match="0"):
        main([command, "--help"])
    assert f"Example: mocap {command} " in " ".join(capsys.readouterr().out.split())


def test_info_lists_the_joints_where_they_are_asked_for(clips, capsys):
    assert main(["info", str(clips / "a.bvh"), "--joints"]) == 0
    told = capsys.readouterr().out.splitlines()
    names = wave(120).skeleton.names
    assert [line.strip() for line in told[-len(names) :]] == list(names)
    assert told[-len(names)] == names[0]
    assert told[-len(names) + 1] == f"  {names[1]}"


def test_info_asks_for_the_unit_of_a_body_of_two_centimetres(clips, capsys):
    assert main(["info", str(clips / "a.bvh"), "--scale", "0.0001"]) == 0
    assert "m: is its scale right?" in capsys.readouterr().out
    assert main(["info", str(clips / "a.bvh")]) == 0
    assert "scale" not in capsys.readouterr().out


LINES = [
    "graph . -o g.npz",
    "loop a.bvh",
    "blend a.bvh b.bvh",
    "find a.bvh:0-30 .",
    "bend walk.bvh --along l.csv -o w.bvh",
]


@pytest.mark.parametrize("line", LINES)
def test_a_body_of_millimetres_is_doubted(line, clips, capsys, monkeypatch):
    """A file in metres is read as centimetres, and then all that is measured in metres is small enough."""
    monkeypatch.chdir(clips)
    if line.startswith("bend"):
        load_save.save(samples.sample("walk_straight")[:240], "walk.bvh")
        (clips / "l.csv").write_text("0,0\n0,0.01\n")
    main([*line.split(), "--scale", "0.0001"])
    assert "m tall: is its scale right?" in capsys.readouterr().err


def test_a_body_to_wear_of_millimetres_is_doubted(clips, capsys):
    load_save.save(samples.sample("walk_straight")[:240], clips / "walk.bvh")
    line = ["retarget", str(clips / "walk.bvh"), "--to", str(clips / "walk.bvh"), "-o", str(clips / "worn")]
    assert main([*line, "--to-scale", "0.0001"]) == 0
    assert "'walk' is 0.017 m tall: is its scale right?" in capsys.readouterr().err


def test_a_name_that_no_joint_has_is_answered_by_the_likest(clips, capsys):
    names = wave(120).skeleton.names
    (clips / "keys.txt").write_text(f"at 1 x{names[-1].upper()} 0 0 0\n")
    words = ["warp", "a.bvh", "--keys", "keys.txt", "-o", "out.bvh", "--loose-feet"]
    assert main([str(clips / word) if "." in word else word for word in words]) == 2
    assert f"expected a joint, one of {names[-1]}, " in capsys.readouterr().err


def test_what_fails_names_options_not_arguments(clips, capsys):
    problem = "'arm' does not fit: use widen=True without skeleton=, or a .bvh file"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mocap.files.convert", lambda *_: [type("Outcome", (), {"problem": problem})()])
        assert main(["convert", str(clips / "a.bvh"), str(clips / "arm.amc")]) == 2
    assert "use --widen without --skeleton, or a .bvh file" in capsys.readouterr().out


def lopsided(name):
    names = ["root", "lfemur", "ltibia", "rfemur", "rtibia"]
    places = [[0, 0.9, 0], [0.1, 0, 0], [0, -0.4, 0], [-0.1, 0, 0], [0, -0.45, 0]]
    body = Skeleton(names, [-1, 0, 1, 0, 3], places)
    angles = 0.5 * np.sin(np.arange(120) / 8)
    turned = np.tile(rotations.IDENTITY, (120, 5, 1))
    turned[:, 1], turned[:, 3] = rotations.about_y(angles), rotations.about_y(-angles)
    roots = np.stack([0 * angles, 0 * angles + 0.9, np.arange(120) / 60], axis=1)
    return Motion(body, roots, turned, 30.0, name)


def test_one_warning_says_that_a_body_is_lopsided(tmp_path, capsys):
    for name in ("a", "b", "c"):
        load_save.save(lopsided(name), tmp_path / f"{name}.bvh")
    files = [str(tmp_path / f"{name}.bvh") for name in ("a", "b", "c")]
    graph = str(tmp_path / "graph.npz")
    assert main(["graph", *files, "--mirror", "-o", graph]) == 0
    (told,) = capsys.readouterr().err.splitlines()
    assert "left and right bones differ by up to 50 mm" in told
    assert told.endswith("So it is with 2 more.")
    assert len(told) <= 200
    for more in ([], ["--clips", *files]):
        assert main(["walk", graph, "--random", "2s", "-o", str(tmp_path / "new.bvh"), *more]) == 0
        assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("held", "shortest", "said"),
    [(0, "1.5", "cm apart: it may leap there."), (60, "0.4", "away: it may hold no whole cycle.")],
)
def test_a_loop_that_leaps_or_holds_a_pose_is_a_warning(held, shortest, said, tmp_path, capsys):
    """Of an arm that swings once, and rises where it was held for some frames before."""
    body = Skeleton(["root", "arm", "hand"], [-1, 0, 1], [[0, 1, 0], [0.1, 0, 0], [0.6, 0, 0]])
    count = 30 if held else 60
    turned, roots = np.tile(rotations.IDENTITY, (held + count, 3, 1)), np.zeros((held + count, 3))
    turned[held:, 1] = rotations.about_y(np.linspace(0, 3, count))
    roots[held:, 1] = np.linspace(0, held / 60, count)
    load_save.save(Motion(body, roots, turned, 30.0, "arm"), tmp_path / "arm.bvh")
    words = ["loop", str(tmp_path / "arm.bvh"), "--shortest", shortest, "-o", str(tmp_path / "out.bvh")]
    assert main(words) == 0
    assert said in capsys.readouterr().err


def test_bodies_that_differ_are_one_short_sentence_that_says_what_to_do(tmp_path, capsys):
    for name in ("one_who_walks", "one_who_runs"):
        names = ["root", *(f"{name}_joint_{joint}" for joint in range(20))]
        body = Skeleton(names, range(-1, 20), np.tile([0, 0.1, 0], (21, 1)))
        turned = np.tile(rotations.IDENTITY, (60, 21, 1))
        load_save.save(Motion(body, np.zeros((60, 3)), turned, 30.0, name), tmp_path / f"{name}.bvh")
    files = [str(tmp_path / f"{name}.bvh") for name in ("one_who_walks", "one_who_runs")]
    assert main(["blend", *files, "-o", str(tmp_path / "out.bvh")]) == 2
    told = capsys.readouterr().err
    assert "Retarget one first." in told
    assert len(told) <= 200
