"""The seam that a reader chooses in notebook 00 is the same in each later one, and an edge of a graph."""

import numpy as np
import pytest

from mocap import plain
from mocap.course import lab
from mocap.course.lab import seam_of_one
from tests.course.lab.students import written
from tests.course.lab.test_own import _differs
from tests.refusals import refused


@pytest.fixture(autouse=True)
def generated(monkeypatch):
    monkeypatch.setattr(seam_of_one, "people", lambda *_: [])


def test_a_choice_is_kept_and_printed(tmp_path, capsys):
    best = lab.pair()
    assert f"Your seam leads from frame {best.i} of walk_circle into frame " in capsys.readouterr().out
    third = lab.choose_pair(3)
    assert "→ 3: frame" in capsys.readouterr().out
    assert (third.i, third.j) != (best.i, best.j)
    again = lab.pair()
    assert (again.i, again.j) == (third.i, third.j)
    (tmp_path / "my_seam.txt").write_text("the best")
    assert lab.pair().i == best.i
    refused("5 seams to choose from, got 6", lab.choose_pair, 6)


def test_each_seam_is_an_edge_of_the_graph_and_pruning_keeps_it():
    seams = seam_of_one._seams()
    clips = [seams[0].a, seams[0].b]
    transitions = plain.find_transitions(clips)
    kept = plain.prune(plain.cut_and_join(clips, transitions))
    for seam in seams:
        (cost,) = [one[4] for one in transitions if one[:4] == (0, seam.i, 1, seam.j)]
        assert cost == pytest.approx(seam.distance, abs=1e-9)
        assert kept.has_edge((0, seam.i), (1, seam.j + plain.K))
    distances = [seam.distance for seam in seams]
    assert distances == sorted(distances)
    assert len(seams) == seam_of_one.LISTED


WRONG = "def hamilton(a, b):\n    return np.array([a[0] * b[0], *(a[0] * b[1:] + b[0] * a[1:])])\n"
TWICE = """
def choice_points(frames, leaves, enters, window):
    return sorted([0, 0, frames, *leaves, *(start + window for start in enters)])
"""


def test_what_does_not_pass_is_made_beside_the_packages(capsys):
    def made(by):
        return by.hamilton(np.array([0.0, 1, 0, 0]), np.array([0.0, 0, 1, 0])).tolist()

    assert list(lab.compare(made, "hamilton")) == ["the package's"]
    lab.mine(written("hamilton", WRONG))
    both = lab.compare(made, "hamilton", "climb")
    assert list(both) == ["yours, which does not pass", "the package's"]
    assert both["yours, which does not pass"] == [0, 0, 0, 0] and both["the package's"] == [0, 0, 0, 1]
    capsys.readouterr()
    alone = lab.compare(lambda by: made(by).index(1.0), "hamilton")
    assert alone == {"the package's": 3}
    assert "As you wrote hamilton, this fails. ValueError: " in capsys.readouterr().out
    lab.compare(lambda by: made(by).index(1.0), *lab.own.NAMES)
    assert "As you wrote hamilton, this fails. ValueError: " in capsys.readouterr().out
    lab.mine(written("hamilton"))
    assert list(lab.compare(made, "hamilton")) == ["yours"]


def test_a_wrong_product_changes_the_walk_of_the_whole_program():
    seam = lab.pair()
    clips = [seam.a[:200], seam.b[:200]]
    line = np.array([[0.0, 0.0], [0.0, 2.0]])
    right, _ = lab.own.OwnGraph(clips, 10, 0.05, lab.own.as_written()).walk(line)
    lab.mine(written("hamilton", WRONG))
    wrong, _ = lab.own.OwnGraph(clips, 10, 0.05, lab.own.as_written()).walk(line)
    assert _differs(right, wrong)


def test_choice_points_that_are_listed_twice_end_no_walk_in_a_loop(capsys):
    """A piece of clip without frames would be walked on for ever."""
    seam = lab.pair()
    clips = [seam.a[:200], seam.b[:200]]
    lab.mine(written("choice_points", TWICE))
    found = lab.compare(lambda by: lab.own.OwnGraph(clips, 10, 0.05, by), *lab.own.NAMES)
    assert list(found) == ["the package's"]
    assert (
        "As you wrote choice_points, this fails. ValueError: Clip 0: 0 follows 0." in capsys.readouterr().out
    )
