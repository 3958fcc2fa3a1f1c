"""Charts: curves over time, samples as bands, boxes of costs, matches as trees."""

from collections.abc import Sequence
from itertools import cycle, repeat

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from mocap.methods.match_webs.match_search import Match
from mocap.plotting.style import ASTRAY, CURVES, QUIET, source_colours


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

    Notebook: 09b-blend-window
    """
    upper, lower = Figure(figsize=(6, 5), layout="constrained").subplots(2, 1, sharex=True)
    at, value, low, high = np.atleast_2d(np.asarray(seen, float)).T
    upper.axhline(0, color=QUIET, linestyle=":", label="guessing")
    upper.plot(at, value, "o-", color=CURVES[0], markersize=5, label="d′ with its 95 % interval")
    upper.vlines(at, np.maximum(low, -9), np.minimum(high, 9), color=CURVES[0], linewidth=1.5)
    upper.set(ylabel="seen: d′", ylim=(-1.5, 4))
    upper.legend(frameon=False)
    quartile_band(x, measured, ax=lower)
    lower.set(xlabel=labels[0], ylabel=f"measured: {labels[1]}")
    return upper, lower


def match_tree(
    matches: Sequence[Match],
    kinds: Sequence[str],
    *,
    wrong: Sequence[bool],
    order: Sequence[str],
    ax: Axes | None = None,
) -> Axes:
    """Draw a search step by step: the query at the left, and each match right of the one that found it.

    Parameters
    ----------
    matches : as from `search`.
    kinds : what each match is; each kind has its own colour.
    wrong : which matches are not what was asked for; they get a cross.
    order : all kinds that may come, so that each keeps its colour from picture to picture.
    ax : axes; new ones by default.

    Examples
    --------
    >>> at = np.arange(2.0)
    >>> found = [Match(0, 0, 9, 0.0, -1, 0, at, at), Match(1, 3, 12, 0.02, 0, 1, at, at)]
    >>> kinds = ["slow", "brisk"]
    >>> match_tree(found, kinds, wrong=[False, True], order=kinds).collections[0].get_segments()[0].tolist()
    [[0.0, 0.0], [1.0, 0.0]]

    Notebook: 16-match-webs
    """
    ax = ax or plt.figure(figsize=(7, 4), layout="constrained").add_subplot()
    places, colours = np.zeros((len(matches), 2)), source_colours([*order, *kinds])
    for step in range(1, 1 + max(match.generation for match in matches)):  # as their finders stand
        inside = [n for n, match in enumerate(matches) if match.generation == step]
        inside.sort(key=lambda n: (places[matches[n].via, 1], n))
        places[inside] = [(step, n - (len(inside) - 1) / 2) for n in range(len(inside))]
    links = [(places[match.via], places[n]) for n, match in enumerate(matches) if match.via >= 0]
    ax.add_collection(LineCollection(links, colors=QUIET, linewidths=0.8, zorder=0))
    ax.scatter(places[:, 0], places[:, 1], s=26, color=[colours[kind] for kind in kinds])
    bad = places[np.asarray(wrong, bool)]
    ax.scatter(bad[:, 0], bad[:, 1], s=60, color=ASTRAY, marker="x", label="wrong" if len(bad) else None)
    for kind, colour in colours.items():
        ax.plot([], [], "o", color=colour, label=kind)
    ax.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
    last = int(places[:, 0].max())
    ax.set(xlabel="step", yticks=[], xlim=(-0.3, max(last, 1) + 0.3), xticks=range(last + 1))
    ax.spines[["left", "top", "right"]].set_visible(False)
    return ax
