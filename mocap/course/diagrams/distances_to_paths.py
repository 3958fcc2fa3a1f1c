"""Two distances from a path: to its nearest point, and to its point at equal arc length."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.plotting.style import ASKED, CURVES, PATH, QUIET

MOMENTS = 9
BEND = 0.8


def two_distances(path: GroundPath, walk: GroundPath, *, step: int = MOMENTS - 1) -> Figure:
    """Draw a path and a walk from above, and both distances of the walk from the path.

    Nine moments are evenly spaced along the walk. At each a thread leads to the path's point at equal arc
    length, as in [KGP02, Eq. 9], and another to the path's nearest point. The curves beside them show both
    distances up to the last moment drawn.

    Parameters
    ----------
    path : the path asked for.
    walk : the line that was walked.
    step : the last moment drawn, from 0, the start, to 8, the end.

    Examples
    --------
    A walk parallel to a straight path: both distances are the same.

    >>> path, walk = (GroundPath([[x, 0], [x, 4]]) for x in (0.0, 0.3))
    >>> left, right = two_distances(path, walk, step=4).axes
    >>> [line.get_ydata()[-1].round(3).item() for line in right.lines[:2]]
    [30.0, 30.0]

    Notebook: 08c-judging-a-search
    """
    figure = plt.figure(figsize=(8, 3.8), layout="constrained")
    ground, curves = figure.subplots(1, 2, width_ratios=(1, 1.3))
    ground.plot(*path.points.T, color=ASKED, linewidth=7, label="path asked for")
    ground.plot(*walk.points.T, color=PATH, linewidth=3.5, label="walk")
    moments, along = np.linspace(0, walk.length, MOMENTS)[: step + 1], np.linspace(0, walk.length, 200)
    here, fine = walk.at(moments), walk.at(along)
    share, highest = np.linspace(0, 1, 15)[:, None, None], 0.0
    for name, point, colour, above in (
        ("at equal arc length (Eq. 9)", path.at, CURVES[0], 4.1),
        ("to the nearest point", lambda s: nearest_points(path, walk.at(s)), CURVES[1], 4.0),
    ):
        thread = point(moments) - here  # bent, so that it is seen beside the path
        bent = here + share * thread + BEND * share * (1 - share) * thread[:, ::-1] * [1, -1]
        ground.plot(*np.moveaxis(bent, 2, 0), color=colour, linewidth=1.8, zorder=above)
        ground.plot(*(here + thread).T, "o", color=colour, markersize=5, zorder=above)
        apart = 100 * np.hypot(*(fine - point(along)).T)
        seen, highest = along <= moments[-1] + 1e-9, max(highest, apart.max())
        curves.plot(along[seen], apart[seen], color=colour, linewidth=2, label=name)
    ground.plot(*here.T, "o", color=PATH, markersize=7, markeredgecolor=ASKED, zorder=5)
    ground.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    ground.xaxis.set_inverted(True)
    ground.legend(frameon=False, fontsize=8)
    curves.axvline(moments[-1], color=QUIET, linewidth=1)
    curves.set(xlabel="metres walked", ylabel="distance (cm)", xlim=(0, walk.length))
    curves.set_ylim(-0.04 * highest - 0.1, 1.35 * highest + 0.1)
    curves.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def nearest_points(path: GroundPath, points: Array) -> Array:
    """Give the point of the path, to a centimetre along it, that is nearest to each of some points.

    Examples
    --------
    >>> nearest_points(GroundPath([[0, 0], [0, 4]]), np.array([[1.0, 2.0], [0.5, 9.0]])).tolist()
    [[0.0, 2.0], [0.0, 4.0]]
    """
    fine = path.at(np.linspace(0, path.length, 1 + round(100 * path.length)))
    apart = np.hypot(*(points[:, None] - fine).transpose(2, 0, 1))
    return np.asarray(fine[apart.argmin(axis=1)])
