"""How one cloud of points is laid on another, from above: by hand, over a turn, in the steps of `align`."""

from collections.abc import Callable

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body import Motion, PlanarTransform, joint_positions
from mocap.course.diagrams.pens import strokes
from mocap.matching.point_clouds import align, distinct_joints, point_cloud
from mocap.plotting import CURVES, PATH, QUIET, SOURCES, bones

STEPS = ("where they are", "each from its own mean", "the second turned", "shifted back")


def laid(first: Motion, second: Motion, move: Callable[[Array], Array]) -> Figure:
    """Draw two windows from above, the second moved, and tell how far apart their points are.

    Parameters
    ----------
    first, second : windows of as many frames.
    move : takes points, shape (N, 3), and moves them.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:10]
    >>> laid(walk, walk, lambda points: points + [0.5, 0, 0]).axes[0].get_title()
    '50.0 cm RMS'

    Notebook: 02-matching
    """
    ax = Figure(figsize=(5.4, 5), layout="constrained").add_subplot()
    places = _places(first, second, move)
    _from_above(ax, (first, second), places)(places)
    ax.set_title(f"{_rms(first, places):.1f} cm RMS")
    return ax.figure  # type: ignore[return-value]


def turning(
    first: Motion, second: Motion, move: Callable[[Array, float], Array]
) -> Callable[[float], list[Artist]]:
    """Draw two windows from above, the second laid on the first after a turn, and the distance at each angle.

    Parameters
    ----------
    first, second : windows of as many frames.
    move : takes points, shape (N, 3), and an angle in radians; turns and shifts the points.

    Returns
    -------
    A function for `explore`: it takes how far to turn, -180 to 180 degrees, and gives what it moved.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:10]
    >>> turning(walk, walk, lambda points, angle: points)(60)[-1].get_text()
    '60°: 0.0 cm RMS'

    Notebook: 02-matching
    """
    ground, curve = Figure(figsize=(8.6, 4.2), layout="constrained").subplots(1, 2)

    def turned(degrees: float) -> Array:
        return _places(first, second, lambda points: move(points, np.radians(degrees)))

    angles = np.arange(-180, 181, 6)
    everywhere = np.stack([turned(angle) for angle in angles.tolist()])  # (A, 2, K, J, 3)
    distances = [_rms(first, places) for places in everywhere]
    put = _from_above(ground, (first, second), everywhere)
    curve.plot(angles, distances, color=CURVES[0])
    (dot,) = curve.plot([], [], "o", color=PATH, markersize=9)
    curve.set(xlabel="θ (degrees)", xlim=(-190, 190), xticks=range(-180, 181, 90))
    curve.set(ylabel="RMS distance (cm)", ylim=(0, 1.1 * max(1, *distances)))
    curve.spines[["top", "right"]].set_visible(False)

    def turn(degrees: float) -> list[Artist]:
        places = turned(degrees)
        distance = _rms(first, places)
        ground.title.set(text=f"{degrees:g}°: {distance:.1f} cm RMS".replace("-", "−"))
        dot.set_data([degrees], [distance])
        return [*put(places), dot, ground.title]

    return turn


def laying_on(first: Motion, second: Motion, *, step: int = 4) -> Figure:
    """Draw from above how the closed form lays one window on another [KGP02, Eqs. 2-4].

    Parameters
    ----------
    first, second : windows of as many frames.
    step : 1 the windows where they are, and the means of their points; 2 each measured from its mean; 3 the
        second turned by the best angle; 4 both moved to the place of the first.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:10]
    >>> laying_on(walk, PlanarTransform(1.0, 2.0, 0.0).apply_motion(walk), step=4).axes[0].get_title()
    'shifted back: 0.0 cm RMS'

    Notebook: 03-transforms
    """
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in (first, second))
    centred = [PlanarTransform(0.0, *-cloud.mean(0)[[0, 2]]) for cloud in (a, b)]
    angle = align(a, b).angle if step > 2 else 0.0
    turn = PlanarTransform(angle, 0.0, 0.0)
    if step > 1:
        back = centred[0].inverse() if step > 3 else PlanarTransform(0.0, 0.0, 0.0)
        first = (back @ centred[0]).apply_motion(first)
        second = (back @ turn @ centred[1]).apply_motion(second)
    figure = laid(first, second, lambda points: points)
    (ax,) = figure.axes
    ax.set_title(f"{STEPS[step - 1]}: {ax.get_title()}")
    return figure


def _places(first: Motion, second: Motion, move: Callable[[Array], Array]) -> Array:
    """Return the joints of both windows, the second one's moved: shape (2, K, J, 3)."""
    p = joint_positions(first)
    q = joint_positions(second)
    return np.stack([p, np.reshape(move(q.reshape(-1, 3)), q.shape)])


def _rms(first: Motion, places: Array) -> float:
    p, q = places[:, :, distinct_joints(first.skeleton)]
    return 100 * float(np.sqrt(((p - q) ** 2).sum(-1).mean()))


def _from_above(
    ax: Axes, motions: tuple[Motion, Motion], everywhere: Array
) -> Callable[[Array], list[Artist]]:
    """Draw the middle poses, the joints' tracks, the means, and a thread from each joint to its partner.

    Gives a function that puts them at `places`, shape (2, K, J, 3), and returns what it moved.
    """
    middle = len(motions[0]) // 2
    distinct = distinct_joints(motions[0].skeleton)
    limbs = np.stack(bones(motions[0].skeleton)[:2])  # (2, B)
    threads = strokes(ax, color=QUIET, linewidth=0.7, zorder=1)
    drawn = []
    for motion, colour in zip(motions, SOURCES, strict=False):
        tracks = strokes(ax, color=colour, linewidth=0.8, alpha=0.35)
        body = strokes(ax, color=colour, linewidth=2.4, label=motion.name)
        (mean,) = ax.plot([], [], "P", color=colour, markersize=12, markeredgecolor="white", zorder=4)
        drawn.append((tracks, body, mean))
    ax.plot([], [], "P", color=QUIET, markersize=9, label="mean")
    flat = everywhere[..., [0, 2]].reshape(-1, 2)
    low = flat.min(0)
    high = flat.max(0)
    x, z = (low + high) / 2
    reach = max(0.5, *(high - low) / 2 + 0.1)
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.set(xlim=(x + reach, x - reach), ylim=(z - reach, z + reach))  # seen from above, x leads to the left
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.08), ncols=3, frameon=False)

    def put(places: Array) -> list[Artist]:
        ground = places[..., [0, 2]]
        threads.set_segments([*ground[:, middle, distinct].swapaxes(0, 1)])
        for (tracks, body, mean), points in zip(drawn, ground, strict=True):
            tracks.set_segments(points.swapaxes(0, 1))
            body.set_segments(points[middle][limbs].swapaxes(0, 1))
            mean.set_data(points[:, distinct].mean((0, 1))[:, None])
        return [threads, *(artist for artists in drawn for artist in artists)]

    return put
