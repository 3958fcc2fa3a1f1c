"""The graph's frames add up, compiled it says the same; thresholds against graphs built at each of them."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.motion import resample
from mocap.body.planar import IDENTITY, PlanarTransform, on_ground
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import compile_graph, walk_track
from mocap.graphs.components import reached
from mocap.graphs.graph_summary import summary
from mocap.graphs.motion_graph import build, from_transitions, merge_choice_points
from mocap.graphs.pruning import prune
from mocap.graphs.thresholds import ThresholdCurve, smallest_threshold, threshold_curve, velocity_differences
from mocap.graphs.tuned import TUNED
from mocap.matching import Transition, align, find_transitions, point_cloud
from mocap.matching.transitions import Transitions
from mocap.synthesis import random_walk, to_motion
from tests.bundled import sneaking, walking
from tests.refusals import refusals, refused
from tests.strategies import ends, planar, random_motion, seeds, wave

CLIPS = [wave(90, name="a"), wave(70, phase=1.0, name="b", seed=1)]
WINDOW = 8


def frames(graph):
    return summary(graph.graph, fps=graph.fps).frames


def test_an_edge_for_every_transition_and_every_stretch():
    """As in [KGP02, 3]."""
    graph = from_transitions(CLIPS, [Transition(0, 30, 1, 20, 0.02, IDENTITY)], window=WINDOW)
    assert sorted(graph.graph.edges(data="kind")) == [
        ((0, 0), (0, 30), "clip"),
        ((0, 30), (0, 90), "clip"),
        ((0, 30), (1, 28), "transition"),
        ((1, 0), (1, 28), "clip"),
        ((1, 28), (1, 70), "clip"),
    ]
    assert frames(graph) == 160
    assert graph.count("transition") == 1
    assert repr(graph) == "MotionGraph(2 clips, 6 nodes, 5 edges, 1 of them transitions)"


def test_building_finds_transitions_below_the_threshold():
    """As in [KGP02, 3]."""
    loose, strict = (build(CLIPS, window=WINDOW, threshold=t) for t in (0.08, 0.02))
    costs = [cost for _, _, cost in strict.graph.edges(data="cost") if cost is not None]
    assert 0 < strict.count("transition") < loose.count("transition")
    assert max(costs) < 0.02
    assert loose.count("transition") == len(find_transitions(CLIPS, window=WINDOW, below=0.08))


def test_below_the_smallest_threshold_there_is_no_walk():
    least = smallest_threshold(CLIPS, window=WINDOW)
    refused("no cycle", prune, build(CLIPS, window=WINDOW, threshold=least), kind=NoWalk)
    whole = build(CLIPS, window=WINDOW, threshold=least * 1.0001)
    before = set(whole.graph)
    assert 0 < len(prune(whole).graph) < len(before) and set(whole.graph) == before
    refused("add clips with similar starts and ends", smallest_threshold, [wave(8)], window=8, kind=NoWalk)


def labelled(frames, switch, **settings):
    """Walk up to the frame `switch`, then run."""
    motion = wave(frames, **settings)
    return replace(motion, labels={"walk": np.arange(frames) < switch, "run": np.arange(frames) >= switch})


def test_an_edge_bears_every_label_of_its_frames():
    clips = [labelled(90, 40, name="a"), labelled(70, 70, name="b")]
    found = [Transition(0, 30, 1, 20, 0.02, IDENTITY), Transition(0, 60, 1, 30, 0.02, IDENTITY)]
    graph = from_transitions(clips, found, window=WINDOW).graph
    labels = {(start, end): "+".join(sorted(both)) for start, end, both in graph.edges(data="labels")}
    assert labels == {
        ((0, 0), (0, 30)): "walk",
        ((0, 30), (0, 60)): "run+walk",
        ((0, 60), (0, 90)): "run",
        ((0, 30), (1, 28)): "walk",
        ((0, 60), (1, 38)): "run+walk",
        ((1, 0), (1, 28)): "walk",
        ((1, 28), (1, 38)): "walk",
        ((1, 38), (1, 70)): "walk",
    }


def make(clips):
    return build(clips, window=WINDOW, threshold=0.05)


def merge(threshold):
    return merge_choice_points(make(CLIPS), within=4, threshold=threshold)


def graph_with(row):
    return from_transitions(CLIPS, [Transition(*row, 0.02, IDENTITY)], window=WINDOW)


test_what_makes_no_graph = refusals(
    ("one clip or more, got none", make, []),
    ("given twice: wave", make, [wave(30), wave(30)]),
    ("'a' runs at 30 Hz, 'b' at 60 Hz", make, [CLIPS[0], resample(CLIPS[1], 60.0)]),
    ("differ in these joints", make, [CLIPS[0], random_motion(1, frames=30)]),
    *(
        ("lies outside the clips", graph_with, row)
        for row in ((0, 83, 1, 20), (0, 30, 1, 63), (0, -1, 1, 20), (2, 30, 1, 20), (0, 30, -1, 20))
    ),
    *(("above 0 m", merge, threshold) for threshold in (0, -1, np.nan)),
)


def transitions_of(motion_graph):
    rows = motion_graph.graph.edges(data=True)
    return [(a, b, edge) for a, b, edge in rows if edge["kind"] == "transition"]


@pytest.fixture(scope="module")
def graphs():
    whole = build(CLIPS, window=WINDOW, threshold=0.06)
    return whole, merge_choice_points(whole, within=4, threshold=0.06)


def test_there_are_fewer_nodes_and_no_fewer_frames(graphs):
    whole, merged = graphs
    assert merged.graph.number_of_nodes() < whole.graph.number_of_nodes()
    assert frames(prune(merged)) >= frames(prune(whole))


def test_every_transition_has_its_counterpart(graphs):
    whole, merged = graphs
    found = [(a, b) for a, b, _ in transitions_of(merged)]
    for (source, leave), (target, enter), _ in transitions_of(whole):
        assert any(
            (a[0], b[0]) == (source, target) and leave <= a[1] <= leave + 4 and enter - 4 <= b[1] <= enter
            for a, b in found
        )


def test_costs_are_measured_anew(graphs):
    clouds = [point_cloud(clip) for clip in CLIPS]
    for (source, leave), (target, enter), edge in transitions_of(graphs[1]):
        a = clouds[source][leave : leave + WINDOW].reshape(-1, 3)
        b = clouds[target][enter - WINDOW : enter].reshape(-1, 3)
        best = align(a, b)
        np.testing.assert_allclose(edge["transform"], best, atol=1e-5)
        rms = np.sqrt(((a - PlanarTransform(*best).apply_points(b)) ** 2).sum(-1).mean())
        assert edge["cost"] == pytest.approx(rms, abs=2e-6)
        assert edge["cost"] < 0.06


def test_within_no_frames_nothing_changes(graphs):
    whole, _ = graphs
    same = merge_choice_points(whole, within=0, threshold=0.06)
    assert nx.utils.graphs_equal(whole.graph, same.graph)


@given(ends, st.integers(0, 12), st.sampled_from([0.05, 0.2, 1.0]))
def test_what_was_reached_still_is(rows, within, threshold):
    found = [Transition(*row, 0.01, IDENTITY) for row in rows]
    whole = from_transitions(CLIPS, found, window=WINDOW)
    merged = merge_choice_points(whole, within=within, threshold=threshold)
    for clip, motion in enumerate(CLIPS):  # from the start of a clip, the ends of the same clips
        ends = {(other, len(m)) for other, m in enumerate(CLIPS)}
        before, after = (reached(graph.graph, [(clip, 0)]) & ends for graph in (whole, merged))
        assert before <= after
        assert (clip, len(motion)) in after
    for _, (_, enter), edge in transitions_of(merged):
        assert enter >= WINDOW
        assert edge["cost"] < max(threshold, 0.02)


def made_up(seed, count):
    random = np.random.default_rng(seed)
    source, target = random.integers(0, 2, (2, count))
    leave, enter = random.integers(0, 60, (2, count))
    zeros = np.zeros(count)
    cost = random.integers(1, 6, count) / 100  # often the same
    return Transitions(source, leave, target, enter, cost, PlanarTransform(zeros, zeros, zeros))


def kept_frames(graph):
    try:
        return frames(prune(graph))
    except NoWalk:
        return 0


@pytest.mark.filterwarnings("ignore:0 frames of clip stay")
@given(seeds, st.integers(0, 20))
def test_the_curve_is_what_building_and_pruning_gives(seed, count):
    found = made_up(seed, count)
    gaps = velocity_differences(CLIPS, found, window=WINDOW)
    curve = threshold_curve(CLIPS, found, window=WINDOW, thresholds=[0, 0.02, 0.035, 0.05, 1])
    for row in zip(*curve, strict=True):
        close = found.cost < row[0]
        graph = from_transitions(CLIPS, found[close], window=WINDOW)
        size = graph.count("transition"), len(graph.graph), graph.graph.number_of_edges()
        assert row[1:5] == (*size, kept_frames(graph))
        means = [column[close].mean() if close.any() else 0.0 for column in (found.cost, gaps)]
        np.testing.assert_allclose(row[5:], means, atol=1e-12)


def test_it_ends_with_all_transitions():
    found = find_transitions(CLIPS, window=WINDOW, below=0.1)
    curve = threshold_curve(CLIPS, found, window=WINDOW, thresholds=np.linspace(0, 0.1, 31))
    assert curve.transitions[-1] == len(found)
    assert curve.frames[-1] == kept_frames(from_transitions(CLIPS, found, window=WINDOW)) > 0
    assert all(np.all(np.diff(column) >= 0) for column in curve[:6])


def test_the_suggestion_is_the_lowest_that_keeps_enough():
    levels, rest = np.array([1.0, 2, 3, 4]), np.arange(4)
    curve = ThresholdCurve(levels, rest, rest, rest, np.array([0, 50, 95, 100]), levels, levels)
    assert curve.suggest() == 3 and curve._replace(frames=np.array([0, 90, 89, 100])).suggest() == 2
    refused("no cycle at any of these", curve._replace(frames=np.zeros(4, int)).suggest, kind=NoWalk)


def curve_of(found, clips=CLIPS, window=WINDOW, thresholds=(0.05,)):
    return threshold_curve(clips, found, window=window, thresholds=thresholds)


test_what_makes_no_curve = refusals(
    ("Thresholds must be numbers", lambda: curve_of(made_up(0, 5), thresholds=[0.1, np.nan])),
    ("windows outside", curve_of, made_up(0, 5), CLIPS[:1]),
    ("windows outside", curve_of, made_up(0, 5), CLIPS, 80),
)


def gaps_of(clips, ways):
    """Measure transitions from frame 30 of clip 0 to frame 30 of clip 1, laid by each of some transforms."""
    count = len(ways)
    zero, thirty = np.zeros(count, int), np.full(count, 30)
    found = Transitions(zero, thirty, zero + 1, thirty, np.zeros(count), PlanarTransform(*np.array(ways).T))
    return velocity_differences(clips, found, window=WINDOW)


@given(planar)
def test_a_copy_moves_as_the_original(transform):
    back = transform.inverse()
    turned = back._replace(angle=back.angle + np.pi)
    right, wrong = gaps_of([CLIPS[0], transform.apply_motion(CLIPS[0])], [back, turned])
    assert right == pytest.approx(0, abs=1e-9)
    assert wrong > 0.5


def test_a_gap_is_in_metres_a_second():
    away = np.outer(np.arange(90) / 30, [3.0, 0, 0])
    faster = replace(CLIPS[0], root_positions=CLIPS[0].root_positions + away)
    assert gaps_of([CLIPS[0], faster], [PlanarTransform(0.0, 0.0, 0.0)]) == pytest.approx(3.0)


GRAPH = walking()


def test_every_edge_is_there_once():
    source = GRAPH.source.graph
    assert sorted(GRAPH.edges) == sorted(source.edges(keys=True))
    for number in range(0, len(GRAPH.edges), 97):
        edge = source.edges[GRAPH.edges[number]]
        assert GRAPH.nodes[GRAPH.target[number]] == GRAPH.edges[number][1]
        assert GRAPH.frames[number] == edge["frames"]
        assert GRAPH.blended[number] == (edge["kind"] == "transition")
        assert GRAPH.cost[number] == edge.get("cost", 0)


def test_the_track_is_the_root_of_the_motion():
    walk = random_walk(GRAPH.source, seconds=60, seed=1, settle=0.2)
    number = {edge: n for n, edge in enumerate(GRAPH.edges)}
    edges = np.array([number[edge] for edge in walk])
    turn, move = np.exp(0.7j), 3 + 4j
    track, rows = walk_track(GRAPH, edges, complex(turn), move)
    motion = to_motion(GRAPH.source, walk, start=PlanarTransform(0.7, 4.0, 3.0))
    assert track == pytest.approx(on_ground(motion.root_positions), abs=1e-9)
    assert np.abs(np.diff(track)) == pytest.approx(GRAPH.step[rows][1:], abs=1e-9)


def test_labels_are_those_of_the_motion():
    graph = sneaking()
    walk = random_walk(graph.source, seconds=60, seed=4)
    number = {edge: n for n, edge in enumerate(graph.edges)}
    _, rows = walk_track(graph, np.array([number[edge] for edge in walk]), 1 + 0j, 0j)
    motion = to_motion(graph.source, walk)
    for label, bears in zip(graph.label_names, graph.bears, strict=True):
        assert np.array_equal(bears[rows], motion.labels.get(label, np.zeros(len(rows), bool)))


def test_macro_edges_are_all_ways_on_from_a_node():
    """Against rides and transitions followed in the graph itself."""
    source = GRAPH.source.graph
    least = np.ceil(GRAPH.fps / 6)

    def ways(node, ridden=0, taken=()):
        leaving = source.out_edges(node, keys=True)
        found = [(*taken, e) for e in leaving if source.edges[e]["kind"] == "transition"]
        for edge in source.out_edges(node, keys=True):
            if source.edges[edge]["kind"] == "clip":
                frames, longer = ridden + source.edges[edge]["frames"], (*taken, edge)
                over = frames >= least or not source.out_degree(edge[1])
                found += [longer] if over else ways(edge[1], frames, longer)
        return found

    for n in range(0, len(GRAPH.nodes), 53):
        of, macro_edges = GRAPH.macro_edges.leaving(np.array([n]))
        assert not of.any()
        told = [GRAPH.macro_edges.edges(np.array([macro_edge])) for macro_edge in macro_edges]
        assert sorted(tuple(GRAPH.edges[e] for e in edges) for edges in told) == sorted(ways(GRAPH.nodes[n]))


def test_a_macro_edge_plays_the_frames_of_its_edges():
    macro_edges = np.arange(0, len(GRAPH.macro_edges.last), 371)
    rows, of = GRAPH.macro_edges.rows(macro_edges)
    assert np.array_equal(np.bincount(of), GRAPH.macro_edges.frames[macro_edges])
    for number, macro_edge in enumerate(macro_edges):
        edges = GRAPH.macro_edges.edges(np.array([macro_edge]))
        _, expected = walk_track(GRAPH, edges, 1 + 0j, 0j)
        assert np.array_equal(rows[of == number], expected)


def test_a_label_has_a_number():
    graph = sneaking()
    assert [graph.label_names[graph.label_number(name)] for name in ("sneak", "walk")] == ["sneak", "walk"]
    assert graph.label_number("") == -1
    refused("bears the label 'fly'; there are: sneak, walk", graph.label_number, "fly", kind=NoWalk)


def test_it_is_compiled_once_and_never_empty():
    assert compile_graph(GRAPH) is GRAPH
    empty = from_transitions([wave(20)], [], window=5)
    empty.graph.remove_edges_from(list(empty.graph.edges))
    refused("no edges", compile_graph, empty, kind=NoWalk)


def test_ahead_of_a_node_the_root_goes_on_as_it_went_past_the_end_too():
    speed = np.array([0.3, 0.0, 1.2])  # x, y, z in metres per second
    glide = replace(wave(50), root_positions=np.arange(50)[:, None] / 40 * speed, fps=40.0)
    graph = compile_graph(from_transitions([glide], [], window=5))
    seconds = np.array([[0.0], [50 / 40]]) + TUNED.ahead  # the clip's start and its end
    assert graph.ahead == pytest.approx(seconds * (1.2 + 0.3j))
    assert graph.going == pytest.approx(np.arctan2(0.3, 1.2))
