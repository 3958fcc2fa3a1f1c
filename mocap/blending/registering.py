"""Registration [KG03]: which frames of several clips belong together, and how they lie on one another."""

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import map_coordinates

from mocap._shared.arrays import Array, frozen
from mocap.blending.clocks import Registration, match_contacts
from mocap.blending.mixing import mix
from mocap.blending.timewarps import Curve, fit_curve
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import from_ground, on_ground
from mocap.errors import MocapError, shortened, warn
from mocap.matching.distance_grids import Floats, check_window, distance_grid
from mocap.matching.point_clouds import align, point_cloud
from mocap.matching.time_paths import path_mean, time_path

# Metres, the mean RMS distance along a path, and seconds of the root's speed: walks are 3 to 8 cm apart, runs
# of one kind 4 to 18, which the roots go in 0.01 to 0.06 s, a walk and a run 24, in 0.1 s.
UNLIKE, QUICK = 0.12, 0.06

# A blend of clips that belong together skates like they do: x 0.7 to 1.2 for walks of one person. By more
# than this, times and metres per second, a warning tells.
SKATES, FASTER = 1.4, 0.01

RATE = 30.0  # frames per second that are compared, or the nearest rate that takes each n-th frame
WINDOW = 5  # frames, at this rate
SPACING = 0.3  # seconds between the knots of the curves; those of time may be farther apart

# Spacings to try before this one, as multiples of it; the first is a straight line. The first is taken
# whose mean distance is at most so many times that of the closest knots, with which the pace of two even
# walks wobbles by a fifth. Clips that are cut alike take the closest: a straight line through nine punches
# makes blends miss their targets by 8 mm, where these miss by 5.
SPACINGS, AS_GOOD = (np.inf, 8.0, 4.0, 2.0), 1.06
AS_NEAR = 1e-9  # metres beyond that, so that rounding does not decide for clips that are the same

_Pair = tuple[Curve, Curve, tuple[float, float], float]
"""A clip registered on the reference: its curves of time and angle, where they hold, and the path's mean."""


