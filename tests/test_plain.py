"""Each plain function and its quick twin in the rooms give the same, on random clips and on captured ones."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

import mocap
from mocap import blending, body, datasets, graphs, matching, plain, steering, synthesis
from mocap.body import joint_positions, rotations
from tests.bundled import walks_of_16

K = plain.K
LINES = {"S": body.s_curve(8.0), "corner": body.GroundPath([[0, 0], [0, 4], [4, 4]])}


def random_clips():
    """Make two clips of a body with joints that coincide, whose turns and roots run as they like."""
    random = np.random.default_rng(7)
    offsets = np.array([[0, 0, 0], [0, 0, 0], [0.1, 0.4, 0], [0, 0.3, 0.2], [0.1, 0.4, 0], [0, 0.2, 0.1]])
    skeleton = body.Skeleton(list("abcdef"), [-1, 0, 1, 2, 1, 4], offsets)

    def clip(frames, name):
        steps = 0.02 * random.normal(size=(frames, 6, 3)).cumsum(0)
        roots = [0, 1, 0] + 0.02 * random.normal(size=(frames, 3)).cumsum(0)
        return mocap.Motion(skeleton, roots, rotations.from_rotvec(steps), plain.FPS, name)

    return [clip(frames, name) for frames, name in ((60, "one"), (45, "two"))]


@pytest.fixture(scope="module", params=["random", "bundled", "captured"])
def clips(request):
    if request.param == "random":
        return random_clips()
    if request.param == "bundled":
        return [mocap.resample(datasets.sample(name), 30)[:200] for name in ("walk_circle", "walk_curve_1")]
    folder = request.getfixturevalue("real_data") / "cmu/16"
    return [mocap.resample(mocap.load(folder / f"16_{trial}.amc"), 30) for trial in (15, 16)]


@pytest.fixture(scope="module")
def both(clips):
    """Give the transitions of both, and the graphs."""
    below = 0.25 if clips[0].name == "one" else 0.08
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plain, "BELOW", below)
        slow = plain.find_transitions(clips)
    quick = matching.find_transitions(clips, window=K, below=below)
    return (slow, plain.cut_and_join(clips, slow)), (quick, graphs.from_transitions(clips, quick, window=K))


def test_joint_positions(clips):
    for clip in clips:
        assert np.allclose(plain.joint_positions(clip), joint_positions(clip), atol=1e-12)


def test_transitions_are_the_same_pairs_costs_and_places(both):
    (slow, _), (quick, _) = both
    assert len(slow) > 10
    assert [found[:4] for found in slow] == [(t.source, t.leave, t.target, t.enter) for t in quick]
    assert np.allclose([found[4] for found in slow], quick.cost, atol=1e-9)
    lays = np.array([found[5] for found in slow])
    assert np.allclose(
        lays, np.stack([quick.transform.rotation, quick.transform.translation], axis=1), atol=1e-9
    )


def test_distance_grid_and_its_minima(clips):
    grid = plain.distance_grid(*map(plain.windows, clips))
    assert np.allclose(grid**2, matching.distance_grid(*clips, window=K), atol=1e-9)
    quick = matching.local_minima(grid, 0.3).tolist()
    assert plain.local_minima(grid, 0.3) == [(row, column) for row, column in quick]


def test_align(clips):
    one, other = (plain.windows(clip) for clip in clips)
    turn, move = plain.align(one[3], other[8])
    assert np.allclose(
        [turn, move], [(quick := matching.align(one[3], other[8])).rotation, quick.translation], atol=1e-12
    )


def test_slerp_and_weights():
    """As in [KGP02, Eq. 7]."""
    random = np.random.default_rng(1)
    p, q = (rotations.from_rotvec(3 * random.normal(size=(99, 3))) for _ in range(2))
    share = random.uniform(size=(99, 1))
    cosine = (plain.slerp(p, q, share) * rotations.slerp(p, q, share[:, 0])).sum(-1)
    assert np.allclose(abs(cosine), 1, atol=1e-12)
    assert np.array_equal(plain.slerp(p, p, share), p)
    assert np.allclose(plain.cubic_weights(), blending.cubic_weights(K))


def played(slow, quick):
    roots, turns = slow
    assert np.allclose(roots, quick.root_positions, atol=1e-9)
    assert np.allclose(abs((turns * quick.rotations).sum(-1)), 1, rtol=0, atol=1e-9)


def test_join(clips):
    """As in [KGP02, Eqs. 5 and 6]."""
    a, b = clips
    played(plain.join(a, 12, b, 7), blending.join(a, 12, b, 7, K))


def test_the_graph_its_components_and_what_pruning_keeps(both):
    (_, slow), (_, quick) = both
    for what in ("kind", "frames"):
        assert list(slow.edges(keys=True, data=what)) == list(quick.graph.edges(keys=True, data=what))
    parts = {frozenset(part) for part in plain.components(slow)}
    assert parts == {frozenset(part) for part in nx.strongly_connected_components(slow)}
    assert set(plain.prune(slow).edges(keys=True)) == set(graphs.prune(quick).graph.edges(keys=True))


def test_random_walks_and_their_motions(clips, both):
    """As in [KGP02, 4.1; Eq. 7]."""
    (_, slow), (_, quick) = both
    slow, quick = plain.prune(slow), graphs.prune(quick)
    for seed in range(5):
        walk = plain.random_walk(slow, 8, seed)
        assert walk == synthesis.random_walk(quick, seconds=8, seed=seed)
        turn, move = np.exp(1j * seed), seed * (3 - 4j)
        place = body.PlanarTransform.from_complex(turn, move)
        played(plain.to_motion(clips, slow, walk, turn, move), synthesis.to_motion(quick, walk, start=place))


def test_components_of_a_long_chain():
    chain = nx.MultiDiGraph([(n, n + 1) for n in range(5000)])
    assert len(plain.components(chain)) == 5001


@pytest.mark.parametrize("seed", range(20))
def test_branch_and_bound(seed):
    random = np.random.default_rng(seed)
    ways = [(n, m) for n in range(9) for m in range(n + 1, 9) if m == n + 1 or random.random() < 0.5]
    graph = nx.MultiDiGraph(ways)
    prices = {edge: float(random.integers(1, 9)) for edge in graph.edges(keys=True)}
    nx.set_edge_attributes(graph, 1, "frames")
    nx.set_edge_attributes(graph, prices, "price")

    def step(state, edge):
        return prices[edge], edge[1]

    cost, walk = plain.branch_and_bound(graph, 0, 0, step, lambda node: node == 8)
    quick = synthesis.branch_and_bound(synthesis.Problem(graph, step, lambda node: node == 8), 0, 0)
    assert (cost, walk) == (quick.cost, quick.walk)
    assert cost == nx.dijkstra_path_length(graph, 0, 8, weight="price")


def compiled(clips):
    """Give the pruned graph of some clips in both forms."""
    found = matching.find_transitions(clips, window=K, below=plain.BELOW)
    lays = zip(found.transform.rotation.tolist(), found.transform.translation.tolist(), strict=True)
    slow = [(t.source, t.leave, t.target, t.enter, t.cost, lay) for t, lay in zip(found, lays, strict=True)]
    quick = graphs.prune(graphs.from_transitions(clips, found, window=K))
    return clips, plain.prune(plain.cut_and_join(clips, slow)), graphs.compile_graph(quick)


@pytest.fixture
def graphs_of_walks(request):
    if request.param == "bundled":
        names = ("walk_circle", "walk_curve_1", "walk_curve_2")
        return compiled([mocap.resample(datasets.sample(name), 30)[:900] for name in names])
    return compiled([mocap.resample(clip, 30) for clip in walks_of_16(request.getfixturevalue("real_data"))])


@pytest.mark.parametrize(
    ("graphs_of_walks", "name"), [("bundled", "S"), ("captured", "corner")], indirect=["graphs_of_walks"]
)
def test_a_walk_along_a_line_is_as_near_as_the_packages(name, graphs_of_walks):
    line, (clips, slow, quick) = LINES[name], graphs_of_walks
    roots, _ = plain.follow(clips, slow, plain.points_along(line.points))
    off = [abs(plain.points_along(line.points) - point).min() for point in plain.ground(roots)]
    assert np.mean(off) <= 1.2 * steering.follow_path(quick, line).off.mean()


def test_it_runs_by_itself(tmp_path, capsys):
    clips = tmp_path / "clips"
    clips.mkdir()
    for name in ("walk_circle", "walk_curve_1"):
        mocap.save(mocap.resample(datasets.sample(name), 30)[:240], clips / f"{name}.bvh")
    line, out = tmp_path / "line.csv", tmp_path / "walk.bvh"
    line.write_text("x,z\n0,0\n0,3\n")
    assert plain.main([str(clips), str(line), "-o", str(out)]) == 0
    assert "2 clips make a graph of" in capsys.readouterr().out
    walk = mocap.load(out)
    assert np.linalg.norm(walk.root_positions[-1, [0, 2]] - [0, 3]) < 1
    assert plain.main([str(clips), str(tmp_path / "none.csv"), "-o", str(out)]) == 2
    assert "none.csv" in capsys.readouterr().err
    mocap.save(walk[:8], clips / "short.bvh")
    assert plain.main([str(clips / "short.bvh"), str(line), "-o", str(out)]) == 2
    assert "A window takes 10 frames" in capsys.readouterr().err


def test_a_line_that_no_walk_follows_is_refused():
    clip = mocap.resample(datasets.sample("walk_circle"), 30)[:60]
    still = [replace(clip, root_positions=0 * clip.root_positions)]
    graph = plain.cut_and_join(still, [])
    with pytest.raises(ValueError, match="No walk reaches the end of the line"):
        plain.follow(still, graph, plain.points_along(LINES["S"].points))
