"""Where one clip passes into another: frames, weights, ways between two rotations, and a leg that reaches."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from mpl_toolkits.mplot3d import Axes3D

from mocap._shared.arrays import Array, Indices
from mocap.blending.weights import cubic_weights
from mocap.body import rotations
from mocap.plotting import CURVES, MARK, QUIET, SOURCES, to_picture

AROUND = 4  # frames of each clip before the window and after it
FIRST, SECOND, RESULT = 2.6, 1.3, 0.0  # the heights of the rows
BOX = 0.86  # a frame's width and height


def blended_seam(step: int = 4, window: int = 6) -> Figure:
    """Draw how frames of two clips become the frames of a transition, and the share α of the first clip.

    Parameters
    ----------
    step : 1 draws the two clips with their windows, 2 adds the weights, 3 the mixed frames, 4 the rest of
        the result.
    window : frames k of the transition.

    Examples
    --------
    >>> rows, weights = blended_seam(step=2, window=6).axes
    >>> len(rows.patches), len(weights.lines)  # two clips of 14 frames, and their windows
    (30, 1)

    Notebook: 04-blending
    """
    figure = plt.figure(figsize=(9, 4.4), layout="constrained")
    rows, weights = figure.subplots(2, 1, height_ratios=[3, 1.3], sharex=True)
    places = np.arange(-AROUND, window + AROUND)
    alpha = np.concatenate([np.ones(AROUND), cubic_weights(window), np.zeros(AROUND)])
    for letter, height, colour in (("i", FIRST, SOURCES[0]), ("j", SECOND, SOURCES[1])):
        for place in places:
            _draw_frame(rows, int(place), height, {colour: 1.0}, _named(letter, int(place)))
        _mark_window(rows, height, window)
    if step >= 3:
        _draw_result(rows, places, alpha, whole=step >= 4)
        _mark_window(rows, RESULT, window)
    names = ["clip A", "clip B,\naligned", "result"]
    rows.set(xlim=(-AROUND - 0.7, window + AROUND - 0.3), ylim=(-0.4, FIRST + 1.4))
    rows.set_yticks(np.array([FIRST, SECOND, RESULT]) + BOX / 2, names)
    rows.tick_params(length=0, labelbottom=False)
    rows.spines[:].set_visible(False)
    weights.set(ylabel="α, share of A", xlabel="frame p of the window", ylim=(-0.1, 1.1))
    if step >= 2:
        weights.plot(places, alpha, "o-", color=CURVES[0])
        for place, share in zip(places[AROUND:-AROUND], alpha[AROUND:-AROUND], strict=True):
            weights.annotate(f"{share:.2f}", (place, share), (7, 5), textcoords="offset points", fontsize=8)
    return figure


def _named(letter: str, steps: int) -> str:
    """Name a frame, some steps from frame i or j."""
    return f"${letter}$" if steps == 0 else f"${letter}{steps:+d}$"


def _mark_window(ax: Axes, height: float, window: int) -> None:
    """Put a frame around the window of a row."""
    corner, wide = (-0.55, height - 0.12), window + 0.1
    ax.add_patch(Rectangle(corner, wide, BOX + 0.24, fill=False, edgecolor=MARK, lw=2.5))


def _draw_frame(ax: Axes, place: int, height: float, shares: Mapping[str, float], name: str) -> None:
    """Draw a frame as a box with a name in it, filled from below with colours, each by its share."""
    low = height
    for colour, share in shares.items():
        ax.add_patch(Rectangle((place - BOX / 2, low), BOX, BOX * share, facecolor=colour, alpha=0.6))
        low += BOX * share
    ax.text(place, height + BOX / 2, name, ha="center", va="center", fontsize=9)


def _draw_result(ax: Axes, places: Indices, alpha: Array, *, whole: bool) -> None:
    """Draw the frames of the result, in the window or all: A's colour up to its share, then B's."""
    for place, share in zip(places.tolist(), alpha.tolist(), strict=True):
        inside = 0 <= place < len(places) - 2 * AROUND
        if inside or whole:
            name = "mix" if inside else _named("i" if place < 0 else "j", place)
            _draw_frame(ax, place, RESULT, {SOURCES[0]: share, SOURCES[1]: 1 - share}, name)
        if inside:
            for start in (FIRST, SECOND):
                ax.plot([place, place], [start - 0.12, RESULT + BOX], color=QUIET, lw=0.6, zorder=0)


def turning_paths(ways: Mapping[str, Array], share: float = 0.25) -> Figure:
    """Draw ways from one rotation to another: a bone's tip on a ball, and how far each way has turned.

    Parameters
    ----------
    ways : a name and rotations (F, 4) each, evenly from the first to the last, which all ways share.
    share : how far along the dots are, from 0 to 1.

    Examples
    --------
    >>> turn = rotations.about_y(np.linspace(0, 1, 11))
    >>> ball, graph = turning_paths({"slerp": turn}, share=1.0).axes
    >>> [round(float(at), 1) for at in graph.lines[-1].get_data()[1]]  # degrees
    [57.3]

    Notebook: 04-blending
    """
    figure = plt.figure(figsize=(9, 3.8), layout="constrained")
    ball: Axes3D = figure.add_subplot(1, 2, 1, projection="3d")
    graph = figure.add_subplot(1, 2, 2)
    ball.set_box_aspect((1, 1, 1), zoom=1.3)
    ball.set_axis_off()
    u, v = np.mgrid[0 : 2 * np.pi : 25j, 0 : np.pi : 13j]
    net = np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)
    ball.plot_wireframe(*net, color="#DDDDDD", linewidth=0.5)
    for (name, way), colour, width in zip(ways.items(), CURVES, (2, 6, 2, 2), strict=False):
        look = {"color": colour, "zorder": 1 / width}
        tips = to_picture(rotations.rotate(way, [0.0, 0.0, 1.0]))
        turned = np.degrees(rotations.angle_between(way[0], way))
        now = round(share * (len(way) - 1))
        ball.plot(*tips.T, linewidth=width, **look)
        ball.plot(*tips[now : now + 1].T, "o", ms=6 + width, **look)
        graph.plot(np.linspace(0, 1, len(way)), turned, label=name, linewidth=width, **look)
        graph.plot([share], [turned[now]], "o", ms=6 + width, **look)
    graph.set(xlabel="share of the way", ylabel="turned from the start (degrees)")
    graph.legend(frameon=False)
    return figure


def knee_triangle(step: int = 3, distance: float = 0.74) -> Figure:
    """Draw a leg as a triangle: what is known, what the law of cosines gives, and what is still free.

    Parameters
    ----------
    step : 1 draws hip, ankle and the three lengths, 2 adds the angles at the hip and at the knee, 3 the knee
        turned about the line from hip to ankle, as it may be.
    distance : from hip to ankle, metres; thigh and shank are 0.45 and 0.41 m.

    Examples
    --------
    >>> bend = knee_triangle(step=2).axes[0].texts[-1].get_text()
    >>> bend
    'bend 61°'

    Notebook: 04b-feet
    """
    thigh, shank = 0.45, 0.41
    figure, ax = plt.subplots(figsize=(5.4, 4.4), layout="constrained")
    along = (thigh**2 + distance**2 - shank**2) / (2 * distance)  # from the hip to below the knee
    across = np.sqrt(thigh**2 - along**2)
    hip, ankle, knee = np.array([[0, 0.0], [0, -distance], [across, -along]])
    if step >= 3:
        for side in (0.4, -0.4, -1.0):
            turned = np.array([hip, knee * [side, 1], ankle])
            ax.plot(*turned.T, "o:", color=QUIET, lw=1.5)
    ax.plot(*np.array([hip, knee, ankle]).T, "o-", color=CURVES[0], lw=4, ms=9)
    ax.plot(*np.array([hip, ankle]).T, color=CURVES[1], lw=2, ls="--")
    middle, shin = 0.5 * knee, (knee + ankle) / 2
    for text, (x, y) in {
        "hip": (-0.09, 0.03),
        "ankle": (-0.13, -distance - 0.05),
        "knee": (knee[0] + 0.03, knee[1]),
        "thigh $u$": (middle[0] + 0.03, middle[1] + 0.03),
        "shank $l$": (shin[0] + 0.03, shin[1] - 0.03),
    }.items():
        ax.text(x, y, text)
    ax.text(-0.02, -distance / 2, "distance $d$", rotation=90, ha="right", va="center", color=CURVES[1])
    if step >= 2:
        _angles(ax, knee, ankle)
    ax.set(aspect="equal", xlim=(-0.35, 0.55), ylim=(-distance - 0.1, 0.1))
    ax.set_axis_off()
    return figure


def _angles(ax: Axes, knee: Array, ankle: Array) -> None:
    """Draw the thigh's continuation past the knee and name the angle at the hip and the knee's bend."""
    onward = knee / np.linalg.norm(knee)
    shank = (ankle - knee) / np.linalg.norm(ankle - knee)
    ax.plot(*np.array([knee, knee + 0.22 * onward]).T, color=QUIET, ls="--", lw=1.5)
    for corner, first, second in ((np.zeros(2), np.array([0, -1.0]), onward), (knee, onward, shank)):
        share = np.linspace(0, 1, 30)[:, None]
        fan = first + share * (second - first)
        arc = corner + 0.12 * fan / np.linalg.norm(fan, axis=1, keepdims=True)
        ax.plot(*arc.T, color="#333333", lw=1.5)
    at_hip, bend = (np.degrees(np.arccos(x @ y)) for x, y in ((onward, [0, -1.0]), (onward, shank)))
    ax.text(0.02, -0.16, f"{at_hip:.0f}°", fontsize=9)
    ax.text(knee[0] + 0.1, knee[1] - 0.12, f"bend {bend:.0f}°")
