"""Notes for the teacher: what a notebook uses by which an answer could have been taken over.

A note changes no mark, and students do not see it: it says at which cells to look. What counts are names in
the syntax tree of the student's cells. Comments, docstrings, texts and methods that share a name with a
builtin function are not looked at.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator, Sequence

from mocap.course.check import Check
from mocap.course.marking.cells import Cell, without_commands

CHECKS = "mocap.course.checks"
JUDGING = {"verdict", "require"}  # methods of a check that return no answer
SHOWING = {"help", "print", "type", "dir", "repr", "str"}  # functions that return no answer of a check either
RUNNING = {"eval", "exec", "compile", "__import__"}  # functions that run a text
READING = {"open", "Path", "read_text", "glob", "rglob", "joinpath", "files", "resource_filename"}
SOURCES = (".py", ".toml", ".ipynb", "*.*", "checks", "answers")  # how the names of files with answers end

UNUSUAL = {
    *("get_objects", "get_referrers", "get_referents", "_getframe", "import_module"),
    *("getsource", "getsourcelines", "getsourcefile", "get_data", "run_path", "run_module"),
    *("run_cell", "run_code", "safe_execfile", "user_ns", "find_module"),
    *("__globals__", "__builtins__", "__closure__", "__subclasses__", "__code__", "__file__", "__path__"),
}
"""Attributes by which a program reaches the objects, the modules or the files of others."""


def note(cells: Sequence[Cell], check: Check, course: Collection[str]) -> str:
    """Return what the cells of an exercise use by which its answer could have been taken over, or "".

    Only the notebook's own cells count: those of the exercise, and those of no exercise that are not in
    `course`, the traits of the course's notebook.

    Examples
    --------
    >>> from mocap.course import checks
    >>> source = "def hamilton(a, b): return rotations.multiply(a, b)  # checks that eval works"
    >>> note([Cell(("hamilton",), source)], checks.hamilton, ())
    'uses `multiply`: look at its cells'
    """
    statements: list[ast.stmt] = []
    for cell in cells:
        is_common = not cell.exercises and cell.source.strip() not in course
        if is_common or check.name in cell.exercises:
            statements += _parsed(cell.source)
    tree = ast.Module(body=statements, type_ignores=[])
    solution = "\n".join(text for text in course if f"def {check.name}(" in text)  # it may call some of them
    oracles = {name for name in check.oracles if f"{name}(" not in solution}
    used = dict.fromkeys([*odd_uses(tree), *_calls_of(tree, oracles)])
    return f"uses {', '.join(f'`{name}`' for name in used)}: look at its cells" if used else ""


def _parsed(source: str) -> list[ast.stmt]:
    """Parse a cell; one that is no Python has no names."""
    try:
        return ast.parse(without_commands(source)).body
    except (SyntaxError, ValueError, RecursionError):
        return []


def odd_uses(tree: ast.Module) -> Iterator[str]:
    """Yield the names of what is used in a syntax tree by which an answer could have been taken over.

    Examples
    --------
    >>> list(odd_uses(ast.parse("speed = getattr(checks.speed, 'tru' + 'th')")))
    ['checks', 'getattr']
    >>> list(odd_uses(ast.parse("angle = line.eval(angle)  # checks it")))
    []
    """
    yield from _imports(tree)
    yield from _uses_of_checks(tree)
    defined = set(_defined(tree))
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id=name)) if name not in defined:
                yield from _odd_call(name, node)
            case ast.Call(func=ast.Attribute(attr=name)) if name in READING and _reads_sources(node):
                yield name
            case ast.Call(func=ast.Attribute(attr="mine"), args=[ast.Constant(value=str(name)), *_]):
                yield f"mine('{name}')"
            case ast.Attribute(value=ast.Name(id="lab"), attr="own" | "slots" | "adopting" as name):
                yield f"lab.{name}"
            case ast.Attribute(value=ast.Name(id="sys"), attr="modules"):
                yield "sys.modules"
            case ast.Attribute(value=ast.Call(func=ast.Name(id="get_ipython")), attr="ex" | "ev" as name):
                yield name
            case ast.Attribute(value=ast.Attribute(), attr="truth" | "answers" | "mistakes" as name):
                yield name
            case ast.Attribute(attr=name) | ast.Name(id=name) if name in UNUSUAL:
                yield name


def _odd_call(name: str, call: ast.Call) -> Iterator[str]:
    """Yield the name of a function that is called, if this could run a text or reach an answer."""
    is_computed = len(call.args) > 1 and not isinstance(call.args[1], ast.Constant | ast.Name)
    reads = name in READING and _reads_sources(call)
    if name in RUNNING or reads or (name in ("getattr", "attrgetter") and is_computed):
        yield name


def _reads_sources(call: ast.Call) -> bool:
    """Return whether a text among the arguments names a file of code, or all files of a folder."""
    texts = [
        node.value for argument in call.args for node in ast.walk(argument) if isinstance(node, ast.Constant)
    ]
    return any(isinstance(text, str) and text.endswith(SOURCES) for text in texts)


def _imports(tree: ast.Module) -> Iterator[str]:
    """Yield the modules that are imported and hold checks or answers."""
    for node in ast.walk(tree):
        match node:
            case ast.ImportFrom(module=str(module)) if module.startswith(CHECKS):
                yield module
            case ast.ImportFrom(module="mocap.course.lab", names=names):
                yield from (
                    f"lab.{alias.name}" for alias in names if alias.name in ("own", "slots", "adopting")
                )
            case ast.ImportFrom(module="gc" | "inspect" | "importlib" | "sys" as module, names=names):
                odd = [alias.name for alias in names if alias.name in {*UNUSUAL, "modules", "resources"}]
                yield from (f"{module}.{name}" for name in odd)
            case ast.Import(names=names):
                yield from (alias.name for alias in names if alias.name.startswith((CHECKS, "importlib.re")))


def _uses_of_checks(tree: ast.Module) -> Iterator[str]:
    """Yield the name of the module of checks if a check is not just called; also `globals` if it is read."""
    names = {"checks", *_other_names(tree)}
    rebound = {name for name in _defined(tree) if name in names}
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    harmless = {id(part) for call in calls for part in _harmless_parts(call)}
    for node in ast.walk(tree):
        match node:
            case ast.Compare(comparators=[ast.Call() as call]):
                harmless.add(id(call))  # `"name" in globals()`
            case ast.Call(func=ast.Name(id="globals")) if id(node) not in harmless:
                yield "globals"
            case ast.Name(id=name, ctx=ast.Load()) if name in names - rebound and id(node) not in harmless:
                yield "checks"


def _harmless_parts(call: ast.Call) -> Iterable[ast.AST]:
    """Return the nodes of a call in which a check is only called, or shown."""
    match call.func:
        case ast.Attribute(value=ast.Name() as module):  # checks.speed(...)
            return [module]
        case ast.Attribute(value=ast.Attribute(value=ast.Name() as module), attr=name) if name in JUDGING:
            return [module]
        case ast.Name(id=name) if name in SHOWING:
            return [node for argument in call.args for node in ast.walk(argument)]
    return []


def _other_names(tree: ast.Module) -> Iterator[str]:
    """Yield the names under which the module of checks is imported."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "mocap.course":
            yield from (alias.asname for alias in node.names if alias.name == "checks" and alias.asname)


def _defined(tree: ast.Module) -> Iterator[str]:
    """Yield the names that are assigned to, or defined as functions, from no check."""
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if name not in _names_in(value):
                yield name
            case ast.FunctionDef(name=name) | ast.arg(arg=name):
                yield name
            case ast.For(target=ast.Name(id=name)) | ast.comprehension(target=ast.Name(id=name)):
                yield name


def _names_in(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def _calls_of(tree: ast.Module, functions: Collection[str]) -> Iterator[str]:
    """Yield which of the package's functions are called, if the notebook does not define them itself."""
    defined = set(_defined(tree))
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id=name)) if name in functions and name not in defined:
                yield name
            case ast.Call(func=ast.Attribute(attr=name)) if name in functions:
                yield name
