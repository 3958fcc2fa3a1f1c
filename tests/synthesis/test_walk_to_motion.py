"""A walk's frames are the clips' own, and its seams are as smooth as the blend promises."""

import tracemalloc
from dataclasses import replace
from decimal import Decimal, localcontext
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.joining import blend
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import concatenate
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.datasets.samples import sample
from mocap.errors import NoWalk
from mocap.feet.footplants import mark_plants
from mocap.files import load_save
from mocap.graphs.edge_tables import edge_table
from mocap.graphs.motion_graph import build, from_transitions
from mocap.graphs.pruning import prune
from mocap.matching.transitions import Transition
from mocap.synthesis.random_walks import dump, random_walk, stream, wander
from mocap.synthesis.walk_to_motion import places, seams, sources, to_motion, with_plants
from tests.bundled import bundled
from tests.refusals import refused
from tests.strategies import planar, seeds, wave

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


def test_cheap_transitions_are_taken_more_often():
    walk = random_walk(GRAPH, seconds=900, seed=0, settle=0.0)
    assert len(seams(GRAPH, random_walk(GRAPH, seconds=900, seed=0))) < len(seams(GRAPH, walk))
    costs = [cost for _, _, cost in GRAPH.graph.edges(data="cost") if cost is not None]
    assert np.mean([seam.cost for seam in seams(GRAPH, walk)]) < np.mean(costs)


@given(st.integers(0, 60), st.integers(0, 60), st.floats(-3, 3), st.floats(-5, 5))
def test_a_transition_blends_the_two_windows_and_leads_on_from_the_second(leave, enter, angle, x):
    """Against the same written down by hand for one transition [KGP02, 3.3; Eqs. 5-7]."""
    transform = PlanarTransform(angle, x, 1.0)
    whole = from_transitions(CLIPS, [Transition(0, leave, 1, enter, 0.1, transform)], window=WINDOW)
    walk = [((0, leave), (1, enter + WINDOW), 0), ((1, enter + WINDOW), (1, 90), 0)]
    motion = to_motion(whole, walk)
    moved = transform.apply_motion(CLIPS[1])
    mixed = blend(CLIPS[0][leave : leave + WINDOW], moved[enter : enter + WINDOW], cubic_weights(WINDOW))
    expected = np.concatenate([joint_positions(mixed), joint_positions(moved)[enter + WINDOW :]])
    assert joint_positions(motion) == pytest.approx(expected, abs=1e-9)


def test_bad_walks_are_refused():
    first, second = random_walk(GRAPH, seconds=4)[:2]
    wrong = (([], "no edges"), ([((7, 7), (8, 8), 0)], "no edge"), ([second, first], "jumps from node"))
    for walk, message in wrong:
        refused(message, to_motion, GRAPH, walk, kind=NoWalk)
    for node, words in (((7, 7), "none in that clip"), ((0, 999), r"node \(0, 999\); the nearest is \(0, ")):
        refused(words, random_walk, GRAPH, seconds=1, start=node, kind=NoWalk)
    refused("longer than 0 s, got 0 s", random_walk, GRAPH, seconds=0)


def test_a_graph_that_was_not_pruned_ends_the_walk():
    whole = from_transitions(CLIPS, [], window=WINDOW)
    with pytest.raises(NoWalk, match=r"ends at node \(0, 120\) after 4.0 s: prune"):
        random_walk(whole, seconds=60, start=(0, 0))


def one_by_one(graph, walk, place=IDENTITY):
    """Play a walk edge by edge, as the definition says: the slow way."""
    pieces = []
    for start, end, key in walk:
        edge = graph.graph.edges[start, end, key]
        leaving = graph.clips[start[0]][start[1] : start[1] + edge["frames"]]
        if edge["kind"] == "transition":
            entering = edge["transform"].apply_motion(graph.clips[end[0]][end[1] - graph.window : end[1]])
            pieces.append(place.apply_motion(blend(leaving, entering, cubic_weights(graph.window))))
            place = place @ edge["transform"]
        else:
            pieces.append(place.apply_motion(leaving))
    return concatenate(pieces)


@given(seeds, planar)
def test_all_at_once_is_what_edge_by_edge_is(seed, place):
    """As in [KGP02, 4.1]."""
    walk = random_walk(GRAPH, seconds=8, seed=seed, settle=0.0)
    motion, expected = to_motion(GRAPH, walk, place=place), one_by_one(GRAPH, walk, place)
    assert motion.root_positions == pytest.approx(expected.root_positions, abs=1e-9)
    assert rotations.angle_between(motion.rotations, expected.rotations).max() < 1e-7
    for joint, mark in expected.contacts.items():
        assert np.array_equal(motion.contacts[joint], mark)


def test_ten_thousand_edges_do_not_drift():
    """Against places multiplied up one by one in 50 digits."""
    walk = [edge for edge, _ in zip(wander(GRAPH, settle=0.0), range(10_000), strict=False)]
    place = places(edge_table(GRAPH, walk))
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
    assert with_plants(GRAPH) is GRAPH
    walk = replace(sample("walk_straight")[:240], contacts={})
    unmarked = from_transitions([walk], [], window=WINDOW)
    (found,) = with_plants(unmarked).clips
    assert found.contacts.keys() == mark_plants(walk).contacts.keys() != set()
    assert with_plants(unmarked).graph is unmarked.graph


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
