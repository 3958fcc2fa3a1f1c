"""Charts: distance images, paths and footprints seen from above, curves over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike, NDArray

from mocap.body.motion import Motion
from mocap.feet.footprints import Footprint
from mocap.plotting.style import ASKED, COLOURS, CURVES, MARK, PATH


def distance_image(
    grid: NDArray[np.floating[Any]],
    *,
    fps: float,
    minima: ArrayLike = (),
    names: Sequence[str] = ("", ""),
    ax: Axes | None = None,
) -> AxesImage:
    """Draw a distance grid, dark where the windows are alike, with its minima marked [KGP02, Fig. 3].

    Parameters
    ----------
    grid : D, shape (n, m), m²; the colours show its square root, in centimetres.
    fps : frames per second; the axes are in seconds.
    minima : the places to mark, rows and columns, shape (N, 2).
    names : of the clip along the rows, and of the clip along the columns.
    ax : axes; new ones by default.

    Returns
    -------
    The image.

    Examples
    --------
    >>> from mocap import plotting
    >>> image = distance_image(np.array([[0.04, 0.01], [0.09, 0.16]]), fps=30, minima=[(0, 1)])
    >>> image.get_array().round(3).tolist()  # cm
    [[20.0, 10.0], [30.0, 40.0]]
    >>> plotting.show(image, alt="Four distances, the least of them marked.")
    Picture('Four distances, the least of them marked.')

    Notebook: 02b-distance-grids
    """
    ax = ax or plt.figure(figsize=(5, 4.2), layout="constrained").add_subplot()
    seconds = (0, grid.shape[1] / fps, grid.shape[0] / fps, 0)
    centimetres = 100 * np.sqrt(grid, dtype=np.float32)  # half the bytes, so the image is drawn faster
    image = ax.imshow(centimetres, cmap="cividis", extent=seconds, interpolation="nearest")
    rows, columns = np.reshape(minima, (-1, 2)).T
    ax.plot((columns + 0.5) / fps, (rows + 0.5) / fps, ".", color="#FFFFFF", markersize=4, label="minima")
    ax.set(xlabel=f"{names[1]} (s)".strip(), ylabel=f"{names[0]} (s)".strip(), aspect="equal")
    ax.figure.colorbar(image, ax=ax, label="RMS distance (cm)", shrink=0.8)
    return image


def path_from_above(
    motion: Motion, *, seams: ArrayLike = (), colour: str = PATH, ax: Axes | None = None
) -> list[Line2D]:
    """Draw the root's path on the ground, seen from above: z upwards, x to the left, as seen from behind.

    Parameters
    ----------
    motion : the motion.
    seams : frames to mark.
    colour : of the path.
    ax : axes; new ones by default.

    Returns
    -------
    The path, the start, and the seams.

    Examples
    --------
    >>> from mocap import datasets, plotting
    >>> drawn = path_from_above(datasets.sample("walk_circle"), seams=[300, 600])
    >>> plotting.show(drawn, alt="A circle seen from above, with two seams.")
    Picture('A circle seen from above, with two seams.')

    Notebook: 00-quickstart
    """
    ax = _from_above(ax)
    x, z = motion.root_positions[:, [0, 2]].T
    at = np.asarray(seams, int)
    lines = ax.plot(x, z, color=colour, linewidth=2, label=motion.name)
    lines += ax.plot(x[:1], z[:1], "o", color=COLOURS["middle"], markersize=6)
    lines += ax.plot(x[at], z[at], "D", color=MARK, markersize=5, label="seams" if len(at) else None)
    return lines


def footprints(prints: Sequence[Footprint], *, ax: Axes | None = None) -> PathCollection:
    """Draw where feet stood, seen from above: left and right in their colours, longer stands larger.

    Parameters
    ----------
    prints : as from `feet.find_footprints`.
    ax : axes, as from `path_from_above`; new ones by default.

    Returns
    -------
    The discs, one per footprint.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> steps = [Footprint("lfoot", "left", 0, 20, 0.1, 0.0), Footprint("rfoot", "right", 18, 40, -0.1, 0.6)]
    >>> footprints(steps, ax=Figure().add_subplot()).get_offsets().tolist()  # (x, z)
    [[0.1, 0.0], [-0.1, 0.6]]

    Notebook: 01b-motion-files
    """
    ax = _from_above(ax)
    at = np.array([(step.x, step.z) for step in prints]).reshape(-1, 2)
    sizes = [12 + 40 * (1 - np.exp(-(step.end - step.start) / 60)) for step in prints]
    colours = [COLOURS[step.side] for step in prints]
    return ax.scatter(at[:, 0], at[:, 1], s=sizes, facecolors=colours, alpha=0.6, linewidths=0, zorder=3)


def asked_and_walked(path: ArrayLike, motion: Motion, *, ax: Axes | None = None) -> list[Line2D]:
    """Draw the path that was asked for, in black, under the path that was walked [KGP02, Fig. 6].

    Parameters
    ----------
    path : the path asked for, shape (N, 2), points (x, z), metres.
    motion : the walk.
    ax : axes; new ones by default.

    Returns
    -------
    The path asked for, the path walked, and its start.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")
    >>> asked, walked, start = asked_and_walked([(0, 0), (0, 10)], walk, ax=Figure().add_subplot())
    >>> asked.get_label(), walked.get_label()
    ('asked for', 'walked')

    Notebook: 08-path-synthesis
    """
    ax = _from_above(ax)
    asked = ax.plot(*np.transpose(path), color=ASKED, linewidth=5, alpha=0.85, label="asked for")
    walked = path_from_above(motion, ax=ax)
    walked[0].set_label("walked")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
    return [*asked, *walked[:2]]


def joint_curve(
    values: ArrayLike,
    *,
    fps: float,
    seams: ArrayLike = (),
    labels: Sequence[str] = (),
    ax: Axes | None = None,
) -> list[Line2D]:
    """Draw a joint's values over time, with the seams shaded: there a curve must not jump or bend sharply.

    Parameters
    ----------
    values : shape (F,) or (F, K), such as a joint's heights or its angles.
    fps : frames per second.
    seams : transitions, shape (N, 2), as frames [start, end).
    labels : the names of the K curves, with their units.
    ax : axes; new ones by default.

    Returns
    -------
    The K curves.

    Examples
    --------
    >>> from mocap import plotting
    >>> (curve,) = joint_curve([0.0, 2.0, 3.0, 3.0], fps=10, seams=[(1, 3)], labels=["height (cm)"])
    >>> curve.get_xdata().tolist()  # seconds
    [0.0, 0.1, 0.2, 0.3]
    >>> plotting.show(curve, alt="A height that rises across a seam.")
    Picture('A height that rises across a seam.')

    Notebook: 02-matching
    """
    ax = ax or plt.figure(figsize=(6, 2.8), layout="constrained").add_subplot()
    columns = np.reshape(values, (len(np.asarray(values)), -1))
    for start, end in np.reshape(seams, (-1, 2)) / fps:
        ax.axvspan(start, end, color=MARK, alpha=0.25, linewidth=1)
    curves = ax.plot(np.arange(len(columns)) / fps, columns, linewidth=1.6)
    for number, curve in enumerate(curves):
        curve.set_color(CURVES[number % len(CURVES)])
    for curve, label in zip(curves, labels, strict=False):
        curve.set_label(label)
    if len(labels) > 1:
        ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=len(labels))
    ax.set(xlabel="time (s)", ylabel=labels[0] if len(labels) == 1 else None)
    ax.spines[["top", "right"]].set_visible(False)
    return curves


def _from_above(ax: Axes | None) -> Axes:
    """Make axes for the ground seen from above: y points at the viewer, so with z upwards x goes left."""
    ax = ax or plt.figure(figsize=(4.5, 4.5), layout="constrained").add_subplot()
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.xaxis.set_inverted(True)
    return ax
