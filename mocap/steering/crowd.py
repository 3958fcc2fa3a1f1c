"""Crowds: many characters of one graph, each on its own path, that keep apart [KGP02, 5.3].

This serves a few characters whose paths are given and cross. A group that stays together and must find its
way among obstacles is planned by `groups`.
"""

import warnings
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.errors import MocapError, MocapWarning
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.followed import Followed
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings, Wishes

WAITS = (0.0, 1.0, 2.0, 4.0)  # seconds, tried in this order


class Crowd(NamedTuple):
    """Walks that begin together: each character waits in its first pose for `waits` seconds.

    `nearest` (K, K) is the smallest distance of the roots of any two, metres; inf on the diagonal.
    """

    walks: list[Followed]
    waits: list[float]
    nearest: Array


def walk_crowd(
    graph: MotionGraph | CompiledGraph,
    paths: Sequence[GroundPath],
    *,
    apart: float = 0.8,
    settings: Settings | None = None,
    pool: Executor | None = None,
) -> Crowd:
    """Find a walk along each path, so that the characters keep apart [KGP02, 5.3].

    First each walk is found as if alone; these searches run in parallel in a `pool`. Then the characters are
    visited in order. One that comes too near to an earlier one searches again, with a price on each frame too
    near. Where this does not help, it also waits before it starts. So the first gives way to nobody, and the
    others give way to those before them.

    Parameters
    ----------
    graph : pruned.
    paths : one per character.
    apart : the least distance between the roots of any two, metres.
    settings : as for `steering.follow_path`.
    pool : a `concurrent.futures.ProcessPoolExecutor` for many characters; by default one after the other.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, and for a distance that is not above 0.

    Warns
    -----
    MocapWarning : where two still come nearer than `apart`.

    Examples
    --------
    Two paths 9 m apart:

    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> crowd = walk_crowd(graph, [body.GroundPath([[x, 0], [x, 3]]) for x in (0, 9)])
    >>> crowd.waits, bool(crowd.nearest[0, 1] > 8)
    ([0.0, 0.0], True)

    Notebook: 08b-steering
    """
    if not (np.isfinite(apart) and apart > 0):
        raise MocapError(f"Characters must be kept more than 0 m apart, got {apart} m.")
    compiled, settings = compile_graph(graph), settings or Settings(width=100)
    walks = list((pool.map if pool else map)(partial(follow_path, compiled, settings=settings), paths))
    waits, tracks = [0.0] * len(walks), [walk.track for walk in walks]
    for one, path in enumerate(paths):
        if _nearest(tracks[one], tracks[:one]) < apart:
            walks[one], waits[one], tracks[one] = _give_way(compiled, path, settings, tracks[:one], apart)
    nearest = np.array([[_nearest(a, [b]) if a is not b else np.inf for b in tracks] for a in tracks])
    if nearest.min(initial=np.inf) < apart:
        a, b = np.unravel_index(nearest.argmin(), nearest.shape)
        warnings.warn(
            f"Characters {a} and {b} come as near as {nearest[a, b]:.2f} m, though {apart:.2f} m were asked "
            "for: their paths leave them no room.",
            MocapWarning,
            stacklevel=2,
        )
    return Crowd(walks, waits, nearest)


def _give_way(
    graph: CompiledGraph, path: GroundPath, settings: Settings, before: Sequence[Array], apart: float
) -> tuple[Followed, float, Array]:
    """Find a walk that keeps away from the tracks `before`, with the shortest wait that is enough.

    Who gives way is free to leave the path or to slow down. Returns the walk, its wait in seconds, and its
    track with the wait.
    """
    free = replace(
        settings, rescue=30.0, crowding=60.0, stray=0.0, tries=1, width=3 * (settings.width or 100)
    )
    found: list[tuple[Followed, float, Array]] = []
    for wait in WAITS:
        frames = round(wait * graph.fps)
        others = [track[min(frames, len(track) - 1) :] for track in before]
        walk = follow_path(graph, path, Wishes(others=others, apart=1.1 * apart), settings=free)
        found.append((walk, wait, np.concatenate([np.repeat(walk.track[:1], frames, axis=0), walk.track])))
        if _nearest(found[-1][2], before) >= apart:
            return found[-1]
    return max(found, key=lambda way: _nearest(way[2], before))


def _nearest(track: Array, others: Sequence[Array]) -> float:
    """Measure the smallest distance of a track from others, metres; who has arrived stays at the end."""
    least = np.inf
    for other in others:
        frames = np.arange(max(len(track), len(other)))
        a, b = (some[np.minimum(frames, len(some) - 1)] for some in (track, other))
        least = min(least, float(np.hypot(*(a - b).T).min()))
    return least
