"""Save a match web to one file: its paths as flat arrays in an `.npz`, its clips by name and fingerprint."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.archives import Arrays, Kind, Layout, read_arrays, write_arrays
from mocap.body.motion import Motion, fingerprint
from mocap.errors import MocapError
from mocap.methods.match_webs.webs import MatchWeb, PathShape

# The arrays of the file, with C clips, N cells and P paths (and so P + 1 offsets, X).
ARRAYS: Layout = {
    "names": ("U", ("C",)),
    "fingerprints": ("U", ("C",)),
    "lengths": ("i", ("C",)),  # of each clip in frames of the web; 0 for one that was too short
    "numbers": ("f", (2,)),  # rate and below
    "window": ("i", ()),
    "shape": ("f", (4,)),
    "cells": ("i", ("N", 2)),
    "costs": ("f", ("N",)),
    "offsets": ("i", ("X",)),
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
    arrays = {
        "names": [clip.name for clip in web.clips],
        "fingerprints": [fingerprint(clip) for clip in web.clips],
        "lengths": np.diff(web.starts),
        "numbers": [web.rate, web.below],
        "window": web.window,
        "shape": web.shape,
        "cells": web.cells,
        "costs": web.costs,
        "offsets": web.offsets,
    }
    write_arrays(path, WEB, arrays)


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
    _require_clips(path, arrays, clips)
    rate, below = arrays["numbers"].tolist()
    slope, *shape = arrays["shape"].tolist()
    return MatchWeb(
        tuple(clips),
        np.cumsum([0, *arrays["lengths"]]),
        rate,
        int(arrays["window"]),
        below,
        PathShape(int(slope), *shape),
        arrays["cells"],
        arrays["costs"],
        arrays["offsets"],
    )


def _require_clips(path: str | Path, arrays: Arrays, clips: Sequence[Motion]) -> None:
    names = arrays["names"].tolist()
    if len(names) != len(clips):
        raise MocapError(f"{path} was built of {len(names)} clips, got {len(clips)}.")
    for name, known, clip in zip(names, arrays["fingerprints"].tolist(), clips, strict=True):
        if fingerprint(clip) != known:
            raise MocapError(
                f"{path} was built of '{name}', not of this '{clip.name}': take that clip, or build anew."
            )


def _rules(arrays: Arrays) -> Iterator[tuple[str, ArrayLike]]:
    """Yield what must hold; each rule needs those before it."""
    cells, offsets, lengths = arrays["cells"], arrays["offsets"], arrays["lengths"]
    yield "rate and distance are above 0", (arrays["numbers"] > 0) & (arrays["numbers"] < np.inf)
    yield "the window has frames", arrays["window"] > 0
    slope, *others = arrays["shape"].tolist()
    yield "paths have a shape", [slope >= 1, *(0 <= number < np.inf for number in others)]
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


WEB = Kind("a match web", 1, ARRAYS, _rules)
