"""`mocap crowd` writes motions, a plan and a film; what cannot be planned is said before it writes."""

import numpy as np
import pytest
from PIL import Image

from mocap.body.motion import resample
from mocap.cli.crowd import _film, _plan, _write
from mocap.cli.main import main
from mocap.datasets import samples
from mocap.errors import NoWalk
from mocap.files import load_save
from mocap.methods.groups.group_graphs import Placed
from mocap.methods.groups.planning import plan_group
from mocap.methods.groups.scenes import Scene
from tests.cli.refused import check_refused
from tests.methods.groups.built import graph
from tests.strategies import wave


@pytest.fixture
def course(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "points.csv").write_text("x, z\n1, 7\n")
    (tmp_path / "discs.csv").write_text("x, z, radius\n-3, 5, 0.5\n")
    return tmp_path


CROWD = ["crowd", "--members", "3", "--through", "points.csv", "--around", "discs.csv", "-o", "crowd"]


def crowd(*more):
    return main([*CROWD, *more])


def test_a_motion_for_each_member_a_plan_and_a_film(course, capsys, monkeypatch):
    monkeypatch.setattr("mocap.cli.crowd.find_spec", lambda name: None)  # no imageio-ffmpeg
    assert crowd() == 0
    said = capsys.readouterr().out
    assert "for 3 members" in said and "3 characters" in said and "m apart at least" in said
    made = names(course / "crowd")
    assert made == ["crowd.gif", "member-01.bvh", "member-02.bvh", "member-03.bvh", "plan.png"]
    lengths = {len(load_save.load(course / "crowd" / name)) for name in made if name.startswith("member")}
    with Image.open(course / "crowd" / "crowd.gif") as film:
        assert film.n_frames == pytest.approx(max(lengths) * 12.5 / 30, abs=2)
    assert len(lengths) == 1


def test_the_film_is_an_mp4_where_that_can_be(tmp_path):
    pytest.importorskip("imageio_ffmpeg")
    _film([wave(30), wave(30, phase=1)], Scene((1 + 0j,), ((2 + 0j, 0.5),)), tmp_path / "crowd.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["crowd.mp4"]


def test_the_film_shows_the_obstacles(tmp_path):
    scene = Scene((1 + 0j,), ((0.3 + 0.5j, 0.5),))
    for name, shown in (("bare", Scene((1 + 0j,))), ("obstacle", scene)):
        _film([wave(9), wave(9, phase=1)], shown, tmp_path / f"{name}.gif")
    bare, obstacle = (
        np.asarray(Image.open(tmp_path / f"{name}.gif").convert("L")) for name in ("bare", "obstacle")
    )
    assert (bare.astype(int) - obstacle > 60).mean() > 0.01


def write(folder, members, *, to="bvh", no_film=True):
    motions = [wave(10, phase=number) for number in range(members)]
    places = np.linspace(0, 1, 9)[:, None] + np.zeros(members)
    _write(motions, places, Scene((1 + 0j,)), folder, to, no_film=no_film)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_smaller_crowd_leaves_no_members_of_an_earlier_one_and_all_other_files(tmp_path, capsys):
    for own in ("member-04.bvh", "member-06.glb", "notes.txt"):
        (tmp_path / own).write_text("one's own")
    write(tmp_path, 3)
    write(tmp_path, 2, to="glb")
    assert capsys.readouterr().out == "removed      3 of the files of an earlier crowd\n"
    left = ["member-01.glb", "member-02.glb", "member-04.bvh", "member-06.glb", "notes.txt", "plan.png"]
    assert names(tmp_path) == left
    (tmp_path / "member-03.bvh").write_text("one's own, where an earlier crowd had a file")
    write(tmp_path, 2, to="glb")
    assert names(tmp_path) == sorted([*left, "member-03.bvh"])


def test_a_plan_that_is_no_crowd_s_lets_nothing_be_removed(tmp_path):
    (tmp_path / "plan.png").write_bytes(b"member-05.bvh\n\xff")
    (tmp_path / "member-05.bvh").write_text("one's own")
    write(tmp_path, 2)
    assert names(tmp_path) == ["member-01.bvh", "member-02.bvh", "member-05.bvh", "plan.png"]


@pytest.mark.parametrize("fails", ["files.save", "cli.crowd._film"])
def test_when_it_is_interrupted_nothing_is_lost_and_the_next_crowd_tidies_up(tmp_path, monkeypatch, fails):
    """Until all motions are whole the old crowd stays; until the film is whole, the old film and members."""
    monkeypatch.setattr("mocap.cli.crowd._film", lambda motions, scene, path: path.write_text("a film"))
    write(tmp_path, 4, no_film=False)
    old = {name: (tmp_path / name).read_bytes() for name in names(tmp_path)}

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(f"mocap.{fails}", interrupted)
        with pytest.raises(KeyboardInterrupt):
            write(tmp_path, 3, to="glb", no_film=False)
    new = [f"member-{number:02}.glb" for number in (1, 2, 3)] if "_film" in fails else []
    assert names(tmp_path) == sorted([*old, *new])
    kept = [name for name in old if name != "plan.png" or not new]
    assert all((tmp_path / name).read_bytes() == old[name] for name in kept)
    write(tmp_path, 2)
    assert names(tmp_path) == ["member-01.bvh", "member-02.bvh", "plan.png"]


def test_where_the_way_to_the_first_point_is_closed_it_sets_out_to_a_side():
    group, scene = graph(3), Scene((20j,), ((3.4j, 1.3),))
    with pytest.raises(NoWalk, match="closed every way"):
        plan_group(group, scene, start=Placed(0, 1j))
    start, found = _plan(group, scene)
    assert abs(np.angle(start.turn / 1j)) == pytest.approx(0.5) and found.clips


def test_sides_are_not_searched_for_long_where_the_way_ahead_is_only_long(monkeypatch):
    asked = []

    def refuse(group, scene, *, start, most=4000):
        asked.append(most)
        raise NoWalk(f"refused {len(asked)}")

    monkeypatch.setattr("mocap.methods.groups.plan_group", refuse)
    with pytest.raises(NoWalk, match="refused 1"):
        _plan(graph(3), Scene((20j,)))
    assert asked == [4000, 400, 400, 400, 400]


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
    check_refused(course, capsys, [*CROWD, "--no-film"], sentence)


def test_a_goal_that_is_walled_in_is_said(course, capsys):
    ring = 3.5 * np.exp(2j * np.pi * np.arange(16) / 16)
    (course / "discs.csv").write_text("\n".join(f"{at.real:.3f}, {at.imag:.3f}, 0.8" for at in ring))
    check_refused(course, capsys, [*CROWD, "--no-film"], "No way past point 1 of 1 was found")


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
    for name in ("walk_curve_1", "walk_curve_2"):
        load_save.save(resample(samples.sample(name), 30), course / "clips" / f"{name}.bvh")
    assert main(["graph", "clips", "-o", "graph.npz"]) == 0
    assert crowd("--graph", "graph.npz", "--to", "glb", "--no-film") == 0
    assert sorted(path.suffix for path in (course / "crowd").iterdir()) == [".glb", ".glb", ".glb", ".png"]
