"""The hierarchy of a BVH file: a tree of joints for each body, each joint with an offset and channels.

An End Site of `head` becomes the joint `head_end`, further ones `head_end2`, … An End Site of length zero is
dropped, because it only marks the end of a branch.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError, Remedy, shortened, warn
from mocap.files.text import to_numbers

FIRST = ("HIERARCHY", "ROOT")  # keywords that begin a file
AFTER_ROOT = ("ROOT",)  # of another body
OPENING = ("ROOT", "JOINT", "END")  # keywords before a brace that opens
INSIDE_JOINT = ("OFFSET", "CHANNELS", "JOINT", "END", "}")
INSIDE_END_SITE = ("OFFSET", "}")
POSITIONS = ("xposition", "yposition", "zposition")
ROTATIONS = ("xrotation", "yrotation", "zrotation")

# What is written.
CHANNELS = "CHANNELS 3 Zrotation Xrotation Yrotation"
ROOT_CHANNELS = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
EMPTY_END_SITE = ("End Site", "{", "\tOFFSET 0 0 0", "}")  # below a joint without children


@dataclass
class Joint:
    """A joint of the file. An End Site is named after the whole hierarchy has been read.

    line : of its name in the file.
    parent : the index of the parent, -1 for a root.
    offset : from the parent, in the unit of the file, shape (3,).
    channels : the names of its channels.
    column : of its first channel in the numbers of a frame.
    """

    line: int
    name: str
    parent: int
    offset: NDArray[np.float64] | None = None
    channels: list[str] = field(default_factory=list)
    column: int = 0

    def columns(self, names: Container[str]) -> list[int]:
        """Return the columns of those channels that have one of the names."""
        return [self.column + n for n, channel in enumerate(self.channels) if channel in names]

    def axes(self) -> str:
        """Return the axes of the rotation channels in order, such as "zxy"."""
        return "".join(channel[0] for channel in self.channels if channel in ROTATIONS)


def _statements(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield the statements of the hierarchy: line, keyword in capitals, and the text after it."""
    for number, line in enumerate(text.split("\n"), 1):
        for statement in re.findall(r"[{}]|[^{}]+", line):
            words = statement.split(maxsplit=1)
            if words:
                yield number, words[0].upper(), "".join(words[1:]).strip()


class Hierarchy(NamedTuple):
    """The joints of one body of a file, parents first, the `roots` of all its bodies, and its `width`.

    The width is the number of channels of all bodies.
    """

    joints: list[Joint]
    roots: tuple[str, ...]
    width: int


def read_hierarchy(path: str | Path, text: str, body: int | None = None) -> Hierarchy:
    """Parse a hierarchy, and choose one of its bodies.

    Parameters
    ----------
    path : the file, for errors.
    text : of its hierarchy.
    body : the number of the body, from 1; None for the first.

    Raises
    ------
    FormatError : with the line that breaks the format.
    MocapError : if the file has no such body.

    Examples
    --------
    >>> text = '''ROOT hips {
    ... OFFSET 0 0 0
    ... End Site { OFFSET 0 9 0 } }'''
    >>> hips, end = read_hierarchy("walk.bvh", text).joints
    >>> end.name, end.parent, end.offset
    ('hips_end', 0, array([0., 9., 0.]))
    """
    joints = _parse_joints(path, text)
    width = 0
    for joint in joints:
        joint.column = width
        width += len(joint.channels)
    bodies = _bodies(joints)
    roots = tuple(root.name for root, *_ in bodies)
    if body is not None and body not in range(1, len(bodies) + 1):
        count = "1 body" if len(bodies) == 1 else f"{len(bodies)} bodies"
        remedy = Remedy("{} is the number of one, from 1", "body")
        raise MocapError(f"{path} holds {count}, got {body}", remedy=remedy)
    return Hierarchy(_named(path, bodies[int(body or 1) - 1]), roots, width)


