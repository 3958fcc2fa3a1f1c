"""Functions of one's own: adopted when they pass, kept in a file with all that they need."""

import functools
import math
import os
import time

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.rotations import slerp as between
from mocap.course import checks, lab
from mocap.course.lab import adopting
from mocap.course.lab.kept_functions import keep, plain_source, run_sections, split
from tests.course.lab.conftest import new_kernel
from tests.course.lab.students import solutions, written
from tests.refusals import refused

X, Y, Z = np.eye(4)[1:]


def test_before_an_exercise_is_solved_the_packages_function_stands_in(capsys, fresh):
    hamilton = lab.mine("hamilton")
    assert hamilton(X, Y).tolist() == Z.tolist()
    assert capsys.readouterr().out == "hamilton: the package's stands in until yours passes its check.\n"
    assert not fresh.exists()


def test_a_function_that_passes_is_used_from_then_on_and_kept_in_a_readable_file(capsys, fresh):
    own = written("hamilton")
    hamilton = lab.mine(own)
    assert capsys.readouterr().out == "hamilton: yours, kept in my_graph.py.\n"
    assert hamilton.adopted is own
    assert lab.mine("hamilton") is hamilton
    assert hamilton(X, Y).tolist() == Z.tolist()
    text = fresh.read_text()
    assert "\n\n\n\n" not in text
    section = f"# ---- hamilton (notebook 01) ----\n\nimport numpy as np\n\n\n{solutions()['hamilton'][1]}"
    assert section in text
    assert lab.whose("hamilton", "climb") == "hamilton: yours · climb: the package's"


def test_it_survives_a_restart_and_goes_when_it_is_deleted(capsys, fresh):
    lab.mine(written("hamilton"))
    lab.mine(written("quintic"))
    new_kernel()
    assert lab.mine("hamilton").yours
    assert lab.mine("quintic").yours
    head, _, rest = fresh.read_text().partition("# ---- hamilton")
    fresh.write_text(head + "# ----" + rest.split("# ----", 1)[1])
    assert not lab.mine("hamilton").yours
    assert lab.mine("quintic").yours
    fresh.unlink()
    assert not lab.mine("quintic").yours


def test_a_wrong_version_leaves_the_place_as_it_was_and_is_not_called_the_readers(capsys, fresh):
    lab.mine(written("hamilton"))
    wrong = written("hamilton", "def hamilton(a, b):\n    return a * b\n")
    assert lab.mine(wrong).adopted is not wrong
    assert lab.mine("hamilton").yours
    assert "a * b" not in fresh.read_text()
    assert capsys.readouterr().out.splitlines()[1:] == [
        "hamilton: yours, kept in my_graph.py; it is the one that passed, not this one.",
        "hamilton: yours, kept in my_graph.py.",
    ]


def test_the_check_judges_what_was_written_when_its_cell_runs_again(capsys):
    hamilton = lab.mine(written("hamilton", "def hamilton(a, b):\n    return a * b\n"))
    assert "multiplies number by number" in checks.hamilton.verdict(hamilton).message
    assert not lab.mine(hamilton).yours
    assert checks.hamilton.verdict(lab.mine("climb")).right is False


def test_a_function_uses_the_other_exercises_by_their_names(fresh):
    best_shift = lab.mine(written("best_shift"))
    source = """
def undo(angle, x, z):
    there = np.array([[x, 0.0, z]])
    return -angle, *best_shift(0 * there, there, -angle)
"""
    lab.mine(written("undo", source, {"best_shift": best_shift}))
    new_kernel()
    assert lab.mine("undo").yours
    arguments = checks.undo.draw(np.random.default_rng(1))
    best_shift = lab.mine("best_shift")
    called, right = [], best_shift.adopted
    best_shift.adopted = lambda *given: called.append(given) or right(*given)
    lab.mine("undo")(*arguments)
    assert called
    assert "best_shift" not in fresh.read_text().partition("# ----")[0]


def test_without_a_file_nothing_is_read_or_written(monkeypatch, fresh, capsys):
    lab.mine(written("hamilton"))
    kept = fresh.read_text()
    monkeypatch.setenv("MOCAP_MINE", "")
    new_kernel()
    assert not lab.mine("hamilton").yours
    lab.mine(written("quintic"))
    assert capsys.readouterr().out.endswith("quintic: yours.\n")
    assert fresh.read_text() == kept


def test_a_name_that_no_exercise_has_is_refused():
    refused(r"no exercise 'hamiltion'; write `hamilton`\.$", lab.mine, "hamiltion")
    refused("no exercise '<lambda>'; write `def` and the name that the", lab.mine, lambda a, b: a)


