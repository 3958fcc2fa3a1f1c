"""The skeleton of Acclaim files (`.asf`): bones, their vectors, axes and degrees of freedom.

A joint has the name of the bone that starts there. The children of the root are at the root itself, and a
bone without children ends in the joint `<bone>_end`. The order of axes is extrinsic: XYZ is R = Rz Ry Rx.
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

INCH = 0.0254  # metres
SHORTEST = 1e-6  # the smallest `:units length`, which divides an inch
TURNS = ("rx", "ry", "rz")  # degrees of freedom: rotations
MOVES = ("tx", "ty", "tz")  # degrees of freedom: translations
DEGREES = ("deg", "degrees")
RADIANS = ("rad", "radians")
ORDER = slice(3, None)  # words of an `axis` line: three angles, and their order


class Bone(NamedTuple):
    """A bone: `vector` from its start to its end (3,), metres; `axis` C, a quaternion; `dofs` in file order.

    The root is also a bone, whose vector is its rest position, and whose axis is its rest orientation.
    """

    vector: Array
    axis: Array
    dofs: tuple[str, ...]

    @property
    def rotation_dofs(self) -> list[int]:
        """The indices of its dofs that are rotations."""
        return [index for index, dof in enumerate(self.dofs) if dof in TURNS]

    @property
    def order(self) -> str:
        """The axes of its rotations, in order."""
        return "".join(self.dofs[index][1] for index in self.rotation_dofs)


class AcclaimSkeleton(NamedTuple):
    """A `skeleton`, its `bones` by name, the `unit` of the file in metres, and whether it has `degrees`."""

    skeleton: Skeleton
    bones: Mapping[str, Bone]
    unit: float
    degrees: bool

    def needed(self) -> list[str]:
        """List the bones for which every frame must have numbers, in the order of the skeleton."""
        return [name for name in self.skeleton.names if name in self.bones and self.bones[name].dofs]


def read_skeleton(path: str | Path, *, scale: float | None = None) -> AcclaimSkeleton:
    """Read an ASF file.

    Parameters
    ----------
    path : the file.
    scale : metres in one unit of the file, by default 0.0254 / length, from `:units` in the file.

    Returns
    -------
    The skeleton, with the bones, unit and angles by which AMC files are read. Bones outside the hierarchy are
    not in the skeleton.

    Raises
    ------
    FormatError : with the line that breaks the format.
    """
    sections = _sections(path, read_text(path))
    for key in (":root", ":bonedata", ":hierarchy"):
        if key not in sections:
            raise FormatError(path, None, f"a {key} section", f"only {' '.join(sections)}")
    length, degrees = _units(_Fields(path, sections.get(":units", [])))
    unit = scale or INCH / length
    radians = np.radians(1.0) if degrees else 1.0  # in the unit of an angle
    bones = {"root": _root(_Fields(path, sections[":root"]), unit, radians)}
    for block in _blocks(path, sections[":bonedata"]):
        line, words = block.line("name")
        if len(words) != 1 or words[0] in bones:
            raise FormatError(path, line, "a new bone's name, one word", f"'{' '.join(words)}'")
        bones[words[0]] = _bone(block, unit, radians)
    children = _hierarchy(path, sections[":hierarchy"], bones)
    try:
        skeleton = _skeleton(children, bones)
    except MocapError:
        expected = "bones whose ends have new names"
        raise FormatError(path, None, expected, "a bone called '<another bone>_end'") from None
    return AcclaimSkeleton(skeleton, bones, unit, degrees)


def _sections(path: str | Path, text: str) -> dict[str, list[Line]]:
    """Group the lines by section. Commas and parentheses are white space in an ASF file."""
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
    """The lines of a section or a bone, by their first words. A default replaces a missing line."""

    def __init__(self, path: str | Path, lines: list[Line]) -> None:
        self.path = path
        self.lines = {key.lower(): (number, words) for number, (key, *words) in lines}

    def line(self, key: str, *default: str) -> Line:
        """Return the number and the words of the line with a key, or the default."""
        if key not in self.lines and not default:
            begin = self.lines.get("begin", (None,))[0]
            keys = ", ".join(self.lines) or "nothing"
            raise FormatError(self.path, begin, f"a '{key}' line", f"only {keys}")
        return self.lines.get(key, (0, [*default]))

    def numbers(self, key: str, count: int, *default: str) -> Array:
        """Return the numbers of the line with a key."""
        line, words = self.line(key, *default)
        noun = "number" if count == 1 else "numbers"
        return to_numbers(self.path, line, words[:count], f"{count} {noun} for '{key}'", count)

    def rotation(self, order: list[str], angles: Array) -> Array:
        """Convert angles (radians) about the fixed axes x, y and z, applied in `order`, to a quaternion."""
        axes = "".join(order).lower()
        if sorted(axes) != ["x", "y", "z"]:
            line = self.line("axis", "XYZ")[0]
            raise FormatError(self.path, line, "an order of axes, such as XYZ", f"'{''.join(order)}'")
        return euler.from_euler(axes, angles[["xyz".index(letter) for letter in axes]])

    def dofs(self, key: str, allowed: tuple[str, ...]) -> tuple[str, ...]:
        """Return the degrees of freedom of the line with a key. Raise unless each is allowed and unique."""
        line, words = self.line(key)
        dofs = tuple(word.lower() for word in words)
        if not dofs or set(dofs) - set(allowed) or len(set(dofs)) < len(dofs):
            got = f"'{' '.join(words)}'"
            raise FormatError(self.path, line, f"some of {' '.join(allowed)}, each once", got)
        return dofs


def _units(fields: _Fields) -> tuple[float, bool]:
    """Read the length of an inch in the file's unit, and whether angles are in degrees."""
    length = fields.numbers("length", 1, "1")[0]
    if length < SHORTEST:
        line, _ = fields.line("length")
        raise FormatError(fields.path, line, f"a length of {SHORTEST:g} or more", f"{length:g}")
    line, words = fields.line("angle", "deg")
    angle = " ".join(words).lower()
    if angle not in DEGREES + RADIANS:
        raise FormatError(fields.path, line, "angle deg or rad", f"'{angle}'")
    return length, angle in DEGREES


