"""Notebook 17: inputs, right answers and mistakes of `mixed_trajectory`, `shrink_box` and `box_at`."""

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.course.checks.answers.common import Arguments
from mocap.methods.parametric_graphs.parametric_edges import shrink_box


def shrunk(good: Array, bad: Array, margin: Array, *, reach: Array, unit: Array) -> tuple[Array, Array]:
    """Shrink a box as `shrink_box` does, with another reach of bad targets and another unit of losses."""
    low = good.min(axis=0)
    high = good.max(axis=0)
    for sample in bad:
        if ((sample > low - reach) & (sample < high + reach)).all():
            losses = np.concatenate([sample - low, high - sample]) / np.tile(unit, 2)
            side = int(losses.argmin())
            axis = side % len(low)
            if side < len(low):
                low[axis] = sample[axis] + margin[axis]
            else:
                high[axis] = sample[axis] - margin[axis]
    return low, high


# ---- mixed_trajectory


def draw_mixed_trajectory(rng: np.random.Generator) -> Arguments:
    """Draw the speeds and the turning rates of three walks, their weights, and a time step."""
    speeds = rng.uniform(0.5, 1.5, (3, 12)) + 1j * rng.uniform(-0.2, 0.2, (3, 12))
    turnings = rng.uniform(0.5, 2, (3, 12)) * np.array([[-1.0], [1.0], [0.3]])
    return speeds, turnings, rng.dirichlet(np.ones(3)), 0.1


def right_mixed_trajectory(speeds: Points, turnings: Array, weights: Array, dt: float) -> Points:
    """Add up steps of the mixed speed, each along the heading that the turns before it give."""
    heading = np.append(0, np.cumsum(weights @ turnings * dt))
    return np.append(0, np.cumsum(weights @ speeds * np.exp(1j * heading[:-1]) * dt))


