"""Functions that are the same as a published solution or as another student's, and others that are not."""

import csv

import pytest

from mocap.course.checks import all_checks
from mocap.course.marking.cells import Cell, course_sheets
from mocap.course.marking.grades import Mark, grade, tables
from mocap.course.marking.likeness import is_published, tree_of
from mocap.course.notebooks import notebooks_in, read, solution, tagged
from mocap.course.opening import stored

WRITTEN = """
def f(points, others, angle):
    c, s = np.cos(angle), np.sin(angle)
    mean = others.mean(axis=0)
    return points.mean(axis=0) - np.array([c * mean[0] + s * mean[1], c * mean[1] - s * mean[0]])
"""
COPIES = {
    "renamed": lambda text: text.replace("mean =", "m =").replace("mean[", "m[").replace("angle", "theta"),
    "explained": lambda text: text.replace(":\n", ':\n    """Mine."""\n    # my idea\n', 1),
    "spread": lambda text: text.replace("(axis=0)", "(\n        axis = 0\n    )"),
    "annotated": lambda text: text.replace("angle):", "angle: float) -> np.ndarray:"),
}
OTHERS = {
    "another order": lambda text: text.replace("c * mean[0] + s * mean[1]", "s * mean[1] + c * mean[0]"),
    "another library call": lambda text: text.replace(".mean(axis=0)", ".sum(axis=0)"),
    "another step": lambda text: text.replace("c, s =", "c, t ="),
}


def tree(source):
    return tree_of([Cell((), "import numpy as np"), Cell(("f",), source)], "f")


@pytest.mark.parametrize("change", COPIES.values(), ids=COPIES)
def test_names_comments_and_layout_do_not_count(change):
    assert change(WRITTEN) != WRITTEN
    assert tree(change(WRITTEN)) == tree(WRITTEN) != ""


@pytest.mark.parametrize("change", OTHERS.values(), ids=OTHERS)
def test_other_thoughts_are_other_trees(change):
    assert tree(change(WRITTEN)) not in ("", tree(WRITTEN))


def test_a_short_function_and_what_is_no_python_are_not_compared():
    assert tree("def f(a, b):\n    return a + b") == tree("def f(a:") == tree("x = 3") == ""


def test_each_published_solution_that_is_long_enough_is_recognised():
    compared = 0
    for (_, course), file in zip(course_sheets(stored()), notebooks_in(stored()), strict=True):
        for name, cell in tagged(read(file), "solution"):
            found = tree_of([Cell((name,), solution(cell))], name)
            compared += bool(found)
            assert is_published(found, name, course) == bool(found), name
    assert compared > 0.6 * len(all_checks())


def test_the_table_names_those_who_wrote_the_same_and_changes_no_mark():
    marks = [Mark(f"{name}/0.ipynb", "speed", True, "", tree="t") for name in ("ada", "bob", "cyn")]
    marks += [
        Mark("dan/0.ipynb", "speed", True, "", published=True),
        Mark("ada/1.ipynb", "speed", True, "", tree="t"),
    ]
    rows = list(csv.DictReader(tables(marks, grade(marks, {}), {})[""].splitlines()))
    assert [row["same as"] for row in rows] == ["bob, cyn", "ada, cyn", "ada, bob", "", "bob, cyn"]
    assert [row["same as the published solution"] for row in rows] == ["", "", "", "1", ""]
    assert [student.points for student in grade(marks, {})] == [1, 1, 1, 1]
