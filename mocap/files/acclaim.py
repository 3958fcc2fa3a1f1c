"""Acclaim motions (`.amc`) of an Acclaim skeleton.

A file has some keywords, then frames: a line with the number of the frame, and a line for each bone with a
number for each of its degrees of freedom. Nearly all files repeat the pattern of the first frame, and are
read by whole columns of words. Any other file is read line by line, which finds the line of an error. The
angles of a bone are its rotation M about the axes of the bone. The ASF file rotates these axes by C relative
to the world, therefore the rotation of a joint in its parent's frame is L = C M C⁻¹.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from itertools import chain
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.errors import FormatError, Remedy, shortened, warn
from mocap.files.asf import MOVES, TURNS, AcclaimSkeleton, Bone
from mocap.files.recordings import Recording
from mocap.files.text import check_room, lines, quick_numbers, read_text, to_numbers, with_decimal_points

CMU_RATE = 120.0  # frames per second in most of the CMU database
FRAME_NUMBER = re.compile(r"^[ \t]*\d+[ \t]*$", re.MULTILINE)
MOST_DIGITS = 9  # of the number of a frame
MOST_MISSING = 0.5  # fraction of a skeleton's bones that a motion may leave out
NAMED = 3  # the largest number of bones that an error names


def read(path: str | Path, asf: AcclaimSkeleton, *, fps: float | None = None) -> Recording:
    """Read an AMC file.

    The position of the root is its rest position + T. Its rotation is M O, where O is its rest orientation.

    Parameters
    ----------
    path : the file.
    asf : its skeleton.
    fps : frames per second, by default from a first line such as "# fps 30", else 120 as in the CMU database.

    Raises
    ------
    FormatError : with the line that breaks the format or does not fit the skeleton.

    Warns
    -----
    MocapWarning : if no frame has numbers for some bones, such as fingers: they keep their rest pose.
    """
    numbers, unit, rate = _read_frames(path, asf)
    angles = {name: unit * block[:, asf.bones[name].rotation_dofs] for name, block in numbers.items()}
    frames = len(numbers["root"])
    check_room(path, frames * len(asf.skeleton), sum(block.size for block in numbers.values()))
    local = np.tile(rotations.IDENTITY, (frames, len(asf.skeleton), 1))
    translations = np.zeros((frames, 3))  # T of the root, in units of the file
    for name, block in numbers.items():
        bone = asf.bones[name]
        local[:, asf.skeleton.index(name)] = _local_rotations(bone, angles[name], is_root=name == "root")
        for dof, column in zip(bone.dofs, block.T, strict=True):
            if name == "root" and dof in MOVES:
                translations[:, MOVES.index(dof)] = column
            elif dof not in TURNS:
                _require_zeros(path, name, dof, column)
    positions = asf.bones["root"].vector + translations * asf.unit
    motion = Motion(asf.skeleton, positions, local, fps or rate or CMU_RATE, Path(path).stem)
    assumed = None
    if fps is None and rate is None:
        assumed = Remedy(f"{CMU_RATE:g} Hz, as an .amc says no rate; {{}} sets another", "fps")
    return Recording(motion, angles, {}, assumed)


def _local_rotations(bone: Bone, angles: Array, *, is_root: bool) -> Array:
    """Compute rotations in the parent's frame, (F, 4), from the angles (F, dofs) of a bone in degrees."""
    rotation = np.tile(rotations.IDENTITY, (len(angles), 1))  # M
    if bone.rotation_dofs:
        rotation = euler.from_euler(bone.order, np.radians(angles))
    if is_root:
        return rotations.multiply(rotation, bone.axis)  # M O
    in_axes = rotations.multiply(rotation, rotations.inverse(bone.axis))
    return rotations.multiply(bone.axis, in_axes)  # L = C M C⁻¹


def _require_zeros(path: str | Path, name: str, dof: str, column: Array) -> None:
    """Raise if a bone is translated or stretched in any frame."""
    if column.any():
        frame = int((column != 0).argmax())
        expected = f"0 for '{dof}' of '{name}', since bones keep their lengths"
        raise FormatError(path, None, expected, f"{column[frame]:g} in frame {frame}")


def first_frame(text: str) -> dict[str, int]:
    """Count the numbers for each bone in the first frame of the text of an AMC file."""
    counts: dict[str, int] | None = None
    for _, (name, *numbers) in lines(text):
        if name.isdecimal():
            if counts is not None:
                break
            counts = {}
        elif counts is not None:
            counts[name] = len(numbers)
    return counts or {}


def missing_bones(counts: Mapping[str, int], asf: AcclaimSkeleton) -> list[str]:
    """List the bones that turn in this skeleton and have no numbers in a frame with these counts."""
    return [name for name in asf.needed() if name not in counts]


def difference(counts: Mapping[str, int], asf: AcclaimSkeleton) -> str:
    """Describe the first difference that keeps a frame from being one of this skeleton; "" if there is none.

    A frame may leave out up to half of the bones: they keep their rest pose [ours].
    """
    for name, count in counts.items():
        if name not in asf.bones:
            return f"no bone '{shortened(name, 30)}'"
        dofs = len(asf.bones[name].dofs)
        if count != dofs:
            return f"{dofs} numbers for '{shortened(name, 30)}', not {count}"
    missing = missing_bones(counts, asf)
    if "root" in missing or len(missing) > MOST_MISSING * len(asf.needed()):
        return f"also {_listed(missing)}"
    return ""


