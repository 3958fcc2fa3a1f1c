"""The numbers in an AMC file, bone by bone; `acclaim` knows what they mean.

A file has some keywords, then frames: a line with the frame's number, and a line for each bone with a number
for each of its degrees of freedom. Nearly all files repeat the first frame's pattern to the end, so whole
columns of words can be read at once. Any other file is read line by line, which finds the line of an error.
"""

from collections.abc import Collection, Mapping
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.errors import FormatError
from mocap.files.text import lines, quick_numbers, read_text, to_numbers

Dofs = Mapping[str, Collection[str]]


class Frames(NamedTuple):
    """An AMC file: the `keywords` before its frames, in capitals, and `numbers` (F, dofs) for each bone.

    The format has no frame rate; `fps` is the rate in a comment, or None.
    """

    keywords: set[str]
    numbers: dict[str, Array]
    fps: float | None


def read_frames(path: str | Path, dofs: Dofs, needed: Collection[str]) -> Frames:
    """Read all numbers of an AMC file.

    Parameters
    ----------
    path : the file.
    dofs : the degrees of freedom of every bone, "root" among them.
    needed : the bones that each frame must name.

    Returns
    -------
    The keywords, and for each bone named an array (F, number of dofs), in the file's units.

    Raises
    ------
    FormatError : with the line that breaks the format or does not fit the bones.
    """
    text = read_text(path)
    keywords, start, counts = _opening(text)
    usual = fits(counts, dofs, needed) and all(word.startswith(":") for word in keywords)
    numbers = _read_columns(text.split("\n", start)[-1], counts) if usual else None
    if numbers is None:
        numbers = _read_lines(path, text, dofs, needed)
    fps, words = None, text.partition("\n")[0].split()
    if words[:2] == ["#", "fps"] and len(words) == 3:  # as `save` writes it
        fps = float(to_numbers(path, 1, words[2:], "frames per second, above 0", 1)[0])
        if fps <= 0:
            raise FormatError(path, 1, "frames per second, above 0", words[2])
    return Frames(keywords, numbers, fps)


def first_frame(path: str | Path) -> dict[str, int]:
    """Count the numbers that the first frame of an AMC file has for each bone."""
    return _opening(read_text(path, most=100_000))[2]


def fits(counts: Mapping[str, int], dofs: Dofs, needed: Collection[str]) -> bool:
    """Check whether a frame with these counts of numbers is one of these bones.

    Examples
    --------
    >>> fits({"root": 3, "knee": 1}, {"root": ("tx", "ty", "tz"), "knee": ("rx",)}, ["root", "knee"])
    True
    """
    known = all(name in dofs and len(dofs[name]) == count for name, count in counts.items())
    return known and set(needed) <= set(counts)


def _opening(text: str) -> tuple[set[str], int, dict[str, int]]:
    """Read the keywords, count their lines, and count the first frame's numbers for each bone."""
    keywords: set[str] = set()
    counts: dict[str, int] = {}
    start = None
    for line, words in lines(text):
        if start is not None and words[0].isdecimal():
            break
        if start is not None:
            counts[words[0]] = len(words) - 1
        elif words[0].isdecimal():
            start = line - 1
        else:
            keywords.add(words[0].upper())
    return keywords, start or 0, counts


def _read_columns(text: str, counts: Mapping[str, int]) -> dict[str, Array] | None:
    """Read a file whose frames all have the first one's pattern; None if not, or for a wrong number."""
    words = f"{text.strip()}\n".replace("\n", " \0 ").split()  # \0 marks the end of a line
    pattern: list[str | None] = [None]
    for name, count in counts.items():
        pattern += ["\0", name, *[None] * count]
    pattern.append("\0")
    width = len(pattern)
    frames = len(words) // width
    for place, word in enumerate(pattern):
        if word is not None and words[place::width] != [word] * frames:
            return None
    columns = [words[place::width] for place, word in enumerate(pattern) if word is None]
    numbers = quick_numbers(list(chain.from_iterable(columns)))
    if numbers is None or not all(map(str.isdecimal, columns[0])):
        return None
    numbers = numbers.reshape(len(columns), frames)
    if np.any(np.diff(numbers[0]) != 1):
        return None
    blocks = np.split(numbers[1:].T, np.cumsum(list(counts.values()))[:-1], axis=1)
    return dict(zip(counts, blocks, strict=True))


def _read_lines(path: str | Path, text: str, dofs: Dofs, needed: Collection[str]) -> dict[str, Array]:
    """Read any file line by line, and raise at the first line that is wrong."""
    frames: list[dict[str, Array]] = []
    line = number = 0
    for line, (name, *words) in lines(text):
        complete = f" after {len(frames) - 1} complete frames"
        if not words and name.isdecimal() and len(name) < 10:
            if frames:
                _check_frame(path, line, frames, needed)
                if int(name) != number + 1:
                    raise FormatError(path, line, f"frame {number + 1}", f"frame {name}")
            number = int(name)
            frames.append({})
        elif frames:
            if name not in dofs or name in frames[-1]:
                raise FormatError(path, line, "another bone of the skeleton", f"'{name}'{complete}")
            expected = f"{len(dofs[name])} numbers for '{name}' ({' '.join(dofs[name])}){complete}"
            frames[-1][name] = to_numbers(path, line, words, expected, len(dofs[name]))
        elif not name.startswith(":"):
            raise FormatError(path, line, "the number of the first frame", f"'{' '.join([name, *words])}'")
    if not frames:
        raise FormatError(path, None, "frames", "none")
    _check_frame(path, line, frames, needed)
    return {name: np.array([frame[name] for frame in frames]) for name in needed}


def _check_frame(
    path: str | Path, line: int, frames: list[dict[str, Array]], needed: Collection[str]
) -> None:
    if missing := [name for name in needed if name not in frames[-1]]:
        got = f"the end of the frame after {len(frames) - 1} complete frames"
        more = f" and {len(missing) - 3} more bones" if len(missing) > 3 else ""
        raise FormatError(path, line, f"numbers for {', '.join(missing[:3])}{more}", got)
