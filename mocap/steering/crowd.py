"""Crowds: many characters of one graph, each on its own path, that keep apart [KGP02, 5.3].

This serves a few characters whose paths are given and cross. A group that stays together and must find its
way among obstacles is planned by `groups`.
"""

import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from mocap._shared.arrays import Array
from mocap.body.ground_path import GroundPath
from mocap.editing.path_editing import moving_frames
from mocap.errors import MocapError, MocapWarning
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.followed import Followed
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings, Wishes

Search = Callable[[GroundPath, Wishes], Followed]

WAITS = (0.0, 1.0, 2.0, 4.0)  # seconds, tried in this order
ASIDE = 1.3  # times the distance to keep: how far a path is bent around another
REACH = 1.2  # metres: how soon before and after


class Crowd(NamedTuple):
    """Walks that begin together: each character waits in its first pose for `waits` seconds.

    `nearest` (K, K) is the smallest distance of the roots of any two, metres; inf on the diagonal.
    """

    walks: list[Followed]
    waits: list[float]
    nearest: Array


def walk_crowd(  # noqa: PLR0913 (where, how far apart, and how to search)
    graph: MotionGraph | CompiledGraph,
    paths: Sequence[GroundPath],
    *,
    apart: float = 0.8,
    settings: Settings | None = None,
    pool: Executor | None = None,
    bend: float = 0.0,
) -> Crowd:
    """Find a walk along each path, so that the characters keep apart [KGP02, 5.3].

    First each walk is found as if alone; these searches run in parallel in a `pool`. Then the characters are
    visited in order. One that comes too near to an earlier one searches again, with a price on each frame too
    near. Where this does not help, it also waits before it starts. So the first gives way to nobody, and the
    others give way to those before them. With `bend`, walks cannot leave their paths; instead a path itself
    is bent around the others, to the left or to the right.

    Parameters
    ----------
    graph : pruned.
    paths : one per character.
    apart : the least distance between the roots of any two, metres.
    settings : as for `steering.follow_path`.
    bend : as for `steering.follow_path`: all are laid on their paths, which are bent around others.
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
    alone = partial(follow_path, compiled, settings=settings, bend=bend)
    walks = list((pool.map if pool else map)(alone, paths))
    # Who gives way is free to leave the path or to slow down.
    wide = replace(
        settings, width=3 * (settings.width or 100), rescue=30.0, crowding=60.0, stray=0.0, tries=1
    )
    search = partial(follow_path, compiled, settings=wide, bend=bend)
    waits, tracks = [0.0] * len(walks), [walk.track for walk in walks]
    for character, path in enumerate(paths):
        before = tracks[:character]
        if _clearance(tracks[character], before) < apart:
            lines = [path, *(_around(path, tracks[character], before, apart) if bend else ())]
            found = _give_way(search, lines, before, apart, compiled.fps)
            walks[character], waits[character], tracks[character] = found
    nearest = np.array([[_nearest(a, b) if a is not b else np.inf for b in tracks] for a in tracks])
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
    search: Search, lines: Sequence[GroundPath], before: Sequence[Array], apart: float, fps: float
) -> tuple[Followed, float, Array]:
    """Find a walk that keeps away from the tracks `before`, with the shortest wait that is enough.

    `lines` are the path, and the ways around the others if there are any. Returns the walk, its wait in
    seconds, and its track with the wait.
    """
    found: list[tuple[Followed, float, Array]] = []
    for wait, line in product(WAITS, lines):
        frames = round(wait * fps)
        others = [track[min(frames, len(track) - 1) :] for track in before]
        walk = search(line, Wishes(others=others, apart=1.1 * apart))
        if line is not lines[0]:
            off = cKDTree(lines[0].resampled(0.01).points).query(walk.track)[0]
            walk = replace(walk, path=lines[0], off=off)
        track = np.concatenate([np.repeat(walk.track[:1], frames, axis=0), walk.track])
        found.append((walk, wait, track))
        if _clearance(track, before) >= apart:
            return found[-1]
    return max(found, key=lambda way: _clearance(way[2], before))


def _around(path: GroundPath, track: Array, before: Sequence[Array], apart: float) -> list[GroundPath]:
    """Bend a path aside, to the left and to the right, where a walk along it comes too near to another.

    It swerves by a bump of `ASIDE` times the distance to keep, and comes back to the path at its ends.
    """
    nearest = min(before, key=lambda other: _nearest(track, other))
    frame = int(_distances(track, nearest)[: len(track)].argmin())
    fine = path.resampled(0.1)
    along, here = fine.along, int(np.hypot(*(fine.points - track[frame]).T).argmin())
    bump = np.exp(-(((along - along[here]) / REACH) ** 2) / 2)
    bump *= np.clip(np.minimum(along, path.length - along) / REACH, 0, 1)
    heading = np.asarray(moving_frames(fine, along).angle)
    left = np.stack([np.cos(heading), -np.sin(heading)], axis=1)
    return [GroundPath(fine.points + side * ASIDE * apart * bump[:, None] * left) for side in (1, -1)]


def _clearance(track: Array, others: Sequence[Array]) -> float:
    """Measure the smallest distance of a track from others, metres."""
    return min((_nearest(track, other) for other in others), default=np.inf)


def _nearest(a: Array, b: Array) -> float:
    """Measure the smallest distance of two tracks, metres."""
    return float(_distances(a, b).min())


def _distances(a: Array, b: Array) -> Array:
    """Measure the distance of two tracks in each frame, metres; the shorter one stays at its end."""
    frames = np.arange(max(len(a), len(b)))
    apart = a[np.minimum(frames, len(a) - 1)] - b[np.minimum(frames, len(b) - 1)]
    return np.asarray(np.hypot(*apart.T))
