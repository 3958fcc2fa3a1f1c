"""`mocap walk` and `mocap crowd`, as a person types them."""

import numpy as np
import pytest
from PIL import Image

from mocap.body.motion import resample
from mocap.cli.walk import _plan
from mocap.datasets import samples
from mocap.errors import NoWalk
from mocap.files import load_save
from mocap.graphs import storage
from mocap.methods.groups.planning import Scene
from tests.bundled import bundled
from tests.files.glb_reader import Glb


@pytest.fixture
def folder(tmp_path, monkeypatch):
    storage.save(bundled("walk_circle", "walk_curve_1"), tmp_path / "graph.npz")
    (tmp_path / "path.csv").write_text("0,0\n0,3\n0.5,5\n")
    (tmp_path / "points.csv").write_text("x, z\n1, 7\n")
    (tmp_path / "discs.csv").write_text("x, z, radius\n-3, 5, 0.5\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_it_wanders_and_writes_gltf_for_engines(folder, run):
    assert "at random" in run("walk graph.npz --random 0.1min -o out.glb --clean").out
    read = Glb((folder / "out.glb").read_bytes())
    assert read.nodes[0]["name"] == "root"
    assert max(times[-1] for times, _ in read.curves().values()) > 5.9


def test_clips_are_found_beside_the_graph(clips, run):
    run("graph a.bvh b.bvh -o graph.npz --threshold 5")
    storage.save(storage.load("graph.npz", storage.find_clips("graph.npz")), "graph.npz")  # without origins
    run("walk graph.npz --random 5s -o out.bvh")
    run("walk graph.npz --random 5s -o out.bvh --clips a.bvh b.bvh")
    (clips / "b.bvh").unlink()
    run("walk graph.npz --random 5s -o out.bvh", 2)


CROWD = "crowd --members 3 --through points.csv --around discs.csv -o crowd"


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_motion_for_each_member_a_plan_and_a_film(folder, run, monkeypatch):
    monkeypatch.setattr("mocap.cli.walk.find_spec", lambda name: None)  # no imageio-ffmpeg
    asked = {}

    def film(motions, path, **settings):
        asked.update(settings, frames=[len(motion) for motion in motions])
        Image.new("RGB", (9, 9)).save(path)

    monkeypatch.setattr("mocap.widgets.save_animation", film)
    said = run(CROWD).out
    assert "for 3 members" in said and "3 characters" in said and "m apart at least" in said
    members = [f"member-0{number}.bvh" for number in (1, 2, 3)]
    assert names(folder / "crowd") == ["crowd.gif", *members, "plan.png"]
    assert [len(load_save.load(folder / "crowd" / name)) for name in members] == asked["frames"]
    assert len({*asked["frames"]}) == 1
    assert np.allclose(asked["discs"], [[-3, 5, 0.5]]) and asked["fps"] == 12.5


def test_a_graph_of_one_s_own_walks_as_glb_and_other_files_stay(folder, run):
    for name in ("walk_curve_1", "walk_curve_2"):
        load_save.save(resample(samples.sample(name), 30), f"{name}.bvh")
    run("graph walk_curve_1.bvh walk_curve_2.bvh -o own.npz")
    (folder / "crowd").mkdir()
    (folder / "crowd" / "notes.txt").write_text("one's own")
    run(f"{CROWD} --graph own.npz --to glb --no-film")
    members = [f"member-0{number}.glb" for number in (1, 2, 3)]
    assert names(folder / "crowd") == [*members, "notes.txt", "plan.png"]


def test_where_the_way_is_closed_it_sets_out_to_a_side_but_does_not_search_there_for_long(monkeypatch):
    asked = []

    def refuse(group, scene, *, start, most=4000):
        asked.append((most, round(float(np.angle(start.turn / 1j)), 6)))
        raise NoWalk(f"refused {len(asked)}")

    monkeypatch.setattr("mocap.methods.groups.lead_group", refuse)
    with pytest.raises(NoWalk, match="refused 1"):
        _plan(None, Scene((20j,)))
    assert asked == [(4000, 0.0), (400, 0.5), (400, -0.5), (400, 1.0), (400, -1.0)]