def _blocks(path: str | Path, lines: list[Line]) -> Iterator[_Fields]:
    """Yield the lines of each bone, from `begin` to `end`."""
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
    """Read the position and the orientation of the root at rest, both 0 by default."""
    position = fields.numbers("position", 3, "0", "0", "0")
    angles = fields.numbers("orientation", 3, "0", "0", "0")
    _, order = fields.line("axis", "XYZ")
    axis = fields.rotation(order, angles * radians)
    return Bone(position * unit, axis, fields.dofs("order", MOVES + TURNS))


def _bone(fields: _Fields, unit: float, radians: float) -> Bone:
    """Read the vector, the axes and the degrees of freedom of a bone, if any."""
    vector = fields.numbers("direction", 3) * fields.numbers("length", 1) * unit
    _, words = fields.line("axis")
    axis = fields.rotation(words[ORDER], fields.numbers("axis", 3) * radians)
    dofs = fields.dofs("dof", (*TURNS, *MOVES, "l")) if "dof" in fields.lines else ()
    return Bone(vector, axis, dofs)


def _hierarchy(path: str | Path, lines: list[Line], bones: Mapping[str, Bone]) -> dict[str, list[str]]:
    """Return the children of each bone that has any."""
    children: dict[str, list[str]] = {}
    orphans = set(bones) - {"root"}  # bones without a parent so far
    for number, (parent, *names) in lines:
        for name in names:  # none after 'begin' and 'end'
            if parent not in bones or name not in orphans:
                got = f"'{name}' below '{parent}'"
                raise FormatError(path, number, "bones of :bonedata, each below one other", got)
            orphans.remove(name)
        if names:
            children.setdefault(parent, []).extend(names)
    if "root" not in children:
        raise FormatError(path, None, "bones below 'root' in :hierarchy", "none")
    return children


def _skeleton(children: Mapping[str, list[str]], bones: Mapping[str, Bone]) -> Skeleton:
    """Build the skeleton from the root, depth first. Bones outside the hierarchy are ignored.

    A bone without children gets a joint at its end, unless its length is 0.
    """
    joints: list[tuple[str, int, Array]] = []
    stack = [("root", -1, np.zeros(3))]  # name, parent, offset
    while stack:
        name, parent, offset = stack.pop()
        vector = bones[name].vector if name in bones and joints else np.zeros(3)  # of the root, a position
        ends = [f"{name}_end"] if np.any(vector) else []
        stack += [(child, len(joints), vector) for child in reversed(children.get(name, ends))]
        joints.append((name, parent, offset))
    names, parents, offsets = zip(*joints, strict=True)
    end = Bone(np.zeros(3), rotations.IDENTITY, ())
    starting = [bones.get(name, end) for name in names]  # the bone that starts at each joint
    # The axis of the root is its rest orientation, not that of its angles.
    axes = [rotations.IDENTITY, *(bone.axis for bone in starting[1:])]
    dofs = [bone.order for bone in starting]
    return Skeleton(names, np.array(parents), np.array(offsets), np.array(axes), dofs)
