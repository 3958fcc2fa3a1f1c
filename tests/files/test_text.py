"""Text, tables of numbers and folders of clips are read whole, or a wrong line is named."""

from pathlib import Path

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.files import conversion, load_save
from mocap.files.text import lines, load_rows, read_text, to_numbers
from tests.refusals import refused
from tests.strategies import wave

TEXTS = [
    (b"a\r\nb\r\n", "a\nb\n"),
    (b"a\rb", "a\nb"),
    (b"\xef\xbb\xbfa\n", "a\n"),
    ("Hüfte".encode(), "Hüfte"),
    ("Hüfte".encode("latin-1"), "Hüfte"),
]


@pytest.mark.parametrize(("data", "text"), TEXTS)
def test_read_text(tmp_path, data, text):
    (tmp_path / "file").write_bytes(data)
    assert read_text(tmp_path / "file") == text


NO_TEXTS = [
    (b"a\nb\0c", "line 2: expected text, got a zero byte"),
    (b" \r\n", "got an empty file"),
    (b"a\n<<<<<<< HEAD\nb", "line 2: .*merge"),
]


@pytest.mark.parametrize(("data", "message"), NO_TEXTS)
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


@pytest.mark.parametrize("text", ["1,2,3\n4,5,6\n", "x;z;r\n1; 2 ;3\n\n4 5 6 # a stone", "1\t2\t3\r\n4,5,6"])
def test_rows_are_read(tmp_path, text):
    file = tmp_path / "t.csv"
    file.write_text(text, newline="")
    np.testing.assert_array_equal(load_rows(file, ("x", "z", "radius")), [[1, 2, 3], [4, 5, 6]])


WRONG_LINES = [
    ("1,2\n3\n", "line 2: expected x and z in each line, such as '1.5, 2', got"),
    ("1,2,3\n", "line 1: expected x and z"),
    ("1,2\nfive,6\n", "line 2"),
    ("0,0\n1,nan", "line 2: expected x and z"),
    ("x,z\n", "got no numbers"),
]


@pytest.mark.parametrize(("text", "sentence"), WRONG_LINES)
def test_a_wrong_line_is_named(tmp_path, text, sentence):
    (tmp_path / "t.csv").write_text(text)
    refused(sentence, load_rows, tmp_path / "t.csv", kind=FormatError)


def test_graphs_and_other_archives_in_a_folder_are_no_clips(tmp_path):
    load_save.save(wave(3), tmp_path / "b.bvh")
    np.savez(tmp_path / "c.npz", poses=np.zeros((2, 66)), trans=np.zeros((2, 3)), mocap_framerate=60.0)
    np.savez(tmp_path / "graph.npz", nodes=np.zeros(3))
    (tmp_path / "broken.npz").write_bytes(b"PK")
    (tmp_path / "notes.txt").write_text("")
    assert [path.name for path in conversion.find_files([tmp_path])] == ["b.bvh", "c.npz"]
    assert [path.name for path, _ in conversion.plan(tmp_path, tmp_path / "out")] == ["b.bvh", "c.npz"]


def test_an_empty_folder_is_refused(tmp_path):
    refused(r"holds no \.amc, \.bvh or AMASS \.npz file\.", conversion.find_files, [tmp_path])


def test_a_name_without_end_is_refused_in_a_sentence():
    refused(r"Cannot read a+: File name too long", conversion.find_files, [Path("a" * 5000)], most=6000)
