"""Comparison with a tolerance: values that differ only by rounding are equal, and ties go to the first.

The last bit of a sum depends on the processor, on the library and on the order of its terms. If two results
are equally good, that bit alone would decide between them. Each method therefore has a tolerance for equal
values, in their unit: far above rounding errors, and far below relevant differences.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Indices


def first_least(values: ArrayLike, equal: float, axis: int | None = None) -> NDArray[np.intp]:
    """Return the index of the first value at most `equal` above the minimum: `np.argmin` with a tolerance.

    Examples
    --------
    >>> values = [3.0, 1.0 + 1e-12, 1.0]
    >>> int(np.argmin(values)), int(first_least(values, equal=1e-9))
    (2, 1)
    """
    numbers = np.asarray(values)
    minimum = numbers.min(axis=axis, keepdims=True)
    return np.asarray((numbers <= minimum + equal).argmax(axis=axis))


def ranks(values: ArrayLike, equal: float) -> Indices:
    """Rank values, shape (N,), from 0; sorted values at distances of at most `equal` have the same rank.

    Examples
    --------
    >>> ranks([0.5, 0.3 + 1e-12, np.inf, 0.3, np.inf], equal=1e-9).tolist()
    [1, 0, 2, 0, 2]
    """
    numbers = np.asarray(values, float)
    order = np.argsort(numbers, kind="stable")
    rising = numbers[order]
    higher = rising[1:] > rising[:-1] + equal
    ranked = np.zeros(len(numbers), np.intp)
    ranked[order[1:]] = np.cumsum(higher)
    return ranked


def in_order(values: ArrayLike, equal: float) -> Indices:
    """Return the indices that sort values, stably for equal ones: `np.argsort` with a tolerance.

    Examples
    --------
    >>> in_order([0.5, 0.3 + 1e-12, 0.3], equal=1e-9).tolist()
    [1, 2, 0]
    """
    return np.argsort(ranks(values, equal), kind="stable")


def first_in_order(values: ArrayLike, equal: float, count: int) -> Indices:
    """Return the first `count` of the indices that `in_order` returns, in half of its time.

    Examples
    --------
    >>> first_in_order([0.5, 0.3 + 1e-12, 0.3], equal=1e-9, count=2).tolist()
    [1, 2]
    """
    numbers = np.asarray(values, float)
    order = np.argsort(numbers)  # not stable: equal values have one rank, and are put in order by `lexsort`
    rising = numbers[order]
    higher = rising[1:] > rising[:-1] + equal
    complete = np.flatnonzero(higher[count - 1 :])  # the last rank of the first `count` is complete there
    if len(complete):
        order = order[: count + complete[0]]
    ranked = np.concatenate([[0], np.cumsum(higher[: len(order) - 1])])
    return np.asarray(order[np.lexsort((order, ranked))][:count])


def whole_steps(values: ArrayLike, step: float) -> NDArray[Any]:
    """Quantise values: return the nearest integer multiples of a step, as integers in floating point.

    Values that differ only by rounding get the same integer, unless the middle between two multiples is
    between them. This is rare if the step is large compared with rounding errors.

    Examples
    --------
    >>> whole_steps([0.3, 0.3 + 1e-12, 0.4, np.inf], 1e-9).tolist()
    [300000000.0, 300000000.0, 400000000.0, inf]
    """
    multiples = np.asarray(np.divide(values, step))
    np.rint(multiples, out=multiples)
    return multiples
