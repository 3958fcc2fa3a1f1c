"""How exercises check themselves: random input, one oracle, and hints for known mistakes.

A check holds a right function and typical wrong ones. It calls a student's function on random input and
compares the results. If they agree with those of a wrong function, it prints the hint for that mistake. It
never raises an error and never shows a solution. The checks are in `course.checks`, a file per notebook.
"""

from __future__ import annotations

import copy
import inspect
import re
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from mocap._shared.limits import Overdue, time_limit

Answer = Callable[..., Any]


class Mistake(NamedTuple):
    """A wrong answer that students give, as a function, and the hint for it.

    Examples
    --------
    >>> Mistake(lambda x: x * x, "That is the square.").hint
    'That is the square.'
    """

    answer: Answer
    hint: str


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


class Trial(NamedTuple):
    """One call of a student's function: its arguments, the right result, and the student's."""

    arguments: tuple[Any, ...]
    wanted: Any
    given: Any


def close(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether two answers are the same: numbers to 8 digits, all else exactly, item by item."""
    if isinstance(wanted, (set, frozenset, dict, str)) or wanted is None:
        return bool(given == wanted)
    try:
        kind = complex if np.iscomplexobj(wanted) else float
        a, b = np.asarray(given, kind), np.asarray(wanted, kind)
    except (TypeError, ValueError):
        return len(given) == len(wanted) and all(map(close, given, wanted))
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-8, atol=1e-9)


def close_angles(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether angles in radians are the same up to whole turns."""
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    return close(np.cos(a), np.cos(b)) and close(np.sin(a), np.sin(b))


def close_rotations(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Check whether quaternions are the same rotations: q and -q are."""
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    signs = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0, -1, 1) if a.shape == b.shape else 1
    return close(a * signs, b)


@dataclass(frozen=True, kw_only=True)
class Check:
    """The check of an exercise; call it with the student's function.

    Parameters
    ----------
    name : the function's name in the notebook.
    asks : what the function must return, as the end of a sentence.
    start : the hint for a student who has not begun.
    draw : takes a random generator, returns the arguments of one call.
    truth : the oracle: takes these arguments, returns the right answer.
    mistakes : known wrong answers with their hints; if several fit, the first one counts.
    same : takes two answers, returns whether they are the same.
    trials : the number of random inputs.
    seconds : the time limit of all these calls; right functions take a hundredth of it.
    notebook : the number of the notebook that asks for it, such as 04b.

    Examples
    --------
    >>> double = Check(
    ...     name="double", asks="twice the number", start="What is 2 times x?",
    ...     draw=lambda rng: (rng.normal(),), truth=lambda x: 2 * x,
    ...     mistakes=[Mistake(lambda x: x * x, "That is the square.")])
    >>> double(lambda x: ...)
    ✗ double: not there yet. It must return twice the number. Hint: What is 2 times x?
    >>> double(lambda x: x**2)
    ✗ double: That is the square.
    >>> double(lambda x: x + x)
    ✓ double: right on 40 random inputs.
    """

    name: str
    asks: str
    start: str
    draw: Callable[[np.random.Generator], tuple[Any, ...]]
    truth: Answer
    mistakes: Sequence[Mistake]
    same: Callable[[Any, Any], bool] = close
    trials: int = 40
    seconds: float = 30.0
    notebook: str = ""
    _said: list[tuple[Answer, Verdict]] = field(default_factory=list, init=False, repr=False)

    def __call__(self, answer: Answer) -> None:
        """Print the verdict on a student's function."""
        verdict = self.verdict(answer)
        self._said[:] = [(_written(answer), verdict)]
        print(verdict)

    def again(self, answer: Answer) -> Verdict:
        """Give the verdict that was printed last, once, if it is on this function; else judge it."""
        said = {id(function): verdict for function, verdict in self._said}
        self._said.clear()
        return said.get(id(_written(answer))) or self.verdict(answer)

    def verdict(self, answer: Answer) -> Verdict:
        """Try a function on random input, and say what is wrong with it, if anything is.

        Of a place that a student's function was put into, it judges what the student has written.
        """
        answer, tried = _written(answer), list[Trial]()
        try:
            with time_limit(self.seconds):
                changed = self._try(answer, tried)
            if changed:
                return self._wrong("your function changes its arguments; work on a copy.")
        except Overdue:
            begun = f"{len(tried)} of {self.trials} inputs were done"
            return self._wrong(f"stopped after {self.seconds:g} s, when {begun}. Does a loop never end?")
        except NotImplementedError:
            return self._wrong(f"not there yet. It must return {self.asks}. Hint: {self.start}")
        except Exception as error:  # a student's function may raise anything, and the page shows it
            return self._wrong(_raised(error, answer))
        failed = [trial for trial in tried if not self._same(trial.given, trial.wanted)]
        if failed:
            return self._wrong(self._known_mistake(tried) or self._first_wrong(failed[0]))
        return Verdict(True, f"{self.name}: right on {self.trials} random inputs.")

    def _try(self, answer: Answer, tried: list[Trial]) -> bool:
        """Call a function on random inputs, until it changes one; say whether it did."""
        rng = np.random.default_rng(0)
        for _ in range(self.trials):
            arguments = self.draw(rng)
            used = copy.deepcopy(arguments)
            tried.append(Trial(arguments, self.truth(*copy.deepcopy(arguments)), answer(*used)))
            if tried[-1].given is ...:
                raise NotImplementedError
            if not all(map(_unchanged, used, arguments)):
                return True
        return False

    def _wrong(self, message: str) -> Verdict:
        return Verdict(False, f"{self.name}: {message}")

    def _same(self, given: Any, wanted: Any) -> bool:  # noqa: ANN401
        try:
            return bool(self.same(given, wanted))
        except Exception:  # the answer has a type that cannot be compared
            return False

    def _known_mistake(self, tried: list[Trial]) -> str | None:
        for mistake in self.mistakes:
            if all(self._same(t.given, mistake.answer(*copy.deepcopy(t.arguments))) for t in tried):
                return mistake.hint
        return None

    def _first_wrong(self, trial: Trial) -> str:
        if trial.given is None:
            return "your function returns None; does it end in `return`?"
        given, wanted = np.shape(_array(trial.given)), np.shape(_array(trial.wanted))
        if given != wanted:
            return f"your answer has the shape {given}; it should be {wanted}."
        if wanted == () and not isinstance(trial.wanted, str):
            numbers = f"you return {_short(trial.given)} where it should be {_short(trial.wanted)}"
            return f"{numbers}. It must return {self.asks}."
        return f"the shape is right, the values are wrong. It must return {self.asks}. Hint: {self.start}"


def check_of(name: str, table: Mapping[str, Any], known: Mapping[str, Any], notebook: str) -> Check:
    """Make a check of its table in a file such as `checks/06-pruning.toml`.

    Parameters
    ----------
    name : the function's name in the notebook.
    table : `asks` and `start` as in `Check`; `takes`, the names of the arguments; `draw`, an expression of
        `rng` that gives the arguments of one call; `right`, an expression of them; and `wrong`, the hint for
        each of several. There `right` stands for the right answer, and `A → B; C → D` for the answer of
        the function that `right` calls, if its lines say B instead of A, and D instead of C. Some tables
        have `same`, a function that compares two answers, and a number of `trials`.
    known : what the expressions may use.
    notebook : as in `Check`.

    Examples
    --------
    >>> double = check_of("double", {
    ...     "asks": "twice the number", "start": "What is 2 times x?", "takes": "x",
    ...     "draw": "(rng.normal(),)", "right": "2 * x", "wrong": {"right + 1": "One too many."},
    ... }, {}, "00")
    >>> double(lambda x: x + x + 1)
    ✗ double: One too many.
    """

    def function(expression: str, takes: str = table["takes"]) -> Answer:
        names = {**globals(), **known}
        if "→" in expression:
            lines = inspect.getsource(names[table["right"].partition("(")[0]])
            for change in expression.split("; "):
                old, new = change.split(" → ")
                lines = lines.replace(old, new)
            exec(lines, names)
            expression = "right"
        expression = re.sub(r"\bright\b", lambda _: f"({table['right']})", expression)
        made: Answer = eval(f"lambda {takes}: ({expression})", names)
        return made

    return Check(
        name=name,
        asks=table["asks"],
        start=table["start"],
        draw=function(table["draw"], "rng"),
        truth=function("right"),
        mistakes=[Mistake(function(wrong), hint) for wrong, hint in table["wrong"].items()],
        same=eval(table.get("same", "close"), {**globals(), **known}),
        trials=table.get("trials", 40),
        notebook=notebook,
    )


def _written(answer: Answer) -> Answer:
    return getattr(answer, "written", answer)


def _unchanged(used: Any, argument: Any) -> bool:  # noqa: ANN401
    return not isinstance(argument, np.ndarray) or np.array_equal(used, argument, equal_nan=True)


def _array(value: Any) -> Any:  # noqa: ANN401
    try:
        return np.asarray(value, float)
    except (TypeError, ValueError):
        return None


def _short(value: Any) -> str:  # noqa: ANN401
    return f"{value:.4g}" if isinstance(value, (float, np.floating)) else repr(value)[:60]


def _raised(error: Exception, answer: Answer) -> str:
    """Say what a function raised, and in which of its lines."""
    here = inspect.getsourcefile(answer) if inspect.isfunction(answer) else None
    lines = [f for f in traceback.extract_tb(error.__traceback__) if f.filename == here and f.name != "_try"]
    at = f" in `{lines[-1].line}`" if lines and lines[-1].line else ""
    return f"your function raises {type(error).__name__}{at}: {error}"
