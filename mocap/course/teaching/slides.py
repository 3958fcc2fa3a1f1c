"""Decks of slides: written by hand beside the notebooks, with the pictures and the code of these; as pages.

A deck is a file of Markdown in `notebooks/slides`, called like its notebook. A line of three dashes ends a
slide; each begins with its heading. A line `{show what}` stands for what a cell of the notebook shows, and
`{code what}` for its code, where `what` is a tag of the cell, or words that no other cell has. A line such as
`{draw 08-tarjan 3}` stands for a step of a drawing for the board. What follows `Note:` is for the speaker.
"Predict:", "Answer:" and "Exercise:" at the beginning of a heading become a label.

The pages are shown by reveal.js from files beside them, without a network. reveal.js (MIT licence) is taken
from the package `sphinx-revealjs`, which ships it; its licence is copied along.
"""

from __future__ import annotations

import base64
import html
import re
import shutil
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

from mocap._shared.atomic import make_folder, write_file
from mocap._shared.progress import Progress
from mocap.course.formulas import to_mathml
from mocap.course.notebooks import library, notebooks_in
from mocap.course.site import MOVING, prepared
from mocap.course.teaching.board import pictures_of
from mocap.errors import MocapError, missing

TAKEN = re.compile(r"^\{(show|code|draw) ([^}\n]+)\}$", re.MULTILINE)
PICTURE = re.compile(r"!\[.*?\]\(.*?\)", re.DOTALL)
LABELS = ("Predict", "Answer", "Exercise")


@dataclass
class Slide:
    """A slide: its label, its heading, its cells, and Markdown for the speaker."""

    label: str
    heading: str
    cells: list[Any]
    notes: str


def deck_file(notebook: Path) -> Path:
    """Give where the deck of a notebook is."""
    return notebook.parent / "slides" / f"{notebook.stem}.md"


def deck_of(file: Path, notebook: Any) -> list[Slide]:  # noqa: ANN401
    """Read a deck.

    Parameters
    ----------
    file : the deck.
    notebook : from `notebooks.read`, for pictures and code.

    Returns
    -------
    The slides; a cell is of Markdown, or a copy of the notebook's with its code or with what it shows.

    Raises
    ------
    MocapError : where the deck is missing, and for a line that takes nothing, no cell or several cells of the
        notebook.
    """
    if not file.is_file():
        raise MocapError(f"There is no deck {file}: slides and films are made of decks.")
    slides = []
    for part in re.split(r"^---$", file.read_text("utf-8"), flags=re.MULTILINE):
        text, _, notes = part.partition("\nNote:")
        heading, _, body = text.strip().partition("\n")
        heading = heading.lstrip("# ")
        label, _, rest = heading.partition(": ")
        is_labelled = label in LABELS
        cells = [cell for cell in _cells_of(file, notebook, body) if cell.source or cell.get("outputs")]
        title = rest if is_labelled else heading
        slides.append(Slide(label if is_labelled else "", title, cells, notes.strip()))
    return slides


def _cells_of(file: Path, notebook: Any, body: str) -> list[Any]:  # noqa: ANN401
    """List the cells of a slide: its texts, and between them what its lines take from the notebook."""
    new_text = library().v4.new_markdown_cell
    first, *parts = TAKEN.split(body)
    triples = list(_three_by_three(parts))
    texts = [first, *(text for _, _, text in triples)]
    wrong = re.search(r"^\{.*", "".join(texts), re.MULTILINE)
    if wrong:
        raise MocapError(f"{file}: '{wrong[0]:.60}' is not {{show ...}}, {{code ...}} or {{draw ...}}.")
    cells = [new_text(first.strip())]
    for verb, name, text in triples:
        cells += [_cell_for(file, notebook, verb, name), new_text(text.strip())]
    return cells


