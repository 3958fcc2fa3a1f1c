"""Bodies drawn as lines on 3D axes with a ground, and the zoom of the camera.

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
from mocap.body.body_sides import head_joints
from mocap.plotting.bodies import bones
from mocap.plotting.style import COLOURS, FLOOR

TALL = 1.9  # metres, the height of the visible space above the ground
ZOOM = 1.55  # zoom of the camera, unless points would be outside the picture
SPACING = 0.5  # metres between the lines of the ground
FILL = 0.92  # fraction of the picture's width and height that points may occupy


def to_picture(points: ArrayLike) -> Array:
    """Convert y-up world coordinates, shape (..., 3), to matplotlib's z-up coordinates, without mirroring.

    Examples
    --------
    >>> to_picture([1, 2, 3])  # x to the left, y up, z ahead
    array([3., 1., 2.])
    """
    return np.roll(np.asarray(points, float), 1, axis=-1)


def ground_axes(
    centre: ArrayLike = (0.0, 0.0), reach: float = 1.0, *, tall: float = TALL, ax: Axes3D | None = None
) -> Axes3D:
    """Set up 3D axes with a square of ground, with lines every half metre.

    Parameters
    ----------
    centre : the middle (x, z) of the square, metres.
    reach : half the side of the square, metres.
    tall : the height of the visible space, metres.
    ax : 3D axes, by default those of a new figure, which they fill.

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
    ax.computed_zorder = False  # the ground is drawn below the feet, for all positions of the camera
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, tall), zoom=ZOOM)
    ax.set_zlim(0, tall)
    x_low, z_low = np.asarray(centre, float) - reach
    x_high, z_high = np.asarray(centre, float) + reach
    ax.set(xlim=(z_low, z_high), ylim=(x_low, x_high))
    lines = [[(x, 0, z_low), (x, 0, z_high)] for x in _multiples(x_low, x_high)]
    lines += [[(x_low, 0, z), (x_high, 0, z)] for z in _multiples(z_low, z_high)]
    # The limits are not updated, because matplotlib 3.9 finds none if there is no line.
    ax.add_collection3d(Line3DCollection(to_picture(lines), colors=FLOOR, lw=0.8, zorder=0), autolim=False)
    return ax


def _multiples(low: float, high: float) -> Array:
    """Return the multiples of `SPACING` from `low` to `high`."""
    return np.arange(np.ceil(low / SPACING), np.floor(high / SPACING) + 1) * SPACING


def keep_inside(ax: Axes3D, points: Array) -> None:
    """Zoom out, never in, until all points, shape (..., 3), metres, are inside the picture."""
    coordinates = to_picture(points).reshape(-1, 3)
    zoom = ZOOM
    spans = np.ptp([ax.get_xlim(), ax.get_ylim(), ax.get_zlim()], axis=1)
    for _ in range(3):  # iterated, because in perspective a step is only approximate
        ax.apply_aspect()
        across, up, _ = proj3d.proj_transform(*coordinates.T, ax.get_proj())
        pixels = ax.transData.transform(np.stack([across, up], axis=-1))
        positions = ax.transAxes.inverted().transform(pixels)  # from 0 to 1 inside the picture
        extent = 2 * float(np.abs(positions - 0.5).max())
        zoom /= max(1.0, extent / FILL)
        ax.set_box_aspect(spans, zoom=zoom)


class StickFigure:
    """A body drawn as lines on 3D axes: its left and its right side in two colours, the head as a dot.

    Parameters
    ----------
    skeleton : the body.
    ax : 3D axes, as from `ground_axes`.
    alpha : opacity, 1 for a solid body, less for a ghost.
    colour : the colour of all bones, to distinguish several bodies. By default that of their sides.

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
        self.ends = np.stack([starts, ends], axis=1)[order]
        self.head = head_joints(skeleton)
        colours = [colour or COLOURS[side] for side in sides[order]]
        lines = np.zeros((len(order), 2, 3))  # until there is a pose
        self.bones = Line3DCollection(lines, colors=colours, linewidths=2.4, alpha=alpha, zorder=3)
        ax.add_collection3d(self.bones)
        dot = colour or COLOURS["middle"]
        (self.dot,) = ax.plot([], [], [], "o", color=dot, markersize=11, alpha=alpha, zorder=3)
        self.figure = ax.figure

    def pose(self, points: Array) -> list[Artist]:
        """Draw the pose with joint positions `points`, shape (J, 3), metres, and return the moved artists."""
        self.bones.set_segments(to_picture(points[self.ends]))
        if self.head:
            self.dot.set_data_3d(*to_picture(points[self.head].mean(axis=0))[:, None])
        return [self.bones, self.dot]
