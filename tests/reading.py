"""Rules that a reader feels, and the record of the files that do not follow them yet.

    python tests/reading.py                       # findings outside the record
    python tests/reading.py --all                 # all findings, and their numbers in each room
    python tests/reading.py --exempt              # shorten the record: drop what complies or is gone
    python tests/reading.py --add "REASON" FILE   # record a file as it is now

A rule is a function that yields (node, message) for each place in a module that makes a reader stop. Its
docstring shows the place, and what to write instead. Two ways lead out:

- A comment `# reads: <rule>: <reason>` excuses the statement that it is in, or the one below a comment that
  stands alone. At a `def` it excuses the signature, and for `complexity` the function.
- `reading_exempt.toml` records files that were there before the rules. A file is excused as long as its
  syntax tree is the recorded one; comments, docstrings, imports and formatting may change. The record only
  shrinks.
"""

import argparse
import ast
import hashlib
import io
import json
import re
import signal
import sys
import tokenize
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("mocap", "figures")
RECORD = Path(__file__).with_name("reading_exempt.toml")

MOST_COMPLEX = 12  # cognitive complexity of a function
MOST_NODES = 40  # syntax nodes of a statement, as `ast.walk` counts them
AXES = 3  # x, y and z: up to here an integer needs no name

# Words that say nothing about what they name: function words, and participles without their noun.
WORDS = """
    about after again apart around asked at away before behind beside beyond both done each enough every far
    few found further gone given here how known least left less made many more most much near nearer now off
    once one only other others over own same several some such taken there things told way ways what when
    where which who why
"""
FUNCTION_WORDS = frozenset(WORDS.split())

Place = tuple[ast.AST, str]
Function = ast.FunctionDef | ast.AsyncFunctionDef
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
LOOPS = (ast.For, ast.AsyncFor, ast.While)


class Finding(NamedTuple):
    """A place in a file that breaks a rule."""

    line: int
    rule: str
    message: str


def parse(text: str) -> ast.Module:
    """Parse a module; Python 3.12 adds empty texts to f-strings, which go."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            node.values = [part for part in node.values if getattr(part, "value", None) != ""]
    return tree


@lru_cache(maxsize=1)
def nodes_of(tree: ast.Module) -> list[ast.AST]:
    """List all nodes of a module; all rules go through the same list."""
    return list(ast.walk(tree))


# Functions --------------------------------------------------------------------------------------------------


def complexity(tree: ast.Module) -> Iterator[Place]:
    """A function whose paths a reader cannot keep in mind: cognitive complexity above 12.

    G. A. Campbell, *Cognitive Complexity*, SonarSource 2018. One each for if, elif, else, a conditional
    expression, a loop, an except, a match, a run of the same boolean operators, and a call of the function
    itself. All of these but elif, else and the operators cost one more for each level that they are nested
    in. The functions inside a function count in it, as one level.

    Instead: a function with a name for the inner loop; a table; `continue` or `return` at the odd case.
    """
    for function in functions(tree):
        score = cognitive_complexity(function)
        if score > MOST_COMPLEX:
            yield function, f"{function.name} has a cognitive complexity of {score}, at most {MOST_COMPLEX}"


def functions(tree: ast.AST) -> Iterator[Function]:
    """Yield functions and methods, but not the functions inside them."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, FUNCTIONS):
            yield node
        elif not isinstance(node, ast.expr):
            yield from functions(node)


def cognitive_complexity(function: Function) -> int:
    """Compute the cognitive complexity of a function."""
    return sum(_score(statement, 0, function.name) for statement in function.body)


def _score(node: ast.AST, depth: int, name: str) -> int:
    """Score a node and what is in it, `depth` levels deep in the function `name`."""
    if isinstance(node, ast.If):
        return 1 + depth + _score_if(node, depth, name)
    if isinstance(node, (*LOOPS, ast.Try, ast.TryStar)):
        return _score_loop_or_try(node, depth, name)
    if isinstance(node, ast.ExceptHandler | ast.Match | ast.IfExp):
        return 1 + depth + _score_children(node, depth + 1, name)
    if isinstance(node, (*FUNCTIONS, ast.Lambda)):
        return _score_children(node, depth + 1, name)
    if isinstance(node, ast.BoolOp):
        return 1 + _score_children(node, depth, name)
    if isinstance(node, ast.Call) and _called(node) == name:
        return 1 + _score_children(node, depth, name)
    return _score_children(node, depth, name)


