"""Arrays in one `.npz` file: written whole, and unpacked only where it holds what it claims.

Such a file holds no code: it is safe to read one from a stranger. What it claims, in the directory of the
`.zip` and in the headers of its arrays, is compared with what it can hold before anything is unpacked.
"""

import math
import mmap
import re
import warnings
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.lib.format as npy
from numpy.typing import NDArray

from mocap._shared.atomic import replacing
from mocap.errors import FormatError, MocapError

Arrays = dict[str, NDArray[Any]]
ROOM = 2**20  # bytes of arrays that any file may hold
RATIO = 8  # bytes of arrays besides, for each byte of the file; ours have three
MOST = 2**14  # members
LAST = {"U": 0x10FFFF, "b": 1}  # the largest codes of letters and of truths


class Member:
    """An array of a file: `dtype` and `shape` as its header claims them, and `read`, which unpacks it.

    What has no header of an array of numbers, truths or letters is an `object` without a shape.
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
        """Unpack the array, in the byte order of this machine and the rows one after the other."""
        if not self.fits:
            raise zipfile.BadZipFile
        with self.archive.open(self.entry) as packed, warnings.catch_warnings(action="ignore"):
            whole = npy.read_array(packed, allow_pickle=False)
        array = whole.astype(self.dtype.newbyteorder("="), "C", copy=False)
        if last := LAST.get(self.dtype.kind):
            codes: NDArray[Any] = array.reshape(-1).view(np.uint32 if last > 1 else np.uint8)
            if np.any((codes > last) | (codes >> 11 == 27)):  # no letter, half of one, no truth
                raise UnicodeError
        return array


def pack(path: str | Path, arrays: Mapping[str, Any]) -> None:
    """Write an `.npz` file, whole or not at all: packed, unless so much would come out that it is refused."""
    with replacing(path) as new:
        for save in (np.savez_compressed, np.savez):
            with new.open("wb") as file:
                save(file, allow_pickle=False, **arrays)
            room = RATIO * new.stat().st_size + ROOM
            if sum(np.asarray(array).nbytes for array in arrays.values()) < room:
                break


@contextmanager
def open_archive(path: str | Path, ours: str, room: int = ROOM) -> Iterator[dict[str, Member]]:
    """Open an `.npz` file, and give what its members claim to be.

    Parameters
    ----------
    path : the file.
    ours : says, for the error, what it should be. Whatever fails within the block, the file is damaged.
    room : bytes that its arrays may take however small the file is.

    Raises
    ------
    MocapError : where the file cannot be read.
    FormatError : where it is no such file, or claims what it cannot hold.
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
    """Check the directory of an archive; nothing is unpacked yet."""
    entries = sorted(archive.infolist(), key=lambda entry: entry.header_offset)
    ends = [entry.header_offset + 30 + len(entry.filename) + entry.compress_size for entry in entries]
    starts = [*(entry.header_offset for entry in entries[1:]), archive.start_dir]
    odd = any(entry.flag_bits & 1 or entry.compress_type not in (0, 8) for entry in entries)
    twice = len({entry.filename.removesuffix(".npy") for entry in entries}) < len(entries)
    overlapping = any(end > start for end, start in zip(ends, starts, strict=True))
    if odd or twice or overlapping or sum(entry.file_size for entry in entries) > room:
        raise zipfile.BadZipFile
    return {entry.filename.removesuffix(".npy"): Member(archive, entry) for entry in entries}
