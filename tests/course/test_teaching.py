"""The teacher's folder: the syllabus fits the exercises, the answers are computed, the marks add up."""

import re
from itertools import chain
from tomllib import loads

from mocap.course import marked_values
from tests.course.stored_notebooks import FOLDER, NAMES, ROOT

SYLLABUS, EXAM, ANSWERS, MARKS = (
    (FOLDER / "teaching" / f"{name}.md").read_text("utf-8")
    for name in ("syllabus", "exam", "answers", "sample-marks")
)
KINDS = ("By hand", "By code", "By judgement")


def numbers(text, kind):
    part = re.split(r"^## ", text.partition(f"## {kind}\n")[2], flags=re.MULTILINE)[0]
    return [int(number) for number in re.findall(r"^\*\*(\d+)\.\*\*", part, re.MULTILINE)]


def test_each_exercise_belongs_to_one_outcome():
    rows = re.findall(r"^\| \w+ \|(.*)\|$", SYLLABUS.partition("| outcome |")[2], re.MULTILINE)
    places = [place for row in rows for cell in row.split("|") for place in cell.split(";")]
    told = [(place.split()[0], name) for place in places for name in re.findall(r"`(\w+)`", place)]
    tables = (ROOT / "mocap" / "course" / "checks").glob("*.toml")
    asked = [
        (table.stem.partition("-")[0], name) for table in tables for name in loads(table.read_text("utf-8"))
    ]
    assert sorted(told) == sorted(asked)


def test_the_weeks_name_papers_and_questions_that_there_are():
    weeks = re.findall(r"^\| (\d+) \|.*\| ([\d, ]+) \|$", SYLLABUS, re.MULTILINE)
    assert [int(week) for week, _ in weeks] == [*range(1, 11)]
    assert sorted(int(one) for _, asked in weeks for one in asked.split(", ")) == [*range(1, 41)]
    papers = loads((ROOT / "figures" / "papers.toml").read_text("utf-8"))
    assert set(re.findall(r"\[([A-Z]\w+\d\d)\]", SYLLABUS)) <= set(papers)


def test_forty_questions_of_three_kinds_have_an_answer_each():
    asked = [numbers(EXAM, kind) for kind in KINDS]
    assert asked == [numbers(ANSWERS, kind) for kind in KINDS]
    assert [*chain(*asked)] == [*range(1, 41)] and min(map(len, asked)) >= 12
    taught = re.findall(r"^\*\*\d+\.\*\* \((\w+)\)", EXAM, re.MULTILINE)
    assert len(taught) == 40 and set(taught) <= {name.partition("-")[0] for name in NAMES}


def test_the_answers_are_right():
    code = re.findall(r"```python\n(.*?)```", ANSWERS, re.DOTALL)
    assert len(code) > len(numbers(ANSWERS, "By code")) and "assert" in "".join(code)
    names = {}
    exec("\n".join(code), names)
    marked_values.compare([ANSWERS], names)


def test_the_marks_of_the_sample_add_up():
    marks = re.findall(r"^\| (.*) \| (\d+) \| (\d+) \|", MARKS, re.MULTILINE)
    sheet = re.findall(r"^\| ([^|]*) \| (\d+) \|", (FOLDER / "PROJECT.md").read_text("utf-8"), re.MULTILINE)
    assert [(part, of) for part, of, _ in marks] == [row for row in sheet if not row[0].isdigit()]
    assert all(int(got) <= int(of) for _, of, got in marks)
    assert f"Together {sum(int(got) for *_, got in marks)} of 100" in MARKS
    assert (FOLDER / "teaching" / "sample-film.mp4").stat().st_size < 1.5e6
