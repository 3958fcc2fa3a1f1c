"""The ground and the bodies on it, in matplotlib's 3D axes.

The world's (z, x, y) are the picture's (x, y, z).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import ArrayLike, NDArray

from mocap.kinematics import joint_positions
from mocap.motion import Motion
from mocap.point_clouds import distinct_joints
from mocap.skeleton import Skeleton
from mocap.style import COLOURS, FLOOR, PATH, SOURCES

Array = NDArray[np.float64]

TALL = 1.9  # metres of height that pictures show
ZOOM = 1.55  # how near one stands


def to_picture(points: ArrayLike) -> Array:
    """Turn y-up world coordinates, shape (..., 3), into matplotlib's z-up ones, without mirroring.

    Notebook: 03-transforms
    """
    return np.roll(np.asarray(points, float), 1, axis=-1)


def stage(
    centre: ArrayLike = (0.0, 0.0), reach: float = 1.0, *, tall: float = TALL, ax: Axes3D | None = None
) -> Axes3D:
    """Set up a square of ground with lines every half metre.

    Parameters
    ----------
    centre : its middle (x, z), metres.
    reach : metres each way from there.
    tall : metres of height above it that are seen.
    ax : 3D axes; by default they fill a new figure.

    Notebook: 01-skeletons-and-clips
    """
    ax = ax or filled(plt.figure(figsize=(5, 5)))
    ax.set_axis_off()
    ax.computed_zorder = False  # the ground lies below the feet, from wherever one looks
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, tall), zoom=ZOOM)
    ax.set_zlim(0, tall)
    ax.add_collection3d(Line3DCollection(np.zeros((1, 2, 3)), colors=FLOOR, linewidths=0.8, zorder=0))
    look_at(ax, np.asarray(centre, float), reach)
    return ax


def filled(figure: Figure) -> Axes3D:
    """Let 3D axes fill a whole figure."""
    return figure.add_axes((0, 0, 1, 1), projection="3d")


def look_at(ax: Axes3D, centre: Array, reach: float) -> None:
    """Show the ground around a point (x, z); its lines stay where they are in the world."""
    x, z = centre
    ax.set(xlim=(z - reach, z + reach), ylim=(x - reach, x + reach))
    along, across = (np.arange(np.ceil((c - reach) * 2), np.floor((c + reach) * 2) + 1) / 2 for c in centre)
    lines = [[(x0, 0, z - reach), (x0, 0, z + reach)] for x0 in along]
    lines += [[(x - reach, 0, z0), (x + reach, 0, z0)] for z0 in across]
    ax.collections[0].set_segments(to_picture(lines))


def keep_inside(ax: Axes3D, points: Array) -> None:
    """Step back until points, shape (..., 3), metres, are all on the picture; nearer is left as it is."""
    flat, zoom = to_picture(points).reshape(-1, 3), ZOOM
    spans = np.ptp([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()], axis=1)
    for _ in range(3):  # perspective makes the first step nearly right, not quite
        ax.apply_aspect()
        across, up, _ = proj3d.proj_transform(*flat.T, ax.get_proj())
        seen = ax.transAxes.inverted().transform(ax.transData.transform(np.stack([across, up], axis=-1)))
        zoom /= max(1.0, 2 * float(np.abs(seen - 0.5).max()) / 0.92)
        ax.set_box_aspect(spans, zoom=zoom)


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
    ax : 3D axes, as from `stage`.
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
    ax : 3D axes; by default a new `stage` around these poses.

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
    ax = stage(centre, max(1.2, *wide) / 2 + 0.3, tall=max(TALL, high[1]), ax=ax)
    keep_inside(ax, points)
    return ax


def laid_over(
    first: Motion, second: Motion, *, every: int = 5, ax: Axes3D | None = None
) -> tuple[list[StickFigure], list[StickFigure]]:
    """Draw two motions over each other, each in one colour, to see how well they match.

    Parameters
    ----------
    first, second : the motions, where they are: `transforms` lays one on the other.
    every : frames from one pose to the next.
    ax : 3D axes; by default a new `stage` around both.

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
