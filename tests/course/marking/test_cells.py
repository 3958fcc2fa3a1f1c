"""Which cells an exercise needs, and which notebook of the course a copy is of."""

import nbformat
import pytest

from mocap.course.checks import all_checks
from mocap.course.marking.cells import Cell, code_cells, course_sheets, needed, sheet_of
from mocap.course.notebooks import notebooks_in, read
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
    assert code_cells(nbformat.v4.new_notebook(cells=[cell])) == [Cell(("a", "b"), "")]


@pytest.mark.parametrize(
    ("source", "wanted"),
    [
        ("%pip install -q seaborn\nimport numpy as np", "pass\nimport numpy as np"),
        ("!python3 -m pip install x\ny = 1", "pass\ny = 1"),
        ("!{sys.executable} -m pip install x", "pass"),
        ("pip install x\ny = 1", "pass\ny = 1"),
        ("try:\n    import mocap\nexcept ImportError:\n    %pip install -q 'motion-graphs'", None),
        ("%conda install -y x", "pass"),
        ("# I had to pip install numpy again\nx = 1", "# I had to pip install numpy again\nx = 1"),
        ("x = 'pip install numpy'", "x = 'pip install numpy'"),
        ("pip = 3\ninstall = pip", "pip = 3\ninstall = pip"),
        ("!ls", "!ls"),
    ],
)
def test_a_cell_loses_the_line_that_installs_and_nothing_else(source, wanted):
    (cell,) = code_cells(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source)]))
    assert cell.source == (wanted or source.replace("%pip install -q 'motion-graphs'", "pass"))
