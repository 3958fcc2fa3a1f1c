"""The ground and the bodies on it, in matplotlib's 3D axes.

The world's (z, x, y) are the picture's (x, y, z).
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import ArrayLike, NDArray

from mocap.matching import distinct_joints
from mocap.skeleton import Skeleton
from mocap.style import COLOURS, FLOOR

Array = NDArray[np.float64]

TALL = 1.9  # metres of height that pictures show


def to_picture(points: ArrayLike) -> Array:
    """Turn y-up world coordinates, shape (..., 3), into matplotlib's z-up ones, without mirroring."""
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
    """
    ax = ax or filled(plt.figure(figsize=(5, 5)))
    ax.set_axis_off()
    ax.computed_zorder = False  # the ground lies below the feet, from wherever one looks
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, tall), zoom=1.55)
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
        self.ends = distinct_joints(skeleton)[1:]  # a bone that several joints share is drawn once
        self.starts = skeleton.parents[self.ends]
        # The line from a parent to its child is the parent's bone.
        self.sides = np.array([skeleton.side(int(parent)) for parent in self.starts])
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
