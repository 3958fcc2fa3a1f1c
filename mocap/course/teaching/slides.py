"""The course as slides: a page for each notebook, shown by reveal.js from files beside it, without a network.

reveal.js (MIT licence) is taken from the package `sphinx-revealjs`, which ships it;
its licence is copied along.
"""

from __future__ import annotations

import html
import re
import shutil
from collections.abc import Collection, Iterable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

from mocap._shared.atomic import make_folder, write_text
from mocap._shared.progress import Progress
from mocap.course.formulas import to_mathml
from mocap.course.notebooks import notebooks_in
from mocap.course.site import MOVING, prepared
from mocap.course.teaching.deck import Slide, deck_file, deck_of
from mocap.errors import missing

PAGE, LIST = (Path(__file__).with_name(name) for name in ("slides.html", "decks.html"))
NEEDED = ("LICENSE", "dist/reveal.css", "dist/reveal.js", "plugin/notes/notes.js")  # of reveal.js
LINK = re.compile(r'<a href="(?!https?:)([^"#]*)(#[^"]*)?"([^>]*)>(.*?)</a>', re.DOTALL)
MATH = re.compile(r"(<(pre|code)\b.*?</\2>)|\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)  # but in code
ANCHOR = re.compile(r'<a class="anchor-link".*?</a>', re.DOTALL)


def _copy_reveal(out: Path) -> None:
    """Copy reveal.js out of the installed package that ships it."""
    found = find_spec("sphinx_revealjs")
    folder = Path(found.origin).parent / "_static" / "revealjs" if found and found.origin else Path()
    if not all((folder / name).is_file() for name in NEEDED):
        raise missing("Slides need reveal.js, which sphinx-revealjs ships", "slides")
    for name in NEEDED:
        make_folder((out / "reveal" / name).parent)
        shutil.copyfile(folder / name, out / "reveal" / name)


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
    files, rows = [file for file in notebooks_in(notebooks) if deck_file(file).is_file()], []
    _copy_reveal(out)
    for file in progress(files):
        title, notebook = prepared(file, moving=moving)
        write_text(
            out / f"{file.stem}.html",
            page_of(title, deck_of(deck_file(file), notebook), {f.stem for f in files}),
        )
        rows.append(f'<li><a href="{file.stem}.html">{html.escape(title)}</a></li>')
    write_text(out / "index.html", Template(LIST.read_text("utf-8")).substitute(rows="\n".join(rows)))
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
        notes = to_html([new_markdown_cell(slide.notes)]) if slide.notes else ""
        sections.append(_section(slide, 2 if number else 1, to_html(slide.cells), notes))

    def linked(found: re.Match[str]) -> str:  # to a page that is no slide only the words are left
        known = found[1].removesuffix(".html") in names
        return f'<a href="{found[1]}"{found[3]}>{found[4]}</a>' if known else found[4]

    parts = {
        "title": html.escape(title),
        "slides": LINK.sub(linked, "\n".join(sections)),
        "code": HtmlFormatter(style="friendly").get_style_defs(".highlight"),
        "moving": MOVING.read_text("utf-8"),
    }
    return Template(PAGE.read_text("utf-8")).substitute(parts)


def to_html(cells: Iterable[Any]) -> str:
    """Convert cells; formulas become MathML."""
    from nbformat.v4 import new_notebook

    def formula(found: re.Match[str]) -> str:
        return found[1] or to_mathml(html.unescape(found[3] or found[4]), block=bool(found[3]))

    made = ""
    for cell in cells:
        body, _ = _exporter().from_notebook_node(new_notebook(cells=[cell]))
        if cell.cell_type == "markdown":
            body = MATH.sub(formula, ANCHOR.sub("", body))
        made += re.sub(r' id="cell-id=[^"]*"', "", body)
    return re.sub(r'(href="(?!https?:)[^"]*)\.(?:ipynb|md)\b', r"\1.html", made)


@cache
def _exporter() -> Any:  # noqa: ANN401
    from nbconvert import HTMLExporter

    return HTMLExporter(template_name="basic")  # type: ignore[no-untyped-call]


def _section(slide: Slide, level: int, body: str, notes: str) -> str:
    label = f'<span class="kind">{slide.label}</span> ' if slide.label else ""
    heading = f"<h{level}>{label}{html.escape(slide.heading)}</h{level}>"
    kind = "picture" if any(cell.get("outputs") for cell in slide.cells) else "text"
    aside = f'<aside class="notes">{notes}</aside>' if notes else ""
    return f'<section class="{kind}">{heading}\n<div class="inner">{body}</div>{aside}</section>'
