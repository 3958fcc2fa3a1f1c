"""Clips of five bodies, from three makers of files, on one skeleton and in one motion graph."""

import itertools
import warnings
from collections import Counter

import networkx as nx
import numpy as np
import pytest

from mocap import load
from mocap.body.kinematics import joint_positions
from mocap.body.motion import resample
from mocap.datasets.cmu_database import cmu
from mocap.editing.retargeting import retarget
from mocap.editing.stances import stance_of, stance_of_walk
from mocap.graphs.motion_graph import MotionGraph, build
from mocap.graphs.pruning import prune
from mocap.synthesis.walk_to_motion import to_motion
from tests.editing.test_retargeted import slide

pytestmark = pytest.mark.exhaustive  # tests/datasets/test_cmu_database.py joins three people quickly

TRIALS = {"16": ("16_15", "16_17", "16_19", "16_31", "16_32"), "02": ("02_01", "02_02"), "49": ("49_01",)}
FILES = {
    "Bandai-Namco": "bvh/bandai_namco/dataset-?_walk*normal*.bvh",
    "puppy": "bvh/puppy0512_motion_graph/walk_normal_*ght*.bvh",
    "cgspeed": "bvh/cmu_cgspeed_bvh11/131_0[1-4].bvh",  # where there are any
}
METRES = 0.10  # people differ by more than the steps of one person, for which 0.04 is enough


@pytest.fixture(scope="module")
def clips(real_data):
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        patch.setenv("MOCAP_DATA", str(real_data / "cmu"))
        walk = cmu("16_15")
        body, mean = stance_of(walk), stance_of_walk(walk)
        found = {who: [cmu(name, skeleton=body) for name in names] for who, names in TRIALS.items()}
        for who, pattern in FILES.items():
            others = [
                load(path, scale=0.0564444 if who == "cgspeed" else None)
                for path in sorted(real_data.glob(pattern))
            ]
            onto = mean if who == "Bandai-Namco" else body
            found[who] = [retarget(other, onto, stance_of(other)) for other in others]
    return {who: [resample(clip, 30) for clip in mine] for who, mine in found.items() if mine}


def graph_of(clips: dict) -> tuple[MotionGraph, list[str]]:
    """Build one graph of all clips, pruned, and name each clip's owner."""
    owners = [who for who, mine in clips.items() for _ in mine]
    return prune(build(list(itertools.chain(*clips.values())), window=10, threshold=METRES)), owners


def joined(graph: MotionGraph, owners: list[str]) -> Counter:
    """Count the transitions between each two bodies."""
    edges = [(u, v) for u, v, kind in graph.graph.edges(data="kind") if kind == "transition"]
    return Counter(tuple(sorted((owners[u[0]], owners[v[0]]))) for u, v in edges)


def test_five_bodies_share_one_graph_and_a_walk_goes_through_all_of_them(clips):
    graph, owners = graph_of(clips)
    counts = joined(graph, owners)
    across = sum(count for pair, count in counts.items() if pair[0] != pair[1])
    print(f"\n{sum(counts.values())} transitions, {across} between different bodies: {dict(counts)}")
    assert across > 500
    assert {owners[clip] for clip, _ in graph.graph} == set(clips)
    chosen = {owners[node[0]]: node for node in graph.graph}  # a node of each
    stops = [chosen[who] for who in clips]
    nodes = [stops[0]]
    for start, end in itertools.pairwise(stops):
        nodes += nx.shortest_path(graph.graph, start, end, weight="frames")[1:]
    edges = [(u, v, next(iter(graph.graph[u][v]))) for u, v in itertools.pairwise(nodes)]
    motion = to_motion(graph, edges)
    assert {owners[u[0]] for u, _, _ in edges} == set(clips)
    feet = [motion.skeleton.index(name) for name in ("lfoot", "rfoot", "ltoes", "rtoes")]
    assert joint_positions(motion)[:, feet, 1].min() > -0.02
    assert np.isfinite(slide(motion, stance_of(motion)))


def test_three_people_share_one_graph(clips):
    few = {who: clips[who][:2] for who in ("16", "02", "49")}
    graph, owners = graph_of(few)
    counts = joined(graph, owners)
    assert all(counts[tuple(sorted(pair))] for pair in (("16", "02"), ("16", "49")))
