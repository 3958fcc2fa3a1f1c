"""Search in steps: motions similar to a query, then motions similar to those [KG04]."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.quantities import check_threshold, described
from mocap._shared.records import NamedTuple
from mocap._shared.ties import in_order
from mocap.body.motion import Motion
from mocap.errors import MocapError, warn
from mocap.matching.point_clouds import point_cloud
from mocap.methods.match_webs.local_alignment import RANKS
from mocap.methods.match_webs.tuned import TUNED
from mocap.methods.match_webs.webs import MatchWeb


class Match(NamedTuple):
    """A stretch of a clip that is similar to the query, or to another match.

    clip, start, stop : number of the clip, and its frames [start, stop).
    cost : mean RMS distance to the match that found it, metres, or 0 for the query itself.
    via : the number of the match that found it, or -1 for the query.
    generation : number of steps from the query.
    rows, frames : shape (K,): frames of the query's clip, and the frames of this clip that are aligned with
        them, through all matches in between.
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
    """Find motions similar to a query, then motions similar to those, and so on [KG04, search in steps].

    One step finds only the nearest matches, because two motions of one kind may differ more than two of
    different kinds. But there are others between them [KG04]. The bound on lengths is ours: a wrong match
    becomes a query, and the first wrong match usually aligns a slow motion with a fast one, or the reverse.

    Further steps help if the motions of one kind vary, such as punches at n targets, or slow and brisk walks.
    If they are similar, such as strides at one pace, one step finds as much, and cannot leak. Further steps
    harm if one kind passes into another, such as turns of 90° into turns of 45°. Then restrict the matches by
    `keep`.

    Parameters
    ----------
    web : as from `build_web`.
    clip, frames : the query, given by the number of a clip and its frames.
    below : the largest mean RMS distance between a match and the match that found it, metres. By default that
        of the web. Choose a value around which the number of matches is constant. Above it, one wrong match
        leads to all others of its kind, and hundreds are found.
    lengths : the shortest and the longest match, as fractions of the query's length.
    steps : number of steps, of which the first is that of the query. By default until no match is new.
    still : matches that move less than this are not used as queries, metres RMS about the mean position of
        each point, because standing still is similar to itself at any time. This bound is ours.
    keep : a predicate of the motion of a match, for example of its change of heading. Matches that do not
        satisfy it are neither returned nor used as queries [ours].

    Returns
    -------
    The query, then its matches step by step, in ascending order of cost in each step. A stretch whose overlap
    with a match is more than half of their union counts as that match.

    Raises
    ------
    MocapError : for a query beyond its clip or shorter than the web's paths, and a `below` over the web's.

    Warns
    -----
    MocapWarning : for a query that finds only itself, for matches that are not used as queries because they
        move less than `still`, and for a step that finds more than 5 times the matches of the previous step.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> found = search(web, 0, slice(240, 370))
    >>> [(match.start, match.stop) for match in found[:3]], len(found)
    ([(240, 370), (884, 1016), (1016, 1144)], 8)
    >>> [(match.generation, match.via, round(match.cost, 3)) for match in found[:3]]
    [(0, -1, 0.0), (1, 0, 0.014), (1, 0, 0.014)]

    Notebook: 16-match-webs
    """
    query = _query(web, clip, frames)
    limit = web.below if below is None else below
    check_threshold(limit)
    if limit > web.below:
        raise MocapError(f"This web goes up to {100 * web.below:g} cm: build another for {100 * limit:g} cm.")
    shortest, longest = (fraction * (query.stop - query.start) for fraction in lengths)
    matches = [query]
    spans = np.array([query[1:3]])  # start and stop of each match
    newest = [0]  # numbers of the matches that the last step found
    still_count = 0  # matches that are not used as queries
    while newest and (steps is None or matches[-1].generation < steps):
        moving = [number for number in newest if _spread(web, matches[number]) >= still]
        still_count += len(newest) - len(moving)
        hits = [hit for number in moving for hit in crossings(web, matches[number], number, limit)]
        candidates = [hit for hit in hits if shortest <= hit.stop - hit.start <= longest]
        count = len(matches)
        for rank in in_order([candidate.cost for candidate in candidates], RANKS):
            match = candidates[rank]
            if _is_new(match, spans) and (not keep or keep(cut_out(web, _in_own_frames(web, clip, match)))):
                matches.append(match)
                spans = np.append(spans, [match[1:3]], axis=0)
        newest = list(range(count, len(matches)))
    _warn(matches, still_count)
    in_own_frames = [_in_own_frames(web, clip, match) for match in matches]
    first, last, _ = frames.indices(len(web.clips[clip]))
    in_own_frames[0] = in_own_frames[0]._replace(start=first, stop=last)
    return in_own_frames


def _is_new(match: Match, spans: NDArray[Any]) -> bool:
    """Return whether a stretch overlaps each of the spans (N, 2) by at most half of their union."""
    starts, stops = spans.T
    common = np.minimum(stops, match.stop) - np.maximum(starts, match.start)
    union = np.maximum(stops, match.stop) - np.minimum(starts, match.start)
    return bool((common <= TUNED.same_match * union).all())


