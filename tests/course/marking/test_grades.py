"""Marks as points, as .csv files that no spreadsheet computes, and as pages for students."""

import csv
import io
import re
from html import unescape

import pytest

from mocap.cli.main import main
from mocap.course.marking.grades import Mark, account, grade, read_points, tables, write_feedback
from mocap.course.marking.rosters import read_roster
from tests.course.marking.students import HONEST, SPEED, START, hand_in
from tests.refusals import refused, refused_texts

MOODLE = "Identifier,Full name,Email address,Status,Grade,Last modified (grade)\n"
MOODLE += "Participant 7,Ada Lovelace,ada@b.org,Submitted,-,-\nParticipant 71,Bob,bob@b.org,Submitted,-,-\n"
CANVAS = "Student,ID,SIS User ID,SIS Login ID,Section,Homework (5)\n    Points Possible,,,,,9\n"
CANVAS += '"Lovelace, Ada",7,S7,ada,A,\n"B, Bob",71,S71,bob,A,\n'


def read(text):
    return list(csv.reader(io.StringIO(text)))


def table(marks, points=(), roster=(), end="-table"):
    points = dict(points)
    return read(tables(marks, grade(marks, points, roster), points, "Homework")[end])


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\t=", " =", "\r=", "\n@"])
def test_no_cell_is_a_formula(start):
    text = f"{start}HYPERLINK(1)"
    for end in ("", "-table", "-moodle", "-canvas"):
        cells = [cell for line in table([Mark(text, "f", False, text)], end=end) for cell in line]
        assert any(cell.startswith("'") for cell in cells)
        assert not any(cell.startswith(("=", "+", "-", "@", "\t", "\r")) for cell in cells)


def test_a_text_stays_on_one_line_and_is_short():
    said = table([Mark("a", "f", False, "one\ntwo\r\n\x1b[2J\u2028\ud800" + "x" * 10_000)], end="")[1][3]
    assert said.startswith("one two [2J")
    assert len(said) == 300
    said.encode("utf-8")


def test_a_table_keeps_commas_the_better_of_two_copies_and_students_without_marks():
    marks = [Mark("ada/1.ipynb", "f", right, "✗ f: one, two") for right in (False, True, False)]
    marks.append(Mark("bob/1.ipynb", "", False, ""))
    assert table(marks, end="")[1] == ["ada/1.ipynb", "f", "0", "✗ f: one, two", "", "", ""]
    assert table(marks) == [["student", "f", "points", "late"], ["ada", "1", "1", ""], ["bob", "", "0", ""]]


@pytest.mark.parametrize(
    ("text", "sent"),
    [
        (MOODLE, ["Ada Lovelace_7_assignsubmission_file/1.ipynb", "Bob_71_assignsubmission_file/1.ipynb"]),
        (MOODLE, ["ADA/1.ipynb", "bob@b.org/1.ipynb"]),
        (CANVAS, ["lovelaceada_7_99_1.ipynb", "bbob_LATE_71_99_1.ipynb"]),
        (CANVAS, ["ada/1.ipynb", "S71.ipynb"]),
    ],
)
def test_students_are_found_in_what_moodle_and_canvas_wrote(text, sent, tmp_path):
    (tmp_path / "roster.csv").write_text(text, "utf-8-sig")
    marks = [Mark(one, name, one is sent[0], "") for one in (*sent, "eve") for name in ("f", "g")]
    made = (marks, {"f": 2.5}, read_roster(tmp_path / "roster.csv"))
    if text is MOODLE:
        assert table(*made, end="-moodle") == [
            ["Identifier", "Full name", "Email address", "Last modified (grade)", "Grade"],
            ["Participant 7", "Ada Lovelace", "ada@b.org", "'-", "3.5"],
            ["Participant 71", "Bob", "bob@b.org", "'-", "0"],
            ["", "eve", "", "", "0"],
        ]
    else:
        assert table(*made, end="-canvas") == [
            ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Homework"],
            ["Points Possible", "", "", "", "", "3.5"],
            ["Lovelace, Ada", "7", "S7", "ada", "A", "3.5"],
            ["B, Bob", "71", "S71", "bob", "A", "0"],
            ["eve", "", "", "eve", "", "0"],
        ]


NO_POINTS = ("spede = 1", "speed = 'x'", "speed = -1", "speed = nan", "speed", "speed = true")
test_points_are_of_exercises_and_no_less_than_0 = refused_texts(
    read_points, "points.toml", *((text, "points.toml") for text in NO_POINTS)
)


def test_a_roster_says_who_students_are(tmp_path):
    refused("gone.csv: cannot be read", read_roster, tmp_path / "gone.csv")
    (tmp_path / "a.csv").write_text("a,b\n1,2\n")
    refused("no column such as 'Email address'", read_roster, tmp_path / "a.csv")


def texts(file):
    return [unescape(text.strip()) for text in re.split(r"<[^>]*>", file.read_text("utf-8")) if text.strip()]


def test_a_page_says_what_the_check_said_and_runs_nothing(tmp_path):
    evil = "<script>alert(1)</script><img src=x onerror=alert(1)>&amp;"
    marks = [Mark(evil, "speed", True, "✓ speed: right."), Mark(evil, "mix", False, f"✗ mix: {evil}")]
    marks += [Mark("../a", "", False, "../a: is not a notebook."), Mark("..", "mix", False, "")]
    marks += [Mark(f"O{sign}B_7_assignsubmission_file/1.ipynb", "mix", True, "") for sign in "'-"]
    files = write_feedback(grade(marks, {"mix": 2.5}), {"mix": 2.5}, tmp_path / "pages")
    assert files[-1].name == "O-B_7_assignsubmission_file_feedback_.html"  # Moodle reads up to the fourth "_"
    assert len({*files}) == 4 and {file.parent for file in files} == {tmp_path / "pages"}
    assert not re.search("<(script|img)", files[0].read_text("utf-8"))
    said = ["1 of 3.5", "All points", "1 of 1", "✓ speed", "right.", "0 of 2.5", "✗ mix", evil]
    assert texts(files[0])[-9:] == [evil.split("/")[0], *said]
    assert "../a: is not a notebook." in texts(files[1])


