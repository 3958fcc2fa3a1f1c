"""The skeleton of Acclaim files (`.asf`): bones, where they start and end, and how they may turn.

A joint has the name of the bone that starts there: the root's children are at the root itself, and a bone
without children ends in the joint `<bone>_end`. An order lists turns about fixed axes, the first one first:
XYZ is R = Rz Ry Rx.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.skeleton import Skeleton
from mocap.errors import FormatError, MocapError
from mocap.files.text import lines, read_text, to_numbers

Line = tuple[int, list[str]]  # its number, from 1, and its words
Fields = dict[str, Line]  # lines by their first words

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

    def dofs(self) -> dict[str, tuple[str, ...]]:
        """List every bone's degrees of freedom."""
        return {name: bone.dofs for name, bone in self.bones.items()}


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
    unit, degrees = _units(path, _fields(sections.get(":units", [])))
    unit = scale or unit
    bones = {"root": _root(path, _fields(sections[":root"]), unit, degrees)}
    for block in _blocks(path, sections[":bonedata"]):
        line, words = _field(path, block, "name")
        if len(words) != 1 or words[0] in bones:
            raise FormatError(path, line, "a new bone's name, one word", f"'{' '.join(words)}'")
        bones[words[0]] = _bone(path, block, unit, degrees)
    children = _hierarchy(path, sections[":hierarchy"], bones)
    try:
        skeleton = grown(children, bones)
    except MocapError:
        expected, got = "bones whose ends have new names", "a bone called '<another bone>_end'"
        raise FormatError(path, None, expected, got) from None
    return AcclaimSkeleton(skeleton, bones, unit, degrees)


def _units(path: str | Path, fields: Fields) -> tuple[float, bool]:
    """Read the unit of length, in metres, and whether angles are degrees."""
    length = _vector(path, fields, "length", 1)[0] if "length" in fields else 1.0
    if length < SHORTEST:
        raise FormatError(path, fields["length"][0], f"a length of {SHORTEST:g} or more", f"{length:g}")
    line, words = fields.get("angle", (0, ["deg"]))
    if (angle := " ".join(words).lower()) not in ("deg", "degrees", "rad", "radians"):
        raise FormatError(path, line, "angle deg or rad", f"'{angle}'")
    return INCH / length, angle.startswith("deg")


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


def _fields(lines: Iterable[Line]) -> Fields:
    return {key.lower(): (number, words) for number, (key, *words) in lines}


def _blocks(path: str | Path, lines: list[Line]) -> Iterator[Fields]:
    """Cut lines at `begin` and `end`."""
    block: list[Line] = []
    for number, words in lines:
        word = words[0].lower()
        if bool(block) == (word == "begin"):
            raise FormatError(path, number, "'end' first" if block else "'begin'", f"'{words[0]}'")
        block.append((number, words))
        if word == "end":
            yield _fields(block[:-1])
            block = []
    if block:
        raise FormatError(path, block[0][0], "'end' to this 'begin'", "the end of the section")


def _field(path: str | Path, fields: Fields, key: str) -> Line:
    if key not in fields:
        line = fields["begin"][0] if "begin" in fields else None
        raise FormatError(path, line, f"a '{key}' line", f"only {', '.join(fields) or 'nothing'}")
    return fields[key]


def _vector(path: str | Path, fields: Fields, key: str, count: int) -> Array:
    line, words = _field(path, fields, key)
    return to_numbers(path, line, words[:count], f"{count} number{'s' * (count > 1)} for '{key}'", count)


def _axis(path: str | Path, line: int, order: str, angles: Array, degrees: bool) -> Array:
    """Turn the angles about x, y and z into a quaternion; `order` says which turn comes first."""
    if sorted(order.lower()) != ["x", "y", "z"]:
        raise FormatError(path, line, "an order of axes, such as XYZ", f"'{order}'")
    radians = np.radians(angles) if degrees else angles
    return euler.from_euler(order.lower(), radians[["xyz".index(letter) for letter in order.lower()]])


def _dofs(path: str | Path, line: int, words: list[str], known: tuple[str, ...]) -> tuple[str, ...]:
    dofs = tuple(word.lower() for word in words)
    if not dofs or set(dofs) - set(known) or len(set(dofs)) < len(dofs):
        raise FormatError(path, line, f"some of {' '.join(known)}, each once", f"'{' '.join(words)}'")
    return dofs


def _root(path: str | Path, fields: Fields, unit: float, degrees: bool) -> Bone:
    line, words = _field(path, fields, "order")
    dofs = _dofs(path, line, words, MOVES + TURNS)
    line, order = fields.get("axis", (0, ["XYZ"]))
    position = _vector(path, fields, "position", 3) if "position" in fields else np.zeros(3)
    angles = _vector(path, fields, "orientation", 3) if "orientation" in fields else np.zeros(3)
    return Bone(position * unit, _axis(path, line, "".join(order), angles, degrees), dofs)


def _bone(path: str | Path, fields: Fields, unit: float, degrees: bool) -> Bone:
    vector = _vector(path, fields, "direction", 3) * _vector(path, fields, "length", 1) * unit
    line, words = _field(path, fields, "axis")
    axis = _axis(path, line, "".join(words[3:]), _vector(path, fields, "axis", 3), degrees)
    dofs = _dofs(path, *fields["dof"], (*TURNS, *MOVES, "l")) if "dof" in fields else ()
    return Bone(vector, axis, dofs)


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


def grown(children: Mapping[str, list[str]], bones: Mapping[str, Bone]) -> Skeleton:
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
