"""Functions that exercises get as arguments.

A check passes them to the student's function. While notebooks are marked they are sent to the student's
process, which imports them from here.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

State = tuple[int, int]
"""A node, and the number of edges walked before it."""

Links = dict[int, list[tuple[float, int, int]]]
"""Similar motions of each motion: the cost, the other motion, and the frames between them."""

MatchesOf = Callable[[int], list[tuple[float, int]]]
"""From a motion to the similar ones, as pairs (cost, motion)."""

MOST_REQUESTS = 400  # calls of `matches_of`; a right answer needs far fewer
FRAMES_APART = 10  # between two motions of notebook 16


def ways_from(lengths: dict[int, dict[int, float]], longest: int, state: State) -> list[tuple[float, State]]:
    """Return the edges that leave the end of a walk, unless the walk has so many already.

    Examples
    --------
    >>> ways_from({1: {2: 0.5}, 2: {}}, 3, (1, 0))
    [(0.5, (2, 1))]
    """
    node, walked = state
    if walked >= longest:
        return []
    return [(length, (end, walked + 1)) for end, length in lengths[node].items()]


def counted_ways_from(
    requests: list[State], lengths: dict[int, dict[int, float]], longest: int, state: State
) -> list[tuple[float, State]]:
    """Return the edges that leave the end of a walk, as `ways_from` does, and note the request.

    Examples
    --------
    >>> requests = []
    >>> counted_ways_from(requests, {1: {2: 0.5}, 2: {}}, 3, (1, 0)), requests
    ([(0.5, (2, 1))], [(1, 0)])
    """
    requests.append(state)
    return ways_from(lengths, longest, state)


def noted_requests(argument: Any) -> list[State] | None:  # noqa: ANN401
    """Return the list in which an argument of `counted_ways_from` notes its requests; None if it notes none.

    Parameters
    ----------
    argument : any argument of an exercise.

    Examples
    --------
    >>> noted_requests(partial(counted_ways_from, [(1, 0)], {1: {}}, 3)), noted_requests(len)
    ([(1, 0)], None)
    """
    if isinstance(argument, partial) and argument.func is counted_ways_from:
        requests: list[State] = argument.args[0]
        return requests
    return None


def is_at(goal: int, state: State) -> bool:
    """Return whether a walk is at its goal.

    Examples
    --------
    >>> is_at(3, (3, 1))
    True
    """
    node, _ = state
    return node == goal


def found_near(links: Links, requests: list[int], match: int) -> list[tuple[float, int]]:
    """Return what is similar to a match, as pairs (cost, match): motions ten frames apart, and a few off.

    Raises
    ------
    RecursionError : after so many requests that the search does not end.

    Examples
    --------
    >>> found_near({0: [(1.5, 2, 1)]}, [], 0)
    [(1.5, 21)]
    """
    requests.append(match)
    if len(requests) > MOST_REQUESTS:
        raise RecursionError(
            f"it has asked {MOST_REQUESTS} times and does not end: what is found again, at nearly the same "
            "frames, is not new"
        )
    motion = (match + FRAMES_APART // 2) // FRAMES_APART
    return [(cost, FRAMES_APART * target + offset) for cost, target, offset in links[motion]]
