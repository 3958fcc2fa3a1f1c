"""Which line of which paper is where: a page with a row for each equation or step of each paper's method.

`papers.toml` says what must have a row, and what departs from the paper there; a row that is `missing` has no
code. The rest is found: functions and tests by the citations in their docstrings, such as [KGP02, Eq. 5], and
cells of notebooks by their `source:` tags, else by what they call. A row is held only by a test that cites
it; else it is untested. Run it as `python figures/ledger.py` after a change of any of these.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.atomic import write_file
from mocap.course.notebooks import read, tagged

PAPERS = Path(__file__).with_name("papers.toml")
SHOWN = 4  # functions of a row at most
SHORT = 5  # letters: such a name without a call may be another word
OTHERS = ("plotting", "diagrams", "widgets", "lab", "course", "cli")  # rooms that use what others compute
CITATION = re.compile(r"\[([A-Z][A-Za-z]+\d\d), ([^\]]+)\]")
OWN = re.compile(r"\A(?:.+\n?)+|^In the paper: .+$", re.MULTILINE)  # what a docstring says first
EQUATIONS = re.compile(r"Eqs?\. (\d+)(?:(-| and |, )(\d+))?")


class Function(NamedTuple):
    """A function or class of the package with what its docstring cites, and what it cites as its own.

    `module` is ROOM.FILE, or ROOM.FOLDER.FILE; `name` may be CLASS.METHOD; `public` is ROOM.NAME if the
    face exports it, else it has the file; `notebook` is the one that its docstring names, or "".
    """

    module: str
    name: str
    public: str
    notebook: str
    cites: frozenset[tuple[str, str]]
    first: frozenset[tuple[str, str]]


class Row(NamedTuple):
    """An equation or a step of a paper, where it is here, and what departs from the paper."""

    key: str
    place: str
    says: str
    departs: str
    functions: tuple[str, ...]
    tests: tuple[str, ...]
    cells: tuple[str, ...]


def papers() -> dict[str, dict[str, Any]]:
    """Read the papers and what of them must have a row: {key: paper}, each with a list of `rows`.

    Examples
    --------
    >>> [row["place"] for row in papers()["KGP02"]["rows"]][:3]
    ['3.1', 'Eq. 1', 'Eqs. 2-4']
    """
    return tomllib.loads(PAPERS.read_text("utf-8"))


def cited(text: str) -> frozenset[tuple[str, str]]:
    """List the places that a text cites, equations one by one.

    Examples
    --------
    >>> sorted(cited("As in [KGP02, Eqs. 5 and 6] and [KGP02, 3.1]."))
    [('KGP02', '3.1'), ('KGP02', 'Eq. 5'), ('KGP02', 'Eq. 6')]
    """
    found = set()
    for key, places in CITATION.findall(" ".join(text.split())):
        for place in places.partition(", after")[0].split("; "):
            found |= {(key, one) for one in _one_by_one(place)}
    return frozenset(found)


def _one_by_one(place: str) -> set[str]:
    """Give the equations of "Eqs. 2-4" or "Eqs. 5 and 6" one by one; other places as they are."""
    if not (equations := EQUATIONS.fullmatch(place)):
        return {place}
    first, last = int(equations[1]), int(equations[3] or equations[1])
    return {f"Eq. {number}" for number in (range(first, last + 1) if equations[2] == "-" else (first, last))}


def functions(package: Path) -> list[Function]:
    """List the public functions and classes whose docstrings cite a paper, by the order of their files."""
    faces = {face.parent: face.read_text("utf-8") for face in package.rglob("__init__.py")}
    found = []
    for path in sorted(package.glob("*/**/*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        if parts[0] in OTHERS or parts[-1] == "__init__":
            continue
        for node, name in _defined(ast.parse(path.read_text("utf-8")).body):
            text = ast.get_docstring(node) or ""
            if not node.name.startswith("_") and (cites := cited(text)):
                taught = (re.findall(r"^Notebook: (\S+)$", text, re.MULTILINE) or [""])[0]
                first, module = cited("".join(OWN.findall(text))), ".".join(parts)
                exported = f'"{name.partition(".")[0]}"' in faces[path.parent]
                public = f"{'.'.join(parts[:-1]) if exported else module}.{name}"
                found.append(Function(module, name, public, taught, cites, first))
    return found


def _defined(body: Iterable[ast.stmt], above: str = "") -> Iterator[tuple[Any, str]]:
    """Yield functions, classes and methods with their names."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node, above + node.name
            if isinstance(node, ast.ClassDef):
                yield from _defined(node.body, f"{node.name}.")