def _score_children(node: ast.AST, depth: int, name: str) -> int:
    return sum(_score(child, depth, name) for child in ast.iter_child_nodes(node))


def _score_all(nodes: list[ast.stmt], depth: int, name: str) -> int:
    return sum(_score(node, depth, name) for node in nodes)


def _score_if(node: ast.If, depth: int, name: str) -> int:
    """Score an if but for its own 1 + depth; an elif costs 1 at any depth."""
    inside = _score(node.test, depth, name) + _score_all(node.body, depth + 1, name)
    match node.orelse:
        case []:
            return inside
        case [ast.If() as elif_]:
            return inside + 1 + _score_if(elif_, depth, name)
    return inside + 1 + _score_all(node.orelse, depth + 1, name)


def _score_loop_or_try(node: ast.stmt, depth: int, name: str) -> int:
    """Score a loop or a try; its `else` costs 1, and a try's own body and `finally` are no level."""
    is_loop = isinstance(node, LOOPS)
    score = 0
    if is_loop:
        score += 1 + depth
    if node.orelse:
        score += 1
    for child in ast.iter_child_nodes(node):
        deeper = is_loop and isinstance(child, ast.stmt)
        score += _score(child, depth + 1 if deeper else depth, name)
    return score


def _called(call: ast.Call) -> str:
    """Return the name of the function in f(x) and self.f(x)."""
    match call.func:
        case ast.Name(id=name) | ast.Attribute(value=ast.Name(id="self" | "cls"), attr=name):
            return name
    return ""


# Statements -------------------------------------------------------------------------------------------------


def statement(tree: ast.Module) -> Iterator[Place]:
    """A statement of more than 40 syntax nodes.

    Of a compound statement its head counts: the test of an if, what a for goes over. Signatures and tables
    of constants are read line by line, and are free.

    Instead: a name for each step.
    """
    for node in nodes_of(tree):
        if isinstance(node, ast.stmt) and not isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            nodes = 1 + sum(1 + _size(part) for part in _head(node))
            if nodes > MOST_NODES:
                yield node, f"{nodes} syntax nodes, at most {MOST_NODES}"


def _head(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the parts of a statement but for the statements in it, and its handlers and cases."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.stmt | ast.ExceptHandler | ast.match_case):
            yield child


def _size(node: ast.AST) -> int:
    """Count the nodes below a node; a table of constants counts as one."""
    if _is_table(node):
        return 0
    return sum(1 + _size(child) for child in ast.iter_child_nodes(node))


def _is_table(node: ast.AST) -> bool:
    """Tell a constant, or a list, tuple, set or dictionary that holds nothing else."""
    match node:
        case ast.Constant() | ast.UnaryOp(op=ast.USub(), operand=ast.Constant()):
            return True
        case ast.List(elts=items) | ast.Tuple(elts=items) | ast.Set(elts=items):
            return bool(items) and all(map(_is_table, items))
        case ast.Dict(keys=keys, values=values):
            return bool(keys) and all(key is not None and _is_table(key) for key in keys + values)
    return False


def pair(tree: ast.Module) -> Iterator[Place]:
    """A tuple assigned to several names at once.

        low, high = np.zeros(3), scale * reach      # low = np.zeros(3)
                                                    # high = scale * reach

    Meant is not the unpacking of one value (`low, high = box`), nor of one value's parts
    (`x, z = point[0], point[2]`), nor a swap (`a, b = b, a`).
    """
    for node in nodes_of(tree):
        if isinstance(node, ast.Assign) and _is_sequence(node.value) and not _is_constants(node, tree):
            values = node.value.elts
            for target in node.targets:
                if _is_sequence(target) and not _is_swap(target.elts, values) and not _are_parts(values):
                    yield node, "several values in one assignment: give each a line"


def _is_sequence(node: ast.AST) -> bool:
    return isinstance(node, ast.Tuple | ast.List)


def _is_swap(targets: list[ast.expr], values: list[ast.expr]) -> bool:
    return sorted(map(ast.unparse, targets)) == sorted(map(ast.unparse, values))


def _are_parts(values: list[ast.expr]) -> bool:
    """Tell attributes or items of one and the same name."""
    wholes = {
        ast.unparse(value.value) for value in values if isinstance(value, ast.Attribute | ast.Subscript)
    }
    are_parts = all(isinstance(value, ast.Attribute | ast.Subscript) for value in values)
    return are_parts and len(wholes) == 1 and wholes.pop().isidentifier()


def constant(tree: ast.Module) -> Iterator[Place]:
    """Several constants in one line.

        WIDTH, HEIGHT = 640, 480      # WIDTH = 640   (and their unit)
        LEAST = MOST = 3              # LEAST = 3

    Meant are names in capitals of a module or a class.
    """
    for node in nodes_of(tree):
        if isinstance(node, ast.Assign) and _is_constants(node, tree):
            yield node, "several constants in one line: give each a line, with its unit"


def _is_constants(node: ast.Assign, tree: ast.Module) -> bool:
    """Tell whether an assignment binds several names in capitals, outside of functions."""
    names = [name.id for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)]
    outside = chain(tree.body, *(child.body for child in tree.body if isinstance(child, ast.ClassDef)))
    return len(names) > 1 and all(name.isupper() for name in names) and node in outside


