"""Bodies as lines on flat axes: poses, film strips, and whole walks in a picture, as in [KGP02, Fig. 1]."""

from collections.abc import Iterable, Sequence
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices
from mocap.body import Motion, Skeleton, joint_positions
from mocap.matching.point_clouds import distinct_joints
from mocap.plotting.style import ASKED, COLOURS, FLOOR, MARK, PATH, QUIET, own_colour, source_colours

# Across and up, seen from the right, front and above.
ASLANT = np.array([[0.57, 0, 0.82], [-0.2, 0.97, 0.14]])


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
    ['0.00 s', '4.82 s', '9.64 s']
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


WIDTH = 9.0  # inches
LOW, HIGH = 1.9, 4.6  # inches: the least and the greatest height of the picture
RISE = np.radians(24)  # how far above the ground the camera stands
COLUMNS = 4  # of the legend
MOST = 15  # bodies; more would hide one another
FEW = 3  # characters; of more, the bodies of one moment are drawn together
APART = 0.7  # metres between two bodies at least


def bodies_along(
    *motions: Motion,
    sources: Sequence[tuple[int, str]] = (),
    seams: Iterable[int] = (),
    path: ArrayLike = (),
    discs: ArrayLike = (),
    places: Sequence[Array] = (),
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
    places : of the joints of each motion, shape (F, J, 3); by default those of `joint_positions`.

    Returns
    -------
    A figure that pyplot does not know, so nobody has to close it.

    Examples
    --------
    >>> from mocap import datasets
    >>> figure = bodies_along(datasets.sample("walk_straight"), seams=[300])
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['walked path', 'seam']
    """
    asked = np.insert(np.reshape(np.asarray(path, float), (-1, 2)), 1, 0.0, axis=-1)
    clouds = places or [joint_positions(motion) for motion in motions]
    ways = [cloud[:, 0] * [1, 0, 1] for cloud in clouds]
    figure = Figure(figsize=(WIDTH, LOW), layout="constrained")
    ax = figure.add_subplot(aspect="equal", anchor="S")  # what is left over is the legend's
    look = _draw_floor(ax, np.concatenate([*ways, asked]))
    ax.add_collection(PolyCollection(list(rims(discs) @ look[:2].T), facecolors=QUIET, zorder=0.5))
    lines = [(asked, ASKED, "asked path", 4.0)] if len(asked) else []
    named = len(motions) == 1 or len({motion.name for motion in motions}) > 1  # colours need different names
    together = np.linspace(0, min(map(len, motions)) - 1, 3).astype(int)  # of a group, the same three moments
    for number, (motion, cloud, way) in enumerate(zip(motions, clouds, ways, strict=True)):
        own = own_colour(number, len(motions))
        spans = _spans(motion, sources if number == 0 else (), own, named)
        lines += [(way[start : end + 1], colour or PATH, name, 1.6) for start, end, colour, name in spans]
        for frame in together if len(motions) > FEW else _chosen(way):
            (colour,) = [colour for start, end, colour, _ in spans if start <= frame < end]
            near = 4 - float(np.tanh(look[2] @ cloud[frame, 0] / 50))  # over those that are farther
            head = {"markersize": 7, "zorder": near, "clip_on": False}
            points = cloud[frame] @ look[:2].T
            draw_body(ax, motion.skeleton, points, colour=colour, head=head, linewidths=2, zorder=near)
    for way, colour, name, wide in lines:
        ax.plot(*look[:2] @ way.T, color=colour, linewidth=wide, label=name, zorder=1)
    if len(marked := np.asarray(list(seams), int)):
        ax.plot(*look[:2] @ ways[0][marked].T, "D", color=MARK, markersize=6, label="seam", zorder=2)
    return _frame(ax, figure)


def _spans(
    motion: Motion, sources: Sequence[tuple[int, str]], colour: str | None, named: bool
) -> list[tuple[int, int, str | None, str]]:
    """List the stretches of a motion that have one colour: their frames [start, end), colour and name."""
    if not sources:
        return [(0, len(motion), colour, motion.name * named if colour else "walked path")]
    colours = source_colours([name for _, name in sources])
    ends = [*(frame for frame, _ in sources[1:]), len(motion)]
    return [(start, end, colours[name], name) for (start, name), end in zip(sources, ends, strict=True)]


def _draw_floor(ax: Axes, ground: Array) -> Array:
    """Choose where to look from, so that the longest way over the ground runs across; draw squares of 1 m.

    They are 10, 100, ... m wide rather than more than a thousand in a row. Returned are the picture's
    directions across, up and away from the camera, as rows of (3, 3).
    """
    across = np.linalg.svd(ground - ground.mean(axis=0), full_matrices=False)[2][0]
    across = -across if (ground[-1] - ground[0]) @ across < 0 else across
    away = np.cross([0, 1, 0], across)
    floor = np.stack([across, away])
    low, high = (f(ground @ floor.T, axis=0) for f in (np.min, np.max))
    cell = 10.0 ** np.ceil(np.log10(max((high - low).max() / 1000, 1.0)))
    low, high = np.floor(low / cell - 0.5), np.ceil(high / cell + 0.5)
    grid = [((x, low[1]), (x, high[1])) for x in np.arange(low[0], high[0] + 1)]
    grid += [((low[0], z), (high[0], z)) for z in np.arange(low[1], high[1] + 1)]
    look = np.stack([across, np.cos(RISE) * np.array([0, 1, 0]) + np.sin(RISE) * away, away])
    lines = cell * np.array(grid) @ floor @ look[:2].T
    ax.add_collection(LineCollection(list(lines), colors=FLOOR, linewidths=0.8, zorder=0))
    return look


def _frame(ax: Axes, figure: Figure) -> Figure:
    """Make the picture as high as what it shows, and name each colour above it, once."""
    ax.set_axis_off()
    ax.margins(0.02, 0.04)
    ax.autoscale_view()
    wide, high = np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim())
    handles, names = ax.get_legend_handles_labels()
    named = dict(zip(names, handles, strict=True))
    words = 0.5 + 0.32 * -(-len(named) // COLUMNS)  # inches
    figure.set_size_inches(WIDTH, float(np.clip(WIDTH * high / wide + words, LOW, HIGH)))
    if named:
        how: dict[str, Any] = {"loc": "outside upper left", "fontsize": 9, "frameon": False}
        figure.legend(list(named.values()), list(named), ncols=min(COLUMNS, len(named)), **how)
    ax.text(
        1, 0, "lines 1 m apart", transform=ax.transAxes, ha="right", va="top", fontsize=8, color="#666666"
    )
    return figure


def _chosen(way: Array) -> list[int]:
    """Choose frames of a path over the ground, shape (F, 3), whose places are far enough from each other."""
    apart, chosen = APART, [0]
    while True:
        for frame, place in enumerate(way):
            if np.linalg.norm(way[chosen] - place, axis=-1).min() > apart:
                chosen.append(frame)
        if len(chosen) <= MOST:
            return chosen
        apart, chosen = 1.15 * apart, [0]


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
