"""When do two groups stand and move alike? Members are matched, and one group is laid on the other.

A configuration is where all members of a group are and how they move. Two of them are alike when some order
of the members and some turn and move of the ground bring one near the other, as windows of two clips are
alike when a planar transform brings their points together. All of this is ours; [LCF05] says only that
configurations are clustered.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Points
from mocap.errors import MocapError

SECONDS = 0.7  # a difference of 1 m/s counts as much as 0.7 m
STARTS = (0.0, 0.5, -0.5)  # radians about where the velocities point
ROUNDS = 5
SLOWEST = 0.2  # m/s; the mean velocity of a slower group has no direction


class Configuration(NamedTuple):
    """Where N members are and how they move, (..., N) complex each; leading axes hold other configurations.

    Examples
    --------
    >>> Configuration(np.array([0j, 1j]), np.array([1 + 0j, 1 + 0j])).velocities.mean()
    np.complex128(1+0j)
    """

    places: Points
    velocities: Points


class Match(NamedTuple):
    """How one configuration lies on another: p ↦ turn · p[order] + move, and the RMS distance left, metres.

    `order` (..., N): which member of the second stands for each of the first.

    Examples
    --------
    >>> Match(np.array(0.1), np.array([1, 0]), np.array(1j), np.array(2j)).order
    array([1, 0])
    """

    rms: Array
    order: Indices
    turn: Points
    move: Points


def seen_from_itself(group: Configuration) -> tuple[Configuration, Points, Points]:
    """See a group from its middle, along its mean velocity: the configuration, the turn and the move back.

    Raises
    ------
    MocapError : for a group that stands, which has no direction.

    Examples
    --------
    >>> group = Configuration(np.array([5j, 7j]), np.array([1j, 1j]))
    >>> own, turn, move = seen_from_itself(group)
    >>> own.places.real.round(6), move
    (array([-1.,  1.]), np.complex128(6j))

    Notebook: 19-group-graphs
    """
    middle, way = group.places.mean(axis=-1), group.velocities.mean(axis=-1)
    if not (np.abs(way) >= SLOWEST).all():
        raise MocapError(
            f"A group that moves by {np.abs(way).min():.2f} m/s on average has no direction; "
            f"{SLOWEST:g} m/s is the least."
        )
    turn = way / np.abs(way)
    places = (group.places - middle[..., None]) * turn[..., None].conj()
    return Configuration(places, group.velocities * turn[..., None].conj()), turn, middle


def compare(
    first: Configuration, second: Configuration, *, starts: tuple[float, ...] = STARTS, rounds: int = ROUNDS
) -> Match:
    """Match the members of two groups, and lay the second on the first [ours].

    The RMS over members of |p - T p'|² + τ² |v - e^{iθ} v'|² is made small, τ = 0.7 s, by turns: for a given
    T = (θ, move) the best order is an assignment; for a given order the best T has a closed form,
    θ = arg(Σ (p - p̄)(p' - p̄')* + τ² Σ v v'*), move = p̄ - e^{iθ} p̄'. Both lower the same sum, so it ends. It
    starts where the mean velocities point, and half a radian to either side.

    Parameters
    ----------
    first, second : (..., N); leading axes broadcast, and each pair is matched by itself.
    starts : radians, the turns to start from.
    rounds : the largest number of rounds.

    Raises
    ------
    MocapError : for groups of different sizes, numbers that are not finite, and no round.

    Examples
    --------
    A group that was turned, moved and renumbered is the same group:

    >>> group = Configuration(np.array([0j, 1 + 0j, 3j]), np.array([1 + 0j, 1 + 0.1j, 1 - 0.1j]))
    >>> other = Configuration(1j * group.places[::-1] + 5, 1j * group.velocities[::-1])
    >>> match = compare(group, other)
    >>> float(match.rms) < 1e-9, match.order
    (True, array([2, 1, 0]))

    Notebook: 19-group-graphs
    """
    if rounds < 1 or not starts or not np.isfinite(starts).all():
        raise MocapError(f"A comparison takes a round or more from finite turns, got {rounds} and {starts}.")
    pairs, shape = _pairs(first, second)
    tried = [_by_turns(pairs, start, rounds) for start in starts]
    best = np.argmin([match.rms for match in tried], axis=0)
    parts = (np.stack(part)[best, np.arange(len(best))] for part in zip(*tried, strict=True))
    return Match._make(part.reshape((*shape, *part.shape[1:])) for part in parts)


class _Pairs(NamedTuple):
    """M pairs of configurations, (M, N) each."""

    places: Points
    velocities: Points
    other_places: Points
    other_velocities: Points


def _pairs(first: Configuration, second: Configuration) -> tuple[_Pairs, tuple[int, ...]]:
    """Put all pairs in a row."""
    sizes = first.places.shape[-1], second.places.shape[-1]
    if sizes[0] != sizes[1]:
        raise MocapError(f"Groups of {sizes[0]} and {sizes[1]} members cannot be matched.")
    if any(group.places.shape != group.velocities.shape for group in (first, second)):
        raise MocapError("A configuration has one place and one velocity for each member.")
    parts = np.broadcast_arrays(*first, *second)
    if not all(np.isfinite(part).all() for part in parts):
        raise MocapError("A configuration has places and velocities that are not finite.")
    return _Pairs._make(part.reshape(-1, sizes[0]) for part in parts), parts[0].shape[:-1]


def _by_turns(pairs: _Pairs, start: float, rounds: int) -> Match:
    """Assign and lay on by turns, from one turn, until no pair gets nearer."""
    way, other_way = pairs.velocities.mean(-1), pairs.other_velocities.mean(-1)
    turn = np.exp(1j * (np.angle(way * other_way.conj()) + start))
    move = pairs.places.mean(-1) - turn * pairs.other_places.mean(-1)
    before = np.full(len(turn), np.inf)
    for _ in range(rounds):
        square = assignment_costs(pairs, turn, move)
        order = np.array([linear_sum_assignment(costs)[1] for costs in square])
        turn, move, rms = _laid(pairs, order)
        if (rms > before - 1e-9).all():
            break
        before = rms
    return Match(rms, order, turn, move)


def assignment_costs(pairs: _Pairs, turn: Points, move: Points) -> Array:
    """Say what it costs to take member j of the second for member i of the first, (M, N, N) m²."""
    there = turn[:, None] * pairs.other_places + move[:, None]
    going = turn[:, None] * pairs.other_velocities
    gap = pairs.places[:, :, None] - there[:, None]
    change = pairs.velocities[:, :, None] - going[:, None]
    return np.asarray(gap.real**2 + gap.imag**2 + SECONDS**2 * (change.real**2 + change.imag**2))


def _laid(pairs: _Pairs, order: Indices) -> tuple[Points, Points, Array]:
    """Lay the second on the first, its members in an order: turn, move, RMS distance."""
    there, going = (np.take_along_axis(part, order, axis=-1) for part in pairs[2:])
    middle, other = pairs.places.mean(-1), there.mean(-1)
    cross = ((pairs.places - middle[:, None]) * (there - other[:, None]).conj()).sum(-1)
    cross = cross + SECONDS**2 * (pairs.velocities * going.conj()).sum(-1)
    turn = cross / np.maximum(np.abs(cross), 1e-12)
    move = middle - turn * other
    gap = np.abs(pairs.places - turn[:, None] * there - move[:, None])
    change = np.abs(pairs.velocities - turn[:, None] * going)
    return turn, move, np.sqrt((gap**2 + SECONDS**2 * change**2).mean(-1))