# Expressions ------------------------------------------------------------------------------------------------


def factor(tree: ast.Module) -> Iterator[Place]:
    """A truth value, or a negation, as a factor.

        price * (end > 0)             # price if end > 0 else 0.0
        speeds * ~standing            # np.where(standing, 0.0, speeds)
        ", aligned" * bool(turn)      # ", aligned" if turn else ""

    `~` of a Python bool is -1 or -2, and 0 * nan is nan.
    """
    for node in nodes_of(tree):
        match node:
            case ast.BinOp(op=ast.Mult(), left=left, right=right):
                factors = [left, right]
            case ast.AugAssign(op=ast.Mult(), value=value):
                factors = [value]
            case _:
                continue
        if any(map(_is_truth, factors)):
            yield node, "a truth value as a factor: write if and else, or np.where"


TRUTHS = {"bool", "isinstance", "any", "all", "isfinite", "isnan", "isclose", "allclose", "logical_not"}


def _is_truth(node: ast.expr) -> bool:
    """Tell an expression that is true or false by its form."""
    match node:
        case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not() | ast.Invert()):
            return True
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            return name in TRUTHS or name.startswith(("is_", "has_", "startswith", "endswith"))
        case ast.BinOp(op=ast.BitAnd() | ast.BitOr(), left=left, right=right):
            return _is_truth(left) or _is_truth(right)
    return False


def walrus(tree: ast.Module) -> Iterator[Place]:
    """An assignment within a larger expression.

        pins = join(plants := plant_pins(motion), pins)      # plants = plant_pins(motion)
                                                             # pins = join(plants, pins)

    Meant is not the whole condition of an if, a while or a comprehension: `while chunk := file.read():`.
    """
    conditions = set()
    for node in nodes_of(tree):
        if isinstance(node, ast.If | ast.While):
            conditions.add(node.test)
        if isinstance(node, ast.comprehension):
            conditions.update(node.ifs)
    for node in nodes_of(tree):
        if isinstance(node, ast.NamedExpr) and node not in conditions:
            yield node, f"{node.target.id} is assigned within an expression: give it a line"


def integer(tree: ast.Module) -> Iterator[Place]:
    """A bare integer for a kind, a row or a column.

        if edge.kind == 3:            # if edge.kind is Kind.CUT:
        rows[:, 7] = lack             # LACK = 7; rows[:, LACK] = lack
        change[:, 3:]                 # TURNS = slice(3, None); change[:, TURNS]
        price = edge[4]               # price = edge.price, of a NamedTuple

    Meant are integers from 3 on (x, y and z need no name) as an index, as the bound of a slice of one axis
    among several, or as start and step of a slice; from 5 on in a reshape; and any integer that a kind, mode,
    state, phase or type is compared with, or set to.
    """
    for node in nodes_of(tree):
        numbers = _bare_indices(node) if isinstance(node, ast.Subscript) else _bare_kinds(node)
        for number in numbers:
            yield node, f"a bare {number}: give the kind, row or column a name"


