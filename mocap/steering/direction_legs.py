"""The legs of a direction: its parts between the places where the walk waits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from mocap._shared.arrays import Points
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError
from mocap.files.directions import DirectedPoint, Direction
from mocap.steering.anchoring import wrapped
from mocap.steering.tuned import TUNED

SAME = 1e-6  # metres between two points that are one


class Leg(NamedTuple):
    """The part of a direction between two places where the walk stands, or its ends.

    Parameters
    ----------
    points : two or more. The wait at the first one is before the leg.
    stands_first, stands_last : whether the walk stands at its ends.
    is_last : whether it is the last leg.
    """

    points: list[DirectedPoint]
    stands_first: bool
    stands_last: bool
    is_last: bool


def legs_of(direction: Direction) -> list[Leg]:
    """Cut a direction into legs where it waits; points in one place become one, with a wait between them.

    Raises
    ------
    MocapError : if all points are in one place.

    Examples
    --------
    >>> points = [DirectedPoint(0, 0), DirectedPoint(0, 4, wait=2.0), DirectedPoint(3, 4)]
    >>> first, last = legs_of(Direction(points, end="stand"))
    >>> first.stands_first, first.stands_last, last.stands_last
    (False, True, True)
    """
    merged: list[DirectedPoint] = []
    for point in direction.points:
        if merged and abs(position_of(merged[-1]) - position_of(point)) < SAME:
            merged[-1] = _stay(merged[-1], point)
        else:
            merged.append(point)
    if len(merged) < 2:
        raise MocapError("All points of the direction are in one place: a walk needs a line.")
    if direction.facing is not None:
        merged[-1] = merged[-1]._replace(heading=direction.facing)
    cuts = [number for number, point in enumerate(merged) if point.wait and 0 < number < len(merged) - 1]
    legs = []
    for start, stop in pairwise([0, *cuts, len(merged) - 1]):
        stands_first = start > 0 or direction.start == "stand" or merged[0].wait > 0
        stands_last = stop < len(merged) - 1 or direction.end == "stand" or merged[-1].wait > 0
        is_last = stop == len(merged) - 1
        legs.append(Leg(merged[start : stop + 1], stands_first, stands_last, is_last))
    return legs


def _stay(arrival: DirectedPoint, departure: DirectedPoint) -> DirectedPoint:
    """Return a point at which a walk stays from the time of one point to that of another."""
    times = [point.t for point in (arrival, departure) if point.t is not None]
    between = times[1] - times[0] if len(times) > 1 else 0.0
    heading = arrival.heading if departure.heading is None else departure.heading
    wait = arrival.wait + departure.wait + between
    return arrival._replace(wait=wait, heading=heading, label=departure.label or arrival.label)


def position_of(point: DirectedPoint) -> complex:
    """Return the position of a point as z + ix."""
    return complex(point.z, point.x)


def rotations_at_ends(leg: Leg, line: Points, heading: float | None) -> tuple[float, float]:
    """Return the rotations of the body at the ends of a leg, if it is to face another way there.

    Up to `TUNED.turned_from`, the search and its correction are expected to turn the body.

    Parameters
    ----------
    leg : the leg.
    line : the points of its line, which may be led around discs.
    heading : the heading of the body at its start, radians; None for any.
    """
    directions = np.angle([line[1] - line[0], line[-1] - line[-2]]).tolist()
    last = leg.points[-1].heading
    wanted: Sequence[float | None] = (
        heading if leg.stands_first else None,
        last if leg.stands_last else None,
    )
    turns = [0.0, 0.0]
    for end, (direction, facing) in enumerate(zip(directions, wanted, strict=True)):
        turn = 0.0 if facing is None else wrapped(facing - direction)
        turns[end] = turn if abs(turn) > TUNED.turned_from else 0.0
    return turns[0], turns[1]


def spare_seconds(leg: Leg, pace: float, elapsed: float) -> float:
    """Return how long a body can wait before a leg, to be in time at its first point that asks for a time.

    Parameters
    ----------
    leg : the leg.
    pace : the pace at which it is walked, m/s.
    elapsed : the time so far, seconds.

    Returns
    -------
    Seconds, negative for a walk that is late; 0 if no time is asked for.

    Examples
    --------
    >>> leg = Leg([DirectedPoint(0, 0), DirectedPoint(0, 4, t=7.0)], True, True, True)
    >>> spare_seconds(leg, pace=1.0, elapsed=0.0)
    3.0
    """
    metres = 0.0
    for start, end in pairwise(leg.points):
        metres += abs(position_of(end) - position_of(start))
        if end.t is not None:
            return float(end.t - elapsed - metres / pace)
    return 0.0
