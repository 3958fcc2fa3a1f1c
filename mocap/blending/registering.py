"""Registration [KG03]: which frames of several clips belong together, and how they lie on one another."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array, Points, frozen
from mocap.blending.contact_matches import SharedPlant, match_contacts
from mocap.blending.timewarps import Curve, fit_curve
from mocap.body.motion import Motion, require_alike
from mocap.body.planar import from_ground, on_ground
from mocap.errors import MocapError, MocapWarning
from mocap.matching.distance_grids import check_window, distance_grid
from mocap.matching.point_clouds import align, point_cloud
from mocap.matching.time_paths import path_mean, time_path

UNLIKE = 0.12  # metres, the mean RMS distance along a path: walks are 3 to 8 cm apart, a walk and a run 24


class Warp(NamedTuple):
    """How to register clips.

    rate : frames per second that are compared, or the nearest rate that takes each n-th frame of the clips.
    window : frames of a window, at this rate.
    slope : how many frames of one clip may pass in a row while the other stands: its pace stays between
        1 / (slope + 1) and slope + 1 times the other's.
    spacing : seconds between the knots of the curves.

    Notebook: 15-registration
    """

    rate: float = 30.0
    window: int = 5
    slope: int = 2
    spacing: float = 0.3


_Pair = tuple[Curve, Curve, tuple[float, float], float]
"""A clip registered on the reference: its curves of time and angle, where they hold, and the path's mean."""


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


