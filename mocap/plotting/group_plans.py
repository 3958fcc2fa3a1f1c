"""The plan of a group from above: each member's way, the points to pass, and what stands in the way."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from mocap._shared.arrays import Points
from mocap.plotting.style import ASKED, FLOOR, QUIET, SOURCES


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
    ax = ax or Figure(figsize=(7, 7), layout="constrained").add_subplot()
    for number, way in enumerate(np.asarray(places).T):
        colour = SOURCES[number % len(SOURCES)]
        ax.plot(way.imag, way.real, color=colour, linewidth=1.2)
    for frame in np.linspace(0, len(places) - 1, 6).round().astype(int):
        inside = "black" if frame else "white"
        ax.scatter(places[frame].imag, places[frame].real, s=14, color=inside, edgecolors="black", zorder=3)
    for centre, radius in discs:
        ax.add_patch(Circle((centre.imag, centre.real), radius, color=QUIET, zorder=2))
    for number, point in enumerate(points, 1):
        ax.add_patch(Circle((point.imag, point.real), near, fill=False, color=ASKED, linestyle=":", zorder=2))
        ax.annotate(str(number), (point.imag, point.real), ha="center", va="center", color=ASKED)
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.invert_xaxis()
    ax.grid(color=FLOOR)
    figure = ax.figure
    assert isinstance(figure, Figure)
    return figure
