"""Joint positions as a `.csv` table, for spreadsheets, R, pandas and MATLAB.

The first line names the columns: `time`, then `<joint>_x`, `<joint>_y` and `<joint>_z` for each joint. Each
further line is a frame: its time in seconds, and positions in the world in metres, y up. The text is UTF-8.
Names with commas or quotes are quoted. Bones and rotations are not in the table, so it cannot be
read as a motion.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.atomic import replacing
from mocap.body.joint_trees import place_joints
from mocap.body.motion import Motion
from mocap.errors import MocapError, shortened
from mocap.files.text import LARGEST

POSITIONS_AT_ONCE = 100_000  # positions of joints that are in memory at a time


def write(motion: Motion, path: str | Path, *, precision: int = 6) -> None:
    """Write the joint positions of a motion to a table atomically, with a part of it in memory at a time.

    Parameters
    ----------
    motion : F frames of J joints.
    path : the file, with F + 1 lines of 3 J + 1 columns.
    precision : the number of decimals of positions. With 6, they are rounded to a micrometre.

    Raises
    ------
    MocapError : for positions of 10⁹ m or more, names of joints with control characters, and a file that
        cannot be written.
    """
    with replacing(path) as unfinished, unfinished.open("w", encoding="utf-8", newline="\n") as file:
        file.write(_header(motion))
        for start, positions in _parts(motion):
            file.write(_rows(positions, start, motion.fps, precision))


def _header(motion: Motion) -> str:
    """Format the line of the columns' names."""
    for name in motion.skeleton.names:
        if not name.isprintable():
            raise MocapError(f"A .csv file cannot hold a joint called {shortened(repr(name), 60)}.")
    line = io.StringIO()
    columns = [f"{name}_{axis}" for name in motion.skeleton.names for axis in "xyz"]
    csv.writer(line, lineterminator="\n").writerow(["time", *columns])
    return line.getvalue()


def _parts(motion: Motion) -> Iterator[tuple[int, Array]]:
    """Yield the positions of consecutive frames (f, J, 3), metres, each with its first frame."""
    frames_at_once = max(1, POSITIONS_AT_ONCE // len(motion.skeleton))
    for start in range(0, len(motion), frames_at_once):
        frames = slice(start, start + frames_at_once)
        roots = motion.root_positions[frames]
        positions = place_joints(motion.skeleton, roots, motion.rotations[frames]).positions
        if not np.all(np.abs(positions) < LARGEST):
            raise MocapError(f"'{shortened(motion.name)}' goes {LARGEST:g} m far: no table holds it.")
        yield start, positions


def _rows(positions: Array, start: int, fps: float, precision: int) -> str:
    """Format the lines of frames, of which `start` is the number of the first."""
    values = np.round(positions.reshape(len(positions), -1), precision) + 0.0  # no -0.0
    row = ",".join(["%r", *[f"%.{precision}f"] * values.shape[1]]) + "\n"
    rows = zip(range(start, start + len(values)), values.tolist(), strict=True)
    return "".join(row % (frame / fps, *numbers) for frame, numbers in rows)
