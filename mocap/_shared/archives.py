"""Arrays in one `.npz` file that says what it holds: written whole, and read only where everything fits.

Such a file holds no code: it is safe to read one from a stranger.
"""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.atomic import replacing, require_npz
from mocap.errors import FormatError, MocapError

Arrays = dict[str, NDArray[Any]]
Layout = Mapping[str, tuple[str, tuple[int | str, ...]]]
TYPES = {"U": str, "i": int, "f": float, "c": complex, "b": bool}
FIRST = {"mocap motion graph": "mocap: a motion graph"}  # how the first files say what they hold


def _no_rules(_: Arrays) -> Iterable[tuple[str, ArrayLike]]:
    return ()


class Kind(NamedTuple):
    """What a file holds.

    name : as in "a match web".
    version : of its arrays; a newer one is refused.
    arrays : for each array the letter of its kind in NumPy, and its shape. Sizes of one letter are the same.
    rules : yields what the numbers must keep, as sentences with booleans; each may need those before it.
    """

    name: str
    version: int
    arrays: Layout
    rules: Callable[[Arrays], Iterable[tuple[str, ArrayLike]]] = _no_rules


def write_arrays(path: str | Path, kind: Kind, arrays: Mapping[str, Any]) -> None:
    """Write arrays to an `.npz` file; an old file is replaced when the new one is complete.

    Parameters
    ----------
    path : the file.
    kind : what it holds.
    arrays : one for each name of the kind; lists become arrays of that kind.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.

    Examples
    --------
    >>> write_arrays("web.txt", Kind("a match web", 1, {}), {})
    Traceback (most recent call last):
    mocap.errors.MocapError: This is written as .npz, got 'web.txt'.
    """
    require_npz(path)
    whole: Arrays = {"format": np.array(f"mocap: {kind.name}"), "version": np.array(kind.version)}
    for key, (letter, _) in kind.arrays.items():
        array = np.asarray(arrays[key])
        whole[key] = array if array.dtype.kind == letter else array.astype(TYPES[letter])
    with replacing(path) as beside, beside.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **whole)


def read_arrays(path: str | Path, kind: Kind) -> Arrays:
    """Read what `write_arrays` wrote.

    Parameters
    ----------
    path : the file.
    kind : what it should hold.

    Raises
    ------
    MocapError : where the file cannot be read.
    FormatError : for files of another kind, of a newer version, and damaged ones.

    Examples
    --------
    >>> read_arrays("no.npz", Kind("a match web", 1, {}))
    Traceback (most recent call last):
    mocap.errors.MocapError: Cannot read no.npz: No such file or directory.
    """
    ours = f"{kind.name} saved by mocap, version {kind.version}"
    arrays = open_arrays(path, ours, ("format", "version", *kind.arrays))
    try:
        name, version = str(arrays.pop("format")), int(arrays.pop("version"))
    except (KeyError, TypeError, ValueError):
        raise FormatError(path, None, ours, "a file of another kind, or a damaged one") from None
    if FIRST.get(name, name) != f"mocap: {kind.name}":
        raise FormatError(path, None, ours, "an .npz of another kind")
    if version > kind.version:
        raise FormatError(path, None, ours, f"version {version}, which a newer mocap wrote")
    if missing := [key for key in kind.arrays if key not in arrays]:
        raise FormatError(path, None, ours, f"one without {', '.join(missing)}")
    _check(path, kind, arrays)
    for what, holds in kind.rules(arrays):
        if not np.all(holds):
            raise FormatError(path, None, f"that {what}", "a damaged file")
    return arrays


def open_arrays(path: str | Path, ours: str, keys: Iterable[str]) -> Arrays:
    """Read those of some arrays that an `.npz` file has; `ours` says, for the error, what it should be.

    Raises
    ------
    MocapError : where the file cannot be read.
    FormatError : where it is no such file.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {key: archive[key] for key in keys if key in archive}
    except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
        raise MocapError(f"Cannot read {path}: {error.strerror}.") from error
    except Exception as error:  # NumPy raises many kinds of errors for other files
        raise FormatError(path, None, ours, "a file of another kind, or a damaged one") from error


def _check(path: str | Path, kind: Kind, arrays: Arrays) -> None:
    """Raise unless every array has its kind and shape."""
    sizes: dict[str, int] = {}
    for key, (letter, shape) in kind.arrays.items():
        array = arrays[key]
        fits = len(shape) == array.ndim and array.dtype.kind == letter
        for name, size in zip(shape, array.shape, strict=False):
            fits &= size == (sizes.setdefault(name, size) if isinstance(name, str) else name)
        if not fits:
            raise FormatError(path, None, f"'{key}' to fit the other arrays", f"{array.dtype}{array.shape}")
