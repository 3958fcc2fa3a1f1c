"""The skeleton of Acclaim files (`.asf`): bones, where they start and end, and how they may turn.

A joint has the name of the bone that starts there: the root's children are at the root itself, and a bone
without children ends in the joint `<bone>_end`. An order lists turns about fixed axes, the first one first:
XYZ is R = Rz Ry Rx.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body import euler, rotations
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError
from mocap.files.text import lines, read_text, to_numbers

Line = tuple[int, list[str]]  # its number, from 1, and its words

INCH, SHORTEST = 0.0254, 1e-6  # metres; the smallest `:units length`
TURNS, MOVES = ("rx", "ry", "rz"), ("tx", "ty", "tz")


class Bone(NamedTuple):
    """A bone: `vector` from its start to its end (3,), metres; `axis` C, a quaternion; `dofs` in file order.

    The root is a bone, too: its vector is its position at rest, its axis its orientation at rest.
    """

    vector: Array
    axis: Array
    dofs: tuple[str, ...]

    @property
    def turns(self) -> list[int]:
        """Which of its dofs are turns."""
        return [place for place, dof in enumerate(self.dofs) if dof in TURNS]

    @property
    def order(self) -> str:
        """The axes that it turns about, in their order."""
        return "".join(self.dofs[place][1] for place in self.turns)


class AcclaimSkeleton(NamedTuple):
    """A `skeleton`, its `bones` by name, the file's `unit` in metres, and `degrees`, else radians."""

    skeleton: Skeleton
    bones: Mapping[str, Bone]
    unit: float
    degrees: bool

    def needed(self) -> list[str]:
        """List the bones that every frame must have numbers for, in the skeleton's order."""
        return [name for name in self.skeleton.names if name in self.bones and self.bones[name].dofs]


def read_skeleton(path: str | Path, *, scale: float | None = None) -> AcclaimSkeleton:
    """Read an ASF file.

    Parameters
    ----------
    path : the file.
    scale : metres in one unit of the file; by default 0.0254 / length, from the file's own `:units`.

    Returns
    -------
    The skeleton, and what reading an AMC file needs. Bones outside the hierarchy are not in the skeleton.

    Raises
    ------
    FormatError : with the line that breaks the format.
    """
    sections = _sections(path, read_text(path))
    for key in (":root", ":bonedata", ":hierarchy"):
        if key not in sections:
            raise FormatError(path, None, f"a {key} section", f"only {' '.join(sections)}")
    units = _Fields(path, sections.get(":units", []))
    length = units.numbers("length", 1, "1")[0]
    if length < SHORTEST:
        raise FormatError(path, units.line("length")[0], f"a length of {SHORTEST:g} or more", f"{length:g}")
    line, words = units.line("angle", "deg")
    if (angle := " ".join(words).lower()) not in ("deg", "degrees", "rad", "radians"):
        raise FormatError(path, line, "angle deg or rad", f"'{angle}'")
    unit, degrees = scale or INCH / length, angle.startswith("deg")
    radians = np.radians(1.0) if degrees else 1.0  # of an angle
    bones = {"root": _root(_Fields(path, sections[":root"]), unit, radians)}
    for block in _blocks(path, sections[":bonedata"]):
        line, words = block.line("name")
        if len(words) != 1 or words[0] in bones:
            raise FormatError(path, line, "a new bone's name, one word", f"'{' '.join(words)}'")
        bones[words[0]] = _bone(block, unit, radians)
    children = _hierarchy(path, sections[":hierarchy"], bones)
    try:
        skeleton = _grown(children, bones)
    except MocapError:
        expected, got = "bones whose ends have new names", "a bone called '<another bone>_end'"
        raise FormatError(path, None, expected, got) from None
    return AcclaimSkeleton(skeleton, bones, unit, degrees)


def _sections(path: str | Path, text: str) -> dict[str, list[Line]]:
    """Sort the lines by section; commas and parentheses are white space in an ASF file."""
    sections: dict[str, list[Line]] = {}
    for number, words in lines(text.translate(str.maketrans(",()", "   "))):
        if words[0].startswith(":"):
            section = words.pop(0).lower()
            if section in sections:
                raise FormatError(path, number, f"one {section} section", "a second one")
            sections[section] = [(number, words)] if words else []
        elif not sections:
            raise FormatError(path, number, "a section, such as ':root'", f"'{words[0]}'")
        else:
            sections[section].append((number, words))
    return sections


