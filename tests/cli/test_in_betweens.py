"""`mocap inbetween`, as a person types it."""

import numpy as np
import pytest

from mocap import feet
from mocap.body import heading, resample, rotations
from mocap.datasets.samples import sample
from mocap.files import load_save
from mocap.graphs import storage
from tests.bundled import bundled
from tests.editing.test_path_editing import slide


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    place = tmp_path_factory.mktemp("inbetween")
    walk = resample(sample("walk_curve_1"), 60)
    load_save.save(walk, place / "walk.bvh")
    load_save.save(walk[:201], place / "a.bvh")
    load_save.save(resample(walk[260:], 30), place / "b.bvh")
    load_save.save(resample(sample("walk_straight"), 30)[:300], place / "straight.bvh")
    storage.save(bundled("walk_circle", "walk_curve_1"), place / "graph.npz")
    return place


@pytest.fixture
def folder(made, monkeypatch):
    monkeypatch.chdir(made)
    return made


def same(motion, expected, atol=1e-5):
    """Compare two motions, but for the rounding of numbers in files."""
    np.testing.assert_allclose(motion.root_positions, expected.root_positions, atol=atol)
    assert rotations.angle_between(motion.rotations, expected.rotations).max() < 1e-3


def test_a_gap_is_made_anew_and_all_else_stays(folder, run):
    said = run("inbetween walk.bvh --gap 2s-3.5s -o filled.bvh").out
    assert (
        "1.50 s, a walk turned by up to " in said
        and f"wrote        filled.bvh: {len(load_save.load('walk.bvh'))} frames" in said
    )
    walk, filled = load_save.load("walk.bvh"), load_save.load("filled.bvh")
    same(filled[:121], walk[:121])
    same(filled[210:], walk[210:])
    assert np.abs(filled.root_positions[121:210] - walk.root_positions[121:210]).max() < 0.15
    assert slide(feet.mark_plants(filled)[100:230]) < 0.005


def test_a_gap_in_frames_too_short_for_a_step_is_interpolated(folder, run, monkeypatch):
    monkeypatch.setattr("mocap.graphs.build", None)  # no graph is built
    assert "0.20 s, interpolated" in run("inbetween walk.bvh --gap 120-132 -o short.bvh").out
    walk, short = load_save.load("walk.bvh"), load_save.load("short.bvh")
    assert len(short) == len(walk)
    assert np.abs(short.root_positions - walk.root_positions).max() < 0.01


def test_two_clips_of_two_rates_are_joined_in_time(folder, run):
    run("inbetween a.bvh b.bvh --seconds 1 -o joined.bvh")
    run("inbetween a.bvh b.bvh --seconds 1 --alone -o alone.bvh")
    a, b, joined, alone = (load_save.load(f"{name}.bvh") for name in ("a", "b", "joined", "alone"))
    assert (joined.fps, len(alone)) == (60, 61)
    assert len(joined) == len(a) + 59 + len(resample(b, 60))
    same(joined[200:261], alone)
    same(alone[:1], a[-1:])
    same(alone[-1:], b[:1])


def test_the_end_is_put_ahead_and_a_graph_gives_the_motion(folder, run):
    run("inbetween a.bvh straight.bvh --seconds 2 --ahead 2.2 --graph graph.npz -o ahead.bvh --alone")
    roots = load_save.load("ahead.bvh")
    line = (roots.root_positions[-1] - roots.root_positions[0])[[0, 2]]
    turn = float(heading(roots.rotations[0, 0]))
    assert line == pytest.approx([2.2 * np.sin(turn), 2.2 * np.cos(turn)], abs=1e-4)
    assert heading(roots.rotations[-1, 0]) == pytest.approx(turn, abs=1e-4)


def test_a_clip_of_the_graph_is_not_written_over(folder, run):
    run("graph walk.bvh -o own.npz")
    before = (folder / "walk.bvh").read_bytes()
    line = "inbetween a.bvh b.bvh --seconds 1 --graph own.npz -o walk.bvh"
    assert "is one of the files to read" in run(line, 2).err
    assert (folder / "walk.bvh").read_bytes() == before
