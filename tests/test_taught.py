"""The package says where it is taught: every function that students meet names the notebook."""

import ast
import contextlib
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

from mocap.course import notebooks

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
PACKAGE = Path(__file__).parents[1] / "mocap"


def code(name):
    cells = notebooks.read(NOTEBOOKS[0].parent / f"{name}.ipynb").cells
    return "\n".join(cell.source for cell in cells if cell.cell_type == "code")


def met(path):
    """Give the package's functions that a notebook's own code uses, by the names of their modules."""
    tree = ast.parse(code(path.stem))
    modules, found = {}, []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "mocap":
            modules |= {alias.asname or alias.name: f"mocap.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mocap."):
            found += [(node.module, alias.name) for alias in node.names]
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            found.append((modules[node.value.id], node.attr))
    for module, attribute in found:
        with contextlib.suppress(ImportError):
            thing = getattr(import_module(module), attribute, None)
            if inspect.isfunction(thing) and thing.__module__.startswith("mocap."):
                yield thing


def test_every_function_that_the_course_uses_names_a_notebook_that_teaches_it():
    for path in NOTEBOOKS:
        for function in met(path):
            where = f"{function.__module__}.{function.__name__}"
            told = f"{function.__doc__}\n{import_module(function.__module__).__doc__}"
            assert re.search(r"^ *Notebooks?: \d\d-", told, re.MULTILINE), f"{where}, used in {path.name}"


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: path.stem)
def test_a_docstring_names_only_notebooks_whose_code_uses_the_function(path):
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            for name in re.findall(r"^ *Notebook: (\S+)", ast.get_docstring(node) or "", re.MULTILINE):
                assert re.search(rf"\b{node.name}\b", code(name)), f"{path.stem}.{node.name}"
