"""The ground seen from above: headings, and how one clip is aligned with another."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap.body import Motion, PlanarTransform, heading
from mocap.course.diagrams.pens import arrow, say, trace
from mocap.plotting.style import COLOURS, CURVES, FLOOR, SOURCES

INK = COLOURS["middle"]


def alignment(
    target: Motion, moving: Motion, transform: PlanarTransform, *, step: int = 3, shift_first: bool = False
) -> Figure:
    """Draw how a clip is aligned with another, seen from above: first it is turned, then it is moved.

    Parameters
    ----------
    target : the motion up to the moment at which the clips match; it stays.
    moving : the other motion from that moment on.
    transform : the planar transform that aligns `moving`.
    step : how many of the three panels are drawn.
    shift_first : exchange the turn and the shift, which leads to another place.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")
    >>> figure = alignment(walk[:120], walk[121:300], PlanarTransform(0.0, 0.0, 0.0), step=1)
    >>> [ax.get_title() for ax in figure.axes]
    ['1. as the clips are']

    Notebook: 03-transforms
    """
    turn = PlanarTransform(transform.angle, 0.0, 0.0), "turned about the origin"
    shift = PlanarTransform(0.0, transform.x, transform.z), "moved over the ground"
    parts = (shift, turn) if shift_first else (turn, shift)
    places = [moving, parts[0][0].apply_motion(moving)]
    places.append(parts[1][0].apply_motion(places[1]))
    corners = np.concatenate([m.root_positions[:, [0, 2]] for m in (target, *places)] + [np.zeros((1, 2))])
    low, high = corners.min(axis=0) - 0.8, corners.max(axis=0) + 0.8
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    for ax in panels[step:]:
        ax.remove()
    names = ["as the clips are", *(name for _, name in parts)]
    for number, (ax, name) in enumerate(zip(panels[:step], names, strict=False)):
        ax.set(xlim=(high[0], low[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x (m)")
        ax.set_title(f"{number + 1}. {name}")
        _draw_walker(ax, target, SOURCES[0], at=-1)
        if number:
            _draw_walker(ax, places[number - 1], FLOOR, at=0)
            start, end = (complex(*m.root_positions[0, [0, 2]]) for m in places[number - 1 : number + 1])
            share = np.linspace(0, 1, 40)
            around = start * np.exp(1j * np.angle(end / start) * share)
            way = around if name == turn[1] else start + (end - start) * share
            trace(ax, way, color=INK, linewidth=1, linestyle="--")
        _draw_walker(ax, places[number], SOURCES[1], at=0)
        ax.plot(0, 0, "+", color=INK, markersize=11)
    panels[0].set_ylabel("z (m)")
    panels[0].legend(frameon=False)
    return figure


def compass(headings: Mapping[str, float], ax: Axes) -> None:
    """Draw headings as arrows, seen from above, with their values.

    Parameters
    ----------
    headings : radians, each by its name.
    ax : axes.

    Examples
    --------
    >>> ax = Figure().add_subplot()
    >>> compass({"left": np.pi / 2}, ax)
    >>> ax.texts[0].get_text()
    'left: 90°'

    Notebook: 03b-angles
    """
    for row, (name, angle) in enumerate(headings.items()):
        text = f"{name}: {np.degrees(angle):.0f}°".replace("-", "−")
        ax.text(-1.5, -1.75 - 0.25 * row, text, color=CURVES[row])
        wide = 7.0 if row == 0 else 1.8  # so that all are seen
        arrow(ax, 0j, 1j * np.exp(1j * angle), CURVES[row], wide)  # z points up the page and x to the left
    for place, word in ((1.2j, "0°"), (-1.2j, "±180°"), (-1.25 + 0j, "90°"), (1.25 + 0j, "−90°")):
        say(ax, place, word, color=INK)
    ax.set(xlim=(-1.5, 1.5), ylim=(-1.8 - 0.25 * len(headings), 1.4), aspect="equal")
    ax.set_axis_off()


def _draw_walker(ax: Axes, motion: Motion, colour: str, *, at: int) -> None:
    """Draw a root's path, and at one frame a dot with an arrow in which the body faces."""
    x, z = motion.root_positions[:, [0, 2]].T
    ax.plot(x, z, color=colour, linewidth=2, label=None if colour == FLOOR else motion.name)
    ax.plot(x[at], z[at], "o", color=colour, markersize=7)
    here, facing = complex(x[at], z[at]), float(heading(motion.rotations[at, 0]))
    arrow(ax, here, here + 0.8j * np.exp(-1j * facing), colour)
