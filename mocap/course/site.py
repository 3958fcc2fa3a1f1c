"""The course as HTML pages without kernel and network, beside the reference pages of the package."""

from __future__ import annotations

import base64
import copy
import html
import io
import json
import pkgutil
import re
import shutil
import tempfile
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any

from PIL import Image

import mocap
from mocap._shared.atomic import make_folder, write_file
from mocap._shared.progress import Progress
from mocap.course.live_experiments import LIVE
from mocap.course.notebooks import execute, library, notebooks_in, read
from mocap.course.search_texts import write_search_texts
from mocap.course.shared_files import share_attachments, share_outputs, trim
from mocap.errors import MocapError, missing
from mocap.widgets.embedding import script_json
from mocap.widgets.link_picture import link_picture
from mocap.widgets.walking_page import bundled_graph, walk_page

HERE = Path(__file__).parent
MOVING = HERE / "moving.js"
STILL = "mocap-still"  # the class of a picture that stands in for a widget
PRIVATE = shutil.ignore_patterns("answers*", ".*")  # of the teachers' folder
HIDDEN = re.compile(r"\._|\.answers$")  # rooms without a page: private ones, and the right answers
NOTE = '<p class="note">{}</p>'
STILL_NOTES = {
    False: "A still picture: its controls move where the notebook runs.",
    True: "A recording: here you can play it and turn it; it answers you where the notebook runs.",
}
SCRIPT = re.compile(r'<script type="module">.*?</script>', re.DOTALL)
ALT = re.compile(r'\balt="([^"]*)"')
AGAIN = re.compile(r"<p><small>Run this cell[^<]*</small></p>")
ABOVE = NOTE.format(
    "Players, sliders, quizzes, bets and the blind test answer you on these pages; code and some "
    'controls are still. To run it live: <code>pip install "motion-graphs[notebooks]"</code>, in a checkout '
    '<code>pip install ".[notebooks]"</code>, then <code>mocap lab</code>.'
)
ABOVE += '<script>document.body.classList.add("mocap-page")</script>'  # players are dark where the page is
TERM = re.compile(
    r"^## (.+)\n+(?:(?!^## ).*\n)*?.*\[→ [^]]*\]\(([^)#]+)\.ipynb", re.MULTILINE
)  # of the glossary
UNSOLVED = re.compile(
    r"^✗ (\w+): not there yet\. It must (return .*)\n(?:\1: the package's .*\n?)?", re.MULTILINE
)
YOUR_TURN = r"Your turn: write \1 where the notebook runs. It must \2\n"
# Groups of notebooks on the first page: a title, a sentence, and the number of the first notebook.
GROUPS = (
    ("From clips to a graph", "What a motion is, when two moments are similar, and how to join them.", "00"),
    (
        "Walks that obey",
        "Search for a walk along a path, steer it, and judge it, also with captured people.",
        "07",
    ),
    ("Beyond the graph", "Edit motions, give them to other bodies, and blend whole families of clips.", "11"),
)
CARD = (
    '<a class="card" href="{page}.html"><img src="{picture}" alt="" loading="lazy">'
    "<b>{number}</b> <span>{title}</span></a>"
)
CARD_SIZE = (360, 240)  # pixels that a picture of a card fits in
REFERENCE = "{0}\n{1}\n\n.. automodule:: {0}\n   :members:\n   :imported-members:\n"


