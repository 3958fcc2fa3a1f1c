"""What marks are worth beyond right or wrong: parts of points, lateness, words, and a class as a whole."""

import codecs
import csv

import nbformat
import pytest

from mocap.course.handout import WHEEL, hand_out
from mocap.course.marking import mark, written_answers
from mocap.course.marking.class_page import class_page, summaries
from mocap.course.marking.grades import Mark, grade, read_points, tables, written_table
from mocap.course.marking.rosters import read_roster
from mocap.course.notebooks import read, tagged
from mocap.course.opening import stored
from mocap.course.written import KIND, TEMPLATE, questions_of
from tests.course.marking.students import CHEAPEST, SPEED, START, hand_in

HALF = SPEED[1].replace("return", "return (1 + (len(positions) % 2)) *")  # right if the length is even


def test_if_asked_a_wrong_function_earns_the_fraction_of_inputs_on_which_it_is_right(tmp_path):
    hand_in([START, ("exercise:speed", HALF), CHEAPEST], tmp_path / "ada" / "x.ipynb")
    hand_in(
        [START, ("exercise:speed", "def speed(a, b): raise ValueError"), CHEAPEST],
        tmp_path / "bob" / "x.ipynb",
    )
    marks = [one for some in mark(tmp_path, partial_points=True) for one in some]
    half, whole, none, _ = marks
    assert not half.right and 0.2 < half.passed < 0.8 and round(40 * half.passed, 6) % 1 == 0
    assert (whole.passed, none.passed) == (0, 0) and whole.right
    ada, bob = grade(marks, {"speed": 10})
    assert ada.points == 1 + round(10 * half.passed, 2) and bob.points == 1
    assert [one.passed for some in mark(tmp_path) for one in some] == [0, 0, 0, 0]  # unless asked


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_rosters_are_read_as_spreadsheets_save_them(encoding, separator, tmp_path):
    lines = [
        "Identifier;Full name;Email address;Status",
        "Participant 7;Zoë Çelik;zoe@b.org;Submitted for grading",
    ]
    (tmp_path / "roster.csv").write_bytes("\r\n".join(lines).replace(";", separator).encode(encoding))
    (row,) = read_roster(tmp_path / "roster.csv")
    assert row["Full name"] == "Zoë Çelik" and row["Identifier"] == "Participant 7"


def test_a_roster_in_utf_16_of_the_other_order_and_with_quoted_separators(tmp_path):
    text = 'Student;SIS Login ID\n"Lovelace; Ada, the first";ada\n'
    (tmp_path / "roster.csv").write_bytes(codecs.BOM_UTF16_BE + text.encode("utf-16-be"))
    assert read_roster(tmp_path / "roster.csv")[0]["Student"] == "Lovelace; Ada, the first"


def test_lateness_is_what_the_platform_says(tmp_path):
    rows = [
        {
            "Identifier": "Participant 7",
            "Full name": "Ada",
            "Status": "Submitted for grading - 1 day 2 hours late",
        }
    ]
    rows += [{"Identifier": "Participant 8", "Full name": "Bob", "Status": "Submitted for grading - "}]
    sent = ("Ada_7_assignsubmission_file/x.ipynb", "Bob_8_assignsubmission_file/x.ipynb")
    marks = [Mark(path, "speed", True, "") for path in sent]
    assert [student.late for student in grade(marks, {}, rows)] == ["1 day 2 hours late", ""]
    (canvas,) = grade([Mark("adal_LATE_815_4711_x.ipynb", "speed", True, "")], {})
    assert canvas.late == "late" and canvas.points == 1
    table = csv.DictReader(tables(marks, grade(marks, {}, rows), {})["-table"].splitlines())
    assert [row["late"] for row in table] == ["1 day 2 hours late", ""]


@pytest.fixture(scope="module")
def handout(tmp_path_factory):
    out = tmp_path_factory.mktemp("words") / "out"
    hand_out([stored() / "02-matching.ipynb"], out, WHEEL)
    return read(out / "02-matching.ipynb")


def test_a_handout_asks_for_words_after_each_prediction_and_design_task(handout):
    names = [name for name, _ in questions_of(read(stored() / "02-matching.ipynb"))]
    assert [name for name, _ in tagged(handout, KIND)] == names and "design-1" in names
    for place, cell in enumerate(handout.cells):
        if cell.source == TEMPLATE:
            assert (
                "**Predict.**" in handout.cells[place - 1].source
                or "**Design task.**" in handout.cells[place - 1].source
            )


def test_words_are_collected_for_a_person_and_templates_are_not(handout, tmp_path):
    (tmp_path / "ada").mkdir()
    (tmp_path / "bob").mkdir()
    nbformat.write(handout, tmp_path / "bob" / "x.ipynb")
    for name, cell in tagged(handout, KIND):
        if name == "design-1":
            cell.source = f"{TEMPLATE} =SUM(1)\n\nBoth dancers' points, " + "and so on " * 100
    handout.cells.append(nbformat.v4.new_markdown_cell("I could not do exercise 2."))
    nbformat.write(handout, tmp_path / "ada" / "x.ipynb")
    answers = written_answers(tmp_path)
    assert [answer.question for answer in answers] == ["design-1", "a text of the student's"]
    rows = list(csv.DictReader(written_table(answers).splitlines()))
    assert rows[0]["answer"].startswith("'=SUM(1) Both dancers") and len(rows[0]["answer"]) > 1000
    assert [row["points"] for row in rows] == ["", ""] and rows[0]["handed in"] == "ada/x.ipynb"


def test_nbgrader_gets_cells_that_a_person_marks(tmp_path):
    (tmp_path / "points.toml").write_text("written = 4\nspeed = 2")
    points = read_points(tmp_path / "points.toml")
    (copy,) = hand_out([stored() / "00-quickstart.ipynb"], tmp_path / "out", WHEEL, points, nbgrader=True)
    cells = [cell for _, cell in tagged(read(copy), KIND)]
    roles = [cell.metadata.nbgrader for cell in cells]
    assert roles and all(role.grade and role.solution and role.points == 4 for role in roles)
    assert all(cell.cell_type == "markdown" for cell in cells)
    assert len({role.grade_id for role in roles}) == len(roles)


def test_what_a_class_misunderstood_is_counted_without_numbers_and_absences_are_told():
    hint = "that is in metres per frame; a second has `fps` frames."
    said = [
        f"{hint}",
        f"{hint} It uses x.",
        "your function raises ValueError: 1",
        "your function raises ValueError: 2",
    ]
    said += ["not there yet. It must return", "stopped after 30 s.", "For 3, you return 4; it should be 5."]
    said += ["For 4, you return 4; it should be 5."] * 2
    marks = [Mark(f"s{n}/x.ipynb", "speed", False, f"✗ speed: {text}") for n, text in enumerate(said)]
    marks += [Mark(f"t{n}/x.ipynb", "speed", True, "✓") for n in range(11)]
    (speed,) = summaries(grade(marks, {}))
    assert (speed.students, speed.solved) == (20, 11)
    assert speed.mistakes == [
        ("wrong, by no mistake that has a hint", 3),
        (hint, 2),
        ("raises ValueError", 2),
    ]
    page = class_page(grade(marks, {}), "Homework <2>")
    assert "Homework &lt;2&gt;" in page and "width: 55%" in page and page.count("<li>") == 3