def test_what_cannot_be_kept_is_used_until_the_kernel_ends(capsys, fresh):
    source = "def hamilton(a, b):\n    return table['product'](a, b)\n"
    own = written("hamilton", source, {"table": {"product": written("hamilton")}})
    assert lab.mine(own).yours
    said = capsys.readouterr().out
    assert "not kept. It uses `table`, a dict that no short text can make.\n" in said
    assert not fresh.exists()


def test_a_file_that_cannot_be_written_is_no_obstacle(monkeypatch, capsys, tmp_path):
    monkeypatch.setenv("MOCAP_MINE", str(tmp_path / "nowhere" / "my_graph.py"))
    assert lab.mine(written("hamilton")).yours
    assert "adopted until this kernel ends, but not kept." in capsys.readouterr().out


UNKNOWN = b"# ---- hmilton ----\n\ndef hmilton(): ...\n"
EXITS = "SystemExit, None; this section is not used"
FAILS = "my_graph.py: hamilton does not pass its check any more, so the package's stands in.\n✗ hamilton: "


@pytest.mark.parametrize(
    ("old", "new", "said", "yours"),
    [
        (b"- a[1:]", b"+ a[1:]", FAILS, False),
        (
            b"__file__))\n",
            b"__file__))\n" + UNKNOWN,
            "the course has no exercise 'hmilton'; it is not used.\n",
            True,
        ),
        (b'"""My', b'\xef\xbb\xbf"""My', "", True),  # as editors on Windows save it
        (b"\n", b"\r\n", "", True),
        (b'\n"""\n', b'\n"""\nexit()\n', EXITS, True),
        (b"import numpy", b"exit()\nimport numpy", EXITS, False),
        (b"return", b"exit()\n    return", FAILS, False),
        (b"return", b"print('here')\n    return", "", True),
        (None, None, "my_graph.py: cannot be read", False),  # a folder
    ],
)
def test_a_changed_file_counts_where_it_passes_and_else_it_is_said(old, new, said, yours, capsys, fresh):
    lab.mine(written("hamilton"))
    text = fresh.read_bytes()
    fresh.unlink()
    fresh.write_bytes(text.replace(old, new)) if old else fresh.mkdir()
    new_kernel()
    capsys.readouterr()
    assert lab.mine("hamilton").yours == yours
    out = capsys.readouterr().out
    assert said in out and "here" not in out
    assert said or out == "hamilton: yours, kept in my_graph.py.\n"
    if old:
        lab.mine(written("quintic"))
        new_kernel()
        assert lab.mine("quintic").yours and lab.mine("hamilton").yours == yours


ONE = "from math import dist\n\n\ndef one(x):\n    return dist([0, 0], x)\n"
TWO = "from numpy.linalg import norm as dist\n\n\ndef two(x):\n    return dist(x)\n"


def test_functions_stand_in_the_order_of_their_notebooks_each_with_its_imports(tmp_path):
    file = tmp_path / "mine.py"
    keep(file, "two", "08b", TWO)
    keep(file, "one", "02", ONE)
    text = keep(file, "two", "08b", TWO)
    assert text == file.read_text()
    assert [name for name, *_ in split(text)[1]] == ["one", "two"]
    found, said = run_sections(file, text, {})
    assert said == []
    assert (found["one"]([3, 4]), found["two"]([3, 4, 12])) == (5, 13)  # each by its own `dist`
    file.write_text(text.replace("# ---- one", "import math\n\n# ---- one"))
    above, *_ = keep(file, "one", "02", ONE).partition("# ----")
    assert "import math\n" in above  # it stays


def test_a_section_that_fails_is_left_out_with_its_line(tmp_path):
    file = tmp_path / "mine.py"
    failing = "# ---- two ----\n\ndef two(x:\n    return\n\n# ---- three ----\n1 / 0\n"
    text = keep(file, "one", "02", ONE) + failing
    found, said = run_sections(file, text, {})
    assert list(found) == ["one"]
    line = text[: text.index("def two")].count("\n") + 1
    assert said[0].startswith(f"{file}, line {line}: SyntaxError, "[:200])
    assert "ZeroDivisionError, division by zero; this section" in said[1] or len(said[1]) == 200


def test_helpers_of_one_function_do_not_replace_those_of_another(tmp_path):
    one = "# ---- one ----\ndef h(): return 1\ndef one(): return h()\n"
    text = one + one.replace("one", "two").replace("1", "2")
    found, _ = run_sections(tmp_path / "mine.py", text, {})
    assert (found["one"](), found["two"]()) == (1, 2)


