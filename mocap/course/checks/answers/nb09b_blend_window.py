"""Notebook 09b: inputs, right answers and mistakes of `added_jolt` and `paired_gain`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.course.checks.answers.common import Arguments

# ---- added_jolt


def draw_added_jolt(rng: np.random.Generator) -> Arguments:
    """Draw tracks of a joint in two clips, and a blend of them with a little noise."""
    first = rng.normal(size=(int(rng.integers(12, 40)), 3)).cumsum(axis=0)
    second = first + rng.normal(size=first.shape).cumsum(axis=0)
    window = len(first) - 8
    alpha = np.concatenate([np.ones(4), 1 - np.arange(1, window + 1) / window, np.zeros(4)])
    mixed = alpha[:, None] * first + (1 - alpha[:, None]) * second
    return mixed + 0.1 * rng.normal(size=first.shape), first, second, alpha, float(rng.integers(24, 121))


def right_added_jolt(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> float:
    """Second differences of a blend without the mean of those of its clips, (F - 2, 3)."""
    share = alpha[1:-1, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return float(np.linalg.norm(added, axis=1).max() * fps)


def mistake_weights_early(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Mix the clips' second differences by the weights of the frame before."""
    share = alpha[:-2, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return np.linalg.norm(added, axis=1).max() * fps


def mistake_weights_late(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Mix the clips' second differences by the weights of the frame after."""
    share = alpha[2:, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return np.linalg.norm(added, axis=1).max() * fps


def mistake_weights_exchanged(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Mix the clips' second differences with α for the second clip and 1 - α for the first."""
    share = alpha[1:-1, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, second, first)]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return np.linalg.norm(added, axis=1).max() * fps


def mistake_whole_jolt(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Return the largest change of the blend's velocity, with those of the clips included."""
    return np.linalg.norm(np.diff(result, 2, axis=0), axis=1).max() * fps


def mistake_mixed_before_differences(
    result: Array, first: Array, second: Array, alpha: Array, fps: float
) -> object:
    """Mix the clips' positions, and take the second differences of the blend minus this mixture."""
    mixed = alpha[:, None] * first + (1 - alpha[:, None]) * second
    added = np.diff(result - mixed, 2, axis=0)
    return np.linalg.norm(added, axis=1).max() * fps


def mistake_per_frame(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Return the largest added change of velocity in metres per frame."""
    return right_added_jolt(result, first, second, alpha, fps) / fps


def mistake_acceleration(result: Array, first: Array, second: Array, alpha: Array, fps: float) -> object:
    """Return the right change of velocity times fps once more, in m/s²."""
    return right_added_jolt(result, first, second, alpha, fps) * fps


def mistake_largest_coordinate(
    result: Array, first: Array, second: Array, alpha: Array, fps: float
) -> object:
    """Return the largest absolute coordinate of the added vectors instead of the largest length."""
    share = alpha[1:-1, None]
    changes = [np.diff(places, 2, axis=0) for places in (result, first, second)]
    added = changes[0] - share * changes[1] - (1 - share) * changes[2]
    return np.abs(added).max() * fps


# ---- paired_gain


def draw_paired_gain(rng: np.random.Generator) -> Arguments:
    """Draw the costs of some matches by one method, and by another that saves about a tenth."""
    old_costs = rng.gamma(3.0, 2.0, int(rng.integers(5, 20)))
    return old_costs, old_costs * rng.uniform(0.7, 1.1) + rng.normal(0, 0.3, len(old_costs))


def right_paired_gain(old_costs: Array, new_costs: Array) -> Array:
    """Return the quartiles and the median of the differences, match by match."""
    return np.percentile(old_costs - new_costs, [25, 50, 75])


def mistake_difference_of_quartiles(old_costs: Array, new_costs: Array) -> object:
    """Return the quartiles of the old costs minus those of the new costs."""
    return np.percentile(old_costs, [25, 50, 75]) - np.percentile(new_costs, [25, 50, 75])


def mistake_loss(old_costs: Array, new_costs: Array) -> object:
    """Return the quartiles of new minus old costs, match by match."""
    return np.percentile(new_costs - old_costs, [25, 50, 75])


def mistake_absolute_gain(old_costs: Array, new_costs: Array) -> object:
    """Return the quartiles of the absolute differences, match by match."""
    return np.percentile(np.abs(old_costs - new_costs), [25, 50, 75])


def mistake_pairs_sorted(old_costs: Array, new_costs: Array) -> object:
    """Return the quartiles of the differences after sorting both lists of costs."""
    return np.percentile(np.sort(old_costs) - np.sort(new_costs), [25, 50, 75])


def mistake_median_alone(old_costs: Array, new_costs: Array) -> object:
    """Return the median of the differences as one number."""
    return np.median(old_costs - new_costs)


def mistake_fractions_for_percent(old_costs: Array, new_costs: Array) -> object:
    """Return the percentiles 0.25 %, 0.5 % and 0.75 % of the differences."""
    return np.percentile(old_costs - new_costs, [0.25, 0.5, 0.75])
