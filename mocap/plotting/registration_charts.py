"""Charts of registered clips: the grid with the path of time, plants as bars, tracks over the ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import ArrayLike, NDArray

from mocap.blending.registering import Warp
from mocap.blending.timewarps import Curve
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.plotting.charts import path_from_above
from mocap.plotting.style import COLOURS, SOURCES

OUTLINED = [Stroke(linewidth=4, foreground="#000000"), Normal()]
HEIGHT = 0.36  # of a bar; a clip's row has one for the left foot above one for the right


class WarpPicture(NamedTuple):
    """The grid, the cells of the path, and the curve through them."""

    grid: AxesImage
    cells: Line2D
    curve: Line2D


def warp_image(
    grid: NDArray[np.floating[Any]],
    path: ArrayLike,
    *,
    warp: Warp | None = None,
    curve: Curve | None = None,
    ax: Axes | None = None,
) -> WarpPicture:
    """Draw the distances of two clips, dark where they are alike, with the path of time through them.

    Parameters
    ----------
    grid : √D, shape (n, m), metres; rows are the windows of the reference.
    path : its cells (row, column), shape (N, 2).
    warp : of the grid, `Warp()` by default; the axes show the seconds in the middle of each window.
    curve : from the reference's seconds to the other clip's.
    ax : axes; new ones by default.

    Returns
    -------
    The grid, the cells, and the curve; the last two are empty where none were given.

    Examples
    --------
    >>> grid, warp = np.array([[0.02, 0.1], [0.1, 0.03]]), Warp(rate=10, window=1)
    >>> drawn = warp_image(grid, [(0, 0), (1, 1)], warp=warp)
    >>> drawn.cells.get_xydata().tolist()
    [[0.0, 0.0], [0.1, 0.1]]

    Notebook: 15-registration
    """
    ax = ax or plt.figure(figsize=(4.8, 4.4), layout="constrained").add_subplot()
    fps, window, *_ = warp or Warp()
    half = (window - 1) / 2
    (rows, columns), edge = np.shape(grid), half - 0.5
    extent = edge / fps, (edge + columns) / fps, (edge + rows) / fps, edge / fps
    image = ax.imshow(100 * np.asarray(grid), cmap="cividis", extent=extent, interpolation="nearest")
    ax.figure.colorbar(image, ax=ax, label="RMS distance (cm)", shrink=0.8)
    u, own = (np.reshape(path, (-1, 2)).T + half) / fps
    (cells,) = ax.plot(own, u, ".", color="#FFFFFF", markersize=2.5)
    times = np.linspace(u[0], u[-1], 200) if curve is not None and len(u) else np.empty(0)
    (line,) = ax.plot(curve(times) if curve is not None else times, times, color="#FFFFFF", linewidth=2)
    line.set_path_effects(OUTLINED)
    ax.set(xlabel="other clip (s)", ylabel="reference (s)", aspect="equal")
    return WarpPicture(image, cells, line)


def plant_bars(
    plants: Mapping[str, Mapping[str, ArrayLike]], *, ax: Axes | None = None
) -> dict[str, PolyCollection]:
    """Draw when feet stand: a row for each clip, a bar for each plant, left above right in their colours.

    Parameters
    ----------
    plants : for each clip's name the plants of its sides, as {"left": (N, 2), "right": (N, 2)} seconds.
    ax : axes; new ones by default.

    Returns
    -------
    The bars of each clip.

    Examples
    --------
    >>> bars = plant_bars({"slow": {"left": [(0.0, 0.7)], "right": [(0.6, 1.3), (1.9, 2.6)]}})
    >>> len(bars["slow"].get_paths())
    3

    Notebook: 15-registration
    """
    ax = ax or plt.figure(figsize=(7, 0.9 + 0.55 * len(plants)), layout="constrained").add_subplot()
    drawn = {}
    for row, (name, sides) in enumerate(plants.items()):
        corners, colours = [], []
        for side, low in (("left", row - HEIGHT), ("right", row)):
            for start, stop in np.reshape(sides[side], (-1, 2)):
                high = low + HEIGHT
                corners.append([(start, low), (stop, low), (stop, high), (start, high)])
                colours.append(COLOURS[side])
        drawn[name] = PolyCollection(corners, facecolors=colours, edgecolors="#FFFFFF", linewidths=0.6)
        ax.add_collection(drawn[name])
    ax.set_yticks(range(len(plants)), list(plants))
    ax.set(xlabel="common clock (s)", ylim=(len(plants) - 0.5, -0.5))
    ax.autoscale_view(scaley=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(axis="y", length=0)
    return drawn


def ground_tracks(
    motions: Sequence[Motion],
    *,
    colours: Sequence[str] = SOURCES,
    every: float = 0.5,
    ax: Axes | None = None,
) -> list[Line2D]:
    """Draw the ways of several motions from above, with a stroke now and then for where the body faces.

    Parameters
    ----------
    motions : as they stand; `body.place` lets them start at one place.
    colours : one for each motion.
    every : seconds from stroke to stroke.
    ax : axes; new ones by default.

    Returns
    -------
    The way of each motion.

    Examples
    --------
    >>> from mocap import datasets
    >>> lines = ground_tracks([datasets.sample("walk_straight")])
    >>> lines[0].get_label()
    'walk_straight'

    Notebook: 15-registration
    """
    ax = ax or plt.figure(figsize=(4.5, 4.5), layout="constrained").add_subplot()
    ways = []
    for motion, colour in zip(motions, colours, strict=False):
        line, *_ = path_from_above(motion, colour=colour, ax=ax)
        step = max(round(every * motion.fps), 1)
        places = motion.root_positions[::step][:, [0, 2]]
        facing = heading(motion.rotations[::step, 0])
        ends = places + 0.25 * np.stack([np.sin(facing), np.cos(facing)], axis=-1)
        ax.add_collection(LineCollection(list(np.stack([places, ends], axis=1)), colors=colour, linewidths=1))
        ways.append(line)
    return ways
