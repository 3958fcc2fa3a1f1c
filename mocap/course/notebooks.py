"""The course's notebooks as data: read a notebook, find its cells and their names, run it again.

The tags of a cell say what it is. `source:ROOM.FILE.FUNCTION` shows the package's own code. `ask:NAME` is the
text of an exercise, `exercise:NAME` the stub of its function, `check:NAME` its check and `solution:NAME` its
folded solution. `experiment:NAME` is something to try, and `prediction` the question before it. `real` is a
cell that needs captured clips.
"""

from __future__ import annotations

import ast
import base64
import inspect
import json
import os
import re
import symtable
import textwrap
import warnings
from collections.abc import Iterator
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from mocap._shared.atomic import write_file
from mocap.course import marked_values
from mocap.errors import MocapError, missing

KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
MOVING = re.compile(r'<div class="mocap-(?:player|inspector)">(<img[^>]*>).*</script>\n?', re.DOTALL)
WIDGET = "application/vnd.jupyter.widget-view+json"  # the name of a model that ends with its kernel


def library() -> Any:  # noqa: ANN401
    """Import nbformat, or say what to install."""
    try:
        import nbclient  # noqa: F401 - it runs what nbformat reads
        import nbformat
    except ImportError as error:
        raise missing("Notebooks need nbformat and nbclient", "notebooks") from error
    return nbformat


def read(path: Path) -> Any:  # noqa: ANN401
    """Read a notebook as an object of nbformat.

    Raises
    ------
    MocapError : if nbformat is not installed, or the file is missing or is not a notebook.

    Examples
    --------
    >>> read(Path("nowhere.ipynb"))
    Traceback (most recent call last):
    mocap.errors.MocapError: nowhere.ipynb: No such file or directory.
    """
    nbformat = library()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)  # of cells without ids, as some editors write them
            return nbformat.read(path, as_version=4)
    except OSError as error:
        raise MocapError(f"{path}: {error.strerror}.") from error
    except Exception as error:  # nbformat raises errors of many kinds
        raise MocapError(f"{path}: is not a notebook.") from error


def notebooks_in(folder: Path) -> list[Path]:
    """List the notebooks of a folder.

    Raises
    ------
    MocapError : if there are none.

    Examples
    --------
    >>> notebooks_in(Path("nowhere"))
    Traceback (most recent call last):
    mocap.errors.MocapError: The folder nowhere holds no notebooks.
    """
    if files := sorted(folder.glob("*.ipynb")):
        return files
    raise MocapError(f"The folder {folder} holds no notebooks.")


def tagged(notebook: Any, kind: str) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """Yield the NAME and the cell for each tag such as `exercise:NAME`.

    Parameters
    ----------
    notebook : from `read`.
    kind : the word before the colon, such as `exercise`.

    Examples
    --------
    >>> from nbformat.v4 import new_code_cell, new_notebook
    >>> cell = new_code_cell("def speed(): ...", metadata={"tags": ["exercise:speed"]})
    >>> [(name, cell.source) for name, cell in tagged(new_notebook(cells=[cell]), "exercise")]
    [('speed', 'def speed(): ...')]
    """
    for cell in notebook.cells:
        for tag in cell.metadata.get("tags", ()):
            if tag == kind or tag.startswith(f"{kind}:"):
                yield tag.removeprefix(kind).removeprefix(":"), cell


def shown_source(name: str) -> str:
    """Return the code of a function or method as a notebook shows it, without docstring and annotations.

    Parameters
    ----------
    name : ROOM.FILE.FUNCTION, or ROOM.FILE.CLASS.METHOD; a file in a folder is FOLDER.FILE.

    Examples
    --------
    >>> print(shown_source("body.rotations.about_y"))
    def about_y(angles):
        ...
    """
    text = textwrap.dedent(inspect.getsource(resolve_name(f"mocap.{name}")))
    node = ast.parse(text).body[0]
    assert isinstance(node, ast.FunctionDef)
    body = node.body[1:] if ast.get_docstring(node) is not None else node.body
    lines = text.splitlines()
    for part in ast.walk(node):
        if isinstance(part, ast.arg):
            part.annotation = None
        elif isinstance(part, ast.AnnAssign) and part.value:
            line = lines[part.lineno - 1]
            lines[part.lineno - 1] = f"{line[: part.target.end_col_offset]} = {line[part.value.col_offset :]}"
    for part in ast.walk(node):
        if isinstance(part, ast.FunctionDef):  # whose arguments have lost their annotations
            lines[part.lineno - 1] = f"{' ' * part.col_offset}def {part.name}({ast.unparse(part.args)}):"
    return "\n".join([lines[node.lineno - 1], *lines[body[0].lineno - 1 :]])


def solution(cell: Any) -> str:  # noqa: ANN401
    """Return the code in a folded solution."""
    (code,) = re.findall(r"```python\n(.*?)```", cell.source, re.DOTALL)
    return str(code)


