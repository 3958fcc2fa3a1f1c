"""The package says where it is taught: every function that students meet names the notebook."""

import ast
import contextlib
import inspect
import re
from functools import cache
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from types import SimpleNamespace

from mocap.course import notebooks

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
PACKAGE = Path(__file__).parents[1] / "mocap"


@cache
def code(name):
    cells = notebooks.read(NOTEBOOKS[0].parent / f"{name}.ipynb").cells
    return "\n".join(cell.source for cell in cells if cell.cell_type == "code")


def met(source):
    """Give the package's functions, not methods, that some code uses, however it imports them."""
    space, tree = SimpleNamespace(), ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom) and " mocap" in ast.unparse(node):
            exec(ast.unparse(node), vars(space))
    chains = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute | ast.Name)}
    for chain in sorted(chains):
        with contextlib.suppress(AttributeError):  # of names that are not the package's
            thing = attrgetter(chain)(space)
            ours = inspect.isfunction(thing) and thing.__module__.startswith("mocap.")
            if ours and thing.__qualname__ == thing.__name__:
                yield thing


def test_every_function_that_the_course_uses_names_a_notebook_that_teaches_it():
    seen = set()
    for path in NOTEBOOKS:
        for function in met(code(path.stem)):
            where = f"{function.__module__}.{function.__name__}"
            told = f"{function.__doc__}\n{import_module(function.__module__).__doc__}"
            assert re.search(r"^ *Notebooks?: \d\d[bc]?-", told, re.MULTILINE), (
                f"{where}, used in {path.name}"
            )
            seen.add(where)
    assert len(seen) > 100


def test_a_docstring_names_only_notebooks_whose_code_uses_the_function():
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                for name in re.findall(r"^ *Notebook: (\S+)", ast.get_docstring(node) or "", re.MULTILINE):
                    assert re.search(rf"\b{node.name}\b", code(name)), f"{path.stem}.{node.name}"
