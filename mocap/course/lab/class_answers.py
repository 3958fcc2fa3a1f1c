"""The files that a class saves after the blind test, as one curve."""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal, NamedTuple

from mocap.course.lab.sensitivity import DPrime, d_prime, mean_d_prime
from mocap.errors import FormatError, MocapError

COLUMNS = ["observer", "below_cm", "window", "seed", "pair", "right", "chosen", "seconds"]


class Answer(NamedTuple):
    """What somebody answered to one pair."""

    observer: str
    below_cm: float
    window: int
    seed: int
    pair: int
    right: bool


class ClassPoint(NamedTuple):
    """What a class saw at one setting: how many people, their right answers, and d′ with its interval."""

    setting: float
    people: int
    right: int
    of: int
    seen: DPrime


def read_answers(files: str | Path | Iterable[str | Path]) -> list[Answer]:
    """Read the files that a class saved.

    Parameters
    ----------
    files : one CSV file or more, as the blind test saves them. The same answer in two files counts once.

    Returns
    -------
    All answers.

    Raises
    ------
    MocapError : for no files, one that cannot be read, and a line that is no answer.

    Examples
    --------
    >>> read_answers([])
    Traceback (most recent call last):
    mocap.errors.MocapError: There are no files of answers.

    Notebooks: 09-discussion, 09b-blend-window
    """
    answers: dict[tuple[object, ...], Answer] = {}
    paths = [Path(file) for file in ([files] if isinstance(files, str | Path) else files)]
    if not paths:
        raise MocapError("There are no files of answers.")
    for path in paths:
        for answer in _read(path):
            if answers.setdefault(answer[:-1], answer) != answer:
                raise MocapError(
                    f"{path}: '{answer.observer}' answered pair {answer.pair} twice, differently."
                )
    return list(answers.values())


def _read(path: Path) -> list[Answer]:
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise MocapError(f"{path}: {getattr(error, 'strerror', None) or 'is not a text'}.") from error
    head, *rows = csv.reader(lines) if lines else [[]]
    if head != COLUMNS:
        raise FormatError(path, 1, ",".join(COLUMNS), repr(",".join(head)))
    answers = []
    for number, row in enumerate(rows, 2):
        try:
            observer, below, window, seed, pair, right, _, _ = row
            answers.append(Answer(observer, float(below), int(window), int(seed), int(pair), _RIGHT[right]))
        except (ValueError, KeyError) as error:
            raise FormatError(
                path, number, "an answer in 8 columns, right 0 or 1", repr(",".join(row))
            ) from error
    return answers


_RIGHT = {"0": False, "1": True}


def class_curve(answers: Sequence[Answer], over: Literal["below_cm", "window"]) -> list[ClassPoint]:
    """Join the answers of a class to one curve of d′.

    One person alone has the interval of `d_prime`. For several, d′ is the mean of theirs, and the interval
    Student's: it speaks of people like these, and not only of the pairs that they saw. The correction in each
    d′ pulls values above 2 towards 0, as 20 answers cannot show more than 2.8.

    Parameters
    ----------
    answers : as from `read_answers`.
    over : what was varied, the threshold or the window; the other must be one and the same.

    Returns
    -------
    A point for each setting, the smallest first.

    Raises
    ------
    MocapError : where the other setting varies, too, and over something else.

    Examples
    --------
    >>> answers = [Answer("ada", 4.0, 10, 0, pair, right=pair > 5) for pair in range(1, 21)]
    >>> class_curve(answers, "below_cm")
    [ClassPoint(setting=4.0, people=1, right=15, of=20, seen=DPrime(...))]

    Notebooks: 09-discussion, 09b-blend-window
    """
    if over not in ("below_cm", "window"):
        raise MocapError(f"A curve of a class runs over 'below_cm' or 'window', got {over!r:.40}.")
    other = "window" if over == "below_cm" else "below_cm"
    held = sorted({getattr(answer, other) for answer in answers})
    if len(held) != 1:
        raise MocapError(f"The answers must have one '{other}', got {held[:9]}: keep those of one.")
    people: dict[float, dict[str, list[bool]]] = defaultdict(lambda: defaultdict(list))
    for answer in answers:
        people[float(getattr(answer, over))][answer.observer].append(answer.right)
    return [_point(setting, list(by.values())) for setting, by in sorted(people.items())]


def _point(setting: float, people: list[list[bool]]) -> ClassPoint:
    each = [d_prime(sum(right), len(right)) for right in people]
    seen = each[0] if len(each) == 1 else mean_d_prime([one.value for one in each])
    right, of = sum(map(sum, people)), sum(map(len, people))
    return ClassPoint(setting, len(people), right, of, seen)
