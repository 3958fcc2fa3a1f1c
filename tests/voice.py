"""The field's terms: which words are no names, and which openings are no docstrings.

    python tests/voice.py           # each place where a private word stands for a term
    python tests/voice.py --count   # how often, by room, and the patterns of docstrings and comments

The left column of `TERMS` holds words that this project used where the field has a term of its own. A name
that users see (a function, a class, a parameter, a field) has none of them, except those in `EXCEPTIONS`,
each with the reason why the word is right there. Rooms that are worded with the next change of their methods
are in `WAITING`.
"""

import argparse
import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)

TERMS = {
    "turn": "rotation; heading for a direction on the ground",
    "turns": "rotations; headings for directions on the ground",
    "move": "translation",
    "moves": "translations",
    "lay": "align, aligned, (planar rigid) transform",
    "laid": "aligned, transformed",
    "place": "position",
    "places": "positions",
    "way": "path, trajectory",
    "ways": "paths, trajectories, choices",
    "ride": "path, trajectory",
    "rides": "paths, trajectories",
    "pin": "constraint",
    "pins": "constraints",
    "wish": "target, request",
    "wishes": "targets, requests",
    "gap": "residual, error, distance",
    "gaps": "residuals, errors, distances",
    "slopes": "derivatives, Jacobian",
    "toward": "derivative",
    "hill": "basis function",
    "hills": "basis functions",
    "hop": "macro-edge",
    "hops": "macro-edges",
    "skate": "foot sliding speed",
    "skates": "foot sliding speeds",
    "slide": "foot sliding distance",
    "slides": "foot sliding distances",
    "plant": "foot contact, footplant",
    "plants": "foot contacts, footplants",
    "shake": "peak acceleration",
    "shaking": "peak acceleration",
    "shakes": "peak acceleration",
    "share": "weight, fraction",
    "shares": "weights, fractions",
    "alike": "similar, nearest",
    "dear": "high cost",
    "cheap": "low cost",
    "tell": "report, return",
    "tells": "reports, returns",
    "told": "reported, given",
    "say": "report, return",
    "says": "reports, returns",
    "said": "reported, given",
    "know": "store, find",
    "knows": "stores, finds",
    "mind": "note, store",
    "minds": "notes, stores",
    "who": "callers, users",
    "whoever": "callers, users",
    "nobody": "no function",
}

MOST_EXCEPTIONS = 40

# Names of functions end with "()": the verb may be right where the noun is not.
EXCEPTIONS = {
    "turn()": "a stable name, `PlanarTransform.turn`, which warns until version 0.3",
    "move()": "a stable name, `PlanarTransform.move`, which warns until version 0.3",
    "move": "a trait of the live player, which its script reads by this name",
    "in_place": "the term of game engines for a cycle on the spot",
    "place()": "the verb: it places a motion on the ground",
    "place_joints()": "the verb: it places the joints in the world",
    "gap": "a stable option, `mocap inbetween --gap`: the gap between two clips, as animators call it",
    "fill_gap()": "the gap between two clips, as animators call it",
    "slides()": "the slides of a lecture, `mocap course slides`",
}

WAITING = {
    "mocap/editing": "worded with feet and edits",
    "mocap/feet": "worded with feet and edits",
    "mocap/methods/motion_matching": "worded with control",
    "mocap/steering/foot_turning.py": "worded with control",
    "mocap/steering/characters.py": "worded with control",
    "mocap/steering/graph_control.py": "worded with control",
    "mocap/steering/judged_control.py": "worded with control",
    "mocap/course": "worded with the classroom",
}

OPENINGS = re.compile(r"(Give|Say|Let|Tell|Know|Mind|What|How|Where|Who|Which)\b")

PATTERNS = {
    "a docstring that begins with Give": re.compile(r'^\s*"""Give\b', re.MULTILINE),
    "a docstring that begins with Say, Let, What, How, Where": re.compile(
        r'^\s*"""(Say|Let|What|How|Where)\b', re.MULTILINE
    ),
    "a clause with what as a noun": re.compile(r"(?<![.:?] )\bwhat (is|a|the|they|it|he|she|one|was)\b"),
    "how far, near, much as a noun": re.compile(r"\bhow (far|near|much|many)\b"),
    "Where as a condition": re.compile(r"(?<=[.] )Where\b"),
    "So opens a sentence": re.compile(r"(?<=[.:] )So\b"),
    "too or as well at the end": re.compile(r"(, too|\bas well)[.,:;]"),
    "in the median, by all, by your": re.compile(r"\b(in the median|by all|by your)\b"),
    "from X on": re.compile(r"\bfrom \S+( \S+)? on\b[,.]?"),
    "a semicolon in prose": re.compile(r"(?<=[a-z]); (?=[a-z])"),
}


