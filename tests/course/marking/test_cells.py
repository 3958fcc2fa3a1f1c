"""Which cells an exercise needs, and which notebook of the course a copy is of."""

import re

import nbformat
import pytest

from mocap.course.checks import all_checks
from mocap.course.marking.cells import Cell, code_cells, course_sheets, named_oracle, needed, sheet_of
from mocap.course.notebooks import notebooks_in, read, tagged
from mocap.course.opening import stored


@pytest.fixture(scope="module")
def sheets():
    return course_sheets(stored())


def test_the_sheets_ask_for_each_check_of_the_course_once(sheets):
    names = [name for exercises, _ in sheets for name in exercises]
    assert sorted(names) == sorted(all_checks())


def test_a_copy_is_recognised_without_its_name_its_tags_and_its_exercises(sheets):
    for sheet, file in list(zip(sheets, notebooks_in(stored()), strict=True))[:3]:
        copy = read(file)
        copy.cells = [cell for cell in copy.cells if "exercise:" not in str(cell.metadata)]
        for cell in copy.cells:
            cell.metadata = {}
        assert sheet_of(copy, sheets) == sheet


@pytest.mark.parametrize(
    ("sources", "wanted"),
    [
        (["a = 1", "def f(): return g()", "def g(): return a"], [0, 1, 2]),  # a helper of a helper, behind
        (["a = 1", "a = 2", "def f(): return a", "a = 3"], [0, 1, 2]),  # those before it count
        (["x = 1", "def f(x):\n    y = x\n    return y", "y = 2"], [1]),  # its own names
        (["import numpy as np", "def f(): return [np.sin(i) for i in range(3)]", "i = 1"], [0, 1]),
        (["x = (", "def f(): return x"], [1]),  # a cell that is no Python
        (["class x: ...", "def f(): return x()"], [0, 1]),
        (["def f(): return g()", "def g(): return f()"], [0, 1]),  # a circle
    ],
)
def test_an_exercise_needs_the_cells_that_define_what_it_uses(sources, wanted):
    cells = [Cell((), source) for source in sources]
    assert needed(cells, "f") == wanted


@pytest.mark.parametrize(
    ("tagged", "others", "wanted"),
    [
        ("def f(x):\n    return ...", ["def f(x): return 2 * x"], [1]),
        ("def f(x):\n    return ...", ["def g(x): return 2", "f = lambda x: g(x)"], [1, 2]),
        ("def f(x):\n    return ...", ["f = lab.mine(f)", "f = [3]"], [0]),
        ("def f(x):\n    ...  # case 1\n    return x", ["def f(x):\n    return ..."], [0, 1]),
        ("def f(x):\n    return x[..., 0]", ["def f(x):\n    return ..."], [0]),
        ("def f(x): return 1", ["def f(x): return 2"], [0, 1]),  # the last one counts, as in the notebook
    ],
)
def test_a_function_that_is_written_in_a_new_cell_counts(tagged, others, wanted):
    cells = [Cell(("f",), tagged), *(Cell((), source) for source in others)]
    assert needed(cells, "f") == wanted
    backwards = [cells[0]._replace(exercises=()), *cells[:0:-1], cells[0]]
    assert len(needed(backwards[1:], "f")) == len(wanted)


def test_nothing_is_needed_for_what_is_not_there():
    assert needed([Cell((), "f(1)")], "f") == []


def test_a_cell_may_hold_two_exercises():
    cell = nbformat.v4.new_code_cell("", metadata={"tags": ["exercise:a", "exercise:b"]})
    installs = nbformat.v4.new_code_cell("%pip install -q motion-graphs")  # is left out
    assert code_cells(nbformat.v4.new_notebook(cells=[installs, cell])) == [Cell(("a", "b"), "")]


def test_no_solution_of_the_course_names_an_oracle(sheets):
    for (exercises, traits), file in zip(sheets, notebooks_in(stored()), strict=True):
        notebook = read(file)
        solutions = {name: cell.source for name, cell in tagged(notebook, "solution")}
        for name, cell in tagged(notebook, "exercise"):
            cell.source = "\n".join(re.findall(r"```python\n(.*?)```", solutions[name], re.DOTALL))
        for name in exercises:
            assert named_oracle(code_cells(notebook), all_checks()[name], traits) == ""


@pytest.mark.parametrize(
    ("source", "word"),
    [
        ("def hamilton(a, b): return checks.hamilton.truth(a, b)", "checks"),
        ("c = checks\ndef hamilton(a, b): return c.hamilton.stand_in(a, b)", "checks"),
        ("def hamilton(a, b): return getattr(c, 'truth')(a, b)", "'truth"),
        ("from mocap.course.checks import all_checks", "checks"),
        ("hamilton = lab.mine('hamilton')", "mine('"),
        ("def hamilton(a, b): return rotations.multiply(a, b)", "multiply"),
        ("exec(open('../ada/03.ipynb').read())", "exec("),
        ("def multiply(a, b): ...\ndef hamilton(a, b): return multiply(a, b)", ""),
        ("checks.hamilton(hamilton)\n# the truth about mistakes, or eval", ""),
    ],
)
def test_what_knows_the_answer_is_named(source, word):
    assert named_oracle([Cell(("hamilton",), source)], all_checks()["hamilton"], ()) == word
    assert named_oracle([Cell((), source)], all_checks()["hamilton"], ()) == word
    assert named_oracle([Cell(("other",), source)], all_checks()["hamilton"], ()) == ""
