"""The course as HTML pages without kernel and network, beside the reference pages of the package."""

from __future__ import annotations

import base64
import copy
import hashlib
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

import mocap
from mocap._shared.atomic import make_folder, write_file
from mocap._shared.progress import Progress
from mocap.course.notebooks import execute, library, notebooks_in, read
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
HEAVY = re.compile(r'(?s)<script type="module">(.*?)</script>|src="data:image/png;base64,([^"]+)"')
AGAIN = re.compile(r"<p><small>Run this cell[^<]*</small></p>")
ABOVE = NOTE.format(
    "Players, recorded sliders, quizzes, bets and the blind test answer you on these pages; code and other "
    'controls are still. To run it live: <code>pip install "motion-graphs[notebooks]"</code>, in a checkout '
    '<code>pip install ".[notebooks]"</code>, then <code>mocap lab</code>.'
)
ABOVE += '<script>document.body.classList.add("mocap-page")</script>'  # players are dark where the page is
REFERENCE = "{0}\n{1}\n\n.. automodule:: {0}\n   :members:\n   :imported-members:\n"


def build_site(notebooks: Path, out: Path, progress: Progress = iter, *, moving: bool = False) -> Path:
    """Write the notebooks and pages of a folder as HTML, beside the reference pages of the package.

    Parameters
    ----------
    notebooks : the course's folder.
    out : the folder for the pages; `index.html` lists them.
    progress : wraps the notebooks while they are prepared.
    moving : run the notebooks, and record positions of each experiment's first control; else a still picture
        stands there.

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
        for file in progress(files):
            title, notebook = prepared(file, moving=moving)
            titles.append(f"{title} <{file.stem}>")
            _detach(notebook, Path(folder), file.stem)
            _share(notebook, out)
            notebook.cells.insert(1, nbformat.v4.new_markdown_cell(ABOVE, id="note"))
            write_file(Path(folder, file.name), nbformat.writes(notebook))
        for page in notebooks.glob("*.md"):
            shutil.copy(page, folder)
        shutil.copytree(notebooks / "teaching", Path(folder, "teaching"), ignore=PRIVATE)
        titles += [page.relative_to(folder).as_posix() for page in sorted(Path(folder).rglob("*.md"))]
        toc = {"course": "\n".join(titles), "package": "\n".join(_write_reference(Path(folder)))}
        write_file(Path(folder, "index.md"), Template((HERE / "index.md").read_text("utf-8")).substitute(toc))
        warned = io.StringIO()  # of papers cited twice
        Sphinx(folder, HERE, out, Path(folder, ".doctrees"), "html", status=None, warning=warned).build()
    graph = bundled_graph()
    write_file(out / "walk.html", walk_page(graph, picture="walk.png", course="00-quickstart.html"))
    write_file(out / "walk.png", link_picture(graph))
    return out / "index.html"


def prepared(file: Path, *, moving: bool) -> tuple[str, Any]:
    """Read a notebook for readers without Python; return its number with its heading, and the notebook."""
    notebook = read(file)
    fill_in(notebook, recorded_of(file, notebook) if moving else {})
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


def fill_in(notebook: Any, recorded: dict[str, Any]) -> None:  # noqa: ANN401
    """Put recordings in the place of experiments, and a sentence above what stays still."""
    scripts: set[str] = set()  # those that the page has already
    for cell in notebook.cells:
        tags = cell.metadata.get("tags", ())
        address = next((tag.replace(":", "-") for tag in tags if ":" in tag), "")
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "text/html" in data:
                page = _without_scripts(data["text/html"], scripts)
                data["text/html"] = _filled_in(page, address, recorded.get(cell.source))


def _without_scripts(page: str, scripts: set[str]) -> str:
    """Take out the scripts that the page of the site has already, and add the others to them.

    One is enough: it starts all that there is on the page.
    """
    for script in SCRIPT.findall(page):
        if script in scripts:
            page = page.replace(script, "")
        scripts.add(script)
    return page


def _filled_in(page: str, address: str, recording: dict[str, Any] | None) -> str:
    """Replace what stays still by its recording; without one, put a sentence above it. Add an address."""
    opening = f'<div class="{STILL}">'
    if opening not in page:
        return page
    if recording:
        return f'<div id="{address}">{_moving(recording)}</div>'
    note = NOTE.format(STILL_NOTES["mocap-player" in page])
    return AGAIN.sub("", page).replace(opening, f'<div class="{STILL}" id="{address}">{note}', 1)


def _moving(recorded: dict[str, Any]) -> str:
    """Write a recording as a slider and a picture; `moving.js` moves them."""
    labels = recorded["labels"]
    position = recorded["at"]
    label = html.escape(labels[position])
    name = html.escape(recorded["name"])
    data = script_json({key: recorded[key] for key in ("labels", "pictures")})
    slider = (
        f'<input type="range" min="0" max="{len(labels) - 1}" value="{position}" aria-valuetext="{label}">'
    )
    source = f"data:image/png;base64,{recorded['pictures'][position]}"
    return (
        f'<div class="moving"><label>{name} {slider}<output>{label}</output></label>'
        f'<img alt="{html.escape(recorded["alt"])}" src="{source}">'
        f'<script type="application/json">{data}</script></div>'
    )


def _detach(notebook: Any, folder: Path, stem: str) -> None:  # noqa: ANN401
    """Write attached pictures as files, which Sphinx finds."""
    for cell in notebook.cells:
        for name, data in cell.pop("attachments", {}).items():
            (folder / f"{stem}-{name}").write_bytes(base64.b64decode(data["image/png"]))
            cell.source = cell.source.replace(f"attachment:{name}", f"{stem}-{name}")


def _share(notebook: Any, out: Path) -> None:  # noqa: ANN401
    """Move scripts and pictures of outputs to files that all pages share, each once."""

    def write(content: bytes, suffix: str) -> str:
        name = f"_shared/{hashlib.sha256(content).hexdigest()[:12]}.{suffix}"
        (out / name).write_bytes(content)
        return name

    def shared(match: re.Match[str]) -> str:
        script, picture = match.groups()
        if not script:
            return f'loading="lazy" src="{write(base64.b64decode(picture), "png")}"'
        # No module: a browser does not load one where the page is a file.
        text = f"(() => {{{script.replace('export default', 'void')}}})();"
        return f'<script defer src="{write(text.encode(), "js")}"></script>'

    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "text/html" in data:
                data["text/html"] = HEAVY.sub(shared, data["text/html"])


def _write_reference(folder: Path) -> list[str]:
    """Write a page for the face of each room, and list them."""
    make_folder(folder / "reference")
    packages = pkgutil.walk_packages(mocap.__path__, "mocap.")
    rooms = [package.name for package in packages if package.ispkg and not HIDDEN.search(package.name)]
    for room in rooms:
        write_file(folder / "reference" / f"{room}.rst", REFERENCE.format(room, "=" * len(room)))
    return [f"reference/{room}" for room in rooms]
