"""What a window is, a lower bound of the distance of two, and sums along diagonals."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import Motion, heading, joint_positions
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud
from mocap.plotting.stick_figures import StickFigure, ground_axes, keep_inside, to_picture
from mocap.plotting.style import COLOURS, FLOOR, QUIET, SOURCES


def window_cloud(motion: Motion, *, step: int = 4) -> Figure:
    """Draw how a window of frames becomes one cloud of points [KGP02, 3.1].

    Parameters
    ----------
    motion : the frames of the window.
    step : 1 the middle frame; 2 all frames; 3 with a point on each joint; 4 the points alone.

    Examples
    --------
    >>> from mocap import datasets, resample
    >>> walk = resample(datasets.sample("walk_straight"), 30)
    >>> window_cloud(walk[:10], step=4).axes[0].get_title()
    '10 frames × 31 joints = 310 points'

    Notebook: 02-matching
    """
    points, cloud = joint_positions(motion), point_cloud(motion)
    flat, middle = cloud.reshape(-1, 3), len(motion) // 2
    figure = Figure(figsize=(5.2, 4.8))
    low, high = points.min(axis=(0, 1))[[0, 2]], points.max(axis=(0, 1))[[0, 2]]
    reach = max(1.2, *(high - low)) / 2 + 0.2
    ax = ground_axes((low + high) / 2, reach, ax=figure.add_axes((0, 0, 1, 0.92), projection="3d"))
    ax.view_init(elev=12, azim=float(np.degrees(heading(motion.rotations[middle, 0]))) - 65)  # from the right
    keep_inside(ax, np.concatenate([points, points * [1, 0, 1]]))  # with the shadow
    for frame in ([middle], range(len(motion)), range(len(motion)), [])[step - 1]:
        StickFigure(motion.skeleton, ax, 1.0 if frame == middle else 0.25).pose(points[frame])
    if step >= 3:
        ax.plot(*to_picture(flat).T, ".", color=SOURCES[0], markersize=4, zorder=4)
    if step == 4:
        ax.plot(*to_picture(flat * [1, 0, 1]).T, ".", color=QUIET, markersize=1.5, zorder=1)
    sums = f"{cloud.shape[0]} frames × {cloud.shape[1]} joints = {len(flat)} points"
    titles = "one frame", f"a window: {len(motion)} frames", "its joints: a point on each"
    ax.set_title((*titles, sums)[step - 1])
    return figure


CIRCLE_STEPS = ("each from its own middle", "where a turn can move each point", "what no turn can remove")


def radius_gaps(first: Motion, second: Motion, joints: Sequence[str], *, step: int = 3) -> Figure:
    """Draw from above why two windows cannot come nearer than their points' distances from the middle.

    Parameters
    ----------
    first, second : windows of as many frames; their middle frames are drawn.
    joints : the names of the joints to draw.
    step : 1 the points, each from the middle of its window; 2 the circles on which a turn of the second
        moves its points, and those of the first; 3 the gap between the two circles of each joint.

    Examples
    --------
    >>> from mocap import datasets, resample
    >>> walk = resample(datasets.sample("walk_straight"), 30)
    >>> radius_gaps(walk[:10], walk[:10], ["head"], step=3).axes[0].get_title().splitlines()
    ['what no turn can remove:', 'head 0 cm']

    Notebook: 02c-most-pairs
    """
    figure = Figure(figsize=(5.6, 5.6), layout="constrained")
    ax, last, places = figure.add_subplot(), step == len(CIRCLE_STEPS), []
    for motion, colour in zip((first, second), SOURCES, strict=False):
        middle = point_cloud(motion).mean((0, 1))  # of all points of the window
        frame = joint_positions(motion)[len(motion) // 2]
        places.append((frame[[motion.skeleton.index(name) for name in joints]] - middle)[:, [2, 0]])
        ax.plot(*places[-1].T, "o", color=colour, label=motion.name)
        for radius in np.linalg.norm(places[-1], axis=-1) if step > 1 else ():
            ax.add_patch(Circle((0, 0), radius, fill=False, color=colour, linewidth=0.8))
    radii = np.linalg.norm(places, axis=-1).T  # (P, 2)
    for name, point, ends in zip(joints, places[0], np.sort(radii, axis=1), strict=True):
        ax.annotate(name, point, (4, 4), textcoords="offset points")
        if last:
            ray = point / max(np.linalg.norm(point), 1e-9)
            ax.plot(*np.outer(ray, ends), color=COLOURS["middle"], linewidth=4)
    gaps = 100 * np.abs(np.diff(radii, axis=1)[:, 0])
    told = ", ".join(f"{name} {gap:.0f} cm" for name, gap in zip(joints, gaps, strict=True))
    ax.set_title(CIRCLE_STEPS[step - 1] + f":\n{told}" * last)
    ax.plot(0, 0, "+", color=QUIET)
    limit = 1.15 * radii.max() + 0.01
    ax.set(aspect="equal", xlabel="z (m)", ylabel="x (m)", xlim=(-limit, limit), ylim=(-limit, limit))
    ax.locator_params(nbins=5)
    figure.legend(loc="outside lower center", ncols=2, frameon=False)
    return figure


def diagonal_sums(products: ArrayLike, window: int, *, step: int) -> Figure:
    """Draw how sums over windows are made by adding up shifted copies of an array of frame pairs.

    Parameters
    ----------
    products : shape (n, m): a number for each frame of one clip and each frame of another.
    window : frames in a window.
    step : how many of the window's frames are added up, 1 to `window`.

    Examples
    --------
    >>> figure = diagonal_sums([[1, 2, 0], [0, 3, 4], [0, 0, 5]], window=2, step=2)
    >>> [text.get_text() for text in figure.axes[1].texts]
    ['4', '6', '0', '8']

    Notebook: 02b-distance-grids
    """
    numbers = np.asarray(products)
    rows, columns = (count - window + 1 for count in numbers.shape)
    if min(rows, columns) < 1 or window < 1:
        raise MocapError(f"Windows of {window} frames do not fit into an array of shape {numbers.shape}.")
    sums = np.sum([numbers[f : f + rows, f : f + columns] for f in range(step)], axis=0)
    figure = Figure(figsize=(8.4, 4.2), layout="constrained")
    frames, windows = figure.subplots(1, 2, width_ratios=(numbers.shape[1], columns))
    _table(frames, numbers, step, (rows, columns))
    frames.set(xlabel="frame j", ylabel="frame i")
    frames.set_title(f"products of frames; the copy shifted by {step - 1}")
    _table(windows, sums, 1, (rows, columns))
    windows.set(xlabel="window j", ylabel="window i", title=f"{step} of {window} copies added up")
    return figure


def _table(ax: Axes, numbers: Array, step: int, part: tuple[int, int]) -> None:
    """Write numbers into cells, the first of the diagonal coloured; frame a part from the last of these."""
    for (row, column), number in np.ndenumerate(numbers):
        ground = SOURCES[4] if row == column < step else "#FFFFFF"
        ax.add_patch(Rectangle((column - 0.5, row - 0.5), 1, 1, facecolor=ground, edgecolor=FLOOR))
        ax.text(column, row, f"{number:g}", ha="center", va="center")
    look: dict[str, Any] = {"fill": False, "edgecolor": SOURCES[0], "linewidth": 2.5, "zorder": 3}
    ax.add_patch(Rectangle((step - 1.5, step - 1.5), part[1], part[0], **look))
    ax.set(xlim=(-0.6, numbers.shape[1] - 0.4), ylim=(numbers.shape[0] - 0.4, -0.6), aspect="equal")
    ax.set(xticks=range(numbers.shape[1]), yticks=range(numbers.shape[0]))
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
