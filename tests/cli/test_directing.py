"""A walk writes what it is made of, refuses a seam while the rest stays, and follows a direction."""

import csv

import numpy as np
import pytest

from mocap.cli import crowd
from mocap.cli.options import Sources
from mocap.files import load_save
from mocap.graphs import storage
from tests.bundled import bundled


def table(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def walks(clips):
    """A graph of generated walks, in which people stand, and lines to walk along."""
    storage.save(bundled("stop_and_go", "walk_curve_1"), clips / "walks.npz")
    (clips / "line.csv").write_text("x,z\n0,0\n0,6\n")
    (clips / "scene.csv").write_text("x,z,heading,wait\n0,0,,\n0,5,90,1\n2,6,,\n")
    return clips


def test_the_table_of_a_walk_plays_all_its_frames_in_order(clips, run):
    run("graph a.bvh b.bvh --threshold 5 --fps 20 -o g.npz")
    run("walk g.npz --random 4s -o w.npz")
    rows = table(clips / "w.edges.csv")
    frames = [int(row["to"]) - int(row["from"]) for row in rows]
    assert sum(frames) == len(load_save.load(clips / "w.npz"))
    assert [float(row["second"]) for row in rows] == pytest.approx(
        (np.cumsum(frames) - frames) / 20, abs=1e-3
    )
    for before, seam, after in zip(rows, rows[1:], rows[2:], strict=False):
        if seam["into"]:
            assert (before["clip"], before["to"]) == (seam["clip"], seam["from"])
            assert after["into"] or (after["clip"], after["from"]) == (seam["into"], seam["at"])
            assert float(seam["cost_cm"]) < 5 and float(seam["jolt"]) > 0


def test_a_mix_with_a_licence_that_is_not_commercial_is_said(clips, run):
    (clips / "terms.csv").write_text("clip,licence\na,CC BY-NC 4.0\nb,CC0\n")
    run("graph a.bvh b.bvh --threshold 5 --fps 20 --licence terms.csv -o g.npz")
    told = run("walk g.npz --random 20s -o w.bvh")
    assert "under other licences with" in told.err and "not for commercial use" in told.err
    assert told.out.splitlines()[-2].startswith("licences     CC")
    assert {"CC BY-NC 4.0", "CC0"} <= {row["licence"] for row in table(clips / "w.edges.csv")}


def test_a_refused_seam_is_gone_and_the_rest_stays(walks, run):
    run("walk walks.npz --path line.csv -o w.bvh --inspect seams.html")
    assert "mocap-inspector" in (walks / "seams.html").read_text("utf-8")
    rows = table(walks / "w.edges.csv")
    seams = [row for row in rows if row["into"]]
    refused = f"{seams[0]['clip']}:{seams[0]['from']}"
    told = run(f"walk walks.npz --path line.csv --without {refused} -o v.bvh").out
    assert told.startswith(f"without      {refused}; ")
    changed = table(walks / "v.edges.csv")
    assert refused not in {f"{row['clip']}:{row['from']}" for row in changed if row["into"]}
    asked = run(f"walk walks.npz --path line.csv --without {refused} --without {refused} -o v.bvh", 2).err
    assert f"The walk has no seam that leaves {refused}; its seams leave" in asked


def test_a_direction_in_a_table_is_followed_and_each_point_told(walks, run):
    told = run("walk walks.npz --path scene.csv --start stand --end stand --facing 0 -o w.bvh").out
    assert [line[:12] for line in told.splitlines()[1:4]] == ["point 1     ", "point 2     ", "point 3     "]
    motion = load_save.load(walks / "w.bvh")
    assert np.hypot(*(motion.root_positions[-1, [0, 2]] - (2, 6))) < 0.1
    assert (walks / "w.edges.csv").exists()
    assert "rotated      90° about the root where it stops, without steps of its own" in told


def test_a_seam_of_a_direction_is_refused_and_its_seams_are_shown(walks, run):
    run("walk walks.npz --path scene.csv --end stand -o w.bvh --inspect seams.html")
    assert "mocap-inspector" in (walks / "seams.html").read_text("utf-8")
    seams = [row for row in table(walks / "w.edges.csv") if row["into"]]
    refused = f"{seams[0]['clip']}:{seams[0]['from']}"
    told = run(f"walk walks.npz --path scene.csv --end stand --without {refused} -o v.bvh").out
    assert told.startswith(f"without      {refused}; ")
    changed = [f"{row['clip']}:{row['from']}" for row in table(walks / "v.edges.csv") if row["into"]]
    assert refused not in changed
    motion = load_save.load(walks / "v.bvh")
    assert np.hypot(*(motion.root_positions[-1, [0, 2]] - (2, 6))) < 0.1


def test_the_size_of_a_line_with_a_stand_is_that_of_the_option(walks, run):
    run("walk walks.npz --path line.csv --unit 0.5 --end stand -o w.bvh")
    motion = load_save.load(walks / "w.bvh")
    assert np.hypot(*(motion.root_positions[-1, [0, 2]] - (0, 3))) < 0.1


def test_clips_that_have_moved_are_found_by_each_command_that_reads_a_graph(clips, run):
    run("graph a.bvh b.bvh --threshold 5 --fps 20 -o g.npz")
    (clips / "moved").mkdir()
    for name in ("a", "b"):
        (clips / f"{name}.bvh").rename(clips / "moved" / f"take {name}.bvh")
    stored = "page g.npz -o p.html"
    assert "'a' is no longer where g.npz found it: give --clips" in run(stored, 2).err
    run(f"{stored} --clips moved")
    filled = "inbetween 'moved/take a.bvh' --gap 10-50 --graph g.npz -o i.bvh"
    assert "no longer where g.npz found it" in run(filled, 2).err
    assert "No legs found" in run(f"{filled} --clips moved", 2).err  # the graph is read; this body has none
    run("walk g.npz --random 2s --clips moved -o w.bvh")
    assert crowd._walks(clips / "g.npz", Sources(), [clips / "moved"]).count("transition")
