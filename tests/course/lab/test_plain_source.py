import functools
import math

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.rotations import slerp as between
from mocap.course.lab.kept_functions import plain_source
from mocap.errors import MocapError

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
    assert plain.imports == {
        "import math",
        "import numpy as np",
        "from mocap.body import rotations",
        "from mocap.body.rotations import slerp as between",
    }
    for first, then in (
        ("def inner", "def helper"),
        ("EPSILON = 1e-06", "def helper"),
        ("AXES = (", "def asked"),
    ):
        assert plain.source.index(first) < plain.source.index(then)
    assert "def known" not in plain.source


def test_the_written_source_runs_alone():
    plain = plain_source(helper)
    space = {}
    exec("\n".join(plain.imports) + "\n" + plain.source, space)
    assert space["helper"](2.5) == helper(2.5)


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


@pytest.mark.parametrize("function", [decorated, cached])
def test_what_stands_around_a_function_is_written_too(function):
    plain = plain_source(function)
    space = {}
    exec("\n".join(plain.imports) + "\n" + plain.source, space)
    assert space[function.__name__](3.5) == function(3.5)


def uses_an_attribute(x):
    class Part:
        whole = AXES

    return [(x + 0j).real, x.made, Part.whole]


real = [object()]


def test_an_attribute_is_not_taken_for_a_value_of_its_name():
    plain = plain_source(uses_an_attribute)
    assert not plain.imports
    assert plain.source.startswith("AXES = ('x', 'y')\n\n\ndef uses_an_attribute")


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
    with pytest.raises(MocapError, match=why):
        plain_source(function)
