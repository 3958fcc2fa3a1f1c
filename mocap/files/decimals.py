"""The numbers of a long text, converted many at a time, each to the same double as by `float`.

A decimal such as -12.75 is an integer, 1275, over a power of ten, 10². An integer below 2⁵³ and a power of at
most 10²² are doubles without rounding, so their quotient is the double nearest to the decimal [CLINGER90]_.
NumPy reads integers ten times faster than decimals.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices, Mask, ranges

# Characters of ASCII. Those from TAB to RETURN separate words, as a blank does.
BLANK = ord(" ")
TAB = ord("\t")
RETURN = ord("\r")
MINUS = ord("-")
POINT = ord(".")
ZERO = ord("0")
NINE = ord("9")
MOST_DIGITS = 15  # of an integer that is surely below 2⁵³
POWERS = 10.0 ** np.arange(MOST_DIGITS + 1)
BLOCK = 2**16  # characters that are converted at a time: their arrays fit into the cache of a processor


def parse_numbers(text: str) -> Array | None:
    r"""Convert the numbers of a text, which blanks and line ends separate, shape (n,).

    Returns
    -------
    The numbers, or None if a word of the text is not a number.

    Examples
    --------
    >>> parse_numbers("0.5 -12.75\n1e3")
    array([ 5.000e-01, -1.275e+01,  1.000e+03])
    >>> parse_numbers("0.5 1.2.3")
    """
    try:
        return np.concatenate([np.empty(0), *map(_parse_block, _blocks(text.encode()))])
    except ValueError:
        return None


def _blocks(data: bytes) -> Iterator[bytes]:
    """Split a text into blocks of whole lines."""
    start = 0
    while start < len(data):
        stop = data.find(b"\n", start + BLOCK) + 1 or len(data)
        yield data[start:stop]
        start = stop


def _parse_block(data: bytes) -> Array:
    """Convert the numbers of a block. Raise ValueError if a word is not a number."""
    characters = np.frombuffer(data, np.uint8)
    is_blank = (characters == BLANK) | ((characters >= TAB) & (characters <= RETURN))
    edges = np.flatnonzero(np.diff(is_blank, prepend=True, append=True))
    starts = edges[::2]
    stops = edges[1::2]
    if len(starts) == 0:
        return np.empty(0)
    is_plain, decimals = _plain_decimals(characters, starts, stops)
    unusual = np.flatnonzero(~is_plain)
    digits = characters.copy()
    digits[ranges(starts[unusual], stops[unusual] - starts[unusual])] = ZERO
    integers = np.fromstring(digits.tobytes().replace(b".", b""), np.int64, sep=" ")
    numbers: Array = np.abs(integers) / POWERS[decimals]
    numbers[characters[starts] == MINUS] *= -1.0  # 0 becomes -0
    words = zip(starts[unusual].tolist(), stops[unusual].tolist(), strict=True)
    numbers[unusual] = np.array([data[start:stop] for start, stop in words], float)
    return numbers


def _plain_decimals(characters: NDArray[np.uint8], starts: Indices, stops: Indices) -> tuple[Mask, Indices]:
    """Return which words are plain decimals, and the number of digits after their points, 0 for other words.

    A plain decimal has at most 15 digits, one of them at its end, at most one point, and perhaps a minus in
    front; no exponent. Raise ValueError for a word of two points.
    """
    is_digit = (characters >= ZERO) & (characters <= NINE)
    is_point = characters == POINT
    digits = _counts(is_digit, starts, stops)
    points = _counts(is_point, starts, stops)
    if points.max() > 1:
        raise ValueError("a word with two points is not a number")
    minuses = characters[starts] == MINUS
    is_plain = is_digit[stops - 1] & (digits <= MOST_DIGITS) & (digits + points + minuses == stops - starts)
    decimals = np.zeros(len(starts), int)
    decimals[points == 1] = stops[points == 1] - np.flatnonzero(is_point) - 1
    return is_plain, np.where(is_plain, decimals, 0)


def _counts(mask: Mask, starts: Indices, stops: Indices) -> Indices:
    """Count the marked characters of each word."""
    sums = np.zeros(len(mask) + 1, np.int32)
    np.cumsum(mask, out=sums[1:])
    return sums[stops] - sums[starts]
