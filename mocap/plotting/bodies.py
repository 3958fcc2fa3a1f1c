"""Bodies as lines on flat axes: poses, film strips, and whole walks in a picture, as in [KGP02, Fig. 1]."""

from collections.abc import Iterable, Sequence
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arguments import checked_by
from mocap._shared.arrays import Array, Indices
from mocap._shared.quantities import described
from mocap._shared.records import NamedTuple
from mocap.body import Motion, Skeleton, joint_positions
from mocap.body.body_sides import head_joints, sides
from mocap.body.motion import require_motion
from mocap.errors import MocapError
from mocap.matching.point_clouds import distinct_joints
from mocap.plotting.props import rims
from mocap.plotting.style import (
    ASKED,
    COLOURS,
    FLOOR,
    MARK,
    PATH,
    QUIET,
    distinct_names,
    own_colour,
    source_colours,
)

# The directions across and up of an oblique view from the right, front and above, as rows (x, y, z).
ASLANT = np.array([[0.57, 0, 0.82], [-0.2, 0.97, 0.14]])


def bones(skeleton: Skeleton) -> tuple[Indices, Indices, NDArray[np.str_]]:
    """Return the B bones of a body as lines: their start joints, end joints and sides, shapes (B,).

    Joints at the same position share one line. The line from a parent to its child is the parent's bone, and
    therefore has the parent's side.

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
    return starts, ends, np.array(sides(skeleton), str)[starts]


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
    points : the positions of its joints on the axes, shape (J, 2).
    colour : the colour of all bones, by default that of their sides.
    head : options of the dot for the head, such as {"markersize": 8}. By default there is no dot.
    look : options of the bones, such as `linewidths` and `alpha`.

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
        dot = {"color": colour or COLOURS["middle"]} | head
        ax.plot(*points[head_joints(skeleton)[-1:]].T, "o", **dot)
    return body


def _require_frames(
    motion: object = None, frames: object = None, view: object = "side", *_looks: object, **_options: object
) -> None:
    """Raise unless the arguments are a motion, a list of its frames, and a known view."""
    count = len(require_motion(motion))
    example = f"such as flat_bodies(motion, [0, {count - 1}])"
    if isinstance(frames, int | str) or not isinstance(frames, Iterable):
        raise MocapError(f"This takes a list of frames, {example}, got {described(frames)}.")
    for frame in frames:
        if not isinstance(frame, int | np.integer) or not -count <= frame < count:
            raise MocapError(f"Frames are whole numbers from 0 to {count - 1}, {example}, got {frame}.")
    if view not in ("side", "front"):
        raise MocapError(f"view is 'side' or 'front', got {described(view)}; axes are given as ax=.")


@checked_by(_require_frames)
def flat_bodies(
    motion: Motion,
    frames: Sequence[int],
    view: Literal["side", "front"] = "side",
    alpha: float = 1.0,
    ax: Axes | None = None,
) -> Axes:
    """Draw poses of a motion on flat axes at their positions: z or x to the right, y upwards, metres.

    Parameters
    ----------
    motion : a walk along z.
    frames : the frames to draw.
    view : "side", with z to the right, or "front", with x to the right. From the front, the walker comes
        towards the reader, so the left side of the body, at +x, is on the right.
    alpha : opacity, 1 for solid bodies, less for ghosts.
    ax : flat axes, by default new ones.

    Raises
    ------
    MocapError : for objects that are not motions, frames outside the motion, and another view.

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
    """Draw poses of one or more motions side by side, at times evenly spread over the first motion.

    Parameters
    ----------
    motions : one or more. Positions are relative to the root of the first motion.
    count : the number of poses, or fewer if the first motion has fewer frames.

    Returns
    -------
    A figure that pyplot does not manage, so that it need not be closed.

    Examples
    --------
    >>> from mocap import datasets
    >>> strip = film_strip([datasets.sample("walk_straight")], count=3)
    >>> [ax.get_title() for ax in strip.axes]
    ['0.00 s', '4.82 s', '9.64 s']
    """
    first = motions[0]
    positions = [joint_positions(motion) for motion in motions]
    frames = np.unique(np.linspace(0, len(first) - 1, count).round().astype(int))
    figure = Figure(figsize=(1.5 * len(frames), 1.75))
    panels = figure.subplots(1, len(frames), sharex=True, sharey=True, squeeze=False)[0]
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.86, 0.0)
    for ax, frame in zip(panels, frames, strict=True):
        origin = positions[0][frame, 0] * [1, 0, 1]  # below the root of the first motion
        for number, (motion, points) in enumerate(zip(motions, positions, strict=True)):
            pose = points[min(len(points) - 1, round(frame / first.fps * motion.fps))]
            flat = (pose - origin) @ ASLANT.T
            look: dict[str, Any] = {"head": {"markersize": 5}, "linewidths": 1.6}
            draw_body(ax, motion.skeleton, flat, colour=own_colour(number, len(motions)), **look)
        ax.set_title(f"{frame / first.fps:.2f} s", fontsize=9)
        ax.set_aspect("equal")
        ax.set_axis_off()
        ax.autoscale_view()
    return figure