def register(
    clips: Sequence[Motion], *, reference: int = 0, slack: float = 1.2, warp: Warp | None = None
) -> Registration:
    """Find which frames of several clips belong together, and how they lie on one another [KG03, alignment].

    Each clip is registered with the reference. The path of least mean through the grid of their distances,
    √D of [KGP02, Eq. 1], says which windows belong together (`matching.time_path`). A curve S through the
    path, with a slope between 1 / (W + 1) and W + 1, makes time run smoothly. Another curve goes through the
    angles θ of the windows' best alignments [KGP02, Eqs. 2-4]. With them the clip is laid on the reference
    at u by turning it by θ(u) and moving its centroid onto the reference's. Last, plants are matched.

    Ours: the clock is the reference's time, so C clips take C - 1 pairs (recalled: the paper fits one curve
    through all clips' times). Only the angle is fitted, since the best alignment takes centroid to centroid;
    so it does not matter where the clips were captured. The ends are free within the slack.

    Parameters
    ----------
    clips : two motions or more, of one skeleton and one rate. Mark their plants first (`feet.mark_plants`)
        if the blend should have contacts.
    reference : the number of the clip whose clock is the common one.
    slack : seconds that one clip may start or end before the other, at most half of the shorter one. 0 for
        clips that were cut alike, at strikes for example.
    warp : `Warp()` by default.

    Returns
    -------
    The clips on one clock; `mix` blends them.

    Raises
    ------
    SkeletonMismatch, MocapError : for different skeletons or rates, fewer than two clips, a reference that is
        none of them, clips of which one is longer than the slope allows, settings that make no sense, and
        clips that have less than a window in common.

    Warns
    -----
    MocapWarning : for clips that may not be of one kind, and where they have less than half of the shortest
        clip in common.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walks = [sample(name) for name in ("walk_5m_0.8_0", "walk_5m_1.1_0")]
    >>> walking = register(walks)
    >>> walking.durations.round(1), bool(walking.costs[1] < 0.1)
    (array([4.7, 4.2]), True)

    Notebook: 15-registration
    """
    warp = warp or Warp()
    step = _checked(clips, reference, slack, warp)
    rate = clips[0].fps / step
    clouds = [point_cloud(clip[::step]) for clip in clips]
    frames = min(int(slack * rate), min(map(len, clouds)) // 2)
    pairs = [
        _identity(clip) if n == reference else _register_pair(clouds[reference], cloud, rate, warp, frames)
        for n, (clip, cloud) in enumerate(zip(clips, clouds, strict=True))
    ]
    times, angles, holds, costs = zip(*pairs, strict=True)
    # All curves hold, and no clip is at its end yet.
    limits = [*holds, *(t.inverse([0, clip.duration]) for t, clip in zip(times, clips, strict=True))]
    span = max(float(low) for low, _ in limits), min(float(high) for _, high in limits)
    if span[1] - span[0] < (warp.window - 1) / rate:
        raise MocapError("The clips have less than one window in common; give longer ones, or less slack.")
    _warn(clips, reference, costs, span)
    centres = tuple(_window_centres(clip, warp.window / rate) for clip in clips)
    plants, means = match_contacts(clips, times, span), frozen(costs, np.float64)
    return Registration(tuple(clips), reference, times, angles, centres, span, means, plants)


def _checked(clips: Sequence[Motion], reference: int, slack: float, warp: Warp) -> int:
    """Check what `register` is given; return how many frames make one step at the warp's rate."""
    if len(clips) < 2:
        raise MocapError(f"A registration needs two clips or more, got {len(clips)}.")
    require_alike(clips)
    if reference not in range(len(clips)):
        raise MocapError(f"The reference is one of the clips 0 to {len(clips) - 1}, got {reference}.")
    if not (np.isfinite(warp.rate) and warp.rate > 0):
        raise MocapError(f"A rate must be above 0, got {warp.rate}.")
    if not 0 <= slack < np.inf:
        raise MocapError(f"Slack is 0 s or more, got {slack} s.")
    shortest = min(clips, key=len)
    step = max(round(clips[0].fps / warp.rate), 1)
    check_window(warp.window, -(-len(shortest) // step), f"'{shortest.name}', at {warp.rate:g} Hz,")
    return step


def _register_pair(ours: Array, theirs: Array, rate: float, warp: Warp, slack: int) -> _Pair:
    """Register the points of a clip on those of the reference, both at the warp's rate."""
    grid = np.sqrt(distance_grid(ours, theirs, window=warp.window))
    path = time_path(grid, slope=warp.slope, slack=min(slack, min(grid.shape) - 1))
    half = (warp.window - 1) / 2
    u, own = (path.T + half) / rate
    fastest = warp.slope + 1.0
    times = fit_curve(u, own, spacing=warp.spacing, least=1 / fastest, most=fastest)
    frames = np.arange(warp.window)
    a, b = (
        points[cells[:, None] + frames].reshape(len(path), -1, 3)
        for points, cells in zip((ours, theirs), path.T, strict=True)
    )
    # The angle that lays each window on its partner, without jumps of whole turns.
    angles = fit_curve(u, np.unwrap(np.asarray(align(a, b).angle)), spacing=warp.spacing)
    # Clips cut alike go on to their ends: the last half window, and the frames that the rate left out.
    beyond = 0.0 if slack else (half + 1) / rate
    return times, angles, (u[0] - beyond, u[-1] + beyond), path_mean(grid, path)


def _identity(clip: Motion) -> _Pair:
    """Register the reference on itself."""
    h = clip.duration
    line, zero = frozen([-h / 2, h / 2, 3 * h / 2], np.float64), frozen(np.zeros(3), np.float64)
    return Curve(0.0, h, line), Curve(0.0, h, zero), (0.0, h), 0.0


def _window_centres(clip: Motion, seconds: float) -> Array:
    """Average the centroid of a clip's points over a window around each frame, (x, z), shape (F, 2)."""
    centres = from_ground(on_ground(point_cloud(clip)).mean(axis=1))
    half = min(round(seconds * clip.fps) // 2, len(clip) - 1)
    around = np.pad(centres, ((half, half), (0, 0)), mode="reflect", reflect_type="odd")
    return frozen(sliding_window_view(around, 2 * half + 1, axis=0).mean(axis=-1), np.float64)


def _warn(clips: Sequence[Motion], reference: int, costs: Sequence[float], span: tuple[float, float]) -> None:
    worst = int(np.argmax(costs))
    shortest, common = min(clip.duration for clip in clips), span[1] - span[0]
    for wrong, sentence in (
        (
            costs[worst] > UNLIKE,
            f"'{clips[reference].name}' and '{clips[worst].name}' may not be the same kind of motion: "
            f"{100 * costs[worst]:.0f} cm along the path.",
        ),
        (
            common < shortest / 2,
            f"The clips have only {common:.2f} s in common; the shortest one lasts {shortest:.2f} s.",
        ),
    ):
        if wrong:
            warnings.warn(sentence, MocapWarning, stacklevel=3)
