"""Bodies drawn as lines on 3D axes with a ground, and where the camera looks.

The world's (z, x, y) are matplotlib's (x, y, z): its third axis points up, ours is y.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import Skeleton
from mocap.plotting.bodies import bones, head_joints
from mocap.plotting.style import COLOURS, FLOOR

TALL = 1.9  # metres above the ground that pictures show
ZOOM = 1.55  # of the camera, where nothing has to be brought inside the picture


def to_picture(points: ArrayLike) -> Array:
    """Turn y-up world coordinates, shape (..., 3), into matplotlib's z-up ones, without mirroring.

    Examples
    --------
    >>> to_picture([1, 2, 3])  # x to the left, y up, z ahead
    array([3., 1., 2.])
    """
    return np.roll(np.asarray(points, float), 1, axis=-1)


def ground_axes(
    centre: ArrayLike = (0.0, 0.0), reach: float = 1.0, *, tall: float = TALL, ax: Axes3D | None = None
) -> Axes3D:
    """Set up a square of ground with lines every half metre.

    Parameters
    ----------
    centre : its middle (x, z), metres.
    reach : metres from there to each side.
    tall : metres above the ground that are seen.
    ax : 3D axes; by default they fill a new figure.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = ground_axes((0, 5), reach=2, ax=Figure().add_subplot(projection="3d"))
    >>> np.concatenate([ax.get_ylim(), ax.get_xlim()]).tolist()  # matplotlib's y is our x, its x our z
    [-2.0, 2.0, 3.0, 7.0]

    Notebook: 03b-angles
    """
    ax = ax or plt.figure(figsize=(5, 5)).add_subplot(projection="3d", position=(0, 0, 1, 1))
    ax.set_axis_off()
    ax.computed_zorder = False  # the ground is drawn below the feet, wherever the camera stands
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, tall), zoom=ZOOM)
    ax.set_zlim(0, tall)
    x, z = centre = np.asarray(centre, float)
    ax.set(xlim=(z - reach, z + reach), ylim=(x - reach, x + reach))
    along, across = (np.arange(np.ceil((c - reach) * 2), np.floor((c + reach) * 2) + 1) / 2 for c in centre)
    lines = [[(x0, 0, z - reach), (x0, 0, z + reach)] for x0 in along]
    lines += [[(x - reach, 0, z0), (x + reach, 0, z0)] for z0 in across]
    # The limits stay, and where there is no line matplotlib 3.9 finds none.
    ax.add_collection3d(Line3DCollection(to_picture(lines), colors=FLOOR, lw=0.8, zorder=0), autolim=False)
    return ax


def keep_inside(ax: Axes3D, points: Array) -> None:
    """Zoom out until all points, shape (..., 3), metres, are inside the picture; never zoom in."""
    flat, zoom = to_picture(points).reshape(-1, 3), ZOOM
    spans = np.ptp([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()], axis=1)
    for _ in range(3):  # in perspective, the first step is only nearly right
        ax.apply_aspect()
        across, up, _ = proj3d.proj_transform(*flat.T, ax.get_proj())
        seen = ax.transAxes.inverted().transform(ax.transData.transform(np.stack([across, up], axis=-1)))
        zoom /= max(1.0, 2 * float(np.abs(seen - 0.5).max()) / 0.92)
        ax.set_box_aspect(spans, zoom=zoom)


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
    >>> from matplotlib.figure import Figure
    >>> from mocap import datasets
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.plotting import ground_axes
    >>> walk = datasets.sample("walk_straight")
    >>> body = StickFigure(walk.skeleton, ground_axes(ax=Figure().add_subplot(projection="3d")))
    >>> moved = body.pose(joint_positions(walk)[30])  # `widgets.explore` draws only these again
    >>> len(moved)  # the bones, and the head
    2

    Notebook: 03b-angles
    """

    def __init__(self, skeleton: Skeleton, ax: Axes3D, alpha: float = 1.0, colour: str | None = None) -> None:
        starts, ends, sides = bones(skeleton)
        order = np.argsort([list(COLOURS).index(side) for side in sides], kind="stable")
        self.ends, self.head = np.stack([starts, ends], axis=1)[order], head_joints(skeleton)
        colours = [colour or COLOURS[side] for side in sides[order]]
        nowhere = np.zeros((len(order), 2, 3))
        self.bones = Line3DCollection(nowhere, colors=colours, linewidths=2.4, alpha=alpha, zorder=3)
        ax.add_collection3d(self.bones)
        dot = colour or COLOURS["middle"]
        (self.dot,) = ax.plot([], [], [], "o", color=dot, markersize=11, alpha=alpha, zorder=3)
        self.figure = ax.figure

    def pose(self, points: Array) -> list[Artist]:
        """Move to the joint positions `points`, shape (J, 3), metres, and return the artists that moved."""
        self.bones.set_segments(to_picture(points[self.ends]))
        if self.head:
            self.dot.set_data_3d(*to_picture(points[self.head].mean(axis=0))[:, None])
        return [self.bones, self.dot]
