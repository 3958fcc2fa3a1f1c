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
from itertools import product
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
EQUATIONS = re.compile(r"Eqs?\. (?P<first>\d+)(?:(?P<between>-| and |, )(?P<last>\d+))?")


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
    citations = set()
    for key, places in CITATION.findall(" ".join(text.split())):
        for place in places.partition(", after")[0].split("; "):
            citations |= {(key, single) for single in _one_by_one(place)}
    return frozenset(citations)


def _one_by_one(place: str) -> set[str]:
    """Return the equations of "Eqs. 2-4" or "Eqs. 5 and 6" one by one; other places as they are."""
    equations = EQUATIONS.fullmatch(place)
    if not equations:
        return {place}
    first = int(equations["first"])
    last = int(equations["last"] or first)
    numbers = range(first, last + 1) if equations["between"] == "-" else (first, last)
    return {f"Eq. {number}" for number in numbers}


def functions(package: Path) -> list[Function]:
    """List the public functions and classes whose docstrings cite a paper, by the order of their files."""
    faces = {stub.parent: _exported(stub) for stub in package.rglob("__init__.pyi")}
    listed = []
    for path in sorted(package.glob("*/**/*.py")):
        room, *_ = parts = path.relative_to(package).with_suffix("").parts
        if room in OTHERS or path.stem == "__init__":
            continue
        for name, docstring in _documented(path):
            is_exported = name.partition(".")[0] in faces[path.parent]
            public = f"{'.'.join(parts[:-1] if is_exported else parts)}.{name}"
            first = cited("".join(OWN.findall(docstring)))
            notebook = _taught_in(docstring)
            listed.append(Function(".".join(parts), name, public, notebook, cited(docstring), first))
    return listed


def _documented(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the name and the docstring of each public function and class of a file that cites a paper."""
    for node, name in _defined(ast.parse(path.read_text("utf-8")).body):
        docstring = ast.get_docstring(node) or ""
        if cited(docstring) and not node.name.startswith("_"):
            yield name, docstring


def _exported(stub: Path) -> set[str]:
    """List the names that the face of a room exports."""
    imports = (node for node in ast.parse(stub.read_text("utf-8")).body if isinstance(node, ast.ImportFrom))
    return {alias.asname or alias.name for node in imports for alias in node.names}


def _taught_in(docstring: str) -> str:
    """Find the notebook that a docstring names, or ""."""
    notebook = re.search(r"^Notebook: (\S+)$", docstring, re.MULTILINE)
    return notebook[1] if notebook else ""


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
    all_functions = functions(root / "mocap")
    tests = list(_tests(root / "tests"))
    cells = _cells(root / "notebooks")
    rows = []
    for key, paper in papers().items():
        for row in paper["rows"]:
            notebook = row.get("notebook", paper["notebook"])
            places = {(key, place) for place in _one_by_one(row["place"])}
            # The functions that cite a place as their own, else all that cite it.
            first = [function for function in all_functions if function.first & places]
            citing = [function for function in all_functions if function.cites & places]
            chosen = (first or citing)[:SHOWN]
            sentences = [sentence for sentence, citations in tests if citations & places]
            links = [_cell_of(function, notebook, cells) for function in chosen]
            if not any(links) and "through" in row:
                links = [_calling(row["through"], [notebook], cells)]
            lists = ([function.public for function in chosen], sentences, links)
            columns = (tuple(dict.fromkeys(filter(None, column))) for column in lists)
            rows.append(Row(key, row["place"], row["says"], row["departs"], *columns))
    return rows


def _tests(folder: Path) -> Iterator[tuple[str, frozenset[tuple[str, str]]]]:
    """Yield each test as a sentence, with what its docstring cites."""
    for path in sorted(folder.rglob("test_*.py")):
        for node in ast.parse(path.read_text("utf-8")).body:
            if not isinstance(node, ast.FunctionDef):
                continue
            citations = cited(ast.get_docstring(node) or "")
            if citations:
                sentence = node.name.removeprefix("test_").replace("_", " ")
                yield f"{sentence} (`{path.relative_to(folder).as_posix()}`)", citations


class _Cell(NamedTuple):
    """A cell of code: its notebook with the heading above it, its code, and what of the package it shows."""

    notebook: str
    link: str
    code: str
    shows: str


def _cells(folder: Path) -> list[_Cell]:
    cells = []
    for path in sorted(folder.glob("*.ipynb")):
        notebook = read(path)
        heading = path.stem
        shown = {cell.id: name for name, cell in tagged(notebook, "source")}
        for cell in notebook.cells:
            if cell.cell_type == "markdown":
                heading = (re.findall(r"^#{1,3} (.+)$", cell.source, re.MULTILINE) or [heading])[-1]
            else:
                code = re.sub(r"^(?:from|import) .*$|#.*$", "", cell.source, flags=re.MULTILINE)
                link = f"[{path.stem.partition('-')[0]}]({path.name}) {heading}"
                shows = shown.get(cell.id, "")
                cells.append(_Cell(path.stem, link, "" if shows else code, shows))
    return cells


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
    uses = [rf"\b{name}\("]
    if len(name) > SHORT:
        uses.append(rf"\b{name}\b")
    for notebook, use in product(notebooks, uses):
        for cell in cells:
            if cell.notebook == notebook and re.search(use, cell.code):
                return cell.link
    return ""


def page(rows: Sequence[Row]) -> str:
    """Write the rows as a page of tables, one for each paper after one of all papers, in Markdown."""
    head = "| paper | how we know it | rows | as the paper says | missing | held by a test |"
    tables = [head + "\n" + "|---" * 6 + "|"]
    for key, paper in papers().items():
        rows_of_paper = [row for row in rows if row.key == key]
        exact = sum(row.departs.startswith("nothing") for row in rows_of_paper)
        missing = sum(row.departs.startswith("missing") for row in rows_of_paper)
        tested = sum(bool(row.tests) for row in rows_of_paper)
        counts = f"{len(rows_of_paper)} | {exact} | {missing} | {tested}"
        tables[0] += f"\n| [{paper['title']}](#{_slug(key, paper)}) | {paper['read']} | {counts} |"
        lines = ["| in the paper | here | test | what departs, and why |", "|---|---|---|---|"]
        for row in rows_of_paper:
            code = "<br>".join([*(f"`{name}`" for name in row.functions), *row.cells])
            tests = "<br>".join(row.tests or ["untested"])
            if row.departs.startswith("missing"):
                code = ""
                tests = ""
            lines.append(f"| **{row.place}** {row.says} | {code} | {tests} | {row.departs} |")
        tables.append(f"## {key} {paper['title']}\n\n{paper['cite']}.\n\n" + "\n".join(lines))
    return "\n\n".join([PAPERS.with_suffix(".md").read_text("utf-8").rstrip(), *tables]) + "\n"


def _slug(key: str, paper: Mapping[str, Any]) -> str:
    return f"{key} {paper['title']}".lower().replace(" ", "-")


if __name__ == "__main__":
    checkout = Path(__file__).parents[1]
    write_file(checkout / "notebooks" / "PAPERS.md", page(ledger(checkout)))
