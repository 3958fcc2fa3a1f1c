"""Do the tests notice a small change? Make changes in a copy of the package, one at a time, and see.

    python tests/mutate.py --count 100 --seed 1
    python tests/mutate.py --only mocap/feet/footskate.py --count 20
    python tests/mutate.py --rooms editing methods --near --least 85 --jobs 2
    python tests/mutate.py --bounds

A change concerns one token of code: a comparison, an operator, a number, and/or, min/max, True/False. First
run the tests that name the module (with --near, only these), then the rest of its room, rooms above, and what
all rooms gave. Changes that no test catches are printed, as file:line:column old -> new. Not for Windows.

With --bounds, make the changes that tests/bounds.toml lists instead. Each belongs to an assertion that has
room for other arithmetic, and is caught only if that assertion fails: its room does not hide what it is for.
"""

import argparse
import ast
import importlib
import multiprocessing
import os
import random
import re
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]
MODULES = {
    "matching": "point_clouds prepared_clouds window_sums distance_grids minima transitions",
    "blending": "weights joining",
    "body": "planar rotations",
    "graphs": "components pruning compiled_graph edge_tables motion_graph",
    "synthesis": "bounded_search",
    "steering": "layered_search path_search path_objective",
    "feet": "leg_track ankle_targets least_bending footskate footplants",
}
ABOVE = {"body": "matching blending feet", "matching": "graphs", "blending": "graphs quality"}
ABOVE |= {"graphs": "synthesis steering", "synthesis": "steering", "feet": "quality synthesis"}
PAIRS = dict(pair.split() for pair in ["< <=", "> >=", "== !=", "+ -", "* /", "+= -=", "*= /=", "and or"])
SWAPS = PAIRS | {new: old for old, new in PAIRS.items()} | {"**": "*", "//": "/", "%": "//", "is": "is not"}
NAMES = {"min": "max", "minimum": "maximum", "argmin": "argmax", "fmin": "fmax"}
NAMES |= {new: old for old, new in NAMES.items()}
LEFT_OUT = (ast.JoinedStr, ast.Raise, ast.Import, ast.ImportFrom)
LIMIT = 120  # seconds of processor time for a group of tests
LOADED_ONCE = "networkx scipy.ndimage scipy.optimize scipy.sparse.csgraph scipy.spatial hypothesis.strategies"
OPTIONS = [
    "-x",
    "-q",
    "-n0",
    "-pno:cacheprovider",
    "--tb=line",
    "-oaddopts=",
    "--doctest-modules",
]
OPTIONS += [f"-pno:{plugin}" for plugin in ("nbval", "pytest_mpl", "anyio")]  # slow to import, and unused
OPTIONS += ["-m", "not tools and not benchmark and not exhaustive and (sweep or not sweep)"]
QUICK = """
from hypothesis import Phase  # the same examples each time, and no search for simpler ones
settings.register_profile("quick", settings(derandomize=True, phases=[Phase.explicit, Phase.generate]))
settings.load_profile("quick")
"""


def modules(rooms: list[str] | None = None) -> list[str]:
    """List the modules of some rooms; without rooms, those of the core."""
    if not rooms:
        return [f"mocap/{room}/{name}.py" for room, names in MODULES.items() for name in names.split()]
    files = [file for room in rooms for file in sorted((ROOT / "mocap" / room).rglob("[!_]*.py"))]
    return [file.relative_to(ROOT).as_posix() for file in files]


class Bound(NamedTuple):
    """An assertion with room for other arithmetic, and a change of the package at which it still fails."""

    test: str  # as pytest names it
    assertion: str  # its text, which occurs once in a file of the tests
    room: str  # what was measured, and where
    file: str
    old: str  # occurs once in this file
    new: str
    helper: str = ""  # the file of the assertion, if not that of the test

    @property
    def asserting(self) -> str:
        """The file of the assertion."""
        return self.helper or self.test.partition("::")[0]


class Change(NamedTuple):
    """Bytes `start` to `end` of a file become `new`."""

    path: str
    start: int
    end: int
    place: str
    old: str
    new: str

    def __str__(self) -> str:
        return f"{self.path}:{self.place} {self.old} -> {self.new or 'nothing'}"


def changes_of(root: Path, path: str) -> list[Change]:
    """List all changes of one token in a file of the package."""
    source = (root / path).read_bytes()
    starts = [0, *(found.end() for found in re.finditer(b"\n", source))]
    changes = []
    for node in nodes(ast.parse(source)):
        for start, end, new in swaps(node, source, starts):
            line = source.count(b"\n", 0, start)
            place = f"{line + 1}:{start - starts[line] + 1}"
            changes.append(Change(path, start, end, place, source[start:end].decode(), new))
    return changes


def nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Walk through the code, without what is left out."""
    yield node
    for field, value in ast.iter_fields(node):
        if field not in ("annotation", "returns", "decorator_list") and getattr(node, "arg", "") != "strict":
            for part in value if isinstance(value, list) else [value]:
                if isinstance(part, ast.AST) and not isinstance(part, LEFT_OUT):
                    yield from nodes(part)


def swaps(node: ast.AST, source: bytes, starts: list[int]) -> Iterator[tuple[int, int, str]]:
    """Yield where a change of a node starts and ends, and what stands there then."""
    if not isinstance(node, ast.expr | ast.AugAssign):
        return
    start = starts[node.lineno - 1] + node.col_offset
    end = starts[node.end_lineno - 1] + node.end_col_offset
    match node:
        case ast.Constant(value=bool(value)):
            yield start, end, str(not value)
        case ast.Constant(value=int(value) | float(value)):
            yield start, end, repr(value + 1 if isinstance(value, int) else 2 * value or 1.0)
        case ast.Name(id=name) | ast.Attribute(attr=name) if name in NAMES:
            yield end - len(name), end, NAMES[name]
        case ast.UnaryOp(op=ast.USub()):
            yield start, start + 1, "+"
        case ast.UnaryOp(op=ast.Not()):
            yield start, start + 3, ""
        case ast.BinOp() | ast.AugAssign() | ast.Compare() | ast.BoolOp():
            operands = [part for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr)]
            for left, right in pairwise(operands):
                first = starts[left.end_lineno - 1] + left.end_col_offset
                between = source[first : starts[right.lineno - 1] + right.col_offset]
                yield from operators(between, first)


def operators(between: bytes, first: int) -> Iterator[tuple[int, int, str]]:
    """Yield the change of the operator between two operands, which may stand in brackets."""
    text = re.sub(rb"#.*", lambda comment: b" " * len(comment[0]), between)
    found = re.search(rb"is not|not in|[^\s()]+", text)
    if new := SWAPS.get(found[0].decode()):
        yield first + found.start(), first + found.end(), new


def tests_of(root: Path, path: str) -> list[list[str]]:
    """List the tests for a module: those that name it or a name of its, the rest of its room, rooms above."""
    room, module = Path(path).relative_to("mocap").parent, Path(path).stem
    own = re.findall(r"^(?:def|class) (\w+)", (root / path).read_text("utf-8"), re.MULTILINE)
    named = re.compile(rf"\b({'|'.join([module, *own])})\b")
    files = sorted(str(file.relative_to(root)) for file in (root / "tests" / room).glob("test_*.py"))
    first = [file for file in files if named.search((root / file).read_text("utf-8"))]
    first.sort(key=lambda file: file != f"tests/{room}/test_{module}.py")
    rest = [file for file in files if file not in first]
    above = [f"tests/{name}" for name in ABOVE.get(str(room), "").split()]
    return [group for group in ([path, *first], rest, above, ["tests/test_same_results.py"]) if group]


def make_copy(copy: Path) -> Path:
    """Copy the package, its tests and what they use."""
    for folder in ("mocap", "tests", "notebooks", "figures"):
        shutil.copytree(ROOT / folder, copy / folder)
    for file in ("pyproject.toml", "conftest.py"):
        shutil.copy2(ROOT / file, copy)
    with (copy / "tests/conftest.py").open("a", encoding="utf-8") as conftest:
        conftest.write(QUICK)
    return copy


def run(copy: Path, tests: list[str], output: str) -> None:
    """Run tests in this process, with what they print in a file, then end it."""
    import resource  # missing on Windows, where pytest still imports this file

    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    os.chdir(copy)
    sys.path.insert(0, str(copy))
    sys.dont_write_bytecode = True
    for stream in (1, 2):
        os.dup2(os.open(output, os.O_WRONLY | os.O_CREAT | os.O_APPEND), stream)
    os._exit(pytest.main([*OPTIONS, *tests]))


def passes(copy: Path, tests: list[str], output: str = os.devnull) -> bool:
    """Run tests in a process of their own, which need not import the libraries again."""
    process = multiprocessing.get_context("fork").Process(target=run, args=(copy, tests, output))
    process.start()
    process.join()
    return process.exitcode == 0


def survives(change: Change, groups: list[list[str]], copies: "SimpleQueue[Path]") -> bool:
    """Do all groups of tests pass with a change?"""
    copy = copies.get()
    file = copy / change.path
    source = file.read_bytes()
    file.write_bytes(source[: change.start] + change.new.encode() + source[change.end :])
    try:
        return all(passes(copy, tests) for tests in groups)
    finally:
        file.write_bytes(source)
        copies.put(copy)


def bounds() -> list[Bound]:
    """Read the bounds that have room, with a change for each."""
    table = tomllib.loads((ROOT / "tests" / "bounds.toml").read_text("utf-8"))
    return [Bound(**entry) for entry in table["bound"]]


def verdict(bound: Bound, copy: Path) -> str:
    """Make the change of a bound in a copy; return "caught" if its assertion fails, else the reason."""
    file = copy / bound.file
    source = file.read_text("utf-8")
    output = copy / "output.txt"
    output.unlink(missing_ok=True)
    if not passes(copy, [bound.test]):
        return "fails without the change"
    file.write_text(source.replace(bound.old, bound.new), "utf-8")
    try:
        survived = passes(copy, [bound.test], str(output))
    finally:
        file.write_text(source, "utf-8")
    said = output.read_text("utf-8")
    if survived:
        return "skipped, as its clips are missing" if " skipped" in said else "missed"
    asserting = (copy / bound.asserting).read_text("utf-8")
    line = asserting.count("\n", 0, asserting.index(bound.assertion)) + 1
    at_the_bound = f"{bound.asserting}:{line}: " in said
    return "caught" if at_the_bound else "fails at another line"


def check_bounds(only: str | None) -> bool:
    """Print for each bound, or those of one module, whether its change is caught; return whether all are."""
    os.environ.setdefault("MOCAP_REAL_DATA", str(ROOT.parent / "shared" / "data"))  # the copy is elsewhere
    chosen = [bound for bound in bounds() if only in (None, bound.file)]
    verdicts = []
    with tempfile.TemporaryDirectory() as folder:
        copy = make_copy(Path(folder) / "copy")
        for bound in chosen:
            verdicts.append(verdict(bound, copy))
            print(f"{verdicts[-1]}: {bound.file}: {bound.old} -> {bound.new}\n    {bound.test}", flush=True)
    caught = verdicts.count("caught")
    print(f"{caught} of {len(chosen)} changes are caught by the assertions that have room")
    return caught == len(chosen)


def check_random_changes(wanted: argparse.Namespace) -> None:
    """Make changes at random places, and print those that no test catches."""
    paths = [wanted.only] if wanted.only else modules(wanted.rooms)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(wanted.jobs) as pool:
        copy = make_copy(Path(folder) / "0")
        changes = [change for path in paths for change in changes_of(copy, path)]
        changes = random.Random(wanted.seed).sample(changes, min(wanted.count, len(changes)))
        groups = [tests_of(copy, change.path)[: 1 if wanted.near else None] for change in changes]
        for tests in sorted({tuple(first) for first, *_ in groups}):
            if not passes(copy, list(tests)):
                raise SystemExit(f"These tests fail without any change: {' '.join(tests)}.")
        copies = SimpleQueue()
        for job in range(wanted.jobs):
            copies.put(shutil.copytree(copy, Path(folder) / f"copy{job}"))
        caught = 0
        results = pool.map(survives, changes, groups, [copies] * len(changes))
        for change, survived in zip(changes, results, strict=True):
            caught += not survived
            if survived:
                print(change, flush=True)
    percent = 100 * caught / len(changes)
    print(f"{caught} of {len(changes)} changes caught ({percent:.0f}%)")
    if wanted.least is not None and percent < wanted.least:
        raise SystemExit(f"Too few: at least {wanted.least:g}% must be caught.")


def main() -> None:
    """Read the options, and check the bounds or random changes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100, help="how many changes (100)")
    parser.add_argument("--seed", type=int, default=1, help="which changes (1)")
    parser.add_argument("--only", metavar="PATH", help="one module, as mocap/feet/footskate.py")
    parser.add_argument("--rooms", nargs="+", metavar="ROOM", help="all modules of these rooms, as editing")
    parser.add_argument("--near", action="store_true", help="run only the tests that name the module")
    parser.add_argument("--least", type=float, metavar="N", help="fail if less than N percent are caught")
    parser.add_argument("--bounds", action="store_true", help="the changes of tests/bounds.toml instead")
    parser.add_argument("--jobs", type=int, default=1, help="how many changes at the same time (1)")
    wanted = parser.parse_args()
    for name in LOADED_ONCE.split():
        importlib.import_module(name)
    if wanted.bounds:
        sys.exit(0 if check_bounds(wanted.only) else 1)
    check_random_changes(wanted)


if __name__ == "__main__":
    main()
