"""d′: a guesser has 0, a perfect eye the most that is shown, and the interval holds the truth."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from mocap.course.lab.sensitivity import d_prime, mean_d_prime, sentence
from mocap.errors import MocapError

PAIRS = 20


def simulated(truth, count, rng):
    """Simulate viewers: each film of a pair looks normal with deviation 1, the seam's by d′ worse."""
    seam, control = rng.normal(truth, 1, (count, PAIRS)), rng.normal(0, 1, (count, PAIRS))
    return (seam > control).sum(axis=1)


def test_it_holds_the_truth_by_the_binomial_too():
    """Without simulation: the probability of counts whose interval holds the truth, over a fine grid."""
    limits = np.array([d_prime(k, PAIRS) for k in range(PAIRS + 1)])
    counts = np.arange(PAIRS + 1)
    ways = np.array(
        [float(np.prod(np.arange(PAIRS - k + 1, PAIRS + 1) / np.arange(1, k + 1))) for k in counts]
    )
    for truth in np.linspace(-1, 4, 101):
        p = norm.cdf(truth / np.sqrt(2))
        held = (limits[:, 1] <= truth) & (truth <= limits[:, 2])
        assert np.sum((ways * p**counts * (1 - p) ** (PAIRS - counts))[held]) >= 0.95


def test_a_guesser_has_0_and_a_perfect_eye_the_most():
    values = np.array([d_prime(k, PAIRS).value for k in range(PAIRS + 1)])
    guessed = values[simulated(0.0, 4000, np.random.default_rng(3))]
    assert abs(guessed.mean()) < 0.03
    assert values[::-1] == pytest.approx(-values)  # so the mean of guessers is exactly 0
    assert np.all(np.diff(values) > 0)
    assert values[-1] == pytest.approx(np.sqrt(2) * norm.ppf(20.5 / 21))
    assert set(values[simulated(20.0, 50, np.random.default_rng(4))]) == {values[-1]}


@given(st.integers(1, 60), st.data())
def test_the_estimate_lies_in_its_interval(of, data):
    right = data.draw(st.integers(0, of))
    value, low, high = d_prime(right, of)
    assert low < value < high
    assert d_prime(right, of, 0.5).low >= low
    assert np.isinf(high) == (right == of)
    assert np.isinf(low) == (right == 0)


def test_the_mean_of_a_class_holds_the_truth():
    rng, truth = np.random.default_rng(5), 1.0
    values = np.array([d_prime(k, PAIRS).value for k in range(PAIRS + 1)])
    classes = [mean_d_prime(values[simulated(truth, 12, rng)]) for _ in range(400)]
    assert np.mean([low <= truth <= high for _, low, high in classes]) >= 0.93


@pytest.mark.parametrize(
    ("right", "of", "sure"), [(-1, 20, 0.95), (21, 20, 0.95), (0, 0, 0.95), (5, 20, 1.0)]
)
def test_what_cannot_be_is_said(right, of, sure):
    with pytest.raises(MocapError, match=f"No d′ for {right} right answers of {of}"):
        d_prime(right, of, sure)


@pytest.mark.parametrize(
    ("right", "said"),
    [
        (20, "1.4 or more. You see these seams."),
        (10, "d′ = 0.0, with 95 % confidence from −0.9 to 0.9. That can be guessing"),
        (3, "but you chose the films without one."),
        (0, "−1.4 or less."),
    ],
)
def test_the_sentence_says_what_a_count_shows(right, said):
    assert said in sentence(right, 20)