class _Fields:
    """Lines by their first words; where a default is given, it stands for a line that is missing."""

    def __init__(self, path: str | Path, lines: list[Line]) -> None:
        self.path, self.lines = path, {key.lower(): (number, words) for number, (key, *words) in lines}

    def line(self, key: str, *default: str) -> Line:
        """Give the number and the words of the line with a key, or the default."""
        if key not in self.lines and not default:
            begin, known = self.lines.get("begin", (None,))[0], ", ".join(self.lines)
            raise FormatError(self.path, begin, f"a '{key}' line", f"only {known or 'nothing'}")
        return self.lines.get(key, (0, [*default]))

    def numbers(self, key: str, count: int, *default: str) -> Array:
        """Give the numbers of the line with a key."""
        line, words = self.line(key, *default)
        expected = f"{count} number{'s' * (count > 1)} for '{key}'"
        return to_numbers(self.path, line, words[:count], expected, count)

    def turn(self, order: list[str], angles: Array) -> Array:
        """Turn radians about x, y and z into a quaternion; `order` says which turn comes first."""
        axes = "".join(order).lower()
        if sorted(axes) != ["x", "y", "z"]:
            line = self.line("axis", "XYZ")[0]
            raise FormatError(self.path, line, "an order of axes, such as XYZ", f"'{''.join(order)}'")
        return euler.from_euler(axes, angles[["xyz".index(letter) for letter in axes]])

    def dofs(self, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
        """Give the degrees of freedom of the line with a key, each one that is known and there once."""
        line, words = self.line(key)
        dofs = tuple(word.lower() for word in words)
        if not dofs or set(dofs) - set(known) or len(set(dofs)) < len(dofs):
            got = f"'{' '.join(words)}'"
            raise FormatError(self.path, line, f"some of {' '.join(known)}, each once", got)
        return dofs


def _blocks(path: str | Path, lines: list[Line]) -> Iterator[_Fields]:
    """Cut lines at `begin` and `end`."""
    block: list[Line] = []
    for number, words in lines:
        word = words[0].lower()
        if bool(block) == (word == "begin"):
            raise FormatError(path, number, "'end' first" if block else "'begin'", f"'{words[0]}'")
        block.append((number, words))
        if word == "end":
            yield _Fields(path, block[:-1])
            block = []
    if block:
        raise FormatError(path, block[0][0], "'end' to this 'begin'", "the end of the section")


def _root(fields: _Fields, unit: float, radians: float) -> Bone:
    position, angles = (fields.numbers(key, 3, "0", "0", "0") for key in ("position", "orientation"))
    axis = fields.turn(fields.line("axis", "XYZ")[1], angles * radians)
    return Bone(position * unit, axis, fields.dofs("order", MOVES + TURNS))


def _bone(fields: _Fields, unit: float, radians: float) -> Bone:
    vector = fields.numbers("direction", 3) * fields.numbers("length", 1) * unit
    axis = fields.turn(fields.line("axis")[1][3:], fields.numbers("axis", 3) * radians)
    return Bone(vector, axis, fields.dofs("dof", (*TURNS, *MOVES, "l")) if "dof" in fields.lines else ())


def _hierarchy(path: str | Path, lines: list[Line], bones: Mapping[str, Bone]) -> dict[str, list[str]]:
    """List the bones' children."""
    children: dict[str, list[str]] = {}
    free = set(bones) - {"root"}
    for number, (parent, *names) in lines:
        for name in names:  # none after 'begin' and 'end'
            if parent not in bones or name not in free:
                got = f"'{name}' below '{parent}'"
                raise FormatError(path, number, "bones of :bonedata, each below one other", got)
            free.remove(name)
        if names:
            children.setdefault(parent, []).extend(names)
    if "root" not in children:
        raise FormatError(path, None, "bones below 'root' in :hierarchy", "none")
    return children


def _grown(children: Mapping[str, list[str]], bones: Mapping[str, Bone]) -> Skeleton:
    """Follow the hierarchy from the root, depth first; bones that it does not reach are left out.

    A bone without children gets a joint at its end, unless it has no length.
    """
    joints: list[tuple[str, int, Array]] = []
    waiting = [("root", -1, np.zeros(3))]  # name, parent, offset
    while waiting:
        name, parent, offset = waiting.pop()
        end = bones[name].vector if name in bones and joints else np.zeros(3)
        ends = [f"{name}_end"] if np.any(end) else []
        waiting += [(child, len(joints), end) for child in reversed(children.get(name, ends))]
        joints.append((name, parent, offset))
    names, parents, offsets = zip(*joints, strict=True)
    # The root's axis is its orientation at rest; its angles do not turn about it.
    stub = Bone(np.zeros(3), rotations.IDENTITY, ())  # an end site
    known = [bones.get(name, stub) for name in names]
    axes = [rotations.IDENTITY, *(bone.axis for bone in known[1:])]
    dofs = [bone.order for bone in known]
    return Skeleton(names, np.array(parents), np.array(offsets), np.array(axes), dofs)
