"""Bodies drawn as lines on 3D axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.plotting.axes import ground_around, to_picture
from mocap.plotting.bodies import bones, head_joints
from mocap.plotting.style import COLOURS, PATH, SOURCES, own_colour


class StickFigure:
    """A body drawn as lines on 3D axes: left and right in colours of their own, the head as a dot.

    Parameters
    ----------
    skeleton : the body.
    ax : 3D axes, as from `ground_axes`.
    alpha : 1 for a solid body, less for a ghost.
    colour : one for all bones, to tell two bodies apart; by default left, right and middle have their own.

    Examples
    --------
    >>> from mocap import datasets
    >>> from mocap.plotting import ground_axes
    >>> walk = datasets.sample("walk_straight")
    >>> body = StickFigure(walk.skeleton, ground_axes(ax=Figure().add_subplot(projection="3d")))
    >>> moved = body.pose(joint_positions(walk)[30])  # `explore` draws only these again
    >>> len(moved)  # left, right, middle, head
    4

    Notebook: 01-skeletons-and-clips
    """

    def __init__(self, skeleton: Skeleton, ax: Axes3D, alpha: float = 1.0, colour: str | None = None) -> None:
        self.figure = ax.figure
        self.starts, self.ends, self.sides = bones(skeleton)
        self.head = head_joints(skeleton)
        look: dict[str, Any] = {"alpha": alpha, "zorder": 3}
        self.bones = {
            side: Line3DCollection(np.zeros((1, 2, 3)), colors=colour or own, linewidths=2.4, **look)
            for side, own in COLOURS.items()
        }
        for part in self.bones.values():
            ax.add_collection3d(part)
        (self.dot,) = ax.plot([], [], [], "o", color=colour or COLOURS["middle"], markersize=11, **look)

    def pose(self, points: Array) -> list[Artist]:
        """Move to the joint positions `points`, shape (J, 3), metres, and return the artists that moved."""
        segments = to_picture(np.stack([points[self.starts], points[self.ends]], axis=1))
        for side, part in self.bones.items():
            part.set_segments(segments[self.sides == side])
        if self.head:
            self.dot.set_data_3d(*to_picture(points[self.head].mean(axis=0))[:, None])
        return [*self.bones.values(), self.dot]


def stick_figure(
    motion: Motion, frames: Sequence[int] | int = 0, *, ax: Axes3D | None = None
) -> list[StickFigure]:
    """Draw poses of a motion: the last one solid, those before it as ghosts, the root's path on the ground.

    Parameters
    ----------
    motion : the motion.
    frames : which frames; one or several.
    ax : 3D axes; by default new ones around these poses.

    Returns
    -------
    One stick figure per pose.

    Examples
    --------
    >>> from mocap import datasets, plotting
    >>> walk = datasets.sample("walk_straight")
    >>> plotting.show(stick_figure(walk, [0, 40, 80]), alt="Three poses of a walk.")
    Picture('Three poses of a walk.')

    Notebook: 01-skeletons-and-clips
    """
    shown = [frames] if isinstance(frames, int) else list(frames)
    points = joint_positions(motion)[shown]
    ax = ax or ground_around(points)
    ax.plot(*to_picture(motion.root_positions * [1, 0, 1]).T, color=PATH, linewidth=1.5, zorder=1)
    ghosts = [0.15 + 0.35 * k / len(shown) for k in range(len(shown) - 1)]
    figures = [StickFigure(motion.skeleton, ax, alpha) for alpha in (*ghosts, 1.0)]
    for figure, pose in zip(figures, points, strict=True):
        figure.pose(pose)
    return figures


def laid_over(
    first: Motion, second: Motion, *, every: int = 5, ax: Axes3D | None = None
) -> tuple[list[StickFigure], list[StickFigure]]:
    """Draw two motions over each other, each in one colour, to see how well they match.

    Parameters
    ----------
    first, second : the motions; they stay where they are, so align them first.
    every : frames from one pose to the next.
    ax : 3D axes; by default new ones around both.

    Returns
    -------
    The stick figures of the first motion, and those of the second.

    Examples
    --------
    >>> from mocap import datasets, plotting
    >>> walk = datasets.sample("walk_straight")
    >>> first, second = laid_over(walk[:21], walk[2:23], every=10)
    >>> len(first), len(second)
    (3, 3)
    >>> plotting.show(first[0].figure, alt="A walk, and the same walk two frames later.")
    Picture('A walk, and the same walk two frames later.')

    Notebook: 02-matching
    """
    clouds = [joint_positions(motion)[::every] for motion in (first, second)]
    ax = ax or ground_around(np.concatenate([points.reshape(-1, 3) for points in clouds]))
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
    """Draw poses side by side, evenly spread over the first motion's time; the others at the same times.

    Parameters
    ----------
    motions : one or more.
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
        ground_around(np.concatenate(everyone), ax)
        ax.set_title(f"{frame / first.fps:.2f} s", fontsize=9, y=1.0)
        for number, (motion, points) in enumerate(zip(motions, everyone, strict=True)):
            StickFigure(motion.skeleton, ax, 1.0, own_colour(number, len(motions))).pose(points)
    return figure
