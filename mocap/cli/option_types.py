"""Types of options that several commands have, with conversion, bounds and help."""

import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Literal

from mocap.cli.typed_commands import ONE_EACH
from mocap.errors import MocapError


def number(low: float, high: float, kind: Callable[[str], float] = float) -> Callable[[str], float]:
    """Return a converter for an option whose value is a number, or with `int` an integer, within bounds.

    Examples
    --------
    >>> number(0, 10)("4.5")
    4.5
    >>> number(0, 10, int)("nan")
    Traceback (most recent call last):
    mocap.errors.MocapError: 'nan' is not a whole number from 0 to 10
    """
    expected = f"a whole number from {low} to {high}" if kind is int else f"a number from {low:g} to {high:g}"

    def read(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise MocapError(f"{text[:40]!r} is not {expected}")
        return value

    return read


# A time in a clip: "1.5s" is in seconds, and "45" is a frame, as in the keys of `mocap warp`.
MOMENT = r"(\d{1,9}|\d{1,9}(?:\.\d{1,9})?s)"


def moment(text: str) -> str:
    """Check the form of a time in a clip, a frame or seconds, for an option.

    Examples
    --------
    >>> moment("90"), moment("1.5s")
    ('90', '1.5s')
    """
    if not re.fullmatch(MOMENT, text):
        raise MocapError(f"{text[:40]!r} is no time in a clip: write a frame as in 90, or seconds as in 1.5s")
    return text


def frame_at(time_in_clip: str, fps: float) -> int:
    """Convert a time in a clip to the nearest frame.

    Examples
    --------
    >>> frame_at("90", fps=120.0), frame_at("1.5s", fps=120.0)
    (90, 180)
    """
    return round(float(time_in_clip.removesuffix("s")) * (fps if time_in_clip.endswith("s") else 1.0))


LENGTH = number(1e-6, 1e6)  # metres per unit
CM = number(0.001, 1000)  # centimetres
RATE = number(1, 1000)  # frames per second
TURN = number(1, 2800)  # degrees per second. `editing.bend` accepts 50 radians per second, 2865 degrees
Skeleton = Annotated[Path | None, "the .asf file of .amc clips (default: a matching one in their folder)"]
Joints = Annotated[
    Sequence[Path],
    ONE_EACH,
    "a .toml of the roles of joints, from mocap info CLIP --joints; may be repeated for several bodies",
]
Up = Annotated[
    Literal["y", "z", "-y", "-z", "x", "-x"] | None,
    "axis of the file that points up (default: as the frames show; y, for AMASS z)",
]
RootOffset = Annotated[
    Literal["add", "ignore"] | None,
    "whether the positions of the root in a .bvh are relative to its OFFSET (default: as the frames show)",
]
Clean = Annotated[bool, "remove foot sliding"]
PlainNames = Annotated[
    bool,
    "drop the characters [ ] . : / from the names of joints, and replace blanks by _, as three.js does",
]
Seed = Annotated[int, number(0, 2**32 - 1, int), "seed of the random numbers"]