def _bare_indices(node: ast.Subscript) -> list[int]:
    """List the integers by which a subscript chooses rows or columns."""
    match node.slice:
        case ast.Tuple(elts=axes):
            return [bare for axis in axes for bare in _bare_axis(axis)]
        case ast.Slice(lower=lower, step=step):
            starts = [bare for bare in _bare(lower) if bare >= AXES]
            return starts if any(bare >= AXES for bare in _bare(step)) else []
    return [bare for bare in _bare(node.slice) if bare >= AXES]


def _bare_axis(axis: ast.expr) -> list[int]:
    """List the integers from 3 on that choose part of an axis; `:3` is x, y and z."""
    if isinstance(axis, ast.Slice):
        starts = [bare for bare in _bare(axis.lower) if bare >= AXES]
        return starts + [bare for bare in _bare(axis.upper) if bare > AXES]
    return [bare for bare in _bare(axis) if bare >= AXES]


KINDS = {"kind", "kinds", "mode", "modes", "state", "states", "phase", "phases", "type"}


def _bare_kinds(node: ast.AST) -> list[int]:
    """List the integers that a kind is compared with or set to, and the sizes in a reshape."""
    match node:
        case ast.Compare(left=first, comparators=rest) if any(map(_is_kind, [first, *rest])):
            return [bare for side in [first, *rest] for bare in _bare(side)]
        case ast.Assign(targets=[target], value=value) if _is_kind(target):
            return _bare(value)
        case ast.keyword(arg=str(word), value=value) if word in KINDS:
            return _bare(value)
        case ast.Call(func=ast.Attribute(attr="reshape"), args=sizes):
            return [bare for size in sizes for bare in _bare(size) if bare > AXES + 1]
    return []


def _is_kind(node: ast.expr) -> bool:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name) | ast.Subscript(slice=ast.Constant(value=name)):
            return name in KINDS
    return False


def _bare(node: ast.AST | None) -> list[int]:
    """List the integers that stand there as such: 7, or 3 and 4 of (3, 4)."""
    match node:
        case ast.Constant(value=int(number)) if not isinstance(number, bool):
            return [number]
        case ast.Tuple(elts=items) | ast.List(elts=items) | ast.Set(elts=items):
            return [number for item in items for number in _bare(item)]
    return []


# Names ------------------------------------------------------------------------------------------------------


def name(tree: ast.Module) -> Iterator[Place]:
    """A function word as the name of a variable, a parameter, a function or an attribute.

        found = find_legs(skeleton)      # legs = find_legs(skeleton)
        own, other = graphs              # source, target = graphs

    `left` is a name beside `right` in one function, `one` beside `other` is none.
    """
    for scope in [tree, *(node for node in nodes_of(tree) if isinstance(node, (*FUNCTIONS, ast.ClassDef)))]:
        bound = list(_bound(scope))
        words = {word.strip("_") for _, word in bound}
        for node, word in bound:
            is_side = word.strip("_") == "left" and "right" in words
            if word.strip("_") in FUNCTION_WORDS and not is_side:
                yield node, f"`{word}` is no name: say what it is"


