"""The checks of the course's exercises, by the names of the functions that they ask for.

A notebook has two files here. `hints/06-pruning.toml` contains the words: what each exercise asks for, and
the hint for each typical mistake. A copy of that folder in another language translates them.
`answers/nb06_pruning.py` contains the functions: inputs, right answers and mistakes. `inputs` has the
functions that students get as arguments.

The answers are imported when a function is checked. In the process of a student whose notebook is marked they
never are, because their folder cannot be read there, and the checks say so.

>>> from mocap.course import checks
>>> checks.speed(lambda positions, fps: ...)
✗ speed: not there yet. It must return ...
"""

import tomllib
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache, partial
from importlib import import_module
from pathlib import Path

from mocap._shared import renamed
from mocap.course.check import Answers, AnswersWithheld, Check, Function, Texts
from mocap.course.comparisons import close

FOLDER = Path(__file__).parent
ANSWERS = FOLDER / "answers"
_withheld = [False]


@cache
def all_checks() -> dict[str, Check]:
    """Return every check by its name, notebook by notebook."""
    loaded: dict[str, Check] = {}
    for file in sorted((FOLDER / "hints").glob("*.toml")):
        notebook, _, _ = file.stem.partition("-")
        for name, table in tomllib.loads(file.read_text("utf-8")).items():
            texts = Texts(**table)
            load = partial(_answers_of, file.stem, name, tuple(texts.mistakes))
            loaded[name] = Check(name, texts, load, notebook)
    return loaded


def _answers_of(stem: str, name: str, mistakes: tuple[str, ...]) -> Answers:
    """Import the answers to an exercise."""
    if withheld():
        raise AnswersWithheld(f"{name}: the right answer is with the marker, which checks yours.")
    module = import_module(f"mocap.course.checks.answers.nb{stem.replace('-', '_')}")
    functions: Mapping[str, Function] = vars(module)
    draw = functions[f"draw_{name}"]
    right = functions[f"right_{name}"]
    is_same = functions.get(f"same_{name}", close)
    unseen = functions.get(f"unseen_{name}", lambda *_: "")
    wrong = {mistake: functions[f"mistake_{mistake}"] for mistake in mistakes}
    return Answers(draw, right, wrong, is_same, unseen)


def withhold() -> None:
    """Answer no more checks in this process, as a notebook runs in it that somebody marks."""
    _withheld[0] = True


def withheld() -> bool:
    """Return whether `withhold` has been called.

    Examples
    --------
    >>> withheld()
    False
    """
    return _withheld[0]


def nearest(name: str) -> str:
    """Return a remedy for a name that no exercise has.

    Examples
    --------
    >>> nearest("sped"), nearest("<lambda>")
    ('write `speed`', 'write `def` and the name that the exercise gives')
    """
    names = get_close_matches(name, all_checks(), 1)
    return f"write `{names[0]}`" if names else "write `def` and the name that the exercise gives"


def __getattr__(name: str) -> Check:
    if name not in all_checks():
        if sentence := renamed.sentence(__name__, name):
            raise AttributeError(sentence)
        names = ", ".join(all_checks())
        raise AttributeError(f"the course has no check '{name}'; it has: {names}; {nearest(name)}")
    return all_checks()[name]
