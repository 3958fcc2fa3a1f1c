"""The symbols of the main sequence: one table on the formula sheet, and one meaning for each letter."""

import re
from collections import Counter

import pytest

from tests.course.stored_notebooks import FOLDER, NAMES, markdown
from tests.loops import for_each

WAY = [name for name in NAMES if name[2] == "-" and int(name[:2]) <= 8]
TABLE = (FOLDER / "FORMULAS.md").read_text("utf-8").partition("\n## Symbols\n")[2].partition("\n## ")[0]
ROWS = re.findall(r"^\| (\$.*?\$) \| (.+?) \| ([\d, ]+) \|$", TABLE, re.MULTILINE)
GREEK = "alpha|beta|gamma|delta|theta|lambda|mu|pi|rho|sigma|tau|phi|varphi|psi|omega|Delta|Sigma|Phi|Omega"
ONE = r"\s*\{?\s*([A-Za-z])(?![A-Za-z])\}?"  # the letter of \mathbf x, or of \mathbf{x}
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)
ITALIC = re.compile(r"(?<![*\w])\*([A-Za-z])\*(?![*\w])")


def letters(formula):
    """Find the letters of a formula: italic, Greek, bold, and upright ones if they are no part of a word."""
    words = r"\\(?:text|operatorname|mathrm)\s*\{[^{}]{2,}\}"
    formula = re.sub(words, " ", formula)
    found = {f"{kind} {letter}" for kind, letter in re.findall(rf"\\(mathbf|mathrm){ONE}", formula)}
    formula = re.sub(rf"\\(?:mathbf|mathrm){ONE}", " ", formula)
    found |= set(re.findall(rf"\\({GREEK})(?![A-Za-z])", formula))
    return found | set(re.findall(r"[A-Za-z]", re.sub(r"\\[A-Za-z]+", " ", formula)))


def letters_of(text):
    """Find the letters of the formulas of a Markdown text, and its single italic letters."""
    text = re.sub(r"```.*?```|`[^`]*`", " ", text, flags=re.DOTALL)
    formulas = [block or inline for block, inline in FORMULA.findall(text)]
    return set(ITALIC.findall(FORMULA.sub(" ", text))).union(*map(letters, formulas))


def meanings():
    """Return each letter of the table, with its meaning and its notebooks, in the order of the table."""
    for symbols, meaning, notebooks in ROWS:
        for symbol in sorted(letters_of(symbols)):
            yield symbol, meaning, notebooks.split(", ")


@pytest.mark.parametrize(
    ("formula", "found"),
    [
        (r"\mathrm{e}^{\mathrm{i}\theta} g + m", {"mathrm e", "mathrm i", "theta", "g", "m"}),
        (r"\dot{\mathbf x}_a = \frac12 \Big( \bar x'_0 \Big)", {"mathbf x", "a", "x"}),
        (r"\operatorname{atan2}(\mathrm{Im}\, C, z)", {"C", "z"}),
        (r"(a, i, \text{cost}) + 1\,\mathrm{mm}", {"a", "i"}),
        (r"\sum_{i=1}^{j} \alpha\,x_i \cdots \cos\Omega", {"i", "j", "alpha", "x", "Omega"}),
    ],
)
def test_the_letters_of_a_formula(formula, found):
    assert letters(formula) == found


def test_a_letter_has_one_meaning():
    found = Counter(symbol for symbol, *_ in meanings())
    assert len(found) > 30
    assert [symbol for symbol, count in found.items() if count > 1] == []
    assert [text for text, count in Counter(text for _, text, _ in ROWS).items() if count > 1] == []


@for_each(WAY)
def test_the_table_has_the_letters_of_a_notebook_and_no_others(name):
    told = {symbol for symbol, _, notebooks in meanings() if name[:2] in notebooks}
    assert letters_of(markdown(name)) == told


@for_each(WAY)
def test_slides_use_the_letters_of_their_notebook(name):
    slides = (FOLDER / "slides" / f"{name}.md").read_text("utf-8")
    assert letters_of(slides) <= letters_of(markdown(name))


def test_the_table_names_notebooks_of_the_main_sequence_in_order():
    for _, _, notebooks in meanings():
        assert notebooks == sorted({*notebooks} & {name[:2] for name in WAY})
