"""A walk's frames are the clips' own, and its seams are as smooth as the blend promises."""

import tracemalloc
from dataclasses import replace
from decimal import Decimal, localcontext
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given

from mocap.body import concatenate, joint_positions
from mocap.body.planar import IDENTITY
from mocap.datasets.samples import sample
from mocap.editing.toes import lowest_heights
from mocap.errors import NoWalk
from mocap.feet.footplants import mark_plants
from mocap.files import load_save
from mocap.graphs import build, from_transitions, prune
from mocap.graphs.edge_tables import edge_table
from mocap.matching.transitions import Transition
from mocap.synthesis import random_walks
from mocap.synthesis.random_walks import cleaned, dump, random_walk, stream, wander
from mocap.synthesis.walk_to_motion import seams, sources, to_motion, transforms_along, with_footplants
from tests.bundled import bundled
from tests.refusals import refusals
from tests.strategies import seeds, wave
from tests.tuning import tune

CLIPS = [wave(120, name="a"), wave(90, phase=1.0, name="b", seed=1)]
WINDOW = 8
GRAPH = prune(build(CLIPS, window=WINDOW, threshold=0.05))


def test_a_walk_along_natural_successors_is_the_clip_bit_for_bit():
    whole = build(CLIPS, window=WINDOW, threshold=0.05)
    nodes = sorted(node for node in whole.graph if node[0] == 0)
    kinds = nx.get_edge_attributes(whole.graph, "kind")
    walk = [e for s, t in pairwise(nodes) for e, k in kinds.items() if e[:2] == (s, t) and k == "clip"]
    motion = to_motion(whole, walk)
    assert len(walk) > 3
    assert np.array_equal(motion.rotations, CLIPS[0].rotations)
    assert np.array_equal(motion.root_positions, CLIPS[0].root_positions)
    assert np.array_equal(motion.contacts["hand"], CLIPS[0].contacts["hand"])


@given(seeds)
def test_a_random_walk_is_a_walk_as_long_as_asked_and_the_same_again(seed):
    walk = random_walk(GRAPH, seconds=4, seed=seed)
    assert all(GRAPH.graph.has_edge(*edge) for edge in walk)
    assert all(a[1] == b[0] for a, b in pairwise(walk))
    motion = to_motion(GRAPH, walk)
    lengths = [GRAPH.graph.edges[edge]["frames"] for edge in walk]
    assert len(motion) == sum(lengths) >= 4 * 30 > sum(lengths[:-1])
    assert walk == random_walk(GRAPH, seconds=4, seed=seed)
    assert random_walk(GRAPH, seconds=1, start=walk[-1][0])[0][0] == walk[-1][0]


def test_who_settles_takes_fewer_transitions():
    """That cheap ones are taken more often, is held by the odds of `plain.random_walk`."""
    seldom, often = (seams(GRAPH, random_walk(GRAPH, seconds=99, settle=settle)) for settle in (1.0, 0.0))
    assert len(seldom) < len(often)


FIRST, SECOND = random_walk(GRAPH, seconds=4)[:2]


def walked(seconds=1, start=None, graph=GRAPH):
    return random_walk(graph, seconds=seconds, start=start)


test_bad_walks_are_refused = refusals(
    (NoWalk, "no edges", to_motion, GRAPH, []),
    (NoWalk, "no edge", to_motion, GRAPH, [((7, 7), (8, 8), 0)]),
    (NoWalk, "jumps from node", to_motion, GRAPH, [SECOND, FIRST]),
    (NoWalk, "none in that clip", walked, 1, (7, 7)),
    (NoWalk, r"node \(0, 999\); the nearest is \(0, \d\d", walked, 1, (0, 999)),
    ("longer than 0 s, got 0 s", walked, 0),
    (
        NoWalk,
        r"ends at node \(0, 120\) after 4.0 s: prune",
        walked,
        60,
        (0, 0),
        from_transitions(CLIPS, [], window=WINDOW),
    ),
)


def test_ten_thousand_edges_do_not_drift():
    """Against places multiplied up one by one in 50 digits."""
    walk = [edge for edge, _ in zip(wander(GRAPH, settle=0.0), range(10_000), strict=False)]
    place = transforms_along(edge_table(GRAPH, walk))
    with localcontext(prec=50):
        x = z = angle = Decimal(0)
        for edge in walk:
            step = GRAPH.graph.edges[edge].get("transform", IDENTITY)
            cos, sin = (Decimal(f(float(angle))) for f in (np.cos, np.sin))
            over, on = Decimal(step.x), Decimal(step.z)
            x, z = x + over * cos + on * sin, z + on * cos - over * sin
            angle += Decimal(step.angle)
    assert place.angle[-1] == pytest.approx(float(angle), abs=1e-9)
    assert [place.x[-1], place.z[-1]] == pytest.approx([float(x), float(z)], abs=1e-7)


