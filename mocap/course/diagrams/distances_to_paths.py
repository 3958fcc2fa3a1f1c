"""Two distances from a path: to its nearest point, and to its point at equal arc length."""

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.plotting.style import ASKED, CURVES, PATH, QUIET

MOMENTS = 9
BEND = 0.8


def two_distances(path: GroundPath, walk: GroundPath) -> Callable[..., list[Any]]:
    """Give a function that draws a path and a walk from above, and both distances of the walk from the path.

    Nine moments are evenly spaced along the walk. At each a thread leads to the path's point at equal arc
    length, as in [KGP02, Eq. 9], and another to the path's nearest point. The curves beside them show both
    distances. `draw(step)` shows all up to a moment, from 0, the start, to 8, the end, and gives what moved.

    Parameters
    ----------
    path : the path asked for.
    walk : the line that was walked.

    Examples
    --------
    A walk parallel to a straight path: both distances are the same.

    >>> path, walk = (GroundPath([[x, 0], [x, 4]]) for x in (0.0, 0.3))
    >>> left, right = two_distances(path, walk)(4)[0].figure.axes
    >>> [line.get_ydata()[-1].round(3).item() for line in right.lines[:2]]
    [30.0, 30.0]

    Notebook: 08c-judging-a-search
    """
    ground, curves = _ground_and_curves(path, walk)
    moments = np.linspace(0, walk.length, MOMENTS)[:, None]
    along = np.maximum(0, moments - moments[1] * np.linspace(1, 0, 25))  # up to each moment, (9, 25)
    here, share, moving = walk.at(moments), np.array([*np.linspace(0, 1, 15), np.nan])[:, None], []
    for name, point, colour, above in (
        ("at equal arc length (Eq. 9)", path.at, CURVES[0], 4.1),
        ("to the nearest point", lambda s: nearest_points(path, walk.at(s)), CURVES[1], 4.0),
    ):
        thread = point(moments) - here  # bent, so that it is seen beside the path
        bent = here + share * thread + BEND * share * (1 - share) * thread[..., ::-1] * [1, -1]
        apart = 100 * np.linalg.norm(walk.at(along) - point(along), axis=-1)
        moving += [
            _line(ground, bent, color=colour, linewidth=1.8, zorder=above),
            _line(ground, here + thread, "o", color=colour, markersize=5, zorder=above),
            _line(curves, np.stack([along, apart], axis=-1), color=colour, linewidth=2, label=name),
        ]
    moving += [_line(ground, here, "o", color=PATH, markersize=7, markeredgecolor=ASKED, zorder=5)]
    now, highest = curves.axvline(color=QUIET, linewidth=1), curves.dataLim.y1
    curves.set_ylim(-0.04 * highest - 0.1, 1.35 * highest + 0.1)
    curves.legend(frameon=False, loc="upper left")

    def draw(step: int = MOMENTS - 1) -> list[Any]:
        for line, rows in moving:
            line.set_data(*rows[: step + 1].reshape(-1, 2).T)
        now.set_xdata([moments[step]] * 2)
        return [now, *(line for line, _ in moving)]

    return draw


def _ground_and_curves(path: GroundPath, walk: GroundPath) -> tuple[Axes, Axes]:
    ground, curves = Figure(figsize=(8, 3.8), layout="constrained").subplots(1, 2, width_ratios=(1, 1.3))
    ground.plot(*path.points.T, color=ASKED, linewidth=7, label="path asked for")
    ground.plot(*walk.points.T, color=PATH, linewidth=3.5, label="walk")
    ground.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    ground.xaxis.set_inverted(True)
    ground.legend(frameon=False)
    curves.set(xlabel="metres walked", ylabel="distance (cm)", xlim=(0, walk.length))
    return ground, curves


def _line(ax: Axes, rows: Array, *form: str, **look: Any) -> tuple[Any, Array]:  # noqa: ANN401
    """Draw a line of which rows, shape (9, points, 2), belong to each moment."""
    return ax.plot(*rows.reshape(-1, 2).T, *form, **look)[0], rows


def nearest_points(path: GroundPath, points: Array) -> Array:
    """Give the point of the path, to a centimetre along it, that is nearest to each of some points.

    Examples
    --------
    >>> nearest_points(GroundPath([[0, 0], [0, 4]]), np.array([[1.0, 2.0], [0.5, 9.0]])).tolist()
    [[0.0, 2.0], [0.0, 4.0]]
    """
    fine = path.at(np.linspace(0, path.length, 1 + round(100 * path.length)))
    apart = np.linalg.norm(points[..., None, :] - fine, axis=-1)
    return np.asarray(fine[apart.argmin(axis=-1)])
