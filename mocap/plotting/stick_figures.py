"""Bodies drawn as lines on 3D axes with a ground, and where the camera looks.

The world's (z, x, y) are matplotlib's (x, y, z): its third axis points up, ours is y.
"""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import Motion, Skeleton, joint_positions
from mocap.plotting.bodies import bones, head_joints
from mocap.plotting.style import COLOURS, FLOOR, own_colour

TALL = 1.9  # metres above the ground that pictures show
ZOOM = 1.55  # of the camera, where nothing has to be brought inside the picture


def to_picture(points: ArrayLike) -> Array:
    """Turn y-up world coordinates, shape (..., 3), into matplotlib's z-up ones, without mirroring.

    Examples
    --------
    >>> to_picture([1, 2, 3])  # x to the left, y up, z ahead
    array([3., 1., 2.])

    Notebook: 03b-angles
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
    >>> ax = ground_axes((0, 5), reach=2, ax=filled(Figure()))
    >>> np.concatenate([ax.get_ylim(), ax.get_xlim()]).tolist()  # matplotlib's y is our x, its x our z
    [-2.0, 2.0, 3.0, 7.0]

    Notebook: 03b-angles
    """
    ax = ax or filled(plt.figure(figsize=(5, 5)))
    ax.set_axis_off()
    ax.computed_zorder = False  # the ground is drawn below the feet, wherever the camera stands
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, tall), zoom=ZOOM)
    ax.set_zlim(0, tall)
    ax.add_collection3d(Line3DCollection(np.zeros((1, 2, 3)), colors=FLOOR, linewidths=0.8, zorder=0))
    look_at(ax, np.asarray(centre, float), reach)
    return ax


def ground_around(points: Array, ax: Axes3D | None = None) -> Axes3D:
    """Set up ground that is wide and high enough for points, shape (..., 3), metres."""
    low, high = (f(points.reshape(-1, 3), axis=0) for f in (np.min, np.max))
    centre, wide = (low + high)[[0, 2]] / 2, (high - low)[[0, 2]]
    ax = ground_axes(centre, max(1.2, *wide) / 2 + 0.3, tall=max(TALL, high[1]), ax=ax)
    keep_inside(ax, points)
    return ax


def filled(figure: Figure) -> Axes3D:
    """Add 3D axes that fill a whole figure."""
    return figure.add_axes((0, 0, 1, 1), projection="3d")


def look_at(ax: Axes3D, centre: Array, reach: float) -> None:
    """Show the ground around a point (x, z); the first collection of `ax`, its lines, keeps to the world."""
    x, z = centre
    ax.set(xlim=(z - reach, z + reach), ylim=(x - reach, x + reach))
    along, across = (np.arange(np.ceil((c - reach) * 2), np.floor((c + reach) * 2) + 1) / 2 for c in centre)
    lines = [[(x0, 0, z - reach), (x0, 0, z + reach)] for x0 in along]
    lines += [[(x - reach, 0, z0), (x + reach, 0, z0)] for z0 in across]
    ax.collections[0].set_segments(to_picture(lines))


def rims(discs: ArrayLike) -> Array:
    """Outline discs on the ground, shape (N, 3), x, z and radius in metres: (N, 48, 3).

    Examples
    --------
    >>> rims([[3, 4, 1]])[0, ::12].round(6).tolist()
    [[3.0, 0.0, 5.0], [4.0, 0.0, 4.0], [3.0, 0.0, 3.0], [2.0, 0.0, 4.0]]
    """
    x, z, radius = np.reshape(np.asarray(discs, float), (-1, 3)).T[..., None]
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    across, along = x + radius * np.sin(angle), z + radius * np.cos(angle)
    return np.stack([across, np.zeros_like(across), along], axis=-1)


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
    >>> from mocap import datasets
    >>> from mocap.plotting import ground_axes
    >>> walk = datasets.sample("walk_straight")
    >>> body = StickFigure(walk.skeleton, ground_axes(ax=Figure().add_subplot(projection="3d")))
    >>> moved = body.pose(joint_positions(walk)[30])  # `explore` draws only these again
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
