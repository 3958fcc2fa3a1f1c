"""Notebook 10: inputs, right answers and mistakes of `standing` and `most_kept`."""

from collections.abc import Callable
from itertools import groupby
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.course.checks.answers.common import Arguments, grown


def runs_that(speeds: Array, enter: float, leave: float, test: Callable[[Mask], Any]) -> list[bool]:
    """Mark the runs below `leave` that pass a test of which frames are below `enter`."""
    marks: list[bool] = []
    for is_low, run in groupby(speeds.tolist(), lambda speed: speed < leave):
        frames = np.array(list(run))
        marks += [is_low and bool(test(frames < enter))] * len(frames)
    return marks


# ---- standing


def draw_standing(rng: np.random.Generator) -> Arguments:
    """Draw speeds of a foot: swings, runs that almost stand, and plants."""
    levels = rng.permutation([4.0, 0.6, 4.0, 0.2, 4.0, 0.2, 4.0])
    speeds = np.concatenate([level * rng.uniform(0.6, 1.4, rng.integers(3, 8)) for level in levels])
    speeds[: len(speeds) - 2 : 9] = 0.7
    speeds[rng.integers(1, len(speeds) - 1, 2)] = rng.permutation([0.2, 0.9])  # at the thresholds
    return speeds, 0.2, 0.9


def right_standing(speeds: Array, enter: float, leave: float) -> Mask:
    """Return the runs below the higher speed that fall below the lower one."""
    return grown(speeds, enter, leave)


def mistake_enter_alone(speeds: Array, enter: float, leave: float) -> object:
    """Mark the frames below the lower speed."""
    return speeds < enter


def mistake_leave_alone(speeds: Array, enter: float, leave: float) -> object:
    """Mark the frames below the higher speed."""
    return speeds < leave


def mistake_forwards_alone(speeds: Array, enter: float, leave: float) -> object:
    """Extend the marks from frames below the lower speed only to later frames below the higher one."""
    return grown(speeds, enter, leave, (1,))


def mistake_swings(speeds: Array, enter: float, leave: float) -> object:
    """Mark the frames that the right answer does not mark."""
    return ~right_standing(speeds, enter, leave)


def mistake_all_frames_strict(speeds: Array, enter: float, leave: float) -> object:
    """Mark the runs below the higher speed in which all frames are also below the lower one."""
    return np.array(runs_that(speeds, enter, leave, np.all))


def mistake_runs_themselves(speeds: Array, enter: float, leave: float) -> object:
    """Return the right runs as pairs (start, stop), shape (R, 2), instead of a mask."""
    edges = np.diff(np.concatenate([[0], right_standing(speeds, enter, leave).astype(int), [0]]))
    return np.argwhere(edges)[:, 0].reshape(-1, 2)


def mistake_backwards_alone(speeds: Array, enter: float, leave: float) -> object:
    """Extend the marks from frames below the lower speed only to earlier frames below the higher one."""
    return grown(speeds, enter, leave, (-1,))


def mistake_at_thresholds(speeds: Array, enter: float, leave: float) -> object:
    """Compare with <= at both thresholds."""
    return grown(speeds, np.nextafter(enter, np.inf), np.nextafter(leave, np.inf))


def mistake_at_leave(speeds: Array, enter: float, leave: float) -> object:
    """Compare with <= at the higher threshold and < at the lower one."""
    return grown(speeds, enter, np.nextafter(leave, np.inf))


def mistake_at_enter(speeds: Array, enter: float, leave: float) -> object:
    """Compare with <= at the lower threshold and < at the higher one."""
    return grown(speeds, np.nextafter(enter, np.inf), leave)


def mistake_between_thresholds(speeds: Array, enter: float, leave: float) -> object:
    """Mark the frames with enter <= speed < leave."""
    return (speeds >= enter) & (speeds < leave)


def mistake_indices(speeds: Array, enter: float, leave: float) -> object:
    """Return the indices of the right frames instead of a mask."""
    return np.flatnonzero(right_standing(speeds, enter, leave))


# ---- most_kept


def draw_most_kept(rng: np.random.Generator) -> Arguments:
    """Draw the lengths of some clips, and a window, in frames."""
    return rng.integers(5, 200, int(rng.integers(1, 12))), int(rng.integers(3, 20))


def right_most_kept(lengths: Indices, window: int) -> float:
    """Return the share of frames that are a window away from both ends of their clip."""
    return float(np.maximum(0, lengths - 2 * window).sum() / lengths.sum())


def mistake_negative_frames(lengths: Indices, window: int) -> object:
    """Return Σ (L - 2w) / Σ L, with negative terms for clips shorter than two windows."""
    return (lengths - 2 * window).sum() / lengths.sum()


def mistake_single_window(lengths: Indices, window: int) -> object:
    """Return the fraction of frames that are a window away from one end of their clip."""
    return np.maximum(0, lengths - window).sum() / lengths.sum()


def mistake_number_of_frames(lengths: Indices, window: int) -> object:
    """Return the number of frames kept in all clips, not divided by the number of all."""
    return np.maximum(0, lengths - 2 * window).sum()


def mistake_mean_of_fractions(lengths: Indices, window: int) -> object:
    """Return the mean over the clips of the fraction that each keeps."""
    return np.mean(np.maximum(0, lengths - 2 * window) / lengths)


def mistake_fraction_lost(lengths: Indices, window: int) -> object:
    """Return the fraction of frames within a window of an end of their clip."""
    return 1 - right_most_kept(lengths, window)


def mistake_share_of_each_clip(lengths: Indices, window: int) -> object:
    """Return the fraction that each clip keeps, shape (N,)."""
    return np.maximum(0, lengths - 2 * window) / lengths


def mistake_frames_of_each_clip(lengths: Indices, window: int) -> object:
    """Return the number of frames that each clip keeps, shape (N,)."""
    return np.maximum(0, lengths - 2 * window)


def mistake_short_clips_left_out(lengths: Indices, window: int) -> object:
    """Return the fraction kept of the frames of clips longer than two windows."""
    kept = lengths[lengths > 2 * window]
    return (kept - 2 * window).sum() / max(1, kept.sum())


def mistake_two_windows_of_all(lengths: Indices, window: int) -> object:
    """Return the fraction kept if all clips were one, which loses two windows in all."""
    return max(0, lengths.sum() - 2 * window) / lengths.sum()


def mistake_largest_clip(lengths: Indices, window: int) -> object:
    """Return the fraction kept of the clip that keeps most of itself, the longest."""
    return (np.maximum(0, lengths - 2 * window) / lengths).max()
