"""Where can one clip pass into another? The local minima of the distance grids of all pairs of clips."""

from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap.errors import MocapError
from mocap.matching import align, check_window, distance_grid, point_cloud
from mocap.motion import Motion, require_alike
from mocap.progress import Progress
from mocap.transforms import PlanarTransform

Array = NDArray[np.float64]


class Transition(NamedTuple):
    """A way from one clip into another: two windows alike enough to be blended.

    The window of clip `source` starts at frame `leave`, that of clip `target` at frame `enter`; `transform`
    lays the second on the first, and `cost` is the RMS distance of the points that is left, in metres.
    """

    source: int
    leave: int
    target: int
    enter: int
    cost: float
    transform: PlanarTransform


def local_minima(grid: Array, below: float = np.inf) -> NDArray[np.intp]:
    """Find the entries under a threshold that are lower than all eight neighbours [KGP02, 3.2].

    Beyond the border there is nothing lower; of neighbours that are exactly equal, the first in reading
    order counts as the lower.

    Parameters
    ----------
    grid : shape (n, m).
    below : only entries under this value, in the grid's unit.

    Returns
    -------
    Rows and columns, shape (N, 2), in reading order.

    Examples
    --------
    >>> local_minima(np.array([[3, 2, 3], [2, 1, 2], [0, 2, 2]]), below=2).tolist()
    [[2, 0]]

    Notebook: 00-quickstart
    """
    padded = np.pad(np.asarray(grid, float), 1, constant_values=np.inf)
    rows, columns = np.nonzero(grid < below)
    value = grid[rows, columns]
    lowest = np.ones(len(rows), bool)
    for row, column in ((r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)):
        neighbour = padded[rows + 1 + row, columns + 1 + column]
        lowest &= value < neighbour if (row, column) < (0, 0) else value <= neighbour
    return np.stack([rows[lowest], columns[lowest]], axis=-1)


def find_transitions(
    clips: Sequence[Motion], *, window: int, below: float, progress: Progress = iter
) -> list[Transition]:
    """Find where one clip can pass into another: local minima of the distance grids of all pairs.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window : frames in a window; about a third of a second.
    below : the largest RMS distance of the points, metres.
    progress : wraps the pairs of clips as they are worked through, to show a bar.

    Returns
    -------
    Transitions both ways between all pairs, within a clip too, ordered by clip and frame. Left out are
    those between windows of one clip that overlap, which would lead from a moment to itself.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, and for clips shorter than the window.

    Notebook: 00-quickstart
    """
    require_alike(clips)
    if not below > 0:
        raise MocapError(f"The threshold must be above 0 m, got {below} m.")
    clouds = [point_cloud(clip) for clip in clips]
    for clip in clips:
        check_window(window, len(clip), clip.name)
    found: list[Transition] = []
    for a, b in progress(list(combinations_with_replacement(range(len(clips)), 2))):
        found += _pair_transitions(clouds, (a, b), window, below)
    return sorted(found, key=lambda t: t[:4])


def _pair_transitions(
    clouds: list[Array], pair: tuple[int, int], window: int, below: float
) -> list[Transition]:
    """Turn the minima of one pair's grid into transitions both ways; the way back is the inverse."""
    a, b = pair
    grid = distance_grid(clouds[a], clouds[b], window=window)
    minima = local_minima(grid, below**2)
    if a == b:
        minima = minima[minima[:, 1] - minima[:, 0] >= window]
    i, j = minima.T
    frames = np.arange(window)
    points, others = (
        np.concatenate(np.moveaxis(clouds[clip][start[:, None] + frames], 1, 0), axis=1)  # (N, window · P, 3)
        for clip, start in ((a, i), (b, j))
    )
    there = align(points, others)
    return [
        Transition(source, int(leave), target, int(enter), cost, PlanarTransform(*numbers))
        for source, target, way in ((a, b, (i, j, there)), (b, a, (j, i, there.inverse())))
        for leave, enter, cost, *numbers in np.column_stack([*way[:2], np.sqrt(grid[i, j]), *way[2]]).tolist()
    ]
