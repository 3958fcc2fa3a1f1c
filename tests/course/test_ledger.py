"""The ledger of papers: no equation without a row, no row without its function and cell, or else missing."""

import re
from functools import cache
from pathlib import Path
from pkgutil import resolve_name

import ledger  # of the folder figures

from tests.loops import for_each

ROOT = Path(__file__).parents[2]
PLACES = [(key, row["place"]) for key, paper in ledger.papers().items() for row in paper["rows"]]


@cache
def rows():
    return ledger.ledger(ROOT)


@for_each(PLACES)
def test_every_row_has_a_function_and_a_cell_that_exist_or_is_missing(place):
    (row,) = (row for row in rows() if (row.key, row.place) == place)
    assert row.says and row.departs and bool(row.functions) != row.departs.startswith("missing")
    if not row.functions:
        return
    for name in row.functions:
        found = resolve_name(f"mocap.{name}")
        assert callable(getattr(found, "func", found)), name  # a cached property holds its function
    for test in row.tests:
        sentence, path = re.fullmatch(r"(.+) \(`(.+)`\)", test).groups()
        _, _, body = (
            (ROOT / "tests" / path).read_text("utf-8").partition(f"def test_{sentence.replace(' ', '_')}(")
        )
        docstring = re.search(r'"""(.+?)"""', body, re.DOTALL)[1]
        cites = {(key, one) for key, one in ledger.cited(docstring)}
        assert cites & {(row.key, one) for one in ledger._one_by_one(row.place)}, "held only by who cites it"
    paper = ledger.papers()[row.key]
    assert row.cells or not (ROOT / "notebooks" / f"{paper['notebook']}.ipynb").exists()
    for cell in row.cells:
        name, heading = re.fullmatch(r"\[\w+\]\((.+)\) (.+)", cell).groups()
        assert heading.replace('"', '\\"') in (ROOT / "notebooks" / name).read_text("utf-8")


def test_notebooks_say_which_papers_could_not_be_read():
    """So that no recalled formula passes for the paper's own."""
    for key, paper in ledger.papers().items():
        text = (ROOT / "notebooks" / f"{paper['notebook']}.ipynb").read_text("utf-8")
        unread = "abstract" in paper["read"] or "transcript" in paper["read"]
        assert ("could read only" in text or "read it in another's transcript" in text) == unread, key


def test_no_equation_of_a_paper_is_without_a_row():
    have = {(row.key, place) for row in rows() for place in ledger._one_by_one(row.place)}
    for key, paper in ledger.papers().items():
        assert {(key, f"Eq. {number}") for number in range(1, paper["equations"] + 1)} <= have


def test_what_a_docstring_cites_has_a_row():
    """A new citation asks for a row; figures are pictures, and other papers have no ledger."""
    have = {(row.key, place) for row in rows() for place in ledger._one_by_one(row.place)}
    for function in ledger.functions(ROOT / "mocap"):
        for key, place in function.cites - have:
            assert place.startswith("Fig.") or key not in ledger.papers(), (function.public, key, place)


def test_the_ten_papers_are_those_of_the_faces_references():
    faces = "".join(path.read_text("utf-8") for path in (ROOT / "mocap").rglob("__init__.py"))
    assert len(ledger.papers()) == 10
    for key, paper in ledger.papers().items():
        (reference,) = set(re.findall(rf"\.\. \[{key}\] (.+?), ", faces))
        assert paper["cite"].startswith(reference) and f"*{paper['title']}" in " ".join(faces.split())
        doi = re.search(r"10\.\d+/[\d.]+\d", paper["cite"])[0]
        assert doi in faces


def test_the_page_on_disk_is_what_is_written():
    stored = (ROOT / "notebooks" / "PAPERS.md").read_text("utf-8")
    assert stored == ledger.page(rows()), "something it lists has changed: run python figures/ledger.py"


def test_every_row_of_the_page_has_as_many_columns():
    lines = [line for line in ledger.page(rows()).splitlines() if line.startswith("|")]
    assert {line.count("|") for line in lines} == {5, 7}
    assert len(lines) == 2 + len(ledger.papers()) + 2 * len(ledger.papers()) + len(PLACES)
