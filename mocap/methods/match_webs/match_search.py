"""What is like a query, and what is like that: the search in steps of [KG04]."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.ties import in_order
from mocap.body.motion import Motion
from mocap.errors import MocapError, warn
from mocap.matching.point_clouds import point_cloud
from mocap.methods.match_webs.local_alignment import LEAST, RANKS
from mocap.methods.match_webs.webs import MatchWeb

SAME = 0.5  # share of the union of two stretches above which they are one match
COVER = 0.9  # share of the stretch that a path must cover; over the rest it is carried on straight
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
    keep: Callable[[Motion], bool] | None = None,
) -> list[Match]:
    """Find what is like a query, then what is like that, until nothing new turns up [KG04, search in steps].

    One step finds the nearest matches alone: motions that are the same to us differ by more than motions that
    are not. But between two that differ there are others [KG04]. The bound on lengths is ours: a wrong match
    is a query too, and the first one is mostly a slow motion laid on a quick one, or the reverse.

    Steps help where one kind has many looks, such as punches at many targets, or slow and brisk walks. Where
    all of a kind look alike, such as strides at one pace, one step finds as much, and cannot leak. Steps harm
    where one kind passes into another, as turns by 90° into turns by 45°: then say by `keep` what is asked.

    Parameters
    ----------
    web : as from `build_web`.
    clip, frames : the query: the number of a clip, and its own frames.
    below : the mean RMS distance that a match may have from what found it, metres; by default the web's own.
        Try some, and take one where the number of matches stays level: a little above, one wrong match brings
        in all of its kind, and hundreds are found.
    lengths : the shortest and the longest match, as shares of the query's length.
    steps : how often to search, the first time with the query; by default until nothing new turns up.
    still : what moves less than this is not searched from, metres RMS about the mean place of each point: to
        stand still is like itself at any time. (Ours; the paper has no such bound.)
    keep : says of the motion of a match whether it is what is asked for, by its turn for example; those that
        are not are neither given nor searched from (ours).

    Returns
    -------
    The query, then its matches step by step, each step from the nearest on. What overlaps a match by more
    than half of their union is that match.

    Raises
    ------
    MocapError : for a query beyond its clip or shorter than the web's paths, and a `below` over the web's.

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
    >>> [(match.generation, match.via, round(match.cost, 3)) for match in found[:3]]
    [(0, -1, 0.0), (1, 0, 0.027), (1, 0, 0.03)]

    Notebook: 16-match-webs
    """
    query = _query(web, clip, frames)
    limit = web.below if below is None else below
    if limit > web.below:
        raise MocapError(f"This web goes up to {100 * web.below:g} cm: build another for {100 * limit:g} cm.")
    shortest, longest = (share * (query.stop - query.start) for share in lengths)
    found, asking, left_out, places = [query], [0], 0, np.array([query[1:3]])
    while asking and (steps is None or found[-1].generation < steps):
        moving = [number for number in asking if _spread(web, found[number]) >= still]
        left_out += len(asking) - len(moving)
        new = [
            other
            for number in moving
            for other in crossings(web, found[number], number, limit)
            if shortest <= other.stop - other.start <= longest
        ]
        before = len(found)
        for match in (new[number] for number in in_order([other.cost for other in new], RANKS)):
            common = np.minimum(places[:, 1], match.stop) - np.maximum(places[:, 0], match.start)
            union = np.maximum(places[:, 1], match.stop) - np.minimum(places[:, 0], match.start)
            fresh = (common <= SAME * union).all()  # it is none of those that were found
            if fresh and (not keep or keep(cut_out(web, _in_own_frames(web, clip, match)))):
                found.append(match)
                places = np.append(places, [match[1:3]], axis=0)
        asking = list(range(before, len(found)))
    _warn(found, left_out)
    own = [_in_own_frames(web, clip, one) for one in found]
    first, last, _ = frames.indices(len(web.clips[clip]))
    own[0] = own[0]._replace(start=first, stop=last)
    return own


def _query(web: MatchWeb, clip: int, frames: slice) -> Match:
    """Count the query, as all matches while they are searched for, in the numbering of all frames.

    Examples
    --------
    At 120 Hz the shortest query, 0.3 s, has 36 frames, and a web counts every fourth:

    >>> from mocap.datasets.samples import sample
    >>> web = MatchWeb((sample("walk_straight"),), [0, 301], 0.05, np.empty((0, 2)), [], [0])
    >>> _query(web, 0, slice(0, 36))[:3], _query(web, 0, slice(1165, 1201))[:3]
    ((0, 0, 9), (0, 291, 300))
    """
    motion = web.clips[clip]
    first, last = frames.start or 0, len(motion) if frames.stop is None else frames.stop
    if not 0 <= first < last <= len(motion):
        raise MocapError(f"'{motion.name}' has frames 0 to {len(motion) - 1}, got {first}:{last}.")
    start, stop = np.round(web.number(clip, [first, last])).astype(int).tolist()
    stop = min(stop, int(web.starts[clip + 1]))
    if stop - start < LEAST:
        given = f"{first}:{last} of '{motion.name}' is {(last - first) / motion.fps:.2g} s"
        raise MocapError(f"A query must last {LEAST / web.rate:g} s or more, as paths do; {given}.")
    rows = np.arange(start, stop, dtype=float)
    return Match(clip, start, stop, 0.0, -1, 0, rows, rows)


def _spread(web: MatchWeb, found: Match) -> float:
    """Measure how far the points of a match are from their mean place, RMS in metres.

    Examples
    --------
    In a stride the points of a walker move by tens of centimetres, in 0.3 s by less:

    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> web = MatchWeb((walk,), [0, 301], 0.05, np.empty((0, 2)), [], [0])
    >>> [round(_spread(web, _query(web, 0, slice(240, stop))), 3) for stop in (276, 370)]
    [0.135, 0.385]
    """
    every = max(1, round(web.clips[0].fps / web.rate))
    points = point_cloud(cut_out(web, _in_own_frames(web, found.clip, found))[::every])
    return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(-1).mean()))


def _in_own_frames(web: MatchWeb, query: int, match: Match) -> Match:
    """Count a match in the own frames of its clip and of the query's clip."""
    start, stop = np.round(web.own_frame(match.clip, match[1:3])).astype(int).tolist()
    stop = min(stop, len(web.clips[match.clip]))
    rows, frames = web.own_frame(query, match.rows), web.own_frame(match.clip, match.frames)
    return match._replace(start=start, stop=stop, rows=rows, frames=frames)


