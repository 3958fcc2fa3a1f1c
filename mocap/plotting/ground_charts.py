"""What lies on the ground, seen from above: paths, ways and plans."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from mocap._shared.arrays import Points
from mocap.body import Motion
from mocap.plotting.picture import figure_of
from mocap.plotting.style import ASKED, COLOURS, FLOOR, PATH, QUIET, SOURCES


def seen_from_above(ax: Axes | None = None) -> Axes:
    """Make axes for the ground seen from above: y points at the viewer, so with z upwards x goes left."""
    ax = ax or plt.figure(figsize=(4.5, 4.5), layout="constrained").add_subplot()
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.xaxis.set_inverted(True)
    return ax


def path_from_above(motion: Motion, *, colour: str = PATH, ax: Axes | None = None) -> list[Line2D]:
    """Draw the root's path on the ground, seen from above: z upwards, x to the left, as seen from behind.

    Parameters
    ----------
    motion : the motion.
    colour : of the path.
    ax : axes; new ones by default.

    Returns
    -------
    The path, and the start.

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
    way = ax.plot(x, z, color=colour, linewidth=2, label=motion.name)
    return way + ax.plot(x[:1], z[:1], "o", color=COLOURS["middle"], markersize=6)


def draw_group_plan(
    places: Points,
    points: Sequence[complex] = (),
    discs: Sequence[tuple[complex, float]] = (),
    *,
    near: float = 1.0,
    ax: Axes | None = None,
) -> Figure:
    """Draw where the members of a group go, seen from above; x to the left as for somebody who looks along z.

    White dots are where they start, black ones where they are at five moments, evenly spread until the end.

    Parameters
    ----------
    places : shape (F, N), complex z + ix, metres.
    points : to pass in order; each is numbered, and its circle of `near` metres drawn.
    discs : obstacles, centre and radius.
    near : metres.
    ax : axes to draw on; by default those of a new figure that pyplot does not know.

    Examples
    --------
    >>> steps = np.linspace(0, 5, 40)[:, None]
    >>> figure = draw_group_plan(steps + [0j, 1j], [5 + 0j], [(3 + 2j, 0.5)])
    >>> len(figure.axes[0].lines), len(figure.axes[0].patches)
    (2, 2)

    Notebook: 19-group-graphs
    """
    ax = seen_from_above(ax or Figure(figsize=(7, 7), layout="constrained").add_subplot())
    for number, way in enumerate(np.asarray(places).T):
        ax.plot(way.imag, way.real, color=SOURCES[number % len(SOURCES)], linewidth=1.2)
    for frame in np.linspace(0, len(places) - 1, 6).round().astype(int):
        inside = "black" if frame else "white"
        ax.scatter(places[frame].imag, places[frame].real, s=14, color=inside, edgecolors="black", zorder=3)
    for centre, radius in discs:
        ax.add_patch(Circle((centre.imag, centre.real), radius, color=QUIET, zorder=2))
    for number, point in enumerate(points, 1):
        ax.add_patch(Circle((point.imag, point.real), near, fill=False, color=ASKED, linestyle=":", zorder=2))
        ax.annotate(str(number), (point.imag, point.real), ha="center", va="center", color=ASKED)
    ax.grid(color=FLOOR)
    return figure_of(ax)
