"""Save a match web to one file: its paths as flat arrays in an `.npz`, its clips by name and fingerprint."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, read_arrays, write_arrays
from mocap.body.motion import Motion, fingerprint
from mocap.datasets.samples import is_bundled
from mocap.errors import MocapError
from mocap.methods.match_webs.webs import MatchWeb

# The arrays of the file, with C clips, N cells and P paths (and so P + 1 offsets, X), and what is in them.
ARRAYS: dict[str, tuple[str, tuple[int | str, ...], Callable[[MatchWeb], object]]] = {
    "names": ("U", ("C",), lambda web: [clip.name for clip in web.clips]),
    "fingerprints": ("U", ("C",), lambda web: [fingerprint(clip) for clip in web.clips]),
    "lengths": ("i", ("C",), lambda web: np.diff(web.starts)),  # in frames of the web; 0 if too short
    "numbers": ("f", (2,), lambda web: [web.rate, web.below]),
    "window": ("i", (), lambda web: web.window),
    "cells": ("i", ("N", 2), lambda web: web.cells),
    "costs": ("f", ("N",), lambda web: web.costs),
    "offsets": ("i", ("X",), lambda web: web.offsets),
}


def save_web(web: MatchWeb, path: str | Path) -> None:
    """Write a match web to an `.npz` file, without the frames of its clips.

    Parameters
    ----------
    web : as from `build_web`.
    path : the file; an old one is replaced when the new one is complete.

    Raises
    ------
    MocapError : for another suffix, and where the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.webs import build_web
    >>> walk = sample("walk_straight")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_web(build_web([walk], below=0.05), f"{folder}/web.npz")
    ...     load_web(f"{folder}/web.npz", [walk])
    MatchWeb(1 clips, 8 paths, below 5 cm)
    """
    write_arrays(path, WEB, {key: take(web) for key, (_, _, take) in ARRAYS.items()})


def load_web(path: str | Path, clips: Sequence[Motion]) -> MatchWeb:
    """Read a match web, and join it with its clips; `save_web` shows an example.

    Parameters
    ----------
    path : a file from `save_web`.
    clips : the motions that it was built of, in their order.

    Returns
    -------
    The same web, bit for bit.

    Raises
    ------
    FormatError : for a file that is no match web, is damaged, or has a newer version.
    MocapError : for other clips than those that the web was built of.
    """
    arrays = read_arrays(path, WEB)
    names = arrays["names"].tolist()
    if len(names) != len(clips):
        raise MocapError(f"{path} was built of {len(names)} clips, got {len(clips)}.")
    for name, known, clip in zip(names, arrays["fingerprints"].tolist(), clips, strict=True):
        if fingerprint(clip) != known and not (clip.name == name and is_bundled(clip)):
            raise MocapError(
                f"{path} was built of '{name}', not of this '{clip.name}': take that clip, or build anew."
            )
    starts, below = np.cumsum([0, *arrays["lengths"]]), float(arrays["numbers"][1])
    parts = (arrays[key] for key in ("cells", "costs", "offsets"))
    return MatchWeb(tuple(clips), starts, int(arrays["window"]), below, *parts)


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold; each rule needs those before it."""
    cells, offsets, lengths = arrays["cells"], arrays["offsets"], arrays["lengths"]
    yield (
        "its frames are 30 a second, its distances above 0",
        [
            arrays["numbers"][0] == MatchWeb.rate,
            0 < arrays["numbers"][1] < np.inf,
        ],
    )
    yield "the window has frames", arrays["window"] > 0
    yield "clips have lengths", lengths >= 0
    yield "paths begin at the first cell", len(offsets) > 0 and offsets[0] == 0
    yield "paths end at the last cell", offsets[-1] == len(cells)
    yield "no path is empty", np.diff(offsets) > 0
    yield "cells lie in clips", (cells >= 0) & (cells < lengths.sum())
    steps, inner = np.diff(cells, axis=0), np.ones(max(len(cells) - 1, 0), bool)
    inner[offsets[1:-1] - 1] = False
    yield "time never runs backwards", steps[inner] >= 0
    starts = np.cumsum([0, *lengths])
    clip = np.searchsorted(starts, cells, side="right")
    yield "a path stays in its two clips", (np.diff(clip, axis=0)[inner] == 0)
    yield "costs are distances", (arrays["costs"] >= 0) & (arrays["costs"] < np.inf)


WEB = Kind("a match web", 1, {key: row[:2] for key, row in ARRAYS.items()}, _rules)
