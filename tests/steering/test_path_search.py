"""The search in layers: as good as trying everything where nothing is cut, and honest when stopped."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import resample
from mocap.body.ground_path import GroundPath, s_curve
from mocap.datasets.samples import sample
from mocap.editing import LIMIT
from mocap.errors import NoWalk
from mocap.graphs import build
from mocap.graphs.compiled_graph import compile_graph
from mocap.graphs.motion_graph import from_transitions
from mocap.graphs.tuned import TUNED
from mocap.steering import path_search
from mocap.steering.bent_following import plan_bending
from mocap.steering.layered_search import LayeredSearch, States, select, standing, start_states
from mocap.steering.path_following import follow_path, path_problem, start_of
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import PathSearch
from mocap.synthesis.bounded_search import branch_and_bound
from mocap.synthesis.ground_walks import GroundWalks, Stand
from tests.bundled import sneaking, walking
from tests.refusals import refused
from tests.strategies import seeds, wave


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
        return states.take(twice)._replace(node=node, cost=cost, trail=twice, macro_edge=step)

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
    assert walk.macro_edge[1:].sum() == walk.node[-1] >= 7 and walk.node[0] == 0
    assert walk.cost[-1] == (walk.macro_edge[1:] + 1).sum()


@given(seeds, st.integers(2, 20))
def test_points_are_met_and_lines_join_them(seed, count):
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 2)) @ [1, 1j]
    route = Route(points, 0.1, np.full(count, -1), np.full(count, np.nan))
    along = np.linspace(-1, route.length + 1, 50)
    places = np.arange(count) * 0.1
    expected = np.interp(along, places, points.real) + 1j * np.interp(along, places, points.imag)
    assert route.at(along) == pytest.approx(expected)
    assert points[route.point(places + 0.05)] == pytest.approx(points)
    assert np.abs(route.directions) == pytest.approx(np.ones(count))
    assert route.bare


def test_a_path_may_be_as_long_as_the_clips_walk_in_an_hour():
    graph = walking()
    speeds = graph.step[graph.first[~graph.blended]] * graph.fps
    make_route(graph, GroundPath([[0, 0], [0, 3600 * speeds.mean()]]), PathRequest())
    refused(
        "more than an hour", make_route, graph, GroundPath([[0, 0], [0, 3600 * speeds.max()]]), PathRequest()
    )


GRAPH = walking()
FREE = {"seam": 0.0, "match": 0.0, "stray": 0.0}


def search_on(graph=GRAPH, request=None, **settings):
    route = make_route(graph, s_curve(), request or PathRequest())
    return PathSearch(graph, route, at_nodes(graph, [0]), Settings(**settings))


def at_nodes(graph, nodes, heading=0.0):
    """Stand at nodes over the origin, and go in one direction."""
    nodes = np.array(nodes)
    turn = np.exp(1j * (heading - graph.going[nodes]))
    return start_states(nodes, turn, -turn * graph.at[nodes])


def test_without_cuts_and_prices_it_finds_what_branch_and_bound_finds():
    """The paper's search is the oracle; sliding along the path, which it does not know, is turned off.

    As in [KGP02, 5.1].
    """
    path = GroundPath([[0, 0], [0.1, 0.45], [0.3, 0.75]])
    request, exact = PathRequest(correction=0.0), Settings(**FREE, width=10**6, cell=1e-6, rescue=0.0)
    route = make_route(GRAPH, path, request)
    for node in (3, 200, 500):
        start = at_nodes(GRAPH, [node], 0.2)
        found = path_search.find_walk(GRAPH, route, start, exact)
        stand = Stand(complex(start.rotation[0]), complex(start.translation[0]))
        problem = path_problem(GroundWalks(GRAPH), route)
        best = branch_and_bound(problem, GRAPH.nodes[node], stand)
        # A macro-edge may ride on past the end of the path, to which the paper's walk stops: never for less.
        assert found.cost >= best.cost - 1e-12
        walked = 0.0
        for edge in found.edges:
            if problem.done(stand):
                break
            more, stand = problem.step(stand, GRAPH.edges[edge])
            walked += more
        assert walked <= 1.2 * best.cost + 1e-3


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_a_wider_beam_costs_more_and_follows_better_and_the_work_is_linear_in_the_length():
    narrow, wide = (follow_path(GRAPH, s_curve(15), settings=Settings(width=w, tries=1)) for w in (3, 100))
    assert wide.found.cost < narrow.found.cost
    assert wide.found.expanded > 10 * narrow.found.expanded
    assert wide.found.cut > 0
    once = Settings(tries=1)
    short, long = (follow_path(GRAPH, s_curve(m), settings=once).found.expanded for m in (10, 40))
    assert 3 < long / short < 5


def test_a_search_is_driven_from_outside_a_round_at_a_time():
    """The rounds that it gives are its history, and the walk traced through them is the one that is found."""
    request, settings = PathRequest(), Settings()
    route = make_route(GRAPH, s_curve(8), request)
    starts = start_of(GRAPH, route, request)
    search = PathSearch(GRAPH, route, starts, settings)
    rounds = list(search)
    assert [len(states.node) for states in rounds] == [len(states.node) for states in search.history]
    assert max(len(states.node) for states in rounds) == search.width == 50
    found = search.best_walk("")
    assert np.array_equal(found.edges, path_search.find_walk(GRAPH, route, starts, settings).edges)
    last = States.join(search.arrived)
    walk = search.trace(last, int(last.cost.argmin()))
    assert np.array_equal(GRAPH.macro_edges.edges(walk.macro_edge[1:]), found.edges)
    assert (np.diff(walk.cost) >= 0).all() and walk.trail[0] == -1
    assert np.array_equal(GRAPH.target[GRAPH.macro_edges.last[walk.macro_edge[1:]]], walk.node[1:])


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_an_interruption_gives_the_best_walk_so_far():
    def interrupted(layers):
        yield from layers[:40]
        raise KeyboardInterrupt

    followed = follow_path(GRAPH, s_curve(), settings=Settings(progress=interrupted))
    assert followed.found.stopped == "interrupted"
    assert followed.report().endswith("interrupted: the best so far")
    assert 0.05 < followed.progress < 0.9
    assert followed.off.mean() < 0.1
    with pytest.raises(NoWalk, match="interrupted before its first step"):
        follow_path(GRAPH, s_curve(), settings=Settings(progress=lambda layers: interrupted(layers[:0])))


def test_a_graph_that_ends_is_told():
    line = compile_graph(from_transitions([wave(120)], [], window=8))
    with pytest.raises(NoWalk, match=r"Every walk ends after 2\.. m of the path: prune"):
        follow_path(line, GroundPath([[0, 0], [0, 50]]))


def test_it_is_told_how_far_the_farthest_walk_came():
    search = search_on()
    search.history = [at_nodes(GRAPH, [3, 4])._replace(along=np.array([2.5, 1.0]))]
    refused("ends after 2.5 m", search.best_walk, "", kind=NoWalk)


def test_walks_stand_alike_by_node_place_turn_and_where_others_walk_by_time():
    apart = {"node": 1, "translation": 0.2, "rotation": np.exp(0.2j), "frames": 30}
    one = start_states(np.array([7]), np.ones(1, complex), np.zeros(1, complex))
    two = [one._replace(**{field: getattr(one, field) * 0 + value}) for field, value in apart.items()]
    for others, told in (((), 4), ([np.zeros((9, 2))], 5)):
        cells = search_on(request=PathRequest(others=others)).cells(States.join([one, one, *two]))
        assert len(np.unique(cells, axis=1).T) == told


def test_a_seam_costs_its_price_and_its_squared_distance():
    start = at_nodes(GRAPH, [3, 200, 500], 0.2)
    dear = search_on(**FREE | {"seam": 0.7, "match": 11.0}).expand(start)
    cheap = search_on(**FREE).expand(start)
    edge = GRAPH.macro_edges.last[dear.macro_edge]
    expected = np.where(GRAPH.blended[edge], 0.7 + 11.0 * GRAPH.cost[edge] ** 2, 0.0)
    assert GRAPH.blended[edge].any()
    assert dear.cost - cheap.cost == pytest.approx(expected)


def test_a_macro_edge_costs_what_its_frames_are_off():
    """Against the frames of each macro-edge, one after the other."""
    graph = sneaking()
    request = PathRequest(labels=[(0, "sneak"), (5, "")], times=[(0, 0.0), (19, 30.0)])
    search = search_on(graph, request)
    route = search.route
    start = at_nodes(graph, [3, 400], 0.2)
    start = start._replace(along=np.array([1.0, 4.5]), frames=np.array([20, 90]))
    of, macro_edge = graph.macro_edges.leaving(start.node)
    costs = search.macro_edge_costs(start, of, macro_edge)
    for number in range(0, len(macro_edge), 3):
        walk, cost = of[number], 0.0
        rows, _ = graph.macro_edges.rows(macro_edge[[number]])
        along = start.along[walk] + np.cumsum(np.maximum(graph.step[rows], 0.3 / 30))
        for count, (row, metres) in enumerate(zip(rows, along, strict=True)):
            body = start.translation[walk] + start.rotation[walk] * graph.ground[row]
            off = abs(body - route.at(np.array([metres]))[0]) ** 2
            cost += off + 100 * off**2
            point = route.point(np.array([metres]))[0]
            sneaks = graph.bears[graph.label_number("sneak"), row]
            cost += 0.1 * (route.label[point] >= 0 and not sneaks)
            cost += 0.2 * ((start.frames[walk] + count) / 30 - route.clock[point]) ** 2
        assert costs[number] == pytest.approx(cost, rel=1e-6)


def test_a_bent_walk_pays_for_turning_the_clips_and_for_standing():
    """Frame by frame, on a straight line, where a clip that walks a bend has to be turned."""
    graph = compile_graph(build([resample(sample("stop_and_go"), 30)], window=10, threshold=0.04))
    route, _ = plan_bending(graph, GroundPath([[0, 0], [0, 9]]), PathRequest(), LIMIT)
    search = PathSearch(graph, route, at_nodes(graph, [0]), Settings(bend=0.5))
    rows = np.arange(len(route.smooth.step))
    costs = search._bending_costs(route.smooth, rows, np.full(len(rows), 1.0))
    stands = route.smooth.step < 0.3 / 30
    assert 0.2 < stands.mean() < 0.8
    assert costs == pytest.approx(0.5 * (route.rotations * 30) ** 2 + 0.1 * stands)


def test_the_promise_of_a_walk_is_bounded_by_what_a_transition_could_save():
    walks = at_nodes(GRAPH, range(50))._replace(cost=np.arange(50.0))
    none, half, every = (search_on(rescue=rescue).score(walks) - walks.cost for rescue in (0.0, 0.5, np.inf))
    assert not none.any() and (every > 0).all()
    assert half == pytest.approx(np.minimum(every, 0.5))


@pytest.mark.parametrize(("times", "seen"), [(1, 1), (2, 1), (3, 1), (4, 0)])
def test_others_are_seen_up_to_three_times_as_far_ahead_as_the_clip(times, seen):
    """Someone is there only at the moment at which the walk would be, if it went straight on."""
    walk = at_nodes(GRAPH, [5])
    body, end = (walk.translation + walk.rotation * points[5] for points in (GRAPH.at, GRAPH.ahead[:, -1]))
    frame = times * round(GRAPH.fps * TUNED.ahead[-1])
    other = np.full((frame + 2, 2), 1000.0)
    place = (body + times * (end - body))[0]
    other[frame] = place.imag, place.real
    alone, found = (
        search_on(request=PathRequest(others=others, apart=0.3), crowding=50.0, rescue=np.inf).score(walk)[0]
        for others in ((), [other])
    )
    # The last point ahead stands for the frames since the one before.
    assert found - alone == pytest.approx(seen * 50 * 0.3**2 * GRAPH.fps * TUNED.ahead[0])
