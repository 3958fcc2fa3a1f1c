"""The checks of notebooks/HOMEWORK.md: right functions pass on three clips, and each wrong one is told."""

import re

import networkx as nx
import numpy as np
import pytest

from mocap import datasets
from mocap.body import rotations
from mocap.body.euler import from_euler
from mocap.graphs import homework_graph
from tests.course.stored_notebooks import FOLDER

PAGE = (FOLDER / "HOMEWORK.md").read_text("utf-8")
START, *CHECKS = re.findall(r"^```python\n((?s:.*?))^```", PAGE, re.MULTILINE)


def root_rotation(rx, ry, rz):
    return from_euler("xyz", np.radians([rx, ry, rz]))


def other_order(rx, ry, rz):
    return from_euler("zyx", np.radians([rz, ry, rx]))


def facing(quaternion):
    matrix = rotations.to_matrix(quaternion)
    return np.arctan2(-matrix[2, 0], matrix[0, 0])


def to_the_right(quaternion):
    return -facing(quaternion)


def probabilities(costs):
    return 0.5 * (1 / costs) / (1 / costs).sum()


def worst_first(costs):
    return 0.5 * costs / costs.sum()


def all_of_it(costs):
    return 2 * probabilities(costs)


def survivors_at(parts):
    def count(costs, threshold):
        graph = homework_graph.connect(parts, costs, threshold, "distance")
        return len(max(nx.strongly_connected_components(graph), key=len))

    return count


RIGHT = {"root_rotation": root_rotation, "facing": facing, "probabilities": probabilities}
WRONG = [
    (0, "root_rotation", other_order, "another order of the axes"),
    (1, "facing", to_the_right, "° off"),
    (2, "probabilities", worst_first, "the best match is not the likeliest"),
    (2, "probabilities", all_of_it, r"the sum is 1\.000"),
]


@pytest.fixture(scope="module")
def space():
    """What the checks have computed, with right functions, of three clips in place of the homework's."""
    imports, loading, _ = START.partition("clips = ")
    assert loading
    names = dict(RIGHT)
    exec(imports, names)
    names["clips"] = [datasets.sample(name)[:1400] for name in datasets.SAMPLES[:3]]
    for check in CHECKS[:3]:
        exec(check, names)
    names["survivors_at"] = survivors_at(names["parts"])
    exec(CHECKS[3], names)
    return names


@pytest.mark.parametrize(("number", "name", "function", "message"), WRONG)
def test_a_wrong_function_is_told(space, number, name, function, message):
    with pytest.raises(AssertionError, match=message):
        exec(CHECKS[number], {**space, name: function})


def test_a_wrong_number_of_segments_is_told(space):
    with pytest.raises(AssertionError, match=r"1 segments, it should be \d+"):
        exec(CHECKS[3], {**space, "survivors_at": lambda *_: 1})


def test_the_page_is_found_from_the_readmes_and_the_notebooks_of_its_route():
    for name in ("01b-motion-files", "03b-angles", "05b-choice-points", "09-discussion"):
        assert f"]({name}.ipynb)" in PAGE
    for file in ("README.md", "09-discussion.ipynb"):
        assert "](HOMEWORK.md)" in (FOLDER / file).read_text("utf-8")
