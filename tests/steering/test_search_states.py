"""What a beam search does with its walks, one step at a time."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.ground_path import s_curve
from mocap.graphs.compiled_graph import AHEAD
from mocap.steering.path_objective import Prices, Wishes, make_route
from mocap.steering.search_states import (
    States,
    crowding,
    expand,
    hop_costs,
    prune,
    score,
    search_space,
    standing,
    start_states,
)
from tests.bundled import sneaking, walking
from tests.strategies import seeds

GRAPH = walking()


def space_of(graph=GRAPH, wishes=None, prices=None):
    return search_space(graph, make_route(graph, s_curve(), wishes or Wishes()), prices or Prices())


def at_nodes(nodes):
    """Stand at nodes over the origin."""
    none = np.zeros(len(nodes), np.intp)
    return States(nodes, none + 1 + 0j, none + 0j, none + 0.0, none, none + 0.0, none, none - 1)


def test_seventy_thousand_nodes_are_all_different():
    """Nodes 5 and 65 541 once got one key of 48 bits, and one of two walks was dropped."""
    nodes = np.arange(70_000)
    space = SimpleNamespace(
        graph=SimpleNamespace(at=np.zeros(len(nodes), complex), fps=30.0), route=SimpleNamespace(others=())
    )
    walks = at_nodes(nodes)
    cells = standing(space, walks, 0.1, 0.1)
    assert np.array_equal(prune(walks, nodes.astype(float), cells, 100_000).node, nodes)


@given(seeds, st.integers(1, 60), st.integers(1, 5), st.integers(1, 40))
def test_of_walks_that_stand_alike_the_best_stays_and_of_these_the_best_few(seed, count, kinds, width):
    random = np.random.default_rng(seed)
    cells = random.integers(-kinds, kinds, (3, count))
    scores = random.integers(0, 10, count).astype(float)
    best = {}
    for walk in sorted(range(count), key=lambda walk: scores[walk]):  # stable, as pruning is
        best.setdefault(tuple(cells[:, walk]), walk)
    kept = prune(at_nodes(np.arange(count)), scores, cells, width)
    assert kept.node.tolist() == list(best.values())[:width]


def test_walks_stand_alike_by_node_place_turn_and_where_others_walk_by_time():
    apart = {"node": 1, "move": 0.2, "turn": np.exp(0.2j), "frames": 30}
    for others, told in (((), 4), ([np.zeros((9, 2))], 5)):
        space = space_of(wishes=Wishes(others=others))
        one = at_nodes(np.array([7]))
        two = [one._replace(**{field: getattr(one, field) * 0 + value}) for field, value in apart.items()]
        cells = standing(space, States.join([one, one, *two]), 0.1, 0.1)
        assert len(np.unique(cells, axis=1).T) == told


def test_a_seam_costs_its_price_and_its_squared_distance():
    prices = Prices(seam=0.7, match=11.0, stray=0.0)
    space, free = space_of(prices=prices), space_of(prices=Prices(seam=0.0, match=0.0, stray=0.0))
    start = start_states(GRAPH, np.array([3, 200, 500]), 0j, 0.2)
    dear, cheap = expand(space, start, 0), expand(free, start, 0)
    edge = GRAPH.hops.last[dear.hop]
    expected = np.where(GRAPH.blended[edge], 0.7 + 11.0 * GRAPH.cost[edge] ** 2, 0.0)
    assert GRAPH.blended[edge].any()
    assert dear.cost - cheap.cost == pytest.approx(expected)


def test_a_hop_costs_what_its_frames_are_off():
    """Against the frames of each hop, one after the other."""
    graph = sneaking()
    wishes = Wishes(labels=[(0, "sneak"), (5, "")], times=[(0, 0.0), (19, 30.0)])
    space = space_of(graph, wishes)
    start = start_states(graph, np.array([3, 400]), 0j, 0.2)
    start = start._replace(along=np.array([1.0, 4.5]), frames=np.array([20, 90]))
    of, hop = graph.hops.leaving(start.node)
    costs = hop_costs(space, start, of, hop)
    for number in range(0, len(hop), 3):
        walk, cost = of[number], 0.0
        rows, _ = graph.hops.rows(hop[[number]])
        along = start.along[walk] + np.cumsum(np.maximum(graph.tracks.step[rows], 0.3 / 30))
        for count, (row, metres) in enumerate(zip(rows, along, strict=True)):
            body = start.move[walk] + start.turn[walk] * graph.tracks.ground[row]
            off = abs(body - space.route.at(np.array([metres]))[0]) ** 2
            cost += off + 100 * off**2
            point = space.route.point(np.array([metres]))[0]
            sneaks = graph.labels.bears[graph.label_number("sneak"), row]
            cost += 0.1 * (space.route.label[point] >= 0 and not sneaks)
            cost += 0.2 * ((start.frames[walk] + count) / 30 - space.route.clock[point]) ** 2
        assert costs[number] == pytest.approx(cost, rel=1e-6)


def test_the_promise_of_a_walk_is_bounded_by_what_a_transition_could_save():
    space = space_of()
    walks = start_states(GRAPH, np.arange(50), 0j, 0.0)._replace(cost=np.arange(50.0))
    assert np.array_equal(score(space, walks, 0.0), walks.cost)
    lost = score(space, walks, np.inf) - walks.cost
    assert (lost > 0).all()
    assert score(space, walks, 0.5) - walks.cost == pytest.approx(np.minimum(lost, 0.5))


def test_looking_ahead_a_walk_sees_others_in_its_way():
    """Someone stands 2 m ahead: a second's walk away, and as far beyond as it takes to give way."""
    ahead = [np.tile([0.0, 2.0], (3, 1))]
    nodes = np.arange(0, len(GRAPH.nodes), 40)
    scores = []
    for others in ((), ahead):
        wishes = Wishes(others=others, apart=0.8)
        space = search_space(GRAPH, make_route(GRAPH, s_curve(), wishes), Prices(crowding=50.0))
        scores.append(score(space, start_states(GRAPH, nodes, 0j, 0.0), np.inf))
    assert (scores[1] >= scores[0]).all()
    assert (scores[1] > scores[0] + 1.0).mean() > 0.5


