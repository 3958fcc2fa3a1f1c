import contextlib
import time

import numpy as np
import pytest

from mocap.course import checks
from mocap.course.lab import slots
from mocap.course.lab.slots import Slot, in_form


def slot(name, own):
    place = Slot(getattr(checks, name))
    place.adopted = own
    return place


@pytest.mark.parametrize(
    ("own", "said"),
    [
        (lambda a, b: 1 / 0, "hamilton: yours raised ZeroDivisionError: division by zero; "),
        (lambda a, b: a + np.nan, "hamilton: yours gave NaN; "),
        (lambda a, b: a[:3], "hamilton: yours gave an answer of the shape (3,); "),
        (lambda a, b: ..., "hamilton: yours gave an answer of the type ellipsis that does not fit; "),
        (lambda a, b: exit(), "hamilton: yours raised SystemExit"),
        (lambda a, b: own_again(a, b), "hamilton: yours raised RecursionError: "),
    ],
)
def test_a_function_that_fails_is_replaced_with_one_sentence(own, said, capsys):
    hamilton = slot("hamilton", own)
    i, j, k = np.eye(4)[1:]
    assert hamilton(i, j).tolist() == k.tolist()
    out = capsys.readouterr().out
    assert out.startswith(said)
    assert out.endswith("the package's stands in from here on.\n")
    assert len(out) <= 200
    assert not hamilton.yours
    hamilton(i, j)
    assert capsys.readouterr().out == ""


def own_again(a, b):
    return own_again(a, b)


def test_an_answer_that_is_a_list_becomes_an_array():
    for name, arguments in {"hamilton": np.eye(4)[1:3], "strikes": [np.array([False, True])]}.items():
        check = checks.all_checks()[name]
        own = slot(name, lambda *given, check=check: check.truth(*given).tolist())
        given, wanted = own(*arguments), check.truth(*arguments)
        assert own.yours and given.dtype == wanted.dtype and given.tolist() == wanted.tolist()


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ([[1, 2], [3]], [{1, 2}, {3}]),
        ([1, [2.0, 3]], (1, np.array([2.0, 3.0]))),
        (np.array([1, 2]), (1, 2.0)),
        (np.array(3.0), 3),
        (np.float64(2), 2),
        ([[1, 2], (3, 4)], {(1, 2), (3, 4)}),
        ({(0, 1): 2}, {(0, 1): 2}),
        (None, None),
    ],
)
def test_an_answer_of_another_type_is_converted(given, wanted):
    assert repr(in_form(given, wanted)) == repr(wanted)


def test_what_a_function_prints_is_dropped_with_one_sentence(capsys):
    chatty = slot("hamilton", lambda a, b: print("a line\n" * 100) or checks.hamilton.truth(a, b))
    for _ in range(3):
        assert chatty(*np.eye(4)[1:3]).tolist() == [0, 0, 0, 1]
    said = "hamilton: yours prints; it is shown where the check runs, and not here.\n"
    assert capsys.readouterr().out == said
    assert chatty.yours


def test_a_function_that_never_ends_is_stopped_though_it_catches_exceptions(monkeypatch, capsys):
    monkeypatch.setattr(slots, "SECONDS", 0.05)

    def forever(a, b):
        end = time.monotonic() + 5  # or this test would never end where it fails
        while time.monotonic() < end:
            try:
                a[9]
            except Exception:
                continue

    assert slot("hamilton", forever)(*np.eye(4)[:2]).tolist() == [0, 1, 0, 0]
    assert "yours did not end within 0.05 s; the package's" in capsys.readouterr().out


def test_interrupting_is_left_to_the_reader():
    def interrupted(a, b):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        slot("hamilton", interrupted)(*np.eye(4)[:2])


@pytest.mark.parametrize(
    ("given", "wanted", "right"),
    [
        ([(1, 2), (3, 4)], [(1, 2)], False),
        ([(1, 2)], [(5, 6)], True),
        ({(0, 1): [2]}, {(0, 0): []}, True),
        ([], {}, False),
        ({1}, {2, 3}, True),
        ([{1}], [{1}, {2}], False),
        ("dead end", "sink", True),
        (None, None, True),
        (2.0, None, False),
        ((np.ones(3), np.ones((3, 4))), (np.zeros(3), np.zeros((3, 4))), True),
        ((np.ones(3), np.ones((3, 1))), (np.zeros(3), np.zeros((3, 4))), False),
        ([1.0, np.nan], [1.0, np.nan], True),
        ([np.nan, 1.0], [1.0, np.nan], False),
        ([(0, 1j, 2.0)], [(3, 4j, 5.0)], True),
        ([{1}, 2], [{1}, {2}], False),
        (3, [{1}], False),
    ],
)
def test_answers_of_the_same_form(given, wanted, right):
    with contextlib.nullcontext() if right else pytest.raises(ValueError, match=r"^gave "):
        in_form(given, wanted)
