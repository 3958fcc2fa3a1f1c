"""Clips on one common clock, and the blend's own clock: where on the common one each of its frames is."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Points, frozen
from mocap.blending.contact_matches import SharedPlant
from mocap.blending.timewarps import Curve
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.errors import MocapError

Weights = ArrayLike | Callable[[float, float], ArrayLike]
"""Weights of C clips, which add up to one; or a function of u and t that gives them."""

FINE = 0.002  # seconds between the points from which the clock's inverse starts
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
    if pace not in PACES:
        raise MocapError(f"No pace '{pace}'; there are: {', '.join(PACES)}.")
    count = len(registration.clips)
    if not callable(weights):
        w = checked(weights, count)
        if pace == "durations":
            times = _closed(registration, w, fps)
            return times, np.tile(w, (len(times), 1))
    varying = weights if callable(weights) else lambda u, t: w
    times = _stepped(registration, varying, fps, pace)
    at = [checked(varying(float(u), n / fps), count) for n, u in enumerate(times)]
    return times, np.array(at)


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


def clock_speed(slopes: ArrayLike, weights: ArrayLike, pace: str = "durations") -> float:
    """Say how fast the common clock goes, du/dt, where the clips' curves have these slopes [KG03, clock].

    Parameters
    ----------
    slopes, weights : shape (C,).
    pace : as for `frame_times`.

    Raises
    ------
    MocapError : where the clock would stop or run backwards.

    Examples
    --------
    >>> round(clock_speed([1, 2], [0.5, 0.5]), 4), clock_speed([1, 2], [0.5, 0.5], "rates")
    (0.6667, 0.75)
    """
    s, w = np.asarray(slopes, float), np.asarray(weights, float)
    speed = 1 / float(w @ s) if pace == "durations" and w @ s else float(w @ (1 / s))
    _require_running(speed, w)
    return speed


def _require_running(speed: float, weights: Array) -> None:
    if not speed > 0:
        some = weights.round(3).tolist()[:6]
        raise MocapError(f"With the weights {some} time would stop; take them nearer to 0 … 1.")


def _closed(registration: Registration, weights: Array, fps: float) -> Array:
    """For constant weights t(u) = Σ w (S(u) - S(u₀)) is known, so only its inverse is to be found."""

    def elapsed(u: Array) -> Array:
        return np.asarray(weights @ np.array([curve(u) - curve(first) for curve in registration.times]))

    def slope(u: Array) -> Array:
        return np.asarray(weights @ np.array([curve.slope(u) for curve in registration.times]))

    first, last = registration.span
    points = np.linspace(first, last, max(int((last - first) / FINE), 8) + 1)
    _require_running(float(slope(points).min()), weights)
    t = elapsed(points)
    wanted = np.arange(int(t[-1] * fps + 1e-6) + 1) / fps
    u = np.interp(wanted, t, points)
    for _ in range(2):  # Newton's way, from a place that is right to FINE²
        u = np.clip(u - (elapsed(u) - wanted) / slope(u), first, last)
    return u


def _stepped(
    registration: Registration, weights: Callable[[float, float], ArrayLike], fps: float, pace: str
) -> Array:
    """Follow du/dt by one step of Runge and Kutta's fourth order for each frame."""

    def speed(u: float, t: float) -> float:
        slopes = [float(np.interp(u, *line)) for line in lines]
        return clock_speed(slopes, checked(weights(u, t), len(slopes)), pace)

    lines = [(curve.knots, curve.slope(curve.knots)) for curve in registration.times]
    (u, last), h = registration.span, 1 / fps
    times = [u]
    while True:
        t = (len(times) - 1) * h
        k1 = speed(u, t)
        k2 = speed(u + h / 2 * k1, t + h / 2)
        k3 = speed(u + h / 2 * k2, t + h / 2)
        u += h / 6 * (k1 + 2 * k2 + 2 * k3 + speed(u + h * k3, t + h))
        if u > last + 1e-9:
            return np.array(times)
        times.append(min(u, last))
