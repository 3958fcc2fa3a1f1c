"""`mocap crowd` writes motions, a plan and a film; what cannot be planned is said before it writes."""

import pytest
from PIL import Image

from mocap.cli.main import main
from mocap.cli.many_clips.crowd import _film
from mocap.files import load_save
from tests.strategies import wave


@pytest.fixture
def course(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "points.csv").write_text("x, z\n1, 7\n")
    (tmp_path / "discs.csv").write_text("x, z, radius\n-3, 5, 0.5\n")
    return tmp_path


def crowd(*more):
    words = ["crowd", "--members", "3", "--through", "points.csv", "--around", "discs.csv", "-o", "crowd"]
    return main([*words, *more])


def test_a_motion_for_each_member_a_plan_and_a_film(course, capsys, monkeypatch):
    monkeypatch.setattr("mocap.cli.many_clips.crowd.find_spec", lambda name: None)  # no imageio-ffmpeg
    assert crowd() == 0
    said = capsys.readouterr().out
    assert "for 3 members" in said and "3 characters" in said and "m apart at least" in said
    names = sorted(path.name for path in (course / "crowd").iterdir())
    assert names == ["crowd.gif", "member-01.bvh", "member-02.bvh", "member-03.bvh", "plan.png"]
    lengths = {len(load_save.load(course / "crowd" / name)) for name in names if name.startswith("member")}
    with Image.open(course / "crowd" / "crowd.gif") as film:
        assert film.n_frames == pytest.approx(max(lengths) * 12.5 / 30, abs=2)
    assert len(lengths) == 1


def test_the_film_is_an_mp4_where_that_can_be(tmp_path):
    pytest.importorskip("imageio_ffmpeg")
    _film([wave(30), wave(30, phase=1)], tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["crowd.mp4"]


@pytest.mark.parametrize(
    ("points", "discs", "sentence"),
    [
        ("1, 7, 3\n", "-3, 5, 0.5\n", "points.csv, line 1: expected x and z in each line"),
        ("1, 7\n", "-3, 5\n", "discs.csv, line 1: expected x, z and radius in each line"),
        ("1, 7\n", "0, 0.1, 0.5\n", "The group starts inside the obstacle at x=0, z=0.1"),
        ("1, 7\n", "0, 9, -1\n", "An obstacle has a centre and a radius above 0"),
        ("1, nan\n", "-3, 5, 0.5\n", "line 1"),
    ],
)
def test_bad_scenes_are_refused_and_nothing_is_written(course, capsys, points, discs, sentence):
    (course / "points.csv").write_text(points)
    (course / "discs.csv").write_text(discs)
    assert crowd("--no-film") == 2
    said = capsys.readouterr().err
    assert sentence in said and len(said.splitlines()) == 1
    assert not (course / "crowd").exists()


def test_a_goal_that_is_walled_in_is_said(course, capsys):
    ring = ["x, z, radius"]
    ring += [f"{3.5 * x:.3f}, {3.5 * z:.3f}, 0.8" for x, z in _circle(16)]
    (course / "discs.csv").write_text("\n".join(ring))
    assert crowd("--no-film") == 2
    assert "No way past point 1 of 1 was found" in capsys.readouterr().err
    assert not (course / "crowd").exists()


def _circle(count):
    from math import cos, pi, sin

    return [(cos(2 * pi * k / count), sin(2 * pi * k / count)) for k in range(count)]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--members", "1"], "2"),
        (["--skeleton", "walk.asf"], "--skeleton belongs to --graph"),
        (["--graph", "no.npz"], "no.npz"),
    ],
)
def test_bad_options_are_one_sentence(course, capsys, words, sentence):
    assert crowd(*words) != 0
    said = capsys.readouterr().err.strip()
    assert sentence in said and len(said.splitlines()) == 1 and len(said) <= 300


def test_a_graph_of_one_s_own_walks_as_glb(course):
    (course / "clips").mkdir()
    from mocap.body.motion import resample
    from mocap.datasets import samples

    for name in ("walk_curve_1", "walk_curve_2"):
        load_save.save(resample(samples.sample(name), 30), course / "clips" / f"{name}.bvh")
    assert main(["graph", "clips", "-o", "graph.npz"]) == 0
    assert crowd("--graph", "graph.npz", "--to", "glb", "--no-film") == 0
    assert sorted(path.suffix for path in (course / "crowd").iterdir()) == [".glb", ".glb", ".glb", ".png"]
