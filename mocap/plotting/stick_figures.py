"""Bodies drawn as lines on 3D axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.matching.point_clouds import distinct_joints
from mocap.plotting.axes import TALL, ground_axes, keep_inside, to_picture
from mocap.plotting.style import COLOURS, PATH, SOURCES


class Bones(NamedTuple):
    """The lines of a body, each from the joint `starts` to the joint `ends`, on its `sides`, shapes (B,)."""

    starts: NDArray[np.intp]
    ends: NDArray[np.intp]
    sides: NDArray[np.str_]


def bones(skeleton: Skeleton) -> Bones:
    """List the lines of a body; one that several joints share is there once.

    The line from a parent to its child is the parent's bone, and so on the parent's side.
    """
    ends = np.array(distinct_joints(skeleton)[1:], np.intp)
    starts = skeleton.parents[ends]
    return Bones(starts, ends, np.array([skeleton.side(int(parent)) for parent in starts], str))


class StickFigure:
    """A body drawn as lines on 3D axes, left and right in colours of their own, the head as a dot.

    Parameters
    ----------
    skeleton : the body.
    ax : 3D axes, as from `axes`.
    alpha : 1 for a solid body, less for a ghost.
    colour : of all its bones, for telling two bodies apart; by default left, right and middle have their own.
    """

    def __init__(self, skeleton: Skeleton, ax: Axes3D, alpha: float = 1.0, colour: str | None = None) -> None:
        self.figure = ax.figure
        self.starts, self.ends, self.sides = bones(skeleton)
        self.head = [joint for joint, name in enumerate(skeleton.names) if "head" in name.lower()]
        self.bones = {
            side: Line3DCollection(
                np.zeros((1, 2, 3)), colors=colour or own, linewidths=2.4, alpha=alpha, zorder=3
            )
            for side, own in COLOURS.items()
        }
        for part in self.bones.values():
            ax.add_collection3d(part)
        (self.dot,) = ax.plot(
            [], [], [], "o", color=colour or COLOURS["middle"], markersize=11, alpha=alpha, zorder=3
        )

    def pose(self, points: Array) -> list[Artist]:
        """Move to the joint positions `points`, shape (J, 3), metres, and give the artists that moved."""
        segments = to_picture(np.stack([points[self.starts], points[self.ends]], axis=1))
        for side, part in self.bones.items():
            part.set_segments(segments[self.sides == side])
        if self.head:
            self.dot.set_data_3d(*to_picture(points[self.head].mean(axis=0))[:, None])
        return [*self.bones.values(), self.dot]


def stick_figure(
    motion: Motion, frames: Sequence[int] | int = 0, *, ax: Axes3D | None = None
) -> list[StickFigure]:
    """Draw poses of a motion: the last one solid, those before it as ghosts, and the root's path below.

    Parameters
    ----------
    motion : the motion.
    frames : which frames; one or several.
    ax : 3D axes; by default a new `axes` around these poses.

    Returns
    -------
    A figure a pose.

    Notebook: 01-skeletons-and-clips
    """
    shown = [frames] if isinstance(frames, int) else list(frames)
    points = joint_positions(motion)[shown]
    ax = ax or _stage_around(points)
    ax.plot(*to_picture(motion.root_positions * [1, 0, 1]).T, color=PATH, linewidth=1.5, zorder=1)
    ghosts = [0.15 + 0.35 * k / len(shown) for k in range(len(shown) - 1)]
    figures = [StickFigure(motion.skeleton, ax, alpha) for alpha in (*ghosts, 1.0)]
    for figure, pose in zip(figures, points, strict=True):
        figure.pose(pose)
    return figures


def _stage_around(points: Array, ax: Axes3D | None = None) -> Axes3D:
    """Set up ground that is wide and tall enough for points, shape (..., 3)."""
    low, high = (f(points.reshape(-1, 3), axis=0) for f in (np.min, np.max))
    centre, wide = (low + high)[[0, 2]] / 2, (high - low)[[0, 2]]
    ax = ground_axes(centre, max(1.2, *wide) / 2 + 0.3, tall=max(TALL, high[1]), ax=ax)
    keep_inside(ax, points)
    return ax


def laid_over(
    first: Motion, second: Motion, *, every: int = 5, ax: Axes3D | None = None
) -> tuple[list[StickFigure], list[StickFigure]]:
    """Draw two motions over each other, each in one colour, to see how well they match.

    Parameters
    ----------
    first, second : the motions, where they are: `planar` lays one on the other.
    every : frames from one pose to the next.
    ax : 3D axes; by default a new `axes` around both.

    Returns
    -------
    The figures of each.

    Notebook: 02-matching
    """
    clouds = [joint_positions(motion)[::every] for motion in (first, second)]
    ax = ax or _stage_around(np.concatenate([points.reshape(-1, 3) for points in clouds]))
    drawn = []
    for motion, points, colour in zip((first, second), clouds, SOURCES[:2], strict=True):
        figures = [StickFigure(motion.skeleton, ax, 0.7, colour) for _ in points]
        for figure, pose in zip(figures, points, strict=True):
            figure.pose(pose)
        ax.plot([], [], [], color=colour, linewidth=2.4, label=motion.name)
        drawn.append(figures)
    ax.legend(loc="upper left", frameon=False)
    return drawn[0], drawn[1]


def film_strip(motions: Sequence[Motion], *, count: int = 6) -> Figure:
    """Draw poses side by side, evenly spread over the time of the first motion, the others with it.

    Parameters
    ----------
    motions : one or more.
    count : pictures; fewer where the motion has fewer frames.

    Returns
    -------
    A figure of its own, outside pyplot.
    """
    first = motions[0]
    clouds = [joint_positions(motion) for motion in motions]
    frames = np.unique(np.linspace(0, len(first) - 1, count).round().astype(int))
    figure = Figure(figsize=(1.5 * len(frames), 1.75))
    for panel, frame in enumerate(frames):
        ax = figure.add_axes((panel / len(frames), 0, 1 / len(frames), 0.86), projection="3d")
        everyone = [
            points[min(len(points) - 1, round(frame / first.fps * motion.fps))]
            for motion, points in zip(motions, clouds, strict=True)
        ]
        _stage_around(np.concatenate(everyone), ax)
        ax.set_title(f"{frame / first.fps:.2f} s", fontsize=9, y=1.0)
        for number, (motion, points) in enumerate(zip(motions, everyone, strict=True)):
            colour = SOURCES[number % len(SOURCES)] if len(motions) > 1 else None
            StickFigure(motion.skeleton, ax, 1.0, colour).pose(points)
    return figure
