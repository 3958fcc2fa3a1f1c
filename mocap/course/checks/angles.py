"""Checks of notebook 03b-angles."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import euler
from mocap.course.check import Check, Mistake, close, close_angles

TURN = 2 * np.pi
Part = tuple[Array, int, int]


def _wrapped(angle: float) -> float:
    return (angle + np.pi) % TURN - np.pi


def _same_turn(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare turns; exactly half a turn may go to either side."""
    return close(given, wanted) or (close(abs(wanted), np.pi) and close(abs(given), np.pi))


def _two_headings(rng: np.random.Generator) -> tuple[float, float]:
    """Draw two headings; every fourth time equal, opposite, or nearly so."""
    a = float(rng.uniform(-np.pi, np.pi))
    apart = (0.0, np.pi, 1e-9, np.pi - 1e-6, *rng.uniform(-np.pi, np.pi, 12))[int(rng.integers(16))]
    return a, _wrapped(a + float(apart))


turn_between = Check(
    name="turn_between",
    asks="the shorter turn from a to b, in [-π, π), above 0 to the left",
    start="subtract, then add or subtract whole turns until the result lies between -π and π.",
    draw=_two_headings,
    truth=lambda a, b: _wrapped(b - a),
    mistakes=[
        Mistake(
            lambda a, b: b - a,
            "for 170° and -170° that is -340°, nearly a whole turn in the wrong direction.",
        ),
        Mistake(lambda a, b: _wrapped(a - b), "the sign is wrong: that is the turn from b to a."),
        Mistake(
            lambda a, b: (b - a) % TURN,
            "that lies between 0 and 2π: a turn of 10° to the right becomes 350° to the left.",
        ),
        Mistake(
            lambda a, b: abs(_wrapped(b - a)),
            "left and right look the same in your answer: keep the sign.",
        ),
        Mistake(
            lambda a, b: np.arccos(np.clip(np.cos(b - a), -1, 1)),
            "arccos gives only the size of the turn: left and right look the same.",
        ),
        Mistake(
            lambda a, b: (b - a) % np.pi,
            "after half a turn the body faces the other way: whole turns may be dropped, half turns not.",
        ),
    ],
    same=_same_turn,
)


def _around(rng: np.random.Generator) -> tuple[Array]:
    """Draw headings around the cut at ±180°; now and then all the same."""
    middle = np.pi + rng.uniform(-0.3, 0.3)
    spread = 0.0 if rng.integers(8) == 0 else 0.8
    headings = middle + spread * rng.uniform(-1, 1, int(rng.integers(3, 9)))
    return ((headings + np.pi) % TURN - np.pi,)


def _mean_vector(headings: ArrayLike) -> tuple[float, float]:
    return float(np.sin(headings).mean()), float(np.cos(headings).mean())


mean_heading = Check(
    name="mean_heading",
    asks="the mean direction, in radians",
    start="a heading is a point on the circle, (sin θ, cos θ); take the mean of the points, and its angle.",
    draw=_around,
    truth=lambda headings: np.arctan2(*_mean_vector(headings)),
    mistakes=[
        Mistake(
            lambda headings: np.mean(headings),
            "this way the mean of 170° and -170° is 0°, the opposite of where both look.",
        ),
        Mistake(
            lambda headings: np.arctan2(*_mean_vector(headings)[::-1]),
            "sine and cosine are swapped: arctan2 takes the sine first.",
        ),
        Mistake(
            lambda headings: np.arctan(np.divide(*_mean_vector(headings))),
            "arctan covers only half the circle; arctan2 takes sine and cosine and covers all of it.",
        ),
        Mistake(
            lambda headings: np.median(headings),
            "the median also cuts the circle at ±180°: headings on a circle have no order.",
        ),
        Mistake(
            lambda headings: np.mean(np.asarray(headings) % TURN) + np.pi,
            "that is the opposite direction: the mean is off by half a turn.",
        ),
    ],
    same=close_angles,
)


