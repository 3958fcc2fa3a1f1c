"""Text is read whole or refused, and its numbers are numbers."""

import pytest

from mocap.errors import FormatError
from mocap.files.text import lines, read_text, to_numbers
from tests.refusals import refused


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"a\r\nb\r\n", "a\nb\n"),
        (b"a\rb", "a\nb"),
        (b"\xef\xbb\xbfa\n", "a\n"),
        ("Hüfte".encode(), "Hüfte"),
        ("Hüfte".encode("latin-1"), "Hüfte"),
    ],
)
def test_read_text(tmp_path, data, text):
    (tmp_path / "file").write_bytes(data)
    assert read_text(tmp_path / "file") == text


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"a\nb\0c", "line 2: expected text, got a zero byte"),
        (b" \r\n", "got an empty file"),
        (b"a\n<<<<<<< HEAD\nb", "line 2: .*merge"),
    ],
)
def test_what_is_no_text_is_refused(tmp_path, data, message):
    (tmp_path / "file").write_bytes(data)
    refused(message, read_text, tmp_path / "file", kind=FormatError)


def test_lines_keep_their_numbers():
    assert list(lines("# all\n\na b\t c # d\n")) == [(3, ["a", "b", "c"])]


@pytest.mark.parametrize(
    "words", [["1"], ["1", "x"], ["1", "nan"], ["1", "inf"], ["1", "-1e9"], ["1", "2", "3"]]
)
def test_numbers_that_are_none_are_refused(words):
    refused(r"a.bvh, line 3: expected a pair", to_numbers, "a.bvh", 3, words, "a pair", 2, kind=FormatError)
