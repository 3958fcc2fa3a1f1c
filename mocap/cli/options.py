"""What the commands share: a bar of progress, and the options of how to read clips and build a graph."""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from tqdm import tqdm

from mocap._shared.progress import Progress
from mocap.errors import MocapError

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]


def bar(what: str) -> Progress:
    """Show a bar on a terminal for work that takes longer than a second; it leaves nothing behind.

    Examples
    --------
    >>> list(bar("counting")([1, 2, 3]))
    [1, 2, 3]
    """
    return partial(tqdm, desc=what, delay=1.0, leave=False, disable=None)


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options of how to read a clip."""
    add = command.add_argument
    add("--skeleton", type=Path, help="the .asf file of .amc clips (default: the one beside them that fits)")
    add("--fps", type=float, help="frames per second (default: what the file says; 120 for .amc)")
    add("--scale", type=float, help="metres in a unit (default: 0.01; for .amc what .asf says)")


def add_building(command: argparse.ArgumentParser) -> None:
    """Add the options of how to read clips and build a graph of them."""
    add = command.add_argument
    add("--skeleton", type=Path, help="the .asf file of .amc clips (default: the one beside them that fits)")
    add("--scale", type=float, help="metres in a unit of the .bvh clips (default: 0.01)")
    add("--fps", type=float, default=30.0, help="frames per second to work at (default: %(default)g)")
    add("--window", type=float, default=1 / 3, help="seconds of a transition (default: %(default).2f)")
    add("--threshold", type=float, default=4.0, help="worst match allowed, cm RMS (default: %(default)g)")


def window_frames(seconds: float, fps: float) -> int:
    """Count the frames of a window; it must last at least two.

    Examples
    --------
    >>> window_frames(1 / 3, 30.0)
    10
    """
    frames = seconds * fps
    if not (np.isfinite(frames) and round(frames) >= 2):
        raise MocapError(f"A window needs two frames or more, got {seconds:g} s at {fps:g} Hz.")
    return round(frames)
