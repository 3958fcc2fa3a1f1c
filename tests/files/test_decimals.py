"""The numbers of long texts, compared with those that `float` reads, to the bit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.files import decimals
from mocap.files.decimals import parse_numbers

FORMATS = ["{:.6f}", "{:.2f}", "{:g}", "{:r}", "{:.0f}", "{:.17g}", "{:+.3f}", "{:.4e}"]
NUMBERS = (
    st.floats(-1e9, 1e9) | st.integers(-(10**6), 10**6).map(float) | st.sampled_from([0.0, -0.0, 5e-324])
)


@st.composite
def words(draw):
    """Return a number as some program writes it."""
    number = draw(NUMBERS)
    form = draw(st.sampled_from(FORMATS))
    return repr(number) if form == "{:r}" else form.format(number)


def floats(text):
    """Return the numbers that Python reads, as integers of the same bits."""
    return np.array([float(word) for word in text.split()]).view(np.int64)


@given(st.lists(st.tuples(words(), st.sampled_from([" ", "\n", "\t", " \n\n", "\r\n"])), min_size=1))
def test_numbers_are_those_of_float_to_the_bit(parts):
    text = "".join(word + blank for word, blank in parts)
    assert np.array_equal(parse_numbers(text).view(np.int64), floats(text))


@given(st.integers(-(10**15), 10**15), st.integers(1, 15))
def test_decimals_of_15_digits_are_those_of_float_to_the_bit(integer, places):
    text = f"{'-' * (integer < 0)}{abs(integer) // 10**places}.{abs(integer) % 10**places:0{places}d}"
    assert np.array_equal(parse_numbers(text).view(np.int64), floats(text))


ODD = [
    "5.",
    "-.5",
    ".5",
    "+3",
    "1e3",
    "2E-5",
    "nan",
    "-inf",
    "1e400",
    "-0",
    "00012.5000",
    "123456789012345678",
]
ODD += ["0.1234567890123456789", "9007199254740993", "-9007199254740993.0", "1e-400", "000000000000000000.1"]


@pytest.mark.parametrize("word", ODD)
def test_words_that_are_no_plain_decimals_are_read_by_float(word):
    text = f"1.5 {word} -2"
    assert np.array_equal(parse_numbers(text).view(np.int64), floats(text))


@pytest.mark.parametrize(
    "word",
    [
        "x",
        "-",
        ".",
        "-.",
        "--1",
        "1-2",
        "1.2.3",
        "1.-2",
        "12e",
        "e5",
        "0x10",
        "1,5",
        "1;",
        "\x1a",
        "é",
        "1\x01",
    ],
)
def test_a_word_that_is_no_number_is_found(word):
    assert parse_numbers(f"1.5 {word} -2") is None


def test_blocks_end_with_a_line(monkeypatch):
    random = np.random.default_rng(0)
    rows = [" ".join(f"{number:g}" for number in row) for row in random.normal(size=(40, 7)) * 1e-3]
    text = "\n".join([*rows[:20], "", " \t", *rows[20:], "\n\n\n"])
    for size in (1, 30, 300, 10**6):
        monkeypatch.setattr(decimals, "BLOCK", size)
        assert np.array_equal(parse_numbers(text).view(np.int64), floats(text))


@pytest.mark.parametrize("text", ["", " ", "\n\n"])
def test_a_text_without_words_has_no_numbers(text):
    assert parse_numbers(text).shape == (0,)