def test_labels_come_from_the_clip_with_the_larger_weight():
    here, there = (replace(clip, labels={name: True}) for clip, name in zip(CLIPS, "ab", strict=True))
    whole = from_transitions([here, there], [Transition(0, 40, 1, 10, 0.1, IDENTITY)], window=WINDOW)
    motion = to_motion(whole, [((0, 0), (0, 40), 0), ((0, 40), (1, 18), 0), ((1, 18), (1, 90), 0)])
    expected = np.arange(len(motion)) < 40 + WINDOW // 2
    assert np.array_equal(motion.labels["a"], expected)
    assert np.array_equal(motion.labels["b"], ~expected)


@given(seeds)
def test_sources_name_the_clip_that_each_frame_bears_the_label_of(seed):
    named = [replace(clip, labels={clip.name: True}) for clip in CLIPS]
    graph = prune(build(named, window=WINDOW, threshold=0.05))
    walk = random_walk(graph, seconds=8, seed=seed, settle=0.0)
    motion, told = to_motion(graph, walk), sources(graph, walk)
    starts, names = zip(*told, strict=True)
    of = np.searchsorted(starts, np.arange(len(motion)), side="right") - 1
    for name in "ab":
        assert np.array_equal(motion.labels[name], np.array(names)[of] == name)


def test_plants_are_found_only_where_no_clip_tells():
    assert with_footplants(GRAPH) is GRAPH
    walk = replace(sample("walk_straight")[:240], contacts={})
    unmarked = from_transitions([walk], [], window=WINDOW)
    (found,) = with_footplants(unmarked).clips
    assert found.contacts.keys() == mark_plants(walk).contacts.keys() != set()
    assert with_footplants(unmarked).graph is unmarked.graph


def test_cleaned_feet_stand_still():
    graph = bundled("walk_circle")
    walk = random_walk(graph, seconds=20, seed=2, settle=0.3)
    plain, clean = (to_motion(graph, walk, clean=c) for c in (False, True))

    def slide(motion):
        """Return how far the ball of the left foot moves at most in a frame in which it stands."""
        joint = next(name for name in clean.contacts if "oe" in name or "ball" in name.lower())
        marks = clean.contacts[joint]
        at = joint_positions(motion)[:, motion.skeleton.index(joint)]
        return np.linalg.norm(np.diff(at, axis=0), axis=-1)[marks[1:] & marks[:-1]].max()

    assert slide(clean) < 1e-3 < slide(plain)


def test_the_pieces_are_the_whole_in_a_file_too(tmp_path, monkeypatch):
    """As in [KGP02, 5.3]."""
    whole = to_motion(GRAPH, random_walk(GRAPH, seconds=60, seed=5))
    tune(monkeypatch, random_walks, piece=7.0)
    pieces = list(stream(GRAPH, seconds=60, seed=5))
    assert len(pieces) > 6
    joined = concatenate(pieces)
    assert np.array_equal(joined.contacts["hand"], whole.contacts["hand"])
    assert dump(GRAPH, tmp_path / "pieces.bvh", seconds=60, seed=5) == len(whole) >= 60 * 30
    load_save.save(whole, tmp_path / "whole.bvh")
    read, once = (load_save.load(tmp_path / f"{name}.bvh") for name in ("pieces", "whole"))
    for one, other, close in ((joined, whole, 1e-9), (read, once, 1e-6)):
        assert one.root_positions == pytest.approx(other.root_positions, abs=close)
        assert np.abs((one.rotations * other.rotations).sum(-1)).min() > 1 - 1e-9


@pytest.mark.parametrize("piece", [1, 8])
def test_pieces_are_cleaned_as_the_whole_would_be(monkeypatch, piece):
    """Cut anywhere, feet stand where they would without the cut; no frame is lost, and none comes twice.

    A leg gets no straighter than it ever is in what is cleaned at once: a few frames differ by millimetres.
    """
    graph = bundled("walk_circle", "walk_curve_1")
    whole = to_motion(graph, random_walk(graph, seconds=30, seed=2), clean=True)
    tune(monkeypatch, random_walks, piece=piece)
    joined = concatenate(list(cleaned(stream(graph, seconds=30, seed=2), lowest_heights(graph.clips))))
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


test_what_cannot_be_written_is_told = refusals(
    ("as .bvh, .glb, .npz or .csv", lambda: dump(GRAPH, "walk.amc", seconds=10)),
    ("may last 3600 s, not 3601: write .bvh", lambda: dump(GRAPH, "walk.glb", seconds=3601)),
    ("longer than 0 s", lambda: dump(GRAPH, "walk.bvh", seconds=0)),
    ("longer than 0 s", lambda: dump(GRAPH, "walk.bvh", seconds=np.nan)),
)