def _warn(found: Sequence[Match], left_out: int) -> None:
    messages = []
    if left_out:
        still = f"{left_out} of {len(found)} matches hardly move, so nothing was searched from them"
        messages.append(f"{still}: to stand still is like itself at any time.")
    if len(found) == 1:
        messages.append("The query found only itself: raise the limit, or take another query.")
    counts = np.bincount([one.generation for one in found])
    if (leaks := counts[2:][counts[2:] > np.maximum(LEAK * counts[1:-1], FEW)]).size:
        many = f"One step found {leaks[0]} matches, more than {LEAK} times the step before"
        messages.append(f"{many}: one wrong match may have led to others; lower the limit.")
    for message in messages:
        warn(message)


def crossings(web: MatchWeb, found: Match, number: int, below: float) -> Iterator[Match]:
    """List what the paths of a web lay on a match, and through it on the query, in the numbering of all.

    A web is symmetric: a path serves a stretch in either of its clips.

    Parameters
    ----------
    web : as from `build_web`.
    found, number : the match, and which of those found it is.
    below : the mean RMS distance of a path inside the match, metres.

    Examples
    --------
    A path covers 18 of the 20 frames of a match. Frame 11 lies on two frames, and gets their mean. The rest
    goes on straight, but does not leave the second clip, which begins at 50:

    >>> from mocap.body import resample
    >>> from mocap.datasets.samples import sample
    >>> walk = resample(sample("walk_straight"), 30)
    >>> cells = [[11, 50], *([11 + n, 51 + n] for n in range(20))]
    >>> web = MatchWeb((walk[:50], walk[50:120]), [0, 50, 120], 0.05, np.array(cells), [0.02] * 21, [0, 21])
    >>> rows = np.arange(9.0, 29)
    >>> [hit] = crossings(web, Match(0, 9, 29, 0.0, -1, 0, rows, rows), 0, 0.05)
    >>> hit.clip, hit.start, hit.stop, round(hit.cost, 3), hit.via, hit.generation
    (1, 50, 69, 0.02, 0, 1)
    >>> hit.rows[[0, 1, -1]].tolist(), hit.frames[[0, 1, -1]].tolist()
    ([11.0, 12.0, 28.0], [50.5, 52.0, 68.0])
    """
    start, stop = found.start, found.stop
    first, last = web.cells[web.offsets[:-1]], web.cells[web.offsets[1:] - 1]
    needed = COVER * (stop - start)
    for side in (0, 1):
        covered = np.minimum(last[:, side], stop - 1) - np.maximum(first[:, side], start) + 1
        for path in np.flatnonzero(covered >= needed).tolist():
            cells, costs = web.path(path)
            part = slice(*np.searchsorted(cells[:, side], [start, stop]))
            cost = float(costs[part].mean())
            if cost <= below:
                own, other = cells[part, side].astype(float), cells[part, 1 - side].astype(float)
                clip = web.clip_at(int(other[0]))  # straight on to the stretch's ends, but not beyond it
                begin = max(int(other[0] - (own[0] - start)), int(web.starts[clip]))
                end = min(int(other[-1] + (stop - own[-1])), int(web.starts[clip + 1]))
                frames, at, count = np.unique(own, return_index=True, return_counts=True)
                inside = (found.frames >= frames[0]) & (found.frames <= frames[-1])
                laid = np.interp(found.frames[inside], frames, np.add.reduceat(other, at) / count)
                rows, steps = found.rows[inside], found.generation + 1
                yield Match(web.clip_at(begin), begin, end, cost, number, steps, rows, laid)


def cut_out(web: MatchWeb, match: Match) -> Motion:
    """Cut a match out of its clip.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> match = search(web, 0, slice(240, 370))[1]
    >>> match.start, cut_out(web, match)
    (100, Motion('walk_straight', 132 frames at 120 Hz, 38 joints))
    >>> np.array_equal(cut_out(web, match).root_positions[0], web.clips[0].root_positions[100])
    True

    Notebook: 16-match-webs
    """
    return web.clips[match.clip][match.start : match.stop]
