"""How exercises check themselves: random input, one oracle, and hints for known mistakes.

A check has a right function and typical wrong ones. It calls a student's function on random input and
compares the results. If they agree with those of a wrong function, it prints the hint for that mistake; else
it looks for a mistake of any exercise, and else it shows the smallest input on which the function fails. The
hint comes when the function fails for the second time: the first time, a check says what must be returned. It
never raises an error and never shows a solution. The checks are in `course.checks`.
"""

from __future__ import annotations

import ast
import copy
import inspect
import io
import re
import textwrap
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stderr
from functools import cached_property
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np

from mocap._shared import records
from mocap._shared.limits import Overdue
from mocap.course.common_mistakes import Attempt, name_mistake
from mocap.course.comparisons import altered, as_numbers, close
from mocap.course.failing_inputs import failing_input, smallest
from mocap.course.guarded_calls import guarded
from mocap.errors import MocapError

Function = Callable[..., Any]
Trial = tuple[tuple[Any, ...], Any, Any]
"""The arguments of a call, the right result, and the student's."""

LATER = "A hint comes when it fails again."


class Verdict(NamedTuple):
    """The result of a check: whether the function is right, and a sentence or two.

    Attributes
    ----------
    right : whether the function is right.
    message : what is said of it.
    unhinted : what is said instead when it fails for the first time; "" for the same.

    Examples
    --------
    >>> print(Verdict(False, "double: That is the square."))
    ✗ double: That is the square.
    """

    right: bool
    message: str
    unhinted: str = ""

    @property
    def without_hint(self) -> Verdict:
        """What is said when the function fails for the first time."""
        return Verdict(self.right, self.unhinted or self.message)

    def __str__(self) -> str:
        return f"{'✓' if self.right else '✗'} {self.message}"


class AnswersWithheld(MocapError):
    """The right answer to an exercise is not in this process, because its function is marked elsewhere."""


CHANGES = "your function changes its arguments; work on a copy."


def _raised(error: BaseException, function: Function) -> str:
    """Describe an error of a student's function. Arrays of motions are read-only, which NumPy says."""
    if isinstance(error, ValueError) and "read-only" in str(error):
        return CHANGES
    kind = " ".join(filter(None, (type(error).__name__, place_of(error, function))))
    return f"your function raises {kind}: {error}"


class Texts(records.NamedTuple):
    """The words of an exercise, which can be translated.

    Attributes
    ----------
    asks : what the function must return, as the end of a sentence.
    start : the hint for a student who has not begun.
    mistakes : the hint for each known mistake, by its name; if several fit, the first one counts.
    minutes : time that the exercise takes.
    trials : number of inputs that are tried.
    """

    asks: str
    start: str
    mistakes: Mapping[str, str]
    minutes: int = 8
    trials: int = 40


class Answers(records.NamedTuple):
    """The functions of an exercise.

    Attributes
    ----------
    draw : from a random generator to the arguments of one call.
    right : from these arguments to the right answer.
    mistakes : known wrong answers, by their names.
    is_same : compares an answer with the right one.
    unseen : from the arguments after a call, and its answer, to the name of a mistake that does not show in
        the answer, or "".
    """

    draw: Function
    right: Function
    mistakes: Mapping[str, Function]
    is_same: Callable[[Any, Any], bool] = close
    unseen: Callable[[tuple[Any, ...], Any], str] = lambda *_: ""


