"""Arrays in `.npz` files: written atomically, and checked before they are unpacked.

Such a file contains no code, and files from untrusted sources are safe to read. The sizes in the directory of
the `.zip` and in the headers of its arrays are checked against the size of the file before anything is
unpacked.

A `Kind` describes the files of one kind, such as saved motion graphs, by their arrays and validity rules.
`write_archive` and `read_archive` both enforce it, so that every file that is written can be read again.
"""

import math
import mmap
import re
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.lib.format as npy
from numpy.typing import ArrayLike, NDArray

from mocap._shared.atomic import replacing
from mocap.errors import FormatError, MocapError, Remedy

Arrays = dict[str, NDArray[Any]]
Layout = Mapping[str, tuple[type, tuple[int | str, ...]]]
"""The type and the shape of each array. A letter is a size that is the same in the whole file."""
Rules = Iterator[tuple[str, ArrayLike]]
"""Validity rules, each a sentence and booleans that must all be true. A rule may assume those before it."""
ROOM = 2**20  # bytes of arrays that a file of any size may contain
RATIO = 8  # further bytes of arrays for each byte of the file (about three in those written here)
MOST = 2**14  # members
LAST = {"U": 0x10FFFF, "b": 1}  # the largest codes of characters and of booleans

# The kinds of files, and the functions that read them.
AMASS = "an AMASS archive"
MOTION = "a motion"
LOADERS = {
    AMASS: "mocap.load",
    MOTION: "mocap.load",
    "a motion graph": "graphs.load",
    "a packed motion graph": "graphs.load",
    "a match web": "match_webs.load_web",
    "a parametric motion graph": "parametric_graphs.load_parametric",
    "a group motion graph": "groups.load_group",
}
FORMER_HEADS = {"mocap motion graph": "mocap: a motion graph"}  # of files of the first version


