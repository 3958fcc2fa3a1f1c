"""The text of a whole program: `mocap.plain`, with the functions of `rewritten` in place of its own.

This is the end of `my_graph.py`, below the functions that a student wrote, and it calls them by their names.
Notebooks run the same text, with a function for each exercise: the student's, or the package's in its stead.
"""

from __future__ import annotations

import ast
import inspect
import linecache
import textwrap
from collections.abc import Mapping
from functools import cache
from types import ModuleType
from typing import Any

from mocap import plain
from mocap.course.checks import all_checks
from mocap.course.lab import rewritten
from mocap.course.notebooks import names_of

ENTRIES = ("main", "random_walk", "join")
"""What the program is for; of the functions of `mocap.plain` it has those that these need."""
IMPORTS = """\
import argparse
import io
import sys
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import networkx as nx
import numpy as np

from mocap import Motion, Skeleton
"""
RENAMED = {"python -m mocap.plain": "python my_graph.py", "mocap.plain: {error}": "my_graph.py: {error}"}
Nodes = dict[str, ast.stmt]


@cache
def text() -> str:
    """Return the program's text: imports, constants, and functions in the order of `mocap.plain`.

    Examples
    --------
    >>> "rotations[frame, 0] = to_unit(hamilton(about_y, root))" in text()
    True
    """
    sources = _sources()
    needed = _needed(sources)
    parts = [IMPORTS]
    was_constant = False
    for name, source in sources.items():
        if name in needed:
            is_constant = not source.startswith(("def ", "class "))
            parts.append(f"{source}\n" if is_constant and was_constant else f"\n\n{source}\n")
            was_constant = is_constant
    program = "".join(parts)
    for old, new in RENAMED.items():
        program = program.replace(old, new)
    return program


def module(exercises: Mapping[str, Any], constants: Mapping[str, Any]) -> Any:  # noqa: ANN401 (a module)
    """Run the program's text as a module.

    Parameters
    ----------
    exercises : a function for each exercise that the program calls.
    constants : new values of its constants, or functions in place of its functions.

    Returns
    -------
    The module, which also has those functions of `mocap.plain` that the text does without.
    """
    pages = ModuleType("my_graph")
    space = vars(pages)
    space.update({name: value for name, value in vars(plain).items() if not name.startswith("__")})
    space.update(exercises)
    file = "<the rest of my_graph.py>"
    linecache.cache[file] = (len(text()), None, text().splitlines(keepends=True), file)
    exec(compile(text(), file, "exec"), space)
    space.update(constants)
    return pages


def _sources() -> dict[str, str]:
    """Return the text of each constant, function and class by its name, in the order of the program."""
    replacements = _top_level(rewritten)
    helpers_of = _helpers_before(list(replacements))
    sources: dict[str, str] = {}
    for name, node in _top_level(plain).items():
        for helper in helpers_of.get(name, ()):
            sources[helper] = _text_of(rewritten, replacements[helper])
        if name not in replacements:
            sources[name] = _text_of(plain, node)
        elif isinstance(node, ast.ClassDef):
            sources[name] = _merged_class(node, replacements[name])
        else:
            sources[name] = _text_of(rewritten, replacements[name])
    return sources


def _helpers_before(names: list[str]) -> dict[str, list[str]]:
    """Return, for functions that replace one of plain's, the helpers that `rewritten` has before them."""
    helpers_of: dict[str, list[str]] = {}
    helpers: list[str] = []
    for name in names:
        if hasattr(plain, name):
            helpers_of[name] = helpers
            helpers = []
        else:
            helpers.append(name)
    return helpers_of


def _top_level(source: ModuleType) -> Nodes:
    """Return the constants, functions and classes of a module by their names.

    Type aliases, and the names that `rewritten` gives to the exercises, are left out.
    """
    nodes: Nodes = {}
    for node in ast.parse(inspect.getsource(source)).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            name = node.name
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
        else:
            continue
        is_exercise = name in all_checks()
        if not is_exercise and not name.startswith("_"):
            nodes[name] = node
    return nodes


def _text_of(source: ModuleType, node: ast.stmt) -> str:
    """Return the lines of a statement without annotations, and of the comment above it."""
    lines = inspect.getsource(source).splitlines()
    first = node.lineno - 1
    while lines[first - 1].startswith("# ") and not lines[first - 1].endswith("---"):
        first -= 1
    return _without_annotations("\n".join(lines[first : node.end_lineno]))


def _merged_class(node: ast.ClassDef, replacement: ast.stmt) -> str:
    """Return the text of plain's class with the methods of another one in place of its own."""
    assert isinstance(replacement, ast.ClassDef)
    new = {part.name: part for part in replacement.body if isinstance(part, ast.FunctionDef)}
    methods = [part for part in node.body if isinstance(part, ast.FunctionDef)]
    names = {part.name for part in methods}
    parts = [f'class {node.name}:\n    """{ast.get_docstring(replacement)}"""']
    for method in methods:
        if method.name not in new:
            parts.append(_text_of(plain, method))
            continue
        for name, part in list(new.items()):  # with the new ones that stand before it
            if name == method.name or name not in names:
                parts.append(_text_of(rewritten, part))
                del new[name]
            if name == method.name:
                break
    whole = "\n\n".join(parts)
    unused = [part for part in parts[1:] if not _is_used(part, whole)]
    return "\n\n".join(part for part in parts if part not in unused)


def _is_used(method: str, whole: str) -> bool:
    """Return whether a method is called inside its class, or is what callers of the class need."""
    name = method.split("(")[0].split()[-1]
    return name in ("__init__", "walk") or f"self.{name}" in whole


def _without_annotations(source: str) -> str:
    """Remove the annotations of functions; those of a NamedTuple's fields are needed, and become text."""
    lines = source.splitlines()
    tree = ast.parse(textwrap.dedent(source))
    indent = " " * (len(lines[-1]) - len(textwrap.dedent(source).splitlines()[-1]))
    fields = [part for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for part in node.body]
    nodes = [part for part in ast.walk(tree) if isinstance(part, ast.AnnAssign | ast.FunctionDef)]
    for part in sorted(nodes, key=lambda part: part.lineno, reverse=True):  # later lines keep their numbers
        first = part.lineno - 1
        if isinstance(part, ast.AnnAssign):
            lines[first] = _without_annotation(lines[first], part, len(indent), part in fields)
            continue
        for argument in ast.walk(part.args):
            if isinstance(argument, ast.arg):
                argument.annotation = None
        signature = f"{indent}{' ' * part.col_offset}def {part.name}({ast.unparse(part.args)}):"
        lines[first : part.body[0].lineno - 1] = [signature]
    return "\n".join(lines)


def _without_annotation(line: str, node: ast.AnnAssign, indent: int, is_field: bool) -> str:
    """Return the line of an assignment without its annotation, or with the annotation as text."""
    end_of_target = indent + (node.target.end_col_offset or 0)
    end_of_annotation = indent + (node.annotation.end_col_offset or 0)
    kind = ast.unparse(node.annotation)
    annotation = f': "{kind}"' if is_field else ""
    return line[:end_of_target] + annotation + line[end_of_annotation:]


def _needed(sources: Mapping[str, str]) -> set[str]:
    """Return the names that the program needs: those that its entries use, and those that these use."""
    needed: set[str] = set()
    waiting = list(ENTRIES)
    while waiting:
        name = waiting.pop()
        if name in sources and name not in needed:
            needed.add(name)
            waiting += names_of(sources[name])[1]
    return needed
