"""Pictures: stick figures, distance grids, graphs, paths, animations.

Every function draws on `ax` (a new one by default) and gives back the artists it made. Colours are those
of Okabe and Ito, which colour-blind readers tell apart. The world's (z, x, y) are the picture's (x, y, z).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.typing import ArrayLike, NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from mocap.atomic import replacing
from mocap.errors import MocapError
from mocap.kinematics import joint_positions
from mocap.matching import distinct_joints
from mocap.motion import Motion, resample
from mocap.motion_graph import MotionGraph
from mocap.progress import Progress
from mocap.skeleton import Skeleton

Array = NDArray[np.float64]

COLOURS = {"left": "#0072B2", "right": "#D55E00", "middle": "#333333"}
PATH, MARK, FLOOR, QUIET = "#E69F00", "#CC79A7", "#DDDDDD", "#999999"
TALL = 1.9  # metres of height that pictures show


def _picture(points: ArrayLike) -> Array:
    """Turn y-up world coordinates, shape (..., 3), into matplotlib's z-up ones, without mirroring."""
    return np.roll(np.asarray(points, float), 1, axis=-1)


def stage(centre: ArrayLike = (0.0, 0.0), reach: float = 1.0, *, ax: Axes3D | None = None) -> Axes3D:
    """Set up a square of ground with lines every half metre, `reach` metres each way from `centre` (x, z)."""
    ax = ax or _filled(plt.figure(figsize=(5, 5)))
    ax.set_axis_off()
    ax.computed_zorder = False  # the ground lies below the feet, from wherever one looks
    ax.view_init(elev=14, azim=-55)
    ax.set_proj_type("persp", focal_length=0.6)
    ax.set_box_aspect((2 * reach, 2 * reach, TALL), zoom=1.55)
    ax.add_collection3d(Line3DCollection(np.zeros((1, 2, 3)), colors=FLOOR, linewidths=0.8, zorder=0))
    _look_at(ax, np.asarray(centre, float), reach)
    return ax


def _filled(figure: Figure) -> Axes3D:
    return figure.add_axes((0, 0, 1, 1), projection="3d")


def _look_at(ax: Axes3D, centre: Array, reach: float) -> None:
    """Show the ground around a point (x, z); its lines stay where they are in the world."""
    x, z = centre
    ax.set(xlim=(z - reach, z + reach), ylim=(x - reach, x + reach), zlim=(0, TALL))
    along, across = (np.arange(np.ceil((c - reach) * 2), np.floor((c + reach) * 2) + 1) / 2 for c in centre)
    lines = [[(x0, 0, z - reach), (x0, 0, z + reach)] for x0 in along]
    lines += [[(x - reach, 0, z0), (x + reach, 0, z0)] for z0 in across]
    ax.collections[0].set_segments(_picture(lines))


