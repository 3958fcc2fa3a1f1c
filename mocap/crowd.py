"""Crowds: many characters off one graph, each on a path of its own, kept apart [KGP02, 5.3]."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mocap.compiling import CompiledGraph, compile_graph
from mocap.errors import MocapError
from mocap.follow import Followed, Wishes, follow_path
from mocap.layered_search import Beam
from mocap.motion_graph import MotionGraph
from mocap.paths import GroundPath
from mocap.routes import Prices

Array = NDArray[np.float64]


def walk_crowd(
    graph: MotionGraph | CompiledGraph,
    paths: Sequence[GroundPath],
    *,
    apart: float = 0.8,
    beam: Beam | None = None,
    pool: Executor | None = None,
) -> list[Followed]:
    """Send a character along each path, all starting at once, none coming near another.

    First each walks as if alone; these searches run side by side in a `pool`. Then, one after the other,
    whoever comes too near to one before searches again, with a price on the metres too near in each frame:
    the first keeps to its path best, the last gives way to all.

    Parameters
    ----------
    graph : pruned.
    paths : one a character.
    apart : metres between the roots of any two.
    beam : how thoroughly to search.
    pool : a `concurrent.futures.ProcessPoolExecutor` for many characters; by default one after the other.

    Returns
    -------
    A walk a path; `clearance` tells how near two come.

    Raises
    ------
    NoWalk, MocapError : as by `follow.follow_path`.
    """
    if not (np.isfinite(apart) and apart > 0):
        raise MocapError(f"Characters must be kept more than 0 m apart, got {apart} m.")
    compiled, wishes, prices = compile_graph(graph), Wishes(apart=apart), Prices(crowding=20.0, stray=0.0)
    wide = replace(beam or Beam(), width=3 * (beam or Beam()).width, rescue=3.0)
    walks = list((pool.map if pool else map)(partial(follow_path, compiled, beam=beam), paths))
    for character, path in enumerate(paths):
        before = [walk.track for walk in walks[:character]]
        if min((_nearest(walks[character].track, track) for track in before), default=np.inf) < apart:
            yielding = replace(wishes, others=before)
            walks[character] = follow_path(compiled, path, yielding, beam=wide, prices=prices)
    return walks


def clearance(walks: Sequence[Followed]) -> float:
    """Measure how near any two of a crowd come, metres between their roots; inf for one alone."""
    return min((_nearest(a.track, b.track) for a, b in combinations(walks, 2)), default=np.inf)


def _nearest(a: Array, b: Array) -> float:
    """Measure how near two come while both are walking, or one has arrived and stays."""
    frames = np.arange(max(len(a), len(b)))
    apart = a[np.minimum(frames, len(a) - 1)] - b[np.minimum(frames, len(b) - 1)]
    return float(np.hypot(*apart.T).min())
