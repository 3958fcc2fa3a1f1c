"""Points of answers in words: read back from the table, added to the grades, and refused by line."""

import csv

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from mocap.cli.main import main
from mocap.course.marking.grades import written_table
from mocap.course.marking.written_points import has_points, read_given_points
from mocap.course.written import OTHER, Answer
from tests.refusals import refused

ANSWERS = [
    Answer("ada/02.ipynb", "design-1", "Both."),
    Answer("ada/02.ipynb", "prediction-1", "=SUM(1)"),
    Answer("ada/02.ipynb", OTHER, "Sorry."),
    Answer("bob/02.ipynb", "design-1", "None."),
]


def table(tmp_path, *points, name="marks-written.csv"):
    """Write the table of the answers, with some points filled in."""
    file = tmp_path / name
    rows = list(csv.reader(written_table(ANSWERS).splitlines()))
    for row, given in zip(rows[1:], points, strict=False):
        row[-1] = given
    with file.open("w", newline="") as opened:
        csv.writer(opened).writerows(rows)
    return file


def test_points_are_summed_for_each_student(tmp_path):
    given = read_given_points(table(tmp_path, "2", "1.5", "", "0"), ANSWERS, {})
    assert [(mark.handed_in.split("/")[0], mark.earned(9)) for mark in given.marks] == [
        ("ada", 3.5),
        ("bob", 0),
    ]
    assert [mark.right for mark in given.marks] == [True, False]
    assert (given.possible, given.without) == (3.5, 0)
    assert given.marks[0].said == "design-1: 2, prediction-1: 1.5"


def test_whole_sums_are_written_without_a_point(tmp_path):
    (mark,) = read_given_points(table(tmp_path, "2.5", "1.5"), ANSWERS, {}).marks
    assert f"{mark.awarded}" == "4"


def test_answers_without_points_are_counted_and_texts_of_students_are_not(tmp_path):
    given = read_given_points(table(tmp_path, "2"), ANSWERS, {"written": 3})
    assert given.without == 2
    assert given.possible == 6  # two questions of three points


def test_points_are_kept_in_the_next_table(tmp_path):
    given = read_given_points(table(tmp_path, "2", "1,5"), ANSWERS, {})
    text = written_table(ANSWERS, given.texts)
    assert [row[-1] for row in csv.reader(text.splitlines())][1:] == ["2", "1.5", "", ""]


def test_a_table_of_another_order_with_semicolons_and_a_further_column_is_read(tmp_path):
    file = tmp_path / "x.csv"
    file.write_text('points;handed in;question;remark\n"2,5";bob/02.ipynb;design-1;good\n;;;\n')
    given = read_given_points(file, ANSWERS, {})
    assert [(mark.handed_in, mark.awarded) for mark in given.marks] == [("bob/02.ipynb", 2.5)]


def test_names_that_look_like_formulas_are_found_again(tmp_path):
    answers = [Answer("=cmd/02.ipynb", "design-1", "x")]
    file = tmp_path / "x.csv"
    file.write_text(written_table(answers, ["3"]))
    assert read_given_points(file, answers, {}).marks[0].awarded == 3


@pytest.mark.parametrize("points", ["-1", "4", "nan", "inf", "two", "1e9", "0x1"])
def test_impossible_points_are_refused_by_line(tmp_path, points):
    file = table(tmp_path, "1", points)
    refused(
        r"marks-written.csv, line 3: '.*' is no number of points from 0 to 3",
        read_given_points,
        file,
        ANSWERS,
        {"written": 3},
    )


def test_without_a_points_file_a_bound_remains(tmp_path):
    refused(
        "line 2: '1001' is no number of points from 0 to 1000",
        read_given_points,
        table(tmp_path, "1001"),
        ANSWERS,
        {},
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("handed in,question\n", "there is no column 'points'"),
        ("", "there is no column 'handed in'"),
        ("handed in,question,points\nada/02.ipynb,design-1\n", "line 2: 2 columns, where the header has 3"),
        (
            "handed in,question,points\nzoe/02.ipynb,design-1,1\n",
            "line 2: 'zoe/02.ipynb, design-1' is not handed in",
        ),
        ("handed in,question,points\n,,\nada/02.ipynb,design-1,1\n", "line 2: ', ' is not handed in"),
        ("handed in,question,points\n" + "bob/02.ipynb,design-1,1\n" * 2, "line 3: .* or has another line"),
    ],
)
def test_malformed_tables_are_refused(tmp_path, text, said):
    (tmp_path / "x.csv").write_text(text)
    refused(said, read_given_points, tmp_path / "x.csv", ANSWERS, {})


def test_a_file_that_is_missing_or_too_large_is_refused(tmp_path, monkeypatch):
    refused("No such file", read_given_points, tmp_path / "x.csv", ANSWERS, {})
    monkeypatch.setattr("mocap.course.marking.written_points.MOST_BYTES", 10)
    refused("no table of points", read_given_points, table(tmp_path, "1"), ANSWERS, {})


def test_a_table_with_points_is_recognised(tmp_path):
    assert not has_points(tmp_path / "x.csv") and not has_points(table(tmp_path))
    assert has_points(table(tmp_path, "", "1"))


def test_the_command_adds_them_to_all_tables(tmp_path, capsys):
    speed = "def speed(root_positions, fps):\n    return 0"
    for name in ("ada", "bob"):
        cells = [
            new_code_cell("import numpy as np"),
            new_code_cell(speed, metadata={"tags": ["exercise:speed"]}),
            new_markdown_cell(f"By {name}: both.", metadata={"tags": ["written:design-1"]}),
        ]
        (tmp_path / "in" / name).mkdir(parents=True)
        nbformat.write(new_notebook(cells=cells), tmp_path / "in" / name / "00.ipynb")
    out = tmp_path / "marks.csv"
    line = ["course", "mark", str(tmp_path / "in"), "-o", str(out)]
    (tmp_path / "points.toml").write_text("written = 4\n")
    assert main(line) == 0
    filled = tmp_path / "marks-written.csv"
    filled.write_text(filled.read_text("utf-8").replace("By ada: both.,", 'By ada: both.,"2,5"'), "utf-8")
    capsys.readouterr()
    assert main(line) == 2  # without --written, the points would be lost
    assert "has points of a person" in capsys.readouterr().err
    options = [
        "--written",
        str(filled),
        "--points",
        str(tmp_path / "points.toml"),
        "--feedback",
        str(tmp_path / "f"),
    ]
    assert main([*line, *options]) == 2
    assert "answers in words without points: 1" in capsys.readouterr().err
    rows = list(csv.DictReader((tmp_path / "marks-table.csv").read_text("utf-8").splitlines()))
    assert [(row["student"], row["written"], row["points"]) for row in rows] == [
        ("ada", "2.5", "2.5"),
        ("bob", "", "0"),
    ]
    assert ",,,,,6\n" in (tmp_path / "marks-canvas.csv").read_text("utf-8").replace("Points Possible", "")
    assert "2.5 of 4" in next((tmp_path / "f").glob("ada*")).read_text("utf-8")
    assert "2.5" in filled.read_text("utf-8")