def register(
    clips: Sequence[Motion], *, reference: int = 0, slack: float = 1.2, slope: int = 2
) -> Registration:
    """Find which frames of several clips belong together, and how they lie on one another [KG03, alignment].

    In the paper: [KG03, alignment; several clips].

    Each clip is registered with the reference. The path of least mean through the grid of their distances,
    √D of [KGP02, Eq. 1], says which windows belong together (`matching.time_path`). A curve S through the
    path, with a slope between 1 / (W + 1) and W + 1, makes time run smoothly: a straight line where it is as
    good, else as few knots as do [ours]. Another curve goes through the angles θ of the windows' best
    alignments [KGP02, Eqs. 2-4]. With them the clip is laid on the reference
    at u by turning it by θ(u) and moving its centroid onto the reference's. Last, plants are matched.

    Ours: the clock is the reference's time, so C clips take C - 1 pairs (recalled: the paper fits one curve
    through all clips' times). Only the angle is fitted, since the best alignment takes centroid to centroid;
    so it does not matter where the clips were captured. The ends are free within the slack.

    Parameters
    ----------
    clips : two motions or more, of one skeleton and one rate. Mark their plants first (`feet.mark_plants`)
        if the blend should have contacts.
    reference : the number of the clip whose clock is the common one.
    slack : seconds that one clip may start or end before the other; at most half of the shortest clip, and
        less where less than half of it would be in common. 0 for clips cut alike, at strikes for example.
    slope : how many frames of one clip may pass in a row while the other stands: its pace stays between
        1 / (slope + 1) and slope + 1 times the other's.

    Returns
    -------
    The clips on one clock; `mix` blends them.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, fewer than two clips, a reference that is
        none of them, clips of which one is longer than the slope allows, and settings that make no sense.

    Warns
    -----
    MocapWarning : for clips that may not be of one kind, and for clips whose blend skates though they do not.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> walking = register(walks)
    >>> walking.durations.round(1), bool(walking.costs[1] < 0.1)
    (array([4.7, 4.3]), True)

    Notebook: 15-registration
    """
    clips = require_alike(clips)
    step = _checked(clips, reference, slack)
    rate = clips[0].fps / step
    clouds = [point_cloud(clip[::step]) for clip in clips]
    shortest = min(clip.duration for clip in clips)
    frames = int(min(slack * rate, min(map(len, clouds)) // 2))
    ours, *others = clouds.pop(reference), *clouds
    h = clips[reference].duration
    line, still = (frozen(knots, np.float64) for knots in ([-h / 2, h / 2, 3 * h / 2], np.zeros(3)))
    while True:
        pairs = [_register_pair(ours, cloud, rate, slope, frames) for cloud in others]
        pairs.insert(reference, (Curve(0.0, h, line), Curve(0.0, h, still), (0.0, h), 0.0))
        times, angles, holds, costs = zip(*pairs, strict=True)
        # All curves hold, and no clip is at its end yet.
        limits = [*holds, *(t.inverse([0, clip.duration]) for t, clip in zip(times, clips, strict=True))]
        span = max(float(low) for low, _ in limits), min(float(high) for _, high in limits)
        if not frames or span[1] - span[0] >= shortest / 2:
            break
        frames //= 2
    centres = tuple(_window_centres(clip, WINDOW / rate) for clip in clips)
    plants, means = match_contacts(clips, times, span), frozen(costs, np.float64)
    found = Registration(clips, reference, times, angles, centres, span, means, plants)
    _warn(found, rate, alike=slack == 0)
    return found


def _checked(clips: Sequence[Motion], reference: int, slack: float) -> int:
    """Check what `register` is given; return how many frames make one step at `RATE`."""
    if len(clips) < 2:
        raise MocapError(f"A registration needs two clips or more, got {len(clips)}.")
    if reference not in range(len(clips)):
        raise MocapError(f"The reference is one of the clips 0 to {len(clips) - 1}, got {reference}.")
    if not 0 <= slack < np.inf:
        raise MocapError(f"Slack is 0 s or more, got {slack} s.")
    shortest = min(clips, key=len)
    step = max(round(clips[0].fps / RATE), 1)
    check_window(WINDOW, -(-len(shortest) // step), f"'{shortest.name}', at {RATE:g} Hz,")
    return step


def _register_pair(ours: Array, theirs: Array, rate: float, slope: int, slack: int) -> _Pair:
    """Register the points of a clip on those of the reference, both at the same rate."""
    grid = np.sqrt(distance_grid(ours, theirs, window=WINDOW))
    path = time_path(grid, slope=slope, slack=min(slack, min(grid.shape) - 1))
    half = (WINDOW - 1) / 2
    u, own = (path.T + half) / rate
    bounds = {"least": 1 / (slope + 1), "most": slope + 1.0}
    times = fit_curve(u, own, spacing=SPACING, **bounds)
    enough = AS_GOOD * _mean_along(grid, times, rate, half) + AS_NEAR
    wide = SPACINGS if slack else ()
    fewer = (fit_curve(u, own, spacing=wider * SPACING, **bounds) for wider in wide)
    times = next((curve for curve in fewer if _mean_along(grid, curve, rate, half) <= enough), times)
    frames = np.arange(WINDOW)
    clouds = zip((ours, theirs), path.T, strict=True)
    a, b = (points[cells[:, None] + frames].reshape(len(path), -1, 3) for points, cells in clouds)
    # The angle that lays each window on its partner, without jumps of whole turns.
    angles = fit_curve(u, np.unwrap(np.asarray(align(a, b).angle)), spacing=SPACING)
    # Clips cut alike go on to their ends: the last half window, and the frames that the rate left out.
    beyond = 0.0 if slack else (half + 1) / rate
    return times, angles, (u[0] - beyond, u[-1] + beyond), path_mean(grid, path)


def _mean_along(grid: Floats, times: Curve, rate: float, half: float) -> float:
    """Average a grid of windows along a curve of time, weighted by how far both clips advance."""
    u = np.linspace(times.knots[0], times.knots[-1], 2 * len(grid))
    values = map_coordinates(grid, [u * rate - half, times(u) * rate - half], order=1, mode="nearest")
    return float(np.average(values, weights=1 + times.slope(u)))


def _window_centres(clip: Motion, seconds: float) -> Array:
    """Average the centroid of a clip's points over a window around each frame, (x, z), shape (F, 2)."""
    centres = from_ground(on_ground(point_cloud(clip)).mean(axis=1))
    half = min(round(seconds * clip.fps) // 2, len(clip) - 1)
    around = np.pad(centres, ((half, half), (0, 0)), mode="reflect", reflect_type="odd")
    return frozen(sliding_window_view(around, 2 * half + 1, axis=0).mean(axis=-1), np.float64)


def _warn(found: Registration, rate: float, *, alike: bool) -> None:
    """Warn of clips that do not fit; those that were cut `alike` are blended with some of them only."""
    clips, worst = found.clips, int(np.argmax(found.costs))
    names = f"'{shortened(clips[found.reference].name, 40)}' and '{shortened(clips[worst].name, 40)}'"
    goes = np.mean([np.abs(np.diff(on_ground(clip.root_positions))).mean() * clip.fps for clip in clips])
    if found.costs[worst] > max(UNLIKE, QUICK * goes):
        apart = f"{100 * found.costs[worst]:.0f} cm along the path"
        warn(f"{names} may not be the same kind of motion: {apart}.")
    elif not alike:
        skate = _skate(mix(found, np.full(len(clips), 1 / len(clips)), fps=rate, rounds=0))
        own = float(np.mean([_skate(part[:: round(part.fps / rate)]) for part in found.parts]))
        if skate > max(SKATES * own, own + FASTER):
            speeds = f"{100 * skate:.1f} cm/s, in the clips at {100 * own:.1f}"
            warn(f"{names} may not belong together: in an even blend the slowest joint goes at {speeds}.")


def _skate(motion: Motion) -> float:
    """Give the mean speed over the ground of each frame's slowest joint, m/s: in walking one foot stands."""
    ground = on_ground(joint_positions(motion))
    return float(np.abs(np.diff(ground, axis=0)).min(axis=1).mean()) * motion.fps
