"""Two distances from a path: to its nearest point, and to its point at equal arc length."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.plotting.style import ASKED, CURVES, PATH, QUIET

MOMENTS = 9
BEND = 0.8
LENGTH, NEAREST = CURVES[:2]


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

    Notebook: 08-path-synthesis
    """
    figure = plt.figure(figsize=(8, 3.8), layout="constrained")
    ground, curves = figure.subplots(1, 2, width_ratios=(1, 1.3))
    until = walk.length * step / (MOMENTS - 1)
    ground.plot(*path.points.T, color=ASKED, linewidth=7, label="path asked for")
    ground.plot(*walk.points.T, color=PATH, linewidth=3.5, label="walk")
    moments = np.linspace(0, walk.length, MOMENTS)[: step + 1]
    here, even, near = walk.at(moments), path.at(moments), nearest_points(path, walk.at(moments))
    _threads(ground, here, near, colour=NEAREST)
    _threads(ground, here, even, colour=LENGTH)
    ground.plot(*here.T, "o", color=PATH, markersize=7, markeredgecolor=ASKED, zorder=5)
    ground.set(aspect="equal", xlabel="x (m)", ylabel="z (m)")
    ground.xaxis.set_inverted(True)
    ground.legend(frameon=False, fontsize=8)
    _curves(curves, path, walk, until)
    return figure


def _threads(ax: Axes, start: Array, end: Array, *, colour: str) -> None:
    """Draw a thread from each start to its end, bent so that it is seen beside the path, with a dot there."""
    share = np.linspace(0, 1, 15)[:, None, None]
    aside = (end - start)[:, ::-1] * [1, -1]  # at right angles to the thread
    threads = start + share * (end - start) + BEND * share * (1 - share) * aside
    ax.plot(*np.moveaxis(threads, 2, 0), color=colour, linewidth=1.8, zorder=4)
    ax.plot(*end.T, "o", color=colour, markersize=5, zorder=4)


def _curves(ax: Axes, path: GroundPath, walk: GroundPath, until: float) -> None:
    """Draw both distances over the metres walked so far."""
    along = np.linspace(0, walk.length, 200)
    here = walk.at(along)
    ends = {"at equal arc length (Eq. 9)": path.at(along), "to the nearest point": nearest_points(path, here)}
    highest = 100 * max(np.hypot(*(here - end).T).max() for end in ends.values())
    seen = along <= until + 1e-9
    for (name, end), colour in zip(ends.items(), (LENGTH, NEAREST), strict=True):
        ax.plot(along[seen], 100 * np.hypot(*(here - end).T)[seen], color=colour, linewidth=2, label=name)
    ax.axvline(until, color=QUIET, linewidth=1)
    ax.set(xlabel="metres walked", ylabel="distance (cm)", xlim=(0, walk.length))
    ax.set_ylim(-0.04 * highest - 0.1, 1.35 * highest + 0.1)
    ax.legend(frameon=False, fontsize=9, loc="upper left")


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