def test_a_head_that_is_no_python_is_not_written_over(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text("import (\n")
    refused(r"line 1: .*; correct it, or delete it", keep, file, "one", "02", ONE)
    assert file.read_text() == "import (\n"


# The source of a function with all that it needs

EPSILON, AXES = 1e-6, ("x", "y")


def helper(x):
    return inner(x) + EPSILON


def inner(x):
    return math.floor(x)


def asked(x):
    def nested(y):
        return between(rotations.IDENTITY, rotations.IDENTITY, np.asarray(y))

    return [helper(x), nested(x), AXES, known(x), len(x)]


def known(x):
    return x


def test_imports_helpers_and_constants_are_written_before_the_function():
    plain = plain_source(asked, {"known"})
    assert plain.partition("\n\n")[0].splitlines() == [
        "from mocap.body import rotations",
        "from mocap.body.rotations import slerp as between",
        "import math",
        "import numpy as np",
    ]
    assert max(plain.index("def inner"), plain.index("EPSILON = 1e-06")) < plain.index("def helper")
    assert plain.index("AXES = (") < plain.index("def asked") and "def known" not in plain


def doubled(function):
    @functools.wraps(function)
    def twice(*given):
        return 2 * function(*given)

    return twice


@functools.cache
def cached(x):
    return x + 1


@doubled
def decorated(x, y=EPSILON, *, axis=AXES[0]):
    return cached(x) + y


@pytest.mark.parametrize("function", [helper, decorated, cached])
def test_what_is_written_runs_alone_with_what_stands_around_it(function):
    plain = plain_source(function)
    space = {}
    exec(plain, space)
    assert space[function.__name__](3.5) == function(3.5)


def uses_an_attribute(x):
    class Part:
        whole = AXES

    return [(x + 0j).real, x.made, Part.whole]


real = [object()]


def test_an_attribute_is_not_taken_for_a_value_of_its_name():
    plain = plain_source(uses_an_attribute)
    assert plain.startswith("AXES = ('x', 'y')\n\n\ndef uses_an_attribute")


def uses_an_array(x):
    return x + ARRAY


ARRAY = np.ones(3)
made = functools.partial(helper)


@pytest.mark.parametrize(
    ("function", "why"),
    [
        (uses_an_array, "It uses `ARRAY`, a ndarray"),
        (lambda x: x, "no `def` with a name"),
        (eval("lambda x: x"), "source cannot be found"),
    ],
)
def test_what_cannot_be_written_down_is_said(function, why):
    refused(why, plain_source, function)


def test_what_ended_the_last_kernel_is_told_and_not_tried_again(capsys, fresh):
    lab.mine(written("hamilton"))
    file = fresh
    report = file.with_name(".my_graph.stopped")
    report.write_text('Timeout (0:00:08)!\n  File "my_graph.py", line 12 in hamilton\n')
    os.utime(report, (time.time() + 10, time.time() + 10))
    new_kernel()
    capsys.readouterr()
    assert not lab.mine("hamilton").yours
    told = capsys.readouterr().out
    assert told.startswith(
        "The last kernel was ended: line 12 of `hamilton` ran compiled code without an end."
    )
    assert lab.mine(written("hamilton")).yours  # handed in again
    os.utime(report, (0, 0))  # a report that is older than the file is about an earlier version
    new_kernel()
    assert lab.mine("hamilton").yours and not report.exists()


def test_a_function_runs_as_it_stands_though_it_does_not_pass(capsys, fresh):
    wrong = written("hamilton", "def hamilton(a, b):\n    return a[0] * b\n")
    lab.mine(wrong)
    by = adopting.as_written()
    i, j = np.eye(4)[1:3]
    assert by.hamilton(i, j).tolist() == [0, 0, 0, 0]
    assert repr(by.hamilton) == "hamilton: yours, which does not pass"
    assert repr(by.climb) == "climb: the package's"
    lab.mine(written("survivors", "def survivors(cells, costs, width):\n    return [0]\n"))
    by = adopting.as_written()
    assert by.survivors(np.zeros((3, 4)), np.arange(3.0), 2) == [0]
    lab.mine(written("hamilton", "def hamilton(a, b):\n    return 1\n"))
    capsys.readouterr()
    assert adopting.as_written().hamilton(i, j).tolist() == [0, 0, 0, 1]
    assert "the package's stands in from here on" in capsys.readouterr().out
    lab.mine(written("climb", "def climb(body, rotations, joint):\n    return ...\n"))
    assert repr(adopting.as_written().climb) == "climb: the package's"  # not begun
