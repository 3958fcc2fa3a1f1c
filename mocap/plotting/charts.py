"""Charts: curves over time, samples as bands."""

from collections.abc import Sequence
from itertools import cycle, repeat

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from mocap.plotting.style import CURVES


def joint_curve(
    values: ArrayLike, *, fps: float, labels: Sequence[str] = (), ax: Axes | None = None
) -> list[Line2D]:
    """Draw a joint's values over time.

    Parameters
    ----------
    values : shape (F,) or (F, K), such as a joint's heights or its angles.
    fps : frames per second.
    labels : the names of the K curves, with their units.
    ax : axes; new ones by default.

    Returns
    -------
    The K curves.

    Examples
    --------
    >>> from mocap import plotting
    >>> (curve,) = joint_curve([0.0, 2.0, 3.0, 3.0], fps=10, labels=["height (cm)"])
    >>> curve.get_xdata().tolist()  # seconds
    [0.0, 0.1, 0.2, 0.3]
    >>> plotting.show(curve, alt="A height that rises.")
    Picture('A height that rises.')

    Notebook: 00-quickstart
    """
    ax = ax or plt.figure(figsize=(6, 2.8), layout="constrained").add_subplot()
    columns = np.reshape(values, (len(np.asarray(values)), -1))
    curves = ax.plot(np.arange(len(columns)) / fps, columns, linewidth=1.6)
    for curve, colour, label in zip(curves, cycle(CURVES), labels or repeat(None)):
        curve.set(color=colour, label=label)
    if len(labels) > 1:
        ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=len(labels))
    ax.set(xlabel="time (s)", ylabel=labels[0] if len(labels) == 1 else None)
    ax.spines[["top", "right"]].set_visible(False)
    return curves


def quartile_band(
    x: ArrayLike, samples: ArrayLike, *, label: str = "", colour: str = CURVES[0], ax: Axes | None = None
) -> Line2D:
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
    The median's line.

    Examples
    --------
    >>> median = quartile_band([1, 2], [[0, 1, 2, 3, 4], [5, 5, 6, 7, 7]])
    >>> median.get_ydata().tolist()
    [2.0, 6.0]

    Notebook: 04b-feet
    """
    ax = ax or plt.figure(figsize=(5, 3.5), layout="constrained").add_subplot()
    low, middle, high = np.percentile(np.asarray(samples, float), [25, 50, 75], axis=1)
    (line,) = ax.plot(x, middle, "o-", color=colour, markersize=4, label=label or None)
    ax.fill_between(np.asarray(x, float), low, high, color=colour, alpha=0.2, linewidth=0)
    return line
