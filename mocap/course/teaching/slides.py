"""The course as slides: a page for each notebook, shown by reveal.js from files beside it, without a network.

reveal.js (MIT licence) is taken from the package `sphinx-revealjs`, which ships it;
its licence is copied along.
"""

from __future__ import annotations

import html
import re
import shutil
from collections.abc import Callable, Collection, Iterable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

from mocap._shared.atomic import make_folder, write_text
from mocap.course.formulas import to_mathml
from mocap.course.notebooks import read
from mocap.course.site import MOVING, fill_in, page_title, recorded_of
from mocap.course.teaching.deck import Slide, deck_of
from mocap.errors import MocapError

PAGE, LIST = (Path(__file__).with_name(name) for name in ("slides.html", "decks.html"))
NEEDED = ("LICENSE", "dist/reveal.css", "dist/reveal.js", "plugin/notes/notes.js")  # of reveal.js
LINK = re.compile(r'<a href="(?!https?:)([^"#]*)(#[^"]*)?"([^>]*)>(.*?)</a>', re.DOTALL)
MATH = re.compile(r"(<(pre|code)\b.*?</\2>)|\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)  # but in code
ANCHOR = re.compile(r'<a class="anchor-link".*?</a>', re.DOTALL)


def reveal() -> Path:
    """Find the folder of reveal.js in the installed package that ships it.

    Raises
    ------
    MocapError : if it is not installed, or not where it was in the versions that we know.
    """
    found = find_spec("sphinx_revealjs")
    folder = Path(found.origin).parent / "_static" / "revealjs" if found and found.origin else None
    if folder is None or not all((folder / name).is_file() for name in NEEDED):
        raise MocapError("Slides need reveal.js, which sphinx-revealjs ships: pip install 'mocap[slides]'.")
    return folder


def build_slides(
    notebooks: Path,
    out: Path,
    progress: Callable[[Iterable[Path]], Iterable[Path]] = iter,
    *,
    moving: bool = False,
) -> Path:
    """Write a deck of slides for each notebook of a folder, and a page that lists them.

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
    files = sorted(notebooks.glob("*.ipynb"))
    if not files:
        raise MocapError(f"The folder {notebooks} holds no notebooks.")
    source = reveal()
    make_folder(out)
    for name in NEEDED:
        make_folder((out / "reveal" / name).parent)
        shutil.copyfile(source / name, out / "reveal" / name)
    titles = {}
    for file in progress(files):
        notebook = read(file)
        titles[file.stem] = page_title(file.stem, notebook)
        fill_in(notebook, recorded_of(file, notebook) if moving else {})
        write_text(out / f"{file.stem}.html", page_of(titles[file.stem], notebook, {f.stem for f in files}))
    rows = "\n".join(
        f'<li><a href="{name}.html">{html.escape(said)}</a></li>' for name, said in titles.items()
    )
    write_text(out / "index.html", Template(LIST.read_text("utf-8")).substitute(rows=rows))
    return out / "index.html"


def page_of(title: str, notebook: Any, names: Collection[str]) -> str:  # noqa: ANN401
    """Write the deck of a notebook as a page.

    Parameters
    ----------
    title : of the page.
    notebook : with its outputs.
    names : of the notebooks that have a deck; links to anything else become plain text.
    """
    from nbformat.v4 import new_markdown_cell
    from pygments.formatters import HtmlFormatter

    sections, heading, count = [], "", 0
    for slide in deck_of(notebook):
        count = count + 1 if slide.heading == heading else 1
        heading = slide.heading
        notes = to_html([new_markdown_cell("\n\n".join(slide.notes))], notebook.metadata)
        sections.append(_section(slide, count, to_html(slide.cells, notebook.metadata), notes))
    body = LINK.sub(lambda link: _link(link, names), "\n".join(sections))
    parts = {
        "title": html.escape(title),
        "slides": body,
        "code": HtmlFormatter(style="friendly").get_style_defs(".highlight"),
        "moving": MOVING.read_text("utf-8"),
    }
    return Template(PAGE.read_text("utf-8")).substitute(parts)


def to_html(cells: Iterable[Any], metadata: Any) -> str:  # noqa: ANN401
    """Convert cells; formulas become MathML."""
    from nbformat.v4 import new_notebook

    made = ""
    for cell in cells:
        body, _ = exporter().from_notebook_node(new_notebook(cells=[cell], metadata=metadata))
        if cell.cell_type == "markdown":
            body = MATH.sub(_formula, ANCHOR.sub("", body))
        made += re.sub(r' id="cell-id=[^"]*"', "", body)
    return re.sub(r'(href="(?!https?:)[^"]*)\.(?:ipynb|md)\b', r"\1.html", made)


def _formula(found: re.Match[str]) -> str:
    return found[1] or to_mathml(html.unescape(found[3] or found[4]), block=bool(found[3]))


@cache
def exporter() -> Any:  # noqa: ANN401
    """Give what converts cells to HTML, or say what to install."""
    try:
        from nbconvert import HTMLExporter
    except ImportError as error:
        raise MocapError("Slides need nbconvert: pip install 'mocap[slides]'.") from error
    return HTMLExporter(template_name="basic")  # type: ignore[no-untyped-call]


def _section(slide: Slide, count: int, body: str, notes: str) -> str:
    """Write a slide; pictures and questions name the section that they stand in small letters."""
    again = f" <small>{count}</small>" if count > 1 else ""
    level = 1 if slide.kind == "title" else 2
    word = {"prediction": "Predict", "answer": "Answer", "exercise": "Exercise"}.get(slide.kind)
    label = f'<span class="kind">{word}</span> ' if word else ""
    heading = f"<h{level}>{label}{html.escape(slide.heading)}{again}</h{level}>"
    aside = f'<aside class="notes">{notes}</aside>' if re.sub(r"<[^>]*>|\s", "", notes) else ""
    return f'<section class="{slide.kind}">{heading}\n<div class="inner">{body}</div>{aside}</section>'


def _link(found: re.Match[str], names: Collection[str]) -> str:
    """Keep links to other decks, and the words of links to pages that are no slides."""
    if found[1].removesuffix(".html") in names:
        return f'<a href="{found[1]}"{found[3]}>{found[4]}</a>'
    return found[4]
