"""Checks of notebook 10."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.course.check import Check, Mistake
from mocap.feet.footplants import hysteresis


def _creeping(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw speeds of a foot: swings, runs that almost stand, and plants."""
    levels = rng.permutation([4.0, 0.6, 4.0, 0.2, 4.0, 0.2, 4.0])
    speeds = np.concatenate([level * rng.uniform(0.6, 1.4, rng.integers(3, 8)) for level in levels])
    speeds[: len(speeds) - 2 : 9] = 0.7
    return speeds, 0.2, 0.9


def _still(speeds: Array, enter: float, leave: float) -> Mask:
    return hysteresis(speeds, np.ones(len(speeds), bool), enter, leave)


def _once_begun(speeds: Array, enter: float, leave: float) -> Mask:
    """Begin only where a speed falls below `enter`, as a single pass over the frames does."""
    marks = np.zeros(len(speeds), bool)
    for frame, speed in enumerate(speeds):
        marks[frame] = speed < enter or (speed < leave and frame > 0 and marks[frame - 1])
    return marks


standing = Check(
    name="standing",
    asks="a mask of the runs below `leave` in which some frame is below `enter`",
    start="runs(speeds < leave) lists the runs; which of them have a frame below `enter`?",
    draw=_creeping,
    truth=_still,
    mistakes=[
        Mistake(
            lambda speeds, enter, leave: speeds < enter,
            "that is one threshold, the strict one: noise cuts each plant into pieces.",
        ),
        Mistake(
            lambda speeds, enter, leave: speeds < leave,
            "that is one threshold, the loose one: it keeps runs that never slow down to `enter`.",
        ),
        Mistake(
            _once_begun,
            "a run begins at its first frame below `leave`, even before it falls below `enter`.",
        ),
        Mistake(
            lambda speeds, enter, leave: _still(speeds, leave, enter),
            "the thresholds are swapped: `enter` is the stricter one.",
        ),
        Mistake(
            lambda speeds, enter, leave: ~_still(speeds, enter, leave),
            "that marks the swings.",
        ),
    ],
)


def _tempo(rng: np.random.Generator) -> tuple[Array, int, float]:
    """Draw speeds that vary with every step, of a walk and then a run."""
    frames, span = 120, 2 * int(rng.integers(3, 10)) + 1
    change = rng.integers(40, 80)
    speeds = np.where(np.arange(frames) < change, 1.2, 2.8) + rng.normal(0, 0.9, frames)
    return np.abs(speeds), span, 2.0


def _smooth(speeds: Array, span: int) -> Array:
    counts = np.convolve(np.ones(len(speeds)), np.ones(span), "same")
    return np.asarray(np.convolve(speeds, np.ones(span), "same") / counts)


running = Check(
    name="running",
    asks="for each frame, whether the mean speed over the `span` frames around it is above `fastest_walk`",
    start="for frame f, take the mean of the speeds in frames f - span // 2 to f + span // 2 of the clip.",
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
            "there are fewer frames at the clip's ends, but you still divide by all of `span`.",
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
            "your mean uses only earlier frames, so the label is half a span late; use both sides.",
        ),
        Mistake(
            lambda speeds, span, fastest_walk: _smooth(speeds, span) < fastest_walk,
            "that marks walking; running is the faster one.",
        ),
    ],
)


def _takes(rng: np.random.Generator) -> tuple[Indices, int]:
    """Draw lengths of takes and a window; some takes are shorter than two windows."""
    return rng.integers(5, 200, int(rng.integers(1, 12))), int(rng.integers(3, 20))


def _share_kept(lengths: Indices, window: float, least: float = 0.0) -> float:
    return float(np.maximum(least, lengths - 2 * window).sum() / lengths.sum())


most_kept = Check(
    name="most_kept",
    asks="the share of all frames that lie at least a window from both ends of their clip",
    start="how many frames does a clip of L frames keep? Add them up, and divide by all frames.",
    draw=_takes,
    truth=_share_kept,
    mistakes=[
        Mistake(
            lambda lengths, window: _share_kept(lengths, window, -np.inf),
            "a clip shorter than two windows keeps no frames, not fewer than none: use max(0, L - 2w).",
        ),
        Mistake(
            lambda lengths, window: _share_kept(lengths, window / 2),
            "every clip loses a window at *both* ends.",
        ),
        Mistake(
            lambda lengths, window: np.maximum(0, lengths - 2 * window).sum(),
            "that is a number of frames; divide by the number of all frames.",
        ),
        Mistake(
            lambda lengths, window: np.mean(np.maximum(0, lengths - 2 * window) / lengths),
            "a mean of shares counts short clips as much as long ones: add up the frames first.",
        ),
        Mistake(
            lambda lengths, window: 1 - _share_kept(lengths, window),
            "that is the share that is lost.",
        ),
    ],
)