class Member:
    """An array of a file: `dtype` and `shape` from its header, and `read`, which unpacks it.

    A member that is not an array of numbers, booleans or characters has the dtype `object` and no shape.
    """

    def __init__(self, archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> None:
        self.archive = archive
        self.entry = entry
        self.shape: tuple[int, ...] = ()
        self.dtype = np.dtype(object)
        self.fits = False
        with archive.open(entry) as packed, suppress(ValueError), warnings.catch_warnings(action="ignore"):
            if npy.read_magic(packed) == (1, 0):
                shape, _, dtype = npy.read_array_header_1_0(packed)
                if dtype.kind in "biufcU":
                    self.shape = shape
                    self.dtype = dtype
                    self.fits = packed.tell() + math.prod(shape) * dtype.itemsize == entry.file_size

    def __str__(self) -> str:
        return f"{self.dtype}{self.shape}"

    def read(self) -> NDArray[Any]:
        """Unpack the array, in native byte order and C order."""
        if not self.fits:
            raise zipfile.BadZipFile
        with self.archive.open(self.entry) as packed, warnings.catch_warnings(action="ignore"):
            whole = npy.read_array(packed, allow_pickle=False)
        array = whole.astype(self.dtype.newbyteorder("="), "C", copy=False)
        if not _is_text(array):
            raise UnicodeError
        return array


def _is_text(array: NDArray[Any]) -> bool:
    """Return whether all characters of an array of texts are Unicode, and all booleans 0 or 1."""
    last = LAST.get(array.dtype.kind)
    if last is None or array.dtype.itemsize == 0:
        return True
    codes: NDArray[Any] = np.ascontiguousarray(array).reshape(-1).view(np.uint32 if last > 1 else np.uint8)
    is_surrogate = codes >> 11 == 27
    return not np.any((codes > last) | is_surrogate)


def pack(path: str | Path, arrays: Mapping[str, Any]) -> None:
    """Write an `.npz` file atomically, compressed unless the ratio would be too large for reading."""
    members: dict[str, Any] = {name: np.asarray(array) for name, array in arrays.items()}
    if any(array.dtype.hasobject for array in members.values()):
        raise TypeError("an archive holds numbers, truths and texts, and no Python objects")
    size = sum(array.nbytes for array in members.values())
    with replacing(path) as new:
        for save in (np.savez_compressed, np.savez):
            with new.open("wb") as file:
                save(file, **members)
            if size < RATIO * new.stat().st_size + ROOM:
                break


@contextmanager
def open_archive(path: str | Path, ours: str, room: int = ROOM) -> Iterator[dict[str, Member]]:
    """Open an `.npz` file and yield its members, by name.

    Parameters
    ----------
    path : the file.
    ours : the description of the expected file, for the error. Any failure within the block is reported as a
        damaged file.
    room : bytes that the arrays of a file of any size may take.

    Raises
    ------
    MocapError : if the file cannot be read.
    FormatError : if it is not an `.npz` file, or the sizes of its members are implausible.
    """
    try:
        with Path(path).open("rb") as file, np.errstate(all="ignore"):
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                crowded = sum(1 for _ in re.finditer(rb"PK\x01\x02", data)) > MOST
                room += RATIO * len(data)
            if crowded:
                raise zipfile.BadZipFile
            with zipfile.ZipFile(file) as archive:
                yield _members(archive, room)
    except MocapError:
        raise
    except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
        raise MocapError(f"Cannot read {path}: {error.strerror}.") from error
    except Exception as error:  # zipfile, zlib and NumPy raise many kinds of errors
        raise FormatError(path, None, ours, "a file of another kind, or a damaged one") from error


def _members(archive: zipfile.ZipFile, room: int) -> dict[str, Member]:
    """Check the directory of an archive, without unpacking anything."""
    entries = sorted(archive.infolist(), key=lambda entry: entry.header_offset)
    ends = [entry.header_offset + 30 + len(entry.filename) + entry.compress_size for entry in entries]
    starts = [*(entry.header_offset for entry in entries[1:]), archive.start_dir]
    odd = any(entry.flag_bits & 1 or entry.compress_type not in (0, 8) for entry in entries)
    twice = len({entry.filename.removesuffix(".npy") for entry in entries}) < len(entries)
    overlapping = any(end > start for end, start in zip(ends, starts, strict=True))
    if odd or twice or overlapping or sum(entry.file_size for entry in entries) > room:
        raise zipfile.BadZipFile
    return {entry.filename.removesuffix(".npy"): Member(archive, entry) for entry in entries}


Shaped = NDArray[Any] | Member


class Part(NamedTuple):
    """Arrays that a file contains several times, numbered from 0, such as those of each node.

    `number` is the name of the size that counts them. In `arrays`, lower-case sizes may differ between parts.

    Examples
    --------
    >>> Part("N", {"grid": (float, ("g",)), "heights": (float, ("g",))}).number
    'N'
    """

    number: str
    arrays: Layout


@dataclass(frozen=True)
class Kind:
    """A kind of files, described by its arrays and validity rules.

    Parameters
    ----------
    name : such as "a match web"; a key of `LOADERS`. The array `format` of a file is "mocap: " and the name.
    arrays : the layout of the arrays, by name.
    rules : a function that yields the validity rules for all arrays of a file.
    parts : by name. Array `key` of part 3 of "node" is called "node_3_key".
    version : the version of the layout. Files of a later one are refused.
    added : arrays that were added to the layout, by their key, and the version since which files have them.

    Examples
    --------
    >>> Kind("a match web", {"costs": (float, ("N",))}, lambda arrays: iter(()), version=2).wanted
    'a match web saved by mocap, version 1 or 2'
    """

    name: str
    arrays: Layout
    rules: Callable[[Arrays], Rules]
    parts: Mapping[str, Part] = field(default_factory=dict)
    version: int = 1
    added: Mapping[str, int] = field(default_factory=dict)

    @property
    def wanted(self) -> str:
        """The description of the expected file, for errors."""
        *earlier, last = map(str, range(1, self.version + 1))
        versions = f"{', '.join(earlier)} or {last}" if earlier else last
        return f"{self.name} saved by mocap, version {versions}"

    def part(self, arrays: Arrays, name: str, number: int) -> Arrays:
        """Extract the arrays of one part from those of a file; `numbered` is the inverse."""
        keys = {f"{name}_{number}_{key}": key for key in self.parts[name].arrays}
        return {key: arrays[whole_key] for whole_key, key in keys.items() if whole_key in arrays}

    def layout_of(self, layout: Layout, version: int) -> Layout:
        """Return the part of a layout that files of a version have."""
        return {key: row for key, row in layout.items() if self.added.get(key, 1) <= version}

    def fits(self, arrays: Mapping[str, Shaped], version: int) -> Iterator[tuple[str, type, bool]]:
        """Yield the name and type of each array of a version, and whether the shape of that in `arrays` fits.

        Parts follow the other arrays, whose shapes determine their number. Iterate further only if an array
        fits.
        """
        sizes: dict[str, int] = {}
        for key, (kind, shape) in self.layout_of(self.arrays, version).items():
            yield key, kind, _has_shape(arrays.get(key), shape, sizes)
        for name, part in self.parts.items():
            for number in range(sizes[part.number]):
                of_part = f"{name}_{number}_"
                for key, (kind, shape) in self.layout_of(part.arrays, version).items():
                    named = tuple(_in_part(size, of_part) for size in shape)
                    yield of_part + key, kind, _has_shape(arrays.get(of_part + key), named, sizes)


def numbered(name: str, number: int, arrays: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arrays of one part with their names in the file.

    Examples
    --------
    >>> numbered("node", 3, {"grid": [0.0, 1.0]})
    {'node_3_grid': [0.0, 1.0]}
    """
    return {f"{name}_{number}_{key}": array for key, array in arrays.items()}


def _in_part(size: int | str, of_part: str) -> int | str:
    """Prefix a lower-case size with the name of its part, which makes it local to the part."""
    return of_part + size if isinstance(size, str) and size.islower() else size


def _has_shape(
    array: NDArray[Any] | Member | None, shape: tuple[int | str, ...], sizes: dict[str, int]
) -> bool:
    """Check the shape of an array or `Member` against named sizes. New names are added to `sizes`."""
    if array is None or len(array.shape) != len(shape):
        return False
    for size, actual in zip(shape, array.shape, strict=True):
        expected = sizes.setdefault(size, actual) if isinstance(size, str) else size
        if actual != expected:
            return False
    return True


def write_archive(path: str | Path, kind: Kind, arrays: Mapping[str, Any]) -> None:
    """Write the arrays of a kind to an `.npz` file atomically.

    Raises
    ------
    MocapError : for another suffix, arrays that could not be read again, and a file that cannot be written.

    Examples
    --------
    >>> web = Kind("a match web", {"costs": (float, ("N",))}, lambda arrays: iter(()))
    >>> write_archive("web.txt", web, {"costs": [0.1, 0.2]})
    Traceback (most recent call last):
    mocap.errors.MocapError: This is written as .npz, got 'web.txt'.
    """
    if Path(path).suffix.lower() != ".npz":
        raise MocapError(f"This is written as .npz, got '{path}'.")
    exact = {key: np.asarray(array) for key, array in arrays.items()}
    whole: Arrays = {}
    for key, dtype, fits in kind.fits(exact, kind.version):
        if not fits:
            raise MocapError(f"Cannot save {kind.name}: '{key}' does not fit its other arrays.")
        whole[key] = exact[key].astype(dtype)
        if not np.array_equal(whole[key], exact[key]):
            raise MocapError(f"Cannot save {kind.name}: '{key}' holds values that {dtype.__name__} has not.")
        if not _is_text(whole[key]):
            raise MocapError(f"Cannot save {kind.name}: '{key}' holds characters that are not Unicode text.")
    for rule, holds in kind.rules(whole):
        if not np.all(holds):
            raise MocapError(f"Cannot save {kind.name}: expected that {rule}.")
    pack(path, {"format": np.array(f"mocap: {kind.name}"), "version": np.array(kind.version), **whole})


def read_archive(path: str | Path, kind: Kind, room: int = ROOM) -> Arrays:
    """Read the arrays of a file from `write_archive`, and its `version`.

    A file of an earlier version does not have the arrays that were added later.

    Parameters
    ----------
    path, room : as for `open_archive`.
    kind : the kind of the file.

    Raises
    ------
    MocapError : if the file cannot be read.
    FormatError : for a file of another kind, with the function that reads it, for a later version, and for
        a damaged file.

    Examples
    --------
    >>> read_archive("gone.npz", Kind("a match web", {}, lambda arrays: iter(())))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read gone.npz: No such file or directory.
    """
    with open_archive(path, kind.wanted, room) as members:
        if kind_of(members) != kind.name:
            raise other_kind(path, kind.wanted, members)
        if members["version"].shape != ():
            raise FormatError(path, None, "a version that is one number", "several")
        version = int(members["version"].read())
        if version > kind.version:
            raise FormatError(path, None, kind.wanted, f"version {version}, which a newer mocap wrote")
        arrays = {key: members[key].read() for key in _checked(path, kind, members, version)}
        for rule, holds in kind.rules(arrays):
            if not np.all(holds):
                raise FormatError(path, None, f"that {rule}", "a damaged file")
    return arrays | {"version": np.array(version)}


def kind_of(members: Mapping[str, Member]) -> str:
    """Return the kind of a file by its array `format`, or by the names of its arrays; "" if unknown."""
    if "format" in members and members["format"].shape == ():
        head = str(members["format"].read())
        return FORMER_HEADS.get(head, head).removeprefix("mocap: ")
    return AMASS if {"poses", "trans"} <= set(members) else ""


def other_kind(path: str | Path, expected: str, members: Mapping[str, Member]) -> FormatError:
    """Return the error for a file of another kind, with the function that reads it.

    Parameters
    ----------
    path : the file.
    expected : the description of the expected file.
    members : the arrays of the file, by name.
    """
    kind = kind_of(members)
    if kind not in LOADERS:
        return FormatError(path, None, expected, "an .npz of another kind")
    return FormatError(path, None, expected, kind, remedy=Remedy(f"{LOADERS[kind]} reads it"))


def _checked(path: str | Path, kind: Kind, members: Mapping[str, Member], version: int) -> list[str]:
    """List the names of all arrays of a version. Raise at the first that is missing or does not fit."""
    keys = []
    for key, dtype, fits in kind.fits(members, version):
        if key not in members:
            raise FormatError(path, None, kind.wanted, f"one without {key}")
        if not fits or members[key].dtype.kind != np.dtype(dtype).kind:
            raise FormatError(path, None, f"'{key}' to fit the other arrays", str(members[key]))
        keys.append(key)
    return keys
