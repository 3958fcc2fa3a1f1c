"""Which cells of a notebook make which slide: by what a cell is.

A heading starts a slide. Of each paragraph the slide has the first sentence, and the notes for the speaker
have all. Predictions, their answers, questions, pictures and players have slides of their own, exercises come
last. Code is shown where it is short and shows the package's own or a function; else its output alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

from mocap.course.teaching.prose import blocks, shortened

LINES = 12.0  # of text on a slide
FEW = 4.0  # lines that leave room for a picture below them
WIDE = 78  # characters of such a line
ROOM = 170  # characters of a paragraph
CODE, PRINTED = 14, 16  # lines of code, and of what it prints
DRAWING = re.compile(r"\b(?:explore|show|figure|subplots)\(")
CAPTION = re.compile(r"\*(?!\*)(?:(?!\*\*).)*\*", re.DOTALL)  # a block in italics


@dataclass
class Slide:
    """A slide: its kind, its heading, its cells, and Markdown for the speaker."""

    kind: str
    heading: str
    cells: list[Any] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    lines: float = 0.0


def deck_of(notebook: Any) -> list[Slide]:  # noqa: ANN401
    r"""Cut a notebook into slides.

    Parameters
    ----------
    notebook : from `course.read`.

    Returns
    -------
    The slides, exercises last.

    Examples
    --------
    >>> from nbformat.v4 import new_markdown_cell, new_notebook
    >>> sources = ["# Walks\n\nA body walks. It is slow.", "## Why?\n\nFor fun."]
    >>> cells = [new_markdown_cell(source) for source in sources]
    >>> [(slide.kind, slide.heading) for slide in deck_of(new_notebook(cells=cells))]
    [('title', 'Walks'), ('text', 'Why?')]
    """
    made, exercises = [Slide("title", "Title")], dict[str, Slide]()
    first = next((cell for cell in notebook.cells if cell.cell_type == "code"), None)
    for cell in notebook.cells:
        tags = cell.metadata.get("tags", [])
        named = [tag.partition(":") for tag in tags if tag.startswith(("ask:", "exercise:", "solution:"))]
        if any(tag.startswith("check:") for tag in tags):
            continue
        if named:
            kind, _, name = named[0]
            exercise = exercises.setdefault(name, Slide("exercise", name.replace("_", " ").capitalize()))
            if kind == "solution":
                exercise.notes.append(cell.source)
            else:
                exercise.cells.append(_changed(cell, outputs=[]) if kind == "exercise" else cell)
        elif cell.cell_type == "markdown":
            _add_text(made, cell, tags)
        else:
            _add_code(made, cell, tags, first=cell is first)
    return [*(slide for slide in made if slide.cells), *exercises.values()]


def _add_text(made: list[Slide], cell: Any, tags: list[str]) -> None:  # noqa: ANN401
    """Put the blocks of a cell on slides, and its whole text into the notes of the first of them."""
    own = next((tag for tag in tags if tag in ("prediction", "answer")), "text")
    if own != "text" or made[-1].kind in ("prediction", "answer"):
        made.append(Slide(own, made[-1].heading))
    for block in blocks(cell.source):
        if block.startswith("# "):
            made[-1].heading = block.lstrip("# ")
        elif block.startswith("#"):
            made.append(Slide("text", block.lstrip("# ")))
        elif block.startswith("<details>"):  # what is folded has a slide of its own, after the question
            if made[-1].kind != "answer" or made[-1].cells:
                made.append(Slide("answer", made[-1].heading))
            for part in blocks(block.partition("</summary>")[2].removesuffix("</details>")):
                _add_block(made, shortened(part, ROOM), part, cell)
        elif block.startswith("**About "):  # the minutes of one who reads alone
            made[-1].notes.append(block)
        else:
            full = "prediction" in tags or CAPTION.fullmatch(block)
            _add_block(made, block if full else shortened(block, ROOM), block, cell)


def _add_block(made: list[Slide], shown: str, whole: str, cell: Any) -> None:  # noqa: ANN401
    from nbformat.v4 import new_markdown_cell

    slide, lines = made[-1], 0.5
    for line in filter(str.strip, shown.splitlines()):
        lines += 2 if line.startswith("$$") else 8 if line.startswith("![") else -(-len(line) // WIDE)
    full = slide.cells and slide.lines + lines > LINES
    below = slide.kind == "picture" and CAPTION.fullmatch(shown)
    if full or (slide.kind in ("picture", "question", "code") and not below):
        slide = Slide(slide.kind if slide.kind in ("prediction", "answer") else "text", slide.heading)
        made.append(slide)
    slide.cells.append(new_markdown_cell(shown, attachments=cell.get("attachments", {})))
    slide.lines += lines
    if shown != whole:
        slide.notes.append(whole)


def _add_code(made: list[Slide], cell: Any, tags: list[str], *, first: bool) -> None:  # noqa: ANN401
    """Put code with what it prints below the text before it where there is room, then what it shows."""
    function = cell.source.lstrip().startswith("def ") and not DRAWING.search(cell.source)
    short = function and len(cell.source.splitlines()) <= CODE and not first
    code = cell.source if short or any(tag.startswith("source:") for tag in tags) else ""
    printed = [_cut(output) for output in cell.outputs if output.output_type == "stream"]
    shown = [output for output in cell.outputs if {"image/png", "text/html"} & set(output.get("data", {}))]
    if code or (printed and not shown and not first):
        lines = sum(len(text.splitlines()) for text in (code, *(output.text for output in printed)))
        slide = made[-1]
        fits = slide.kind == "text" and slide.cells and slide.lines + 0.8 * lines <= LINES
        if not fits and (lines >= FEW or slide.kind == "text"):  # else the text after it says it again
            made.append(Slide("code", slide.heading))
        if fits or slide is not made[-1]:
            made[-1].cells.append(_changed(cell, source=code, outputs=printed))
            made[-1].lines += 0.8 * lines
    for output in shown:
        question = 'class="mocap-question"' in output.data.get("text/html", "")
        slide = made[-1]
        bet = question and slide.kind == "prediction" and slide.lines <= 2 * FEW
        if not question and slide.kind == "text" and slide.cells and slide.lines <= FEW:
            slide.kind = "picture"  # a few lines before a picture stand above it
        elif not bet:
            slide = Slide("question" if question else "picture", slide.heading)
            made.append(slide)
        made_by = {**cell.metadata, "code": cell.source}
        slide.cells.append(_changed(cell, source="", outputs=[output], metadata=made_by))


def _cut(output: Any) -> Any:  # noqa: ANN401
    lines = output.text.splitlines()
    left = f"… ({len(lines) - PRINTED + 1} more lines)"
    return _changed(output, text="\n".join([*lines[: PRINTED - 1], left])) if len(lines) > PRINTED else output


def _changed(one: Any, **new: Any) -> Any:  # noqa: ANN401
    """Copy a cell or an output with other values."""
    return type(one)(one, **new)
