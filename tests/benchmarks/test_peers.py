"""Works beside those of other libraries, or beside the least that they could take, in one run.

See the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_peers.py

A library that is not installed is skipped: `pip install upc-pymotion` for the first.
"""

from functools import cache

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.rotations import to_matrix
from mocap.graphs import prune
from mocap.graphs.components import largest_component, numbered_edges
from mocap.synthesis import random_walk, to_motion
from tests.benchmarks.timing import fastest, hold, ratio
from tests.bundled import walking

pytestmark = pytest.mark.benchmark

COUNT = 500_000  # rotations
HOUR = 3600.0  # seconds


def random_rotations(seed):
    quaternions = np.random.default_rng(seed).normal(size=(COUNT, 4))
    return quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)


def test_slerp_beside_pymotion():
    peer = pytest.importorskip("pymotion.rotations.quat")
    start, end = random_rotations(0), random_rotations(1)
    amounts = np.random.default_rng(2).random(COUNT)

    def ours():
        return rotations.slerp(start, end, amounts)

    hold("slerp, in pymotion's", ratio(ours, lambda: peer.slerp(start, end, amounts[:, None])), 1.1)


def test_slerp_beside_a_copy_of_its_rotations():
    start, end = random_rotations(0), random_rotations(1)
    amounts = np.random.default_rng(2).random(COUNT)
    work = ratio(lambda: rotations.slerp(start, end, amounts), lambda: (start.copy(), end.copy()))
    hold("slerp, in copies of its rotations", work, 12)


def edges_and_frames(graph):
    ends = numbered_edges(graph)
    data = [edge for _, _, edge in graph.edges(data=True)]
    return ends, np.array([edge["frames"] if edge["kind"] == "clip" else 0 for edge in data])


def test_pruning_beside_components_of_scipy():
    """The component is found in little more than SciPy's time; the rest is a new graph of networkx.

    To list the edges of the graph once takes some 20 times as long as SciPy's components, and to copy it some
    90 times. Pruning is therefore held to copies.
    """
    source = walking().source
    ends, frames = edges_and_frames(source.graph)
    count = len(source.graph)

    def components():
        adjacency = coo_array((np.ones(len(ends), bool), tuple(ends.T)), shape=(count, count))
        return connected_components(adjacency, directed=True, connection="strong")

    hold(
        "largest component, in SciPy's", ratio(lambda: largest_component(ends, frames, count), components), 3
    )
    hold("prune, in SciPy's components", ratio(lambda: prune(source), components), 90)
    hold("prune, in copies of its graph", ratio(lambda: prune(source), source.graph.copy), 2)


@cache
def hour():
    source = walking().source
    return random_walk(source, seconds=HOUR, seed=1)


def gather_an_hour():
    """Copy as many poses as an hour has, from random frames of a clip."""
    clip = max(walking().source.clips, key=len)
    chosen = np.random.default_rng(0).integers(0, len(clip), round(HOUR * clip.fps))
    return lambda: (clip.root_positions[chosen], clip.rotations[chosen])


def test_an_hour_of_random_walk_beside_gathering_its_frames():
    source = walking().source
    gather = gather_an_hour()
    hold("edges of an hour, in gathers", ratio(lambda: random_walk(source, seconds=HOUR), gather), 10)
    hold("motion of an hour, in gathers", ratio(lambda: to_motion(source, hour()), gather, 3), 40)


def test_forward_kinematics_beside_memory_traffic():
    """The traffic is one copy of all that is read and written.

    Two parts alone take about ten copies: the conversion of quaternions to matrices by SciPy, and the
    products of matrices down the tree by NumPy.
    """
    motion = to_motion(walking().source, hour())[:15_000]
    poses = forward_kinematics(motion)
    numbers = np.empty(poses.positions.size + poses.matrices.size + motion.rotations.size)
    matrices = to_matrix(np.swapaxes(motion.rotations, 0, 1))
    world = np.empty_like(matrices)

    def multiply():
        world[0] = matrices[0]
        for joint, parent in enumerate(motion.skeleton.parents[1:], start=1):
            np.matmul(world[parent], matrices[joint], out=world[joint])

    whole, conversion, products, copy = fastest(
        lambda: forward_kinematics(motion), lambda: to_matrix(motion.rotations), multiply, numbers.copy
    )
    print(f"\nconversion: {conversion / copy:.1f} copies, products: {products / copy:.1f} copies")
    hold("forward kinematics, in copies", whole / copy, 14)
    hold("forward kinematics, in its conversion and products", whole / (conversion + products), 1.3)
