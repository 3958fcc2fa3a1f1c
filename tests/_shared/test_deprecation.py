"""What STABLE.md promises of names that are removed, tried on a function that stands for such a name."""

import re
from importlib import import_module
from pkgutil import walk_packages

import pytest

import mocap
from mocap._shared import deprecation
from mocap._shared.deprecation import DEPRECATED, Deprecation, deprecated, version_numbers
from tests.refusals import refusals


@pytest.fixture
def old(monkeypatch):
    """Return the old name of a function that doubles a number."""
    monkeypatch.setattr(deprecation, "DEPRECATED", [])

    def double(number, *, times=2):
        """Return a multiple of a number."""
        return times * number

    return deprecated("mocap.twice", since="0.2", removed_in="0.3", instead="mocap.double")(double)


def test_the_old_name_does_the_same_and_warns_at_the_line_that_calls_it(old):
    with pytest.warns(DeprecationWarning) as caught:
        assert old(3, times=5) == 15
    (warning,) = caught
    assert str(warning.message) == (
        "mocap.twice is deprecated since version 0.2 and is removed in version 0.3: use mocap.double."
    )
    assert warning.filename == __file__
    assert old.__name__ == "twice"
    assert re.match(r"mocap.twice is deprecated .*\n\nReturn a multiple", old.__doc__, re.DOTALL)


def test_it_is_due_with_the_version_that_is_named(old):
    (twice,) = deprecation.DEPRECATED
    versions = ("0.2.9", "0.3.0", "0.3.0.dev1", "0.10.0", "1.0")
    due = [version for version in versions if twice.is_due(version)]
    assert due == ["0.3.0", "0.3.0.dev1", "0.10.0", "1.0"]


def deprecation_of(since, removed_in):
    return Deprecation("mocap.twice", since=since, removed_in=removed_in, instead="mocap.double")


test_a_name_that_would_not_warn_for_a_whole_version_is_refused = refusals(
    ("since 0.2, it can be removed in 0.3, got 0.2.5", deprecation_of, "0.2", "0.2.5"),
    ("since 0.2.1, it can be removed in 0.4, got 0.3", deprecation_of, "0.2.1", "0.3"),
    ("since 1.4, it can be removed in 1.5, got 0.9", deprecation_of, "1.4", "0.9"),
)


def test_no_name_stays_longer_than_it_was_promised():
    for module in walk_packages(mocap.__path__, "mocap."):
        if not module.name.endswith("__main__"):
            import_module(module.name)
    assert [str(name) for name in DEPRECATED if name.is_due(mocap.__version__)] == []
    assert all(version_numbers(name.since) <= version_numbers(mocap.__version__) for name in DEPRECATED)