def _two_frames(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the angles z, x, y of two frames: nearly the same, or near twins, plus whole turns."""
    before = rng.uniform(-1, 1, 3) * [np.pi, 1.2, np.pi]
    # Nearly the same, not quite: then the twin is half a turn away, which could be written with either sign.
    angles = before + rng.choice([1e-8, 1e-3, 0.05, 0.3]) * rng.uniform(-1, 1, 3)
    if rng.integers(2):
        angles = _twin(angles)
    return before, angles + TURN * rng.integers(-1, 2, 3)


def _twin(angles: ArrayLike) -> Array:
    return np.asarray(angles) * [1, -1, 1] + np.pi


def _near(before: ArrayLike, angles: ArrayLike) -> Array:
    """Add the whole turns that bring each angle nearest to the one before."""
    steps = np.subtract(angles, before)
    return np.asarray(np.asarray(angles) - TURN * np.round(steps / TURN))


def _nearest(before: ArrayLike, angles: ArrayLike) -> Array:
    return np.asarray(euler.continuous("ZXY", np.stack([before, angles]))[1])


def _nearer(before: ArrayLike, *candidates: ArrayLike) -> Array:
    return np.asarray(min(candidates, key=lambda c: float(np.abs(np.subtract(c, before)).sum())))


nearest_twin = Check(
    name="nearest_twin",
    asks="the three angles of the same rotation that are nearest to `before`, shape (3,)",
    start="write down the twin; to each of the two add the whole turns that bring it near; which is nearer?",
    draw=_two_frames,
    truth=_nearest,
    mistakes=[
        Mistake(
            lambda before, angles: _near(before, angles),
            "you add whole turns, but never take the twin (a + π, π - b, c + π).",
        ),
        Mistake(
            lambda before, angles: _near(before, _twin(angles)),
            "you always take the twin; take it only where it is nearer.",
        ),
        Mistake(
            lambda before, angles: _nearer(before, angles, _twin(angles)),
            "whole turns are missing: 350° and -10° are the same angle, so bring each candidate near first.",
        ),
        Mistake(
            lambda before, angles: _nearer(
                before, _near(before, angles), _near(before, np.asarray(angles) + np.pi)
            ),
            "the middle angle of the twin is π - b, not b + π.",
        ),
        Mistake(
            lambda before, angles: np.asarray(before),
            "those are the angles of the frame before: the rotation must stay this frame's own.",
        ),
    ],
)


def _parts(rng: np.random.Generator) -> tuple[list[Part]]:
    """Draw slices of walks over the ground; the second sometimes follows the first in the same clip."""
    clips = [rng.uniform(-3, 3, 2) + rng.uniform(0.1, 0.4, (20, 2)).cumsum(axis=0) for _ in range(3)]
    parts = [(clip, int(rng.integers(0, 6)), int(rng.integers(8, 14))) for clip in clips]
    if rng.integers(2):
        parts[1] = (parts[0][0], parts[0][2], parts[0][2] + 4)
    return (parts,)


def _chained(parts: list[Part], back: int = 0) -> Array:
    """Join slices: each first frame where the clip before would have been, `back` frames earlier."""
    pieces, moved = [], np.zeros(2)
    for number, (clip, start, stop) in enumerate(parts):
        if number:
            before, _, end = parts[number - 1]
            moved = moved + before[end - back] - clip[start]
        pieces.append(clip[start:stop] + moved)
    return np.concatenate(pieces)


def _unmoved(parts: list[Part]) -> Array:
    return np.concatenate([clip[start:stop] for clip, start, stop in parts])


def _not_carried_on(parts: list[Part]) -> Array:
    """Move each slice to where the clip before was stored, not to where it was moved."""
    pairs = pairwise(parts)
    moved = [clip[start:stop] - clip[start] + before[end] for (before, _, end), (clip, start, stop) in pairs]
    return np.concatenate([parts[0][0][slice(*parts[0][1:])], *moved])


chain = Check(
    name="chain",
    asks="the places of all slices in a row, shape (N, 2)",
    start="where would the clip before be at its frame `stop`, one step after its slice? Start there.",
    draw=_parts,
    truth=_chained,
    mistakes=[
        Mistake(
            lambda parts: _chained(parts, 1),
            "bug five is still there: the first frame of a slice repeats the last place, so the body stops "
            "for one frame.",
        ),
        Mistake(_unmoved, "slices of different clips must be moved, or the body leaps from clip to clip."),
        Mistake(
            _not_carried_on,
            "you start where the clip before was stored, but that slice was moved, too: add up the moves.",
        ),
        Mistake(
            lambda parts: _chained(parts, -1),
            "you skip a frame: the slice should start at frame `stop` of the clip before, not one later.",
        ),
    ],
)
