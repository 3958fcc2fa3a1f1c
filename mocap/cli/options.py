"""What the commands share: a progress bar, and the options for reading clips and building a graph."""

import argparse
import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mocap._shared.progress import Progress
from mocap.errors import MocapError

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]

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


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options for reading a clip."""
    add = command.add_argument
    add("--skeleton", type=Path, help=SKELETON)
    add("--fps", type=float, help="frames per second (default: as in the file; 120 for .amc)")
    add("--scale", type=float, help="metres per unit of length (default: 0.01; for .amc as in the .asf)")


def add_building(command: argparse.ArgumentParser) -> None:
    """Add the options for reading clips and building their graph."""
    add = command.add_argument
    add("--skeleton", type=Path, help=SKELETON)
    add("--scale", type=float, help="metres per unit of length in .bvh clips (default: 0.01)")
    add("--fps", type=float, default=30.0, help="frame rate of the graph (default: %(default)g)")
    add("--window", type=float, default=1 / 3, help="seconds of a transition (default: %(default).2f)")
    add("--threshold", type=float, default=4.0, help="largest distance of a match, cm (default: %(default)g)")


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
