"""How well somebody tells two films apart, as the d′ of signal detection; and a class, as one curve."""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from scipy import stats

from mocap.errors import FormatError, MocapError
from mocap.files.text import read_text

COLUMNS = ["observer", "below_cm", "window", "seed", "pair", "right", "chosen", "seconds"]


class DPrime(NamedTuple):
    """An estimate of d′, and the limits of its confidence interval."""

    value: float
    low: float
    high: float


def d_prime(right: int, of: int) -> DPrime:
    """Estimate d′ from right answers about pairs: d′ = √2 z(p), where one of two films has the seam [MC05].

    z is the inverse of the normal distribution, and p the share of right answers; who guesses has d′ = 0. If
    all answers are right, p = 1 would make d′ infinite; so the estimate takes p = (right + ½) / (of + 1), the
    log-linear correction of [Hau95]. The interval is that of [CP34] for p, mapped by √2 z: it holds the true
    d′ in at least 95 of 100 tests, also for few answers. After right answers only it has no upper limit. To
    map an exact interval is our choice; it is wider than approximate ones.

    Parameters
    ----------
    right, of : right answers, and all.

    Returns
    -------
    The estimate and its limits.

    Raises
    ------
    MocapError : for more right answers than answers, and fewer than 0.

    Examples
    --------
    >>> [round(number, 2) for number in d_prime(15, 20)]
    [0.9, 0.03, 1.93]
    >>> round(d_prime(20, 20).value, 2), d_prime(20, 20).high  # the most that 20 answers can show
    (2.8, inf)

    Notebook: 09b-blend-window
    """
    if not (0 <= right <= of and of > 0):
        raise MocapError(f"No d′ for {right} right answers of {of}.")
    limits = stats.binomtest(right, of).proportion_ci()
    estimate = (right + 0.5) / (of + 1)
    return DPrime(*(float(np.sqrt(2) * stats.norm.ppf(p)) for p in (estimate, *limits)))


def mean_d_prime(values: Sequence[float]) -> DPrime:
    """Average the d′ of several people; the limits at 95 % are Student's, as people differ.

    Parameters
    ----------
    values : one d′ per person, two or more.

    Returns
    -------
    The mean and its limits.

    Examples
    --------
    >>> [round(number, 2) for number in mean_d_prime([0.5, 1.0, 1.5])]
    [1.0, -0.24, 2.24]
    """
    mean = float(np.mean(values))
    half_width = float(stats.sem(values)) * float(stats.t.ppf(0.975, len(values) - 1))
    return DPrime(mean, mean - half_width, mean + half_width)


def sentence(right: int, of: int) -> str:
    """Return what a number of right answers shows.

    Examples
    --------
    >>> sentence(15, 20)
    'You chose right in 15 of 20 pairs: d′ = 0.9, with 95 % confidence from 0.0 to 1.9. You see these seams.'
    >>> sentence(20, 20)
    'You chose right in 20 of 20 pairs: d′ = 2.8, with 95 % confidence 1.4 or more. You see these seams.'
    """
    value, low, high = d_prime(right, of)
    shown, lower, upper = (f"{number:.1f}".replace("-", "−") for number in (value, low, high))
    limits = f"from {lower} to {upper}"
    if right in (0, of):
        limits = f"{lower} or more" if right else f"{upper} or less"
    verdict = "You see these seams." if low > 0 else "That can be guessing, whose d′ is 0."
    if high < 0:
        verdict = "You see these seams, but you chose the films without one."
    estimate = f"d′ = {shown}, with 95 % confidence {limits}"
    return f"You chose right in {right} of {of} pairs: {estimate}. {verdict}"


class Answer(NamedTuple):
    """An answer to one pair."""

    observer: str
    below_cm: float
    window: int
    seed: int
    pair: int
    right: bool


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

    Notebook: 09b-blend-window
    """
    answers: dict[tuple[object, ...], Answer] = {}
    paths = [files] if isinstance(files, str | Path) else [*files]
    if not paths:
        raise MocapError("There are no files of answers.")
    for path in paths:
        head, *rows = csv.reader(read_text(path).splitlines())
        if head != COLUMNS:
            raise FormatError(path, 1, ",".join(COLUMNS), repr(",".join(head)))
        for number, row in enumerate(rows, 2):
            answer = _answer_of(row, path, number)
            if answers.setdefault(answer[:-1], answer) != answer:
                twice = f"'{answer.observer}' answered pair {answer.pair} twice, differently"
                raise MocapError(f"{path}: {twice}.")
    return list(answers.values())


def _answer_of(row: Sequence[str], path: str | Path, number: int) -> Answer:
    """Read an answer from a line of a file."""
    try:
        observer, below, window, seed, pair, right, _, _ = row
        is_right = {"0": False, "1": True}[right]
        return Answer(observer, float(below), int(window), int(seed), int(pair), is_right)
    except (ValueError, KeyError) as error:
        expected = "an answer in 8 columns, right 0 or 1"
        raise FormatError(path, number, expected, repr(",".join(row))) from error


# reads: name: notebooks and files of classes use `over`
def class_curve(answers: Sequence[Answer], over: Literal["below_cm", "window"]) -> dict[float, DPrime]:
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
    d′ at each setting, the smallest first, with its interval.

    Raises
    ------
    MocapError : where the other setting varies, too, and over something else.

    Examples
    --------
    >>> answers = [Answer("ada", 4.0, 10, 0, pair, right=pair > 5) for pair in range(1, 21)]
    >>> class_curve(answers, "below_cm")
    {4.0: DPrime(value=0.90..., low=0.03..., high=1.92...)}

    Notebook: 09b-blend-window
    """
    if over not in ("below_cm", "window"):
        raise MocapError(f"A curve of a class runs over 'below_cm' or 'window', got {over!r:.40}.")
    constant = "window" if over == "below_cm" else "below_cm"
    values = sorted({getattr(answer, constant) for answer in answers})
    if len(values) != 1:
        raise MocapError(f"The answers must have one '{constant}', got {values[:9]}: keep those of one.")
    people: dict[float, dict[str, list[bool]]] = defaultdict(lambda: defaultdict(list))
    for answer in answers:
        people[float(getattr(answer, over))][answer.observer].append(answer.right)
    curve = dict[float, DPrime]()
    for setting, answers_of in sorted(people.items()):
        estimates = [d_prime(sum(right), len(right)) for right in answers_of.values()]
        is_single = len(estimates) == 1
        curve[setting] = estimates[0] if is_single else mean_d_prime([d.value for d in estimates])
    return curve
