"""`mocap.atomic`: whole files or none."""

import pytest

from mocap._shared.atomic import replacing
from mocap.errors import FormatError, MocapError
from mocap.files.text import lines, read_text, to_numbers


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "walk.bvh"
    path.write_text("old")
    with replacing(path) as beside:
        beside.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


@pytest.mark.parametrize("trouble", [KeyboardInterrupt, ZeroDivisionError, SystemExit])
def test_nothing_is_left_of_a_failure(tmp_path, trouble):
    path = tmp_path / "walk.bvh"
    path.write_text("old")
    with pytest.raises(trouble), replacing(path) as beside:
        beside.write_text("half a fi")
        raise trouble
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


def test_a_new_file_has_ordinary_permissions(tmp_path):
    (tmp_path / "plain").write_text("")
    with replacing(tmp_path / "new") as beside:
        beside.write_text("")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_missing_folder_is_named(tmp_path):
    path = tmp_path / "nowhere" / "walk.bvh"
    with pytest.raises(MocapError, match=r"Cannot write .*walk.bvh: No such file"), replacing(path) as beside:
        beside.write_text("")


def test_a_folder_in_the_way_is_named(tmp_path):
    (tmp_path / "walk.bvh").mkdir()
    with pytest.raises(MocapError, match=r"Cannot write"), replacing(tmp_path / "walk.bvh") as beside:
        beside.write_text("")
    assert [file.name for file in tmp_path.iterdir()] == ["walk.bvh"]


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
    with pytest.raises(FormatError, match=message):
        read_text(tmp_path / "file")


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(MocapError, match=r"Cannot read .*gone: No such file"):
        read_text(tmp_path / "gone")
    with pytest.raises(MocapError, match=r"Cannot read .*: Is a directory"):
        read_text(tmp_path)


def test_lines_keep_their_numbers():
    assert list(lines("# all\n\na b\t c # d\n")) == [(3, ["a", "b", "c"])]


@pytest.mark.parametrize(
    "words", [["1"], ["1", "x"], ["1", "nan"], ["1", "inf"], ["1", "-1e9"], ["1", "2", "3"]]
)
def test_numbers_that_are_none_are_refused(words):
    with pytest.raises(FormatError, match=r"a.bvh, line 3: expected a pair"):
        to_numbers("a.bvh", 3, words, "a pair", 2)
