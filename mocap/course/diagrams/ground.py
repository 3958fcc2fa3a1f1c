"""The ground seen from above: how one clip is laid on another, and two distances from a path."""

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body import Motion, PlanarTransform, heading
from mocap.body.ground_path import GroundPath
from mocap.course.diagrams.pens import arrow, trace
from mocap.plotting.charts import seen_from_above
from mocap.plotting.style import ASKED, COLOURS, CURVES, FLOOR, PATH, QUIET, SOURCES

INK = COLOURS["middle"]


def alignment(
    target: Motion, moving: Motion, transform: PlanarTransform, *, shift_first: bool = False
) -> Figure:
    """Draw how a clip is aligned with another, seen from above: first it is turned, then it is moved.

    Parameters
    ----------
    target : the motion up to the moment at which the clips match; it stays.
    moving : the other motion from that moment on.
    transform : the planar transform that aligns `moving`.
    shift_first : exchange the turn and the shift, which leads to another place.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")
    >>> figure = alignment(walk[:120], walk[121:300], PlanarTransform(0.0, 0.0, 0.0))
    >>> figure.axes[0].get_title()
    '1. as the clips are'

    Notebook: 03-transforms
    """
    turn = PlanarTransform(transform.angle, 0.0, 0.0), "turned about the origin"
    shift = PlanarTransform(0.0, transform.x, transform.z), "moved over the ground"
    parts = (shift, turn) if shift_first else (turn, shift)
    places = [moving, parts[0][0].apply_motion(moving)]
    places.append(parts[1][0].apply_motion(places[1]))
    trajectories = [motion.root_positions[:, [0, 2]] for motion in (target, *places)]
    corners = np.concatenate([*trajectories, np.zeros((1, 2))])
    low = corners.min(axis=0) - 0.8
    high = corners.max(axis=0) + 0.8
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    names = ["as the clips are", *(name for _, name in parts)]
    for number, (ax, name) in enumerate(zip(panels, names, strict=True)):
        ax.set(xlim=(high[0], low[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x (m)")
        ax.set_title(f"{number + 1}. {name}")
        _draw_walker(ax, target, SOURCES[0], frame=-1)
        if number:
            _draw_walker(ax, places[number - 1], FLOOR, frame=0)
            steps = places[number - 1 : number + 1]
            start, end = (complex(*motion.root_positions[0, [0, 2]]) for motion in steps)
            share = np.linspace(0, 1, 40)
            arc = start * np.exp(1j * np.angle(end / start) * share)
            route = arc if name == turn[1] else start + (end - start) * share
            trace(ax, route, color=INK, linewidth=1, linestyle="--")
        _draw_walker(ax, places[number], SOURCES[1], frame=0)
        ax.plot(0, 0, "+", color=INK, markersize=11)
    panels[0].set_ylabel("z (m)")
    panels[0].legend(frameon=False)
    return figure


def _draw_walker(ax: Axes, motion: Motion, colour: str, *, frame: int) -> None:
    """Draw a root's path, and at one frame a dot with an arrow in which the body faces."""
    x, z = motion.root_positions[:, [0, 2]].T
    ax.plot(x, z, color=colour, linewidth=2, label=None if colour == FLOOR else motion.name)
    ax.plot(x[frame], z[frame], "o", color=colour, markersize=7)
    position = complex(x[frame], z[frame])
    facing = float(heading(motion.rotations[frame, 0]))
    arrow(ax, position, position + 0.8j * np.exp(-1j * facing), colour)


MOMENTS = 9
BEND = 0.8


def two_distances(path: GroundPath, walk: GroundPath) -> Callable[..., list[Any]]:
    """Return a function that draws a path and a walk from above, and both of their distances.

    Nine moments are evenly spaced along the walk. At each a thread leads to the path's point at equal arc
    length, as in [KGP02, Eq. 9], and another to the path's nearest point. The curves beside them show both
    distances. `draw(step)` shows all up to a moment, from 0, the start, to 8, the end, and gives what moved.

    Parameters
    ----------
    path : the path asked for.
    walk : the line that was walked.

    Examples
    --------
    A walk parallel to a straight path: both distances are the same.

    >>> path, walk = (GroundPath([[x, 0], [x, 4]]) for x in (0.0, 0.3))
    >>> left, right = two_distances(path, walk)(4)[0].figure.axes
    >>> [line.get_ydata()[-1].round(3).item() for line in right.lines[:2]]
    [30.0, 30.0]

    Notebook: 08c-judging-a-search
    """
    ground, curves = _ground_and_curves(path, walk)
    moments = np.linspace(0, walk.length, MOMENTS)[:, None]
    along = np.maximum(0, moments - moments[1] * np.linspace(1, 0, 25))  # up to each moment, (9, 25)
    positions = walk.at(moments)
    moving = []
    equal_length = ("at equal arc length (Eq. 9)", path.at, CURVES[0], 4.1)
    nearest = ("to the nearest point", lambda s: nearest_points(path, walk.at(s)), CURVES[1], 4.0)
    for name, point, colour, layer in (equal_length, nearest):
        targets = point(moments)
        threads = _bent(positions, targets)
        distances = 100 * np.linalg.norm(walk.at(along) - point(along), axis=-1)
        curve = np.stack([along, distances], axis=-1)
        moving.append(_line(ground, threads, color=colour, linewidth=1.8, zorder=layer))
        moving.append(_line(ground, targets, "o", color=colour, markersize=5, zorder=layer))
        moving.append(_line(curves, curve, color=colour, linewidth=2, label=name))
    dots = {"color": PATH, "markersize": 7, "markeredgecolor": ASKED, "zorder": 5}
    moving.append(_line(ground, positions, "o", **dots))
    moment = curves.axvline(color=QUIET, linewidth=1)
    highest = curves.dataLim.y1
    curves.set_ylim(-0.04 * highest - 0.1, 1.35 * highest + 0.1)
    curves.legend(frameon=False, loc="upper left")

    def draw(step: int = MOMENTS - 1) -> list[Any]:
        for line, rows in moving:
            line.set_data(*rows[: step + 1].reshape(-1, 2).T)
        moment.set_xdata([moments[step]] * 2)
        return [moment, *(line for line, _ in moving)]

    return draw


def _bent(starts: Array, ends: Array) -> Array:
    """Return threads from points to points, (9, 16, 2), bent so that they are seen beside the path."""
    share = np.array([*np.linspace(0, 1, 15), np.nan])[:, None]
    straight = ends - starts
    sideways = straight[..., ::-1] * [1, -1]
    return np.asarray(starts + share * straight + BEND * share * (1 - share) * sideways)


def _ground_and_curves(path: GroundPath, walk: GroundPath) -> tuple[Axes, Axes]:
    ground, curves = Figure(figsize=(8, 3.8), layout="constrained").subplots(1, 2, width_ratios=(1, 1.3))
    seen_from_above(ground).plot(*path.points.T, color=ASKED, linewidth=7, label="path asked for")
    ground.plot(*walk.points.T, color=PATH, linewidth=3.5, label="walk")
    ground.legend(frameon=False)
    curves.set(xlabel="metres walked", ylabel="distance (cm)", xlim=(0, walk.length))
    return ground, curves


def _line(ax: Axes, rows: Array, *form: str, **look: Any) -> tuple[Any, Array]:  # noqa: ANN401
    """Draw a line of which rows, shape (9, points, 2), belong to each moment."""
    return ax.plot(*rows.reshape(-1, 2).T, *form, **look)[0], rows


def nearest_points(path: GroundPath, points: Array) -> Array:
    """Return the point of the path, to a centimetre along it, that is nearest to each of some points.

    Examples
    --------
    >>> nearest_points(GroundPath([[0, 0], [0, 4]]), np.array([[1.0, 2.0], [0.5, 9.0]])).tolist()
    [[0.0, 2.0], [0.0, 4.0]]
    """
    fine = path.at(np.linspace(0, path.length, 1 + round(100 * path.length)))
    distances = np.linalg.norm(points[..., None, :] - fine, axis=-1)
    return np.asarray(fine[distances.argmin(axis=-1)])