class StickFigure:
    """A body drawn as lines on 3D axes, left and right in colours of their own, the head as a dot.

    Parameters
    ----------
    skeleton : the body.
    ax : 3D axes, as from `stage`.
    alpha : 1 for a solid body, less for a ghost.
    """

    def __init__(self, skeleton: Skeleton, ax: Axes3D, alpha: float = 1.0) -> None:
        self.ends = distinct_joints(skeleton)[1:]  # a bone that several joints share is drawn once
        self.starts = skeleton.parents[self.ends]
        # The line from a parent to its child is the parent's bone.
        self.sides = np.array([skeleton.side(int(parent)) for parent in self.starts])
        self.head = [joint for joint, name in enumerate(skeleton.names) if "head" in name.lower()]
        self.bones = {
            side: Line3DCollection(np.zeros((1, 2, 3)), colors=colour, linewidths=2.4, alpha=alpha, zorder=3)
            for side, colour in COLOURS.items()
        }
        for part in self.bones.values():
            ax.add_collection3d(part)
        (self.dot,) = ax.plot([], [], [], "o", color=COLOURS["middle"], markersize=11, alpha=alpha, zorder=3)

    def pose(self, points: Array) -> None:
        """Move to the joint positions `points`, shape (J, 3), metres."""
        segments = _picture(np.stack([points[self.starts], points[self.ends]], axis=1))
        for side, part in self.bones.items():
            part.set_segments(segments[self.sides == side])
        if self.head:
            self.dot.set_data_3d(*_picture(points[self.head].mean(axis=0))[:, None])


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

    Notebook: 00-quickstart
    """
    shown = [frames] if isinstance(frames, int) else list(frames)
    points = joint_positions(motion)[shown]
    if ax is None:
        low, high = (f(points[..., [0, 2]], axis=(0, 1)) for f in (np.min, np.max))
        ax = stage((low + high) / 2, max(1.2, *(high - low)) / 2 + 0.3)
    ax.plot(*_picture(motion.root_positions * [1, 0, 1]).T, color=PATH, linewidth=1.5, zorder=1)
    ghosts = [0.15 + 0.35 * k / len(shown) for k in range(len(shown) - 1)]
    figures = [StickFigure(motion.skeleton, ax, alpha) for alpha in (*ghosts, 1.0)]
    for figure, pose in zip(figures, points, strict=True):
        figure.pose(pose)
    return figures


def distance_image(
    grid: Array,
    *,
    fps: float,
    minima: ArrayLike = (),
    names: Sequence[str] = ("", ""),
    ax: Axes | None = None,
) -> AxesImage:
    """Draw a distance grid, dark where the windows are alike, with its minima marked [KGP02, Fig. 3].

    Parameters
    ----------
    grid : D, shape (n, m), m²; its root, in centimetres, is what the colours show.
    fps : frames a second: the axes are in seconds.
    minima : rows and columns, shape (N, 2).
    names : of the clip along the rows and that along the columns.
    ax : axes; new ones by default.

    Notebook: 00-quickstart
    """
    ax = ax or plt.figure(figsize=(5, 4.2), layout="constrained").add_subplot()
    seconds = (0, grid.shape[1] / fps, grid.shape[0] / fps, 0)
    image = ax.imshow(100 * np.sqrt(grid), cmap="cividis", extent=seconds, interpolation="nearest")
    rows, columns = np.reshape(minima, (-1, 2)).T
    ax.plot((columns + 0.5) / fps, (rows + 0.5) / fps, ".", color="#FFFFFF", markersize=4, label="minima")
    ax.set(xlabel=f"{names[1]} (s)".strip(), ylabel=f"{names[0]} (s)".strip(), aspect="equal")
    ax.figure.colorbar(image, ax=ax, label="RMS distance (cm)", shrink=0.8)
    return image


def path_from_above(
    motion: Motion, *, seams: ArrayLike = (), colour: str = PATH, ax: Axes | None = None
) -> list[Line2D]:
    """Draw the root's path on the ground seen from above, with x to the left as from behind, z up.

    Parameters
    ----------
    motion : the motion.
    seams : frames to mark.
    colour : of the path.
    ax : axes; new ones by default.

    Returns
    -------
    The path, the start, and the seams.

    Notebook: 00-quickstart
    """
    ax = ax or plt.figure(figsize=(4.5, 4.5), layout="constrained").add_subplot()
    x, z = motion.root_positions[:, [0, 2]].T
    at = np.asarray(seams, int)
    lines = ax.plot(x, z, color=colour, linewidth=2, label=motion.name)
    lines += ax.plot(x[:1], z[:1], "o", color=COLOURS["middle"], markersize=6)
    lines += ax.plot(x[at], z[at], "D", color=MARK, markersize=5, label="seams" if len(at) else None)
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    if not ax.xaxis_inverted():
        ax.invert_xaxis()  # y is up: seen from above, x grows to the left when z grows upwards
    return lines


def timeline(motion_graph: MotionGraph, *, ax: Axes | None = None) -> LineCollection:
    """Draw a motion graph: a bar a clip, along time, and an arc a transition, from leaving to entering.

    Notebook: 00-quickstart
    """
    ax = ax or plt.figure(figsize=(7, 0.7 * len(motion_graph.clips) + 1), layout="constrained").add_subplot()
    fps = motion_graph.clips[0].fps
    arcs = []
    for start, end, edge in motion_graph.graph.edges(data=True):
        ends = np.array([[start[1] / fps, -start[0]], [end[1] / fps, -end[0]]])
        if edge["kind"] == "clip":
            ax.plot(*ends.T, color=COLOURS["left"], linewidth=5, solid_capstyle="butt")
        else:
            arcs.append(_arc(*ends))
    for clip, motion in enumerate(motion_graph.clips):
        ax.plot([0, len(motion) / fps], [-clip, -clip], color=QUIET, linewidth=1, zorder=0)
    transitions = LineCollection(
        arcs, colors=MARK, linewidths=0.5, alpha=min(1.0, 0.03 + 100 / (len(arcs) + 1))
    )
    ax.add_collection(transitions)
    ax.set_yticks([-clip for clip in range(len(motion_graph.clips))], [m.name for m in motion_graph.clips])
    ax.set(xlabel="time in the clip (s)")
    ax.spines[["top", "right", "left"]].set_visible(False)
    return transitions


def _arc(start: Array, end: Array) -> Array:
    """Bend a line, upwards at its middle, so that arcs within one clip are seen."""
    t = np.linspace(0, 1, 17)[:, None]
    return start + t * (end - start) + 4 * t * (1 - t) * [0, 0.45]


def save_animation(motion: Motion, path: str | Path, *, fps: float = 25.0, progress: Progress = iter) -> Path:
    """Write an animated GIF: the stick figure on the ground, followed by the camera, and its path.

    Parameters
    ----------
    motion : what to show.
    path : the file to write, ending in .gif; nothing is left behind when writing fails.
    fps : pictures a second; GIFs count in hundredths of a second, so 25, 50 and 20 are exact.
    progress : wraps the pictures as they are drawn, to show a bar.

    Returns
    -------
    The path.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.
    """
    if Path(path).suffix.lower() != ".gif":
        raise MocapError(f"An animation is written as .gif, got '{path}'.")
    motion = resample(motion, fps)
    points = joint_positions(motion)
    centres = gaussian_filter1d(motion.root_positions[:, [0, 2]], fps / 3, axis=0, mode="nearest")
    figure = Figure(figsize=(5, 5))
    canvas = FigureCanvasAgg(figure)  # draws whatever pyplot is set to, and needs no screen
    ax = stage(centres[0], ax=_filled(figure))
    (body,) = stick_figure(motion, 0, ax=ax)
    pictures = []
    for frame in progress(range(len(motion))):
        _look_at(ax, centres[frame], 1.0)
        body.pose(points[frame])
        canvas.draw()
        pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    first, *rest = (picture.quantize(32, dither=Image.Dither.NONE) for picture in pictures)
    with replacing(path) as beside:
        first.save(beside, save_all=True, append_images=rest, duration=round(1000 / fps), loop=0)
    return Path(path)
