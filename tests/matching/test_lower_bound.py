"""The lower bound against measured distances, and the pairs that it leaves against loops over all pairs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.matching import lower_bound, near_pairs
from mocap.matching.distance_grids import cloud_distances
from mocap.matching.lower_bound import projections, sample_directions, squared_length, squared_reach
from mocap.matching.near_pairs import cut_into_leaves, is_sparse, pair_distances, sort_by_diagonal
from mocap.matching.point_clouds import unit_weights
from mocap.matching.prepared_clouds import cloud, join
from tests.strategies import planar, seeds
from tests.tuning import tune

precisions = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def prepared(points, window, dtype=np.float64, random=None):
    """Prepare points, with equal weights of points and frames or random ones, of which some are 0."""
    count = points.shape[1]
    weights, taper = None, None
    if random is not None:
        weights = random.integers(0, 4, count) + (np.arange(count) == 0)
        taper = random.integers(0, 4, window) + (np.arange(window) == 0)
    unit = unit_weights(weights, count)
    return cloud(points, points[..., 1].mean(0), unit, window, dtype, taper=taper)


def random_walk(seed, frames, points=4, size=1.0):
    """Points that move on smoothly, so that windows are near some others."""
    random = np.random.default_rng(seed)
    t = np.arange(frames)[:, None, None] / random.uniform(2, 6, (1, points, 3))
    noise = random.normal(size=(frames, points, 3)) * 0.01
    return size * (np.sin(t + random.uniform(0, 6, (points, 3))) + noise)


def whole(ready):
    return np.flatnonzero(np.isfinite(ready.sizes))


def measured(ready):
    """D of all pairs of windows, in 64 bits."""
    count = len(whole(ready))
    return cloud_distances(*[ready.part(slice(0, count))] * 2).astype(float)


def squares(places):
    return ((places[:, None].astype(float) - places) ** 2).sum(-1)


@precisions
@given(
    seeds,
    st.integers(1, 6),
    st.integers(1, 5),
    st.sampled_from([0.01, 1.0, 100.0]),
    st.booleans(),
    st.booleans(),
)
def test_the_bound_is_below_the_distance(dtype, seed, window, points, size, smooth, weighted):
    random = np.random.default_rng(seed)
    shape = (14 + window, points, 3)
    clip = random_walk(seed, shape[0], points, size) if smooth else random.normal(size=shape) * size
    ready = prepared(clip, window, dtype, random if weighted else None)
    places = projections(ready, whole(ready), sample_directions(ready))
    longest = squared_length(places)
    costs = np.sqrt(measured(ready))
    reach = np.vectorize(lambda below: squared_reach(ready, below, longest))(costs)
    assert np.all(squares(places) <= reach)


@given(seeds, st.integers(1, 2), st.booleans())
def test_with_all_directions_the_bound_lacks_what_its_derivation_says(seed, window, weighted):
    random = np.random.default_rng(seed)
    points = 2  # so few numbers that all directions are there
    ready = prepared(random.normal(size=(20, points, 3)), window, random=random if weighted else None)
    with pytest.MonkeyPatch.context() as patch:
        tune(patch, lower_bound, directions=100)
        places = projections(ready, whole(ready), sample_directions(ready))
    vectors, _ = lower_bound._vectors(ready, whole(ready))
    radius = np.linalg.norm(vectors, axis=1)
    product = np.outer(radius, radius)
    lack = (product - np.abs(vectors @ vectors.conj().T)) ** 2 / np.maximum(product, 1e-12)
    assert measured(ready) - squares(places) == pytest.approx(lack, abs=1e-4)


@given(seeds, planar, st.booleans())
def test_no_planar_transform_changes_the_projections(seed, transform, weighted):
    clip = np.random.default_rng(seed).normal(size=(9, 4, 3))
    ready, moved = (
        prepared(points, 3, random=np.random.default_rng(1) if weighted else None)
        for points in (clip, transform.apply_points(clip))
    )
    directions = sample_directions(ready)
    places, others = (projections(each, whole(each), directions) for each in (ready, moved))
    assert places == pytest.approx(others, abs=1e-5)


@precisions
def test_the_margin_is_small_beside_a_threshold_and_grows_with_the_bodies(dtype):
    body = np.random.default_rng(0).normal(size=(40, 31, 3)) * [0.3, 0.5, 0.3]
    margins = []
    for scale in (1, 10):
        ready = prepared(scale * body, 10, dtype)
        places = projections(ready, whole(ready), sample_directions(ready))
        margins.append(squared_reach(ready, 0.04, squared_length(places)) - 0.04**2)
    assert 0 < margins[0] < 0.05 * 0.04**2  # it is 0.02 to 0.04 of it
    assert margins[1] > 5 * margins[0]


def test_without_a_margin_pairs_would_be_lost_in_32_bits():
    """The measured distance of two windows can be less than the bound: this is what the margin is for."""
    random = np.random.default_rng(5)
    clip = random.normal(size=(30, 8, 3)) * [0, 1, 0] + [0, 5, 0]  # only heights differ, so bound = distance
    ready = prepared(np.concatenate([clip, clip + 1e-3 * random.normal(size=clip.shape)]), 1, np.float32)
    places = projections(ready, whole(ready), sample_directions(ready))
    distances = measured(ready)
    assert np.any(squares(places) > distances)
    longest = squared_length(places)
    reach = np.vectorize(lambda below: squared_reach(ready, below, longest))(np.sqrt(distances))
    assert np.all(squares(places) <= reach)


def test_windows_of_one_point_have_no_ground_to_compare():
    ready = prepared(np.arange(9.0)[:, None, None] * [0, 1, 0], 1)
    places = projections(ready, whole(ready), sample_directions(ready))
    assert np.sqrt(squares(places)) == pytest.approx(np.abs(np.subtract.outer(*2 * [np.arange(9)])), abs=1e-5)


@given(seeds, st.integers(0, 60), st.integers(1, 9))
def test_each_window_is_in_one_leaf_and_in_its_box(seed, count, size):
    random = np.random.default_rng(seed)
    windows = random.permutation(1000)[:count]
    places = random.integers(0, 3, (count, 4)).astype(np.float32)  # many are the same
    with pytest.MonkeyPatch.context() as patch:
        tune(patch, near_pairs, leaf=size)
        leaves = cut_into_leaves(windows, places)
    assert sorted(leaves.windows) == sorted(windows)
    assert np.all(np.diff(leaves.starts) <= size)
    where = dict(zip(windows.tolist(), places, strict=True))
    assert all(
        np.array_equal(where[w], p) for w, p in zip(leaves.windows.tolist(), leaves.projections, strict=True)
    )
    for number in range(len(leaves.low)):
        members = leaves.projections[leaves.leaf(number)]
        assert np.array_equal(leaves.low[number], members.min(0))
        assert np.array_equal(leaves.high[number], members.max(0))


@given(
    seeds, st.integers(0, 40), st.integers(0, 40), st.integers(1, 9), st.floats(0.1, 4), st.integers(-9, 9)
)
def test_near_pairs_are_those_of_all_pairs(seed, rows, columns, size, reach, shift):
    random = np.random.default_rng(seed)
    a, b = (random.normal(size=(count, 3)).astype(np.float32) for count in (rows, columns))
    with pytest.MonkeyPatch.context() as patch:
        tune(patch, near_pairs, leaf=size)
        leaves = [cut_into_leaves(np.arange(len(places)), places) for places in (a, b)]
    found = near_pairs.near_pairs(*leaves, reach, shift=shift, at_most=np.inf)
    exact = ((a[:, None].astype(float) - b) ** 2).sum(-1)
    late = np.subtract.outer(-np.arange(rows), -np.arange(columns)) >= shift
    pairs = set(map(tuple, found.T.tolist()))
    assert len(pairs) == found.shape[1]
    for off, compare in ((-1e-4, pairs.issuperset), (1e-4, pairs.issubset)):  # rounding in 32 bits
        assert compare(set(map(tuple, np.argwhere((exact <= reach + off) & late).tolist())))
    if len(pairs) > 1:
        assert near_pairs.near_pairs(*leaves, reach, shift=shift, at_most=len(pairs) - 1) is None


@precisions
@given(seeds, st.integers(1, 7), st.booleans(), st.integers(1, 30))
def test_distances_of_pairs_are_those_of_the_grid(dtype, seed, window, weighted, together):
    """In runs along diagonals and alone, in any number of parts."""
    random = np.random.default_rng(seed)
    clips = [random_walk(seed + n, 12 + window) for n in range(2)]
    ready = join(
        [prepared(clip, window, dtype, np.random.default_rng(3) if weighted else None) for clip in clips]
    )
    starts = whole(ready)
    chosen = random.random((len(starts), len(starts))) < random.choice([0.05, 0.9])
    chosen[3, 4] = True
    pairs = sort_by_diagonal(starts[np.argwhere(chosen).T])
    assert np.all(np.diff(pairs[1] - pairs[0]) >= 0)
    with pytest.MonkeyPatch.context() as patch:
        tune(patch, near_pairs, pairs_together=together)
        distances = pair_distances(ready, ready, pairs)
    count = len(ready.sizes) - window + 1
    grid = cloud_distances(*[ready.part(slice(0, count))] * 2)
    assert distances.dtype == dtype
    assert distances == pytest.approx(grid[tuple(pairs)], abs=1e-5 if dtype == np.float32 else 1e-13)


def test_few_near_pairs_are_told_from_many_by_a_sample():
    ready = prepared(random_walk(0, 400), 2)
    directions = sample_directions(ready)
    assert is_sparse(ready, directions, 0.01)
    assert not is_sparse(ready, directions, 3.0)
    assert not is_sparse(ready, directions, np.inf)
