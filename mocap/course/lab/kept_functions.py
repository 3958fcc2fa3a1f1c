"""The file beside the notebooks that keeps what students wrote, so that it survives a restart of the kernel.

It is plain Python: each function, with its imports, helpers and constants, under a heading with its name. Who
deletes a function, or the file, starts anew. What is read from it counts only if it passes its check again.
"""

from __future__ import annotations

import ast
import inspect
import os
import re
import textwrap
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from mocap._shared.atomic import write_file
from mocap.course.notebooks import names_of
from mocap.errors import MocapError

HEAD = '''"""My motion graph: what I wrote in the course, and what passed its check.

The notebooks run these functions in place of the package's. Delete one of them, or this file, to start anew.
By itself it walks along a line, as it stands, right or wrong: python my_graph.py clips/ path.csv -o walk.bvh
The rest of the program is its last section. Change its constants, or anything else, and run it again.
"""
'''
FOOT = """

if __name__ == "__main__":
    import sys

    from mocap.course.lab import own

    sys.exit(own.run(globals(), __file__))
"""
OLD_FOOT = """

if __name__ == "__main__":
    from mocap.course.lab import own

    own.main(__file__)
"""
PROGRAM = "program"  # the name of the last section
PROGRAM_HEADING = "# ---- program (the rest, which calls the functions above: change what you like) ----\n"
HEADING = re.compile(r"^(# -+ (\w+)(?: \(.*\))? -+\n)", re.MULTILINE)


def place() -> Path | None:
    """Return the path of the file: `my_graph.py`, or what MOCAP_MINE names; None if that is empty."""
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


def split(text: str) -> tuple[str, list[tuple[str, str, str]]]:
    r"""Split a text at its headings: the head, and the name, the heading and the body of each section.

    Examples
    --------
    >>> split("import math\n# ---- f (notebook 01) ----\ndef f(): ...\n")
    ('import math\n', [('f', '# ---- f (notebook 01) ----\n', 'def f(): ...\n')])
    """
    for foot in (FOOT, OLD_FOOT):
        text = text.replace(foot, "\n" * foot.count("\n"))  # what follows it keeps its line
    head, *rest = HEADING.split(text)
    return head, list(zip(rest[1::3], rest[::3], rest[2::3], strict=True))


