"""Blind tests: their pairs, what stands in the page, and what answers say of an eye and of a class."""

import base64
import zlib
from functools import cache

import numpy as np
import pytest
from scipy.stats import binom, norm

from mocap import datasets
from mocap.body import joint_positions
from mocap.course import lab
from mocap.course.lab.blind_tests import STEP, BlindTest, choose, make_pairs
from mocap.course.lab.sensitivity import COLUMNS, class_curve, d_prime, mean_d_prime, read_answers, sentence
from mocap.matching import find_transitions
from mocap.plotting import bones
from tests.refusals import refusals, refused, refused_texts


@cache
def material():
    clips = [datasets.sample(name)[:2400:4] for name in ("walk_circle", "walk_curve_1")]
    return clips, find_transitions(clips, window=10, below=0.06)


def drawn(window=10, below=0.04, seed=0):
    clips, found = material()
    return make_pairs(clips, choose(clips, found, below, seed), window, seed)


def test_the_same_seed_gives_the_same_pairs_and_another_one_others():
    first, again, other = (drawn(seed=seed) for seed in (1, 1, 2))
    assert [pair.on_left for pair in first] == [pair.on_left for pair in again]
    for a, b in zip(first, again, strict=True):
        assert np.array_equal(a.seam.root_positions, b.seam.root_positions)
    assert [pair.match.leave for pair in first] != [pair.match.leave for pair in other]


def test_sides_and_controls_are_drawn():
    pairs = [pair for seed in range(5) for pair in drawn(seed=seed)]
    assert 35 <= sum(pair.on_left for pair in pairs) <= 65
    clips = {clip.name for clip in material()[0]}
    assert {pair.control.name for pair in pairs} == clips


def test_a_control_is_its_clip_and_shares_half_of_the_film_with_the_seam():
    clips, _ = material()
    for pair in drawn(window=2):
        assert len(pair.seam) == len(pair.control) == 78
        apart = np.linalg.norm(joint_positions(pair.seam) - joint_positions(pair.control), axis=-1)
        same = apart.max(axis=1) < 1e-6
        assert same[:25].all() or same[-25:].all()
        assert not same.all()
        assert any(_is_part(pair.control, clip) for clip in clips)
        assert 0.75 * 0.04 < pair.match.cost <= 0.04


def _is_part(film, clip):
    """Whether a film is a piece of a clip, turned and moved: the heights of its joints are the clip's."""
    heights, of_clip = joint_positions(film)[..., 1], joint_positions(clip)[..., 1]
    starts = np.flatnonzero(np.abs(of_clip[: len(clip) - len(film) + 1] - heights[0]).max(axis=1) < 1e-9)
    return any(np.allclose(of_clip[s : s + len(film)], heights) for s in starts)


def test_only_the_film_with_the_seam_has_the_blend_s_jolt():
    """Short blends of worse matches jolt; their controls do not: what a perfect eye can see is there."""
    pairs = drawn(window=1, below=0.06)
    jolts = [[_largest_jolt(pair.seam), _largest_jolt(pair.control)] for pair in pairs]
    assert np.median([seam / control for seam, control in jolts]) > 1.5


def _largest_jolt(film):
    second = np.diff(joint_positions(film), 2, axis=0)
    return np.sqrt((second**2).sum(axis=-1).mean(axis=-1)).max()


def test_as_many_matches_are_chosen_as_are_asked_for():
    assert len(choose(*material(), 0.04, 0, count=3)) == 3


test_what_makes_no_blind_test_and_no_d_prime_is_said = refusals(
    (
        r"needs 20 matches of 0\.8 to 1\.0 cm, with 1\.6 s .*; got \d+\.$",
        lambda: lab.blind_test(*material(), below=0.01),
    ),
    *(
        (f"1 to 60 frames here, got {window}", lambda window=window: lab.blind_test(*material(), window))
        for window in (0, -3, 61)
    ),
    ("clips of one rate", lambda: lab.blind_test([material()[0][0], datasets.sample("jog")], material()[1])),
    *(
        (f"No d′ for {right} right answers of {of}", d_prime, right, of)
        for right, of in ((-1, 20), (21, 20), (0, 0))
    ),
    ("one 'below_cm', got", class_curve, [], "window"),
)


def test_the_page_has_films_and_sentences_and_says_without_a_script_what_it_is():
    test = lab.blind_test(*material())
    assert isinstance(test, BlindTest)
    data = test.scene
    assert len(data["onLeft"]) == 20
    assert len(data["films"]) == 40
    assert len(data["sentences"]) == 21
    assert data["plan"] == {"below_cm": 4.0, "window": 10, "seed": 0}
    bundle, metadata = test._repr_mimebundle_()
    assert metadata["image/png"]["alt"] in bundle["text/html"]
    assert base64.b64decode(bundle["image/png"])[1:4] == b"PNG"
    assert bundle["text/plain"].startswith("Blind test: 20 pairs")
    assert len(test.html()) < 300_000


