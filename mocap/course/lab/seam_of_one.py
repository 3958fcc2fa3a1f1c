"""One seam, all the way: a reader chooses it in notebook 00, and meets it again in each one up to 08.

It leads from one walk of a person into another walk of the same person. The choice is kept in a file beside
`my_graph.py`. Without captured clips, the two walks are generated ones.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mocap import datasets
from mocap._shared import records
from mocap._shared.atomic import write_file
from mocap.body.motion import Motion, resample
from mocap.course.lab.kept_functions import place
from mocap.course.real_clips import people
from mocap.errors import MocapError
from mocap.graphs.motion_graph import build
from mocap.graphs.pruning import prune
from mocap.matching.distance_grids import distance_grid
from mocap.matching.minima import local_minima

TRIALS = ("16_12", "16_16")  # walks of subject 16 of the CMU database
GENERATED = ("walk_circle", "walk_curve_1")
FPS = 30  # frames per second
WINDOW = 10  # frames
BELOW = 0.04  # metres: the threshold of the seams
ROOM = 25  # frames of both clips before a seam and after it
APART = 15  # frames between two seams of the list, in one of the clips
LISTED = 5  # seams to choose from


class Pair(records.NamedTuple):
    """Two walks, and a seam from the first into the second.

    Attributes
    ----------
    a, b : the walks, at 30 frames per second.
    i, j : the first frames of the seam's windows of ten frames, in a and in b.
    distance : their RMS distance, metres.
    """

    a: Motion
    b: Motion
    i: int
    j: int
    distance: float

    def is_apart(self, i: int, j: int) -> bool:
        """Return whether a seam of other frames is not nearly the same one."""
        return abs(i - self.i) >= APART or abs(j - self.j) >= APART

    def __str__(self) -> str:
        ends = f"frame {self.i} of {self.a.name} into frame {self.j} of {self.b.name}"
        return f"Your seam leads from {ends}: {100 * self.distance:.1f} cm."


def pair() -> Pair:
    """Return the seam that the reader has chosen in notebook 00, or the best one, and print it.

    Notebooks: 02-matching to 08-path-synthesis
    """
    seams = _seams()
    number = _chosen(len(seams))
    print(seams[number])
    return seams[number]


def choose_pair(number: int = 1) -> Pair:
    """Choose a seam for the notebooks up to 08, print those to choose from, and keep the choice in a file.

    Parameters
    ----------
    number : that of the seam in the printed list, which starts with the best one, 1.

    Raises
    ------
    MocapError : for a number that the list does not have.

    Notebook: 00-quickstart
    """
    seams = _seams()
    if number not in range(1, len(seams) + 1):
        raise MocapError(f"There are {len(seams)} seams to choose from, got {number}.")
    for listed, seam in enumerate(seams, start=1):
        mark = "→" if listed == number else " "
        print(f"{mark} {listed}: frame {seam.i} to frame {seam.j}, {100 * seam.distance:.1f} cm")
    file = _file()
    if file:
        write_file(file, f"{number}\n")
    return seams[number - 1]


def _seams() -> list[Pair]:
    """List the best seams between the two walks that pruning keeps, and that are not close to each other."""
    clips = [resample(clip, FPS) for clip in people(*TRIALS)]
    if not clips:
        clips = [resample(datasets.sample(name), FPS)[:300] for name in GENERATED]
    a, b = clips
    grid = distance_grid(a, b, window=WINDOW)
    minima = local_minima(grid, below=BELOW**2)
    has_room = (minima >= ROOM).all(axis=1) & (minima < np.subtract(grid.shape, ROOM)).all(axis=1)
    minima = minima[has_room]
    distances = np.sqrt(grid[tuple(minima.T)])
    kept = prune(build(clips, window=WINDOW, threshold=BELOW)).graph
    seams: list[Pair] = []
    for number in np.argsort(distances, kind="stable"):
        i, j = map(int, minima[number])
        is_new = all(seam.is_apart(i, j) for seam in seams)
        if is_new and len(seams) < LISTED and kept.has_edge((0, i), (1, j + WINDOW)):
            seams.append(Pair(a, b, i, j, float(distances[number])))
    return seams


def _file() -> Path | None:
    """Return the file of the choice, beside that of the functions; None if nothing is kept."""
    functions = place()
    return functions and functions.with_name("my_seam.txt")


def _chosen(count: int) -> int:
    """Return the place of the chosen seam in the list, 0 if nothing has been chosen."""
    file = _file()
    try:
        number = int(file.read_text("utf-8")) if file else 1
    except (OSError, ValueError):  # no file, or another text in it
        return 0
    return number - 1 if number in range(1, count + 1) else 0
