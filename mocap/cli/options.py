"""What the commands share: a progress bar, numbers with bounds, the options for reading and building."""

import argparse
import math
import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mocap._shared.progress import Progress
from mocap.errors import MocapError

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]

RATES = (1.0, 1000.0)  # frames per second that a graph or a film may have
SKELETON = "the .asf file of .amc clips (default: the one in the same folder that fits)"


def bar(what: str) -> Progress:
    """Show a progress bar on a terminal, for work that takes longer than a second; erase it at the end.

    Examples
    --------
    >>> list(bar("counting")([1, 2, 3]))
    [1, 2, 3]
    """
    from tqdm import tqdm  # imported here, so that `mocap --help` stays quick

    return partial(tqdm, desc=what, delay=1.0, leave=False, disable=None)


def number(low: float, high: float) -> Callable[[str], float]:
    """Make a type for an option that takes a number within bounds.

    Examples
    --------
    >>> number(0, 10)("4.5")
    4.5
    >>> number(0, 10)("nan")
    Traceback (most recent call last):
    argparse.ArgumentTypeError: 'nan' is not a number from 0 to 10
    """

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a number from {low:g} to {high:g}")
        return value

    return read


def whole(low: int, high: int) -> Callable[[str], int]:
    """Make a type for an option that takes a whole number within bounds.

    Examples
    --------
    >>> whole(1, 10)("0")
    Traceback (most recent call last):
    argparse.ArgumentTypeError: '0' is not a whole number from 1 to 10
    """

    def read(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a whole number from {low} to {high}")
        return value

    return read


LENGTH, CM, SEED = number(1e-6, 1e6), number(0.001, 1000), whole(0, 2**32 - 1)
TURN = number(1, 3600)  # degrees per second


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options for reading a clip."""
    add = command.add_argument
    add("--skeleton", type=Path, help=SKELETON)
    add("--fps", type=number(*RATES), help="frames per second (default: as in the file; 120 for .amc)")
    add("--scale", type=LENGTH, help="metres per unit of length (default: 0.01; for .amc as in the .asf)")


def add_building(command: argparse.ArgumentParser) -> None:
    """Add the options for reading clips and building their graph."""
    add = command.add_argument
    add("--skeleton", type=Path, help=SKELETON)
    add("--scale", type=LENGTH, help="metres per unit of length in .bvh clips (default: 0.01)")
    add("--fps", type=number(*RATES), default=30.0, help="frame rate of the graph (default: %(default)g)")
    add(
        "--window", type=number(0, 60), default=1 / 3, help="seconds of a transition (default: %(default).2f)"
    )
    add("--threshold", type=CM, default=4.0, help="largest distance of a match, cm (default: %(default)g)")


def window_frames(seconds: float, fps: float) -> int:
    """Count the frames of a window, which needs at least two.

    Raises
    ------
    MocapError : if there are fewer.

    Examples
    --------
    >>> window_frames(1 / 3, 30.0)
    10
    """
    frames = seconds * fps
    if not (math.isfinite(frames) and round(frames) >= 2):
        raise MocapError(f"A window needs two frames or more, got {seconds:g} s at {fps:g} Hz.")
    return round(frames)


def as_options(message: str) -> str:
    """Give the arguments that a message names the names that they have on a command line.

    Examples
    --------
    >>> as_options("choose another name, or set skeleton= to it; widen=True also writes one")
    'choose another name, or set --skeleton to it; --widen also writes one'
    """
    return re.sub(r"\b(skeleton|scale|fps|widen|clips)=(True)?(?=\W|$)", r"--\1", message)


def require_other(target: Path, read: Iterable[Path]) -> None:
    """Raise where the file to write is one of those to read.

    Examples
    --------
    >>> require_other(Path("clips/walk.bvh"), [Path("clips/run.bvh"), Path("./clips/walk.bvh")])
    Traceback (most recent call last):
    mocap.errors.MocapError: clips/walk.bvh is one of the files to read: choose another name with -o.
    """
    if target.resolve() in (path.resolve() for path in read):
        raise MocapError(f"{target} is one of the files to read: choose another name with -o.")


def require_amc(clip: Path, skeleton: Path | None) -> None:
    """Raise for a skeleton that a clip does not need.

    Examples
    --------
    >>> require_amc(Path("walk.bvh"), Path("walk.asf"))
    Traceback (most recent call last):
    mocap.errors.MocapError: --skeleton is for .amc clips; walk.bvh needs none.
    """
    if skeleton and clip.suffix.lower() in (".bvh", ".npz"):
        raise MocapError(f"--skeleton is for .amc clips; {clip} needs none.")
