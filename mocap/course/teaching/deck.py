"""Which cells of a notebook make which slide: by what a cell is, and by tags where that is not right.

A heading starts a slide. Of each paragraph the slide has the first sentence, and the notes for the speaker
have all. Predictions, their answers, questions, pictures and players have slides of their own, exercises come
last. Code is shown where it is short and shows the package's own or a function; else its output alone.

Tags change this for a cell: `slide:skip` leaves it out, `slide:notes` keeps it for the speaker, `slide:full`
shows its text in full, `slide:code` shows its code, `slide:own` gives it a slide of its own.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from mocap.course.teaching.prose import blocks, shortened

LINES = 12.0  # of text on a slide
FEW = 4.0  # lines that leave room for a picture below them
WIDE = 78  # characters of such a line
ROOM = 170  # characters of a paragraph
CODE, PRINTED = 14, 16  # lines of code, and of what it prints
PICTURES = ("image/png", "text/html")
DRAWING = re.compile(r"\b(?:explore|show|figure|subplots)\(")
UNSEEN = ("check:", "slide:skip")


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
    return _Cutter(notebook).slides()


class _Cutter:
    def __init__(self, notebook: Any) -> None:  # noqa: ANN401
        self.notebook = notebook
        self.made: list[Slide] = []
        self.exercises: dict[str, Slide] = {}
        self.heading = ""
        self.code = 0

    def slides(self) -> list[Slide]:
        """Cut the notebook cell by cell; its exercises come last."""
        for cell in self.notebook.cells:
            tags = cell.metadata.get("tags", [])
            named = next(
                (tag for tag in tags if tag.partition(":")[0] in ("ask", "exercise", "solution")), ""
            )
            if any(tag.startswith(UNSEEN) for tag in tags):
                continue
            if named:
                kind, _, name = named.partition(":")
                self._exercise(kind, name, cell)
            elif "slide:notes" in tags:
                self._last().notes.append(cell.source)
            elif cell.cell_type == "markdown":
                self._text(cell, tags)
            elif cell.cell_type == "code":
                self._code(cell, tags)
        kept = [slide for slide in self.made if slide.cells]
        return [*kept, *self.exercises.values()]

    def _last(self) -> Slide:
        return self.made[-1] if self.made else self._new("text")

    def _new(self, kind: str) -> Slide:
        self.made.append(Slide(kind, self.heading))
        return self.made[-1]

    def _exercise(self, kind: str, name: str, cell: Any) -> None:  # noqa: ANN401
        slide = self.exercises.setdefault(name, Slide("exercise", name.replace("_", " ").capitalize()))
        if kind == "solution":
            slide.notes.append(cell.source)
        else:
            cell = copy.deepcopy(cell)
            if kind == "exercise":
                cell.outputs = []
            slide.cells.append(cell)

    def _text(self, cell: Any, tags: list[str]) -> None:  # noqa: ANN401
        """Put the blocks of a cell on slides, and its whole text into the notes of the first of them."""
        own = next((kind for kind in ("prediction", "answer") if kind in tags), "")
        title = not self.made
        if own or title or "slide:own" in tags:
            self.heading = self.heading if not title else "Title"
            self._new("title" if title else own or "text")
        elif self._last().kind in ("prediction", "answer"):
            self._new("text")
        for block in blocks(cell.source):
            if block.startswith("#"):
                self._head(block.lstrip("# "), title)
            elif block.startswith("<details>"):
                self._folded(block, cell)
            else:
                full = {"slide:full", "prediction"} & set(tags) or _is_caption(block)
                self._block(block if full else shortened(block, ROOM), block, cell)

    def _head(self, heading: str, title: bool) -> None:
        self.heading = heading
        if title:
            self.made[-1].heading = heading
        else:
            self._new("text")

    def _folded(self, block: str, cell: Any) -> None:  # noqa: ANN401
        """Give what is folded a slide of its own, which follows the question."""
        inner = block.partition("</summary>")[2].removesuffix("</details>")
        if self._last().kind != "answer" or self._last().cells:
            self._new("answer")
        for part in blocks(inner):
            self._block(shortened(part, ROOM), part, cell)

    def _block(self, shown: str, whole: str, cell: Any) -> None:  # noqa: ANN401
        slide, lines = self._last(), _lines(shown)
        if shown.startswith("**About "):  # the minutes of one who reads alone
            slide.notes.append(whole)
            return
        if slide.kind in ("picture", "question", "code") and not (
            slide.kind == "picture" and _is_caption(shown)
        ):
            slide = self._new("text")
        elif slide.cells and slide.lines + lines > LINES:
            slide = self._new(slide.kind if slide.kind in ("prediction", "answer") else "text")
        slide.cells.append(_markdown(shown, cell))
        slide.lines += lines
        if shown != whole:
            slide.notes.append(whole)

    def _code(self, cell: Any, tags: list[str]) -> None:  # noqa: ANN401
        self.code += 1
        cell = copy.deepcopy(cell)
        short = len(cell.source.splitlines()) <= CODE
        wanted = any(tag.startswith(("source:", "slide:code")) for tag in tags)
        function = cell.source.lstrip().startswith("def ") and not DRAWING.search(cell.source)
        if not wanted and not (short and function and self.code > 1):
            cell.source = ""
        printed = [output for output in cell.outputs if output.output_type == "stream"]
        shown = [output for output in cell.outputs if set(PICTURES) & set(output.get("data", {}))]
        if cell.source or (printed and not shown and self.code > 1):
            self._last_code(cell, [_cut(output) for output in printed])
        for output in shown:
            asked = 'class="mocap-question"' in output.data.get("text/html", "")
            self._shown("question" if asked else "picture").cells.append(_output_alone(cell, output))

    def _shown(self, kind: str) -> Slide:
        """Take the slide of a few lines before a picture or a bet for it, or a new one."""
        slide = self._last()
        if kind == "question" and slide.kind == "prediction" and slide.lines <= 2 * FEW:
            return slide
        if kind == "picture" and slide.kind == "text" and slide.cells and slide.lines <= FEW:
            slide.kind = kind
            return slide
        return self._new(kind)

    def _last_code(self, cell: Any, printed: list[Any]) -> None:  # noqa: ANN401
        """Put code and what it prints below the text before it, where there is room."""
        lines = len(cell.source.splitlines()) + sum(len(output.text.splitlines()) for output in printed)
        slide = self._last()
        if slide.kind != "text" or slide.lines + 0.8 * lines > LINES or not slide.cells:
            if lines < FEW and slide.kind != "text":
                return  # a line or two that the text after it says again
            slide = self._new("code")
        cell.outputs = printed
        slide.cells.append(cell)
        slide.lines += 0.8 * lines


def _is_caption(block: str) -> bool:
    return re.fullmatch(r"\*[^*].*\*", block, re.DOTALL) is not None and "**" not in block


def _markdown(text: str, cell: Any) -> Any:  # noqa: ANN401
    from nbformat.v4 import new_markdown_cell

    made = new_markdown_cell(text)
    if "attachment:" in text:
        made.attachments = cell.get("attachments", {})
    return made


def _output_alone(cell: Any, output: Any) -> Any:  # noqa: ANN401
    """Copy a cell with one of its outputs, without code; the name of its source stays for recordings."""
    alone = copy.deepcopy(cell)
    alone.source, alone.outputs = "", [output]
    return alone


def _cut(output: Any) -> Any:  # noqa: ANN401
    lines = output.text.splitlines()
    if len(lines) > PRINTED:
        output.text = "\n".join([*lines[: PRINTED - 1], f"… ({len(lines) - PRINTED + 1} more lines)"])
    return output


def _lines(block: str) -> float:
    """Estimate the lines of a block on a slide."""
    return sum(_height(line) for line in block.splitlines() if line.strip()) + 0.5


def _height(line: str) -> float:
    if line.startswith("$$"):
        return 2.0
    return 8.0 if line.startswith("![") else -(-len(line) // WIDE)


def numbered(slides: list[Slide]) -> Iterator[tuple[int, Slide]]:
    """Yield each slide with its number among those of its heading, from 1."""
    count = 0
    for number, slide in enumerate(slides):
        count = count + 1 if number and slide.heading == slides[number - 1].heading else 1
        yield count, slide
