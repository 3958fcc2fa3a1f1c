"""Notebook 10: inputs, right answers and mistakes of `standing` and `most_kept`."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.course.checks.answers.common import Arguments, grown

# ---- standing


def draw_standing(rng: np.random.Generator) -> Arguments:
    """Draw speeds of a foot: swings, runs that almost stand, and plants."""
    levels = rng.permutation([4.0, 0.6, 4.0, 0.2, 4.0, 0.2, 4.0])
    speeds = np.concatenate([level * rng.uniform(0.6, 1.4, rng.integers(3, 8)) for level in levels])
    speeds[: len(speeds) - 2 : 9] = 0.7
    return speeds, 0.2, 0.9


def right_standing(speeds: Array, enter: float, leave: float) -> Mask:
    return grown(speeds, enter, leave)


def mistake_enter_alone(speeds: Array, enter: float, leave: float) -> object:
    return speeds < enter


def mistake_leave_alone(speeds: Array, enter: float, leave: float) -> object:
    return speeds < leave


def mistake_forwards_alone(speeds: Array, enter: float, leave: float) -> object:
    return grown(speeds, enter, leave, (1,))


def mistake_swings(speeds: Array, enter: float, leave: float) -> object:
    return ~right_standing(speeds, enter, leave)


# ---- most_kept


def draw_most_kept(rng: np.random.Generator) -> Arguments:
    return rng.integers(5, 200, int(rng.integers(1, 12))), int(rng.integers(3, 20))


def right_most_kept(lengths: Indices, window: int) -> float:
    return float(np.maximum(0, lengths - 2 * window).sum() / lengths.sum())


def mistake_negative_frames(lengths: Indices, window: int) -> object:
    return (lengths - 2 * window).sum() / lengths.sum()


def mistake_single_window(lengths: Indices, window: int) -> object:
    return np.maximum(0, lengths - window).sum() / lengths.sum()


def mistake_number_of_frames(lengths: Indices, window: int) -> object:
    return np.maximum(0, lengths - 2 * window).sum()


def mistake_mean_of_fractions(lengths: Indices, window: int) -> object:
    return np.mean(np.maximum(0, lengths - 2 * window) / lengths)


def mistake_fraction_lost(lengths: Indices, window: int) -> object:
    return 1 - right_most_kept(lengths, window)
