"""Which cell goes on which slide."""

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from mocap.course.teaching.deck import LINES, deck_of
from tests.course.stored_notebooks import read

PICTURE = new_output("display_data", {"image/png": "aGk=", "text/html": "<img>"})
QUESTION = new_output("display_data", {"text/html": '<div class="mocap-question">'})
TITLE = new_markdown_cell("# Title\n\nFirst. Second.")


def text(source, *tags):
    return new_markdown_cell(source, metadata={"tags": list(tags)})


def code(source="x", *tags, outputs=()):
    return new_code_cell(source, metadata={"tags": list(tags)}, outputs=list(outputs))


def printed(words):
    return new_output("stream", name="stdout", text=words)


def deck(*cells):
    return deck_of(new_notebook(cells=[TITLE, code("import numpy"), *cells]))


def words(slide):
    return "\n".join(cell.source for cell in slide.cells)


def test_headings_start_slides_and_exercises_come_last():
    slides = deck(
        text("## One\n\nA. B."),
        text("Write it.", "ask:f"),
        code("def f(): ...", "exercise:f", outputs=[printed("no")]),
        code("checks.f(f)", "check:f"),
        text("<details><summary>Solution</summary>\n\nsecret</details>", "solution:f"),
        text("## What you learnt\n\n- all"),
    )
    headings = [("title", "Title"), ("text", "One"), ("text", "What you learnt"), ("exercise", "F")]
    assert [(s.kind, s.heading) for s in slides] == headings
    assert words(slides[-1]) == "Write it.\ndef f(): ..."
    assert slides[-1].cells[1].outputs == []
    assert "secret" in slides[-1].notes[0]


def test_a_long_paragraph_is_short_on_the_slide_and_whole_in_the_notes():
    whole = "It is short. " + "And it goes on for a long time, with many words and more of them. " * 4
    slide = deck(text(f"## One\n\n{whole}"))[1]
    assert words(slide).startswith("It is short.") and len(words(slide)) < 180
    assert slide.notes == [whole.strip()]


def test_a_prediction_is_whole_and_its_answer_comes_on_the_next_slide():
    question = "**Predict.** " + "What? " * 60
    folded = "<details><summary>Answer</summary>\n\nThis.\n\n</details>"
    both = deck(text(f"{question}\n\n{folded}", "prediction"), text("Then."))
    apart = deck(
        text(question, "prediction"), code(outputs=[QUESTION]), text(folded, "answer"), text("Then.")
    )
    for slides in (both, apart):
        assert words(slides[1]).startswith(question.strip())
        assert "This." not in words(slides[1])
        assert words(slides[2]) == "This."
    assert [s.kind for s in both] == ["title", "prediction", "answer", "text"]
    assert [s.kind for s in apart][1] == "prediction"


SO, BODY = text("## One\n\nSo."), "def f():\n" + "    x\n" * 20


@pytest.mark.parametrize(
    ("cells", "wanted"),
    [
        ([text("**Predict.** So?", "prediction"), code(outputs=[QUESTION])], "prediction"),
        ([text("## One"), code(outputs=[QUESTION])], "question"),
        ([text("## One\n\n" + "Look.\n\n" * 6), code(outputs=[PICTURE])], "text picture"),
        ([SO, code(BODY)], "text"),
        ([SO, code(BODY, "source:f")], "text code"),
        ([code(outputs=[QUESTION]), code(outputs=[printed("one line")])], "question"),
    ],
)
def test_what_stands_on_slides_of_its_own(cells, wanted):
    assert [slide.kind for slide in deck(*cells)][1:] == wanted.split()


def test_a_picture_has_its_slide_with_the_lines_before_it_and_its_caption():
    slides = deck(
        text("## One\n\nLook."), code("plot()", outputs=[PICTURE]), text("*It falls. Why?*\n\nNext.")
    )
    assert [s.kind for s in slides] == ["title", "picture", "text"]
    assert words(slides[1]) == "Look.\n\n*It falls. Why?*"


def test_code_is_shown_where_it_is_short_and_a_function():
    function = "def f(x):\n    return x"
    assert words(deck(SO, code(function))[1]).endswith(function)
    for hidden in ("x = 1", f"{function}\n\nexplore(f)"):
        assert words(deck(SO, code(hidden))[1]) == "So."


def test_what_is_printed_is_cut():
    shown = deck(SO, code(outputs=[printed("line\n" * 40)]))[2].cells[0].outputs[0].text.splitlines()
    assert len(shown) == 16 and shown[-1] == "… (25 more lines)"


@pytest.mark.parametrize("name", ["00-quickstart", "07-walks-and-search", "19-group-graphs"])
def test_the_slides_of_a_notebook_are_not_too_full(name):
    slides = deck_of(read(name))
    assert 20 < len(slides) < 75
    for slide in slides:
        free = len(slide.cells) == 1 or slide.kind in ("exercise", "prediction", "code")
        assert slide.lines <= LINES or free
