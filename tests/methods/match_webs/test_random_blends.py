import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kstest

from mocap.errors import MocapError
from mocap.methods.match_webs import random_weights

VALUES = np.random.default_rng(3).normal(size=(9, 2)) * [20, 0.3]


@given(st.integers(1, 4), st.integers(0, 6), st.floats(0, 0.5), st.integers(0, 99))
def test_weights_add_up_to_one_and_stay_within_the_spread(numbers, more, spread, seed):
    values = np.random.default_rng(seed).normal(size=(numbers + 1 + more, numbers))
    weights = random_weights(values, 30, spread=spread, seed=seed)
    assert np.allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert weights.min() >= -spread - 1e-12 and weights.max() <= 1 + spread + 1e-12
    assert ((weights != 0).sum(axis=1) <= numbers + 1).all()


def test_two_weights_are_even_over_what_is_allowed():
    weights = random_weights([[0.0], [1.0]], 4000, spread=0.1)[:, 0]
    assert kstest((weights + 0.1) / 1.2, "uniform").pvalue > 0.01


def test_partners_are_the_nearest_by_scaled_values():
    weights = random_weights(VALUES, 200, near=3, seed=1)
    scaled = VALUES / VALUES.std(axis=0)
    distance = np.linalg.norm(scaled[:, None] - scaled, axis=-1)
    ranks = distance.argsort(axis=1).argsort(axis=1)
    for row in weights:
        chosen = np.flatnonzero(row)
        assert min(ranks[first][chosen].max() for first in chosen) <= 3


def test_a_seed_gives_the_same_again_and_another_one_others():
    one, same, other = (random_weights(VALUES, 5, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


@pytest.mark.parametrize(
    ("values", "settings", "message"),
    [
        ([[1.0, 2], [3, 4]], {}, "A measure of 2 numbers needs 3 examples, got 2."),
        ([1.0, 2], {}, r"Examples need finite values of shape \(C, d\), got shape \(2,\)"),
        ([[np.nan], [1]], {}, "Examples need finite values"),
        (VALUES, {"spread": -0.1}, "Weights spread by 0 or more beyond 0 and 1, got -0.1"),
    ],
)
def test_hostile_input_is_one_sentence(values, settings, message):
    with pytest.raises(MocapError, match=message):
        random_weights(values, **{"count": 5, **settings})
