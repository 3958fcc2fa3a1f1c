"""The paper's search follows short paths, and ours follows long ones better."""

import numpy as np
import pytest
from asked_lines import random_line

from mocap.body.ground_path import GroundPath, s_curve
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import compile_graph
from mocap.steering.path_following import follow_as_2002, follow_path, path_problem
from mocap.steering.path_objective import Settings, Wishes, make_route
from mocap.synthesis.ground_walks import GroundWalks, Stand
from tests.bundled import bundled, captured, walking

GRAPH = walking()


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_layers_keep_to_the_path_where_depth_first_does_not():
    """It counts squares of distances at equal arc length [KGP02, Eq. 9]."""
    ours = follow_path(GRAPH, s_curve(10))
    theirs = follow_as_2002(GRAPH, s_curve(10), Wishes(start=ours.walk[0][0]), budget=300)
    assert theirs.progress == 1.0
    assert theirs.found.expanded > 300
    assert theirs.found.cut > 0 and theirs.found.cost == pytest.approx((theirs.off_at_length**2).sum())
    assert "out of nodes: the best so far" in theirs.report()
    assert ours.off.mean() < theirs.off.mean()


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_what_the_papers_search_gains_at_its_best_it_pays_in_seams(real_data):
    """As in [KGP02, 5.1]. Where they are free in layers, too, walks in layers are nearer on these lines."""
    graph, found = captured(real_data), []
    free, best = Settings(seam=0, match=0, width=200, tries=1), 30_000
    for seed in (500, 502, 507):
        path = GroundPath(random_line(seed).at(np.linspace(0, 7, 141)))
        usual = follow_path(graph, path)
        wishes = Wishes(start=usual.walk[0][0], slide=0)
        theirs = follow_as_2002(graph, path, wishes, look=(45, 15), budget=best)
        found.append((follow_path(graph, path, settings=free), theirs, usual))
    off = np.array([[walk.off.mean() for walk in walks] for walks in found])
    seams = np.array([[walk.seams_per_second for walk in walks] for walks in found])
    assert (np.diff(off) > 0).all() and (np.diff(off)[:, 1] < 0.02).all()
    assert np.median(seams[:, 0]) < 1.3 * np.median(seams[:, 1]) and (2 * seams[:, 2] < seams[:, 1]).all()


def test_who_stands_gets_on_by_a_little():
    """As in [KGP02, least progress]: else a walk that stands would never end."""
    graph, path = compile_graph(bundled("stop_and_go")), GroundPath([[0, 0], [0, 3]])
    walks = GroundWalks(graph)
    problem = path_problem(walks, make_route(graph, path, Wishes()))
    own, counted = [], []
    for edge in walks.number:
        own.append(graph.step[walks.rows(edge)])
        counted.append(problem.step(Stand(1 + 0j, 0j), edge)[1].along)
    least = [np.maximum(steps, 0.3 / graph.fps).sum() for steps in own]
    assert counted == pytest.approx(least)
    assert min(steps.sum() / len(steps) for steps in own) * graph.fps < 0.1


def test_before_its_first_step_there_is_no_walk():
    wishes = Wishes(start=GRAPH.nodes[10])
    with pytest.raises(NoWalk, match="out of nodes before its first step"):
        follow_as_2002(GRAPH, GroundPath([[0, 0], [0, 3]]), wishes, budget=0)
