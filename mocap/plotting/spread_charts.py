"""Charts of samples: medians with their quartiles, what people see, and random walks as rows of steps."""

from __future__ import annotations

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from mocap.plotting.style import CURVES, QUIET

SEAMS = LinearSegmentedColormap.from_list("seams", ["#F2D3E4", "#CC79A7", "#5B1F45"])


class Band(NamedTuple):
    """A median as a line, and the middle half of the samples as a band."""

    median: Line2D
    quartiles: PolyCollection


def quartile_band(
    x: ArrayLike, samples: ArrayLike, *, label: str = "", colour: str = CURVES[0], ax: Axes | None = None
) -> Band:
    """Draw the median of samples as a line, and the range from quartile to quartile as a band.

    Parameters
    ----------
    x : shape (n,), what was varied.
    samples : shape (n, k), k measurements at each x.
    label : for the legend.
    colour : of line and band.
    ax : axes; new ones by default.

    Returns
    -------
    The line and the band.

    Examples
    --------
    >>> band = quartile_band([1, 2], [[0, 1, 2, 3, 4], [5, 5, 6, 7, 7]])
    >>> band.median.get_ydata().tolist()
    [2.0, 6.0]

    Notebook: 04-blending
    """
    ax = ax or plt.figure(figsize=(5, 3.5), layout="constrained").add_subplot()
    low, middle, high = np.percentile(np.asarray(samples, float), [25, 50, 75], axis=1)
    (line,) = ax.plot(x, middle, "o-", color=colour, markersize=4, label=label or None)
    return Band(line, ax.fill_between(np.asarray(x, float), low, high, color=colour, alpha=0.2, linewidth=0))


def walk_rows(costs: ArrayLike, *, highest: float, ax: Axes | None = None) -> AxesImage:
    """Draw random walks as rows with a box per step: grey in a clip, purple for a transition, then white.

    Parameters
    ----------
    costs : shape (walks, steps): the cost of the transition that a step takes, 0 for a step that stays in its
        clip, NaN after the end of a walk.
    highest : the cost that is drawn darkest.
    ax : axes; new ones by default.

    Returns
    -------
    The image; a `colorbar` of it explains the costs.

    Examples
    --------
    >>> image = walk_rows([[0, 150, np.nan], [300, 0, 0]], highest=300)
    >>> image.get_array().mask.tolist()  # neither grey boxes nor white ones have a cost
    [[True, False, True], [False, True, True]]

    Notebook: 09-discussion
    """
    ax = ax or plt.figure(figsize=(6, 4), layout="constrained").add_subplot()
    values = np.asarray(costs, float)
    alive = np.ma.masked_where(np.isnan(values), np.zeros(values.shape))
    grey = LinearSegmentedColormap.from_list("grey", ["#E4E4E4", QUIET])
    ax.imshow(alive, cmap=grey, vmin=0, vmax=1, aspect="auto", interpolation="nearest")
    taken = np.ma.masked_where(~(values > 0), np.nan_to_num(values))
    image = ax.imshow(taken, cmap=SEAMS, vmin=0, vmax=highest, aspect="auto", interpolation="nearest")
    ax.set(xlabel="step of the walk", ylabel="walk")
    return image


def seen_beside_measured(
    seen: ArrayLike, x: ArrayLike, measured: ArrayLike, labels: tuple[str, str]
) -> tuple[Axes, Axes]:
    """Draw how well people see seams above a measure of the same seams.

    Parameters
    ----------
    seen : shape (n, 4), rows (x, d′, low, high); a limit may be infinite.
    x, measured : shapes (m,) and (m, k), k measurements at each x, as for `quartile_band`.
    labels : of the x axis and of the measure, with units.

    Returns
    -------
    The upper axes and the lower ones, of a new figure that pyplot does not know.

    Examples
    --------
    >>> points = [[2, 2.8, 1.4, np.inf], [10, 0.9, 0.0, 1.9]]
    >>> upper, _ = seen_beside_measured(points, [2, 10], [[3, 4], [1, 2]], ("window (frames)", "jolt"))
    >>> upper.lines[1].get_ydata().tolist()
    [2.8, 0.9]

    Notebooks: 09-discussion, 09b-blend-window
    """
    upper, lower = Figure(figsize=(6, 5), layout="constrained").subplots(2, 1, sharex=True)
    at, value, low, high = np.atleast_2d(np.asarray(seen, float)).T
    upper.axhline(0, color=QUIET, linestyle=":", label="guessing")
    upper.plot(at, value, "o-", color=CURVES[0], markersize=5, label="d′ with its 95 % interval")
    upper.vlines(at, np.maximum(low, -9), np.minimum(high, 9), color=CURVES[0], linewidth=1.5)
    upper.set(ylabel="seen: d′", ylim=(-1.5, 4))
    upper.legend(frameon=False)
    quartile_band(x, measured, colour=CURVES[0], ax=lower)
    lower.set(xlabel=labels[0], ylabel=f"measured: {labels[1]}")
    return upper, lower
