"""Bodies along their path: a whole walk in one picture, as in [KGP02, Fig. 1]."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.plotting.axes import rims
from mocap.plotting.bodies import draw_body
from mocap.plotting.style import ASKED, FLOOR, MARK, PATH, QUIET, own_colour, source_colours

WIDTH = 9.0  # inches
LOW, HIGH = 1.9, 4.6  # inches: the least and the greatest height of the picture
RISE = np.radians(24)  # how far above the ground the camera stands
MOST = 15  # bodies; more would hide one another
FEW = 3  # characters; of more, the bodies of one moment are drawn together
GREY = "#666666"
APART = 0.7  # metres between two bodies at least


def bodies_along(
    *motions: Motion,
    sources: Sequence[tuple[int, str]] = (),
    seams: Iterable[int] = (),
    path: ArrayLike = (),
    discs: ArrayLike = (),
) -> Figure:
    """Draw motions as bodies along their paths, evenly spread over the ground, from the side and above.

    Parameters
    ----------
    motions : one or more characters; sources and seams are those of the first. More than three are drawn at
        the same three moments, so that one sees the group.
    sources : pairs (frame, name of the clip from there on), as from `synthesis.sources`: bodies and path have
        the colour of their clip. Without them one character has the colours of left and right, and several
        have a colour each.
    seams : frames at which a transition starts, marked on the path.
    path : the path that was asked for, shape (N, 2), points (x, z) in metres.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.

    Returns
    -------
    A figure that pyplot does not know, so nobody has to close it.

    Examples
    --------
    >>> from mocap import datasets
    >>> figure = bodies_along(datasets.sample("walk_straight"), seams=[300])
    >>> [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    ['walked path', 'seam']

    Notebook: 00-quickstart
    """
    asked = np.reshape(np.asarray(path, float), (-1, 2))
    clouds = [joint_positions(motion) for motion in motions]
    ways = [cloud[:, 0, [0, 2]] for cloud in clouds]
    view = _View(np.concatenate([*ways, asked]))
    view.ax.add_collection(PolyCollection(list(view.see(rims(discs))), facecolors=QUIET, zorder=0.5))
    view.line(asked, ASKED, "asked path", 4.0)
    named = len(motions) == 1 or len({motion.name for motion in motions}) > 1  # colours need different names
    together = np.linspace(0, min(map(len, motions)) - 1, 3).astype(int)  # of a group, the same three moments
    for number, (motion, cloud, way) in enumerate(zip(motions, clouds, ways, strict=True)):
        own = own_colour(number, len(motions))
        spans = _spans(motion, sources if number == 0 else (), own, named)
        for start, end, colour, name in spans:
            view.line(way[start : end + 1], colour or PATH, name)
        for frame in together if len(motions) > FEW else _chosen(way):
            (colour,) = [colour for start, end, colour, _ in spans if start <= frame < end]
            view.body(motion.skeleton, cloud[frame], colour)
    if len(marked := np.asarray(list(seams), int)):
        places = view.see(clouds[0][marked, 0] * [1, 0, 1])
        view.ax.plot(*places.T, "D", color=MARK, markersize=6, label="seam", zorder=2)
    return view.framed()


def _spans(
    motion: Motion, sources: Sequence[tuple[int, str]], colour: str | None, named: bool
) -> list[tuple[int, int, str | None, str]]:
    """List the stretches of a motion that have one colour: their frames [start, end), colour and name."""
    if not sources:
        return [(0, len(motion), colour, motion.name * named if colour else "walked path")]
    colours = source_colours([name for _, name in sources])
    ends = [*(frame for frame, _ in sources[1:]), len(motion)]
    return [(start, end, colours[name], name) for (start, name), end in zip(sources, ends, strict=True)]


class _View:
    """A parallel projection in which the longest way over the ground, points (N, 2), runs across."""

    def __init__(self, ground: Array) -> None:
        x, z = np.linalg.svd(ground - ground.mean(axis=0), full_matrices=False)[2][0]
        if (ground[-1] - ground[0]) @ (x, z) < 0:
            x, z = -x, -z
        self.axes = np.array([[x, 0, z], [z, 0, -x]])  # across, and away from the camera
        self.up = np.cos(RISE) * np.array([0, 1, 0]) + np.sin(RISE) * self.axes[1]
        self.figure = Figure(figsize=(WIDTH, LOW), layout="constrained")
        self.ax = self.figure.add_subplot(aspect="equal")
        self.ax.set_axis_off()
        self._grid(_level(ground) @ self.axes.T)

    def see(self, points: Array) -> Array:
        """Project points, shape (..., 3), metres, to places in the picture, shape (..., 2)."""
        return np.stack([points @ self.axes[0], points @ self.up], axis=-1)

    def _grid(self, ground: Array) -> None:
        """Draw squares of 1 m on the floor; of 10, 100, ... m rather than more than a thousand in a row."""
        cell = 10.0 ** np.ceil(np.log10(max(np.ptp(ground, axis=0).max() / 1000, 1.0)))
        low, high = np.floor(ground.min(axis=0) / cell - 0.5), np.ceil(ground.max(axis=0) / cell + 0.5)
        away = [((x, low[1]), (x, high[1])) for x in np.arange(low[0], high[0] + 1)]
        along = [((low[0], z), (high[0], z)) for z in np.arange(low[1], high[1] + 1)]
        lines = self.see(cell * np.array([*away, *along]) @ self.axes)
        self.ax.add_collection(LineCollection(list(lines), colors=FLOOR, linewidths=0.8, zorder=0))

    def line(self, ground: Array, colour: str, name: str, wide: float = 1.6) -> None:
        """Draw a line over the ground, points (x, z); each name stands in the legend once."""
        if len(ground):
            known = name in self.ax.get_legend_handles_labels()[1]
            label = None if known or not name else name
            self.ax.plot(*self.see(_level(ground)).T, color=colour, linewidth=wide, label=label, zorder=1)

    def body(self, skeleton: Skeleton, points: Array, colour: str | None) -> None:
        """Draw a body, over those that are farther from the camera."""
        near = 4 - float(np.tanh(points[0] @ self.axes[1] / 50))
        head = {"markersize": 7, "zorder": near, "clip_on": False}
        draw_body(self.ax, skeleton, self.see(points), colour=colour, head=head, linewidths=2, zorder=near)

    def framed(self) -> Figure:
        """Make the picture as high as what it shows, and name the colours above it."""
        self.ax.margins(0.02, 0.04)
        self.ax.autoscale_view()
        wide, high = np.ptp(self.ax.get_xlim()), np.ptp(self.ax.get_ylim())
        self.figure.set_size_inches(WIDTH, float(np.clip(WIDTH * high / wide + 0.35, LOW, HIGH)))
        if columns := min(6, len(self.ax.get_legend_handles_labels()[1])):
            self.ax.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=columns, fontsize=9, frameon=False)
        self.ax.text(
            1, 1.02, "lines 1 m apart", transform=self.ax.transAxes, ha="right", fontsize=8, color=GREY
        )
        return self.figure


def _chosen(ground: Array) -> list[int]:
    """Choose frames of a path, shape (F, 2), whose places are far enough from each other."""
    apart, chosen = APART, [0]
    while True:
        for frame, place in enumerate(ground):
            if np.linalg.norm(ground[chosen] - place, axis=-1).min() > apart:
                chosen.append(frame)
        if len(chosen) <= MOST:
            return chosen
        apart, chosen = 1.15 * apart, [0]


def _level(ground: Array) -> Array:
    """Give points (x, z), shape (N, 2), the height 0: shape (N, 3)."""
    return np.insert(ground, 1, 0.0, axis=-1)