def build_site(
    notebooks: Path, out: Path, progress: Progress = iter, *, moving: bool = False, address: str = ""
) -> Path:
    """Write the notebooks and pages of a folder as HTML, beside the reference pages of the package.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the pages; `index.html` lists them.
    progress : wraps the notebooks while they are prepared.
    moving : run the notebooks, and record positions of each experiment's first control anew. Otherwise the
        recordings of the release are shown, or a still picture where a cell has changed since.
    address : where the site will be published, as in https://example.org/course. Links to it then show a
        picture.

    Returns
    -------
    The page that lists all others.

    Raises
    ------
    MocapError : if Sphinx is not installed, there are no notebooks, or one does not run.

    Examples
    --------
    >>> build_site(Path("nowhere"), Path("out"))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    nbformat = library()
    files = notebooks_in(notebooks)
    if not all(map(find_spec, ("furo", "myst_nb", "sphinx"))):
        raise missing("The site needs Sphinx, MyST-NB and Furo", "site")
    from sphinx.application import Sphinx

    make_folder(out)
    make_folder(out / "_shared")
    with tempfile.TemporaryDirectory() as folder:
        titles = []
        cards = {}
        terms = _terms(notebooks / "GLOSSARY.md")
        for file in progress(files):
            title, notebook = prepared(file, moving=moving, live=True)
            titles.append(f"{title} <{file.stem}>")
            cards[file.stem] = _card(title, notebook, out, file.stem)
            share_attachments(notebook, out)
            share_outputs(notebook, out)
            notebook.cells.insert(1, nbformat.v4.new_markdown_cell(ABOVE, id="note"))
            if file.stem in terms:
                notebook.cells.insert(1, _index_cell(terms[file.stem]))
            write_file(Path(folder, file.name), nbformat.writes(notebook))
        for page in notebooks.glob("*.md"):
            shutil.copy(page, folder)
        shutil.copytree(notebooks / "teaching", Path(folder, "teaching"), ignore=PRIVATE)
        texts = [page.relative_to(folder).as_posix() for page in sorted(Path(folder).rglob("*.md"))]
        toc = {"course": "\n".join(titles), "pages": "\n".join(texts)}
        toc |= {"package": "\n".join(_write_reference(Path(folder))), "count": str(len(files))}
        toc |= {"groups": _groups(cards), "picture": picture_address(address)}
        first = Template((HERE / "index.md").read_text("utf-8"))
        write_file(Path(folder, "index.md"), first.substitute(toc))
        warned = io.StringIO()  # of papers cited twice
        Sphinx(folder, HERE, out, Path(folder, ".doctrees"), "html", status=None, warning=warned).build()
    trim(out)
    write_search_texts(out)
    graph = bundled_graph()
    write_file(
        out / "walk.html", walk_page(graph, picture=picture_address(address), course="00-quickstart.html")
    )
    write_file(out / "walk.png", link_picture(graph))
    return out / "index.html"


def picture_address(address: str) -> str:
    """Return the address of the picture that links to the site show.

    Examples
    --------
    >>> picture_address("https://example.org/course/")
    'https://example.org/course/walk.png'
    """
    return f"{address.rstrip('/')}/walk.png" if address else "walk.png"


def _index_cell(terms: list[str]) -> Any:  # noqa: ANN401
    """Return a cell without text by which the search of the site finds terms of the glossary."""
    entries = "\n".join(f"```{{index}} ! {term}\n```" for term in terms)
    return library().v4.new_markdown_cell(entries, id="index")


def _terms(glossary: Path) -> dict[str, list[str]]:
    """Return the terms of the glossary by the notebook that teaches them.

    The common beginning of several terms is a term of the first of their notebooks.
    """
    text = glossary.read_text("utf-8") if glossary.exists() else ""
    taught = dict(TERM.findall(text))
    beginnings: dict[str, list[str]] = {}
    for term, notebook in taught.items():
        beginning = " ".join(term.split()[:-1])
        if " " in beginning:
            beginnings.setdefault(beginning, []).append(notebook)
    shared = {beginning: min(stems) for beginning, stems in beginnings.items() if len(stems) > 1}
    terms: dict[str, list[str]] = {}
    for term, notebook in (shared | taught).items():
        terms.setdefault(notebook, []).append(term)
    return terms


def _card(title: str, notebook: Any, out: Path, stem: str) -> str:  # noqa: ANN401
    """Write the picture of a notebook's card, and return the card."""
    number, _, heading = title.partition(" ")
    attached = [data["image/png"] for data in notebook.cells[0].get("attachments", {}).values()]
    if not attached:
        return CARD.format(page=stem, picture="walk.png", number=number, title=html.escape(heading))
    picture = Image.open(io.BytesIO(base64.b64decode(attached[0]))).convert("RGB")
    picture.thumbnail(CARD_SIZE)
    name = f"_shared/card-{stem}.png"
    data = io.BytesIO()
    picture.quantize(64).save(data, "png", optimize=True)
    (out / name).write_bytes(data.getvalue())
    return CARD.format(page=stem, picture=name, number=number, title=html.escape(heading))


def _groups(cards: dict[str, str]) -> str:
    """Return the groups of cards of the first page."""
    ends = [first for _, _, first in GROUPS[1:]] + ["~"]
    parts = []
    for (title, words, first), end in zip(GROUPS, ends, strict=True):
        of_group = [card for stem, card in cards.items() if first <= stem < end]
        if of_group:
            parts.append(f'## {title}\n\n{words}\n\n<div class="cards">{"".join(of_group)}</div>\n')
    return "\n".join(parts)


def prepared(file: Path, *, moving: bool, live: bool = False) -> tuple[str, Any]:
    """Read a notebook for readers without Python; return its number with its heading, and the notebook.

    If `live`, the page has the script that runs small experiments.
    """
    notebook = read(file)
    recorded = recorded_of(file, notebook) if moving else stored_recordings(file)
    fill_in(notebook, recorded, file.stem if live else "")
    number = file.name.partition("-")[0]
    heading = notebook.cells[0].source.splitlines()[0].lstrip("# ")
    return f"{number} {heading}", notebook


