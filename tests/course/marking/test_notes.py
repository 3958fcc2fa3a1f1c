"""Notes for the teacher: cheats get one, honest students none, and no mark depends on it."""

import re

import nbformat
import pytest

from mocap.course.checks import all_checks
from mocap.course.marking import mark
from mocap.course.marking.cells import Cell, code_cells, course_sheets, sheet_of
from mocap.course.marking.notes import note, odd_uses
from mocap.course.notebooks import notebooks_in, read, tagged
from mocap.course.opening import stored
from tests.course.marking.honest import HONEST_HAND_INS
from tests.course.marking.students import CHEAPEST, START, hand_in

SPEED = all_checks()["speed"]


@pytest.fixture(scope="module")
def course():
    """Return the traits of the course's first notebook."""
    sheets = course_sheets(stored())
    return sheet_of(read(stored() / "00-quickstart.ipynb"), sheets)[1]


def notebook(cells):
    made = [nbformat.v4.new_code_cell(s, metadata={"tags": [tag] if tag else []}) for tag, s in cells]
    return nbformat.v4.new_notebook(cells=made)


def test_there_are_as_many_honest_hand_ins_as_the_docstring_says():
    assert len(HONEST_HAND_INS) == 44


@pytest.mark.parametrize("name", HONEST_HAND_INS)
def test_an_honest_student_gets_no_note(name, course):
    assert note(code_cells(notebook(HONEST_HAND_INS[name])), SPEED, course) == ""


TRUTH = "getattr(c.speed, 'tru' + 'th')"
TABLES = """
import pathlib, tomllib, mocap
file = pathlib.Path(mocap.__file__).parent / 'course' / 'checks' / '00-quickstart.toml'
right = tomllib.loads(file.read_text())['speed']['right']
speed = eval('lambda positions, fps: ' + right)
"""
CHEATS = {
    "the check's oracle": "speed = checks.speed.truth",
    "the oracle under other names": f"from mocap.course import checks as c\nspeed = {TRUTH}",
    "the oracle by another variable": f"c = checks\nspeed = {TRUTH}",
    "the tables of checks": TABLES,
    "a text that IPython runs": "get_ipython().run_cell('speed = chec' + 'ks.speed.tru' + 'th')",
    "a global by its name": "speed = getattr(globals()['che' + 'cks'].speed, 'tru' + 'th')",
    "the module of answers": "from mocap.course.checks.answers.nb00_quickstart import right_speed as speed",
    "a module by its name": "import importlib\nm = importlib.import_module('mocap.course.chec' + 'ks')",
    "all modules": "import sys\nspeed = sys.modules['mocap.course.che' + 'cks'].speed.truth",
    "all objects": "import gc\nspeed = next(o for o in gc.get_objects() if 'right' in repr(o))",
    "all objects, imported": "from gc import get_objects\nfor thing in get_objects(): print(thing)",
    "another's notebook": "exec(open('../ada/03.ipynb').read())",
    "the function that stands in": "from mocap.course import lab\nspeed = lab.mine('speed')",
    "the place of it": "from mocap.course import lab\nspeed = lab.slots('speed')[0].stand_in",
    "the source of it": "import inspect\nprint(inspect.getsource(checks.speed.truth))",
    "a function's globals": "speed = checks.speed.verdict.__globals__",
}


@pytest.mark.parametrize("name", CHEATS)
def test_a_cheat_gets_a_note_in_its_cell_and_in_one_of_notes_and_not_for_another_exercise(name, course):
    source = CHEATS[name]
    assert note([Cell(("speed",), source)], SPEED, course).endswith(": look at its cells")
    assert note([Cell((), source)], SPEED, course) != ""
    assert note([Cell(("cheapest",), source)], SPEED, course) == ""


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("def hamilton(a, b): return rotations.multiply(a, b)", "`multiply`"),
        ("def multiply(a, b): ...\ndef hamilton(a, b): return multiply(a, b)", ""),
        ("def hamilton(a, b):\n    # rotations.multiply(a, b)\n    return a", ""),
        ("def hamilton(a, b) return multiply(a, b)", ""),  # which is no Python
    ],
)
def test_the_packages_own_function_is_named(source, names):
    said = note([Cell(("hamilton",), source)], all_checks()["hamilton"], ())
    assert said == (f"uses {names}: look at its cells" if names else "")


def test_no_solution_of_the_course_gets_a_note():
    sheets = course_sheets(stored())
    for (exercises, traits), file in zip(sheets, notebooks_in(stored()), strict=True):
        notebook = read(file)
        solutions = {name: cell.source for name, cell in tagged(notebook, "solution")}
        for name, cell in tagged(notebook, "exercise"):
            cell.source = "\n".join(re.findall(r"```python\n(.*?)```", solutions[name], re.DOTALL))
        for name in exercises:
            assert note(code_cells(notebook), all_checks()[name], traits) == ""


def test_a_note_changes_no_mark(tmp_path):
    odd = "import sys\nprint(sys.modules.keys() & {'numpy'})\n"
    right = "def speed(positions, fps):\n    return np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps"
    hand_in([START, ("exercise:speed", odd + right), CHEAPEST], tmp_path / "ada" / "00.ipynb")
    (marks, *_) = mark(tmp_path)
    assert [(one.right, one.note) for one in marks] == [
        (True, "uses `sys.modules`: look at its cells"),
        (True, ""),
    ]
    assert all("look" not in one.said for one in marks)


def test_code_of_any_size_and_depth_is_read():
    import ast

    assert list(odd_uses(ast.parse("x = " + "+".join(["1"] * 900)))) == []
    assert note([Cell(("speed",), "(" * 5000)], SPEED, ()) == ""


@pytest.mark.sweep
def test_every_honest_student_earns_the_mark(tmp_path):
    for number, cells in enumerate(HONEST_HAND_INS.values()):
        hand_in(cells, tmp_path / f"{number:02}" / "00.ipynb")
    marks = [one for some in mark(tmp_path, jobs=2) for one in some if one.exercise == "speed"]
    assert [one for one in marks if not one.right or one.note] == []
    assert len(marks) == len(HONEST_HAND_INS)