def mistake_positions_mixed(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Integrate each walk by itself, and return the weighted mean of the positions."""
    clips = np.eye(3)
    tracks = [right_mixed_trajectory(speeds, turnings, clip, dt) for clip in clips]
    return weights @ np.array(tracks)


def mistake_heading_half_way(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Take each step along the mean of the headings before and after it."""
    heading = np.append(0, np.cumsum(weights @ turnings * dt))
    middle = (heading[:-1] + heading[1:]) / 2
    return np.append(0, np.cumsum(weights @ speeds * np.exp(1j * middle) * dt))


def mistake_turns_first(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Take each step along the heading after it."""
    heading = np.append(0, np.cumsum(weights @ turnings * dt))
    return np.append(0, np.cumsum(weights @ speeds * np.exp(1j * heading[1:]) * dt))


def mistake_never_turns(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Take all steps along the heading 0."""
    return right_mixed_trajectory(speeds, 0 * turnings, weights, dt)


def mistake_largest_weight_alone(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Integrate the walk of the largest weight alone."""
    return right_mixed_trajectory(speeds, turnings, np.eye(3)[weights.argmax()], dt)


def mistake_first_position_missing(speeds: Points, turnings: Array, weights: Array, dt: float) -> object:
    """Return the T positions after the steps, without the 0 before them."""
    return right_mixed_trajectory(speeds, turnings, weights, dt)[1:]


# ---- shrink_box


def draw_shrink_box(rng: np.random.Generator) -> Arguments:
    """Draw good targets in degrees and m/s, and bad ones near a side of them, the first just outside it."""
    scale = np.array([60.0, 0.4])
    good = rng.uniform([-50, 0.7], [50, 1.3], (12, 2))
    low = good.min(axis=0)
    high = good.max(axis=0)
    bad = rng.uniform(low + 0.05 * (high - low), high - 0.05 * (high - low), (4, 2))
    bad[0, 0] = low[0] - 0.005 * scale[0]
    return good, bad, scale, 0.01


def right_shrink_box(good: Array, bad: Array, scale: Array, eps: float) -> tuple[Array, Array]:
    """Return the box of the good targets, shrunk until no bad one is inside [HG07]."""
    return shrink_box(good, bad, scale, eps)


def mistake_outside_not_kept_off(good: Array, bad: Array, scale: Array, eps: float) -> object:
    """Shrink the box only for bad targets inside it, not for those within the margin outside."""
    return shrunk(good, bad, eps * scale, reach=0 * scale, unit=scale)


def mistake_good_alone(good: Array, bad: Array, scale: Array, eps: float) -> object:
    """Return the bounding box of the good targets."""
    return good.min(axis=0), good.max(axis=0)


def mistake_not_scaled(good: Array, bad: Array, scale: Array, eps: float) -> object:
    """Move the side that loses least in the targets' own units, degrees and m/s."""
    return shrunk(good, bad, eps * scale, reach=eps * scale, unit=np.ones_like(scale))


def mistake_no_margin(good: Array, bad: Array, scale: Array, eps: float) -> object:
    """Shrink the box to the bad targets with eps = 0, so that they are on its sides."""
    return right_shrink_box(good, bad, scale, 0.0)


def mistake_worst_side(good: Array, bad: Array, scale: Array, eps: float) -> object:
    """Move, for each bad target, the side that loses most."""
    return shrunk(good, bad, eps * scale, reach=eps * scale, unit=-scale)


# ---- box_at


def draw_box_at(rng: np.random.Generator) -> Arguments:
    """Draw a request, nine samples with the ends of their boxes, and how many neighbours count."""
    sources = rng.uniform(-75, 75, 9)
    request = float(rng.uniform(-60, 60))
    low = sources - rng.uniform(20, 60, 9)
    high = sources + rng.uniform(20, 60, 9)
    return request, sources, low, high, int(rng.integers(3, 6))


def right_box_at(request: float, sources: Array, low: Array, high: Array, k: int) -> tuple[float, float]:
    """Mix two values of the k nearest samples by 1 / d - 1 / d_k."""
    nearest = np.argsort(np.abs(sources - request))[:k]
    gaps = np.abs(sources - request)[nearest]
    weights = 1 / gaps - 1 / gaps[-1]
    weights = weights / weights.sum()
    return float(weights @ low[nearest]), float(weights @ high[nearest])


def mistake_sources_sorted(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Sort the sources but not their boxes, so that the weights multiply boxes of other samples."""
    return right_box_at(request, np.sort(sources), low, high, k)


def mistake_last_not_subtracted(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Weight the k nearest samples by 1 / d."""
    nearest = np.argsort(np.abs(sources - request))[:k]
    gaps = np.abs(sources - request)[nearest]
    weights = 1 / gaps
    weights = weights / weights.sum()
    return float(weights @ low[nearest]), float(weights @ high[nearest])


def mistake_nearest_subtracted(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Weight the k nearest samples by 1 / d - 1 / d_1, which is 0 for the nearest."""
    nearest = np.argsort(np.abs(sources - request))[:k]
    gaps = np.abs(sources - request)[nearest]
    weights = 1 / gaps - 1 / gaps[0]
    weights = weights / weights.sum()
    return float(weights @ low[nearest]), float(weights @ high[nearest])


def mistake_not_normalised(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Weight the k nearest samples by 1 / d - 1 / d_k without dividing by the sum of the weights."""
    nearest = np.argsort(np.abs(sources - request))[:k]
    gaps = np.abs(sources - request)[nearest]
    weights = 1 / gaps - 1 / gaps[-1]
    return float(weights @ low[nearest]), float(weights @ high[nearest])


def mistake_weighted_by_distance(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Weight the k nearest samples by d."""
    nearest = np.argsort(np.abs(sources - request))[:k]
    gaps = np.abs(sources - request)[nearest]
    weights = gaps / gaps.sum()
    return float(weights @ low[nearest]), float(weights @ high[nearest])


def mistake_nearest_alone(request: float, sources: Array, low: Array, high: Array, k: int) -> object:
    """Return the box of the nearest sample."""
    nearest = int(np.abs(sources - request).argmin())
    return float(low[nearest]), float(high[nearest])
