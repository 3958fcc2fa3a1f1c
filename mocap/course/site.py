"""The course as HTML pages without kernel and network: with pictures, players and a search."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from string import Template
from typing import Any

from mocap._shared.atomic import make_folder, write_text
from mocap.course.notebooks import read
from mocap.errors import MocapError

PAGE = Path(__file__).with_name("page.html")
PAGES = {"GLOSSARY": "Glossary", "FORMULAS": "Formula sheet"}  # beside the notebooks, as Markdown
MATH = re.compile(r"(```.*?```|`[^`]*`)|\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)


def build_site(
    notebooks: Path, out: Path, progress: Callable[[Iterable[Path]], Iterable[Path]] = iter
) -> Path:
    """Write the notebooks and pages of a folder as HTML, with a menu and a search.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the pages; `index.html` leads to the first notebook.
    progress : wraps the files while they are converted.

    Returns
    -------
    The first page.

    Raises
    ------
    MocapError : if nbconvert or latex2mathml is not installed, or there are no notebooks.

    Examples
    --------
    >>> build_site(Path("nowhere"), Path("out"))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    files = sorted(notebooks.glob("*.ipynb")) + [notebooks / f"{name}.md" for name in PAGES]
    if len(files) == len(PAGES):
        raise MocapError(f"The folder {notebooks} holds no notebooks.")
    make_folder(out)
    contents = {file.stem: _contents(file) for file in files}
    titles = {name: PAGES.get(name) or _title(name, notebook) for name, notebook in contents.items()}
    index: list[dict[str, str]] = []
    for file in progress(files):
        name = file.stem
        write_text(out / f"{name}.html", _page(name, titles, _body(contents[name])))
        index += _sections(name, titles[name], contents[name])
    write_text(out / "search.js", f"const sections = {json.dumps(index, ensure_ascii=False)};\n")
    first = files[0].stem
    write_text(out / "index.html", f'<meta http-equiv="refresh" content="0; url={first}.html">\n')
    return out / f"{first}.html"


def _contents(file: Path) -> Any:  # noqa: ANN401
    """Read a notebook, or a Markdown page as a notebook of one cell."""
    if file.suffix == ".ipynb":
        return read(file)
    from nbformat.v4 import new_markdown_cell, new_notebook

    text = file.read_text("utf-8")
    return new_notebook(cells=[new_markdown_cell(text, id="page")])


def _title(name: str, notebook: Any) -> str:  # noqa: ANN401
    return f"{name[:2]} {notebook.cells[0].source.splitlines()[0].lstrip('# ')}"


def _body(notebook: Any) -> str:  # noqa: ANN401
    """Convert a notebook's cells; formulas become MathML, which browsers draw themselves."""
    try:
        from latex2mathml.converter import convert
        from nbconvert import HTMLExporter
    except ImportError as error:
        raise MocapError("The site needs nbconvert and latex2mathml: pip install 'mocap[site]'.") from error
    formulas: list[str] = []

    def keep(found: re.Match[str]) -> str:
        if found[1]:
            return found[1]
        formulas.append(convert(found[2] or found[3], display="block" if found[2] else "inline"))
        return f"FORMULA{len(formulas) - 1}."

    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = MATH.sub(keep, cell.source)
    exporter = HTMLExporter(template_name="basic")  # type: ignore[no-untyped-call]
    body, _ = exporter.from_notebook_node(notebook)
    body = re.sub(r"FORMULA(\d+)\.", lambda found: formulas[int(found[1])], body)
    body = re.sub(r"(<h\d id=\")([^\"]+)\"", lambda found: f'{found[1]}{found[2].lower()}"', body)
    return re.sub(r'(href="(?!https?:)[^"]*)\.(?:ipynb|md)\b', r"\1.html", body)


def _page(name: str, titles: dict[str, str], body: str) -> str:
    menu = "\n".join(
        f'<a href="{other}.html"{" aria-current=page" * (other == name)}>{html.escape(shown)}</a>'
        for other, shown in titles.items()
    )
    return Template(PAGE.read_text("utf-8")).substitute(
        title=html.escape(titles[name]), menu=menu, body=body, code=_code_style()
    )


def _code_style() -> str:
    from pygments.formatters import HtmlFormatter

    return str(HtmlFormatter(style="friendly").get_style_defs(".highlight"))


def _sections(name: str, title: str, notebook: Any) -> list[dict[str, str]]:  # noqa: ANN401
    """Return the text under each heading, for the search."""
    text = "\n\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    sections = []
    for part in re.split(r"^(?=#+ )", text, flags=re.MULTILINE)[1:]:
        heading, _, rest = part.partition("\n")
        heading = heading.lstrip("# ")
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)|<[^>]*>|[*`$]", r"\1", rest)
        at = f"{name}.html#{heading.lower().replace(' ', '-')}"
        sections.append({"page": title, "heading": heading, "at": at, "text": " ".join(words.split())})
    return sections