def _parse_joints(path: str | Path, text: str) -> list[Joint]:
    """Parse the joints of all bodies. Raise at the line that breaks the format."""
    tree = _Tree(path)
    line = 1
    for line, keyword, argument in _statements(text):
        if keyword not in tree.allowed:
            allowed = (*tree.allowed, "MOTION") if tree.allowed == AFTER_ROOT else tree.allowed
            raise FormatError(path, line, " or ".join(allowed), f"'{keyword}'")
        tree.add(line, keyword, argument)
    if tree.allowed != AFTER_ROOT:
        raise FormatError(path, line, " or ".join(tree.allowed), "the end of the hierarchy")
    return tree.joints


def _bodies(joints: Sequence[Joint]) -> list[list[Joint]]:
    """Split the joints of a file at its roots; the parents of each body are counted from its root."""
    bodies: list[list[Joint]] = []
    start = 0  # the number of the root of the body
    for number, joint in enumerate(joints):
        if joint.parent < 0:
            bodies.append([])
            start = number
        else:
            joint.parent -= start
        bodies[-1].append(joint)
    return bodies


class _Tree:
    """The state of the parser: the joints that have been read.

    joints : parents first. An End Site has an empty name.
    open : the joints whose braces are open, innermost last.
    allowed : the keywords that may follow.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = path
        self.joints: list[Joint] = []
        self.open: list[int] = []
        self.allowed: tuple[str, ...] = FIRST

    def add(self, line: int, keyword: str, argument: str) -> None:
        """Add a statement whose keyword is allowed."""
        match keyword:
            case "ROOT" | "JOINT" | "END":
                self._open_joint(line, keyword, argument)
            case "{":
                self.open.append(len(self.joints) - 1)
            case "OFFSET":
                offset = to_numbers(self.path, line, argument.split(), "3 numbers", 3)
                self.joints[self.open[-1]].offset = offset
            case "CHANNELS":
                channels = _channels(self.path, line, argument.lower().split())
                self.joints[self.open[-1]].channels = channels
            case "}":
                self._close_joint(line)
        self.allowed = self._next_keywords(keyword)

    def _open_joint(self, line: int, keyword: str, argument: str) -> None:
        if not argument:
            raise FormatError(self.path, line, f"a name after {keyword}", "none")
        name = "" if keyword == "END" else argument
        parent = self.open[-1] if self.open else -1
        self.joints.append(Joint(line, name, parent))

    def _close_joint(self, line: int) -> None:
        """Close the innermost brace. An End Site of zero length is dropped."""
        joint = self.joints[self.open.pop()]
        if joint.offset is None:
            raise FormatError(self.path, line, "an OFFSET before '}'", "none")
        if not joint.name and not np.any(joint.offset):
            self.joints.pop()  # an End Site has no children, therefore it is the last joint

    def _next_keywords(self, keyword: str) -> tuple[str, ...]:
        """Return the keywords that may follow a keyword."""
        if keyword in OPENING:
            return ("{",)
        if self.open:
            is_end_site = not self.joints[self.open[-1]].name
            return INSIDE_END_SITE if is_end_site else INSIDE_JOINT
        return AFTER_ROOT if self.joints else FIRST


def _channels(path: str | Path, line: int, words: list[str]) -> list[str]:
    """Parse the names of channels, after their number."""
    count, *names = words or [""]
    unknown = [name for name in names if name not in POSITIONS + ROTATIONS]
    repeated = [name for name, times in Counter(names).items() if times > 1]
    if count == str(len(names)) and not unknown and not repeated:
        return names
    got = f"'{shortened(count, 30)}' and {len(names)} names"
    if unknown:
        got = f"'{unknown[0]}'"
    elif repeated:
        got = f"'{repeated[0]}' twice"
    expected = "the number of channels and their names, such as '3 Zrotation Xrotation Yrotation'"
    raise FormatError(path, line, expected, got)


def _named(path: str | Path, joints: list[Joint]) -> list[Joint]:
    """Name the End Sites, and give joints of equal names a number, with a warning."""
    ends: Counter[int] = Counter()
    names: set[str] = set()
    repeated: list[str] = []
    for joint in joints:
        is_end_site = not joint.name
        if is_end_site:
            joint.name = _end_name(joints[joint.parent].name, ends[joint.parent])
            ends[joint.parent] += 1
        if joint.name in names and not is_end_site:
            repeated.append(joint.name)
            joint.name = _numbered(joint.name, names)
        if joint.name in names:
            raise FormatError(path, joint.line, "a new joint's name", f"'{joint.name}' again")
        names.add(joint.name)
    if repeated:
        shown = shortened(f"'{repeated[0]}'", 40)
        warn(f"{path}: {len(repeated)} joints have the name of another, such as {shown}: they get a number.")
    return joints


def _numbered(name: str, names: Container[str]) -> str:
    """Return a name with the first number, from 2, that is not taken."""
    number = 2
    while f"{name}_{number}" in names:
        number += 1
    return f"{name}_{number}"


def _end_name(parent: str, index: int) -> str:
    """Name an End Site of `parent`; the first one has index 0."""
    return f"{parent}_end{index + 1 if index else ''}"


def _end_sites(skeleton: Skeleton, offsets: Array, rotates: NDArray[np.bool_]) -> set[int]:
    """Return the leaves that can be End Sites: they never rotate, and have the names of End Sites."""
    end_sites: set[int] = set()
    counts: Counter[int] = Counter()  # of the End Sites of each parent
    leaves = set(range(1, len(skeleton))) - set(skeleton.parents.tolist())
    for joint in sorted(leaves - set(np.flatnonzero(rotates).tolist())):
        parent = int(skeleton.parents[joint])
        name = _end_name(skeleton.names[parent], counts[parent])
        if skeleton.names[joint] == name and offsets[joint].any():
            end_sites.add(joint)
            counts[parent] += 1
    return end_sites


def write_hierarchy(
    skeleton: Skeleton, offsets: Array, rotates: NDArray[np.bool_], precision: int
) -> tuple[str, list[int]]:
    """Format the hierarchy, and list the joints that have channels, in the order of the file.

    Parameters
    ----------
    skeleton : J joints.
    offsets : shape (J, 3), in the unit of the file. The offset of the root is written as 0.
    rotates : shape (J,), whether a joint rotates in any frame.
    precision : the number of decimals.

    Raises
    ------
    MocapError : for a name that the format cannot represent.
    """
    end_sites = _end_sites(skeleton, offsets, rotates)
    rows = ["HIERARCHY"]
    order: list[int] = []
    depth = 0
    stack = [0]  # joints to write, the next one at the end; -1 for the closing brace of a joint
    while stack:
        joint = stack.pop()
        if joint < 0:
            depth -= 1
            rows.append("\t" * depth + "}")
            continue
        is_end_site = joint in end_sites
        offset = offsets[joint] if joint else np.zeros(3)
        numbers = " ".join(f"{number:.{precision}f}" for number in offset)
        joint_rows = _joint_rows(skeleton, joint, numbers, is_end_site=is_end_site)
        rows += ["\t" * depth + row for row in joint_rows]
        stack.append(-1)
        depth += 1
        if not is_end_site:
            stack += reversed(skeleton.children(joint))
            order.append(joint)
    return "\n".join([*rows, ""]), order


def _joint_rows(skeleton: Skeleton, joint: int, offset: str, *, is_end_site: bool) -> list[str]:
    """Format the lines of a joint, without those of its children and its closing brace."""
    if is_end_site:
        return ["End Site", "{", f"\tOFFSET {offset}"]
    keyword = "JOINT" if joint else "ROOT"
    channels = CHANNELS if joint else ROOT_CHANNELS
    rows = [f"{keyword} {_checked_name(skeleton, joint)}", "{", f"\tOFFSET {offset}", f"\t{channels}"]
    if not skeleton.children(joint):
        rows += [f"\t{row}" for row in EMPTY_END_SITE]
    return rows


def _checked_name(skeleton: Skeleton, joint: int) -> str:
    """Return the name of a joint. Raise if it could not be read again."""
    name = skeleton.names[joint]
    if not name.isprintable() or name != name.strip() or not name or set(name) & set("{}"):
        raise MocapError(f"A BVH file cannot hold a joint called {shortened(repr(name))}.")
    return name