def names_of(source: str) -> tuple[set[str], set[str]]:
    """Return the names that some code defines, and those that it uses from outside of its functions.

    Code that is no Python has none.

    Examples
    --------
    >>> names_of("def half(x): return x / two")
    ({'half'}, {'two'})
    """
    try:
        top = symtable.symtable(source, "", "exec")
    except (SyntaxError, ValueError):
        return set(), set()
    defining = [symbol for symbol in top.get_symbols() if symbol.is_assigned() or symbol.is_imported()]
    used: set[str] = set()
    tables = [top]
    while tables:
        table = tables.pop()
        tables += table.get_children()
        symbols = [symbol for symbol in table.get_symbols() if symbol.is_referenced()]
        used |= {symbol.get_name() for symbol in symbols if table is top or symbol.is_global()}
    return {symbol.get_name() for symbol in defining}, used


def run(path: Path, figures: Path) -> None:
    """Run a notebook from top to bottom, and store it with its outputs, without what varies between runs.

    The code in `source:` cells is taken from the package again, attached pictures from `figures`, and marked
    numbers in the text from what the cells compute.

    Parameters
    ----------
    path : the notebook.
    figures : the folder of the pictures.

    Raises
    ------
    MocapError : if a cell or a marked number fails; the file stays as it was.
    """
    nbformat = library()
    notebook = read(path)
    for name, cell in tagged(notebook, "source"):
        cell.source = shown_source(name)
    for cell in notebook.cells:
        for name in cell.get("attachments", {}):
            cell.attachments[name] = {"image/png": base64.b64encode((figures / name).read_bytes()).decode()}
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    notebook.cells.append(nbformat.v4.new_code_cell(marked_values.question(texts)))
    execute(notebook, path)
    printed = "".join(o.text for o in notebook.cells.pop().outputs if o.get("name") == "stdout")
    values = json.loads(printed) if printed else {}  # none of a notebook that stepped aside
    _renew_numbers(notebook, path, values)
    settle(notebook)
    write_file(path, nbformat.writes(notebook) + "\n")


def _renew_numbers(notebook: Any, path: Path, values: dict[str, float | str]) -> None:  # noqa: ANN401
    """Write computed values into the text of a notebook; raise if one is missing where it must not be."""
    for number, cell in enumerate(notebook.cells):
        if cell.cell_type == "markdown":
            cell.source = marked_values.refreshed(cell.source, values)
            wrong = marked_values.wrong(cell.source, values) if values else []
            if wrong and not _is_real(cell):
                raise MocapError(f"{path}, cell {number}: {wrong[0]}")


def _is_real(cell: Any) -> bool:  # noqa: ANN401
    """Return whether a cell needs captured clips."""
    return "real" in cell.metadata.get("tags", ())


def execute(notebook: Any, path: Path, seconds: int = 120) -> None:  # noqa: ANN401
    """Run a notebook as if nobody had solved anything, by a kernel that does not warn of its connection.

    Parameters
    ----------
    notebook : from `read`; it takes the outputs.
    path : its file, beside which its cells find others.
    seconds : that a cell may take.

    Raises
    ------
    MocapError : if a cell fails; it says which.
    """
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    started = [0]
    options: dict[str, Any] = {"resources": {"metadata": {"path": path.parent}}, "timeout": seconds}
    client: Any = NotebookClient(notebook, extra_arguments=["--log-level=ERROR"], **options)
    client.on_cell_start = lambda cell, cell_index: started.append(cell_index)
    try:
        client.execute(env={**os.environ, "MOCAP_MINE": ""})
    except CellExecutionError as error:
        said = _error_of(notebook.cells[started[-1]]) or f"{error.ename}: {error.evalue}"
        raise MocapError(f"{path}, cell {started[-1]}: {said:.120}") from error


def _error_of(cell: Any) -> str:  # noqa: ANN401
    """Return the name and the message of the last error among a cell's outputs.

    The kernel's reply names no error if the code ran, but its result could not be displayed.
    """
    errors = [output for output in cell.outputs if output.output_type == "error"]
    return f"{errors[-1].ename}: {errors[-1].evalue}" if errors else ""


def settle(notebook: Any) -> None:  # noqa: ANN401
    """Remove from a notebook's metadata and outputs what varies between runs."""
    notebook.metadata = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number:02}"
        cell.metadata = {key: value for key, value in cell.metadata.items() if key == "tags"}
        if cell.cell_type == "code":
            cell.outputs = _joined(cell.outputs)
        if _is_real(cell):
            _keep_pictures(cell)


def _joined(outputs: list[Any]) -> list[Any]:
    """Drop widgets, which end with the kernel, and join the pieces of one stream."""
    joined: list[Any] = []
    for output in outputs:
        data = output.get("data", {})
        is_widget = data.pop(WIDGET, None) is not None
        if is_widget and not data:
            continue
        previous: Any = joined[-1] if joined else {}
        if output.output_type == "stream" and previous.get("name") == output.name:
            previous.text += output.text
        else:
            joined.append(output)
    return joined


def _keep_pictures(cell: Any) -> None:  # noqa: ANN401
    """Replace what moves by its picture, so that no captured motion is stored."""
    for output in cell.get("outputs", ()):
        data = output.get("data", {})
        if "text/html" in data:
            data["text/html"] = MOVING.sub(r"\1", data["text/html"])
