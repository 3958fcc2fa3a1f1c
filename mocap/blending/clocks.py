"""Clips on one common clock, and the blend's own clock: where on the common one each of its frames is."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import CubicHermiteSpline

from mocap._shared.arrays import Array, Points, frozen, runs
from mocap._shared.records import dataclass
from mocap.blending.timewarps import Curve
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError

SHORTEST = 0.02  # seconds on the common clock: what is left of a plant beside a cut or the span's end


SharedPlant = tuple[str, Array]
"""A plant that all C clips have: the joint, and when it starts and stops in each of them, (2, C), seconds.

They are seconds of the common clock.
"""


def match_contacts(
    clips: Sequence[Motion], times: Sequence[Curve], span: tuple[float, float]
) -> tuple[SharedPlant, ...]:
    """Match the plants of registered clips: in each match one of every clip, all at about the same time.

    In the paper: [KG03, constraint matches].

    Plants that overlap, or hang together by others that do, make a group. A group that lacks a clip is
    dropped. One with exactly one plant of each clip is a match. Any other is cut where the clip with the most
    plants pauses, each part by itself. [KG03] has matches of one interval for each clip, with intervals
    dropped or split; how it splits them is not known to us, so this rule is ours.

    Parameters
    ----------
    clips : C motions; those without contacts have no plants, so there is no match.
    times : for each clip, the curve from the common clock to the clip's own seconds.
    span : the stretch of the common clock to look at, seconds.

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
        plants = [
            (start, stop, number)
            for number, (clip, curve) in enumerate(zip(clips, times, strict=True))
            for start, stop in _within(curve.inverse(runs(clip.contacts[joint]) / clip.fps).tolist(), *span)
        ]
        for group in _groups(sorted(plants)):
            of_clips = [[(a, b) for a, b, clip in group if clip == number] for number in range(len(clips))]
            most = max(of_clips, key=len)
            pauses = [(before[1] + after[0]) / 2 for before, after in pairwise(most)]
            for low, high in pairwise([-np.inf, *pauses, np.inf]):
                parts = [_within(own, low, high) for own in of_clips]
                if all(parts):
                    ends = [[own[0][0] for own in parts], [own[-1][1] for own in parts]]
                    matches.append((joint, frozen(ends, np.float64)))
    return tuple(matches)


def _within(plants: Iterable[Sequence[float]], low: float, high: float) -> list[tuple[float, float]]:
    """Cut away what lies before `low` and after `high`, and leave out what is then too short."""
    parts = [(max(start, low), min(stop, high)) for start, stop in plants]
    return [(start, stop) for start, stop in parts if stop - start >= SHORTEST]


def _groups(plants: Sequence[tuple[float, float, int]]) -> list[list[tuple[float, float, int]]]:
    """Collect plants (start, stop, clip) that hang together: each starts before one before it stops."""
    groups: list[list[tuple[float, float, int]]] = []
    reach = -np.inf
    for plant in plants:
        if plant[0] >= reach:
            groups.append([])
        groups[-1].append(plant)
        reach = max(reach, plant[1])
    return groups


Weights = ArrayLike | Callable[[float, float], ArrayLike]
"""Weights of C clips, which add up to one; or a function of u and t that gives them."""

FINE = 0.002  # seconds between the points at which the clock is looked at
PACES = ("durations", "rates")


@dataclass(frozen=True, eq=False)
class Registration:
    """Clips on one common clock u, which is the reference's own time in seconds.

    clips, reference : C motions, and the number of the one that the others are laid on.
    times : for each clip the curve S from u to its own seconds; the reference's is u itself.
    angles : for each clip the angle, radians, that turns it on the reference at u; the reference's is 0.
    centres : for each clip the centroid (x, z) of its points, averaged over a window, shape (F, 2), metres.
    span : where all clips are defined: the first u and the last.
    costs : shape (C,), the mean RMS distance along the clips' paths, metres.
    contacts : the plants that all clips have.
    """

    clips: tuple[Motion, ...]
    reference: int
    times: tuple[Curve, ...]
    angles: tuple[Curve, ...]
    centres: tuple[Array, ...]
    span: tuple[float, float]
    costs: Array
    contacts: tuple[SharedPlant, ...] = ()

    @cached_property
    def durations(self) -> Array:
        """How long each clip takes for the span, seconds, shape (C,)."""
        return frozen([float(curve(self.span[1]) - curve(self.span[0])) for curve in self.times], np.float64)

    @cached_property
    def parts(self) -> tuple[Motion, ...]:
        """The stretch of each clip that the span covers, to its nearest frames."""
        ends = [np.rint(curve(self.span) * c.fps) for curve, c in zip(self.times, self.clips, strict=True)]
        return tuple(c[int(a) : int(b) + 1] for (a, b), c in zip(ends, self.clips, strict=True))

    def centre(self, clip: int, times: ArrayLike) -> Points:
        """Give a clip's centroid as z + ix at times of the common clock."""
        frames = self.times[clip](times) * self.clips[clip].fps
        own = np.arange(len(self.centres[clip]))
        x, z = (np.interp(frames, own, column) for column in self.centres[clip].T)
        return on_ground(np.stack([x, z], axis=-1))


