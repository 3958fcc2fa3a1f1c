"""Arrays in one `.npz` file: written whole, and unpacked only where it holds what it claims.

Such a file holds no code: it is safe to read one from a stranger. What it claims, in the directory of the
`.zip` and in the headers of its arrays, is compared with what it can hold before anything is unpacked.
"""

import math
import mmap
import re
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from mocap._shared.atomic import replacing
from mocap.errors import FormatError, MocapError

Arrays = dict[str, NDArray[Any]]
RATIO, ROOM = 8, 2**20  # bytes of arrays: at most ROOM, and RATIO for each byte of the file; ours have three
MOST, START, CHUNK = 2**14, 1024, 2**20  # members; bytes that hold a header, and that are unpacked at once
LAST = {"U": 0x10FFFF, "b": 1}  # the largest codes of letters and of truths
HEADER = re.compile(
    rb"\x93NUMPY\x01\x00(..)\{ *'descr': *'([<>|](?:b1|[iu][1248]|f[248]|c8|c16|U\d{1,6}))', *"
    rb"'fortran_order': *(True|False), *'shape': *\(([\d, L]*)\),? *\} *\n",
    re.DOTALL,
)


class Member:
    """An array of a file: `dtype` and `shape` as its header claims them, and `read`, which unpacks it.

    What has no header of an array of numbers, truths or letters is an `object` without a shape.
    """

    def __init__(self, archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> None:
        self.archive, self.entry = archive, entry

    def __str__(self) -> str:
        return f"{self.dtype}{self.shape}"

    @cached_property
    def header(self) -> re.Match[bytes] | None:
        """The header that the array starts with, if it is one."""
        with self.archive.open(self.entry) as packed:
            found = HEADER.match(packed.read(START))
        return found if found and found.end() == 10 + int.from_bytes(found[1], "little") else None

    @property
    def dtype(self) -> np.dtype[Any]:
        """The type of the numbers."""
        return np.dtype(self.header[2].decode() if self.header else object)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape, for which the member has as many bytes as it takes."""
        if not self.header:
            return ()
        shape = tuple(map(int, re.findall(rb"\d+", self.header[4])))
        if self.header.end() + math.prod(shape) * self.dtype.itemsize != self.entry.file_size:
            raise zipfile.BadZipFile
        return shape

    def read(self) -> NDArray[Any]:
        """Unpack the array, in the order and the bytes of this machine."""
        if not self.header:
            raise zipfile.BadZipFile
        shape, data, at = self.shape, np.empty(self.entry.file_size, np.uint8), 0
        with self.archive.open(self.entry) as packed:
            while part := packed.read(CHUNK):  # all at once would take twice the memory
                data[at : at + len(part)] = np.frombuffer(part, np.uint8)
                at += len(part)
        order: Literal["F", "C"] = "F" if self.header[3] == b"True" else "C"
        whole = data[self.header.end() : at].view(self.dtype).reshape(shape, order=order)
        array = whole.astype(self.dtype.newbyteorder("="), "C", copy=False)
        if last := LAST.get(self.dtype.kind):
            codes: NDArray[Any] = array.reshape(-1).view(np.uint32 if last > 1 else np.uint8)
            if np.any((codes > last) | (codes >> 11 == 27)):  # no letter, half of one, no truth
                raise UnicodeError
        return array


def pack(path: str | Path, arrays: Mapping[str, Any]) -> None:
    """Write an `.npz` file, whole or not at all: packed, unless so much would come out that it is refused."""
    with replacing(path) as beside:
        for save in (np.savez_compressed, np.savez):
            with beside.open("wb") as file:
                save(file, allow_pickle=False, **arrays)
            if (
                sum(np.asarray(array).nbytes for array in arrays.values())
                < RATIO * beside.stat().st_size + ROOM
            ):
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