def _listed(names: list[str]) -> str:
    """List the first names, and count the others."""
    remainder = f" and {len(names) - NAMED} more bones" if len(names) > NAMED else ""
    return f"{', '.join(names[:NAMED])}{remainder}"


def _read_frames(path: str | Path, asf: AcclaimSkeleton) -> tuple[dict[str, Array], float, float | None]:
    """Read the numbers (F, dofs) of each bone, the unit of angles in degrees, and the frame rate, if any."""
    text = with_decimal_points(path, read_text(path))
    start = FRAME_NUMBER.search(text)
    head, frames = (text[: start.start()], text[start.start() :]) if start else (text, "")
    keywords = {words[0].upper() for _, words in lines(head)}
    counts = first_frame(frames)
    fits = not difference(counts, asf)
    missing = missing_bones(counts, asf) if fits else []
    usual = fits and "#" not in frames and all(word[0] == ":" for word in keywords)
    numbers = (_by_columns(frames, counts) if usual else None) or _by_lines(path, text, asf, missing)
    if missing:
        warn(f"{path} has no numbers for {_listed(missing)}: they keep their rest pose.")
    in_degrees = ":RADIANS" not in keywords and (asf.degrees or ":DEGREES" in keywords)
    unit = 1.0 if in_degrees else np.degrees(1.0)
    names = [name for name in asf.needed() if name not in missing]
    return {name: numbers[name] for name in names}, unit, _frame_rate(path, text)


def _frame_rate(path: str | Path, text: str) -> float | None:
    """Read the frame rate from a first line such as "# fps 30"; the format itself has no frame rate."""
    match text.partition("\n")[0].split():
        case ["#", "fps", word]:
            fps = float(to_numbers(path, 1, [word], "frames per second, above 0", 1)[0])
            if fps <= 0:
                raise FormatError(path, 1, "frames per second, above 0", word)
            return fps
    return None


def _by_columns(frames: str, counts: Mapping[str, int]) -> dict[str, Array] | None:
    """Read the numbers by whole columns of words; None if a frame differs in pattern from the first one."""
    words = frames.split()
    pattern = [""]  # of a frame: the name of a bone, and an empty text for each number
    for name, count in counts.items():
        pattern += [name, *[""] * count]
    columns = [words[start :: len(pattern)] for start in range(len(pattern))]
    alike = all(set(column) == {name} for name, column in zip(pattern, columns, strict=True) if name)
    if len(words) % len(pattern) or not alike or not all(map(str.isdecimal, columns[0])):
        return None
    columns_of_numbers = [column for name, column in zip(pattern, columns, strict=True) if not name]
    numbers = quick_numbers([*chain.from_iterable(columns_of_numbers)])
    if numbers is None or (np.diff(numbers[: len(columns[0])]) != 1).any():
        return None
    table = numbers.reshape(len(columns_of_numbers), -1)[1:].T  # without the numbers of the frames
    return dict(zip(counts, np.split(table, np.cumsum([*counts.values()])[:-1], axis=1), strict=True))


def _by_lines(
    path: str | Path, text: str, asf: AcclaimSkeleton, missing: Collection[str]
) -> dict[str, Array]:
    """Read a file line by line, and raise at the first invalid line.

    Bones in `missing` are in no frame.
    """
    names = [name for name in asf.needed() if name not in missing]
    bones = {name: bone for name, bone in asf.bones.items() if name not in missing}
    frames: list[dict[str, Array]] = []
    line = number = 0
    for line, (name, *words) in lines(text):
        if not words and name.isdecimal() and len(name) <= MOST_DIGITS:
            if frames:
                _require_whole(path, line, frames, names)
                _require_next(path, line, number, name)
            number = int(name)
            frames.append({})
        elif frames:
            frames[-1][name] = _bone_numbers(path, line, [name, *words], frames, bones)
        elif not name.startswith(":"):
            raise FormatError(path, line, "the number of the first frame", f"'{' '.join([name, *words])}'")
    if not frames:
        raise FormatError(path, None, "frames", "none")
    _require_whole(path, line, frames, names)
    return {name: np.array([frame[name] for frame in frames]) for name in names}


def _bone_numbers(
    path: str | Path, line: int, words: list[str], frames: list[dict[str, Array]], bones: Mapping[str, Bone]
) -> Array:
    """Read the words of a bone's line: its name, and a number for each degree of freedom."""
    name, *numbers = words
    complete = f" after {len(frames) - 1} complete frames"
    if name not in bones or name in frames[-1]:
        raise FormatError(path, line, "another bone of the skeleton", f"'{name}'{complete}")
    dofs = bones[name].dofs
    expected = f"{len(dofs)} numbers for '{name}' ({' '.join(dofs)}){complete}"
    return to_numbers(path, line, numbers, expected, len(dofs))


def _require_next(path: str | Path, line: int, previous: int, number: str) -> None:
    """Raise if the number of a frame does not follow the previous one."""
    if int(number) != previous + 1:
        raise FormatError(path, line, f"frame {previous + 1}", f"frame {number}")


def _require_whole(path: str | Path, line: int, frames: list[dict[str, Array]], names: list[str]) -> None:
    """Raise if the last frame lacks a bone of these names."""
    if missing := [name for name in names if name not in frames[-1]]:
        got = f"the end of the frame after {len(frames) - 1} complete frames"
        raise FormatError(path, line, f"numbers for {_listed(missing)}", got)
