"""How well somebody tells two films apart, as the d′ of signal detection."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats

from mocap.errors import MocapError


class DPrime(NamedTuple):
    """An estimate of d′, and the limits of its confidence interval."""

    value: float
    low: float
    high: float


def d_prime(right: int, of: int, confidence: float = 0.95) -> DPrime:
    """Estimate d′ from right answers about pairs: d′ = √2 z(p), where one of two films has the seam [MC05].

    z is the inverse of the normal distribution, and p the share of right answers; who guesses has d′ = 0. If
    all answers are right, p = 1 would make d′ infinite; so the estimate takes p = (right + ½) / (of + 1), the
    log-linear correction of [Hau95]. The interval is that of [CP34] for p, mapped by √2 z: it holds the true
    d′ at least as often as it says, also for few answers. After right answers only it has no upper limit. To
    map an exact interval is our choice; it is wider than approximate ones.

    Parameters
    ----------
    right, of : right answers, and all.
    confidence : how often intervals made like this one hold the true d′.

    Returns
    -------
    The estimate and its limits.

    Raises
    ------
    MocapError : for more right answers than answers, fewer than 0, and a confidence outside (0, 1).

    Examples
    --------
    >>> [round(number, 2) for number in d_prime(15, 20)]
    [0.9, 0.03, 1.93]
    >>> round(d_prime(20, 20).value, 2), d_prime(20, 20).high  # the most that 20 answers can show
    (2.8, inf)

    Notebooks: 09-discussion, 09b-blend-window
    """
    if not (0 <= right <= of and of > 0 and 0 < confidence < 1):
        raise MocapError(f"No d′ for {right} right answers of {of} at a confidence of {confidence}.")
    outside = (1 - confidence) / 2
    low = stats.beta.ppf(outside, right, of - right + 1) if right else 0.0
    high = stats.beta.ppf(1 - outside, right + 1, of - right) if right < of else 1.0
    return DPrime(*(float(np.sqrt(2) * stats.norm.ppf(p)) for p in ((right + 0.5) / (of + 1), low, high)))


def mean_d_prime(values: Sequence[float], confidence: float = 0.95) -> DPrime:
    """Average the d′ of several people; the limits are Student's, as people differ.

    Parameters
    ----------
    values : one d′ per person, two or more.
    confidence : how often intervals made like this one hold the true mean.

    Returns
    -------
    The mean and its limits.

    Examples
    --------
    >>> [round(number, 2) for number in mean_d_prime([0.5, 1.0, 1.5])]
    [1.0, -0.24, 2.24]
    """
    mean, error = float(np.mean(values)), float(stats.sem(values))
    wide = error * float(stats.t.ppf((1 + confidence) / 2, len(values) - 1))
    return DPrime(mean, mean - wide, mean + wide)


def sentence(right: int, of: int) -> str:
    """Say what a number of right answers shows.

    Examples
    --------
    >>> sentence(15, 20)
    'You chose right in 15 of 20 pairs: d′ = 0.9, with 95 % confidence from 0.0 to 1.9. You see these seams.'
    >>> sentence(20, 20)
    'You chose right in 20 of 20 pairs: d′ = 2.8, with 95 % confidence 1.4 or more. You see these seams.'
    """
    value, low, high = d_prime(right, of)
    shown, least, most = (f"{number:.1f}".replace("-", "−") for number in (value, low, high))
    limits = f"from {least} to {most}"
    if right in (0, of):
        limits = f"{least} or more" if right else f"{most} or less"
    verdict = "You see these seams." if low > 0 else "That can be guessing, whose d′ is 0."
    if high < 0:
        verdict = "You see these seams, but you chose the films without one."
    estimate = f"d′ = {shown}, with 95 % confidence {limits}"
    return f"You chose right in {right} of {of} pairs: {estimate}. {verdict}"