def frame_times(
    registration: Registration, weights: Weights, *, fps: float, pace: str = "durations"
) -> tuple[Array, Array]:
    """Find the time u of each frame of a blend, from the first time of the span to its last.

    With `pace="durations"` du/dt = 1 / Σ w S'(u): seconds of the clips are averaged, so with constant weights
    the blend lasts exactly Σ w T (ours). With "rates" du/dt = Σ w / S'(u) (that this is the rule of [KG03] is
    recalled): a mean of reciprocals, so it plays too fast wherever the curves wiggle.

    Parameters
    ----------
    registration : of C clips.
    weights : constant, or a function of the common clock u and of the blend's own time t, both in seconds.
    fps : frames per second of the blend.
    pace : "durations" or "rates".

    Returns
    -------
    The times u, shape (F,), and the weights there, shape (F, C).

    Raises
    ------
    MocapError : for weights that are not C finite numbers or do not add up to one, a rate that is not above
        0, another pace, and a clock that would stop, which takes weights far outside [0, 1].

    Notebook: 15-registration
    """
    if not (np.isfinite(fps) and fps > 0):
        raise MocapError(f"A frame rate must be above 0, got {fps}.")
    count, (first, last) = len(registration.clips), registration.span
    # The curves' slopes are straight between knots: with these among the points, sums by trapezia are exact.
    knots = np.concatenate([curve.knots for curve in registration.times])
    points = np.linspace(first, last, max(int((last - first) / FINE), 8) + 1)
    points = np.union1d(points, knots[(first + FINE / 9 < knots) & (knots < last - FINE / 9)])
    points = points[np.diff(points, prepend=-np.inf) > FINE / 1e3]
    slopes = np.array([curve.slope(points) for curve in registration.times])
    if callable(weights):
        speeds, t = np.empty(len(points)), 0.0
        for n, (u, step) in enumerate(zip(points, np.diff(points, append=last), strict=True)):
            speeds[n] = clock_speed(slopes[:, n], checked(weights(float(u), t), count), pace)
            t += float(step / speeds[n])
    else:
        constant = checked(weights, count)
        speeds = clock_speed(slopes, constant, pace)
    seconds = cumulative_trapezoid(1 / speeds, points, initial=0)  # the blend's own time t at each u
    clock = np.arange(int(seconds[-1] * fps + 1e-6) + 1) / fps
    times = np.clip(CubicHermiteSpline(seconds, points, speeds)(clock), first, last)
    if not callable(weights):
        return times, np.tile(constant, (len(times), 1))
    both = zip(times.tolist(), clock.tolist(), strict=True)
    return times, np.array([checked(weights(u, t), count) for u, t in both])


def checked(weights: ArrayLike, count: int) -> Array:
    """Give weights as an array.

    Raises
    ------
    MocapError : unless they are `count` finite numbers that add up to one.

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


def clock_speed(slopes: ArrayLike, weights: ArrayLike, pace: str = "durations") -> Array:
    """Say how fast the common clock goes, du/dt, where the clips' curves have these slopes [KG03, clock].

    Parameters
    ----------
    slopes : shape (C,), or (C, N) for N times.
    weights : shape (C,).
    pace : as for `frame_times`.

    Returns
    -------
    A number, or shape (N,).

    Raises
    ------
    MocapError : where the clock would stop or run backwards, and for another pace.

    Examples
    --------
    >>> float(clock_speed([1, 2], [0.5, 0.5]).round(4)), float(clock_speed([1, 2], [0.5, 0.5], "rates"))
    (0.6667, 0.75)
    """
    s, w = np.asarray(slopes, float), np.asarray(weights, float)
    if pace not in PACES:
        raise MocapError(f"No pace '{pace}'; there are: {', '.join(PACES)}.")
    mean = w @ s if pace == "durations" else w @ (1 / s)
    if not np.all(mean > 0):
        some = w.round(3).tolist()[:6]
        raise MocapError(f"With the weights {some} time would stop; take them nearer to 0 … 1.")
    return np.asarray(1 / mean if pace == "durations" else mean)
