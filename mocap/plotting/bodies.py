"""Bodies as lines: their bones, and poses drawn on flat axes."""

from collections.abc import Sequence
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices
from mocap.body import Motion, Skeleton, joint_positions
from mocap.matching.point_clouds import distinct_joints
from mocap.plotting.style import COLOURS, own_colour

ASLANT = np.array(
    [[0.57, 0, 0.82], [-0.2, 0.97, 0.14]]
)  # across and up, seen from the right, front and above


def bones(skeleton: Skeleton) -> tuple[Indices, Indices, NDArray[np.str_]]:
    """List the B lines of a body: the joints where they start and end, and their sides, shapes (B,).

    Joints that share a place share one line. The line from a parent to its child is the parent's bone, and so
    it is on the parent's side.

    Examples
    --------
    >>> names = ["hips", "lknee", "rknee", "lfoot"]
    >>> body = Skeleton(names, [-1, 0, 0, 1], [[0, 1, 0], [0.1, -0.4, 0], [-0.1, -0.4, 0], [0, -0.4, 0]])
    >>> [f"{names[start]} to {names[end]}: {side}" for start, end, side in zip(*bones(body))]
    ['hips to lknee: middle', 'hips to rknee: middle', 'lknee to lfoot: left']

    Notebook: 11-warping
    """
    ends = np.array(distinct_joints(skeleton)[1:], np.intp)
    starts = skeleton.parents[ends]
    return starts, ends, np.array([skeleton.side(int(parent)) for parent in starts], str)


def head_joints(skeleton: Skeleton) -> list[int]:
    """Find the joints that are called a head; the last is its tip."""
    return [joint for joint, name in enumerate(skeleton.names) if "head" in name.lower()]


def draw_body(
    ax: Axes,
    skeleton: Skeleton,
    points: Array,
    *,
    colour: str | None = None,
    head: dict[str, Any] | None = None,
    **look: Any,  # noqa: ANN401 (of matplotlib's lines)
) -> LineCollection:
    """Draw a pose on flat axes.

    Parameters
    ----------
    ax : flat axes.
    skeleton : the body.
    points : shape (J, 2), where its joints are on the axes.
    colour : one for all bones; by default left, right and middle have their own.
    head : how to draw the dot for the head, such as {"markersize": 8}; without it there is none.
    look : of the bones, such as `linewidths` and `alpha`.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> body = Skeleton(["hips", "lknee"], [-1, 0], [[0, 1, 0], [0.1, -0.4, 0]])
    >>> draw_body(Figure().add_subplot(), body, np.array([[0, 1], [0.1, 0.6]])).get_segments()[0].tolist()
    [[0.0, 1.0], [0.1, 0.6]]
    """
    starts, ends, sides = bones(skeleton)
    lines = list(np.stack([points[starts], points[ends]], axis=1))
    body = LineCollection(lines, colors=[colour or COLOURS[side] for side in sides], **look)
    ax.add_collection(body)
    if head is not None:
        ax.plot(*points[head_joints(skeleton)[-1:]].T, "o", **({"color": colour or COLOURS["middle"]} | head))
    return body


def flat_bodies(
    motion: Motion,
    frames: Sequence[int],
    view: Literal["side", "front"] = "side",
    alpha: float = 1.0,
    ax: Axes | None = None,
) -> Axes:
    """Draw poses of a motion flat, where they are: z or x to the right, y upwards, metres.

    Parameters
    ----------
    motion : a walk along z.
    frames : which frames.
    view : from the side, z to the right; or from the front, x to the right. There the walker comes to the
        reader, so the left side of the body, which is at +x, is on the right.
    alpha : 1 for solid bodies, less for ghosts.
    ax : flat axes; by default new ones.

    Examples
    --------
    >>> from mocap import datasets
    >>> from matplotlib.figure import Figure
    >>> ax = flat_bodies(datasets.sample("walk_straight"), [0, 60, 120], ax=Figure().add_subplot())
    >>> len(ax.collections)
    3

    Notebook: 14-levels
    """
    across = 2 if view == "side" else 0
    ax = ax or plt.subplots(figsize=(8, 2.6), layout="constrained")[1]
    for points in joint_positions(motion)[list(frames)]:
        draw_body(ax, motion.skeleton, points[:, [across, 1]], linewidths=1.8, alpha=alpha)
    ax.autoscale_view()
    ax.set(aspect="equal", xlabel=f"{'xyz'[across]} (m)", ylabel="y (m)")
    return ax


def film_strip(motions: Sequence[Motion], *, count: int = 6) -> Figure:
    """Draw poses side by side, evenly spread over the first motion's time; the others at the same times.

    Parameters
    ----------
    motions : one or more; the picture goes with the first.
    count : poses; fewer where the first motion has fewer frames.

    Returns
    -------
    A figure that pyplot does not know, so nobody has to close it.

    Examples
    --------
    >>> from mocap import datasets
    >>> strip = film_strip([datasets.sample("walk_straight")], count=3)
    >>> [ax.get_title() for ax in strip.axes]
    ['0.00 s', '5.00 s', '10.00 s']
    """
    first, clouds = motions[0], [joint_positions(motion) for motion in motions]
    frames = np.unique(np.linspace(0, len(first) - 1, count).round().astype(int))
    figure = Figure(figsize=(1.5 * len(frames), 1.75))
    panels = figure.subplots(1, len(frames), sharex=True, sharey=True, squeeze=False)[0]
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.86, 0.0)
    for ax, frame in zip(panels, frames, strict=True):
        for number, (motion, points) in enumerate(zip(motions, clouds, strict=True)):
            pose = points[min(len(points) - 1, round(frame / first.fps * motion.fps))]
            flat = (pose - clouds[0][frame, 0] * [1, 0, 1]) @ ASLANT.T
            look: dict[str, Any] = {"head": {"markersize": 5}, "linewidths": 1.6}
            draw_body(ax, motion.skeleton, flat, colour=own_colour(number, len(motions)), **look)
        ax.set_title(f"{frame / first.fps:.2f} s", fontsize=9)
        ax.set_aspect("equal")
        ax.set_axis_off()
        ax.autoscale_view()
    return figure
