import functools
import math

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.rotations import slerp as between
from mocap.course.lab.kept_functions import keep, plain_source, run_sections, split
from tests.refusals import refused

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
    assert (
        "import math\n" in keep(file, "one", "02", ONE).partition("# ----")[0]
    )  # what is written above stays


def test_a_section_that_fails_is_left_out_with_its_line(tmp_path):
    file = tmp_path / "mine.py"
    text = (
        keep(file, "one", "02", ONE)
        + "# ---- two ----\n\ndef two(x:\n    return\n\n# ---- three ----\n1 / 0\n"
    )
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
    for first, then in (
        ("def inner", "def helper"),
        ("EPSILON = 1e-06", "def helper"),
        ("AXES = (", "def asked"),
    ):
        assert plain.index(first) < plain.index(then)
    assert "def known" not in plain


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
