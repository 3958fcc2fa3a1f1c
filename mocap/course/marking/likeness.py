"""Which functions are the same as the published solution, or as another student's, whatever their names are.

Two functions are the same if their syntax trees are: comments, layout, docstrings, annotations and the names
of arguments and of local variables do not count. A short function has few ways to be written, so only those
of some length are compared. What is found is a note for the teacher and changes no mark.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterable, Iterator, Sequence

from mocap.course.marking.cells import Cell, without_commands

SHORTEST = 35  # nodes of a syntax tree, of which a line such as `return a + b` has about ten
CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)  # of a published solution


def tree_of(cells: Sequence[Cell], name: str) -> str:
    r"""Return the syntax tree of a function of a notebook as text; "" if there is none, or a short one.

    Of several functions of the name the last one counts, as when the cells run.

    Examples
    --------
    >>> long = "def f(a):\n    rest = [b * b + a[0] for b in a if b > 0]\n    return sum(rest) / len(rest)"
    >>> other = long.replace("rest", "squares").replace("(a)", "(points)").replace("a[0]", "points[0]")
    >>> tree_of([Cell((), long)], "f") == tree_of([Cell((), other.replace("in a", "in points"))], "f") != ""
    True
    """
    trees = [tree for cell in cells for tree in _trees(cell.source, name)]
    return trees[-1] if trees else ""


def is_published(tree: str, name: str, course: Collection[str]) -> bool:
    """Return whether a tree is that of the published solution, in the texts of the course's notebook."""
    solutions = (code for text in course if f"def {name}(" in text for code in CODE.findall(text))
    return bool(tree) and any(tree in _trees(code, name) for code in solutions)


def _trees(source: str, name: str) -> list[str]:
    """List the trees of the functions of a name in a cell, as texts."""
    try:
        statements = ast.parse(without_commands(source)).body
    except (SyntaxError, ValueError, RecursionError):
        return []
    return [_normal(*parts) for statement in statements for parts in _functions(statement, name)]


def _functions(statement: ast.stmt, name: str) -> Iterator[tuple[ast.arguments, list[ast.stmt]]]:
    """Yield the arguments and the body of a function, or of a lambda, that a statement defines."""
    match statement:
        case ast.FunctionDef(name=defined, args=arguments, body=body) if defined == name:
            yield arguments, body
        case ast.Assign(targets=[ast.Name(id=defined)], value=ast.Lambda(args=arguments, body=value)):
            if defined == name:
                yield arguments, [ast.Return(value)]


def _normal(arguments: ast.arguments, body: list[ast.stmt]) -> str:
    """Write a function as text, in which arguments and local variables are numbered; "" for a short one."""
    statements = [statement for statement in body if not _is_text(statement)]
    nodes = [node for statement in statements for node in ast.walk(statement)]
    if len(nodes) < SHORTEST:
        return ""
    names = [argument.arg for argument in ast.walk(arguments) if isinstance(argument, ast.arg)]
    numbers = {name: f"v{number}" for number, name in enumerate(dict.fromkeys([*names, *_assigned(nodes)]))}
    for node in nodes:
        if isinstance(node, ast.Name):
            node.id = numbers.get(node.id, node.id)
        elif isinstance(node, ast.arg):
            node.arg = numbers.get(node.arg, node.arg)
            node.annotation = None
        elif isinstance(node, ast.FunctionDef):
            node.returns = None
    return "\n".join(map(ast.dump, statements))


def _is_text(statement: ast.stmt) -> bool:
    """Return whether a statement is a docstring, or another text that does nothing."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def _assigned(nodes: Iterable[ast.AST]) -> list[str]:
    """List the names that are assigned to in a function, and the arguments of functions in it."""
    names: list[str] = []
    for node in nodes:
        match node:
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                names.append(name)
    return names