class Finding(NamedTuple):
    """A name that users see and that holds a private word."""

    path: str
    line: int
    name: str
    word: str


def words_of(name: str) -> list[str]:
    """Split an identifier at underscores and capitals.

    >>> words_of("plant_slides()"), words_of("PlantSlide")
    (['plant', 'slides'], ['plant', 'slide'])
    """
    parts = re.split(r"[_()]+|(?<=[a-z0-9])(?=[A-Z])", name)
    return [part.lower() for part in parts if part]


def public_names(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the names that users see, with their lines.

    They are the names of functions and classes, of parameters, and of the fields of classes. Names that begin
    with an underscore are left out, with all that is in a function's signature or a class's body.
    """
    for node in ast.walk(tree):
        if isinstance(node, FUNCTIONS) and not node.name.startswith("_"):
            yield node.lineno, f"{node.name}()"
            yield from parameters_of(node.args)
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield node.lineno, node.name
            yield from fields_of(node)


def parameters_of(arguments: ast.arguments) -> Iterator[tuple[int, str]]:
    """Yield the names of parameters, with their lines."""
    starred = [argument for argument in (arguments.vararg, arguments.kwarg) if argument]
    for argument in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, *starred]:
        yield argument.lineno, argument.arg


def fields_of(node: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Yield the public fields of a class, with their lines: in its body, and those set on `self`."""
    for statement in node.body:
        for target in targets_of(statement):
            if isinstance(target, ast.Name) and not target.id.startswith("_"):
                yield target.lineno, target.id
    for inner in ast.walk(node):
        if isinstance(inner, ast.Attribute) and is_set_on_self(inner) and not inner.attr.startswith("_"):
            yield inner.lineno, inner.attr


def targets_of(statement: ast.stmt) -> list[ast.expr]:
    """List what an assignment assigns to; nothing for another statement."""
    if isinstance(statement, ast.Assign):
        return statement.targets
    return [statement.target] if isinstance(statement, ast.AnnAssign) else []


def is_set_on_self(node: ast.Attribute) -> bool:
    """Return whether an expression sets an attribute of `self`."""
    return isinstance(node.ctx, ast.Store) and isinstance(node.value, ast.Name) and node.value.id == "self"


def private_word(name: str) -> str | None:
    """Return the first word of a name that has a term in its place, or None.

    >>> private_word("hop_costs"), private_word("macro_edge_costs")
    ('hop', None)
    """
    return next((word for word in words_of(name) if word in TERMS), None)


def is_waiting(path: Path) -> bool:
    """Return whether a file belongs to a room that is worded later."""
    name = path.relative_to(ROOT).as_posix()
    return any(name == room or name.startswith(f"{room}/") for room in WAITING)


def findings(path: Path) -> Iterator[Finding]:
    """Yield the names of a file that hold a private word, also those with a reason."""
    shown = path.relative_to(ROOT).as_posix()
    for line, name in public_names(ast.parse(path.read_text("utf-8"))):
        word = private_word(name)
        if word is not None:
            yield Finding(shown, line, name, word)


def all_findings() -> list[Finding]:
    """List the findings in all rooms that do not wait, also those with a reason."""
    return [finding for path in files() if not is_waiting(path) for finding in findings(path)]


def files() -> list[Path]:
    """List the files of the package."""
    return sorted((ROOT / "mocap").rglob("*.py"))


def openings(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the docstrings of a file that begin with a word that names no function, with their lines."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module):
            text = ast.get_docstring(node)
            if text and OPENINGS.match(text):
                yield getattr(node, "lineno", 1), text.splitlines()[0]


def prose_of(text: str) -> str:
    """Return the docstrings and comments of a module, one after the other."""
    parts = re.findall(r'""".*?"""|#[^\n]*', text, re.DOTALL)
    return "\n".join(parts)


def main() -> int:
    """Print the findings, or how often each pattern occurs."""
    parser = argparse.ArgumentParser(description="Find private words where the field has a term.")
    parser.add_argument("--count", action="store_true", help="count by room, and count patterns of prose")
    options = parser.parse_args()
    found = [finding for finding in all_findings() if finding.name not in EXCEPTIONS]
    if not options.count:
        for finding in found:
            print(f"{finding.path}:{finding.line}: {finding.name}: {TERMS[finding.word]}")
        return int(bool(found))
    rooms = Counter("/".join(finding.path.split("/")[:2]) for finding in found)
    for room, count in rooms.most_common():
        print(f"{count:5} {room}")
    for title, waiting in (("worded", False), ("waiting", True)):
        texts = [path.read_text("utf-8") for path in files() if is_waiting(path) == waiting]
        prose = "\n".join(map(prose_of, texts))
        print(f"Rooms that are {title}: {len(prose.split())} words of docstrings and comments")
        for name, pattern in PATTERNS.items():
            print(f"{len(pattern.findall(prose)):5} {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
