"""What a layered search does with its walks, whatever they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.steering.layered_search import LayeredSearch, select, standing, start_states
from tests.strategies import seeds


def test_seventy_thousand_nodes_are_all_different():
    """Nodes 5 and 65 541 once got one key of 48 bits, and one of two walks was dropped."""
    nodes, zero = np.arange(70_000), np.zeros(70_000, complex)
    cells = standing(start_states(nodes, zero + 1, zero), zero, 0.1, 0.1)
    assert np.array_equal(select(nodes.astype(float), cells, 100_000), nodes)


@given(seeds, st.integers(1, 60), st.integers(1, 5), st.integers(1, 40))
def test_of_walks_that_stand_alike_the_best_stays_and_of_these_the_best_few(seed, count, kinds, width):
    random = np.random.default_rng(seed)
    cells = random.integers(-kinds, kinds, (3, count))
    scores = random.integers(0, 10, count).astype(float)
    best = {}
    for walk in sorted(range(count), key=lambda walk: scores[walk]):  # stable, as the selection is
        best.setdefault(tuple(cells[:, walk]), walk)
    assert select(scores, cells, width).tolist() == list(best.values())[:width]


class Stairs(LayeredSearch):
    """Walks that climb to step 7 by one or by two steps at a time; a double step costs 3, a single one 2."""

    def expand(self, states):
        twice = np.repeat(np.arange(len(states.node)), 2)
        step = np.tile([1, 2], len(states.node))
        node, cost = states.node[twice] + step, states.cost[twice] + step + 1
        return states.take(twice)._replace(node=node, cost=cost, trail=twice, hop=step)

    def score(self, states):
        return states.cost

    def cells(self, states):
        return np.stack([states.node, 0 * states.node if self.merge else np.arange(len(states.node))])

    def layers(self, states):
        return states.node // 2  # so that a walk can stay in its layer for two rounds

    def done(self, states):
        return states.node >= 7


@pytest.mark.parametrize("merge", [False, True])
def test_the_best_of_all_walks_arrives(merge):
    zero = np.zeros(1, complex)
    search = Stairs(start_states(np.array([0]), zero + 1, zero), 1000)
    search.merge = merge
    rounds = list(search)
    assert rounds[0].node.tolist() == [0] and len(rounds) == len(search.history)
    assert search.expanded == sum(len(states.node) for states in rounds)
    ends = [(states, row) for states in search.arrived for row in range(len(states.node))]
    states, row = min(ends, key=lambda end: end[0].cost[end[1]])
    assert states.cost[row] == 11  # three double steps and a single one
    walk = search.trace(states, row)
    assert walk.hop[1:].sum() == walk.node[-1] >= 7 and walk.node[0] == 0
    assert walk.cost[-1] == (walk.hop[1:] + 1).sum()
