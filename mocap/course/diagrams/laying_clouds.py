"""How one cloud of points is laid on another: means, centring, angle, shift; all seen from above."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mocap._shared.arrays import Array
from mocap.body import Motion, PlanarTransform, joint_positions
from mocap.course.diagrams.pens import require_step
from mocap.matching.point_clouds import align, point_cloud, rms_distance
from mocap.plotting import CURVES, QUIET, SOURCES, bones

STEPS = ("where they are, with their means", "each from its own mean", "the second turned", "shifted back")


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
    '4. shifted back: 0.0 cm RMS'

    Notebook: 02-matching
    """
    require_step(step, len(STEPS))
    angle = align(*(point_cloud(motion).reshape(-1, 3) for motion in (first, second))).angle
    back = PlanarTransform(0.0, *_mean(first) * (step > 3))
    if step > 1:
        turn = PlanarTransform(angle * (step > 2), 0.0, 0.0)
        first, second = back.apply_motion(_centred(first)), (back @ turn).apply_motion(_centred(second))
    figure = Figure(figsize=(5.6, 5.2), layout="constrained")
    ax = figure.add_subplot()
    _from_above(ax, first, second)
    ax.set_title(f"{step}. {STEPS[step - 1]}: {100 * rms_distance(first, second):.1f} cm RMS", fontsize=11)
    return figure


def turning(first: Motion, second: Motion, *, degrees: float = 0.0) -> Figure:
    """Draw two centred windows from above, the second turned by hand, and the distance left so far.

    The curve ends at the angle to which the second is turned, so that nobody sees the rest before they turn.

    Parameters
    ----------
    first, second : windows of as many frames.
    degrees : how far to turn the second about its mean, -180 to 180.

    Examples
    --------
    >>> from mocap import datasets
    >>> walk = datasets.sample("walk_straight")[:10]
    >>> turning(walk, walk).axes[1].get_title()
    '0°: 0.0 cm'

    Notebook: 02-matching
    """
    first, second = _centred(first), _centred(second)
    clouds = [point_cloud(motion).reshape(-1, 3) for motion in (first, second)]

    def left(angle: float) -> float:
        turned = PlanarTransform(np.radians(angle), 0.0, 0.0).apply_points(clouds[1])
        return 100 * float(np.sqrt(((clouds[0] - turned) ** 2).sum(-1).mean()))

    figure = Figure(figsize=(8.6, 4.2), layout="constrained")
    ground, curve = figure.subplots(1, 2)
    _from_above(ground, first, PlanarTransform(np.radians(degrees), 0.0, 0.0).apply_motion(second))
    angles = np.append(np.arange(-180, degrees, 3), degrees)
    curve.plot(angles, [left(angle) for angle in angles], color=CURVES[0])
    curve.plot([degrees], [left(degrees)], "o", color="#000000", markersize=8)
    highest = max(left(angle) for angle in range(-180, 181, 10))
    curve.set(xlabel="θ (degrees)", xlim=(-190, 190), xticks=range(-180, 181, 90))
    curve.set(ylabel="RMS distance (cm)", ylim=(0, 1.1 * max(highest, 1)))
    curve.set_title(f"{degrees:g}°: {left(degrees):.1f} cm".replace("-", "−"))
    curve.spines[["top", "right"]].set_visible(False)
    return figure


def _mean(motion: Motion) -> Array:
    """Take the mean of a window's points over the ground: (x, z)."""
    return np.asarray(point_cloud(motion).mean(axis=(0, 1))[[0, 2]])


def _centred(motion: Motion) -> Motion:
    """Move the mean of a window's points over the ground to the origin."""
    return PlanarTransform(0.0, *-_mean(motion)).apply_motion(motion)


def _from_above(ax: Axes, first: Motion, second: Motion) -> None:
    """Draw the middle poses, the joints' tracks, the means, and a thread from each joint to its partner."""
    middle = len(first) // 2
    threads = np.stack([point_cloud(motion)[middle][:, [0, 2]] for motion in (first, second)])
    ax.plot(*threads.transpose(2, 0, 1), color=QUIET, linewidth=0.7, zorder=1)
    clouds = [joint_positions(motion)[..., [0, 2]] for motion in (first, second)]
    for motion, places, colour in zip((first, second), clouds, SOURCES, strict=False):
        ax.plot(places[..., 0], places[..., 1], color=colour, linewidth=0.8, alpha=0.35)
        limbs = places[middle][np.stack(bones(motion.skeleton)[:2])]
        ax.plot(limbs[..., 0], limbs[..., 1], color=colour, linewidth=2.4)
        ax.plot(*_mean(motion)[:, None], "P", color=colour, markersize=12, markeredgecolor="white", zorder=4)
        ax.plot([], [], color=colour, linewidth=2.4, label=motion.name)
    ax.plot([], [], "P", color=QUIET, markersize=9, label="mean")
    low, high = (f(np.concatenate(clouds), axis=(0, 1)) for f in (np.min, np.max))
    (x, z), reach = (low + high) / 2, max(0.5, *(high - low) / 2 + 0.1)
    ax.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")
    ax.set(xlim=(x + reach, x - reach), ylim=(z - reach, z + reach))  # seen from above, x leads to the left
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.08), ncols=3, frameon=False, fontsize=9)