def test_the_command_writes_points_pages_and_who_is_unknown(tmp_path, capsys):
    hand_in(HONEST, tmp_path / "in" / "ada" / "00.ipynb")
    hand_in([START, SPEED], tmp_path / "in" / "eve" / "00.ipynb")
    (tmp_path / "roster.csv").write_text(MOODLE)
    (tmp_path / "points.toml").write_text("speed = 3")
    options = {"points": "points.toml", "roster": "roster.csv", "feedback": "pages", "out": "Sheet 1.csv"}
    paths = [part for name, file in options.items() for part in (f"--{name}", str(tmp_path / file))]
    assert main(["course", "mark", str(tmp_path / "in"), *paths, "--jobs", "2"]) == 2
    out, err = capsys.readouterr()
    assert "2 pages" in out and "3 of 4 are right" in out
    assert err.splitlines()[-1] == (
        "2 folders and files: 2 marked; nothing handed in: Bob; not in the roster: eve"
    )
    made = {
        end: read((tmp_path / f"Sheet 1{end}.csv").read_text("utf-8")) for end in ("", "-moodle", "-canvas")
    }
    assert [line[:3] for line in made[""][1:]] == [
        [f"{who}/00.ipynb", name, right]
        for who, rights in (("ada", "11"), ("eve", "10"))
        for name, right in zip(("speed", "cheapest"), rights, strict=True)
    ]
    assert made["-moodle"][1:] == [
        ["Participant 7", "Ada Lovelace", "ada@b.org", "'-", "4"],
        ["", "eve", "", "", "3"],
        ["Participant 71", "Bob", "bob@b.org", "'-", "0"],
    ]
    assert made["-canvas"][0][-1] == "Sheet 1"
    assert texts(tmp_path / "pages" / "eve_feedback.html")[-2:] == ["✗ cheapest", "its cell is missing."]


WEI = "Identifier,Full name,Email address\nParticipant 1,Wei Zhang,zhangw@b.org\n"
WEI += "Participant 2,Wei Zhang,wzhang2@b.org\nParticipant 3,Ada Lovelace,ada@b.org\n"


def by_identifier(roster, sent):
    marks = [Mark(f"{name}/00.ipynb", "speed", True, "") for name in sent]
    return marks, {line.columns["Identifier"] or line.sent: line for line in grade(marks, {}, roster)}


@pytest.fixture
def roster(tmp_path):
    (tmp_path / "roster.csv").write_text(WEI)
    return read_roster(tmp_path / "roster.csv")


def test_two_people_of_one_name_are_told_apart_by_number_or_login(roster):
    sent = ["Wei Zhang_1_assignsubmission_file", "Wei Zhang_2_assignsubmission_file"]
    for names in (sent, ["zhangw", "wzhang2"]):
        marks, grades = by_identifier(roster, names)
        assert [grades[f"Participant {n}"].points for n in (1, 2, 3)] == [1, 1, 0]
        assert account(marks, list(grades.values())) == (
            "2 folders and files: 2 marked; nothing handed in: Ada Lovelace",
            True,
        )


def test_a_name_of_two_people_is_refused_and_neither_gets_the_grade(roster):
    marks, grades = by_identifier(roster, ["Wei Zhang", "Ada Lovelace"])
    assert {*grades} == {"Wei Zhang", "Participant 3"}
    said, needs_person = account(marks, list(grades.values()))
    assert said == "2 folders and files: 2 marked; ambiguous in the roster: Wei Zhang" and needs_person


def test_two_folders_of_one_person_are_refused(roster):
    _, grades = by_identifier(roster, ["Ada Lovelace", "ada"])
    assert [line.problem for line in grades.values()][:2] == ["ambiguous in the roster"] * 2
    assert grades["Ada Lovelace"].points == grades["ada"].points == 1


def test_who_is_in_the_roster_and_handed_in_nothing_gets_a_row_of_zeros(roster):
    marks, grades = by_identifier(roster, ["zhangw"])
    texts = tables(marks, list(grades.values()), {})
    assert read(texts["-table"])[1:] == [
        ["zhangw", "1", "1", ""],
        ["Wei Zhang", "0", "0", ""],
        ["Ada Lovelace", "0", "0", ""],
    ]
    assert read(texts["-moodle"])[-1] == ["Participant 3", "Ada Lovelace", "ada@b.org", "", "0"]


def test_all_well_needs_no_person(roster):
    marks, grades = by_identifier([], ["ada", "bob"])
    assert account(marks, list(grades.values())) == ("2 folders and files: 2 marked", False)


def test_a_page_of_a_name_from_another_system_is_written(tmp_path):
    marks = [
        Mark("M\udcfcller/00.ipynb", "speed", True, "✓ speed: \udcfc"),
        Mark("zoe/1.ipynb", "speed", True, ""),
    ]
    files = write_feedback(grade(marks, {}), {}, tmp_path)
    assert [file.name for file in files] == ["M-ller_feedback.html", "zoe_feedback.html"]
    assert "M?ller" in files[0].read_text("utf-8")
