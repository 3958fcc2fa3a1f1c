"""The terms of the course: each has an entry in the glossary, and no private word takes its place.

`tests/voice.py` has the same rule for names in code, in a table of private words and the field's terms.
"""

import re

import pytest

from tests.course.stored_notebooks import FOLDER, NAMES, markdown
from tests.course.test_prose import prose
from tests.loops import for_each
from tests.voice import TERMS

GLOSSARY = (FOLDER / "GLOSSARY.md").read_text("utf-8")
ENTRIES = set(re.findall(r"^## (.*)", GLOSSARY, re.MULTILINE))
SLIDES = sorted(path.stem for path in (FOLDER / "slides").glob("*.md"))
PAGES = ("COMMANDS.md", "GLOSSARY.md", "FORMULAS.md", "HOMEWORK.md", "PROJECT.md", "README.md", "RECIPES.md")
TEACHING = ("README.md", "exam.md", "syllabus.md", "sample-marks.md")

# The field's terms, by the pattern of their use in a sentence.
USED = {
    "align": r"align(?:s|ed|ment)?",
    "arc length": r"arc lengths?",
    "basis function": r"basis functions?",
    "beam width": r"beam widths?",
    "constraint": r"constraints?",
    "contact": r"contacts?",
    "cost": r"costs?",
    "foot sliding distance": r"foot sliding distances?",
    "foot sliding speed": r"foot sliding speeds?",
    "footplant": r"footplants?",
    "footskate": r"footskate",
    "heading": r"headings?",
    "Jacobian": r"Jacobians?",
    "level": r"levels?",
    "macro-edge": r"macro-edges?",
    "path": r"paths?",
    "peak acceleration": r"peak accelerations?",
    "planar transform": r"planar transforms?",
    "position": r"positions?",
    "residual": r"residuals?",
    "rotation": r"rotations?",
    "target": r"targets?",
    "translation": r"translations?",
    "velocity difference": r"velocity differences?",
    "weight": r"weights?",
}

# Private words where the field has a term. A pattern names the sense that is meant as well as it can.
PRIVATE = {
    r"pins?(?! the version)|pinned": "constraint, constrained",
    r"hops?": "macro-edge",
    r"beams?(?! widths?| search)": "beam width, or beam search",
    r"hills?": "basis function",
    r"wish(?:es|ed)?": "request, target, constraint",
    r"skat(?:e|es|ed|ing)": "foot sliding",
    r"shak(?:e|es|ing)": "peak acceleration",
    r"lays?|laid": "align, aligned",
    r"rides?": "path",
    r"plants?(?! the)": "footplant",
    r"gaps?": "residual, distance, difference",
    r"(?:a|the|which|this|larger|smaller|similar|same|linear|as a) shares?": "fraction, weight",
    r"(?:its|one|their|mean|same|two|different|other) places?": "position",
    r"(?:its|the root's|short|long|which) ways?|other way round": "path, method, direction",
    r"(?:foot|mean|worst|this|of|doubles the) slide": "foot sliding distance",
    r"let go": "released",
}
EXCEPTIONS = {
    "leave no gap in this format": "bones of a file do have no gap between them",
    "the *gap* or residual": "the name of the exercise that asks for the residual",
}


def read_text(page):
    return (FOLDER / page).read_text("utf-8")


def plain(text):
    """Return prose without the addresses of links and the cells that slides show, on one line."""
    text = re.sub(r"\{(?:show|code|draw) [^}]*\}", "", text)
    return re.sub(r"\s+", " ", re.sub(r"[*_\[\]]", "", prose(text)))


def private(text):
    """List private words in a text, each with some words around it and the term to write."""
    text = plain(text)
    for phrase in EXCEPTIONS:
        text = text.replace(plain(phrase), "")
    findings = []
    for pattern, term in PRIVATE.items():
        for match in re.finditer(rf"\b(?:{pattern})\b", text, re.IGNORECASE):
            excerpt = text[max(match.start() - 30, 0) : match.end() + 30]
            findings.append(f"{excerpt!r}: {term}")
    return findings


def test_each_term_that_a_notebook_uses_has_an_entry():
    text = plain("\n".join(map(markdown, NAMES)))
    used = {term for term, pattern in USED.items() if re.search(rf"\b(?:{pattern})\b", text)}
    assert used - ENTRIES == set()


def test_each_pattern_of_a_term_matches_the_term():
    for term, pattern in USED.items():
        assert re.fullmatch(pattern, term), term


def test_no_headword_is_a_private_word():
    headwords = {entry: set(entry.lower().split()) & set(TERMS) for entry in ENTRIES}
    assert {entry for entry, words in headwords.items() if words} == set()


@for_each(NAMES)
def test_no_private_word_stands_for_a_term_in_a_notebook(name):
    assert private(markdown(name)) == []


@for_each([*PAGES, *(f"teaching/{name}" for name in TEACHING), *(f"slides/{name}.md" for name in SLIDES)])
def test_no_private_word_stands_for_a_term_on_a_page(page):
    assert private(read_text(page)) == []


@pytest.mark.parametrize(
    ("text", "term"),
    [
        ("A *pin* holds the foot.", "constraint"),
        ("The joints meet their pins.", "constraint"),
        ("A narrow beam drops it.", "beam width"),
        ("The foot returns to its place.", "position"),
        ("Half of the weights are at one\nplace.", "position"),
        ("The share of walks that last", "fraction"),
    ],
)
def test_a_private_word_would_be_noticed(text, term):
    (finding,) = private(text)
    assert term in finding


@pytest.mark.parametrize(
    "text",
    [
        "The beam width is 50.",
        "`pin` and $gap$ are names",
        "All joints share one weight.",
        "Footplants are held.",
    ],
)
def test_other_words_are_left_alone(text):
    assert private(text) == []
