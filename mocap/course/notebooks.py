"""The course's notebooks as data: their cells by tag, and their running anew.

Cells carry tags that say what they are: `source:ROOM.FILE.FUNCTION` shows the package's own code,
`exercise:NAME` is the stub of a function, `check:NAME` its check, `solution:NAME` the folded solution,
`experiment:NAME` something to play with, `prediction` the question before it.
"""

from __future__ import annotations

import ast
import base64
import inspect
import re
import textwrap
from collections.abc import Iterator
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any

from mocap._shared.atomic import write_text
from mocap.errors import MocapError

KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
WIDGET = "application/vnd.jupyter.widget-view+json"  # names a model that is gone once the kernel is


def library() -> Any:  # noqa: ANN401
    """Give nbformat, or say what to install."""
    try:
        import nbclient  # noqa: F401  # which comes with it, and runs what it reads
        import nbformat
    except ImportError as error:
        raise MocapError("Notebooks need nbformat and nbclient: pip install 'mocap[notebooks]'.") from error
    return nbformat


def read(path: Path) -> Any:  # noqa: ANN401
    """Read a notebook, as nbformat's object.

    Raises
    ------
    MocapError : where nbformat is not installed, or the file is no notebook.
    """
    nbformat = library()
    try:
        return nbformat.read(path, as_version=4)
    except OSError as error:
        raise MocapError(f"{path}: {error.strerror}.") from error
    except Exception as error:  # nbformat raises whatever it stumbles on
        raise MocapError(f"{path}: is not a notebook.") from error


def tagged(notebook: Any, kind: str) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """Give the cells with a tag such as `exercise:NAME`, each with its NAME; `kind` is what stands before."""
    for cell in notebook.cells:
        for tag in cell.metadata.get("tags", ()):
            if tag == kind or tag.startswith(f"{kind}:"):
                yield tag.removeprefix(kind).removeprefix(":"), cell


def shown_source(name: str) -> str:
    """Give a function or method as a notebook shows it: without its docstring and type annotations.

    Examples
    --------
    >>> print(shown_source("body.rotations.about_y"))
    def about_y(angles):
        ...
    """
    room, file, function = name.split(".", 2)
    text = textwrap.dedent(inspect.getsource(attrgetter(function)(import_module(f"mocap.{room}.{file}"))))
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
    return "\n".join([f"def {node.name}({ast.unparse(node.args)}):", *lines[body[0].lineno - 1 :]])


def solution(cell: Any) -> str:  # noqa: ANN401
    """Give the code in a folded solution."""
    (code,) = re.findall(r"```python\n(.*?)```", cell.source, re.DOTALL)
    return str(code)


def run(path: Path, figures: Path) -> None:
    """Run a notebook from top to bottom, and store it with its outputs: nothing in it that varies.

    What the package has, the notebook takes from there: the code in `source:` cells, and pictures of
    `figures` that are attached under their names.

    Raises
    ------
    MocapError : if a cell fails; the file stays as it was.
    """
    nbformat, notebook = library(), read(path)
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    for name, cell in tagged(notebook, "source"):
        cell.source = shown_source(name)
    for cell in notebook.cells:
        for name in cell.get("attachments", {}):
            cell.attachments[name] = {"image/png": base64.b64encode((figures / name).read_bytes()).decode()}
    at = [0]
    client = NotebookClient(notebook, timeout=120, resources={"metadata": {"path": path.parent}})
    client.on_cell_start = lambda cell, cell_index: at.append(cell_index)
    try:
        client.execute()
    except CellExecutionError as error:
        raise MocapError(f"{path}, cell {at[-1]}: {error.ename}: {error.evalue}") from error
    settle(notebook)
    write_text(path, nbformat.writes(notebook) + "\n")


def settle(notebook: Any) -> None:  # noqa: ANN401
    """Take out of a notebook's metadata and outputs what varies from run to run."""
    notebook.metadata = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number:02}"
        cell.metadata = {key: value for key, value in cell.metadata.items() if key == "tags"}
        if cell.cell_type == "code":
            cell.outputs = _merged(cell.outputs)


def _merged(outputs: list[Any]) -> list[Any]:
    """Join the pieces in which a stream came, drop the names of widgets that are no more."""
    merged: list[Any] = []
    for output in outputs:
        data = output.get("data", {})
        data.pop(WIDGET, None)
        if output.output_type == "stream" and merged and merged[-1].get("name") == output.name:
            merged[-1].text += output.text
        else:
            merged.append(output)
    return merged
