"""The match web of a set of clips: all long paths of similar frames, found once and stored."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array, Indices, frozen
from mocap._shared.progress import Progress
from mocap._shared.quantities import check_threshold
from mocap._shared.records import dataclass
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion, resample
from mocap.errors import MocapError, warn
from mocap.matching.transitions import join_clouds
from mocap.methods.match_webs.local_alignment import DISTANCE, find_paths
from mocap.methods.match_webs.tuned import TUNED

WINDOW = 5  # frames in a window, at the web's rate
SHORTEST = WINDOW + TUNED.least_advance  # frames of the shortest clip that can contain a path
NAMED = 4  # clips that a warning names. It counts the others


@dataclass(frozen=True, eq=False, repr=False)
class MatchWeb:
    """All long paths of similar frames in a set of clips.

    Parameters
    ----------
    clips : the motions, each at its own rate.
    starts : shape (C + 1,): first frame of each clip, at the web's rate, in the numbering of all clips.
    below : the limit of distances, as for `build_web`.
    cells : shape (N, 2): pairs of frames in the numbering of all clips, path by path, the earlier frame
        first. A pair consists of the middle frames of two windows.
    costs : shape (N,), the RMS distance of each pair of windows, metres.
    offsets : shape (P + 1,): first cell of each path.
    """

    clips: tuple[Motion, ...]
    starts: Indices
    below: float
    cells: NDArray[np.integer[Any]]
    costs: NDArray[np.floating[Any]]
    offsets: Indices
    rate: ClassVar[float] = 30.0  # frames per second at which clips are compared

    def __post_init__(self) -> None:
        kinds = dict[str, Any](starts=np.intp, cells=np.int32, costs=np.float32, offsets=np.intp)
        for key, kind in kinds.items():
            object.__setattr__(self, key, frozen(getattr(self, key), kind))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        return f"MatchWeb({len(self.clips)} clips, {len(self)} paths, below {100 * self.below:g} cm)"

    def path(self, number: int) -> tuple[NDArray[np.integer[Any]], NDArray[np.floating[Any]]]:
        """Return the cells of a path, shape (K, 2), and their costs, shape (K,)."""
        part = slice(self.offsets[number], self.offsets[number + 1])
        return self.cells[part], self.costs[part]

    def clip_at(self, frame: int) -> int:
        """Return the number of the clip that contains a frame in the numbering of all clips."""
        return int(np.searchsorted(self.starts, frame, side="right")) - 1

    def number(self, clip: int, frame: ArrayLike) -> Array:
        """Convert a clip's own frames to the numbering of all clips, which is at the web's rate."""
        ratio = self.rate / self.clips[clip].fps
        return np.asarray(self.starts[clip] + np.asarray(frame) * ratio)

    def own_frame(self, clip: int, number: ArrayLike) -> Array:
        """Convert frames in the numbering of all clips to frames of a clip, the inverse of `number`."""
        ratio = self.clips[clip].fps / self.rate
        return np.asarray((np.asarray(number) - self.starts[clip]) * ratio)


def build_web(clips: Sequence[Motion], *, below: float = 0.12, progress: Progress = iter) -> MatchWeb:
    """Find all long paths of similar frames in a set of clips [KG04, match web].

    The distance is that of `matching.find_transitions`, and the paths are those of `local_paths`. A cell that
    is not a one-dimensional minimum costs more, so that paths follow the floors of valleys.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    below : the largest mean RMS distance of a path, metres. A search can only use a lower limit.
    progress : wraps the tiles of the grid as they are processed, to show a bar.

    Returns
    -------
    The web. A path applies to both of its clips, so each pair of clips is compared once. Stretches of one
    clip that begin within 0.3 s of each other are not compared.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, several skeletons or rates, clips that are all too short, and
        a limit above 1 m.

    Warns
    -----
    MocapWarning : for clips that are too short to contain a path, which are left out.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> web, round(float(web.costs.mean()), 3)
    (MatchWeb(1 clips, 8 paths, below 5 cm), 0.018)

    A clip needs at least 14 frames at 30 Hz, here 53 at 120 Hz:

    >>> build_web([sample("walk_straight")[:53]])
    MatchWeb(1 clips, 0 paths, below 12 cm)

    Notebook: 16-match-webs
    """
    clips = require_compatible(clips)
    check_threshold(below)
    resampled = [resample(clip, MatchWeb.rate) for clip in clips]
    shortest = f"{SHORTEST / MatchWeb.rate:.2g} s"
    long = [clip for clip in resampled if len(clip) >= SHORTEST]
    if not long:
        raise MocapError(f"No clip is long enough for a path: that takes {shortest}.")
    if short := [f"'{clip.name}'" for clip in resampled if len(clip) < SHORTEST]:
        names = ", ".join(short[:NAMED])
        if len(short) > NAMED:
            names += f" and {len(short) - NAMED} more"
        warn(f"Too short to hold a path of {shortest}, and left out: {names}.")
    cloud = join_clouds(long, None, WINDOW, 0, np.float64)  # with 32 bits, paths would depend on rounding
    lengths = [len(clip) if len(clip) >= SHORTEST else 0 for clip in resampled]
    starts = np.cumsum([0, *lengths])
    paths = find_paths(cloud, np.unique(starts), below, progress)
    rows = np.concatenate([np.empty((0, 3)), *paths])
    cells = rows[:, :DISTANCE] + WINDOW // 2  # the middles of the windows
    offsets = np.cumsum([0, *map(len, paths)])
    return MatchWeb(clips, starts, float(below), cells, rows[:, DISTANCE], offsets)
