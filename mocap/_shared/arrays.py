"""Types of arrays, and three functions that many modules use."""

from collections.abc import Sequence
from typing import Any, Protocol, SupportsFloat

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]
Points = NDArray[np.complexfloating[Any, Any]]
"""Points on the ground, as complex numbers z + ix."""


class Row(Protocol):
    """A sequence of numbers: a list, a tuple or an array of one axis."""

    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> SupportsFloat: ...


VectorsLike = NDArray[Any] | Sequence[Row]
"""N vectors as passed by callers: an array of shape (N, K), or N lists or arrays of K numbers each."""


def frozen(values: ArrayLike, dtype: type[np.generic]) -> NDArray[Any]:
    """Copy values into a read-only array.

    Examples
    --------
    >>> frozen([1, 2], np.float64).flags.writeable
    False
    """
    array: NDArray[Any] = np.array(values, dtype)
    array.flags.writeable = False
    return array


def runs(marks: Mask) -> NDArray[np.intp]:
    """List the runs of True as rows [start, stop), shape (N, 2).

    Examples
    --------
    >>> runs(np.array([True, True, False, True])).tolist()
    [[0, 2], [3, 4]]

    Notebook: 04b-feet
    """
    edges = np.diff(np.asarray(marks, np.int8), prepend=0, append=0)
    return np.stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)], axis=-1)


def ranges(first: Indices, counts: Indices) -> Indices:
    """Concatenate ranges of integers, each given by its first number and its count.

    Examples
    --------
    >>> ranges(np.array([5, 0]), np.array([2, 3])).tolist()
    [5, 6, 0, 1, 2]
    """
    starts = np.cumsum(counts) - counts  # of the ranges in the result
    return np.asarray(np.arange(counts.sum()) + np.repeat(first - starts, counts))
