"""What is like a query, and what is like that: the search in steps of [KG04]."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from itertools import groupby, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.errors import MocapError, MocapWarning
from mocap.matching.point_clouds import point_cloud
from mocap.methods.match_webs.crossings import Crossing, crossings
from mocap.methods.match_webs.webs import MatchWeb

SAME = 0.5  # share of the union of two stretches above which they are one match
LEAK, FEW = 5, 20  # a step with so many times the matches of the step before leaks, unless they are few


class Match(NamedTuple):
    """A stretch of a clip that is like the query, or like another match.

    clip, start, stop : which clip, and its own frames [start, stop).
    cost : mean RMS distance to the match that found it, metres; 0 for the query itself.
    via : the number of the match that found it; -1 for the query.
    generation : how many steps it is from the query.
    rows, frames : shape (K,): frames of the query's clip, and the frames of this one that lie on them,
        through all matches between.
    """

    clip: int
    start: int
    stop: int
    cost: float
    via: int
    generation: int
    rows: Array
    frames: Array


def search(  # noqa: PLR0913 (a web, a query, and its limits)
    web: MatchWeb,
    clip: int,
    frames: slice,
    *,
    below: float | None = None,
    lengths: tuple[float, float] = (3 / 4, 4 / 3),
    steps: int | None = None,
    still: float = 0.05,
) -> list[Match]:
    """Find what is like a query, then what is like that, until nothing new turns up [KG04, search in steps].

    One step finds the nearest matches alone: motions that are the same to us differ by more than motions that
    are not. But between two that differ there are others [KG04]. The bound on lengths is ours: a wrong match
    is a query too, and the first one is mostly a slow motion laid on a quick one, or the reverse.

    Parameters
    ----------
    web : as from `build_web`.
    clip, frames : the query: the number of a clip, and its own frames.
    below : the mean RMS distance that a match may have from what found it, metres; by default the web's own.
    lengths : the shortest and the longest match, as shares of the query's length.
    steps : how often to search, the first time with the query; by default until nothing new turns up.
    still : what moves less than this is not searched from, metres RMS about the mean place of each point: to
        stand still is like itself at any time. (Ours; the paper has no such bound.)

    Returns
    -------
    The query, then its matches step by step, each step from the nearest on. What overlaps a match by more
    than half of their union is that match.

    Raises
    ------
    MocapError : for a clip that is not there, a query beyond its clip or shorter than the web's paths, a
        `below` that is not above 0 or over the web's own, lengths that leave out the query's, and no steps.

    Warns
    -----
    MocapWarning : for a query that finds only itself; for matches that are not searched from, because they
        move less than `still`; and for a step that finds more than 5 times what the step before did.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> found = search(web, 0, slice(240, 370))
    >>> [(match.start, match.stop) for match in found[:3]], len(found)
    ([(240, 370), (100, 232), (376, 500)], 8)

    Notebook: 16-match-webs
    """
    query = _query(web, clip, frames)
    limit = web.below if below is None else below
    _check(web, limit, lengths, steps)
    low, high = (share * (query.stop - query.start) for share in lengths)
    found, asking, left_out = [query], [0], 0
    places = np.array([query[1:3]])
    while asking and (steps is None or found[-1].generation < steps):
        moving = [number for number in asking if _spread(web, found[number]) >= still]
        left_out += len(asking) - len(moving)
        new = [
            (other, number)
            for number in moving
            for other in crossings(web, found[number].start, found[number].stop, limit)
            if low <= other.stop - other.start <= high
        ]
        before = len(found)
        for other, number in sorted(new, key=lambda pair: pair[0].cost):
            if not _is_among(other, places):
                found.append(_composed(web, found[number], other, number))
                places = np.append(places, [other[:2]], axis=0)
        asking = list(range(before, len(found)))
    _warn(found, left_out)
    first, *others = (_in_own_frames(web, one) for one in found)
    start, stop, _ = frames.indices(len(web.clips[clip]))
    return [first._replace(start=start, stop=stop), *others]


def _query(web: MatchWeb, clip: int, frames: slice) -> Match:
    """Count the query, as all matches while they are searched for, in the numbering of all frames."""
    if not 0 <= clip < len(web.clips):
        raise MocapError(f"This web has clips 0 to {len(web.clips) - 1}, got {clip}.")
    motion = web.clips[clip]
    first, last = frames.start or 0, len(motion) if frames.stop is None else frames.stop
    if not 0 <= first < last <= len(motion):
        raise MocapError(f"'{motion.name}' has frames 0 to {len(motion) - 1}, got {first}:{last}.")
    start, stop = (round(float(web.number(clip, frame))) for frame in (first, last))
    stop = min(stop, int(web.starts[clip + 1]))
    if stop - start < round(web.shape.least * web.rate):
        raise MocapError(
            f"A query must last {web.shape.least:g} s or more, as the paths of this web do; "
            f"{first}:{last} of '{motion.name}' is {(last - first) / motion.fps:.2g} s."
        )
    rows = np.arange(start, stop, dtype=float)
    return Match(clip, start, stop, 0.0, -1, 0, rows, rows)


def _check(web: MatchWeb, below: float, lengths: tuple[float, float], steps: int | None) -> None:
    if not below > 0:
        raise MocapError(f"A match needs a distance above 0 m, got below={below}.")
    if below > web.below:
        raise MocapError(
            f"This web holds paths up to {100 * web.below:g} cm: build another for {100 * below:g} cm."
        )
    if not 0 < lengths[0] <= 1 <= lengths[1]:
        raise MocapError(f"Lengths are shares from up to 1 to 1 or more of the query's, got {lengths}.")
    if steps is not None and steps < 1:
        raise MocapError(f"A search takes 1 step or more, got {steps}.")


def _spread(web: MatchWeb, found: Match) -> float:
    """Measure how far the points of a match are from their mean place, RMS in metres."""
    points = point_cloud(
        cut_out(web, _in_own_frames(web, found))[:: max(1, round(web.clips[0].fps / web.rate))]
    )
    return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(-1).mean()))


def _is_among(other: Crossing, places: NDArray[np.integer[Any]]) -> bool:
    """Say whether a stretch and a match, [start, stop), have more than half of their union in common."""
    starts, stops = places.T
    common = np.minimum(stops, other.stop) - np.maximum(starts, other.start)
    union = np.maximum(stops, other.stop) - np.minimum(starts, other.start)
    return bool((common > SAME * union).any())


def _composed(web: MatchWeb, match: Match, other: Crossing, via: int) -> Match:
    """Lay a new match on the query: through the match that found it."""
    start, stop, cost, own, frames = other
    inside = (match.frames >= own[0]) & (match.frames <= own[-1])
    laid = np.interp(match.frames[inside], own, frames)
    return Match(web.clip_at(start), start, stop, cost, via, match.generation + 1, match.rows[inside], laid)


def _in_own_frames(web: MatchWeb, match: Match) -> Match:
    """Count a match in its clip's own frames."""
    clip = match.clip
    start, stop = (round(float(web.own_frame(clip, number))) for number in (match.start, match.stop))
    of_query = web.clip_at(int(match.rows[0])) if len(match.rows) else clip
    rows, frames = web.own_frame(of_query, match.rows), web.own_frame(clip, match.frames)
    return match._replace(start=start, stop=min(stop, len(web.clips[clip])), rows=rows, frames=frames)


def _warn(found: Sequence[Match], left_out: int) -> None:
    messages = []
    if left_out:
        messages.append(
            f"{left_out} of {len(found)} matches hardly move, so nothing was searched from them: "
            "to stand still is like itself at any time."
        )
    if len(found) == 1:
        messages.append("The query found only itself: raise the limit, or take another query.")
    counts = [len(list(step)) for _, step in groupby(found, key=lambda one: one.generation)][1:]
    leaks = [now for before, now in pairwise(counts) if now > max(LEAK * before, FEW)]
    if leaks:
        messages.append(
            f"One step found {leaks[0]} matches, more than {LEAK} times the step before: one wrong match may "
            "have led to others; lower the limit."
        )
    for message in messages:
        warnings.warn(message, MocapWarning, stacklevel=3)


def cut_out(web: MatchWeb, match: Match) -> Motion:
    """Cut a match out of its clip.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> cut_out(web, search(web, 0, slice(240, 370))[1])
    Motion('walk_straight', 132 frames at 120 Hz, 38 joints)

    Notebook: 16-match-webs
    """
    return web.clips[match.clip][match.start : match.stop]
