"""Nodes are configurations that come again, and their share of the simulation is said."""

import warnings

import numpy as np
import pytest

from mocap.errors import MocapError, MocapWarning
from mocap.methods.groups.clustering import cluster
from mocap.methods.groups.flocking import Trajectories
from tests.methods.groups.built import flock


@pytest.mark.parametrize(("count", "nodes", "covered"), [(12, 8, 0.85), (6, 6, 0.85), (12, 4, 0.85)])
def test_few_nodes_cover_most_of_a_simulation(count, nodes, covered):
    found = cluster(flock(count, 300.0), nodes=nodes)
    assert len(found.nodes) <= nodes and found.covered >= covered
    near = (found.distances[found.frames // 10] < 0.5).any(axis=0)
    assert near.mean() == pytest.approx(found.covered)


def test_the_first_node_has_the_most_others_near():
    found = cluster(flock(6, 120.0), nodes=3)
    assert (found.distances < 0.5).sum(axis=1).argmax() == found.frames[0] // 10


def test_nodes_are_the_same_wherever_the_flock_walked_and_whatever_its_numbers():
    walked = flock(6, 120.0)
    order = np.random.default_rng(2).permutation(6)
    moved = Trajectories(*(part[:, order] * np.exp(1.2j) for part in walked))
    moved = Trajectories(moved.places + 30 - 7j, moved.velocities)
    one, other = cluster(walked, nodes=4), cluster(moved, nodes=4)
    np.testing.assert_array_equal(one.frames, other.frames)
    np.testing.assert_allclose(one.distances, other.distances, atol=1e-6)


def test_where_nodes_cover_little_it_says_so():
    with pytest.warns(MocapWarning, match=r"1 nodes are within 0.3 m of \d+% of what was simulated"):
        cluster(flock(12, 60.0), nodes=1, reach=0.3)


def test_it_ends_where_all_are_covered():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(cluster(flock(6, 60.0), nodes=50, reach=2.0).nodes) < 50


def test_no_frames_have_no_nodes():
    with pytest.raises(MocapError, match="There is no frame to take nodes from"):
        cluster(Trajectories(*np.zeros((2, 0, 3), complex)))


@pytest.mark.parametrize("wrong", [{"nodes": 0}, {"reach": 0.0}, {"reach": np.nan}])
def test_what_makes_no_sense_is_refused(wrong):
    with pytest.raises(MocapError, match="a node or more and a reach above 0"):
        cluster(flock(6, 30.0), **wrong)
