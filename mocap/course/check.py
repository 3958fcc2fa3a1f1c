"""How exercises check themselves: random input, one oracle, and hints for known mistakes.

A check holds a right function and typical wrong ones. It calls a student's function on random input and
compares the results. If they agree with those of a wrong function, it prints the hint for that mistake. It
never raises an error and never shows a solution. The checks are in `course.checks`, a file per notebook.
"""

from __future__ import annotations

import copy
import inspect
import io
import re
import traceback
from collections.abc import Callable, Mapping
from contextlib import redirect_stderr
from typing import Any, NamedTuple

import numpy as np

from mocap._shared.limits import Overdue, time_limit

Answer = Callable[..., Any]
Table = Mapping[str, Any]
Trial = tuple[tuple[Any, ...], Any, Any]  # the arguments of a call, the right result, and the student's


class Verdict(NamedTuple):
    """The result of a check: whether the function is right, and a sentence or two.

    Examples
    --------
    >>> print(Verdict(False, "double: That is the square."))
    ✗ double: That is the square.
    """

    right: bool
    message: str

    def __str__(self) -> str:
        return f"{'✓' if self.right else '✗'} {self.message}"


def close(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether two answers are the same: numbers to 8 digits, all else exactly, item by item."""
    if isinstance(wanted, set | frozenset):  # students list its items in any type
        return {tuple(item) if np.ndim(item) else item for item in given} == wanted
    if isinstance(wanted, dict | str) or wanted is None:
        return bool(given == wanted)
    try:
        kind = complex if np.iscomplexobj(wanted) else float
        a, b = np.asarray(given, kind), np.asarray(wanted, kind)
    except (TypeError, ValueError):
        return len(given) == len(wanted) and all(map(close, given, wanted))
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-8, atol=1e-9, equal_nan=True)


def close_angles(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether angles in radians are the same up to whole turns."""
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    return close(np.cos(a), np.cos(b)) and close(np.sin(a), np.sin(b))


def close_rotations(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether quaternions are the same rotations: q and -q are."""
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    signs = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0, -1, 1) if a.shape == b.shape else 1
    return close(a * signs, b)


def altered(old: Any, new: Any) -> bool:  # noqa: ANN401
    """Check whether an argument is an array that a function has changed."""
    return isinstance(old, np.ndarray) and not np.array_equal(new, old, equal_nan=True)


class Check:
    """The check of an exercise; call it with the student's function.

    Parameters
    ----------
    name : the function's name in the notebook.
    table : from a file such as `checks/06-pruning.toml`: `asks`, what the function must return, as the end of
        a sentence; `start`, the hint for a student who has not begun; `takes`, the names of the
        arguments; `draw`, lines of Python that draw the arguments of one call by `rng`, and list them in the
        last line; `right`, lines that end in the right answer; and `wrong`, the hint for each of several: if
        several fit, the first one counts. There `right` stands for the right answer, `right(...)` for that to
        other arguments, and `A → B; C → D` for the answer that has B instead of A, and D instead of C, in its
        lines and in those of the function that it calls first. Some tables have `same`, a function that
        compares two answers, a number of `trials`, and the `minutes` that it takes, 8 if not said.
    known : what the expressions may use.
    notebook : the number of the notebook that asks for it, such as 04b.

    Attributes
    ----------
    draw : takes a random generator, returns the arguments of one call.
    truth : the oracle: takes these arguments, returns the right answer.
    mistakes : known wrong answers, as functions, with their hints.
    oracles : the names of the package's functions that the right answer calls.
    seconds : the time limit of all calls; right functions take a hundredth of it.

    Examples
    --------
    >>> double = Check("double", {
    ...     "asks": "twice the number", "start": "What is 2 times x?", "takes": "x",
    ...     "draw": "(rng.normal(),)", "right": "2 * x",
    ...     "wrong": {"x * x": "That is the square.", "right + 1": "One too many."},
    ... }, {})
    >>> double(lambda x: ...)
    ✗ double: not there yet. It must return twice the number. Hint: What is 2 times x?
    >>> double(lambda x: x**2)
    ✗ double: That is the square.
    >>> double(lambda x: x + x)
    ✓ double: right on 40 random inputs.
    """

    seconds = 30.0

    def __init__(self, name: str, table: Table, known: Mapping[str, Any], notebook: str = "") -> None:
        self.name, self.notebook = name, notebook
        self.asks, self.start, self.trials = table["asks"], table["start"], table.get("trials", 40)
        self.minutes = table.get("minutes", 8)
        self._table, self._known = table, {**globals(), **known}
        self.same = eval(table.get("same", "close"), self._known)
        called = re.findall(r"(?<![\w.)])[A-Za-z_][\w.]*(?=\()", table["right"].splitlines()[-1])
        called = [word for word in called if word.partition(".")[0] in self._known]
        named = {word.split(".")[-1]: getattr(eval(word, self._known), "__module__", "") for word in called}
        self.oracles = [name for name, room in named.items() if re.match(r"mocap\.(?!course\.)", room or "")]
        self.draw = _function_of(table["draw"], "rng", dict(self._known))
        self.truth = self._function("right", table["takes"])
        wrong = table["wrong"].items()
        self.mistakes: list[tuple[Answer, str]] = [
            (self._function(one, table["takes"]), hint) for one, hint in wrong
        ]

    def _function(self, expression: str, takes: str) -> Answer:
        """Make a function of the right answer, or of a wrong one."""
        names, right = dict(self._known), self._table["right"]
        if "→" in expression:
            called, source = names.get(right.partition("(")[0]), ""
            if inspect.isfunction(called):
                names, source = called.__globals__ | names, inspect.getsource(called)
            for change in expression.split("; "):
                old, new = change.split(" → ")
                source, right = source.replace(old, new), right.replace(old, new)
            exec(source, names)
            expression = "right"
        names["right"] = _function_of(right, takes, names)
        return _function_of(re.sub(r"\bright\b(?!\()", f"right({takes})", expression), takes, names)

    def __call__(self, answer: Answer) -> None:
        """Print the verdict on a student's function."""
        print(self.verdict(answer))

    def require(self, answer: Answer) -> None:
        """Raise an AssertionError that says what is wrong, for nbgrader, which takes warnings for errors."""
        with redirect_stderr(io.StringIO()):
            verdict = self.verdict(answer)
        assert verdict.right, verdict

    def verdict(self, answer: Answer) -> Verdict:
        """Try a function on random input, and say what is wrong with it, if anything is.

        Of a place that a student's function was put into, it judges what the student has written.
        """
        answer, tried = written(answer), list[Trial]()
        try:
            with time_limit(self.seconds):
                wrong = self._try(answer, tried)
        except Overdue:
            begun = f"{len(tried)} of {self.trials} inputs were done"
            wrong = f"stopped after {self.seconds:g} s, when {begun}. Does a loop never end?"
        except NotImplementedError:
            wrong = f"not there yet. It must return {self.asks}. Hint: {self.start}"
        except (Exception, SystemExit) as error:  # it may raise anything, and the page shows it
            what = " ".join(filter(None, (type(error).__name__, place_of(error, answer))))
            wrong = f"your function raises {what}: {error}"
        failed = [(wanted, given) for _, wanted, given in tried if not self._same(given, wanted)]
        if not wrong and failed:
            fits = (
                hint
                for mistake, hint in self.mistakes
                if all(self._same(given, mistake(*copy.deepcopy(one))) for one, _, given in tried)
            )
            wrong = next(fits, "") or self._first_wrong(*failed[0])
        return Verdict(not wrong, f"{self.name}: {wrong or f'right on {self.trials} random inputs.'}")

    def _try(self, answer: Answer, tried: list[Trial]) -> str:
        """Call a function on random inputs, until it changes one; say so if it did."""
        rng = np.random.default_rng(0)
        for _ in range(self.trials):
            arguments = self.draw(rng)
            used = copy.deepcopy(arguments)
            tried.append((arguments, self.truth(*copy.deepcopy(arguments)), answer(*used)))
            if tried[-1][-1] is ...:
                raise NotImplementedError
            if any(map(altered, arguments, used)):
                return "your function changes its arguments; work on a copy."
        return ""

    def _same(self, given: Any, wanted: Any) -> bool:  # noqa: ANN401
        try:
            return bool(self.same(given, wanted))
        except Exception:  # the answer has a type that cannot be compared
            return False

    def _first_wrong(self, wanted: Any, given: Any) -> str:  # noqa: ANN401
        if given is None:
            return "your function returns None; does it end in `return`?"
        if isinstance(wanted, set | frozenset):  # students list its items in any type
            return f"some are missing or wrong. It must return {self.asks}. Hint: {self.start}"
        here, there = np.shape(as_numbers(given)), np.shape(as_numbers(wanted))
        if here != there:
            return f"your answer has the shape {here}; it should be {there}."
        if there == () and not isinstance(wanted, str):
            numbers = f"you return {_short(given)} where it should be {_short(wanted)}"
            return f"{numbers}. It must return {self.asks}."
        return f"the shape is right, the values are wrong. It must return {self.asks}. Hint: {self.start}"


def _function_of(lines: str, takes: str, names: dict[str, Any]) -> Answer:
    """Make a function of lines of Python, the last of which is what it returns."""
    *before, last = lines.splitlines()
    exec("\n ".join([f"def made({takes}):", *before, f"return ({last})"]), names)
    made: Answer = names["made"]
    return made


def written(place: Any) -> Answer:  # noqa: ANN401
    """Give the function that a student wrote, also of a place of `lab.mine`; where none is, one to write."""
    own: Answer = getattr(place, "written", place)
    return (lambda *_: ...) if own is getattr(place, "stand_in", None) else own


def as_numbers(value: Any) -> Any:  # noqa: ANN401
    """Give a value as an array of numbers; None where it is something else."""
    try:
        return np.asarray(value, complex)
    except (TypeError, ValueError):
        return None


def _short(value: Any) -> str:  # noqa: ANN401
    return f"{value:.4g}" if isinstance(value, (float, np.floating)) else repr(value)[:60]


def place_of(error: BaseException, answer: Answer) -> str:
    """Quote the line of a function in which an error arose."""
    here = inspect.getsourcefile(answer) if inspect.isfunction(answer) else None
    lines = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == here and f.name != "_try"]
    return f"in `{lines[-1].line}`" if lines and lines[-1].line else ""
