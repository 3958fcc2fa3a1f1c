"""The bound never exceeds the distance, in 32 bits and in 64, and its margin covers what rounding does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.matching import principal_directions
from mocap.matching.distance_grids import cloud, cloud_distances
from mocap.matching.lower_bound import MOST, projections, reach, whole_windows, window_numbers
from mocap.matching.point_clouds import unit_weights
from tests.strategies import planar, seeds

precisions = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def prepared(points, window, dtype, random=None):
    """Prepare points, with equal weights or random ones of which some are 0."""
    count = points.shape[1]
    drawn = None if random is None else random.integers(0, 4, count) + (np.arange(count) == 0)
    weights = unit_weights(drawn, count)
    return cloud(points, points[..., 1].mean(0), weights, window, dtype), weights


def apart(rows):
    return np.linalg.norm(rows[:, None].astype(float) - rows, axis=-1)


def measured(ready):
    count = len(whole_windows(ready))
    return cloud_distances(*[ready.part(slice(0, count))] * 2).astype(float)


@precisions
@given(seeds, st.integers(1, 6), st.integers(1, 5), st.sampled_from([0.01, 1.0, 100.0]), st.booleans())
def test_the_bound_is_below_the_distance_of_random_clouds(dtype, seed, window, points, size, weighted):
    random = np.random.default_rng(seed)
    clip = random.normal(size=(14 + window, points, 3)) * size
    ready, weights = prepared(clip, window, dtype, random if weighted else None)
    starts = whole_windows(ready)
    numbers = window_numbers(ready, starts, weights)
    grid = measured(ready)
    for count in (1, 3, MOST):
        found = projections(ready, starts, weights, principal_directions(numbers, count))
        least = apart(found)
        assert np.all(least <= np.vectorize(lambda cost: reach(ready, cost))(np.sqrt(grid)))
        assert np.all(least <= apart(numbers) + 1e-4 * size)


@given(seeds, planar)
def test_no_planar_transform_changes_the_numbers(seed, transform):
    clip = np.random.default_rng(seed).normal(size=(9, 4, 3))
    ready, weights = prepared(clip, 3, np.float64)
    moved, _ = prepared(transform.apply_points(clip), 3, np.float64)
    starts = whole_windows(ready)
    numbers, others = (window_numbers(each, starts, weights) for each in (ready, moved))
    assert numbers == pytest.approx(others, abs=1e-9)


@precisions
def test_the_margin_is_small_beside_a_threshold_and_grows_with_the_bodies(dtype):
    body = np.random.default_rng(0).normal(size=(40, 31, 3)) * [0.3, 0.5, 0.3]
    ready, _ = prepared(body, 10, dtype)
    large, _ = prepared(10 * body, 10, dtype)
    margins = [reach(each, 0.04) - 0.04 for each in (ready, large)]
    assert 0 < margins[0] < (3e-4 if dtype == np.float32 else 1e-11)
    assert margins[1] > 5 * margins[0]


def test_a_margin_of_nothing_would_lose_pairs_in_32_bits():
    """The measured distance of two windows can be less than the bound: this is what `reach` is for."""
    random = np.random.default_rng(5)
    clip = random.normal(size=(30, 8, 3)) * [0, 1, 0] + [0, 5, 0]  # only heights differ, so bound = distance
    twice = np.concatenate([clip, clip + 1e-3 * random.normal(size=clip.shape)])
    ready, weights = prepared(twice, 1, np.float32)
    starts = whole_windows(ready)
    numbers = window_numbers(ready, starts, weights)
    least = apart(projections(ready, starts, weights, principal_directions(numbers)))
    cost = np.sqrt(measured(ready))
    assert np.any(least > cost)
    assert np.all(least <= np.vectorize(lambda each: reach(ready, each))(cost))
