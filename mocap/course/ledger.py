"""Which line of which paper is where: a page with a row for each equation or step of each paper's method.

`papers.toml` says what must have a row, and what departs from the paper there. The rest is found: functions
by the citations in their docstrings, such as [KGP02, Eq. 5], tests by the same citations, else by the
functions that they use, and cells of notebooks by their `source:` tags, else by what they call.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.atomic import write_text
from mocap.course.notebooks import read, tagged
from mocap.errors import MocapError

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

    Raises
    ------
    MocapError : where there are no tests, as in an installed package.
    """
    if not (root / "tests").is_dir():
        raise MocapError(f"The ledger of papers reads the package's tests: there are none in {root}.")
    known, tests, cells = functions(root / "mocap"), _Tests(root / "tests"), _Cells(root / "notebooks")
    rows = []
    for key, paper in papers().items():
        for row in paper["rows"]:
            notebook = row.get("notebook", paper["notebook"])
            places = {(key, place) for place in _one_by_one(row["place"])}
            chosen = _chosen(known, places)
            held = tests.citing(places) or [tests.of(one) for one in chosen]
            shown = [cell for one in chosen if (cell := cells.of(one, notebook))]
            if not shown and "through" in row:
                shown = [cells.calling(row["through"], notebook)]
            lists = ([one.public for one in chosen], held, shown)
            found = (tuple(dict.fromkeys(filter(None, some))) for some in lists)
            rows.append(Row(key, row["place"], row["says"], row["departs"], *found))
    return rows


def _chosen(known: Sequence[Function], places: set[tuple[str, str]]) -> list[Function]:
    """Choose those that cite a place as their own, in the first paragraph or by "In the paper:", else all."""
    first = [one for one in known if one.first & places]
    return (first or [one for one in known if one.cites & places])[:SHOWN]


class _Tests:
    """The tests, each with what it cites, and all names that it and the helpers of its file use."""

    def __init__(self, folder: Path) -> None:
        self.uses: dict[tuple[Path, str], set[str]] = {}
        self.cites: dict[tuple[Path, str], frozenset[tuple[str, str]]] = {}
        for path in sorted(folder.rglob("test_*.py")):
            body = ast.parse(path.read_text("utf-8")).body
            nodes = {node.name: node for node in body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
            names, file = {name: _names(node) for name, node in nodes.items()}, path.relative_to(folder)
            for name in (name for name in nodes if name.startswith("test_")):
                self.uses[file, name] = _with_helpers(name, names)
                self.cites[file, name] = cited(ast.get_docstring(nodes[name]) or "")

    def citing(self, places: set[tuple[str, str]]) -> list[str]:
        """Name the tests that cite a place."""
        return [_sentence(*test) for test, cites in self.cites.items() if cites & places]

    def of(self, function: Function) -> str:
        """Name a test that uses a function: in the tests of its file, else of its room."""
        room, _, file = function.module.partition(".")
        own, name = f"test_{file.rpartition('.')[2]}", function.name.rpartition(".")[2]
        using = [test for test, names in self.uses.items() if test[0].parts[0] == room and name in names]
        return _sentence(*min(using, key=lambda test: test[0].stem != own)) if using else ""


def _sentence(path: Path, test: str) -> str:
    return f"{test.removeprefix('test_').replace('_', ' ')} (`{path.as_posix()}`)"


def _names(node: ast.AST) -> set[str]:
    """List all names that some code uses, the fixtures that it asks for among them."""
    named = {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
    named |= {one.attr for one in ast.walk(node) if isinstance(one, ast.Attribute)}
    return named | {one.arg for one in ast.walk(node) if isinstance(one, ast.arg)}


def _with_helpers(name: str, uses: Mapping[str, set[str]]) -> set[str]:
    """Add to a test's names those of the helpers that it uses, and theirs."""
    found, left = {name}, [name]
    while left:
        new = uses.get(left.pop(), set()) - found
        found |= new
        left += new
    return found


class _Cells:
    """The code cells of the notebooks, each with its notebook, the heading above it, and what it shows."""

    def __init__(self, folder: Path) -> None:
        self.cells: list[tuple[str, str, str]] = []
        self.shown: dict[str, str] = {}
        for path in sorted(folder.glob("*.ipynb")):
            notebook, heading = read(path), path.stem
            shown = {cell.id: name for name, cell in tagged(notebook, "source")}
            for cell in notebook.cells:
                if cell.cell_type == "markdown":
                    heading = (re.findall(r"^#{1,3} (.+)$", cell.source, re.MULTILINE) or [heading])[-1]
                elif cell.id in shown:
                    self.shown.setdefault(shown[cell.id], _linked(path.stem, heading))
                else:
                    code = re.sub(r"^(?:from|import) .*$|#.*$", "", cell.source, flags=re.MULTILINE)
                    self.cells.append((path.stem, heading, code))

    def of(self, function: Function, notebook: str) -> str:
        """Link the cell that shows a function's source, else the first of its notebook that calls it.

        Its notebook is the one that its docstring names, or that of the paper.
        """
        whole = f"{function.module}.{function.name}"
        if shown := [link for name, link in self.shown.items() if f"{name}.".startswith(f"{whole}.")]:
            return shown[0]
        return self.calling(function.name.rpartition(".")[2], function.notebook, notebook)

    def calling(self, name: str, *notebooks: str) -> str:
        """Link the first cell that calls a function, or else names it, in the first notebook that does."""
        for own in filter(None, notebooks):
            for use in (rf"\b{name}\(", rf"\b{name}\b")[: 2 if len(name) > SHORT else 1]:
                for notebook, heading, code in self.cells:
                    if notebook == own and re.search(use, code):
                        return _linked(notebook, heading)
        return ""


def _linked(name: str, heading: str) -> str:
    return f"[{name.partition('-')[0]}]({name}.ipynb) {heading}"


def page(rows: Sequence[Row]) -> str:
    """Write the rows as a page of tables, one for each paper after one of all papers, in Markdown."""
    tables = ["| paper | how we know it | rows | as the paper says |\n|---|---|---|---|"]
    for key, paper in papers().items():
        own = [row for row in rows if row.key == key]
        same = sum(row.departs.startswith("nothing") for row in own)
        tables[0] += f"\n| [{paper['title']}](#{_slug(key, paper)}) | {paper['read']} | {len(own)} | {same} |"
        lines = ["| in the paper | here | test | what departs, and why |", "|---|---|---|---|"]
        for row in own:
            code = [f"`{name}`" for name in row.functions]
            lists = ["<br>".join(some) for some in ([*code, *row.cells], row.tests)]
            lines.append("| " + " | ".join([f"**{row.place}** {row.says}", *lists, row.departs]) + " |")
        tables.append(f"## {key} {paper['title']}\n\n{paper['cite']}.\n\n" + "\n".join(lines))
    return "\n\n".join([PAPERS.with_suffix(".md").read_text("utf-8").rstrip(), *tables]) + "\n"


def _slug(key: str, paper: Mapping[str, Any]) -> str:
    return f"{key} {paper['title']}".lower().replace(" ", "-")


def write_ledger(root: Path) -> Path:
    """Write `notebooks/PAPERS.md` of a checkout anew, and give its path."""
    path = root / "notebooks" / "PAPERS.md"
    write_text(path, page(ledger(root)))
    return path
