"""The paper's search follows short paths, and ours follows long ones better."""

import pytest

from mocap.body.ground_path import GroundPath, s_curve
from mocap.errors import MocapWarning, NoWalk
from mocap.steering.path_following import follow_as_2002, follow_path
from mocap.steering.path_objective import Wishes
from mocap.synthesis.bounded_search import Budget
from tests.bundled import walking

GRAPH = walking()


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_layers_keep_to_the_path_where_depth_first_does_not():
    ours = follow_path(GRAPH, s_curve(10))
    theirs = follow_as_2002(GRAPH, s_curve(10), Wishes(start=ours.walk[0][0]), budget=Budget(nodes=300))
    assert theirs.progress == 1.0
    assert theirs.found.expanded > 300
    assert theirs.found.cut > 0
    assert "out of nodes: the best so far" in theirs.report()
    assert ours.off.mean() < theirs.off.mean()


def test_before_its_first_step_there_is_no_walk():
    wishes = Wishes(start=GRAPH.nodes[10])
    with pytest.raises(NoWalk, match="out of nodes before its first step"):
        follow_as_2002(GRAPH, GroundPath([[0, 0], [0, 3]]), wishes, budget=Budget(nodes=0))
    assert issubclass(MocapWarning, UserWarning)
