"""Labels come back from a table as they were, and a wrong table is refused with its line."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.files.label_tables import LabelRow, label_clips, load_labels, rows_of, save_labels
from mocap.files.named_tables import read_table, write_table
from tests.refusals import refused
from tests.strategies import wave

CLIP = wave(90, name="a, b")


@given(st.integers(1, 2**30), st.sampled_from([10.0, 29.97, 30.0, 59.94, 120.0, 1000.0]))
def test_rows_give_the_same_labels_at_any_rate(bits, fps):
    mark = np.array([bits >> n & 1 for n in range(90)], bool)
    clip = replace(CLIP, fps=fps, labels={"stand": mark} if mark.any() else {})
    assert label_clips([replace(clip, labels={})], rows_of(clip))[0] == clip


def test_a_table_comes_back_with_commas_quotes_and_umlauts(tmp_path):
    rows = [LabelRow("a, b", "0s", "1.5s", 'the "slow" one'), LabelRow("ü", "", "45", "walk")]
    save_labels(tmp_path / "labels.csv", rows)
    assert load_labels(tmp_path / "labels.csv") == rows


def test_columns_have_any_order_and_semicolons_separate_too(tmp_path):
    file = tmp_path / "labels.csv"
    file.write_text("# by hand\nlabel;Clip;to;from\n\nwalk;a;45;0s\n", "utf-8")
    assert load_labels(file) == [LabelRow("a", "0s", "45", "walk")]


def test_frames_and_seconds_mark_the_same_and_empty_times_are_the_ends():
    rows = [LabelRow("a, b", "30", "60", "stand"), LabelRow("a, b", "1s", "2s", "wait")]
    (clip,) = label_clips([CLIP], [*rows, LabelRow("a, b", "", "", "all")])
    assert (clip.labels["stand"] == clip.labels["wait"]).all() and clip.labels["all"].all()
    assert clip.labels["stand"].nonzero()[0].tolist() == [*range(30, 60)]


def test_a_clip_without_rows_keeps_its_labels():
    other = replace(CLIP, name="c", labels={"old": True})
    labelled = label_clips([CLIP, other], [LabelRow("a, b", "", "", "new")])
    assert [sorted(clip.labels) for clip in labelled] == [["new"], ["old"]] and labelled[1] is other


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("# only a comment", "a first line with the columns clip, from, to, label"),
        ("clip,from,to\na,0,1\n", "line 1: expected a first line with the columns"),
        ("clip,from,to,label,colour\na,0,1,walk,red\n", "got 'clip, from, to, label, colour'"),
        ("clip,from,to,label,label\na,0,1,walk,red\n", "line 1"),
        ("clip,from,to,label\n", "rows below the names of the columns"),
        ("clip,from,to,label\na,0,1,walk,more\n", "line 2: expected 4 cells, got 5"),
        ("clip,from,to,label\na,soon,1,walk\n", r"line 2: expected times such as 45 .* got 'soon'"),
        ("clip,from,to,label\na,-1,1,walk\n", "got '-1'"),
        ("clip,from,to,label\n,0,1,walk\n", "line 2: expected the name of a clip and a label"),
    ],
)
def test_a_wrong_table_is_refused_with_its_line(tmp_path, text, words):
    file = tmp_path / "labels.csv"
    file.write_text(text, "utf-8")
    refused(words, load_labels, file)


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (LabelRow("b", "", "", "walk"), "no clip 'b' to label; there are: a, b"),
        (LabelRow("a, b", "80", "91", "walk"), "is not in its clip: 'a, b' has 90 frames, 3.00 s"),
        (LabelRow("a, b", "2s", "1s", "walk"), "from 2s to 1s is not in its clip"),
        (LabelRow("a, b", "5", "5", "walk"), "is not in its clip"),
    ],
)
def test_a_row_that_fits_no_clip_is_refused(row, words):
    refused(words, label_clips, [CLIP], [row])


def test_a_table_of_too_many_lines_is_refused(tmp_path):
    write_table(tmp_path / "long.csv", ["x"], [[1]] * 500_001)
    refused("a table of 500,000 lines at most", read_table, tmp_path / "long.csv", ["x"])
