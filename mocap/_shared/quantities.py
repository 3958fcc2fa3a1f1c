"""Checks of the type and the unit of numbers, with errors that show the intended value."""

import math
from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.errors import MocapError, Remedy, shortened

FARTHEST_WINDOW = 1.0  # metres (RMS): the largest plausible threshold (random windows are 0.2 m apart)
FULL_TURN = 2 * math.pi  # radians


def described(value: object) -> str:
    """Describe a value in a few words, for errors.

    Examples
    --------
    >>> described("walk.bvh"), described([1, 2]), described(np.zeros((2, 3))), described(4)
    ("the text 'walk.bvh'", 'a list of 2', 'an array (2, 3)', '4')
    """
    if isinstance(value, str):
        return f"the text {shortened(repr(value), 60)}"
    if isinstance(value, np.ndarray):
        return f"an array {value.shape}"
    if isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        return f"a {type(value).__name__} of {len(value)}"
    if value is None or isinstance(value, Real):
        return str(value)
    kind = type(value).__name__
    return f"{'an' if kind[0] in 'AEIOaeio' else 'a'} {kind}"


def check_number(value: Any, name: str) -> None:  # noqa: ANN401
    """Raise unless a value is a number: 4 is one, "4" is not.

    Examples
    --------
    >>> check_number("4", "fps")
    Traceback (most recent call last):
    mocap.errors.MocapError: fps must be a number such as 4, got the text '4'.
    """
    if isinstance(value, Real | np.number):
        return
    example = value if isinstance(value, str) and value.strip("-").replace(".", "", 1).isdigit() else "30"
    raise MocapError(f"{name} must be a number such as {example}, got {described(value)}.")


def check_threshold(metres: Any) -> None:  # noqa: ANN401
    """Raise for a threshold above 1 m, also for each of a mapping from pairs of labels to thresholds.

    Examples
    --------
    >>> check_threshold(4)
    Traceback (most recent call last):
    mocap.errors.MocapError: A threshold of 4 m lets any two poses meet: it is in metres, 0.04 for 4 cm.
    """
    for distance in metres.values() if isinstance(metres, Mapping) else [metres]:
        check_number(distance, "A threshold")
        if FARTHEST_WINDOW < distance < math.inf:
            centimetres = f"{distance / 100:g} for {distance:g} cm"
            raise MocapError(
                f"A threshold of {distance:g} m lets any two poses meet: it is in metres, {centimetres}."
            )


def check_radians(angle: Any, name: str, *, largest: float = FULL_TURN) -> None:  # noqa: ANN401
    """Raise for an angle that is probably in degrees, because it is implausibly large in radians.

    Parameters
    ----------
    angle : radians, or radians per second.
    name : the name of the angle, for the error.
    largest : the largest angle that is accepted.

    Examples
    --------
    >>> check_radians(90, "direction")
    Traceback (most recent call last):
    mocap.errors.MocapError: direction is in radians, got 90: write np.radians(90) for 90 degrees.
    """
    check_number(angle, name)
    if abs(angle) > largest and math.isfinite(angle):
        degrees = Remedy(f"write np.radians({angle:g}) for {angle:g} degrees")
        raise MocapError(f"{name} is in radians, got {angle:g}.", remedy=degrees)


def check_frames(count: Any, name: str, fps: float | None = None) -> None:  # noqa: ANN401
    """Raise unless a number of frames is whole and at least 1.

    Parameters
    ----------
    count : frames.
    name : of the number, for the error.
    fps : frames per second of the clip, for the error.

    Examples
    --------
    >>> check_frames(0.33, "A window", 30)
    Traceback (most recent call last):
    mocap.errors.MocapError: A window is a whole number of frames, got 0.33: 0.33 s at 30 Hz are 10 frames.
    """
    if isinstance(count, int | np.integer) and count >= 1:
        return
    needs = f"{name} is a whole number of frames, at least one frame, got {described(count)}"
    if fps and isinstance(count, float) and count > 0:
        seconds = f"{count:g} s at {fps:g} Hz are {max(1, round(count * fps))} frames"
        raise MocapError(f"{name} is a whole number of frames, got {count:g}: {seconds}.")
    raise MocapError(f"{needs}.")


def numbers_of(values: ArrayLike, name: str, example: str) -> Array:
    """Convert values to an array of numbers.

    Parameters
    ----------
    values : numbers, lists of them, or an array.
    name : the name of the values, for the error.
    example : an example of such values, for the error.

    Raises
    ------
    MocapError : for text, and for rows of different lengths.

    Examples
    --------
    >>> numbers_of([[0, 0], [0, 1, 2]], "A path", "[[0, 6]]")
    Traceback (most recent call last):
    mocap.errors.MocapError: A path needs numbers such as [[0, 6]], got a list of 2: rows differ in length.
    """
    try:
        return np.asarray(values, float)
    except (TypeError, ValueError) as error:
        cause = "rows differ in length" if "inhomogeneous" in str(error) else "not all are numbers"
        got = described(values) if isinstance(values, str) else f"{described(values)}: {cause}"
        raise MocapError(f"{name} needs numbers such as {example}, got {got}.") from None