def _query(web: MatchWeb, clip: int, frames: slice) -> Match:
    """Return the query as a match in the numbering of all frames, as during the search."""
    if not isinstance(frames, slice):
        raise MocapError(f"The query's frames are a slice such as slice(60, 90), got {described(frames)}.")
    motion = web.clips[clip]
    first = frames.start or 0
    last = len(motion) if frames.stop is None else frames.stop
    if not 0 <= first < last <= len(motion):
        raise MocapError(f"'{motion.name}' has frames 0 to {len(motion) - 1}, got {first}:{last}.")
    start, stop = np.round(web.number(clip, [first, last])).astype(int).tolist()
    stop = min(stop, int(web.starts[clip + 1]))
    if stop - start < TUNED.least_advance:
        length = f"{first}:{last} of '{motion.name}' is {(last - first) / motion.fps:.2g} s"
        raise MocapError(
            f"A query must last {TUNED.least_advance / web.rate:g} s or more, as paths do; {length}."
        )
    rows = np.arange(start, stop, dtype=float)
    return Match(clip, start, stop, 0.0, -1, 0, rows, rows)


def _spread(web: MatchWeb, match: Match) -> float:
    """Compute the RMS distance of the points of a match from their mean positions, metres."""
    step = max(1, round(web.clips[0].fps / web.rate))
    motion = cut_out(web, _in_own_frames(web, match.clip, match))
    points = point_cloud(motion[::step])
    deviations = points - points.mean(axis=0)
    return float(np.sqrt((deviations**2).sum(-1).mean()))


def _in_own_frames(web: MatchWeb, query: int, match: Match) -> Match:
    """Convert a match to the frames of its clip and of the query's clip."""
    start, stop = np.round(web.own_frame(match.clip, match[1:3])).astype(int).tolist()
    stop = min(stop, len(web.clips[match.clip]))
    rows = web.own_frame(query, match.rows)
    frames = web.own_frame(match.clip, match.frames)
    return match._replace(start=start, stop=stop, rows=rows, frames=frames)


def _warn(matches: Sequence[Match], still_count: int) -> None:
    """Warn about a search with still matches, without matches, or with a step that leaks."""
    messages = []
    if still_count:
        still = f"{still_count} of {len(matches)} matches hardly move, so nothing was searched from them"
        messages.append(f"{still}: standing still is similar to itself at any time.")
    if len(matches) == 1:
        messages.append("The query found only itself: raise the limit, or take another query.")
    counts = np.bincount([match.generation for match in matches])
    previous = counts[1:-1]
    following = counts[2:]
    leaks = following[following > np.maximum(TUNED.leak * previous, TUNED.few_matches)]
    if leaks.size:
        leak = f"One step found {leaks[0]} matches, more than {TUNED.leak} times the step before"
        messages.append(f"{leak}: one wrong match may have led to others; lower the limit.")
    for message in messages:
        warn(message)


def crossings(web: MatchWeb, match: Match, number: int, below: float) -> Iterator[Match]:
    """Find the stretches that the paths of a web align with a match, and through it with the query.

    All frames are in the numbering of all clips. A web is symmetric: a path applies to both of its clips.

    Parameters
    ----------
    web : as from `build_web`.
    match, number : the match, and its number among all matches.
    below : the largest mean RMS distance of a path inside the match, metres.

    Examples
    --------
    A path covers 18 of the 20 frames of a match. Frame 11 is aligned with two frames, and gets their mean.
    The path is extended straight to the rest, but not beyond the second clip, which begins at 50:

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
    first = web.cells[web.offsets[:-1]]  # first cell of each path
    last = web.cells[web.offsets[1:] - 1]
    needed = TUNED.cover * (match.stop - match.start)
    generation = match.generation + 1
    for side in (0, 1):
        begin = np.maximum(first[:, side], match.start)
        end = np.minimum(last[:, side], match.stop - 1)
        covered = end - begin + 1
        for path in np.flatnonzero(covered >= needed).tolist():
            cells, costs = web.path(path)
            part = slice(*np.searchsorted(cells[:, side], [match.start, match.stop]))
            cost = float(costs[part].mean())
            if cost <= below:
                inside = cells[part].astype(float)
                start, stop, rows, frames = _carry(web, match, inside[:, side], inside[:, 1 - side])
                clip = web.clip_at(start)
                yield Match(clip, start, stop, cost, number, generation, rows, frames)


def _carry(web: MatchWeb, match: Match, source: Array, target: Array) -> tuple[int, int, Array, Array]:
    """Transfer a match to the other clip of a path, which aligns frames `source` (K,) with `target` (K,).

    The path is extended straight to the ends of the match, but not beyond the other clip.

    Returns
    -------
    The start and stop of the new stretch, the frames of the query that the path covers, and the frames that
    are aligned with them. A frame that is aligned with several gets their mean.
    """
    clip = web.clip_at(int(target[0]))
    extended_start = int(target[0] - (source[0] - match.start))
    extended_stop = int(target[-1] + (match.stop - source[-1]))
    start = max(extended_start, int(web.starts[clip]))
    stop = min(extended_stop, int(web.starts[clip + 1]))
    frames, firsts, counts = np.unique(source, return_index=True, return_counts=True)
    means = np.add.reduceat(target, firsts) / counts
    is_covered = (match.frames >= frames[0]) & (match.frames <= frames[-1])
    return start, stop, match.rows[is_covered], np.interp(match.frames[is_covered], frames, means)


def cut_out(web: MatchWeb, match: Match) -> Motion:
    """Return the motion of a match, cut out of its clip.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.methods.match_webs.webs import build_web
    >>> web = build_web([sample("walk_straight")], below=0.05)
    >>> match = search(web, 0, slice(240, 370))[1]
    >>> match.start, cut_out(web, match)
    (884, Motion('walk_straight', 132 frames at 120 Hz, 1.09 s, 38 joints))

    Notebook: 16-match-webs
    """
    return web.clips[match.clip][match.start : match.stop]
