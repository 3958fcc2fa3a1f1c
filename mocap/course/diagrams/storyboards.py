"""A transition in panels: where it is, its two windows, aligned, and the seam."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body import Motion, PlanarTransform, find_legs, heading, joint_positions
from mocap.errors import MocapError
from mocap.matching.point_clouds import distinct_joints, rms_distance
from mocap.plotting.bodies import draw_body
from mocap.plotting.style import COLOURS, MARK, PATH, QUIET

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
    where, windows, *last = figure.subplots(1, count)
    draw_where(where)
    where.set_title("1  which two windows", loc="left", fontsize=11)
    draw_matched(windows, *pair)
    apart = f"2  aligned, RMS distance {100 * rms_distance(*pair):.1f} cm"
    windows.set_title(apart, loc="left", fontsize=11)
    for ax in last:
        _draw_seam(ax, pair[0], *seam)
        ax.set_title("3  the seam; its window is shaded", loc="left", fontsize=11)
    return figure


def draw_matched(ax: Axes, *pair: Motion) -> None:
    """Draw the first, middle and last frames of two windows from the side, with threads between them."""
    last, joints = len(pair[0]) - 1, distinct_joints(pair[0].skeleton)
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
    """Give the turn after which a window's middle heads along z, from the left to the right of a panel."""
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
