"""Long walks, written as they are made, are the walks they would be at once."""

import tracemalloc

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.motion import concatenate
from mocap.files import load_save
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.synthesis.random_walks import dump, random_walk, stream
from mocap.synthesis.walk_to_motion import to_motion
from tests.bundled import bundled
from tests.refusals import refused
from tests.strategies import wave

CLIPS = [wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)]
GRAPH = prune(build(CLIPS, window=8, threshold=0.05))


def test_the_pieces_are_the_whole():
    """As in [KGP02, 5.3]."""
    whole = to_motion(GRAPH, random_walk(GRAPH, seconds=60, seed=5))
    pieces = list(stream(GRAPH, seconds=60, seed=5, piece=7))
    assert len(pieces) > 6
    joined = concatenate(pieces)
    assert joined.root_positions == pytest.approx(whole.root_positions, abs=1e-9)
    assert np.abs((joined.rotations * whole.rotations).sum(-1)) == pytest.approx(np.ones((len(whole), 4)))
    assert np.array_equal(joined.contacts["hand"], whole.contacts["hand"])


def test_a_file_written_in_pieces_is_one_written_at_once(tmp_path):
    frames = dump(GRAPH, tmp_path / "pieces.bvh", seconds=90, seed=5)
    whole = to_motion(GRAPH, random_walk(GRAPH, seconds=90, seed=5))
    load_save.save(whole, tmp_path / "whole.bvh")
    pieces, once = (load_save.load(tmp_path / f"{name}.bvh") for name in ("pieces", "whole"))
    assert frames == len(pieces) == len(once) >= 90 * 30
    assert pieces.root_positions == pytest.approx(once.root_positions, abs=1e-6)
    assert np.abs((pieces.rotations * once.rotations).sum(-1)).min() > 1 - 1e-9


@pytest.mark.parametrize("piece", [1, 8])
def test_pieces_are_cleaned_as_the_whole_would_be(piece):
    """Cut anywhere, feet stand where they would without the cut; no frame is lost, and none comes twice.

    A leg gets no straighter than it ever is in what is cleaned at once: a few frames differ by millimetres.
    """
    graph = bundled("walk_circle", "walk_curve_1")
    whole = to_motion(graph, random_walk(graph, seconds=30, seed=2), clean=True)
    joined = concatenate(list(stream(graph, seconds=30, seed=2, piece=piece, clean=True)))
    assert len(joined) == len(whole)
    off = np.abs(joint_positions(joined) - joint_positions(whole)).max(axis=(1, 2))
    assert off.max() < 0.006
    assert np.median(off) < 1e-9
    assert all(np.array_equal(joined.contacts[foot], marks) for foot, marks in whole.contacts.items())


def test_memory_does_not_grow_with_the_walk(tmp_path):
    """As in [KGP02, 5.3]: motion dumping."""
    peaks = []
    for seconds in (60, 180):
        tracemalloc.start()
        dump(GRAPH, tmp_path / "long.bvh", seconds=seconds)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.2 * peaks[0]


def test_an_interruption_leaves_nothing(tmp_path):
    def interrupted(pieces):
        yield pieces[0]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        dump(GRAPH, tmp_path / "walk.bvh", seconds=120, progress=interrupted)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "seconds", "message"),
    [
        ("walk.amc", 10, "as .bvh or .glb"),
        ("walk.glb", 3601, "may last 3600 s, not 3601: write .bvh"),
        ("walk.bvh", 0, "longer than 0 s"),
        ("walk.bvh", np.nan, "longer than 0 s"),
    ],
)
def test_what_cannot_be_written_is_told(tmp_path, name, seconds, message):
    refused(message, dump, GRAPH, tmp_path / name, seconds=seconds)
