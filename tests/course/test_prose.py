"""The prose of the notebooks: no computed number is typed by hand, words are plain, minutes are honest."""

import re

import pytest
import reading_minutes  # of the folder figures
from nbformat.v4 import new_code_cell, new_markdown_cell

from mocap.course.marked_values import marked
from tests.course.stored_notebooks import FOLDER, NAMES, PAGES, every_notebook, markdown, read
from tests.loops import for_each

# Words that a reader of English as a second language stumbles over, or that have a plainer word.
UNUSUAL = (
    r"lest|thrice|shall|whoever|whomever|whence|hence|thereby|wherein|whilst|dear(?:er|est)?|mend(?:s|ed|ing)?|"
    r"at hand|goes by|told|betwixt|amongst|alas|nay|acquitted"
)
COUNTED = r"frames?|metres?|centimetres?|degrees?|steps?|seams?|cm|turns?|transitions?|times|poses?"
PER = rf"(?:{COUNTED}) an? (?:second|frame|step|metre|minute)\b"


def prose(text):
    """Return Markdown without code, formulas, addresses, tags, marked numbers and names of sections."""
    for unwanted in (
        r"```.*?```",
        r"`[^`]*`",
        r"\$\$.*?\$\$",
        r"\$[^$\n]*\$",
        r"[-−\w.]+(?: \d{3})*<!--[=~].*?-->",
        r"<!--.*?-->",
        r"\]\([^)]*\)",
        r"<[^>]*>",
        r"(?:[Ss]ections?|Eqs?\.|[Ff]igures?|[Cc]hapters?) [\d.]+(?:(?:,| and|–| to) [\d.]+)*",
        r"[\d.]+ Hz|\b(?:19|20)\d\d\b|\b\d\d_\d\d\b",
    ):
        text = re.sub(unwanted, " ", text, flags=re.DOTALL)
    return text


def said(text):
    """List the numbers that are no small whole numbers."""
    numbers = re.findall(
        r"(?<![\w.])\d{1,3}(?: \d{3})+(?:\.\d+)?(?![\w])|(?<![\w.])\d+(?:\.\d+)?(?![\w])", text
    )
    return {n.replace(" ", "") for n in numbers if len(re.sub(r"\D", "", n)) >= 3 or "." in n}


def printed(name):
    """Join all that the cells of a notebook print or show as text, pictures' sentences too.

    What a quiz or a bet asks is prose; what came out of a bet is a result.
    """
    parts = []
    for cell in read(name).cells:
        for output in cell.get("outputs", ()):
            text = output.get("data", {}).get("text/plain", "")
            if cell.source.startswith("lab.bets("):
                text = "\n".join(line.rpartition(": ")[2] for line in text.splitlines())
            if not cell.source.startswith(("lab.quiz(", "lab.bet(")):
                parts += [output.get("text", ""), text]
    return "\n".join(parts)


@every_notebook
def test_no_number_that_a_cell_prints_is_typed_by_hand(name):
    shown = said(printed(name).replace(",", " "))
    typed = {
        (number, cell.id)
        for cell in read(name).cells
        if cell.cell_type == "markdown"
        for number in said(prose(cell.source.split("## Read on")[0]))
    }
    assert sorted(pair for pair in typed if pair[0] in shown) == []


@every_notebook
def test_every_mark_stands_behind_a_number(name):
    for cell in read(name).cells:
        if cell.cell_type == "markdown":
            list(marked(cell.source))


@for_each([*NAMES, *PAGES])
def test_words_are_plain(page):
    text = prose(markdown(page) if page in NAMES else (FOLDER / page).read_text("utf-8"))
    assert re.findall(rf"(?i)\b(?:{UNUSUAL}|{PER})\b", text) == []


def test_what_a_student_reads_and_does_is_counted():
    text = "One ![a picture](a.png)<!--= x --> two three.\n\n```python\nx = 1\n```\n\n## Read on\n\nA book."
    cells = [
        new_markdown_cell(text),
        new_code_cell("a = 1\n\nlab.quiz('a')", metadata={"tags": ["experiment:a"]}),
        new_code_cell("def climb(): ...", metadata={"tags": ["exercise:climb"]}),
    ]
    counted = reading_minutes.contents(cells)
    assert counted == (3, 3, 1, 1, 14)
    assert counted.minutes == pytest.approx(3 / 120 + 3 * 8 / 60 + 0.5 + 4 + 14)


@every_notebook
def test_the_minutes_are_honest(name):
    text = "\n".join(cell.source for cell in read(name).cells)
    stated = int(re.search(r"\*\*About (\d+) minutes", text)[1])
    assert abs(stated - reading_minutes.contents(read(name).cells).minutes) <= 2
    assert stated <= 95


def test_the_guide_states_the_hours_of_a_reader_who_counted_exercises():
    hours = re.search(r"the main sequence takes ([\d.]+) hours", (FOLDER / "README.md").read_text("utf-8"))
    assert hours and abs(float(hours[1]) - reading_minutes.reader_hours()) < 0.15
