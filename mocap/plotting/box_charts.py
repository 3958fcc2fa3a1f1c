"""Charts of parametric motion graphs: what may follow one source, and the boxes of all sources."""

from __future__ import annotations

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike

from mocap.plotting.style import ASTRAY, CURVES, MARK, QUIET


class BoxPicture(NamedTuple):
    """The targets as dots, and the box."""

    targets: PathCollection
    box: Rectangle


def box_chart(
    targets: ArrayLike,
    costs: ArrayLike,
    box: tuple[float, float],
    *,
    limits: tuple[float, float],
    ax: Axes | None = None,
) -> BoxPicture:
    """Draw what it costs to follow one source with each target, and the box of those that may follow.

    Parameters
    ----------
    targets : shape (N,), parameters, such as degrees of turn.
    costs : shape (N,), centimetres.
    box : its low and its high end.
    limits : T_GOOD and T_BAD, centimetres: dots are good up to the first, bad above the second.
    ax : axes; new ones by default.

    Examples
    --------
    >>> drawn = box_chart([-30, 0, 30], [5.0, 2, 2.5], (-5, 30), limits=(3, 4))
    >>> len(drawn.targets.get_offsets())
    3

    Notebook: 17-parametric-graphs
    """
    ax = ax or plt.figure(figsize=(6.4, 3), layout="constrained").add_subplot()
    targets, costs = np.asarray(targets, float), np.asarray(costs, float)
    good, bad = limits
    colours = np.where(costs <= good, CURVES[0], np.where(costs > bad, ASTRAY, QUIET))
    shaded = ax.axvspan(*box, color=CURVES[0], alpha=0.15)
    dots = ax.scatter(targets, costs, s=12, c=colours.tolist())
    for limit, name in ((good, "T_GOOD"), (bad, "T_BAD")):
        ax.axhline(limit, color=QUIET, linewidth=1, linestyle="dashed")
        ax.annotate(name, (1.0, limit), xycoords=("axes fraction", "data"), va="center", fontsize=8)
    ax.set(ylabel="cost (cm)")
    return BoxPicture(dots, shaded)


class BoxesPicture(NamedTuple):
    """The costs of all pairs as an image, and the low and the high sides of the boxes."""

    costs: AxesImage
    sides: list[Line2D]


def boxes_image(
    costs: ArrayLike, ends: tuple[float, float], boxes: ArrayLike, *, ax: Axes | None = None
) -> BoxesPicture:
    """Draw what it costs that a target follows a source, for all pairs, with each source's box.

    Parameters
    ----------
    costs : shape (S, T), centimetres, of S sources and T targets evenly spaced between the ends.
    ends : of sources and targets, such as degrees of turn.
    boxes : shape (S, 2), the low and the high end of each source's box.
    ax : axes; new ones by default.

    Examples
    --------
    >>> drawn = boxes_image(np.ones((3, 5)), (-60, 60), [[-60, 0], [-30, 30], [0, 60]])
    >>> drawn.sides[1].get_ydata().tolist()
    [0.0, 30.0, 60.0]

    Notebook: 17-parametric-graphs
    """
    ax = ax or plt.figure(figsize=(5.4, 4.2), layout="constrained").add_subplot()
    costs, boxes = np.asarray(costs, float), np.asarray(boxes, float)
    image = ax.imshow(
        costs.T, cmap="cividis", extent=(*ends, *ends), origin="lower", interpolation="nearest", aspect="auto"
    )
    at = np.linspace(*ends, len(boxes))
    sides = [ax.plot(at, side, color=MARK, linewidth=2)[0] for side in boxes.T]
    ax.figure.colorbar(image, ax=ax, label="cost (cm)", shrink=0.9)
    return BoxesPicture(image, sides)