def test_a_body_pays_for_the_square_of_how_much_it_is_too_near():
    """To another one that stands still at its end, 5 m ahead, from frame 1 on."""
    wishes = Wishes(others=[np.array([[0.0, 2.0], [0.0, 5.0]])], apart=0.8)
    space = space_of(wishes=wishes, prices=Prices(crowding=50.0))
    body, frame = np.array([2.5, 2.5, 5 + 0.5j, 5.0, 9.0]) + 0j, np.array([0, 1, 1, 9, 9])
    too_near = np.array([0.3, 0.0, 0.3, 0.8, 0.0])
    assert crowding(space, body, frame) == pytest.approx(50 * too_near**2)


@pytest.mark.parametrize(("times", "seen"), [(1, 1), (2, 1), (3, 1), (4, 0)])
def test_others_are_seen_up_to_three_times_as_far_ahead_as_the_clip(times, seen):
    """Someone is there only at the moment at which the walk would be, if it went straight on."""
    walk = start_states(GRAPH, np.array([5]), 0j, 0.0)
    body, end = (walk.move + walk.turn * points[5] for points in (GRAPH.at, GRAPH.ahead[:, -1]))
    frame = times * round(GRAPH.fps * AHEAD[-1])
    other = np.full((frame + 2, 2), 1000.0)
    place = (body + times * (end - body))[0]
    other[frame] = place.imag, place.real
    found = []
    for others in ((), [other]):
        space = space_of(wishes=Wishes(others=others, apart=0.3), prices=Prices(crowding=50.0))
        found.append(score(space, walk, np.inf)[0])
    # The last point ahead stands for the frames since the one before.
    assert found[1] - found[0] == pytest.approx(seen * 50 * 0.3**2 * GRAPH.fps * AHEAD[0])