def ledger(root: Path) -> list[Row]:
    """Find functions, tests and cells for all that the papers' methods consist of.

    Parameters
    ----------
    root : a checkout: the folder with the folders mocap, tests and notebooks.
    """
    known, tests = functions(root / "mocap"), list(_tests(root / "tests"))
    cells = _cells(root / "notebooks")
    rows = []
    for key, paper in papers().items():
        for row in paper["rows"]:
            notebook = row.get("notebook", paper["notebook"])
            places = {(key, place) for place in _one_by_one(row["place"])}
            first = [one for one in known if one.first & places]  # their own, else all that cite it
            chosen = (first or [one for one in known if one.cites & places])[:SHOWN]
            held = [said for said, cites in tests if cites & places]
            shown = [cell for one in chosen if (cell := _cell_of(one, notebook, cells))]
            if not shown and "through" in row:
                shown = [_calling(row["through"], [notebook], cells)]
            lists = ([one.public for one in chosen], held, shown)
            found = (tuple(dict.fromkeys(filter(None, some))) for some in lists)
            rows.append(Row(key, row["place"], row["says"], row["departs"], *found))
    return rows


def _tests(folder: Path) -> Iterator[tuple[str, frozenset[tuple[str, str]]]]:
    """Yield each test as a sentence, with what its docstring cites."""
    for path in sorted(folder.rglob("test_*.py")):
        for node in ast.parse(path.read_text("utf-8")).body:
            if isinstance(node, ast.FunctionDef) and (cites := cited(ast.get_docstring(node) or "")):
                said = node.name.removeprefix("test_").replace("_", " ")
                yield f"{said} (`{path.relative_to(folder).as_posix()}`)", cites


class _Cell(NamedTuple):
    """A cell of code: its notebook with the heading above it, its code, and what of the package it shows."""

    notebook: str
    link: str
    code: str
    shows: str


def _cells(folder: Path) -> list[_Cell]:
    found = []
    for path in sorted(folder.glob("*.ipynb")):
        notebook, heading = read(path), path.stem
        shown = {cell.id: name for name, cell in tagged(notebook, "source")}
        for cell in notebook.cells:
            if cell.cell_type == "markdown":
                heading = (re.findall(r"^#{1,3} (.+)$", cell.source, re.MULTILINE) or [heading])[-1]
            else:
                code = re.sub(r"^(?:from|import) .*$|#.*$", "", cell.source, flags=re.MULTILINE)
                link = f"[{path.stem.partition('-')[0]}]({path.name}) {heading}"
                shows = shown.get(cell.id, "")
                found.append(_Cell(path.stem, link, "" if shows else code, shows))
    return found


def _cell_of(function: Function, notebook: str, cells: Sequence[_Cell]) -> str:
    """Link the cell that shows a function or its plain twin, else the first of its notebook that calls it.

    Its notebook is the one that its docstring names, or that of the paper.
    """
    whole = f"{function.module}.{function.name}."
    for cell in cells:
        if f"{cell.shows}.".startswith(whole) or cell.shows == f"plain.{function.name}":
            return cell.link
    return _calling(function.name.rpartition(".")[2], [function.notebook, notebook], cells)


def _calling(name: str, notebooks: Sequence[str], cells: Sequence[_Cell]) -> str:
    """Link the first cell that calls a function, or else names it, in the first notebook that does."""
    for own in notebooks:
        for use in (rf"\b{name}\(", rf"\b{name}\b")[: 2 if len(name) > SHORT else 1]:
            for cell in cells:
                if cell.notebook == own and re.search(use, cell.code):
                    return cell.link
    return ""


def page(rows: Sequence[Row]) -> str:
    """Write the rows as a page of tables, one for each paper after one of all papers, in Markdown."""
    head = "| paper | how we know it | rows | as the paper says | missing | held by a test |"
    tables = [head + "\n" + "|---" * 6 + "|"]
    for key, paper in papers().items():
        own = [row for row in rows if row.key == key]
        same, missing = (sum(row.departs.startswith(word) for row in own) for word in ("nothing", "missing"))
        counts = f"{len(own)} | {same} | {missing} | {sum(bool(row.tests) for row in own)}"
        tables[0] += f"\n| [{paper['title']}](#{_slug(key, paper)}) | {paper['read']} | {counts} |"
        lines = ["| in the paper | here | test | what departs, and why |", "|---|---|---|---|"]
        for row in own:
            code = [f"`{name}`" for name in row.functions]
            lists = ["<br>".join(some) for some in ([*code, *row.cells], row.tests or ["untested"])]
            lists = ["", ""] if row.departs.startswith("missing") else lists
            lines.append("| " + " | ".join([f"**{row.place}** {row.says}", *lists, row.departs]) + " |")
        tables.append(f"## {key} {paper['title']}\n\n{paper['cite']}.\n\n" + "\n".join(lines))
    return "\n\n".join([PAPERS.with_suffix(".md").read_text("utf-8").rstrip(), *tables]) + "\n"


def _slug(key: str, paper: Mapping[str, Any]) -> str:
    return f"{key} {paper['title']}".lower().replace(" ", "-")


if __name__ == "__main__":
    checkout = Path(__file__).parents[1]
    write_file(checkout / "notebooks" / "PAPERS.md", page(ledger(checkout)))
