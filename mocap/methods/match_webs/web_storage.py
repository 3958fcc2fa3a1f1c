"""Storage of a match web in one file: its paths as arrays in an `.npz`, its clips by name and fingerprint.

The file contains no frames of the clips and no code, so that reading an untrusted file is safe.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mocap._shared.archives import Arrays, Kind, Layout, Rules, read_archive, write_archive
from mocap._shared.arrays import Indices
from mocap._shared.progress import Progress
from mocap._shared.quantities import described
from mocap.body.motion import Motion
from mocap.datasets import clip_references
from mocap.datasets.clip_origins import Origin
from mocap.datasets.clip_references import MOST_FRAMES
from mocap.errors import FormatError, MocapError, shortened
from mocap.methods.match_webs.webs import SHORTEST, MatchWeb

# The arrays of the file, with C clips, N cells, and X offsets: one for each path, and the end.
# reads: statement: a table
ARRAYS: Layout = {
    **clip_references.LAYOUT,
    "rate": (float, ()),
    "below": (float, ()),
    "lengths": (int, ("C",)),  # frames of each clip at the web's rate, or 0 if it is too short for a path
    "cells": (np.int32, ("N", 2)),
    "costs": (np.float32, ("N",)),
    "offsets": (int, ("X",)),
}


def save_web(web: MatchWeb, path: str | Path, origins: Sequence[Origin] = ()) -> None:
    """Save a match web to an `.npz` file, which is replaced only when the new one is complete.

    A web of 1080 paths through five bundled clips takes 6 s to build, and 0.1 s to load from 1.2 MB.

    Parameters
    ----------
    web : as from `build_web`.
    path : the file.
    origins : the sources of the clips, as for `graphs.save`, one for each clip or none.

    Raises
    ------
    MocapError : for another suffix, and if the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs import build_web
    >>> clips = [sample("walk_straight")]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_web(build_web(clips, below=0.05), f"{folder}/web.npz")
    ...     load_web(f"{folder}/web.npz", clips)
    MatchWeb(1 clips, 8 paths, below 5 cm)
    """
    if isinstance(path, MatchWeb):
        raise MocapError("The web comes first: match_webs.save_web(web, 'web.npz').")
    if not isinstance(web, MatchWeb):
        remedy = "match_webs.build_web(clips) makes one"
        raise MocapError(f"This takes a MatchWeb, got {described(web)}: {remedy}.")
    arrays = clip_references.arrays_of_clips(web.clips, origins, path)
    arrays |= {"rate": web.rate, "below": web.below, "lengths": np.diff(web.starts)}
    arrays |= {"cells": web.cells, "costs": web.costs, "offsets": web.offsets}
    write_archive(path, WEB, arrays)


def load_web(
    path: str | Path,
    clips: Sequence[Motion] | None = None,
    *,
    skeleton: Path | None = None,
    progress: Progress = iter,
) -> MatchWeb:
    """Load a match web and its clips, at their frame rate. `save_web` has an example.

    Parameters
    ----------
    path : a file from `save_web`.
    clips : the motions from which it was built, in any order. Other motions are ignored. By default they are
        bundled samples, or the files that the web stores, or files of the same names in its folder.
    skeleton : the `.asf` file of `.amc` clips, by default the one that the web stores, or one that fits.
    progress : wraps the files of the clips, to show a bar.

    Returns
    -------
    The same web, bit for bit. The joints of its clips have the roles that they had when it was saved.

    Raises
    ------
    FormatError : for a file that is no match web, is damaged, or has a newer version.
    MocapError : for a clip that is missing, cannot be read, or has changed.
    """
    arrays = read_archive(path, WEB)
    references = clip_references.references_in(arrays)
    clips = clip_references.load_references(references, path, clips, skeleton, progress)
    lengths = _lengths(clips)
    if not np.array_equal(arrays["lengths"], lengths):
        raise FormatError(path, None, f"clips of {shortened(str(lengths.tolist()), 60)} frames", "others")
    starts = np.cumsum([0, *lengths])
    below = float(arrays["below"])
    return MatchWeb(tuple(clips), starts, below, arrays["cells"], arrays["costs"], arrays["offsets"])


def _lengths(clips: Sequence[Motion]) -> Indices:
    """Count the frames of clips at the web's rate, as `body.resample` does, or 0 if too short for a path."""
    counts = [int(clip.duration * MatchWeb.rate + 1e-9) + 1 for clip in clips]
    return np.array([count if count >= SHORTEST else 0 for count in counts], np.intp)


def _rules(arrays: Arrays) -> Rules:
    """Yield the rules of a valid file and their results. Each rule requires those before it."""
    cells = arrays["cells"]
    offsets = arrays["offsets"]
    lengths = arrays["lengths"]
    yield from clip_references.rules_of_clips(arrays)
    yield f"a web compares {MatchWeb.rate:g} frames a second", arrays["rate"] == MatchWeb.rate
    yield "the limit of distances is above 0", 0 < arrays["below"] < np.inf
    yield "costs are distances", (arrays["costs"] >= 0) & (arrays["costs"] < np.inf)
    yield "clips have lengths", (lengths >= 0) & (lengths < MOST_FRAMES)
    yield "paths begin with the first cell", len(offsets) > 0 and offsets[0] == 0
    yield "paths end with the last cell", offsets[-1] == len(cells)
    yield "no path is empty", np.diff(offsets) > 0
    yield "cells lie in clips", (cells >= 0) & (cells < lengths.sum())
    yield "the earlier frame of a cell comes first", cells[:, 0] < cells[:, 1]
    inside = np.delete(np.arange(len(cells)), offsets[:-1])  # cells that follow another one of their path
    yield "time never runs backwards", cells[inside] >= cells[inside - 1]
    clip = np.searchsorted(np.cumsum(lengths), cells, side="right")
    yield "a path stays in its two clips", clip[inside] == clip[inside - 1]


WEB = Kind("a match web", ARRAYS, _rules, version=2, added={"roles": 2})
