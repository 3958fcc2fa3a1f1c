"""The hierarchy of a BVH file: a tree of joints, each with an offset and channels.

An End Site under `head` becomes the joint `head_end`, further ones `head_end2`, …; an End Site of zero length
becomes no joint, as it only marks that no joint follows.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, shortened
from mocap.files.text import to_numbers

OUTSIDE, OPENING = ("HIERARCHY", "ROOT"), ("ROOT", "JOINT", "END")
WITHIN, WITHIN_END = ("OFFSET", "CHANNELS", "JOINT", "END", "}"), ("OFFSET", "}")
CHANNELS = "CHANNELS 3 Zrotation Xrotation Yrotation"
ROOT_CHANNELS = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
NOTHING_BELOW = ("End Site", "{", "\tOFFSET 0 0 0", "}")
POSITIONS = ("xposition", "yposition", "zposition")
ROTATIONS = ("xrotation", "yrotation", "zrotation")


@dataclass
class Joint:
    """A joint of the file; an End Site gets its name at the end, when those of its parent are counted."""

    line: int
    name: str
    parent: int
    offset: NDArray[np.float64] | None = None
    channels: list[str] = field(default_factory=list)


def _statements(text: str) -> Iterator[tuple[int, str, str]]:
    """Go through the statements of the hierarchy: line, keyword in capitals, and the rest."""
    for number, line in enumerate(text.split("\n"), 1):
        for statement in re.findall(r"[{}]|[^{}]+", line):
            if words := statement.split(maxsplit=1):
                yield number, words[0].upper(), "".join(words[1:]).strip()


def read_hierarchy(path: str | Path, text: str) -> list[Joint]:
    """Build the tree, parents first."""
    joints: list[Joint] = []
    inside: list[int] = []  # the joints whose braces are open
    allowed: tuple[str, ...] = OUTSIDE
    line = 1
    for line, keyword, rest in _statements(text):
        if keyword not in allowed:
            raise FormatError(path, line, " or ".join(allowed) or "MOTION", f"'{keyword}'")
        if keyword in OPENING:
            if not rest:
                raise FormatError(path, line, f"a name after {keyword}", "none")
            joints.append(Joint(line, rest if keyword != "END" else "", inside[-1] if inside else -1))
        elif keyword == "{":
            inside.append(len(joints) - 1)
        elif keyword == "OFFSET":
            joints[inside[-1]].offset = to_numbers(path, line, rest.split(), "3 numbers", 3)
        elif keyword == "CHANNELS":
            joints[inside[-1]].channels = _channels(path, line, rest.lower().split())
        elif keyword == "}":
            _close(path, line, joints, inside.pop())
        within = (WITHIN if joints[inside[-1]].name else WITHIN_END) if inside else ()
        allowed = ("{",) if keyword in OPENING else within if joints else OUTSIDE
    if inside or allowed:
        raise FormatError(path, line, " or ".join(allowed), "the end of the hierarchy")
    return _named(path, joints)


def _channels(path: str | Path, line: int, words: list[str]) -> list[str]:
    count, *names = words or [""]
    unknown = [name for name in names if name not in POSITIONS + ROTATIONS]
    twice = [name for name, times in Counter(names).items() if times > 1]
    if count != str(len(names)) or unknown or twice:
        got = f"'{(unknown or twice)[0]}'{' twice' * bool(twice)}" if unknown or twice else ""
        expected = "the number of channels and their names, such as '3 Zrotation Xrotation Yrotation'"
        raise FormatError(path, line, expected, got or f"'{shortened(count, 30)}' and {len(names)} names")
    return names


def _close(path: str | Path, line: int, joints: list[Joint], joint: int) -> None:
    if joints[joint].offset is None:
        raise FormatError(path, line, "an OFFSET before '}'", "none")
    if not joints[joint].name and not np.any(joints[joint].offset):
        joints.pop()  # an End Site, so it is the last


def _named(path: str | Path, joints: list[Joint]) -> list[Joint]:
    """Name the End Sites, and check that no two joints have the same name."""
    ends: Counter[int] = Counter()
    names = set()
    for joint in joints:
        if not joint.name:
            joint.name = _end_name(joints[joint.parent].name, ends[joint.parent])
            ends[joint.parent] += 1
        if joint.name in names:
            raise FormatError(path, joint.line, "a new joint's name", f"'{joint.name}' again")
        names.add(joint.name)
    return joints


def _end_name(parent: str, before: int) -> str:
    """Name the End Site of `parent` that comes after `before` others."""
    return f"{parent}_end{before + 1 if before else ''}"


def _end_sites(skeleton: Skeleton, offsets: Array, turning: NDArray[np.bool_]) -> set[int]:
    """Find the leaves that never turn and have the names that reading would give them."""
    found: set[int] = set()
    ends: Counter[int] = Counter()
    leaves = set(range(1, len(skeleton))) - set(skeleton.parents.tolist())
    for joint in sorted(leaves - set(np.flatnonzero(turning).tolist())):
        parent = int(skeleton.parents[joint])
        if skeleton.names[joint] == _end_name(skeleton.names[parent], ends[parent]) and offsets[joint].any():
            found.add(joint)
            ends[parent] += 1
    return found


def write_hierarchy(
    skeleton: Skeleton, offsets: Array, turning: NDArray[np.bool_], precision: int
) -> tuple[str, list[int]]:
    """Write the hierarchy with `offsets` in the file's unit; list the joints with channels, in its order."""
    ends = _end_sites(skeleton, offsets, turning)
    rows, order, waiting, depth = ["HIERARCHY"], [], [0], 0
    while waiting:
        joint = waiting.pop()
        tabs = "\t" * depth
        if joint < 0:
            depth -= 1
            rows.append(f"{tabs[1:]}}}")
            continue
        name = skeleton.names[joint]
        if not name.isprintable() or name != name.strip() or not name or set(name) & set("{}"):
            raise MocapError(f"A BVH file cannot hold a joint called {shortened(repr(name))}.")
        title = "End Site" if joint in ends else f"{'JOINT' if joint else 'ROOT'} {name}"
        offset = " ".join(f"{number:.{precision}f}" for number in (offsets[joint] if joint else np.zeros(3)))
        rows += [f"{tabs}{title}", f"{tabs}{{", f"{tabs}\tOFFSET {offset}"]
        depth += 1
        waiting.append(-1)  # the closing brace, below all children
        if joint not in ends:
            rows.append(f"{tabs}\t{CHANNELS if joint else ROOT_CHANNELS}")
            rows += [] if skeleton.children(joint) else [f"{tabs}\t{row}" for row in NOTHING_BELOW]
            waiting += reversed(skeleton.children(joint))
            order.append(joint)
    return "\n".join([*rows, ""]), order
