"""What a window is, a lower bound of the distance of two, diagonal sums, and a transition in panels."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import Motion, PlanarTransform, find_legs, heading, joint_positions
from mocap.errors import MocapError
from mocap.matching.point_clouds import distinct_joints, point_cloud, rms_distance
from mocap.plotting.bodies import draw_body
from mocap.plotting.stick_figures import StickFigure, ground_axes, keep_inside, to_picture
from mocap.plotting.style import COLOURS, FLOOR, MARK, PATH, QUIET, SOURCES


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
    points = joint_positions(motion)
    cloud = point_cloud(motion)
    flat = cloud.reshape(-1, 3)
    middle = len(motion) // 2
    figure = Figure(figsize=(5.2, 4.8))
    low = points.min(axis=(0, 1))[[0, 2]]
    high = points.max(axis=(0, 1))[[0, 2]]
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


ADDED = 4  # which of the sources' colours the numbers have that are added up
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
    ax = figure.add_subplot()
    shows_gaps = step == len(CIRCLE_STEPS)
    places = []
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
        if shows_gaps:
            ray = point / max(np.linalg.norm(point), 1e-9)
            ax.plot(*np.outer(ray, ends), color=COLOURS["middle"], linewidth=4)
    gaps = 100 * np.abs(np.diff(radii, axis=1)[:, 0])
    listed = ", ".join(f"{name} {gap:.0f} cm" for name, gap in zip(joints, gaps, strict=True))
    ax.set_title(f"{CIRCLE_STEPS[step - 1]}:\n{listed}" if shows_gaps else CIRCLE_STEPS[step - 1])
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
    copies = [numbers[f : f + rows, f : f + columns] for f in range(step)]
    sums = np.sum(copies, axis=0)
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
        ground = SOURCES[ADDED] if row == column < step else "#FFFFFF"
        ax.add_patch(Rectangle((column - 0.5, row - 0.5), 1, 1, facecolor=ground, edgecolor=FLOOR))
        ax.text(column, row, f"{number:g}", ha="center", va="center")
    look: dict[str, Any] = {"fill": False, "edgecolor": SOURCES[0], "linewidth": 2.5, "zorder": 3}
    ax.add_patch(Rectangle((step - 1.5, step - 1.5), part[1], part[0], **look))
    ax.set(xlim=(-0.6, numbers.shape[1] - 0.4), ylim=(numbers.shape[0] - 0.4, -0.6), aspect="equal")
    ax.set(xticks=range(numbers.shape[1]), yticks=range(numbers.shape[0]))
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)


INK = COLOURS["middle"]
Pair = tuple[Motion, Motion]
LINES: tuple[Any, ...] = ("-", (0, (3, 2)))  # of the first body, and of the second


def storyboard(
    draw_where: Callable[[Axes], object], pair: Pair, seam: tuple[Motion, int], show: Sequence[str]
) -> Figure:
    """Draw a transition in panels with labels, as far as a course has come.

    Parameters
    ----------
    draw_where : draws on given axes where the windows are, such as a distance grid.
    pair : the two windows, the second laid on the first.
    seam : their blend with some clip around it, and in which of its frames the window begins.
    show : what has been explained; with "weights", the seam is drawn as well.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:240]
    >>> figure = storyboard(lambda ax: None, (walk[:40], walk[:40]), (walk, 20), ["windows"])
    >>> [ax.get_title(loc="left") for ax in figure.axes]
    ['1  which two windows', '2  aligned, RMS distance 0.0 cm']
    """
    count = 3 if "weights" in show else 2
    figure = Figure(figsize=(4.6 * count, 3.3), layout="constrained")
    overview, windows, *last = figure.subplots(1, count)
    draw_where(overview)
    overview.set_title("1  which two windows", loc="left", fontsize=11)
    draw_matched(windows, *pair)
    distance = f"2  aligned, RMS distance {100 * rms_distance(*pair):.1f} cm"
    windows.set_title(distance, loc="left", fontsize=11)
    for ax in last:
        _draw_seam(ax, pair[0], *seam)
        ax.set_title("3  the seam; its window is shaded", loc="left", fontsize=11)
    return figure


def draw_matched(ax: Axes, *pair: Motion) -> None:
    """Draw the first, middle and last frames of two windows from the side, with threads between them."""
    last = len(pair[0]) - 1
    joints = distinct_joints(pair[0].skeleton)
    points = [joint_positions(_facing(pair[0]).apply_motion(motion))[..., [2, 1]] for motion in pair]
    for place, (frame, words) in enumerate([(0, "first frame"), (last // 2, "middle"), (last, "last frame")]):
        poses = [cloud[frame] + [1.1 * place - points[0][frame, 0, 0], 0.0] for cloud in points]
        for number, pose in enumerate(poses):
            _draw_pose(ax, pose, pair[number], dashed=number == 1)
        threads = np.stack([pose[joints] for pose in poses], axis=1)
        ax.add_collection(LineCollection(list(threads), colors="#000000", linewidths=1.2, zorder=3))
        ax.annotate(words, (1.1 * place, -0.12), ha="center", va="top", fontsize=9)
    ax.axhline(0, color=QUIET, linewidth=0.8, zorder=0)
    ax.plot([-0.7, 2.9], [-0.3, -0.3], alpha=0)  # room for the words
    for motion, style in zip(pair, LINES, strict=True):
        ax.plot([], [], color=INK, linestyle=style, label=motion.name)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, 0.04), ncols=2, frameon=False, fontsize=9)
    _bare(ax)


def _draw_seam(ax: Axes, window: Motion, seam: Motion, begin: int) -> None:
    """Draw the blend by the paper's weights from the side, with the tracks of the balls of the feet."""
    end = begin + len(window) - 1
    points = joint_positions(_facing(window).apply_motion(seam))[..., [2, 1]]
    for frame in dict.fromkeys([0, begin // 2, begin, end, (end + len(seam)) // 2, len(seam) - 1]):
        _draw_pose(ax, points[frame], seam, alpha=1.0 if begin <= frame <= end else 0.4)
    ax.plot(points[:, 0, 0], 0 * points[:, 0, 0], color=PATH, linewidth=2)
    with suppress(MocapError):  # a body without legs
        for leg in find_legs(seam.skeleton):
            ax.plot(*points[:, leg.ball].T, color=COLOURS[seam.skeleton.side(leg.ball)], linewidth=1)
    ax.axvspan(*points[[begin, end], 0, 0], color=MARK, alpha=0.3, zorder=0)
    _bare(ax)


def _facing(window: Motion) -> PlanarTransform:
    """Return the turn after which a window's middle heads along z, from the left to the right of a panel."""
    return PlanarTransform(-float(heading(window.rotations[len(window) // 2, 0])), 0.0, 0.0)


def _draw_pose(ax: Axes, points: Array, motion: Motion, alpha: float = 1.0, dashed: bool = False) -> None:
    """Draw a pose, shape (J, 2), in the colours of left and right; of a dashed body the head is a ring."""
    head = {"color": "none" if dashed else INK, "markeredgecolor": INK, "markersize": 8, "alpha": alpha}
    look: dict[str, Any] = {"linestyles": [LINES[dashed]], "linewidths": 1.8 if dashed else 2.4}
    draw_body(ax, motion.skeleton, points, head=head, alpha=alpha, **look)


def _bare(ax: Axes) -> None:
    """Show as much as is drawn, at the same scale on both axes, and no ticks."""
    ax.autoscale_view()
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xticks=[], yticks=[])
    ax.spines[:].set_visible(False)