def _three_by_three(parts: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    """Yield the parts of a text three by three."""
    remaining = iter(parts)
    return zip(remaining, remaining, remaining, strict=True)


def _cell_for(file: Path, notebook: Any, verb: str, name: str) -> Any:  # noqa: ANN401
    """Copy a cell of the notebook, with its code or with what it shows; or draw a step for the board."""
    if verb == "draw":
        new = library().v4
        drawing, _, step = name.partition(" ")
        picture = {"image/png": base64.b64encode(pictures_of(drawing)[int(step) - 1]).decode()}
        return new.new_code_cell(outputs=[new.new_output("display_data", picture)])
    matching = [cell for cell in notebook.cells if name in cell.metadata.get("tags", ())]
    matching = matching or [cell for cell in notebook.cells if name in cell.source]
    if len(matching) != 1:
        raise MocapError(f"{file}: '{name:.60}' is in {len(matching)} cells of the notebook, not in one.")
    (cell,) = matching
    if cell.cell_type == "markdown":
        return type(cell)(cell, source="\n".join(PICTURE.findall(cell.source)))
    if verb == "code":
        return type(cell)(cell, outputs=[])
    seen = [output for output in cell.outputs if "data" in output] or cell.outputs
    return type(cell)(cell, source="", outputs=seen, metadata={**cell.metadata, "code": cell.source})


PAGE = Path(__file__).with_name("slides.html")
LIST = Path(__file__).with_name("decks.html")
NEEDED = ("LICENSE", "dist/reveal.css", "dist/reveal.js", "plugin/notes/notes.js")  # of reveal.js
LINK = re.compile(
    r'<a href="(?P<page>(?!https?:)[^"#]*)(?:#[^"]*)?"(?P<rest>[^>]*)>(?P<words>.*?)</a>', re.DOTALL
)
MATH = re.compile(
    r"(?P<code><(?P<tag>pre|code)\b.*?</(?P=tag)>)|\$\$(?P<block>.+?)\$\$|\$(?P<inline>[^$\n]+?)\$", re.DOTALL
)  # but in code
ANCHOR = re.compile(r'<a class="anchor-link".*?</a>', re.DOTALL)


def build_slides(notebooks: Path, out: Path, progress: Progress = iter, *, moving: bool = False) -> Path:
    """Write the decks of a folder's notebooks as pages, and a page that lists them.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the pages; reveal.js is copied into it.
    progress : wraps the files while they are converted.
    moving : run the notebooks, and record positions of each experiment's first control, as for the site.

    Returns
    -------
    The page that lists the decks.

    Raises
    ------
    MocapError : if what is needed is not installed, there are no notebooks, or one does not run.

    Examples
    --------
    >>> build_slides(Path("nowhere"), Path("out"))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    files = [file for file in notebooks_in(notebooks) if deck_file(file).is_file()]
    rows = []
    package = find_spec("sphinx_revealjs")
    folder = Path(package.origin).parent / "_static" / "revealjs" if package and package.origin else Path()
    if not all((folder / name).is_file() for name in NEEDED):
        raise missing("Slides need reveal.js, which sphinx-revealjs ships", "slides")
    for name in NEEDED:  # out of the installed package that ships it
        make_folder((out / "reveal" / name).parent)
        shutil.copyfile(folder / name, out / "reveal" / name)
    for file in progress(files):
        title, notebook = prepared(file, moving=moving)
        write_file(
            out / f"{file.stem}.html",
            page_of(title, deck_of(deck_file(file), notebook), {f.stem for f in files}),
        )
        rows.append(f'<li><a href="{file.stem}.html">{html.escape(title)}</a></li>')
    write_file(out / "index.html", Template(LIST.read_text("utf-8")).substitute(rows="\n".join(rows)))
    return out / "index.html"


def page_of(title: str, slides: Iterable[Slide], names: Collection[str]) -> str:
    """Write a deck as a page.

    Parameters
    ----------
    title : of the page.
    slides : from `deck_of`.
    names : of the notebooks that have a deck; links to anything else become plain text.
    """
    from nbformat.v4 import new_markdown_cell
    from pygments.formatters import HtmlFormatter

    sections = []
    for number, slide in enumerate(slides):
        level = 2 if number else 1
        label = f'<span class="kind">{slide.label}</span> ' if slide.label else ""
        heading = f"<h{level}>{label}{html.escape(slide.heading)}</h{level}>"
        kind = "picture" if any(cell.get("outputs") for cell in slide.cells) else "text"
        inner = f'{heading}\n<div class="inner">{to_html(slide.cells)}</div>'
        if slide.notes:
            inner += f'<aside class="notes">{to_html([new_markdown_cell(slide.notes)])}</aside>'
        sections.append(f'<section class="{kind}">{inner}</section>')

    def linked(match: re.Match[str]) -> str:  # to a page that is no slide only the words are left
        page = match["page"]
        is_deck = page.removesuffix(".html") in names
        return f'<a href="{page}"{match["rest"]}>{match["words"]}</a>' if is_deck else match["words"]

    style = HtmlFormatter(style="friendly").get_style_defs(".highlight")
    pages = LINK.sub(linked, "\n".join(sections))
    parts = {"title": html.escape(title), "slides": pages, "code": style, "moving": MOVING.read_text("utf-8")}
    return Template(PAGE.read_text("utf-8")).substitute(parts)


def to_html(cells: Iterable[Any]) -> str:
    """Convert cells; formulas become MathML."""
    from nbformat.v4 import new_notebook

    def formula(match: re.Match[str]) -> str:
        block = match["block"]
        return match["code"] or to_mathml(html.unescape(block or match["inline"]), block=bool(block))

    page = ""
    for cell in cells:
        body, _ = _exporter().from_notebook_node(new_notebook(cells=[cell]))
        if cell.cell_type == "markdown":
            body = MATH.sub(formula, ANCHOR.sub("", body))
        page += re.sub(r' id="cell-id=[^"]*"', "", body)
    return re.sub(r'(href="(?!https?:)[^"]*)\.(?:ipynb|md)\b', r"\1.html", page)


@cache
def _exporter() -> Any:  # noqa: ANN401
    from nbconvert import HTMLExporter

    return HTMLExporter(template_name="basic")  # type: ignore[no-untyped-call]
