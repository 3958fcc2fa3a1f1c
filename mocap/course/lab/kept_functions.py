"""The file beside the notebooks that keeps what students wrote, so that it survives a restart of the kernel.

It is plain Python: the imports, and each function under a heading with its name. Who deletes a function, or
the file, starts anew. What is read from it counts only if it passes its check again.
"""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.atomic import write_text
from mocap.course.lab.plain_source import Plain
from mocap.errors import MocapError

HEAD = '''"""My motion graph: what I wrote in the course, and what passed its check.

The notebooks run these functions in place of the package's. Delete one of them, or this file, to start anew.
"""
'''
HEADING = re.compile(r"^# -+ (\w+)(?: \(.*\))? -+\n", re.MULTILINE)


def place() -> Path | None:
    """Say where the file is: `my_graph.py` beside the notebook, or what MOCAP_MINE names; None if empty."""
    named = os.environ.get("MOCAP_MINE", "my_graph.py")
    return Path(named) if named else None


def read_text(file: Path | None) -> str:
    """Read the file; "" where there is none."""
    try:
        return file.read_text("utf-8-sig") if file else ""  # editors on Windows put a mark in front
    except FileNotFoundError:
        return ""
    except (OSError, UnicodeDecodeError) as error:
        raise MocapError(f"{file}: cannot be read ({error}); nothing in it is used.") from error


class Section(NamedTuple):
    """A part of the file: a function's name, its heading, the line of its body, and its body."""

    name: str
    heading: str
    line: int
    body: str


def split(text: str) -> list[Section]:
    r"""Split a text at its headings; the first part, the head, has no name.

    Examples
    --------
    >>> [tuple(part) for part in split("import math\n# ---- f (notebook 01) ----\ndef f(): ...\n")][1]
    ('f', '# ---- f (notebook 01) ----\n', 2, 'def f(): ...\n')
    """
    found = [*HEADING.finditer(text)]
    starts, ends = [match.end() for match in found], [*(match.start() for match in found), len(text)]
    parts = [Section("", "", 0, text[: ends[0]])]
    for match, start, end in zip(found, starts, ends[1:], strict=True):
        parts.append(Section(match[1], match[0], text.count("\n", 0, start), text[start:end]))
    return parts


def run_sections(file: Path, text: str, known: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Run the file section by section; a section that fails is left out.

    Parameters
    ----------
    file : its path, for tracebacks.
    text : what it holds.
    known : names that all functions may use: the other exercises'.

    Returns
    -------
    The functions by their names, and a sentence for each section that fails.
    """
    head, *sections = split(text)
    shared: dict[str, Any] = {"__name__": "my_graph", **known}
    said = _run(file, head, shared)
    found: dict[str, Any] = {}
    for section in sections:
        space = {**shared}  # a helper of one function does not replace that of another
        space.pop(section.name, None)
        said += _run(file, section, space)
        if callable(made := space.get(section.name)):
            found[section.name] = made
    return found, said


def _run(file: Path, part: Section, space: dict[str, Any]) -> list[str]:
    try:
        exec(compile("\n" * part.line + part.body, str(file.resolve()), "exec"), space)
    except (Exception, SystemExit) as error:  # students edit the file, and it may hold anything
        at = getattr(error, "lineno", None) or part.line + 1
        why = getattr(error, "msg", str(error))
        return [f"{file}, line {at}: {type(error).__name__}, {why}; this section is not used."[:200]]
    return []


def keep(file: Path, name: str, notebook: str, plain: Plain) -> str:
    """Write a function into the file, in place of an earlier one of its name, and return the new text.

    Parameters
    ----------
    file : the file; it is made where there is none.
    name : the function's.
    notebook : the number of the notebook that asks for it; the functions stand in this order.
    plain : its imports and its source.

    Raises
    ------
    MocapError : where the file cannot be read as Python or cannot be written; it stays as it was.
    """
    head, *sections = split(read_text(file))
    try:
        lines = {ast.unparse(node) for node in ast.parse(head.body).body if not isinstance(node, ast.Expr)}
    except SyntaxError as error:
        raise MocapError(f"{file}, line {error.lineno}: {error.msg}; correct it, or delete it.") from error
    new = Section(name, f"# ---- {name} (notebook {notebook}) ----\n", 0, f"\n{plain.source}")
    kept = [*(part for part in sections if part.name != name), new]
    kept.sort(key=lambda part: part.heading.partition("notebook ")[2])
    imports = "\n".join(sorted(lines | plain.imports))
    start = f"{HEAD}\n{imports}\n" if imports else HEAD
    text = "\n\n".join([start, *(part.heading + part.body.rstrip() + "\n" for part in kept)])
    try:
        write_text(file, text)
    except OSError as error:
        raise MocapError(f"{file}: cannot be written ({error.strerror}).") from error
    return text