class Check:
    """The check of an exercise; call it with the student's function.

    Parameters
    ----------
    name : the function's name in the notebook.
    texts : its words.
    load : returns its functions; called when the first of them is needed.
    notebook : the number of the notebook that asks for it, such as 04b.

    Attributes
    ----------
    truth : the oracle: takes the arguments of a call, returns the right answer.
    trials : number of inputs that are tried.
    seconds : the time limit of all calls; right functions take a hundredth of it.
    has_failed : whether a call in this kernel has found something wrong; from then on, calls print hints.

    Examples
    --------
    >>> answers = Answers(
    ...     draw=lambda rng: (rng.normal(),),
    ...     right=lambda x: 2 * x,
    ...     mistakes={"square": lambda x: x * x, "added": lambda x: 2 * x + 1},
    ... )
    >>> hints = {"square": "That is the square.", "added": "One too many."}
    >>> double = Check("double", Texts("twice the number", "What is 2 times x?", hints), lambda: answers)
    >>> double(lambda x: ...)
    ✗ double: not there yet. It must return twice the number.
    >>> double(lambda x: x**2)
    ✗ double: That is the square.
    >>> double(lambda x: x + x)
    ✓ double: right on 40 random inputs.
    """

    seconds = 6.0

    def __init__(self, name: str, texts: Texts, load: Callable[[], Answers], notebook: str = "") -> None:
        self.name = name
        self.notebook = notebook
        self.texts = texts
        self.asks = texts.asks
        self.start = texts.start
        self.minutes = texts.minutes
        self.trials = texts.trials
        self.truth: Function = self._right  # the same object at each look
        self.has_failed = False
        self._load = load

    @cached_property
    def answers(self) -> Answers:
        """The functions of the exercise.

        Raises
        ------
        AnswersWithheld : in the process of a student whose notebook is marked.
        """
        return self._load()

    def _right(self, *arguments: Any) -> Any:  # noqa: ANN401
        return self.answers.right(*arguments)

    def draw(self, rng: np.random.Generator) -> tuple[Any, ...]:
        """Draw the arguments of one call."""
        arguments: tuple[Any, ...] = self.answers.draw(rng)
        return arguments

    @property
    def mistakes(self) -> list[tuple[Function, str]]:
        """Known wrong answers, each with its hint."""
        return [(self.answers.mistakes[name], hint) for name, hint in self.texts.mistakes.items()]

    @property
    def oracles(self) -> list[str]:
        """The names of the package's functions that give the right answer."""
        return list(dict.fromkeys(_package_calls(self.answers.right)))

    def __call__(self, function: Function) -> None:
        """Print the verdict on a student's function, without a hint when it fails for the first time."""
        verdict = self.verdict(function)
        print(verdict if self.has_failed else verdict.without_hint)
        self.has_failed = self.has_failed or not verdict.right

    def require(self, function: Function) -> None:
        """Raise an AssertionError that says what is wrong, for nbgrader, which takes warnings for errors."""
        with redirect_stderr(io.StringIO()):
            verdict = self.verdict(function)
        if not verdict.right:
            raise AssertionError(verdict)

    def verdict(self, function: Function, seed: int = 0) -> Verdict:
        """Try a function on random input, and report what is wrong with it, if anything is.

        Parameters
        ----------
        function : the student's, or a place of `lab.mine`, of which it judges what the student has written.
        seed : of the random input.
        """
        function = written(function)
        trials: list[Trial] = []
        try:
            with guarded(self.seconds):
                wrong = self._try(function, trials, seed)
                if not wrong:
                    return self._judged(function, trials)
        except AnswersWithheld as error:
            return Verdict(False, str(error))
        except Overdue:
            begun = f"{len(trials)} of {self.trials} inputs were done"
            wrong = f"stopped after {self.seconds:g} s, when {begun}. Does a loop never end?"
        except NotImplementedError:
            return self._hinted(f"not there yet. It must return {self.asks}.", f"Hint: {self.start}")
        except (Exception, SystemExit) as error:  # it may raise anything, and the page shows it
            wrong = _raised(error, function)
        return Verdict(False, f"{self.name}: {wrong}")

    def passed(self, function: Function, seed: int = 0) -> float:
        """Return the fraction of the random inputs of `verdict` on which a function is right.

        An input on which it raises an error, or that it changes, counts as wrong; all do if it is too slow.
        """
        rng = np.random.default_rng(seed)
        right = 0
        try:
            with guarded(self.seconds):
                for _ in range(self.trials):
                    arguments = self.draw(rng)
                    wanted = self.truth(*copy.deepcopy(arguments))
                    right += self._passes(function, arguments, wanted)
        except Overdue:
            return 0.0
        return right / self.trials

    def _passes(self, function: Function, arguments: tuple[Any, ...], wanted: Any) -> bool:  # noqa: ANN401
        """Return whether a function is right on an input, and does not change it."""
        used = copy.deepcopy(arguments)
        try:
            answer = function(*used)
        except (Exception, SystemExit):
            return False
        return self._is_same(answer, wanted) and not any(map(altered, arguments, used))

    def _try(self, function: Function, trials: list[Trial], seed: int) -> str:
        """Call a function on random inputs, until it changes one; say so if it did."""
        rng = np.random.default_rng(seed)
        for _ in range(self.trials):
            arguments = self.draw(rng)
            used = copy.deepcopy(arguments)
            wanted = self.truth(*copy.deepcopy(arguments))
            answer = function(*used)
            trials.append((arguments, wanted, answer))
            if answer is ...:
                raise NotImplementedError
            if any(map(altered, arguments, used)):
                return CHANGES
            mistake = self._unseen_mistake(used, answer)
            if mistake:
                return self.texts.mistakes[mistake]
        return ""

    def _unseen_mistake(self, used: tuple[Any, ...], answer: Any) -> str:  # noqa: ANN401
        """Name a mistake that an answer does not show; "" for an answer of another form."""
        try:
            return self.answers.unseen(used, answer)
        except Exception:  # the answer may have any type
            return ""

    def _hinted(self, sentence: str, hint: str) -> Verdict:
        """Return a verdict of a sentence that is always said, and a hint that may be kept for later."""
        return Verdict(False, f"{self.name}: {sentence} {hint}", f"{self.name}: {sentence}")

    def _judged(self, function: Function, trials: list[Trial]) -> Verdict:
        """Return the verdict on some answers: right, or the mistake that they fit, or a failing input."""
        failed = [trial for trial in trials if not self._is_same(trial[2], trial[1])]
        if not failed:
            return Verdict(True, f"{self.name}: right on {self.trials} random inputs.")
        unhinted = f"{self.name}: not right yet. It must return {self.asks}. {LATER}"
        for mistake, hint in self.mistakes:
            if all(self._is_same(answer, mistake(*copy.deepcopy(used))) for used, _, answer in trials):
                return Verdict(False, f"{self.name}: {hint}", unhinted)
        if any(answer is None for _, _, answer in failed):
            return Verdict(False, f"{self.name}: your function returns None; does it end in `return`?")
        attempts = [Attempt(*trial) for trial in trials]
        named = name_mistake(attempts, self._is_same)
        hint = named or self._unnamed(function, *smallest(failed))
        return Verdict(False, f"{self.name}: {hint}", unhinted)

    def _is_same(self, answer: Any, wanted: Any) -> bool:  # noqa: ANN401
        try:
            return bool(self.answers.is_same(answer, wanted))
        except Exception:  # the answer has a type that cannot be compared
            return False

    def _unnamed(self, function: Function, arguments: tuple[Any, ...], wanted: Any, answer: Any) -> str:  # noqa: ANN401
        """Describe a wrong answer that fits no known mistake."""
        shape = _shape(answer)
        wanted_shape = _shape(wanted)
        if shape is not None and wanted_shape is not None and shape != wanted_shape:
            returned = f"your answer has the shape {shape}; it should be {wanted_shape}."
            return f"{returned} It must return {self.asks}."
        return failing_input(function, arguments, wanted, answer)


