"""Checks of notebook 10."""

import numpy as np
from numpy.typing import NDArray

from mocap.checking import Check, Mistake

Array = NDArray[np.float64]


def _stray(places: Array) -> float:
    """Measure how far points on the ground, shape (n, 2), get from where they are on average."""
    return float(np.linalg.norm(places - places.mean(axis=0), axis=1).max())


creep = Check(
    name="creep",
    asks="the largest distance over the ground of a planted frame from the plant's mean place, in metres",
    start="take positions[start:stop], only x and z, and subtract their mean; which row is the longest?",
    draw=lambda rng: (rng.normal(size=(20, 3)), int(rng.integers(1, 8)), int(rng.integers(11, 19))),
    truth=lambda positions, start, stop: _stray(positions[start:stop, [0, 2]]),
    mistakes=[
        Mistake(
            lambda positions, start, stop: np.linalg.norm(
                positions[start:stop] - positions[start:stop].mean(axis=0),
                axis=1,
            ).max(),
            "the height is in it: over the ground only x and z count.",
        ),
        Mistake(
            lambda positions, start, stop: _stray(positions[:, [0, 2]]),
            "that is of all frames; only start <= f < stop belong to the plant.",
        ),
        Mistake(
            lambda positions, start, stop: np.linalg.norm(
                positions[start:stop, [0, 2]] - positions[start, [0, 2]], axis=1
            ).max(),
            "you measure from the first frame; the mean of the plant is what the clean-up keeps.",
        ),
        Mistake(
            lambda positions, start, stop: np.linalg.norm(
                positions[start:stop, [0, 2]] - positions[start:stop, [0, 2]].mean(axis=0), axis=1
            ).mean(),
            "that is how far it strays on average; take the largest.",
        ),
        Mistake(
            lambda positions, start, stop: np.ptp(positions[start:stop, [0, 2]], axis=0).max(),
            "that is the longer side of a box around the places; measure distances from their mean.",
        ),
    ],
)


def _leaping(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw a steady way over the ground with a leap or two, and a bob that is no leap."""
    fps, frames = float(rng.integers(30, 121)), int(rng.integers(20, 50))
    steps = rng.normal(0.8, 0.1, (frames, 3)) / fps
    steps[rng.integers(1, frames, 2), 2] += 9.0 / fps
    steps[rng.integers(1, frames), 1] += 9.0 / fps
    return steps.cumsum(axis=0), fps, 5.0


def _speeds(positions: Array, fps: float) -> Array:
    return np.asarray(np.hypot(*np.diff(positions[:, [0, 2]], axis=0).T) * fps)


leaps = Check(
    name="leaps",
    asks="the frames at which the root arrives over the ground faster than `fastest`, as a list",
    start="np.diff gives the step from each frame to the next; a step lasts 1 / fps seconds.",
    draw=_leaping,
    truth=lambda positions, fps, fastest: (np.flatnonzero(_speeds(positions, fps) > fastest) + 1).tolist(),
    mistakes=[
        Mistake(
            lambda positions, fps, fastest: np.flatnonzero(_speeds(positions, fps) > fastest),
            "these are the frames before the leaps: step f leads from frame f to frame f + 1.",
        ),
        Mistake(
            lambda positions, fps, fastest: np.flatnonzero(_speeds(positions, 1.0) > fastest) + 1,
            "you compare metres a frame with metres a second.",
        ),
        Mistake(
            lambda positions, fps, fastest: (
                np.flatnonzero(np.linalg.norm(np.diff(positions, axis=0), axis=1) * fps > fastest) + 1
            ),
            "a jump upwards is no leap over the ground; leave y out.",
        ),
        Mistake(
            lambda positions, fps, fastest: _speeds(positions, fps) > fastest,
            "that is a mask; np.flatnonzero makes frame numbers of it.",
        ),
    ],
)


def _tempo(rng: np.random.Generator) -> tuple[Array, int, float]:
    """Draw speeds that bob with every step, walking first and then running."""
    frames, span = 120, 2 * int(rng.integers(3, 10)) + 1
    change = rng.integers(40, 80)
    speeds = np.where(np.arange(frames) < change, 1.2, 2.8) + rng.normal(0, 0.9, frames)
    return np.abs(speeds), span, 2.0


def _smooth(speeds: Array, span: int) -> Array:
    counts = np.convolve(np.ones(len(speeds)), np.ones(span), "same")
    return np.asarray(np.convolve(speeds, np.ones(span), "same") / counts)


running = Check(
    name="running",
    asks="for each frame whether the mean speed over the `span` frames around it is above `fastest_walk`",
    start="for frame f take the mean of the speeds from f - span // 2 to f + span // 2 that the clip has.",
    draw=_tempo,
    truth=lambda speeds, span, fastest_walk: _smooth(speeds, span) > fastest_walk,
    mistakes=[
        Mistake(
            lambda speeds, span, fastest_walk: speeds > fastest_walk,
            "frame by frame the label flickers with every step; average over the span first.",
        ),
        Mistake(
            lambda speeds, span, fastest_walk: (
                np.convolve(speeds, np.ones(span) / span, "same") > fastest_walk
            ),
            "at the clip's ends fewer frames are there, and you still divide by all of `span`.",
        ),
        Mistake(
            lambda speeds, span, fastest_walk: (
                np.convolve(speeds, np.ones(span) / span, "valid") > fastest_walk
            ),
            "the ends are missing: every frame needs its label.",
        ),
        Mistake(
            lambda speeds, span, fastest_walk: (
                (np.convolve(speeds, np.ones(span)) / np.convolve(np.ones(len(speeds)), np.ones(span)))[
                    : len(speeds)
                ]
                > fastest_walk
            ),
            "your mean looks only back, so the label comes half a span late; take frames on both sides.",
        ),
        Mistake(
            lambda speeds, span, fastest_walk: _smooth(speeds, span) < fastest_walk,
            "that marks walking; running is the faster one.",
        ),
    ],
)