def _bound(scope: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """Yield the names that a module, class or function binds itself, and where."""
    for node in ast.iter_child_nodes(scope):
        match node:
            case ast.Name(id=word, ctx=ast.Store()) | ast.Attribute(attr=word, ctx=ast.Store()):
                yield node, word
            case ast.arg(arg=word) | ast.alias(asname=str(word)) | ast.MatchAs(name=str(word)):
                yield node, word
            case ast.FunctionDef(name=word) | ast.AsyncFunctionDef(name=word) | ast.ClassDef(name=word):
                yield node, word
                continue  # a scope of its own
            case ast.ExceptHandler(name=str(word)) | ast.MatchStar(name=str(word)):
                yield node, word
        yield from _bound(node)


Rule = Callable[[ast.Module], Iterator[Place]]
FINDERS: tuple[Rule, ...] = (complexity, statement, pair, constant, factor, walrus, integer, name)
RULES = {rule.__name__: rule for rule in FINDERS}


# Exceptions -------------------------------------------------------------------------------------------------


class Excuse(NamedTuple):
    """A comment `# reads: <rule>: <reason>`, and the lines of the statement that it excuses."""

    line: int
    rule: str
    reason: str
    lines: range


def excuses(text: str) -> list[Excuse]:
    """List the comments that excuse a statement."""
    if "reads:" not in text:
        return []  # as in nearly all files, and splitting a text into tokens takes long
    statements = [node for node in nodes_of(ast.parse(text)) if isinstance(node, ast.stmt)]
    spans = sorted((_span(node) for node in statements), key=lambda span: (span.start, len(span)))
    listed = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        comment = re.match(r"#\s*reads:\s*(\w*):?\s*(.*)", token.string)
        if token.type == tokenize.COMMENT and comment:
            line, _ = token.start
            is_alone = token.line.lstrip().startswith("#")
            excused = [span for span in spans if (span.start > line if is_alone else line in span)]
            listed.append(Excuse(line, comment[1], comment[2], excused[0] if excused else range(0)))
    return listed


def _span(node: ast.stmt) -> range:
    """Return the lines of a statement; of a compound one those of its head."""
    decorators = getattr(node, "decorator_list", [])
    start = min([node.lineno, *(decorator.lineno for decorator in decorators)])
    body = getattr(node, "body", None) or getattr(node, "cases", None)
    if not body:
        return range(start, node.end_lineno + 1)
    first_line = getattr(body[0], "lineno", node.lineno + 1)  # a case has no line of its own
    return range(start, max(first_line, node.lineno + 1))


@lru_cache(maxsize=8)
def findings(text: str) -> list[Finding]:
    """List all that the rules find in a module, excused or not, by line."""
    tree = parse(text)
    places = [(rule, *place) for rule, find in RULES.items() for place in find(tree)]
    return sorted({Finding(node.lineno, rule, message) for rule, node, message in places})


def open_findings(text: str) -> list[Finding]:
    """List what the rules find in a module and no comment excuses."""
    excused = {(line, excuse.rule) for excuse in excuses(text) for line in excuse.lines}
    return [finding for finding in findings(text) if (finding.line, finding.rule) not in excused]


def complies(text: str) -> bool:
    """Tell whether a module has no open finding; the first one ends the search."""
    if excuses(text):
        return not open_findings(text)
    tree = parse(text)
    return not any(True for find in RULES.values() for _ in find(tree))


# The record -------------------------------------------------------------------------------------------------


def files() -> dict[str, Path]:
    """Return the files that the rules are for, by their paths from the root, with slashes."""
    paths = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
    return {path.relative_to(ROOT).as_posix(): path for path in paths}


@cache
def fingerprint(text: str) -> str:
    """Return a short hash of a module's syntax tree, without comments, docstrings, imports and formatting.

    `ast.dump` and `ast.unparse` differ between versions of Python, therefore the nodes are listed here.
    """
    tree = parse(text)
    for node in nodes_of(tree):
        if isinstance(node, (*FUNCTIONS, ast.ClassDef, ast.Module)) and ast.get_docstring(node) is not None:
            node.body = node.body[1:]
        if isinstance(getattr(node, "body", None), list):
            node.body = [part for part in node.body if not isinstance(part, ast.Import | ast.ImportFrom)]
    return hashlib.sha256(_listed(tree).encode()).hexdigest()[:12]


def _listed(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_listed, value))}]"
    if not isinstance(value, ast.AST):
        return repr(value)
    fields = {key: field for key, field in ast.iter_fields(value) if field not in (None, [])}
    listed = [f"{key}={_listed(field)}" for key, field in fields.items()]
    return f"{type(value).__name__}({', '.join(listed)})"