def run_sections(file: Path, text: str, names: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Run the file section by section; a section that fails is left out.

    Parameters
    ----------
    file : its path, for tracebacks.
    text : what it holds.
    names : what all functions may use: the other exercises'.

    Returns
    -------
    The functions by their names, and a sentence for each section that fails.
    """
    head, sections = split(text)
    shared: dict[str, Any] = {"__name__": "my_graph", **names}
    functions: dict[str, Any] = {}
    problems: list[str] = []
    line = 0
    for name, heading, body in [("", "", head), *sections]:
        if name == PROGRAM:  # which notebooks do not need
            line += heading.count("\n") + body.count("\n")
            continue
        space = {**shared} if name else shared  # a helper of one function does not replace that of another
        space.pop(name, None)
        line += heading.count("\n")
        try:
            exec(compile("\n" * line + body, str(file.resolve()), "exec"), space)
        except (Exception, SystemExit) as error:  # students edit the file, and it may hold anything
            problems.append(_section_problem(file, line + 1, error))
        line += body.count("\n")
        if callable(space.get(name)):
            functions[name] = space[name]
    return functions, problems


def _section_problem(file: Path, first_line: int, error: BaseException) -> str:
    """Return the sentence for a section that fails, with the line of the error or of the section."""
    line = getattr(error, "lineno", None) or first_line
    reason = getattr(error, "msg", str(error))
    return f"{file}, line {line}: {type(error).__name__}, {reason}; this section is not used."[:200]


def plain_source(function: FunctionType, provided: Collection[str] = ()) -> str:
    """Write down a function so that a new Python can run it: imports, helpers, and its source.

    Parameters
    ----------
    function : made in a notebook or a file.
    provided : names that are there wherever it runs, as those of the course's exercises.

    Raises
    ------
    MocapError
        If its source cannot be found, or it uses an object that has no short text.

    Examples
    --------
    >>> plain_source(textwrap.shorten).splitlines()[0]
    'from textwrap import TextWrapper'
    """
    imports: set[str] = set()
    helpers: dict[str, str] = {}
    _gather(inspect.unwrap(function), {*provided, function.__name__}, imports, helpers)
    parts = [*helpers.values(), _source(function)]
    if imports:
        parts.insert(0, "".join(sorted(imports)))
    return "\n\n".join(parts)


def _gather(function: FunctionType, collected: set[str], imports: set[str], helpers: dict[str, str]) -> None:
    """Collect what a function uses, its helpers' helpers first.

    Parameters
    ----------
    function : the function.
    collected : names that are provided or collected; grows.
    imports, helpers : lines of imports, and sources by name; both grow.
    """
    for name in sorted(names_of(_source(function))[1]):
        if name in collected or name not in function.__globals__:
            continue
        collected.add(name)
        value = function.__globals__[name]
        helper = inspect.unwrap(value) if callable(value) else None  # as it stands below its decorators
        if isinstance(helper, FunctionType) and helper.__globals__ is function.__globals__:
            _gather(helper, collected, imports, helpers)
            helpers[name] = _source(helper)
        elif _import(name, value):
            imports.add(f"{_import(name, value)}\n")
        else:
            helpers[name] = _assignment(name, value)


def _import(name: str, value: Any) -> str:  # noqa: ANN401
    """Write the import that gives a name its value, or "" where none does."""
    module = getattr(value, "__module__", None)
    original_name = getattr(value, "__name__", None)
    if isinstance(value, ModuleType):
        module, _, original_name = value.__name__.rpartition(".")
    line = f"from {module} import {original_name}" if module else f"import {original_name}"
    if original_name != name:
        line = f"{line} as {name}"
    space: dict[str, Any] = {}
    with suppress(ImportError, SyntaxError):  # there is no such module, or no such name to import
        exec(line, space)
    gives_value = name in space and space[name] is value
    return line if gives_value and module != "__main__" else ""


def _assignment(name: str, value: Any) -> str:  # noqa: ANN401
    """Write the assignment that gives a name its value; raise if no short text can."""
    if not _is_plain(value):
        raise MocapError(f"It uses `{name}`, a {type(value).__name__} that no short text can make.")
    return f"{name} = {value!r}\n"


def _is_plain(value: Any) -> bool:  # noqa: ANN401
    try:
        return bool(ast.literal_eval(repr(value)) == value)
    except (ValueError, SyntaxError):
        return False


def _source(function: FunctionType) -> str:
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError) as error:
        raise MocapError("Its source cannot be found.") from error
    if not source.lstrip().startswith(("def ", "@")):
        raise MocapError("It is no `def` with a name of its own.")
    return source.rstrip() + "\n"


def is_stub(function: Callable[..., Any]) -> bool:
    """Return whether a function still has a line `...` or `return ...`, as the cell of an exercise at first.

    Examples
    --------
    >>> is_stub(textwrap.shorten)
    False
    """
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    except (OSError, TypeError, SyntaxError):
        return False
    lines = [node.value for node in ast.walk(tree) if isinstance(node, ast.Return | ast.Expr)]
    return any(isinstance(value, ast.Constant) and value.value is ... for value in lines)


def keep(file: Path, name: str, notebook: str, source: str, program: str = "") -> str:
    """Write a function into the file, in place of an earlier one of its name, and return the new text.

    Parameters
    ----------
    file : the file; it is made where there is none.
    name : the function's.
    notebook : the number of the notebook that asks for it; the functions stand in this order.
    source : from `plain_source`. Its imports stay with it, as another's may have the same names.
    program : the rest of the program, for a file that does not have it yet.

    Raises
    ------
    MocapError : where the file cannot be read as Python or cannot be written; it stays as it was.
    """
    head, sections = split(read_text(file))
    try:
        ast.parse(head)
    except SyntaxError as error:
        raise MocapError(f"{file}, line {error.lineno}: {error.msg}; correct it, or delete it.") from error
    new = name, f"# ---- {name} (notebook {notebook}) ----\n", f"\n{source}"
    kept = [*(part for part in sections if part[0] != name), new]
    if program and all(part[0] != PROGRAM for part in sections):
        kept.append((PROGRAM, PROGRAM_HEADING, f"\n{program}"))
    kept.sort(key=lambda part: (part[0] == PROGRAM, part[1].partition("(")[2]))  # by notebook
    start = head.rstrip() + "\n" if head.strip() else HEAD
    parts = [start]
    for _, heading, body in kept:
        parts.append(heading + body.rstrip() + "\n")
    text = "\n\n".join(parts) + FOOT
    write_file(file, text)
    return text
