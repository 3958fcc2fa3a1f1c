"""What teachers hold in hand: plans that add up, by the same minutes; exercises, answers and marks."""

import re
from functools import cache
from itertools import chain
from tomllib import loads

import pytest
import reading_minutes  # of the folder figures
from nbformat.v4 import new_markdown_cell

from mocap.course.exam.sheets import PRACTICE, answers
from tests.course.stored_notebooks import FOLDER, NAMES, ROOT, read

PLAN = (FOLDER / "README.md").read_text("utf-8")
PROJECT = (FOLDER / "PROJECT.md").read_text("utf-8")
WEEKS, ROWS = (
    re.findall(r"^\| (\d+) \| (.*) \| (.*) \|$", plan.partition("\n## ")[0], re.M)
    for plan in re.split(r"^## (?:Ten|Two) weeks$", PLAN, flags=re.M)[1:]
)
NEAR = 5  # minutes


@cache
def sections(name):
    """Give the minutes of each section of a notebook, by the rule for the whole."""
    parts, at = {}, ""
    for cell in read(name).cells:
        pieces = [cell]
        if cell.cell_type == "markdown":
            pieces = [new_markdown_cell(text) for text in re.split(r"^(?=##? )", cell.source, flags=re.M)]
        for piece in pieces:
            heading = re.match(r"##? (.*)", piece.source) if piece.cell_type == "markdown" else None
            at = heading[1] if heading else at
            parts.setdefault(at, []).append(piece)
    return {at: reading_minutes.contents(cells).minutes for at, cells in parts.items()}


def parts(cell):
    """Give name, heading and minutes of each part of a cell of the plan; "" where there is none."""
    for piece in cell.split(";"):
        name = (re.findall(r"\]\(([\w-]+)\.ipynb\)", piece) or [""])[0]
        headed = re.findall(r"\*([^*]+)\* \((\d+)\)", piece)
        whole = re.findall(r"\((\d+)\)", piece)
        for heading, stated in headed or [("", minutes) for minutes in whole]:
            yield name, heading, int(stated)


def test_there_are_six():
    assert [number for number, _, _ in ROWS] == list("123456")


@pytest.mark.parametrize(("session", "in_class", "at_home"), ROWS)
def test_a_session_adds_up(session, in_class, at_home):
    found = list(parts(in_class))
    assert abs(sum(stated for *_, stated in found) - 90) <= NEAR
    taken = {}
    for name, heading, stated in found:
        if name:
            own = sections(name)
            real = own[heading] if heading else sum(own.values())
            assert abs(real - stated) <= NEAR, (name, heading, real)
            taken[name] = taken.get(name, 0) + real
    ((name, _, stated),) = parts(at_home)
    left = sum(sections(name).values())
    if "rest of" in at_home:
        elsewhere = [part for _, cell, _ in ROWS for part in parts(cell) if part[0] == name]
        left -= sum(sections(name)[heading] for _, heading, _ in elsewhere)
    assert abs(left - stated) <= NEAR, left


@pytest.mark.parametrize(("week", "in_class", "at_home"), WEEKS)
def test_a_week_takes_what_its_notebooks_take(week, in_class, at_home):
    assert sum(stated for *_, stated in parts(in_class)) <= 90
    for name, _, stated in [*parts(in_class), *parts(at_home)]:
        assert not name or abs(sum(sections(name).values()) - stated) <= NEAR, name


def test_the_weeks_go_along_the_way():
    way = [name for name in NAMES if name[2] == "-" and int(name[:2]) <= 10]
    assert [name for _, cell, _ in WEEKS for name, *_ in parts(cell)] == way
    in_class, at_home = (sum(part[2] for row in WEEKS for part in parts(row[n])) / 60 for n in (1, 2))
    assert f"about {round(in_class)} of the fifteen hours." in PLAN
    assert f"Work at home takes about {round(at_home)} hours," in PLAN


def test_the_hours_in_all_are_those_of_the_sessions():
    at_home = sum(stated for *_, cell in ROWS for *_, stated in parts(cell))
    assert f"at home about {round(at_home / 60)} hours" in PLAN
    assert f"In class this is {6 * 90 // 60} hours" in PLAN


def test_the_hours_of_the_course_are_those_of_its_notebooks():
    stated = {name: int(re.search(rf"\]\({name}\.ipynb\) \| (\d+) \|", PLAN)[1]) for name in NAMES}
    until_ten = {name: minutes for name, minutes in stated.items() if int(name[:2]) <= 10}
    first_halves = [minutes for name, minutes in until_ten.items() if name[2] == "-"]
    after = [minutes for name, minutes in stated.items() if name not in until_ten]
    for minutes, said in (
        (sum(first_halves), r"The main sequence, 00 to 10, takes about (\d+) hours"),
        (sum(until_ten.values()) - sum(first_halves), r"01b to 09b, take about (\d+) more"),
        (sum(after), r"take about (\d+) hours\. They"),
    ):
        assert abs(int(re.search(said, PLAN)[1]) - minutes / 60) < 1


def test_the_project_adds_up_and_asks_the_five_questions():
    marks = re.findall(r"^\| [^|]+ \| (\d+) \| [^|]+ \|$", PROJECT.partition("## How it is marked")[2], re.M)
    assert sum(map(int, marks)) == 100
    hours = re.findall(r"^\| \d \| .* \| (\d+) \|$", PROJECT.partition("## Timeline")[2], re.M)
    assert f"about {sum(map(int, hours))} hours" in PROJECT
    asked = re.findall(r"^\d\. (.*\?)$", PROJECT, re.M)
    assert len(asked) == 5
    assert " ".join(asked) in PLAN
    assert "](PROJECT.md)" in PLAN


SYLLABUS, EXAM, MARKS = (
    (FOLDER / "teaching" / f"{name}.md").read_text("utf-8") for name in ("syllabus", "exam", "sample-marks")
)
ANSWERS = answers(EXAM, PRACTICE, {})
KINDS = ("By hand", "By code", "By judgement")


def numbers(text, kind):
    part = re.split(r"^## ", text.partition(f"## {kind}\n")[2], flags=re.MULTILINE)[0]
    return [int(number) for number in re.findall(r"^\*\*(\d+)\.\*\*", part, re.MULTILINE)]


def test_each_exercise_belongs_to_one_outcome():
    rows = re.findall(r"^\| \w+ \|(.*)\|$", SYLLABUS.partition("| outcome |")[2], re.MULTILINE)
    places = [place for row in rows for cell in row.split("|") for place in cell.split(";")]
    told = [(place.split()[0], name) for place in places for name in re.findall(r"`(\w+)`", place)]
    tables = (ROOT / "mocap" / "course" / "checks" / "hints").glob("*.toml")
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


def test_the_marks_of_the_sample_add_up():
    marks = re.findall(r"^\| (.*) \| (\d+) \| (\d+) \|", MARKS, re.MULTILINE)
    sheet = re.findall(r"^\| ([^|]*) \| (\d+) \|", (FOLDER / "PROJECT.md").read_text("utf-8"), re.MULTILINE)
    assert [(part, of) for part, of, _ in marks] == [row for row in sheet if not row[0].isdigit()]
    assert all(int(got) <= int(of) for _, of, got in marks)
    assert f"Together {sum(int(got) for *_, got in marks)} of 100" in MARKS
    assert (FOLDER / "teaching" / "sample-film.mp4").stat().st_size < 1.5e6
