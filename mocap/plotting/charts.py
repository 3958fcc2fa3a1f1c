"""Charts: curves over time, samples as bands, and paths on the ground, seen from above."""

from collections.abc import Sequence
from itertools import cycle, repeat

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from numpy.typing import ArrayLike

from mocap._shared.arrays import Points
from mocap.body import Motion
from mocap.plotting.picture import figure_of
from mocap.plotting.style import ASKED, COLOURS, CURVES, FLOOR, PATH, QUIET, SOURCES


def joint_curve(
    values: ArrayLike, *, fps: float, labels: Sequence[str] = (), ax: Axes | None = None
) -> list[Line2D]:
    """Draw a joint's values over time.

    Parameters
    ----------
    values : shape (F,) or (F, K), such as a joint's heights or its angles.
    fps : frames per second.
    labels : the names of the K curves, with their units.
    ax : axes, by default new ones.

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
    """Draw the median of samples as a line, and the interquartile range as a band.

    Parameters
    ----------
    x : shape (n,), the varied quantity.
    samples : shape (n, k), k measurements at each x.
    label : the entry in the legend.
    colour : the colour of the line and the band.
    ax : axes, by default new ones.

    Returns
    -------
    The line of the median.

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


def seen_from_above(ax: Axes | None = None) -> Axes:
    """Create axes of the ground seen from above, with z upwards, x to the left, and y towards the viewer."""
    ax = ax or plt.figure(figsize=(4.5, 4.5), layout="constrained").add_subplot()
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.xaxis.set_inverted(True)
    return ax


def path_from_above(motion: Motion, *, colour: str = PATH, ax: Axes | None = None) -> list[Line2D]:
    """Draw the root's path on the ground, seen from above: z upwards, x to the left.

    Parameters
    ----------
    motion : the motion.
    colour : the colour of the path.
    ax : axes, by default new ones.

    Returns
    -------
    The path and its start.

    Examples
    --------
    >>> from mocap import datasets, plotting
    >>> drawn = path_from_above(datasets.sample("walk_circle"))
    >>> plotting.show(drawn, alt="A circle seen from above.")
    Picture('A circle seen from above.')

    Notebook: 08c-judging-a-search
    """
    ax = seen_from_above(ax)
    x, z = motion.root_positions[:, [0, 2]].T
    path = ax.plot(x, z, color=colour, linewidth=2, label=motion.name)
    start = ax.plot(x[:1], z[:1], "o", color=COLOURS["middle"], markersize=6)
    return path + start


def draw_group_plan(
    positions: Points,
    points: Sequence[complex] = (),
    discs: Sequence[tuple[complex, float]] = (),
    *,
    radius: float = 1.0,
    ax: Axes | None = None,
) -> Figure:
    """Draw the paths of the members of a group, seen from above: z upwards, x to the left.

    White dots mark the positions at the start, and black dots those at five evenly spaced later moments.

    Parameters
    ----------
    positions : the positions of the members, shape (F, N), complex z + ix, metres.
    points : points to pass in order, drawn with their numbers and circles of `radius` metres.
    discs : obstacles, centre and radius.
    radius : the distance from a point within which it counts as passed, metres.
    ax : axes to draw on, by default those of a new figure that pyplot does not manage.

    Examples
    --------
    >>> steps = np.linspace(0, 5, 40)[:, None]
    >>> figure = draw_group_plan(steps + [0j, 1j], [5 + 0j], [(3 + 2j, 0.5)])
    >>> len(figure.axes[0].lines), len(figure.axes[0].patches)
    (2, 2)

    Notebook: 19-group-graphs
    """
    ax = seen_from_above(ax or Figure(figsize=(7, 7), layout="constrained").add_subplot())
    for number, path in enumerate(np.asarray(positions).T):
        ax.plot(path.imag, path.real, color=SOURCES[number % len(SOURCES)], linewidth=1.2)
    for frame in np.linspace(0, len(positions) - 1, 6).round().astype(int):
        inside = "black" if frame else "white"
        ax.scatter(
            positions[frame].imag, positions[frame].real, s=14, color=inside, edgecolors="black", zorder=3
        )
    for centre, disc_radius in discs:
        ax.add_patch(Circle((centre.imag, centre.real), disc_radius, color=QUIET, zorder=2))
    for number, point in enumerate(points, 1):
        ax.add_patch(
            Circle((point.imag, point.real), radius, fill=False, color=ASKED, linestyle=":", zorder=2)
        )
        ax.annotate(str(number), (point.imag, point.real), ha="center", va="center", color=ASKED)
    ax.grid(color=FLOOR)
    return figure_of(ax)
