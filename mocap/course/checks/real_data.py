"""Random input and answers, right and wrong, for `10-real-data.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.feet.footplants import hysteresis


def draw_standing(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw speeds of a foot: swings, runs that almost stand, and plants."""
    levels = rng.permutation([4.0, 0.6, 4.0, 0.2, 4.0, 0.2, 4.0])
    speeds = np.concatenate([level * rng.uniform(0.6, 1.4, rng.integers(3, 8)) for level in levels])
    speeds[: len(speeds) - 2 : 9] = 0.7
    return speeds, 0.2, 0.9


def still(speeds: Array, enter: float, leave: float) -> Mask:
    return hysteresis(speeds, np.ones(len(speeds), bool), enter, leave)


def once_begun(speeds: Array, enter: float, leave: float) -> Mask:
    """Begin only where a speed falls below `enter`, as a single pass over the frames does."""
    marks = np.zeros(len(speeds), bool)
    for frame, speed in enumerate(speeds):
        marks[frame] = speed < enter or (speed < leave and frame > 0 and marks[frame - 1])
    return marks


def draw_running(rng: np.random.Generator) -> tuple[Array, int, float]:
    """Draw speeds that vary with every step, of a walk and then a run."""
    frames, span = 120, 2 * int(rng.integers(3, 10)) + 1
    change = rng.integers(40, 80)
    speeds = np.where(np.arange(frames) < change, 1.2, 2.8) + rng.normal(0, 0.9, frames)
    return np.abs(speeds), span, 2.0


def smooth(speeds: Array, span: int) -> Array:
    counts = np.convolve(np.ones(len(speeds)), np.ones(span), "same")
    return np.asarray(np.convolve(speeds, np.ones(span), "same") / counts)


def share_kept(lengths: Indices, window: float, least: float = 0.0) -> float:
    return float(np.maximum(least, lengths - 2 * window).sum() / lengths.sum())