def _shape(answer: Any) -> tuple[int, ...] | None:  # noqa: ANN401
    """Return the shape of an answer; None for one without, such as a set or a ragged list."""
    if isinstance(answer, set | dict):
        return None
    is_sequence = isinstance(answer, list | tuple | np.ndarray)
    numbers = as_numbers(answer)
    return None if numbers is None and is_sequence else np.shape(numbers)


def _package_calls(function: Function) -> Iterator[str]:
    """Yield the names of the package's functions that a function calls where it returns."""
    if not isinstance(function, FunctionType):
        return
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    for returned in (node for node in ast.walk(tree) if isinstance(node, ast.Return)):
        for call in (node for node in ast.walk(returned) if isinstance(node, ast.Call)):
            name = ast.unparse(call.func)
            root, *parts = name.split(".")
            value = function.__globals__.get(root)
            for part in parts:
                value = getattr(value, part, None)
            if re.match(r"mocap\.(?!course\.)", getattr(value, "__module__", None) or ""):
                yield name.rpartition(".")[2]


def written(place: Any) -> Function:  # noqa: ANN401
    """Return the function that a student wrote, also of a place of `lab.mine`; one to write if there is none.

    Examples
    --------
    >>> written(len)
    <built-in function len>
    """
    function: Function = getattr(place, "written", place)
    return (lambda *_: ...) if function is getattr(place, "stand_in", None) else function


def place_of(error: BaseException, function: Function) -> str:
    """Quote the line of a function in which an error arose."""
    file = inspect.getsourcefile(function) if inspect.isfunction(function) else None
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.line for frame in frames if frame.filename == file and frame.name != "_try"]
    return f"in `{lines[-1]}`" if lines and lines[-1] else ""