WIDTH = 9.0  # inches
LOW = 1.9  # inches, the least height of the picture
HIGH = 4.6  # inches, the greatest height of the picture
RISE = np.radians(24)  # the angle at which the camera looks down
COLUMNS = 4  # columns of the legend
MOST = 15  # largest number of bodies, because more would hide each other
FEW = 3  # characters: for more than these, the bodies at the same moments are drawn
APART = 0.7  # metres, the least distance between two bodies
VERTICAL = np.array([0, 1, 0])  # the direction upwards
ACROSS = 0  # row of a view
DEPTH = 2  # row of a view
FLAT = slice(0, 2)  # rows of a view, across and up
WIDENING = 1.15  # the factor by which the least distance grows while there are too many bodies


def bodies_along(
    *motions: Motion,
    sources: Sequence[tuple[int, str]] = (),
    seams: Iterable[int] = (),
    path: ArrayLike = (),
    discs: ArrayLike = (),
    positions: Sequence[Array] = (),
) -> Figure:
    """Draw motions as bodies along their paths, evenly spread over the ground, seen from the side and above.

    Parameters
    ----------
    motions : one or more characters. Sources and seams are those of the first. More than three characters are
        drawn at the same three moments, to show the group.
    sources : pairs (first frame, name of the clip), as from `synthesis.sources`, which define the colours of
        bodies and path. Without them, one character has the colours of left and right, and each of several
        has a colour of its own.
    seams : frames at which a transition starts, marked on the path.
    path : the requested path, shape (N, 2), points (x, z) in metres.
    discs : obstacles on the ground, shape (N, 3), x, z and radius in metres.
    positions : the joint positions of each motion, shape (F, J, 3), by default those of `joint_positions`.

    Returns
    -------
    A figure that pyplot does not manage, so that it need not be closed.

    Examples
    --------
    >>> from mocap import datasets
    >>> figure = bodies_along(datasets.sample("walk_straight"), seams=[300])
    >>> [text.get_text() for text in figure.legends[0].get_texts()]
    ['walked path', 'seam']
    """
    request = np.insert(np.reshape(np.asarray(path, float), (-1, 2)), 1, 0.0, axis=-1)
    positions = positions or [joint_positions(motion) for motion in motions]
    paths = [joints[:, 0] * [1, 0, 1] for joints in positions]
    figure = Figure(figsize=(WIDTH, LOW), layout="constrained")
    ax = figure.add_subplot(aspect="equal", anchor="S")  # the rest of the height is for the legend
    ground = np.concatenate([*paths, request])
    view = _view(ground)
    _draw_floor(ax, view, ground)
    ax.add_collection(PolyCollection(list(rims(discs) @ view[FLAT].T), facecolors=QUIET, zorder=0.5))
    count = len({name for _, name in sources})
    spans = [[_whole(motions, number, count)] for number in range(len(motions))]
    if sources:
        spans[0] = _spans_of_sources(sources, len(motions[0]))
    moments = np.linspace(0, min(map(len, motions)) - 1, 3).astype(int)
    for number, motion in enumerate(motions):
        for frame in moments if len(motions) > FEW else _spaced(paths[number]):
            colour = _colour_of(spans[number], frame)
            _draw_pose(ax, view, motion.skeleton, positions[number][frame], colour)
    if len(request):
        _draw_path(ax, view, request, color=ASKED, label="asked path", linewidth=4.0)
    for walked, stretches in zip(paths, spans, strict=True):
        _draw_spans(ax, view, walked, stretches)
    marks = paths[0][np.asarray(list(seams), int)]
    if len(marks):
        ax.plot(*view[FLAT] @ marks.T, "D", color=MARK, markersize=6, label="seam", zorder=2)
    return _frame(ax, figure)


class _Span(NamedTuple):
    """Frames [start, end) of a motion that have one colour, None for the colours of the body's sides."""

    start: int
    end: int
    colour: str | None
    name: str  # entry in the legend, "" for none


def _whole(motions: Sequence[Motion], number: int, sources: int) -> _Span:
    """Return a whole motion as one span, with a name of its own for one of several motions."""
    name = "walked path"
    if len(motions) > 1:
        name = distinct_names([motion.name for motion in motions])[number]
    return _Span(0, len(motions[number]), own_colour(number, len(motions), sources), name)


def _spans_of_sources(sources: Sequence[tuple[int, str]], count: int) -> list[_Span]:
    """Return a span for each source of a motion of `count` frames."""
    colours = source_colours([name for _, name in sources])
    ends = [*(start for start, _ in sources[1:]), count]
    return [_Span(start, end, colours[name], name) for (start, name), end in zip(sources, ends, strict=True)]


