"""One step of the search: the paths of a web that cross some frames, and what lies at their other ends."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.methods.match_webs.webs import MatchWeb

COVER = 0.9  # share of the stretch that a path must cover; over the rest it is carried on straight


class Crossing(NamedTuple):
    """The frames [start, stop) that a path lays on a stretch, in the numbering of all clips' frames.

    `cost` is the path's mean RMS distance inside the stretch, metres; `own` and `other`, shape (K,), are
    frames of the stretch, each once, and the frames that lie on them.
    """

    start: int
    stop: int
    cost: float
    own: Array
    other: Array


def crossings(web: MatchWeb, start: int, stop: int, below: float) -> Iterator[Crossing]:
    """List what the paths of a web lay on the frames [start, stop), in the numbering of all.

    A web is symmetric: a path serves a stretch in either of its clips.

    Parameters
    ----------
    web : as from `build_web`.
    start, stop : frames at the web's rate.
    below : the mean RMS distance of a path inside the stretch, metres.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> found = min(crossings(web, 60, 92, 0.05), key=lambda crossing: crossing.cost)
    >>> found.start, found.stop
    (25, 58)
    """
    first, last = web.ends
    needed = COVER * (stop - start)
    for side in (0, 1):
        covered = np.minimum(last[:, side], stop - 1) - np.maximum(first[:, side], start) + 1
        for number in np.flatnonzero(covered >= needed):
            cells, costs = web.path(number)
            first_cell, end = np.searchsorted(cells[:, side], [start, stop])
            inside = slice(first_cell, end)
            cost = float(costs[inside].mean())
            if cost <= below:
                own, other = cells[inside, side].astype(float), cells[inside, 1 - side].astype(float)
                yield _crossing(web, (start, stop), cost, own, other)


def _crossing(web: MatchWeb, stretch: tuple[int, int], cost: float, own: Array, other: Array) -> Crossing:
    """Carry a path on straight to the stretch's ends, but not beyond the other clip's."""
    clip = web.clip_at(int(other[0]))
    start = max(int(other[0] - (own[0] - stretch[0])), int(web.starts[clip]))
    stop = min(int(other[-1] + (stretch[1] - own[-1])), int(web.starts[clip + 1]))
    frames, first, count = np.unique(own, return_index=True, return_counts=True)
    return Crossing(start, stop, cost, frames, np.add.reduceat(other, first) / count)