def record() -> dict[str, dict[str, dict[str, str]]]:
    """Read the record: for each room its exempt files, each with a fingerprint and a reason."""
    return tomllib.loads(RECORD.read_text("utf-8"))


def room_of(name: str) -> str:
    """Return the room of a file: the folder it is in."""
    return name.rpartition("/")[0]


def is_recorded(name: str, text: str) -> bool:
    """Tell whether a file is exempt: recorded, and unchanged since."""
    room, _, file = name.rpartition("/")
    entry = record().get(room, {}).get(file)
    return entry is not None and entry["tree"] == fingerprint(text)


def needless() -> list[str]:
    """List the recorded files that comply, changed, or are gone."""
    paths = files()
    listed = []
    for room, entries in record().items():
        for name in (f"{room}/{file}" for file in entries):
            text = paths[name].read_text("utf-8") if name in paths else ""
            if not is_recorded(name, text) or complies(text):
                listed.append(name)
    return listed


HEAD = """\
# Files that do not follow the rules of reading.py yet, by room. Each is exempt as long as its syntax tree is
# this one: a file that changes complies. `python tests/reading.py --exempt` shortens this record.
"""


def write(rooms: dict[str, dict[str, dict[str, str]]]) -> None:
    """Write the record, rooms and files in order."""
    lines = [HEAD]
    for room in sorted(room for room in rooms if rooms[room]):
        lines.append(f'["{room}"]')
        for file, entry in sorted(rooms[room].items()):
            reason = json.dumps(entry["reason"], ensure_ascii=False)
            lines.append(f'"{file}" = {{ tree = "{entry["tree"]}", reason = {reason} }}')
        lines.append("")
    RECORD.write_text("\n".join(lines).rstrip() + "\n", "utf-8")


def shorten() -> None:
    """Drop from the record what is needless in it."""
    entries = record()
    for name in needless():
        room, _, file = name.rpartition("/")
        print(f"{name}: no longer exempt")
        del entries[room][file]
    write(entries)


def add(names: list[str], reason: str) -> None:
    """Record files as they are."""
    rooms = record()
    for name in names:
        room, _, file = name.rpartition("/")
        tree = fingerprint((ROOT / name).read_text("utf-8"))
        rooms.setdefault(room, {})[file] = {"tree": tree, "reason": reason}
    write(rooms)


def files_below(paths: list[str]) -> list[str]:
    """Return files as they are named, and for a folder all Python files in it."""
    names = []
    for path in paths:
        if (ROOT / path).is_dir():
            names += sorted(file.relative_to(ROOT).as_posix() for file in (ROOT / path).rglob("*.py"))
        else:
            names.append(path)
    return names


def report(names: list[str], *, everything: bool) -> int:
    """Print what is found in files, and the numbers in each room; return the number of all."""
    counts: Counter[tuple[str, str]] = Counter()
    for name in names:
        text = (ROOT / name).read_text("utf-8")
        if is_recorded(name, text) and not everything:
            continue
        for line, rule, message in open_findings(text):
            print(f"{name}:{line}: {rule}: {message}")
            counts[room_of(name), rule] += 1
    for (room, rule), count in sorted(counts.items()):
        print(f"{room:30} {rule:12} {count:5}")
    return counts.total()


def main() -> int:
    """List findings, or change the record."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("files", nargs="*", help="files or folders, from the root; all by default")
    parser.add_argument("--all", action="store_true", help="also list what is found in exempt files")
    parser.add_argument("--exempt", action="store_true", help="shorten the record")
    parser.add_argument("--add", metavar="REASON", help="record the files as they are")
    options = parser.parse_args()
    for path in options.files:
        if not (ROOT / path).exists():
            parser.error(f"there is no {path} in {ROOT}")
    if options.add:
        add(options.files, options.add)
    if options.exempt:
        shorten()
    return min(1, report(files_below(options.files) or list(files()), everything=options.all))


if __name__ == "__main__":
    if hasattr(signal, "SIGPIPE"):  # Windows has none
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # end quietly where `| head` has seen enough
    sys.exit(main())