def recorded_of(file: Path, notebook: Any) -> dict[str, Any]:  # noqa: ANN401
    """Run a copy of a notebook, and return the recording of each experiment by the source of its cell."""
    with tempfile.TemporaryDirectory() as folder:
        recording = copy.deepcopy(notebook)
        watching = f"from mocap.course import recording\nrecording.watch({folder!r})"
        recording.cells[0] = library().v4.new_code_cell(watching)  # in place of the heading
        execute(recording, file, 600)
        recordings = [json.loads(path.read_text("utf-8")) for path in sorted(Path(folder).iterdir())]
    for experiment in recordings:
        if "error" in experiment:
            raise MocapError(f"{file}: an experiment cannot be recorded: {experiment['error']:.99}")
    return {experiment["source"]: experiment for experiment in recordings}


def recordings_file(file: Path) -> Path:
    """Return the file in which the recordings of a notebook are kept, from a release on.

    Examples
    --------
    >>> recordings_file(Path("notebooks", "06-pruning.ipynb")).as_posix()
    'notebooks/recordings/06-pruning.json'
    """
    return file.parent / "recordings" / f"{file.stem}.json"


def stored_recordings(file: Path) -> dict[str, Any]:
    """Return the recordings that are kept of a notebook, by the sources of their cells."""
    kept = recordings_file(file)
    recordings = json.loads(kept.read_text("utf-8")) if kept.exists() else []
    return {experiment["source"]: experiment for experiment in recordings}


def fill_in(notebook: Any, recorded: dict[str, Any], stem: str = "") -> None:  # noqa: ANN401
    """Put recordings in the place of experiments, a sentence above the rest, and one for exercises.

    Small experiments of the notebook with a name `stem` run on the page.
    """
    scripts: set[str] = set()  # those that the page has already
    for cell in notebook.cells:
        tags = cell.metadata.get("tags", ())
        address = next((tag.replace(":", "-") for tag in tags if ":" in tag), "")
        for output in cell.get("outputs", ()):
            if "text" in output:
                output["text"] = UNSOLVED.sub(YOUR_TURN, output["text"])
            data = output.get("data", {})
            if "text/html" in data:
                page = _without_scripts(data["text/html"], scripts)
                data["text/html"] = _filled_in(page, address, recorded.get(cell.source), stem)


def _without_scripts(page: str, scripts: set[str]) -> str:
    """Take out the scripts that the page of the site has already, and add the others to them.

    One is enough: it starts all that there is on the page.
    """
    for script in SCRIPT.findall(page):
        if script in scripts:
            page = page.replace(script, "")
        scripts.add(script)
    return page


def _filled_in(page: str, address: str, recording: dict[str, Any] | None, stem: str) -> str:
    """Replace what stays still by its recording; without one, put a sentence above it. Add an address."""
    opening = f'<div class="{STILL}">'
    if opening not in page:
        return page
    name = f"{stem}:{address.removeprefix('experiment-')}"
    if name in LIVE:
        return _live(name, AGAIN.sub("", page), address)
    if recording:
        return f'<div id="{address}">{_moving(recording)}</div>'
    note = NOTE.format(STILL_NOTES["mocap-player" in page])
    return AGAIN.sub("", page).replace(opening, f'<div class="{STILL}" id="{address}">{note}', 1)


def _live(name: str, page: str, address: str) -> str:
    """Write the controls and the data of an experiment for `live.js`, which replaces its still picture."""
    experiment = LIVE[name]
    alt = ALT.search(page)
    content: dict[str, Any] = {"controls": experiment.controls, "data": experiment.data()}
    content["alt"] = html.unescape(alt[1]) if alt else ""
    data = f'<script type="application/json">{script_json(content)}</script>'
    return f'<div class="live" data-live="{name}" id="{address}">{page}{data}</div>'


def _moving(recorded: dict[str, Any]) -> str:
    """Write a recording as a slider and a picture; `moving.js` moves them."""
    labels = recorded["labels"]
    position = recorded["at"]
    label = html.escape(labels[position])
    name = html.escape(recorded["name"])
    pictures = [f"data:image/webp;base64,{picture}" for picture in recorded["pictures"]]
    data = script_json({"labels": labels, "pictures": pictures})
    slider = (
        f'<input type="range" min="0" max="{len(labels) - 1}" value="{position}" aria-valuetext="{label}">'
    )
    alt = html.escape(recorded["alt"])
    width = recorded["width"]
    return (
        f'<div class="moving"><label>{name} {slider}<output>{label}</output></label>'
        f'<img alt="{alt}" width="{width}" src="{pictures[position]}">'
        f'<script type="application/json">{data}</script></div>'
    )


def _write_reference(folder: Path) -> list[str]:
    """Write a page for the face of each room, and list them."""
    make_folder(folder / "reference")
    packages = pkgutil.walk_packages(mocap.__path__, "mocap.")
    rooms = [package.name for package in packages if package.ispkg and not HIDDEN.search(package.name)]
    for room in rooms:
        write_file(folder / "reference" / f"{room}.rst", REFERENCE.format(room, "=" * len(room)))
    return [f"reference/{room}" for room in rooms]
