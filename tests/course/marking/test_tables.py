"""Marks as .csv files that no spreadsheet computes."""

import csv
import io

import pytest

from mocap.course.marking import Mark, to_csv, to_table


def read(text):
    return list(csv.reader(io.StringIO(text)))


def test_the_table_keeps_commas():
    assert read(to_csv([Mark("a", "f", False, "✗ f: one, two")]))[1] == ["a", "f", "0", "✗ f: one, two"]


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\t=", " =", "\r=", "\n@"])
def test_no_cell_is_a_formula(start):
    text = f"{start}HYPERLINK(1)"
    for table in (to_csv([Mark(text, "f", False, text)]), to_table([Mark(text, "f", False, text)])):
        line = read(table)[1]
        assert line[0].startswith("'")
        assert not any(cell.startswith(("=", "+", "-", "@", "\t", "\r")) for cell in line)


def test_a_text_stays_on_one_line_and_is_short():
    said = read(to_csv([Mark("a", "f", False, "one\ntwo\r\n\x1b[2J\u2028\ud800" + "x" * 10_000)]))[1][3]
    assert said.startswith("one two [2J")
    assert len(said) == 300
    said.encode("utf-8")


def test_of_two_copies_the_better_one_counts():
    marks = [Mark("ada/1.ipynb", "f", right, "") for right in (False, True, False)]
    assert read(to_table(marks))[1] == ["ada", "1", "1"]


def test_a_student_without_marks_has_a_line():
    assert read(to_table([Mark("ada/1.ipynb", "", False, "")])) == [["student", "right"], ["ada", "0"]]
