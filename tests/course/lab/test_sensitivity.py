"""d′: a guesser has 0, a perfect eye the most that is shown, and the interval holds the truth."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from mocap.course.lab import class_curve
from mocap.course.lab.sensitivity import COLUMNS, Answer, d_prime, mean_d_prime, read_answers, sentence
from mocap.plotting import seen_beside_measured
from tests.refusals import refused

PAIRS = 20
HEAD = ",".join(COLUMNS)


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
    assert np.isinf(high) == (right == of)
    assert np.isinf(low) == (right == 0)


def test_the_mean_of_a_class_holds_the_truth():
    rng, truth = np.random.default_rng(5), 1.0
    values = np.array([d_prime(k, PAIRS).value for k in range(PAIRS + 1)])
    classes = [mean_d_prime(values[simulated(truth, 12, rng)]) for _ in range(400)]
    assert np.mean([low <= truth <= high for _, low, high in classes]) >= 0.93


@pytest.mark.parametrize(("right", "of"), [(-1, 20), (21, 20), (0, 0)])
def test_what_cannot_be_is_said(right, of):
    refused(f"No d′ for {right} right answers of {of}", d_prime, right, of)


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


# The files of a class as one curve


def file(folder, name, rows):
    path = folder / f"{name}.csv"
    path.write_text("\n".join([HEAD, *rows]) + "\n", "utf-8")
    return path


def rows(observer, right, window=10, seed=0):
    return [f"{observer},4.0,{window},{seed},{n + 1},{int(n < right)},left,2.5" for n in range(20)]


def test_a_class_is_joined_to_a_curve(tmp_path):
    files = [
        file(tmp_path, f"{who}-{window}", rows(who, right, window))
        for who, window, right in [("ada", 2, 19), ("ada", 10, 12), ("bo", 10, 15), ("cy", 10, 9)]
    ]
    curve = class_curve(read_answers(files), "window")
    assert [point[:4] for point in curve] == [(2.0, 1, 19, 20), (10.0, 3, 36, 60)]
    assert curve[0].seen == d_prime(19, 20)
    assert curve[1].seen == mean_d_prime([d_prime(right, 20).value for right in (12, 15, 9)])


def test_two_tests_of_one_person_add_up_and_a_file_read_twice_counts_once(tmp_path):
    one = file(tmp_path, "a", rows("ada", 12))
    two = file(tmp_path, "b", rows("ada", 16, seed=1))
    (point,) = class_curve(read_answers([one, two, one]), "below_cm")
    assert point == (4.0, 1, 28, 40, d_prime(28, 40))


def test_one_file_needs_no_list_and_a_curve_runs_over_what_was_varied(tmp_path):
    one = file(tmp_path, "a", rows("ada", 12))
    answers = read_answers([one])
    assert read_answers(one) == read_answers(str(one)) == answers
    refused("runs over 'below_cm' or 'window', got 'below'", class_curve, answers, "below")


def test_the_other_setting_must_be_one(tmp_path):
    answers = read_answers([file(tmp_path, "a", rows("a", 9)), file(tmp_path, "b", rows("b", 9, window=2))])
    refused(r"one 'window', got \[2, 10\]", class_curve, answers, "below_cm")
    refused("one 'below_cm', got", class_curve, [], "window")


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["ada,4.0,10,0,1,2,left,2.5"], r"line 2: expected an answer in 8 columns"),
        (["ada,4.0,10,0,1,1,left"], r"line 2: expected"),
        (["ada,4.0,10,0,1,1,left,2.5", "ada,much,10,0,1,1,left,2.5"], r"line 3: expected"),
        (
            [f"ada,4.0,10,0,1,{right},left,2.5" for right in (1, 0)],
            "'ada' answered pair 1 twice, differently",
        ),
        ([""], "line 2: expected"),
    ],
)
def test_what_is_no_answer_is_said(lines, said, tmp_path):
    refused(said, read_answers, [file(tmp_path, "a", lines)])


def test_what_is_no_file_of_answers_is_said(tmp_path):
    for name, text in (("a", b"x,y\n"), ("e", b""), ("b", b"\xff\xfe\x00")):
        (tmp_path / f"{name}.csv").write_bytes(text)
    for name, said in (
        ("a", "line 1: expected observer,below_cm"),
        ("e", "line 1: expected"),
        ("b", r"b\.csv: is not a text"),
        ("no", r"no\.csv: No such file"),
    ):
        refused(said, read_answers, [tmp_path / f"{name}.csv"])


def test_the_picture_shows_the_curve_above_the_measure():
    """A simulated class that sees short blends better: the curve falls with the window."""
    rng, windows = np.random.default_rng(0), [2, 6, 20]
    answers = [
        Answer(f"{who}", 8.0, window, 0, pair, bool(rng.normal(truth, 1) > rng.normal(0, 1)))
        for window, truth in zip(windows, (3, 1, 0), strict=True)
        for who in range(10)
        for pair in range(20)
    ]
    curve = class_curve(answers, "window")
    values = [point.seen.value for point in curve]
    assert values == sorted(values, reverse=True)
    assert curve[-1].seen.low < 0 < curve[-1].seen.high
    points = [(point.setting, *point.seen) for point in curve]
    upper, lower = seen_beside_measured(points, windows, np.ones((3, 5)), ("window (frames)", "jolt (m/s)"))
    assert upper.lines[1].get_ydata().tolist() == values
    assert lower.get_xlabel() == "window (frames)"
