"""Registration [KG03]: corresponding frames of several clips, and the transforms that align them there."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap._shared.arguments import called_as
from mocap._shared.arrays import Array, Indices, frozen
from mocap.blending.clocks import Registration, match_contacts
from mocap.blending.mixing import mix
from mocap.blending.timewarps import Curve, fit_curve
from mocap.blending.tuned import TUNED
from mocap.body.concatenation import require_compatible
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import from_ground, on_ground
from mocap.errors import MocapError, shortened, warn
from mocap.matching.banded_paths import BandedPath, banded_path
from mocap.matching.point_clouds import align, point_cloud
from mocap.matching.prepared_clouds import check_window

PAIRS_TOGETHER = 4096  # pairs of windows that are aligned at a time, some 10 MB
AS_NEAR = 1e-9  # metres beyond that, so that rounding does not decide for clips that are the same

_Pair = tuple[Curve, Curve, tuple[float, float], float]
"""The registration of a clip: its curves of time and angle, their span, and the mean cost of the path."""


@called_as("blending.register([first, second])")
def register(
    clips: Sequence[Motion], *, reference: int = 0, slack: float = 1.2, slope: int = 2
) -> Registration:
    """Find the corresponding frames of several clips, and the transforms that align them [KG03, alignment].

    In the paper: [KG03, alignment; several clips].

    Each clip is registered with the reference. The path of minimum mean through the grid of distances, √D of
    [KGP02, Eq. 1], pairs the corresponding windows (`matching.time_path`). The path of
    clips of more than ten seconds is searched in a band around the diagonal of the grid, which is widened
    where the path comes near its edge [ours]. A smooth curve S of time is fitted to the path, with a slope
    between 1 / (W + 1) and W + 1: a straight line if its distances are as small, else a curve with as few
    knots as possible [ours]. Another curve is fitted to the angles θ of the optimal
    alignments of the windows [KGP02, Eqs. 2-4]. At the time u, the clip is aligned with the reference by the
    rotation θ(u) and by the translation of its centroid to that of the reference. Finally, footplants are
    matched.

    Ours: the clock is the time of the reference, and C clips require C - 1 registrations. (In the paper, as
    far as we remember, a curve is fitted through the times of all clips.) Only the angle is fitted, because
    the optimal alignment maps centroid to centroid. Registration is therefore independent of the positions at
    which clips were captured. The ends of the path are free within the slack.

    Parameters
    ----------
    clips : two motions or more, of one skeleton and one rate. Mark their footplants first
        (`feet.mark_plants`) if the blend should have contacts.
    reference : the number of the clip whose clock is the common one.
    slack : seconds by which one clip may start or end before the other, at most half of the shortest clip,
        and less if the clips would share less than half of it. Use 0 for clips with corresponding ends, such
        as strikes.
    slope : W, the largest number of consecutive frames of one clip at a single frame of the other. The pace
        of a clip is between 1 / (slope + 1) and slope + 1 times that of the other.

    Returns
    -------
    The clips on a common clock; `mix` blends them.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, fewer than two clips, a reference that is
        none of them, clips whose lengths differ by more than the slope allows, and invalid settings.

    Warns
    -----
    MocapWarning : for clips that may not be of one kind, and for a blend whose feet slide more than theirs.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> walking = register(walks)
    >>> walking.durations.round(1), bool(walking.costs[1] < 0.1)
    (array([5. , 4.1]), True)

    Notebook: 15-registration
    """
    clips = require_compatible(clips)
    step = _checked(clips, reference, slack)
    rate = clips[0].fps / step
    clouds = [point_cloud(clip[::step]) for clip in clips]
    shortest = min(clip.duration for clip in clips)
    frames = int(min(slack * rate, min(map(len, clouds)) // 2))
    reference_cloud = clouds.pop(reference)
    identity = _registered_on_itself(clips[reference].duration)
    while True:
        pairs = [_register_pair(reference_cloud, cloud, rate, slope, frames) for cloud in clouds]
        pairs.insert(reference, identity)
        times, angles, spans, costs = zip(*pairs, strict=True)
        start, end = _common_span(clips, times, spans)
        if not frames or end - start >= shortest / 2:
            break
        frames //= 2
    centres = tuple(_window_centres(clip, TUNED.window / rate) for clip in clips)
    plants = match_contacts(clips, times, (start, end))
    means = frozen(costs, np.float64)
    registration = Registration(clips, reference, times, angles, centres, (start, end), means, plants)
    _warn(registration, rate, alike=slack == 0)
    return registration


def _checked(clips: Sequence[Motion], reference: int, slack: float) -> int:
    """Check the arguments of `register`; return the number of frames in a step at `TUNED.rate`."""
    if len(clips) < 2:
        raise MocapError(f"A registration needs two clips or more, got {len(clips)}.")
    if reference not in range(len(clips)):
        raise MocapError(f"The reference is one of the clips 0 to {len(clips) - 1}, got {reference}.")
    if not 0 <= slack < np.inf:
        raise MocapError(f"Slack is 0 s or more, got {slack} s.")
    shortest = min(clips, key=len)
    step = max(round(clips[0].fps / TUNED.rate), 1)
    check_window(TUNED.window, -(-len(shortest) // step), f"'{shortest.name}', at {TUNED.rate:g} Hz,")
    return step


def _registered_on_itself(duration: float) -> _Pair:
    """Return the curves of the reference: the identity of time, and angle 0."""
    identity = frozen([-duration / 2, duration / 2, 3 * duration / 2], np.float64)
    zero = frozen(np.zeros(3), np.float64)
    return Curve(0.0, duration, identity), Curve(0.0, duration, zero), (0.0, duration), 0.0


def _common_span(
    clips: Sequence[Motion], times: Sequence[Curve], spans: Sequence[tuple[float, float]]
) -> tuple[float, float]:
    """Return the first and the last time at which all curves are defined and all clips have a frame."""
    of_clips = [curve.inverse([0, clip.duration]) for curve, clip in zip(times, clips, strict=True)]
    limits: list[Any] = [*spans, *of_clips]
    return max(float(start) for start, _ in limits), min(float(end) for _, end in limits)


def _register_pair(reference: Array, clip: Array, rate: float, slope: int, slack: int) -> _Pair:
    """Register the points of a clip with those of the reference, both at the same rate."""
    windows = min(len(reference), len(clip)) - TUNED.window + 1
    limits = {"slope": slope, "slack": min(slack, windows - 1)}
    widths = {"half_width": round(TUNED.band * rate), "margin": round(TUNED.band_margin * rate)}
    banded = banded_path(reference, clip, window=TUNED.window, **limits, **widths)
    path = banded.path
    half = (TUNED.window - 1) / 2
    u, clip_times = (path.T + half) / rate
    bounds = {"least": 1 / (slope + 1), "most": slope + 1.0}
    times = fit_curve(u, clip_times, spacing=TUNED.spacing, **bounds)
    largest_mean = TUNED.as_good * _mean_along(banded, times, rate, half) + AS_NEAR
    for multiple in TUNED.wider_spacings if slack else ():
        smoother = fit_curve(u, clip_times, spacing=multiple * TUNED.spacing, **bounds)
        if _mean_along(banded, smoother, rate, half) <= largest_mean:
            times = smoother
            break
    # The angle that aligns each pair of windows, without jumps of 2 π.
    angles = fit_curve(u, np.unwrap(_aligning_angles(reference, clip, path)), spacing=TUNED.spacing)
    # Without slack, the clips match up to their ends: include the half window and the frames of a last step.
    margin = 0.0 if slack else (half + 1) / rate
    return times, angles, (u[0] - margin, u[-1] + margin), banded.mean


def _aligning_angles(reference: Array, clip: Array, path: Indices) -> Array:
    """Return the angle that best aligns each pair of windows on a path, shape (N,), computed in parts."""
    parts = [path[first : first + PAIRS_TOGETHER] for first in range(0, len(path), PAIRS_TOGETHER)]
    alignments = [align(_windows(reference, part[:, 0]), _windows(clip, part[:, 1])) for part in parts]
    return np.concatenate([alignment.angle for alignment in alignments])


def _windows(points: Array, starts: Indices) -> Array:
    """Return the points of the windows that start at N frames, shape (N, `TUNED.window` · P, 3)."""
    frames = starts[:, None] + np.arange(TUNED.window)
    return np.asarray(points[frames].reshape(len(starts), -1, 3))


def _mean_along(banded: BandedPath, times: Curve, rate: float, half: float) -> float:
    """Compute the mean distance along a curve of time, weighted by the time by which both clips advance."""
    u = np.linspace(times.knots[0], times.knots[-1], 2 * len(banded.band.first))
    values = banded.interpolated(u * rate - half, times(u) * rate - half)
    return float(np.average(values, weights=1 + times.slope(u)))


def _window_centres(clip: Motion, seconds: float) -> Array:
    """Compute the centroid (x, z) of a clip's points, averaged over a window around each frame, (F, 2)."""
    centres = from_ground(on_ground(point_cloud(clip)).mean(axis=1))
    half = min(round(seconds * clip.fps) // 2, len(clip) - 1)
    padded = np.pad(centres, ((half, half), (0, 0)), mode="reflect", reflect_type="odd")
    return frozen(sliding_window_view(padded, 2 * half + 1, axis=0).mean(axis=-1), np.float64)


def _warn(registration: Registration, rate: float, *, alike: bool) -> None:
    """Warn of clips that may be of different kinds. The blend is not checked if they are cut `alike`."""
    clips = registration.clips
    worst = int(np.argmax(registration.costs))
    distance = registration.costs[worst]
    names = f"'{shortened(clips[registration.reference].name, 40)}' and '{shortened(clips[worst].name, 40)}'"
    speed = np.mean([np.abs(np.diff(on_ground(clip.root_positions))).mean() * clip.fps for clip in clips])
    if distance > max(TUNED.unlike, TUNED.unlike_time * speed):
        warn(f"{names} may not be the same kind of motion: {100 * distance:.0f} cm along the path.")
    elif not alike:
        blend = mix(registration, np.full(len(clips), 1 / len(clips)), fps=rate, rounds=0)
        of_blend = _sliding_speed(blend)
        parts = [part[:: round(part.fps / rate)] for part in registration.parts]
        of_clips = float(np.mean([_sliding_speed(part) for part in parts]))
        if of_blend > max(TUNED.sliding_ratio * of_clips, of_clips + TUNED.sliding_difference):
            speeds = f"{100 * of_blend:.1f} cm/s, in the clips at {100 * of_clips:.1f}"
            warn(f"{names} may not belong together: in an even blend the slowest joint goes at {speeds}.")


def _sliding_speed(motion: Motion) -> float:
    """Return the mean ground speed of the slowest joint in each frame, m/s: in a walk, one foot stands."""
    ground = on_ground(joint_positions(motion))
    return float(np.abs(np.diff(ground, axis=0)).min(axis=1).mean()) * motion.fps
