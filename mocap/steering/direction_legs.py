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
SIDEWAYS = np.radians(75)  # radians between a heading and a line, beyond which a body walks sideways
ROUNDING = 0.8  # metres of line before and after a point that asks for a heading, about one step
ARC = 9  # points of a curve before or after such a point


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
    end = len(merged) - 1
    cuts = [number for number, point in enumerate(merged) if point.wait and 0 < number < end]
    legs = []
    for start, stop in pairwise([0, *cuts, end]):
        stands_first = start > 0 or direction.start == "stand" or merged[0].wait > 0
        stands_last = stop < end or direction.end == "stand" or merged[-1].wait > 0
        is_last = stop == end
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


def times_along(
    leg: Leg, metres: Sequence[float], length: float, elapsed: float
) -> list[tuple[float, float]]:
    """Return pairs of metres along the line of a leg and the time asked for there, after a time elapsed.

    Examples
    --------
    >>> leg = Leg([DirectedPoint(0, 0), DirectedPoint(0, 4, t=7.0)], True, True, True)
    >>> times_along(leg, [0.0, 4.1], length=4.0, elapsed=1.0)
    [(4.0, 6.0)]
    """
    times = []
    for place, point in zip(metres[1:], leg.points[1:], strict=True):
        if point.t is not None:
            times.append((min(place, length), point.t - elapsed))
    return times


def due_at_end(leg: Leg, later: Sequence[Leg], pace: float, settling: float = 0.0) -> float | None:
    """Return when a leg should end so that those after it are in time, seconds; None if none has a time.

    Parameters
    ----------
    leg : the leg.
    later : those after it, before which the walk waits.
    pace : the pace at which they are walked, m/s. They start and stop at half of it.
    settling : for how long the body has stood when a leg ends, which is a part of the wait, seconds.

    Examples
    --------
    After a wait of 2 s, five metres are walked, and one of them at half the pace:

    >>> first = Leg([DirectedPoint(0, 0), DirectedPoint(0, 4, wait=2.0)], True, True, False)
    >>> last = Leg([DirectedPoint(0, 4, wait=2.0), DirectedPoint(5, 4, t=14.0)], True, True, True)
    >>> due_at_end(first, [last], pace=1.0)
    6.0
    """
    if leg.points[-1].t is not None:
        return leg.points[-1].t
    needed = 0.0
    for following in later:
        wait = following.points[0].wait
        needed += wait - min(wait, settling) + 2 * TUNED.starting_metres / pace
        for start, end in pairwise(following.points):
            needed += abs(position_of(end) - position_of(start)) / pace
            if end.t is not None:
                return end.t - needed
    return None


def line_with_headings(points: Sequence[DirectedPoint]) -> list[DirectedPoint]:
    """Return the points of a line that passes its points in the directions of their headings.

    A body that walks faces the way it goes. Near a point that asks for a heading, the line is a curve whose
    tangent there is that heading, if it is within `SIDEWAYS` of both directions of the line. The curve is
    made of a quadratic Bézier arc on either side, at most `ROUNDING` metres long.

    Examples
    --------
    >>> points = [DirectedPoint(0, 0), DirectedPoint(0, 2, heading=0.5), DirectedPoint(2, 4)]
    >>> len(line_with_headings(points)) > 3
    True
    """
    line = [points[0]]
    for previous, point, following in zip(points, points[1:], points[2:], strict=False):
        incoming = position_of(point) - position_of(previous)
        outgoing = position_of(following) - position_of(point)
        if point.heading is None or not is_walked(point.heading, incoming, outgoing):
            line.append(point)
            continue
        tangent = complex(np.exp(1j * point.heading))
        arrival = _arc(position_of(point), -incoming, -tangent)
        departure = _arc(position_of(point), outgoing, tangent)
        for position in [*arrival[::-1], *departure[1:]]:
            line.append(DirectedPoint(position.imag, position.real))
    return [*line, points[-1]]


def _arc(corner: complex, arrow: complex, tangent: complex) -> list[complex]:
    """Return points of a Bézier arc that leaves a corner along a tangent and ends along an arrow."""
    reach = min(ROUNDING, abs(arrow) / 2)
    end = corner + reach * arrow / abs(arrow)
    middle = corner + tangent * reach / 2
    fraction = np.linspace(0, 1, ARC)
    to_middle = corner + fraction * (middle - corner)
    to_end = middle + fraction * (end - middle)
    return [complex(position) for position in to_middle + fraction * (to_end - to_middle)]


def is_walked(heading: float, incoming: complex, outgoing: complex) -> bool:
    """Return whether a heading is near both directions of a line, so that a body that walks can have it."""
    angles = [abs(wrapped(heading - float(np.angle(arrow)))) for arrow in (incoming, outgoing)]
    return bool(max(angles) < SIDEWAYS)


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