def _colour_of(spans: Sequence[_Span], frame: int) -> str | None:
    """Return the colour of the span that contains a frame."""
    (colour,) = [span.colour for span in spans if span.start <= frame < span.end]
    return colour


def _draw_path(ax: Axes, view: Array, path: Array, **look: Any) -> None:  # noqa: ANN401 (of matplotlib's lines)
    """Draw a path on the ground, shape (F, 3)."""
    ax.plot(*view[FLAT] @ path.T, zorder=1, **look)


def _draw_spans(ax: Axes, view: Array, path: Array, spans: Sequence[_Span]) -> None:
    """Draw a walked path, each span in its colour."""
    for span in spans:
        points = path[span.start : span.end + 1]
        _draw_path(ax, view, points, color=span.colour or PATH, label=span.name, linewidth=1.6)


def _draw_pose(ax: Axes, view: Array, skeleton: Skeleton, joints: Array, colour: str | None) -> None:
    """Draw a body with joint positions (J, 3), in front of the bodies that are farther from the camera."""
    depth = view[DEPTH] @ joints[0]
    zorder = 4 - float(np.tanh(depth / 50))
    head = {"markersize": 7, "zorder": zorder, "clip_on": False}
    draw_body(ax, skeleton, joints @ view[FLAT].T, colour=colour, head=head, linewidths=2, zorder=zorder)


def _view(ground: Array) -> Array:
    """Return a view in which the longest extent of points (N, 3) on the ground is horizontal in the picture.

    Its rows are the directions across and up in the picture, and away from the camera along the ground.
    """
    across = np.linalg.svd(ground - ground.mean(axis=0), full_matrices=False)[2][0]
    across = -across if (ground[-1] - ground[0]) @ across < 0 else across
    depth = np.cross(VERTICAL, across)
    up = np.cos(RISE) * VERTICAL + np.sin(RISE) * depth
    return np.stack([across, up, depth])


def _draw_floor(ax: Axes, view: Array, ground: Array) -> None:
    """Draw squares of 1 m below points (N, 3), or of 10, 100, ... m so that a row has at most a thousand."""
    floor = view[[ACROSS, DEPTH]]
    low = np.min(ground @ floor.T, axis=0)
    high = np.max(ground @ floor.T, axis=0)
    cell = 10.0 ** np.ceil(np.log10(max((high - low).max() / 1000, 1.0)))
    x_low, z_low = np.floor(low / cell - 0.5)
    x_high, z_high = np.ceil(high / cell + 0.5)
    lines = [((x, z_low), (x, z_high)) for x in np.arange(x_low, x_high + 1)]
    lines += [((x_low, z), (x_high, z)) for z in np.arange(z_low, z_high + 1)]
    flat = cell * np.array(lines) @ floor @ view[FLAT].T
    ax.add_collection(LineCollection(list(flat), colors=FLOOR, linewidths=0.8, zorder=0))
    note = f"lines {cell:g} m apart"
    ax.text(1, 0, note, transform=ax.transAxes, ha="right", va="top", fontsize=8, color="#666666")


def _frame(ax: Axes, figure: Figure) -> Figure:
    """Fit the height of the figure to its content, and add a legend above it.

    A name has an entry for each of its colours.
    """
    ax.set_axis_off()
    ax.margins(0.02, 0.04)
    ax.autoscale_view()
    width = np.ptp(ax.get_xlim())
    height = np.ptp(ax.get_ylim())
    handles, names = ax.get_legend_handles_labels()
    pairs = [(name, str(plt.getp(handle, "color"))) for name, handle in zip(names, handles, strict=True)]
    entries = dict(zip(pairs, handles, strict=True))
    legend_height = 0.5 + 0.32 * -(-len(entries) // COLUMNS)  # inches
    figure.set_size_inches(WIDTH, float(np.clip(WIDTH * height / width + legend_height, LOW, HIGH)))
    if entries:
        look: dict[str, Any] = {"loc": "outside upper left", "fontsize": 9, "frameon": False}
        figure.legend(
            list(entries.values()), [name for name, _ in entries], ncols=min(COLUMNS, len(entries)), **look
        )
    return figure


def _spaced(path: Array) -> list[int]:
    """Choose frames of a path on the ground, shape (F, 3), at a minimum distance from each other.

    The minimum distance is `APART`, or larger if there would be more than `MOST` frames.
    """
    distance = APART
    while True:
        chosen = [0]
        for frame, position in enumerate(path):
            if np.linalg.norm(path[chosen] - position, axis=-1).min() > distance:
                chosen.append(frame)
        if len(chosen) <= MOST:
            return chosen
        distance *= WIDENING
