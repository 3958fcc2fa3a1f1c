"""A plugin of pytest that rounds otherwise: functions of NumPy and SciPy return other last bits.

    MOCAP_ROUNDING=1 pytest -p tests.rounding tests/feet

Another processor has other vector instructions, and another library of mathematics: its sines, exponentials,
sums of products and solutions of linear systems differ from ours in their last bits. So do those here. A
result becomes the next float64 above or below, or stays. This depends on its bits alone: equal results stay
equal, and short fractions such as 0, 1 and 0.75 stay, as they do everywhere.
"""

import os
from collections.abc import Callable
from functools import wraps

import numpy as np
import scipy.linalg

FUNCTIONS = {
    np: ["sin", "cos", "arctan2", "arccos", "exp", "hypot", "cross", "einsum", "interp"],
    np.linalg: ["norm", "solve", "inv", "pinv"],
    scipy.linalg: ["solve", "solveh_banded"],
}
SHORT = 2**20 - 1  # a short fraction has zeros in all these bits
MIX = 0x9E3779B97F4A7C15  # an odd number that mixes bits in a product [Knuth's multiplicative hashing]


def other_last_bits(values: np.ndarray) -> np.ndarray:
    """Move each float64 by -1, 0 or 1 unit in the last place, which one depends on its bits."""
    bits = np.ascontiguousarray(values).view(np.int64)
    mixed = (bits.view(np.uint64) * np.uint64(MIX)) >> np.uint64(32)
    steps = (mixed % np.uint64(3)).astype(np.int64) - 1
    moved = np.where(bits & SHORT, bits + steps, bits).view(np.float64)
    return np.where(np.isfinite(values), moved, values)


def rounded_otherwise(function: Callable) -> Callable:
    """Return a function whose results have other last bits."""

    @wraps(function)
    def rounded(*arguments: object, **options: object) -> object:
        result = function(*arguments, **options)
        if not isinstance(result, np.ndarray | np.floating) or result.dtype != np.float64 or "out" in options:
            return result
        return other_last_bits(result) if np.ndim(result) else other_last_bits(np.array([result]))[0]

    for name in ("outer", "reduce", "accumulate"):  # a ufunc has these
        if hasattr(function, name):
            setattr(rounded, name, getattr(function, name))
    return rounded


if os.environ.get("MOCAP_ROUNDING"):
    for module, names in FUNCTIONS.items():
        for name in names:
            setattr(module, name, rounded_otherwise(getattr(module, name)))
