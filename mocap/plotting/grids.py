"""Grids as images: distance grids with their minima, and walks as rows of boxes."""

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.image import AxesImage
from numpy.typing import ArrayLike, NDArray

from mocap.plotting.style import QUIET

Grid = NDArray[np.floating[Any]]
SEAMS = LinearSegmentedColormap.from_list("seams", ["#F2D3E4", "#CC79A7", "#5B1F45"])
STEPS = LinearSegmentedColormap.from_list("steps", ["#E4E4E4", QUIET])


def distance_image(
    grid: Grid, *, fps: float, minima: ArrayLike = (), names: Sequence[str] = ("", ""), ax: Axes | None = None
) -> AxesImage:
    """Draw a distance grid, in which similar windows are dark, with its minima marked [KGP02, Fig. 3].

    Parameters
    ----------
    grid : D, shape (n, m), square metres, as from `matching.distance_grid`.
    fps : frames per second. The axes are in seconds, from the start of each window.
    minima : shape (N, 2), the cells (i, j) to mark.
    names : the names of the motions in the rows and in the columns.
    ax : axes, by default new ones.

    Returns
    -------
    The image of RMS distances in centimetres.

    Examples
    --------
    >>> from mocap import plotting
    >>> image = distance_image(np.array([[0.04, 0.01], [0.01, 0.04]]), fps=30, minima=[[0, 1]])
    >>> image.get_array().tolist()
    [[20.0, 10.0], [10.0, 20.0]]
    >>> plotting.show(image, alt="Four distances, dark along the rising diagonal.")
    Picture('Four distances, dark along the rising diagonal.')

    Notebook: 02b-distance-grids
    """
    ax = ax or plt.figure(figsize=(5, 4.2), layout="constrained").add_subplot()
    centimetres = 100 * np.sqrt(grid, dtype=np.float32)  # half the memory, and faster to draw
    extent = 0, grid.shape[1] / fps, grid.shape[0] / fps, 0
    image = ax.imshow(centimetres, cmap="cividis", extent=extent, interpolation="nearest", aspect="equal")
    rows, columns = (np.reshape(minima, (-1, 2)).T + 0.5) / fps
    ax.plot(columns, rows, ".", color="#FFFFFF", markersize=4, label="minima")
    ax.figure.colorbar(image, ax=ax, label="RMS distance (cm)", shrink=0.8)
    ax.set(xlabel=f"{names[1]} (s)".strip(), ylabel=f"{names[0]} (s)".strip())
    return image


def walk_rows(costs: ArrayLike, *, highest: float, ax: Axes | None = None) -> AxesImage:
    """Draw random walks as rows with a box per step: grey in a clip, purple for a transition, then white.

    Parameters
    ----------
    costs : shape (walks, steps), the cost of the transition of a step, 0 for a step within a clip, and NaN
        after the end of a walk.
    highest : the cost that is drawn darkest.
    ax : axes, by default new ones.

    Returns
    -------
    The image, for a `colorbar` of the costs.

    Examples
    --------
    >>> image = walk_rows([[0, 150, np.nan], [300, 0, 0]], highest=300)
    >>> image.get_array().mask.tolist()  # neither grey boxes nor white ones have a cost
    [[True, False, True], [False, True, True]]

    Notebook: 09-discussion
    """
    ax = ax or plt.figure(figsize=(6, 4), layout="constrained").add_subplot()
    values = np.asarray(costs, float)
    look: dict[str, Any] = {"vmin": 0, "aspect": "auto", "interpolation": "nearest"}
    steps = np.ma.masked_where(np.isnan(values), np.zeros(values.shape))
    ax.imshow(steps, cmap=STEPS, vmax=1, **look)
    transitions = np.ma.masked_where(~(values > 0), np.nan_to_num(values))
    ax.set(xlabel="step of the walk", ylabel="walk")
    return ax.imshow(transitions, cmap=SEAMS, vmax=highest, **look)
