"""Clips on a common clock, and the clock of a blend: the common time of each of its frames."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import CubicHermiteSpline

from mocap._shared.arrays import Array, Points, frozen, runs
from mocap._shared.quantities import described
from mocap._shared.records import dataclass
from mocap.blending.timewarps import Curve
from mocap.blending.tuned import TUNED
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError

SharedFootplant = tuple[str, Array]
"""A footplant that all C clips have: the joint, and the start and the stop of the footplant in each, (2, C).

They are seconds of the common clock.
"""

Footplant = tuple[float, float]
"""The start and the stop of a footplant, seconds of the common clock."""


def match_contacts(
    clips: Sequence[Motion], times: Sequence[Curve], span: tuple[float, float]
) -> tuple[SharedFootplant, ...]:
    """Match the footplants of registered clips: a match has one of each clip, all at about the same time.

    In the paper: [KG03, constraint matches].

    Footplants whose time intervals overlap, directly or through others, form a group. A group without a
    footplant of some clip is dropped. A group with exactly one footplant of each clip is a match. Any other
    group is split at the pauses of the clip with the most footplants, and the parts are processed separately.
    [KG03] has matches of one interval for each clip, with intervals dropped or split. Its rule for splitting
    is not known to us, therefore this rule is ours.

    Parameters
    ----------
    clips : C motions. If one has no contacts, there are no matches.
    times : for each clip, the curve from the common clock to the time of the clip in seconds.
    span : the interval of the common clock that is searched, seconds.

    Returns
    -------
    The matches, joint by joint, in the order of time.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk, same_clock = sample("walk_straight"), Curve(0.0, 1.0, np.array([-0.5, 0.5, 1.5]))
    >>> joint, (starts, stops) = match_contacts([walk, walk[12:]], [same_clock, same_clock], (1.0, 3.0))[1]
    >>> joint, starts.round(1)
    ('lfoot', array([2.3, 2.2]))
    """
    joints = [joint for joint in clips[0].contacts if all(joint in clip.contacts for clip in clips)]
    matches = []
    for joint in joints:
        plants = [_footplants(clip, curve, joint, span) for clip, curve in zip(clips, times, strict=True)]
        for group in _overlapping(plants):
            matches += [(joint, frozen(match, np.float64)) for match in _split(group)]
    return tuple(matches)


def _footplants(clip: Motion, curve: Curve, joint: str, span: tuple[float, float]) -> list[Footplant]:
    """List the footplants of a joint in a clip, clipped to the span."""
    seconds = runs(clip.contacts[joint]) / clip.fps
    return _cut(curve.inverse(seconds).tolist(), *span)


def _cut(plants: Iterable[Sequence[float]], low: float, high: float) -> list[Footplant]:
    """Clip footplants to an interval, and drop those that are then too short."""
    parts = [(max(start, low), min(stop, high)) for start, stop in plants]
    return [(start, stop) for start, stop in parts if stop - start >= TUNED.shortest_plant]


def _overlapping(plants: Sequence[list[Footplant]]) -> list[list[list[Footplant]]]:
    """Group footplants of C clips whose time intervals overlap. A group lists the footplants of each clip."""
    in_time = sorted((start, stop, clip) for clip, listed in enumerate(plants) for start, stop in listed)
    groups: list[list[list[Footplant]]] = []
    group_stop = -np.inf
    for start, stop, clip in in_time:
        if start >= group_stop:
            groups.append([[] for _ in plants])
        groups[-1][clip].append((start, stop))
        group_stop = max(group_stop, stop)
    return groups


def _split(group: list[list[Footplant]]) -> Iterator[tuple[list[float], list[float]]]:
    """Split a group at the pauses of the clip with the most footplants. Yield starts and stops of matches.

    A part without a footplant of some clip is not a match.
    """
    busiest = max(group, key=len)
    pauses = [(stop + next_start) / 2 for (_, stop), (next_start, _) in pairwise(busiest)]
    for low, high in pairwise([-np.inf, *pauses, np.inf]):
        parts = [_cut(plants, low, high) for plants in group]
        if all(parts):
            yield [plants[0][0] for plants in parts], [plants[-1][1] for plants in parts]


Weights = ArrayLike | Callable[[float, float], ArrayLike]
"""Weights of C clips, whose sum is one, or a function of u and t that returns them."""

PACES = ("durations", "rates")


@dataclass(frozen=True, eq=False)
class Registration:
    """Clips on a common clock u, the time of a reference clip in seconds.

    clips, reference : C motions, and the number of the one with which the others are aligned.
    times : for each clip, the curve S from u to the time of the clip in seconds. For the reference, S(u) = u.
    angles : for each clip, the curve of the angle that aligns it at u, radians; 0 for the reference.
    centres : for each clip, the centroid (x, z) of its points, averaged over a window, shape (F, 2), metres.
    span : the first and the last u at which all clips are defined.
    costs : shape (C,), the mean RMS distance along the time path of each clip, metres.
    contacts : the footplants that all clips have.
    """

    clips: tuple[Motion, ...]
    reference: int
    times: tuple[Curve, ...]
    angles: tuple[Curve, ...]
    centres: tuple[Array, ...]
    span: tuple[float, float]
    costs: Array
    contacts: tuple[SharedFootplant, ...] = ()

    def __repr__(self) -> str:
        first, last = self.span
        return f"Registration({len(self.clips)} clips, {last - first:.3g} s)"

    @cached_property
    def durations(self) -> Array:
        """The duration of the span in each clip, seconds, shape (C,)."""
        ends = [curve(self.span) for curve in self.times]
        return frozen([last - first for first, last in ends], np.float64)

    @cached_property
    def parts(self) -> tuple[Motion, ...]:
        """The part of each clip that the span covers, to the nearest frames."""
        parts = []
        for clip, curve in zip(self.clips, self.times, strict=True):
            first, last = np.rint(curve(self.span) * clip.fps).astype(int)
            parts.append(clip[first : last + 1])
        return tuple(parts)

    def centre(self, clip: int, times: ArrayLike) -> Points:
        """Return the centroid of a clip as z + ix at times of the common clock."""
        frames = self.times[clip](times) * self.clips[clip].fps
        whole_frames = np.arange(len(self.centres[clip]))
        x, z = (np.interp(frames, whole_frames, coordinates) for coordinates in self.centres[clip].T)
        return on_ground(np.stack([x, z], axis=-1))


def require_registration(registration: object) -> Registration:
    """Return a registration as it is. Raise for anything else, with the call that makes one.

    Examples
    --------
    >>> require_registration([])
    Traceback (most recent call last):
    mocap.errors.MocapError: This takes a Registration, got a list of 0: blending.register([first, second])
    makes one.
    """
    if isinstance(registration, Registration):
        return registration
    needs = f"This takes a Registration, got {described(registration)}"
    raise MocapError(f"{needs}: blending.register([first, second]) makes one.")


def frame_times(
    registration: Registration, weights: Weights, *, fps: float, pace: str = "durations"
) -> tuple[Array, Array]:
    """Compute the time u of each frame of a blend, from the start of the span to its end.

    With `pace="durations"`, du/dt = 1 / Σ w S'(u): the durations of the clips are averaged, and with constant
    weights the blend lasts exactly Σ w T (ours). With "rates", du/dt = Σ w / S'(u), probably the rule of
    [KG03] (not checked). This is a mean of reciprocals, and too fast if the slopes of the curves differ.

    Parameters
    ----------
    registration : of C clips.
    weights : constant, or a function of the common clock u and of the time t of the blend, both in seconds.
    fps : frames per second of the blend.
    pace : "durations" or "rates".

    Returns
    -------
    The times u, shape (F,), and the weights at these times, shape (F, C).

    Raises
    ------
    MocapError : for weights that are not C finite numbers or whose sum is not one, a rate that is not above
        0, another pace, and weights far outside [0, 1] that would stop the clock.

    Notebook: 15-registration
    """
    if not (np.isfinite(fps) and fps > 0):
        raise MocapError(f"A frame rate must be above 0, got {fps}.")
    first, last = registration.span
    points = _clock_points(registration)
    slopes = np.array([curve.slope(points) for curve in registration.times])
    speeds = _clock_speeds(points, slopes, weights, pace)
    seconds = cumulative_trapezoid(1 / speeds, points, initial=0)  # the time t of the blend at each u
    clock = np.arange(int(seconds[-1] * fps + 1e-6) + 1) / fps
    times = np.clip(CubicHermiteSpline(seconds, points, speeds)(clock), first, last)
    count = len(registration.clips)
    if callable(weights):
        moments = zip(times.tolist(), clock.tolist(), strict=True)
        return times, np.array([checked(weights(u, t), count) for u, t in moments])
    return times, np.tile(checked(weights, count), (len(times), 1))


def _clock_points(registration: Registration) -> Array:
    """Return times of the common clock, 2 ms apart, including the knots of all curves.

    The slopes of the curves are linear between knots, therefore the trapezoidal rule is exact for Σ w S'(u).
    """
    first, last = registration.span
    points = np.linspace(first, last, max(int((last - first) / TUNED.clock_step), 8) + 1)
    knots = np.concatenate([curve.knots for curve in registration.times])
    inner = (first + TUNED.clock_step / 9 < knots) & (knots < last - TUNED.clock_step / 9)
    points = np.union1d(points, knots[inner])
    return points[np.diff(points, prepend=-np.inf) > TUNED.clock_step / 1e3]


def _clock_speeds(points: Array, slopes: Array, weights: Weights, pace: str) -> Array:
    """Compute du/dt at the points, shape (N,), from the slopes (C, N) of the curves there.

    Time-varying weights also depend on the time t of the blend, which is integrated from point to point.
    """
    count = len(slopes)
    if not callable(weights):
        return clock_speed(slopes, checked(weights, count), pace)
    speeds = np.empty(len(points))
    t = 0.0
    for n, (u, step) in enumerate(zip(points, np.diff(points, append=points[-1]), strict=True)):
        speeds[n] = clock_speed(slopes[:, n], checked(weights(float(u), t), count), pace)
        t += float(step / speeds[n])
    return speeds


def checked(weights: ArrayLike, count: int) -> Array:
    """Convert weights to an array.

    Raises
    ------
    MocapError : unless they are `count` finite numbers whose sum is one.

    Examples
    --------
    >>> checked([1.1, -0.1], 2)
    array([ 1.1, -0.1])
    """
    w = np.asarray(weights, float)
    if w.shape != (count,) or not np.isfinite(w).all() or abs(w.sum() - 1) > 1e-6:
        shown = w.tolist() if w.size <= 6 else f"an array of shape {w.shape} with the sum {w.sum():g}"
        raise MocapError(f"A blend of {count} clips needs {count} weights that add up to 1, got {shown}.")
    return w


def clock_speed(derivatives: ArrayLike, weights: ArrayLike, pace: str = "durations") -> Array:
    """Compute the speed of the common clock, du/dt, from the derivatives of the clips' curves [KG03, clock].

    Parameters
    ----------
    derivatives : shape (C,), or (C, N) for N times.
    weights : shape (C,).
    pace : as for `frame_times`.

    Returns
    -------
    A number, or shape (N,).

    Raises
    ------
    MocapError : for a clock that would stop or run backwards, and for another pace.

    Examples
    --------
    >>> float(clock_speed([1, 2], [0.5, 0.5]).round(4)), float(clock_speed([1, 2], [0.5, 0.5], "rates"))
    (0.6667, 0.75)
    """
    s = np.asarray(derivatives, float)
    w = np.asarray(weights, float)
    if pace not in PACES:
        raise MocapError(f"No pace '{pace}'; there are: {', '.join(PACES)}.")
    mean = w @ s if pace == "durations" else w @ (1 / s)
    if not np.all(mean > 0):
        shown = w.round(3).tolist()[:6]
        raise MocapError(f"With the weights {shown} time would stop; take them nearer to 0 … 1.")
    return np.asarray(1 / mean if pace == "durations" else mean)
