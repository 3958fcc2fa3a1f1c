"""The course as HTML pages without kernel and network: with pictures, players and a search."""

from __future__ import annotations

import copy
import html
import json
import re
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from string import Template
from typing import Any, NamedTuple

from mocap._shared.atomic import make_folder, write_text
from mocap.course.notebooks import execute, read
from mocap.errors import MocapError

PAGE = Path(__file__).with_name("page.html")
MOVING = Path(__file__).with_name("moving.js")
STILL = "mocap-still"  # the class of a picture that stands in for a widget
PAGES = {  # beside the notebooks
    "GLOSSARY": "Glossary",
    "FORMULAS": "Formula sheet",
    "PAPERS": "Papers",
    "PROJECT": "Project",
}
MATH = re.compile(r"(```.*?```|`[^`]*`)|\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)
UPRIGHT = re.compile(r"\\(?:operatorname|mathrm)\s*\{([A-Za-z]\w*)\}")
ARG = re.compile(r"\\arg\b")  # which the converter does not know
NAMED = r"<m(?:i|text)>[a-z]{2,}\d?</m(?:i|text)>"  # a function's name, such as sin
BEFORE = re.compile(rf"(</(?:mi|mn|mrow|msub|msup|msubsup|mfrac|msqrt)>)(?=(?:<msup>)?{NAMED})")
AFTER = re.compile(rf"({NAMED}|<msup>{NAMED}<mn>\d</mn></msup>)(?=<(?:mi|mn|mrow|ms|mf))")
BARS = {r">\lVert<": ">‖<", r">\rVert<": ">‖<", r">\|<": ">‖<", r">\lvert<": ">|<", r">\rvert<": ">|<"}
THIN = r'\1<mspace width="0.167em" />'
HEADING = re.compile(r'<h(\d) id="[^"]*">(.*?)<a class="anchor-link" href="[^"]*">¶</a></h\1>', re.DOTALL)
NOTE = '<p class="note">{}</p>'
STILL_NOTES = {
    False: "A still picture: its controls move where the notebook runs.",
    True: "A recording: here you can play it and turn it; it answers you where the notebook runs.",
}
LIVE = {  # what needs no Python, by its class
    "mocap-player": "the players play",
    "mocap-question": "quizzes and bets answer you",
    "mocap-inspector": "seams can be looked into",
    "mocap-blind": "the blind test can be taken",
    "moving": "the sliders show recorded positions",
}
RUN = (
    "To run {} live, in a checkout of the package: <code>pip install '.[notebooks]'</code>, "
    "then <code>mocap lab</code>."
)


class Section(NamedTuple):
    """A heading of a page, its level, and its place in the page."""

    level: int
    at: str
    heading: str


def build_site(
    notebooks: Path,
    out: Path,
    progress: Callable[[Iterable[Path]], Iterable[Path]] = iter,
    *,
    moving: bool = False,
) -> Path:
    """Write the notebooks and pages of a folder as HTML, with a menu and a search.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the pages; `index.html` leads to the first notebook.
    progress : wraps the files while they are converted.
    moving : run the notebooks, and record positions of each experiment's first control; else a still picture
        stands there.

    Returns
    -------
    The first page.

    Raises
    ------
    MocapError : if nbconvert or latex2mathml is not installed, there are no notebooks, or one does not run.

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
    titles = {name: PAGES.get(name) or page_title(name, notebook) for name, notebook in contents.items()}
    index: list[dict[str, str]] = []
    for file in progress(files):
        name, notebook = file.stem, contents[file.stem]
        fill_in(notebook, recorded_of(file, notebook) if moving and file.suffix == ".ipynb" else {})
        body, sections = _anchored(body_of(notebook))
        write_text(out / f"{name}.html", _page(name, titles, body, sections))
        index += _searched(name, titles[name], body, sections)
    write_text(out / "search.js", f"const sections = {json.dumps(index, ensure_ascii=False)};\n")
    first = f"{files[0].stem}.html"
    start = f'<a href="{first}">{html.escape(titles[files[0].stem])}</a>'
    head = f'<meta charset="utf-8"><title>mocap</title><meta http-equiv="refresh" content="0; url={first}">'
    write_text(out / "index.html", f'<!DOCTYPE html>\n<html lang="en">{head}\n{start}\n')
    return out / first


def _contents(file: Path) -> Any:  # noqa: ANN401
    """Read a notebook, or a Markdown page as a notebook of one cell."""
    if file.suffix == ".ipynb":
        return read(file)
    from nbformat.v4 import new_markdown_cell, new_notebook

    text = file.read_text("utf-8")
    return new_notebook(cells=[new_markdown_cell(text, id="page")])


def page_title(name: str, notebook: Any) -> str:  # noqa: ANN401
    """Give a notebook's number and its heading."""
    return f"{name.partition('-')[0]} {notebook.cells[0].source.splitlines()[0].lstrip('# ')}"


def recorded_of(file: Path, notebook: Any) -> dict[str, Any]:  # noqa: ANN401
    """Run a copy of a notebook, and give the recording of each experiment by the source of its cell."""
    from nbclient.exceptions import CellExecutionError
    from nbformat.v4 import new_code_cell

    with tempfile.TemporaryDirectory() as folder:
        again = copy.deepcopy(notebook)
        watching = f"from mocap.widgets import recording\nrecording.watch({folder!r})"
        again.cells.insert(0, new_code_cell(watching))
        try:
            execute(again, file.parent, 600)
        except CellExecutionError as error:
            raise MocapError(f"{file}: a cell fails with {error.ename}: {error.evalue:.99}") from error
        recorded = [json.loads(kept.read_text("utf-8")) for kept in sorted(Path(folder).iterdir())]
    for one in recorded:
        if "error" in one:
            raise MocapError(f"{file}: an experiment cannot be recorded: {one['error']:.99}")
    return {one["source"]: one for one in recorded}


def fill_in(notebook: Any, recorded: dict[str, Any]) -> None:  # noqa: ANN401
    """Put recordings in the place of experiments, and a sentence above what stays still."""
    opening = f'<div class="{STILL}">'
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if opening in data.get("text/html", ""):
                note = NOTE.format(STILL_NOTES["mocap-player" in data["text/html"]])
                data["text/html"] = data["text/html"].replace(opening, opening + note, 1)
                if cell.source in recorded:
                    data["text/html"] = _moving(recorded[cell.source])


def _moving(recorded: dict[str, Any]) -> str:
    """Write a recording as a slider and a picture; `moving.js` moves them."""
    at, labels = recorded["at"], recorded["labels"]
    data = json.dumps({key: recorded[key] for key in ("labels", "pictures")}).replace("<", "\\u003c")
    label = html.escape(labels[at])
    return (
        f'<div class="moving"><label>{html.escape(recorded["name"])} <input type="range" min="0" '
        f'max="{len(labels) - 1}" value="{at}" aria-valuetext="{label}"><output>{label}</output></label>'
        f'<img alt="{html.escape(recorded["alt"])}" src="data:image/png;base64,{recorded["pictures"][at]}">'
        f'<script type="application/json">{data}</script></div>'
    )


def body_of(notebook: Any) -> str:  # noqa: ANN401
    """Convert a notebook's cells; formulas become MathML, which browsers draw themselves."""
    try:
        import latex2mathml  # noqa: F401 - `_mathml` needs it
        from nbconvert import HTMLExporter
    except ImportError as error:
        raise MocapError("The site needs nbconvert and latex2mathml: pip install 'mocap[site]'.") from error
    formulas: list[str] = []

    def keep(found: re.Match[str]) -> str:
        if found[1]:
            return found[1]
        formulas.append(_mathml(found[2] or found[3], "block" if found[2] else "inline"))
        return f"FORMULA{len(formulas) - 1}."

    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = MATH.sub(keep, cell.source)
    exporter = HTMLExporter(template_name="basic")  # type: ignore[no-untyped-call]
    body, _ = exporter.from_notebook_node(notebook)
    body = re.sub(r"FORMULA(\d+)\.", lambda found: formulas[int(found[1])], body)
    return re.sub(r'(href="(?!https?:)[^"]*)\.(?:ipynb|md)\b', r"\1.html", body)


def _mathml(formula: str, display: str) -> str:
    """Convert a formula, with thin spaces around the names of functions, as TeX sets them."""
    from latex2mathml.converter import convert

    converted = convert(UPRIGHT.sub(r"\\text{\1}", ARG.sub(r"\\text{arg}", formula)), display=display)
    for left, bar in BARS.items():  # which the converter leaves as they are after \big
        converted = converted.replace(left, bar)
    return AFTER.sub(THIN, BEFORE.sub(THIN, converted))


def _anchored(body: str) -> tuple[str, list[Section]]:
    """Give each heading the name that links in Markdown use, and list the headings."""
    sections: list[Section] = []
    names: Counter[str] = Counter()

    def named(found: re.Match[str]) -> str:
        heading = _text(found[2])
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") or "section"
        at = f"{name}-{names[name]}" if names[name] else name
        names[name] += 1
        sections.append(Section(int(found[1]), at, heading))
        link = f'<a class="anchor-link" href="#{at}" aria-label="Link to this section">¶</a>'
        return f'<h{found[1]} id="{at}">{found[2]}{link}</h{found[1]}>'

    return HEADING.sub(named, body), sections


def _text(part: str) -> str:
    """Take the words out of HTML: those of formulas and of code, too."""
    part = re.sub(r"(?s)<(script|style)\b.*?</\1>", " ", part)
    part = re.sub(r"(?s)<math.*?</math>", lambda found: re.sub(r"<[^>]*>", " ", found[0]), part)
    part = re.sub(r"</(?:p|div|li|td|th|tr|pre|h\d|summary)>|<br\s*/?>", " ", part)
    return " ".join(html.unescape(re.sub(r"<[^>]*>", "", part)).replace("¶", " ").split())


def _searched(name: str, title: str, body: str, sections: list[Section]) -> list[dict[str, str]]:
    """Return the text under each heading, for the search."""
    parts = re.split(r'<h\d id="[^"]*">.*?</h\d>', body, flags=re.DOTALL)[1:]
    return [
        {"page": title, "heading": section.heading, "at": f"{name}.html#{section.at}", "text": _text(part)}
        for section, part in zip(sections, parts, strict=True)
    ]


def _page(name: str, titles: dict[str, str], body: str, sections: list[Section]) -> str:
    inner = "".join(
        f'<li><a href="#{s.at}">{html.escape(s.heading)}</a></li>' for s in sections if s.level == 2
    )
    menu = "\n".join(
        f'<li><a href="{other}.html"{" aria-current=page" * (other == name)}>{html.escape(shown)}</a>'
        f"{f'<ul>{inner}</ul>' * (other == name and inner != '')}</li>"
        for other, shown in titles.items()
    )
    parts = {"menu": menu, "note": _note(name, body), "body": body, "code": _code_style()}
    return filled(PAGE, titles[name], parts)


def filled(page: Path, title: str, parts: dict[str, str]) -> str:
    """Fill in a page's template: its title, its parts, and the script that moves recordings."""
    moving = MOVING.read_text("utf-8")
    return Template(page.read_text("utf-8")).substitute(parts, title=html.escape(title), moving=moving)


def _note(name: str, body: str) -> str:
    """Say what moves on a page, what does not, and how to run it."""
    if name in PAGES:
        return NOTE.format(f"This page is text. {RUN.format('the notebooks')}")
    live = [said for part, said in LIVE.items() if f'class="{part}' in body]
    if not live:
        return NOTE.format(f"This page is still: code and controls do not run here. {RUN.format('it')}")
    said = " and ".join(filter(None, [", ".join(live[:-1]), live[-1]]))
    return NOTE.format(f"On this page {said}; code and other controls are still. {RUN.format('it')}")


def _code_style() -> str:
    from pygments.formatters import HtmlFormatter

    light, dark = (
        HtmlFormatter(style=style).get_style_defs(".highlight") for style in ("friendly", "native")
    )
    return f"{light}\n@media screen and (prefers-color-scheme: dark) {{\n{dark}\n}}"
