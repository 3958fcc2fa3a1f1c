"""Acclaim motions (`.amc`) of an Acclaim skeleton.

A file has some keywords, then frames: a line with the frame's number, and a line for each bone with a number
for each of its degrees of freedom. Nearly all files repeat the first frame's pattern to the end, so whole
columns of words are read at once; any other is read line by line, which finds the line of an error. They
give a bone's rotation M as angles about the bone's own axes. The ASF file turns these axes by C against the
world, so a joint's rotation in its parent's frame is L = C M C⁻¹.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import chain
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.motion import Motion
from mocap.errors import FormatError
from mocap.files.asf import MOVES, TURNS, AcclaimSkeleton
from mocap.files.recordings import Recording
from mocap.files.text import check_room, lines, quick_numbers, read_text, to_numbers

CMU_RATE = 120.0  # frames per second in most of the CMU database
FIRST = re.compile(r"^[ \t]*\d+[ \t]*$", re.MULTILINE)  # the number of a frame


def read(path: str | Path, asf: AcclaimSkeleton, *, fps: float | None = None) -> Recording:
    """Read an AMC file.

    The root's position is its position at rest + T; its rotation is M O, with O its orientation at rest.

    Parameters
    ----------
    path : the file.
    asf : its skeleton.
    fps : frames per second; by default those of a first line "# fps 30", else CMU's 120.

    Raises
    ------
    FormatError : with the line that breaks the format or does not fit the skeleton.
    """
    numbers, unit, rate = _read_frames(path, asf)
    angles = {name: unit * block[:, asf.bones[name].turns] for name, block in numbers.items()}
    frames = len(numbers["root"])
    check_room(path, frames * len(asf.skeleton), sum(block.size for block in numbers.values()))
    local = np.tile(rotations.IDENTITY, (frames, len(asf.skeleton), 1))
    moves = np.zeros((frames, 3))
    for name, block in numbers.items():
        bone = asf.bones[name]
        own = np.tile(rotations.IDENTITY, (frames, 1))
        if bone.turns:
            own = euler.from_euler(bone.order, np.radians(angles[name]))
        turned = rotations.multiply(own, bone.axis)
        if name != "root":  # L = C M C⁻¹
            turned = rotations.multiply(bone.axis, rotations.multiply(own, rotations.inverse(bone.axis)))
        local[:, asf.skeleton.index(name)] = turned
        for dof, column in zip(bone.dofs, block.T, strict=True):
            if name == "root" and dof in MOVES:
                moves[:, MOVES.index(dof)] = column
            elif dof not in TURNS and column.any():
                frame, expected = int((column != 0).argmax()), "since bones keep their lengths"
                got = f"{column[frame]:g} in frame {frame}"
                raise FormatError(path, None, f"0 for '{dof}' of '{name}', {expected}", got)
    places = asf.bones["root"].vector + moves * asf.unit
    motion = Motion(asf.skeleton, places, local, fps or rate or CMU_RATE, Path(path).stem)
    return Recording(motion, angles, {})


def first_frame(text: str) -> dict[str, int]:
    """Count the numbers that the first frame of an AMC file's text has for each bone."""
    counts: dict[str, int] | None = None
    for _, (name, *numbers) in lines(text):
        if name.isdecimal():
            if counts is not None:
                break
            counts = {}
        elif counts is not None:
            counts[name] = len(numbers)
    return counts or {}


def fits(counts: Mapping[str, int], asf: AcclaimSkeleton) -> bool:
    """Check whether a frame with these counts of numbers is one of this skeleton."""
    known = {name: len(bone.dofs) for name, bone in asf.bones.items()}
    return counts.items() <= known.items() and set(asf.needed()) <= set(counts)


def _read_frames(path: str | Path, asf: AcclaimSkeleton) -> tuple[dict[str, Array], float, float | None]:
    """Read the numbers (F, dofs) of each bone, the degrees that an angle of 1 has, and the rate, if told."""
    text = read_text(path)
    start = FIRST.search(text)
    head, frames = (text[: start.start()], text[start.start() :]) if start else (text, "")
    keywords = {words[0].upper() for _, words in lines(head)}
    counts = first_frame(frames)
    usual = fits(counts, asf) and "#" not in frames and all(word[0] == ":" for word in keywords)
    numbers = (_by_columns(frames, counts) if usual else None) or _by_lines(path, text, asf)
    in_degrees = ":RADIANS" not in keywords and (asf.degrees or ":DEGREES" in keywords)
    fps, words = None, text.partition("\n")[0].split()
    if words[:2] == ["#", "fps"] and len(words) == 3:  # the format has no frame rate: a comment tells it
        fps = float(to_numbers(path, 1, words[2:], "frames per second, above 0", 1)[0])
        if fps <= 0:
            raise FormatError(path, 1, "frames per second, above 0", words[2])
    return {name: numbers[name] for name in asf.needed()}, 1.0 if in_degrees else np.degrees(1.0), fps


def _by_columns(frames: str, counts: Mapping[str, int]) -> dict[str, Array] | None:
    """Read whole columns of words, where all frames have the first one's pattern; None where not."""
    words, pattern = frames.split(), [""]
    for name, count in counts.items():
        pattern += [name, *[""] * count]
    columns = [words[place :: len(pattern)] for place in range(len(pattern))]
    alike = all(set(column) == {name} for name, column in zip(pattern, columns, strict=True) if name)
    if len(words) % len(pattern) or not alike or not all(map(str.isdecimal, columns[0])):
        return None
    found = [column for name, column in zip(pattern, columns, strict=True) if not name]
    numbers = quick_numbers([*chain.from_iterable(found)])
    if numbers is None or (np.diff(numbers[: len(columns[0])]) != 1).any():
        return None
    table = numbers.reshape(len(found), -1)[1:].T
    return dict(zip(counts, np.split(table, np.cumsum([*counts.values()])[:-1], axis=1), strict=True))


def _by_lines(path: str | Path, text: str, asf: AcclaimSkeleton) -> dict[str, Array]:
    """Read any file line by line, and raise at the first line that is wrong."""
    frames: list[dict[str, Array]] = []
    line = number = 0
    for line, (name, *words) in lines(text):
        complete = f" after {len(frames) - 1} complete frames"
        if not words and name.isdecimal() and len(name) < 10:
            if frames:
                _require_whole(path, line, frames, asf)
                if int(name) != number + 1:
                    raise FormatError(path, line, f"frame {number + 1}", f"frame {name}")
            number = int(name)
            frames.append({})
        elif frames:
            if name not in asf.bones or name in frames[-1]:
                raise FormatError(path, line, "another bone of the skeleton", f"'{name}'{complete}")
            dofs = asf.bones[name].dofs
            expected = f"{len(dofs)} numbers for '{name}' ({' '.join(dofs)}){complete}"
            frames[-1][name] = to_numbers(path, line, words, expected, len(dofs))
        elif not name.startswith(":"):
            raise FormatError(path, line, "the number of the first frame", f"'{' '.join([name, *words])}'")
    if not frames:
        raise FormatError(path, None, "frames", "none")
    _require_whole(path, line, frames, asf)
    return {name: np.array([frame[name] for frame in frames]) for name in asf.needed()}


def _require_whole(path: str | Path, line: int, frames: list[dict[str, Array]], asf: AcclaimSkeleton) -> None:
    if missing := [name for name in asf.needed() if name not in frames[-1]]:
        more = f" and {len(missing) - 3} more bones" if len(missing) > 3 else ""
        got = f"the end of the frame after {len(frames) - 1} complete frames"
        raise FormatError(path, line, f"numbers for {', '.join(missing[:3])}{more}", got)
