"""What is left is what brute force leaves; what goes, goes for a reason that holds."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mocap.errors import MocapWarning, NoWalk
from mocap.graphs.pruning import Reason, notes_example, prune_graph
from tests.refusals import quietly, refused

WALK, RUN, BOTH = frozenset({"walk"}), frozenset({"run"}), frozenset({"walk", "run"})

edges = st.lists(
    st.tuples(
        st.integers(0, 7),
        st.integers(0, 7),
        st.sampled_from([WALK, RUN, BOTH, frozenset()]),
        st.integers(1, 9),
        st.sampled_from(["clip", "transition"]),
    ),
    max_size=24,
)


def graph_of(rows):
    graph = nx.MultiDiGraph()
    for start, end, labels, frames, kind in rows:
        graph.add_edge(start, end, labels=labels, frames=frames, kind=kind)
    return graph


def closure(nodes, rows):
    """Tell by trying all ways which node reaches which, in at least one step."""
    reach = np.zeros((len(nodes), len(nodes)), bool)
    for start, end, *_ in rows:
        reach[nodes.index(start), nodes.index(end)] = True
    for middle in range(len(nodes)):
        reach |= np.outer(reach[:, middle], reach[middle])
    return reach


def best_by_brute_force(rows):
    """List every component, as (frames, edges) and nodes, the best ones only."""
    nodes = sorted({node for start, end, *_ in rows for node in (start, end)})
    reach = closure(nodes, rows)
    found = []
    for row, _ in enumerate(nodes):
        part = {nodes[i] for i in np.flatnonzero(reach[row] & reach[:, row])}
        inside = [r for r in rows if {r[0], r[1]} <= part]
        frames = sum(length for *_, length, kind in inside if kind == "clip")
        if part and reach[row, row]:
            found.append(((frames, len(inside)), frozenset(part)))
    size = max((size for size, _ in found), default=None)
    return {part for s, part in found if s == size}


@given(edges, st.booleans())
@example([(0, 0, WALK, 9, "clip"), *2 * [(1, 1, WALK, 1, "clip")]], False)  # fewer edges, more frames
def test_brute_force_keeps_the_same(rows, by_labels):
    """As in [KGP02, 3.4]."""
    sets = {labels for _, _, labels, *_ in rows} if by_labels else {frozenset()}
    best = {s: best_by_brute_force([r for r in rows if not by_labels or r[2] == s]) for s in sets}
    best = {labels: parts for labels, parts in best.items() if parts}
    graph = graph_of(rows)
    if not best:
        refused("no cycle", prune_graph, graph, by_labels=by_labels, kind=NoWalk)
        return
    found = quietly(prune_graph, graph, by_labels=by_labels)
    assert set(found.components) == set(best)
    assert all(nodes in best[labels] for labels, nodes in found.components.items())
    kept = set().union(*found.components.values())
    assert set(found.graph) == kept
    assert set(found.orphans) == set(graph) - kept
    within = sorted(e for e in graph.edges(keys=True) if {*e[:2]} <= kept)
    assert sorted(found.graph.edges(keys=True)) == within
    assert {*found.removed} == {*graph.edges(keys=True)} - {*found.graph.edges(keys=True)}
    assert list(found.graph) == [node for node in graph if node in kept]
    assert all(degree > 0 for _, degree in found.graph.out_degree())


@given(edges, st.booleans())
def test_every_reason_holds(rows, by_labels):
    try:
        graph = graph_of(rows)
        found = quietly(prune_graph, graph, by_labels=by_labels)
    except NoWalk:
        return
    nodes = sorted(graph)
    reach = closure(nodes, rows)
    kept = [nodes.index(node) for node in found.graph]

    def holds(reason, node):
        i = nodes.index(node)
        cycle, before, after = reach[i, i], reach[i, kept].any(), reach[kept, i].any()
        return {
            Reason.DEAD_END: not cycle,
            Reason.SINK: cycle and not before,
            Reason.UNREACHED: cycle and before and not after,
            Reason.ASIDE: cycle and before and after,
        }[reason]

    for (start, end, _), reason in found.removed.items():
        assert holds(reason, end if end in found.orphans else start)


def test_the_graph_of_the_notes():
    """As in [KGP02, 3.4]."""
    graph = notes_example()
    found = prune_graph(graph)
    assert set(found.components[frozenset()]) == {1, 2, 3, 6, 7, 8}
    assert nx.is_path(found.graph, [6, 7, 8, 3, 1, 2])
    assert found.removed == {
        (3, 4, 0): Reason.SINK,
        (4, 4, 0): Reason.SINK,
        (6, 5, 0): Reason.DEAD_END,
        (7, 5, 0): Reason.DEAD_END,
    }
    assert found.report().splitlines() == [
        "kept 6 nodes and 7 edges",
        "removed 2 nodes and 4 edges",
        "  2 edges: dead end: on no cycle",
        "  2 edges: sink: on a cycle, but reaches nothing that is kept",
    ]
    assert set(graph) == set(range(1, 9))


def ring(start, labels, frames=10):
    return [(start, start + 1, labels, frames, "clip"), (start + 1, start, labels, 5, "transition")]


def test_both_warnings_come_with_their_numbers():
    """As in [KGP02, warnings]."""
    rows = [*ring(0, WALK), *ring(2, RUN, 7), (0, 2, BOTH, 5, "transition")]
    with pytest.warns(MocapWarning) as caught:
        found = prune_graph(graph_of(rows), by_labels=True, least_frames=8)
    assert [str(warning.message) for warning in caught] == [
        "7 frames of clip stay with run, fewer than the 8 asked for.",
        "No way leads from run (2 nodes) to walk (2 nodes): allow costlier transitions between the two.",
    ]
    assert found.graph.has_edge(0, 2) and "  2 nodes: run" in found.report().splitlines()


def test_a_kind_that_is_lost_is_told():
    with pytest.warns(MocapWarning, match="^0 frames of clip stay with run, fewer than the 1 asked for"):
        prune_graph(graph_of([*ring(0, WALK), (2, 3, RUN, 30, "clip")]), by_labels=True)
    with pytest.warns(MocapWarning, match="^10 frames of clip stay, fewer than the 60 asked for"):
        prune_graph(graph_of(ring(0, WALK)), least_frames=60)


def test_a_ring_that_mixes_kinds_is_set_aside():
    rows = [*ring(0, WALK), *ring(4, RUN), (1, 2, BOTH, 5, "transition"), (2, 0, BOTH, 5, "transition")]
    found = quietly(prune_graph, graph_of(rows), by_labels=True)
    assert {found.removed[e] for e in ((1, 2, 0), (2, 0, 0))} == {Reason.ASIDE}


def test_without_a_cycle_there_is_no_walk():
    for graph in (nx.MultiDiGraph(), graph_of([(0, 1, WALK, 9, "clip")])):
        refused("no cycle,", prune_graph, graph, kind=NoWalk)
    mixed = graph_of([(0, 1, WALK, 9, "clip"), (1, 0, RUN, 9, "clip")])
    refused("no cycle of edges with the same labels", prune_graph, mixed, by_labels=True, kind=NoWalk)
    assert len(prune_graph(mixed).graph) == 2