def test_the_films_are_exact_to_half_a_step():
    pair = drawn()[3]
    film, scene = pair.seam, BlindTest([pair], 10, 0.04, 0).scene
    body, (first, second), data = scene["body"], scene["films"], scene["data"]
    assert second["offset"] == 2 * 3 * first["frames"] * body["joints"]
    numbers = np.frombuffer(zlib.decompress(data), "<u2")[: second["offset"] // 2]
    places = np.cumsum(np.cumsum(numbers.reshape(-1, 3, first["frames"]), -1, dtype="<u2"), -1, dtype="<u2")
    points = np.moveaxis(places * STEP, -1, 0) + first["low"]
    starts, ends, _ = bones(film.skeleton)
    assert np.abs(points - joint_positions(film)[:, np.unique([0, *starts, *ends])]).max() < 0.6 * STEP


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
    for truth in np.linspace(-1, 4, 101):
        held = (limits[:, 1] <= truth) & (truth <= limits[:, 2])
        assert np.sum(binom.pmf(counts, PAIRS, norm.cdf(truth / np.sqrt(2)))[held]) >= 0.95


def test_a_guesser_has_0_and_a_perfect_eye_the_most():
    values = np.array([d_prime(k, PAIRS).value for k in range(PAIRS + 1)])
    guessed = values[simulated(0.0, 4000, np.random.default_rng(3))]
    assert abs(guessed.mean()) < 0.03
    assert values[::-1] == pytest.approx(-values)  # so the mean of guessers is exactly 0
    assert np.all(np.diff(values) > 0)
    assert values[-1] == pytest.approx(np.sqrt(2) * norm.ppf(20.5 / 21))
    assert set(values[simulated(20.0, 50, np.random.default_rng(4))]) == {values[-1]}


def test_the_mean_of_a_class_holds_the_truth():
    rng, truth = np.random.default_rng(5), 1.0
    values = np.array([d_prime(k, PAIRS).value for k in range(PAIRS + 1)])
    classes = [mean_d_prime(values[simulated(truth, 12, rng)]) for _ in range(400)]
    assert np.mean([low <= truth <= high for _, low, high in classes]) >= 0.93


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
    of_three = mean_d_prime([d_prime(right, 20).value for right in (12, 15, 9)])
    assert list(curve.items()) == [(2.0, d_prime(19, 20)), (10.0, of_three)]


def test_two_tests_of_one_person_add_up_and_a_file_read_twice_counts_once(tmp_path):
    one = file(tmp_path, "a", rows("ada", 12))
    two = file(tmp_path, "b", rows("ada", 16, seed=1))
    assert class_curve(read_answers([one, two, one]), "below_cm") == {4.0: d_prime(28, 40)}


def test_one_file_needs_no_list_and_a_curve_runs_over_what_was_varied(tmp_path):
    one = file(tmp_path, "a", rows("ada", 12))
    answers = read_answers([one])
    assert read_answers(one) == read_answers(str(one)) == answers
    refused("runs over 'below_cm' or 'window', got 'below'", class_curve, answers, "below")


def test_the_other_setting_must_be_one(tmp_path):
    answers = read_answers([file(tmp_path, "a", rows("a", 9)), file(tmp_path, "b", rows("b", 9, window=2))])
    refused(r"one 'window', got \[2, 10\]", class_curve, answers, "below_cm")


ADA = "ada,4.0,10,0,1"


test_what_is_no_file_of_answers_is_said = refused_texts(
    lambda file: read_answers([file]),
    "a.csv",
    (f"{HEAD}\n{ADA},2,left,2.5\n", r"line 2: expected an answer in 8 columns"),
    (f"{HEAD}\n{ADA},1,left\n", r"line 2: expected"),
    (f"{HEAD}\n{ADA},1,left,2.5\nada,much,10,0,1,1,left,2.5\n", r"line 3: expected"),
    (f"{HEAD}\n{ADA},1,left,2.5\n{ADA},0,left,2.5\n", "'ada' answered pair 1 twice, differently"),
    (f"{HEAD}\n\n", "line 2: expected"),
    ("x,y\n", "line 1: expected observer,below_cm"),
    ("", r"a\.csv: expected some text, got an empty file"),
    (b"ab\x00", r"a\.csv, line 1: expected text, got a zero byte"),
)
test_no_file_is_said = refusals((r"Cannot read .*a\.csv: No such file", read_answers, ["nowhere/a.csv"]))
