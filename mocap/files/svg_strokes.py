"""The first stroke of an SVG path: its commands, and the points that they draw [SVG11, 8.3].

The `d` of a path is a text such as "M 0 0 L 10 0 q 5 0 5 5": a letter for each command, and its numbers.
Upper-case commands have absolute coordinates, lower-case ones coordinates relative to the pen. Points are
complex numbers x + iy, with x to the right and y down.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import takewhile
from math import comb
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import FormatError, shortened
from mocap.files.text import to_numbers

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
SEPARATORS = " ,\t\n"  # of numbers (a sign also begins a new number)
WORD = re.compile(rf"{NUMBER.pattern}|[^{SEPARATORS}]")

COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}  # numbers
IMPLIED = {"M": "L", "m": "l"}  # the command of further numbers, if it is another one
FLAGS = slice(3, 5)  # numbers of an arc that are 0 or 1: large, sweep

MOST_POINTS = 500_000  # half a kilometre with a point in every millimetre
CURVE_PIECES = 32  # line segments of a curve
ARC_PIECES = 128  # line segments of an arc


def _bernstein(degree: int) -> Array:
    """Return the Bernstein polynomials of a Bézier curve, shape (`CURVE_PIECES`, degree + 1).

    The point at t is the sum of C(n, k) (1 - t)ⁿ⁻ᵏ tᵏ times control point k. The rows are the values t > 0.
    """
    t = np.linspace(0, 1, CURVE_PIECES + 1)[1:]
    polynomials = []
    for k in range(degree + 1):
        polynomials.append(comb(degree, k) * (1 - t) ** (degree - k) * t**k)
    return np.stack(polynomials, axis=1)


BERNSTEIN = {degree: _bernstein(degree) for degree in (2, 3)}
ARC_FRACTIONS = np.linspace(0, 1, ARC_PIECES + 1)[1:]


@dataclass
class _Pen:
    """A pen that draws one stroke.

    points : the points drawn so far.
    position : the position of the pen.
    start : the start of the stroke, to which `Z` closes it.
    control : the last control point of the last curve.
    command : the last command, in upper case.
    """

    points: list[complex] = field(default_factory=list)
    position: complex = 0j
    start: complex = 0j
    control: complex = 0j
    command: str = ""

    def draw(self, letter: str, numbers: list[float]) -> None:
        """Carry out a command."""
        command = letter.upper()
        origin = self.position if letter.islower() else 0j
        end = self._end(command, numbers, origin)
        match command:
            case "M":
                self.points.clear()
                self.start = end
            case "A":
                self.points += _arc(self.position, numbers, end)[:-1]
            case "C" | "S" | "Q" | "T":
                self.points += self._curve(command, numbers, origin)[:-1]
        self.points.append(end)
        self.position = end
        self.command = command

    def _end(self, command: str, numbers: list[float], origin: complex) -> complex:
        """Return the position after a command."""
        match command:
            case "Z":
                return self.start
            case "H":
                return complex(origin.real + numbers[0], self.position.imag)
            case "V":
                return complex(self.position.real, origin.imag + numbers[0])
        return origin + complex(*numbers[-2:])

    def _curve(self, command: str, numbers: list[float], origin: complex) -> list[complex]:
        """Return the points of a Bézier curve after its start, and store its last control point.

        `S` and `T` omit the first control point. After a curve of the same degree, it is the reflection of
        the last control point, and after any other command the position of the pen.
        """
        pairs = zip(numbers[::2], numbers[1::2], strict=True)
        corners = [origin + complex(*pair) for pair in pairs]
        if command in "ST":
            is_smooth = self.command in ("CS" if command == "S" else "QT")
            corners.insert(0, 2 * self.position - self.control if is_smooth else self.position)
        self.control = corners[-2]
        points: list[complex] = (BERNSTEIN[len(corners)] @ [self.position, *corners]).tolist()
        return points


def first_stroke(path: Path, text: str, element: str) -> Array:
    """Return the points of the first stroke of a path, (N, 2); curves are approximated by line segments.

    Parameters
    ----------
    path : the file, for errors.
    text : the `d` of a path.
    element : the kind of element of the text, for errors.

    Raises
    ------
    FormatError : for a text that breaks the format, and for more than 500 000 points.

    Examples
    --------
    >>> first_stroke(Path("a.svg"), "M 0 0 h 3 v 4 z", "path").tolist()
    [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 0.0]]
    """
    pen = _Pen()
    for letter, numbers in _commands(path, text, element):
        if len(pen.points) > MOST_POINTS:
            raise FormatError(path, None, f"a line of {MOST_POINTS:,} points at most", "more")
        if letter in "Mm" and len(pen.points) > 1:
            break  # a second stroke
        pen.draw(letter, numbers)
    return np.array(pen.points).view(float).reshape(-1, 2)


def _commands(path: Path, text: str, element: str) -> Iterator[tuple[str, list[float]]]:
    """Yield the commands of the `d` of a path, each with its numbers. A repeated command needs no letter."""
    words = WORD.findall(text)
    if words[:1] not in (["M"], ["m"]):
        raise FormatError(path, None, "a path that starts with 'M'", f"'{text[:99]}'")
    letter = ""
    index = 0
    while index < len(words):
        if words[index].isalpha() or letter in "zZ":
            letter = words[index]
            index += 1
        if letter.upper() not in COUNTS:
            raise FormatError(path, None, f"the commands {' '.join(COUNTS)}", f"'{shortened(letter, 40)}'")
        count = COUNTS[letter.upper()]
        yield letter, _numbers(path, words[index : index + count], letter, element)
        index += count
        letter = IMPLIED.get(letter, letter)


def _numbers(path: Path, words: list[str], letter: str, element: str) -> list[float]:
    """Convert the words up to the next letter to the numbers of a command."""
    command = letter.upper()
    words = list(takewhile(lambda word: not word.isalpha(), words))
    taker = f"'{letter}'" if element == "path" else f"each point of a {element}"
    count = COUNTS[command]
    numbers = to_numbers(path, None, words, f"{count} numbers for {taker}", count).tolist()
    if command == "A" and not set(numbers[FLAGS]) <= {0, 1}:
        raise FormatError(path, None, f"flags 0 or 1 for '{letter}'", f"'{' '.join(words)}'")
    return list(numbers)


def _arc(start: complex, numbers: list[float], end: complex) -> list[complex]:
    """Return the points of an elliptic arc after its start [SVG11, F.6.5 and F.6.6].

    Rotated to its principal axes, and divided by its radii, the ellipse is a circle of radius 1. Of the two
    circles through both end points, the flags determine the centre and the direction.
    """
    radius_x = abs(numbers[0])
    radius_y = abs(numbers[1])
    tilt, large, sweep = numbers[2:5]
    if radius_x * radius_y == 0 or start == end:
        return [end]
    axis = np.exp(1j * np.radians(tilt))  # the direction of the first radius
    upright = np.array([start, end]) / axis
    first, last = upright.real / radius_x + 1j * upright.imag / radius_y
    half = (last - first) / 2  # of the chord
    radius = max(1.0, abs(half))  # above 1 if the radii are too small to reach the end
    to_centre = 1j * half / abs(half) * np.sqrt(radius**2 - abs(half) ** 2)
    if large == sweep:
        to_centre = -to_centre
    centre = (first + last) / 2 + to_centre
    angle = np.angle((last - centre) / (first - centre)) % (2 * np.pi)
    if not sweep:
        angle = angle - 2 * np.pi
    circle = centre + (first - centre) * np.exp(1j * angle * ARC_FRACTIONS)
    ellipse = (circle.real * radius_x + 1j * circle.imag * radius_y) * axis
    points: list[complex] = ellipse.tolist()
    return [*points[:-1], end]
