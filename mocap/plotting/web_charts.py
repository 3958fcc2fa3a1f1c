"""Charts of match webs: paths over a grid, matches step by step, samples of a space and a wish."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.quiver import Quiver
from numpy.typing import ArrayLike, NDArray

from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.methods.match_webs.match_search import Match
from mocap.plotting.stick_figures import bones
from mocap.plotting.style import ASKED, ASTRAY, COLOURS, PATH, QUIET, source_colours


class WebPicture(NamedTuple):
    """The grid, the cells that are marked, and the paths."""

    grid: AxesImage
    cells: Line2D
    paths: LineCollection


def web_image(
    grid: NDArray[np.floating[Any]],
    *,
    marks: ArrayLike | None = None,
    paths: Sequence[ArrayLike] = (),
    rate: float = 30.0,
    ax: Axes | None = None,
) -> WebPicture:
    """Draw the distances of two clips, dark where they are alike, with marked cells and paths.

    Parameters
    ----------
    grid : √D, shape (n, m), metres.
    marks : cells to mark with dots, booleans of shape (n, m), such as from `minima_1d`.
    paths : cells (row, column) of each path, shape (N, 2).
    rate : windows per second; the axes are in seconds.
    ax : axes; new ones by default.

    Examples
    --------
    >>> drawn = web_image(np.array([[0.02, 0.1], [0.1, 0.03]]), paths=[[(0, 0), (1, 1)]], rate=10)
    >>> drawn.paths.get_segments()[0].tolist()
    [[0.05, 0.05], [0.15, 0.15]]

    Notebook: 16-match-webs
    """
    ax = ax or plt.figure(figsize=(6, 4), layout="constrained").add_subplot()
    extent = 0, grid.shape[1] / rate, grid.shape[0] / rate, 0
    image = ax.imshow(
        100 * np.asarray(grid, np.float32), cmap="cividis", extent=extent, interpolation="nearest"
    )
    rows, columns = np.nonzero(np.zeros(grid.shape, bool) if marks is None else np.asarray(marks))
    (cells,) = ax.plot((columns + 0.5) / rate, (rows + 0.5) / rate, ".", ms=2, mew=0, color="#FFFFFF")
    lines = [(np.asarray(path)[:, ::-1] + 0.5) / rate for path in paths]
    drawn = LineCollection(lines, colors=PATH, linewidths=2)
    ax.add_collection(drawn)
    ax.set(xlabel="(s)", ylabel="(s)", aspect="equal")
    ax.figure.colorbar(image, ax=ax, label="RMS distance (cm)", shrink=0.8)
    return WebPicture(image, cells, drawn)


class MatchTree(NamedTuple):
    """The matches, those among them that are wrong, and who found whom."""

    matches: PathCollection
    wrong: PathCollection
    links: LineCollection


def match_tree(
    matches: Sequence[Match],
    kinds: Sequence[str],
    *,
    wrong: Sequence[bool] | None = None,
    order: Sequence[str] = (),
    ax: Axes | None = None,
) -> MatchTree:
    """Draw a search step by step: the query at the left, and each match right of the one that found it.

    Parameters
    ----------
    matches : as from `search`.
    kinds : what each match is; each kind has its own colour.
    wrong : which matches are not what was asked for; they get a cross.
    order : all kinds that may come, so that each keeps its colour from picture to picture.
    ax : axes; new ones by default.

    Examples
    --------
    >>> at = np.arange(2.0)
    >>> found = [Match(0, 0, 9, 0.0, -1, 0, at, at), Match(1, 3, 12, 0.02, 0, 1, at, at)]
    >>> match_tree(found, ["slow", "brisk"]).links.get_segments()[0].tolist()
    [[0.0, 0.0], [1.0, 0.0]]

    Notebook: 16-match-webs
    """
    ax = ax or plt.figure(figsize=(7, 4), layout="constrained").add_subplot()
    places = _tree_places(matches)
    colours = source_colours([*order, *kinds])
    links = [(places[match.via], places[n]) for n, match in enumerate(matches) if match.via >= 0]
    lines = LineCollection(links, colors=QUIET, linewidths=0.8, zorder=0)
    ax.add_collection(lines)
    dots = ax.scatter(places[:, 0], places[:, 1], s=26, color=[colours[kind] for kind in kinds])
    bad = np.zeros(len(matches), bool) if wrong is None else np.asarray(wrong, bool)
    crosses = ax.scatter(
        places[bad, 0], places[bad, 1], s=60, color=ASTRAY, marker="x", label="wrong" if bad.any() else None
    )
    for kind, colour in colours.items():
        ax.plot([], [], "o", color=colour, label=kind)
    ax.legend(frameon=False, loc="upper left", bbox_to_anchor=(1, 1))
    ax.set(xlabel="step", yticks=[], xlim=(-0.3, max(places[:, 0].max(), 1) + 0.3))
    ax.set_xticks(range(int(places[:, 0].max()) + 1))
    ax.spines[["left", "top", "right"]].set_visible(False)
    return MatchTree(dots, crosses, lines)


def _tree_places(matches: Sequence[Match]) -> NDArray[np.float64]:
    """Place each match at its step; within a step as its finders stand, from the middle to both sides."""
    places = np.zeros((len(matches), 2))
    for step in range(1, 1 + max(match.generation for match in matches)):
        inside = [n for n, match in enumerate(matches) if match.generation == step]
        inside.sort(key=lambda n: (places[matches[n].via, 1], n))
        heights = np.arange(len(inside)) - (len(inside) - 1) / 2
        places[inside] = np.column_stack([np.full(len(inside), step), heights])
    return places


class SpacePicture(NamedTuple):
    """The samples, the examples, and arrows from the wishes to what was got."""

    samples: PathCollection
    examples: PathCollection
    wishes: PathCollection
    arrows: Quiver


def space_image(
    values: ArrayLike,
    examples: int,
    *,
    wishes: ArrayLike = (),
    got: ArrayLike = (),
    ax: Axes | None = None,
) -> SpacePicture:
    """Draw what the samples of a space do, and arrows from wishes to what their blends do.

    Parameters
    ----------
    values : two numbers of each sample, shape (N, 2).
    examples : how many of them, the first ones, are the examples.
    wishes, got : shape (M, 2).
    ax : axes; new ones by default.

    Examples
    --------
    >>> drawn = space_image([[0, 1], [2, 3], [1, 2]], 2, wishes=[[1, 1]], got=[[1, 2]])
    >>> len(drawn.samples.get_offsets()), len(drawn.examples.get_offsets())
    (1, 2)

    Notebook: 16-match-webs
    """
    ax = ax or plt.figure(figsize=(5.6, 4.4), layout="constrained").add_subplot()
    across, up = np.asarray(values, float).T
    asked, given = (np.reshape(np.asarray(each, float), (-1, 2)).T for each in (wishes, got))
    dots = ax.scatter(across[examples:], up[examples:], s=8, color=QUIET, label="samples")
    large = ax.scatter(across[:examples], up[:examples], s=42, color=COLOURS["middle"], label="examples")
    crosses = ax.scatter(asked[0], asked[1], s=70, color=ASKED, marker="+", label="asked", zorder=3)
    in_data: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.008}
    arrows = ax.quiver(*asked, *(given - asked), color=PATH, zorder=2, **in_data)
    ax.scatter(given[0], given[1], s=26, color=PATH, label="got", zorder=3)
    return SpacePicture(dots, large, crosses, arrows)


def target_poses(
    motions: Sequence[Motion], frames: Sequence[int], *, targets: ArrayLike, columns: int
) -> list[Axes]:
    """Draw one pose of each motion from behind, row by row, each with the place that was asked for.

    Parameters
    ----------
    motions : each standing over the origin and facing +z at its start.
    frames : which frame of each.
    targets : (x, y) of each, metres; x grows to the left of the body, which is the left of the picture.
    columns : of the grid.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")
    >>> len(target_poses([walk, walk], [0, 60], targets=[[0, 1], [0, 1]], columns=2))
    2

    Notebook: 16-match-webs
    """
    rows = -(-len(motions) // columns)
    figure = plt.figure(figsize=(1.7 * columns, 1.9 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel().tolist()
    starts, ends, sides = bones(motions[0].skeleton)
    colours = [COLOURS[side] for side in sides]
    for ax, motion, frame, target in zip(axes, motions, frames, np.asarray(targets), strict=False):
        points = joint_positions(motion[frame : frame + 1])[0, :, :2]
        lines = list(np.stack([points[starts], points[ends]], axis=1))
        ax.add_collection(LineCollection(lines, colors=colours, linewidths=1.6))
        ax.plot(*target, "+", color=ASKED, markersize=11, markeredgewidth=1.8)
        ax.set(aspect="equal", xlim=(1.0, -1.0), ylim=(0, 1.95))
    figure.supxlabel("to the left (m)")
    figure.supylabel("up (m)")
    return axes
