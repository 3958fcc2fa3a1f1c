"""When do two groups stand and move alike, and which moments come again and again? [LCF05].

A configuration is where all members of a group are and how they move. Two of them are alike when some order
of the members and some turn and move of the ground bring one near the other, as windows of two clips are
alike when a planar transform brings their points together. All of this is ours; [LCF05] says only that
configurations are clustered.
"""

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least, whole_steps
from mocap.errors import MocapError, warn
from mocap.methods.groups.flocking import RATE, Configuration

SECONDS = 0.7  # a difference of 1 m/s counts as much as 0.7 m
STARTS = (0.0, 0.5, -0.5)  # radians about where the velocities point
ROUNDS = 5
EVERY = 1.0  # seconds between the frames that nodes are chosen from
COVERED = 0.8  # a smaller share of the simulation near a node is warned of
SLOWEST = 0.2  # m/s; the mean velocity of a slower group has no direction

# m² and metres: orders of the members whose costs differ by less are equal, as are RMS distances. Rounding is
# some 1e-12; two groups that are alike are decimetres apart.
EQUAL_COSTS = 1e-6
EQUAL = 1e-9

TINY = 1e-12  # m²; groups whose places and velocities correlate by less have no best rotation


class Match(NamedTuple):
    """A match of two configurations: p ↦ turn · p[order] + move, and the RMS residual, metres.

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
    """See a group from its middle, along its mean velocity, and return the rotation and translation back.

    Raises
    ------
    MocapError : for a group that stands, which has no direction.

    Examples
    --------
    It goes to the left at 0.2 m/s, the least there may be:

    >>> group = Configuration(np.array([5j, 7j]), np.array([0.1j, 0.3j]))
    >>> own, turn, move = seen_from_itself(group)
    >>> own.places.real.round(6).tolist(), own.velocities.real.round(6).tolist()
    ([-1.0, 1.0], [0.1, 0.3])
    >>> complex(turn), complex(move)
    (1j, 6j)

    Notebook: 19-group-graphs
    """
    middle = group.places.mean(axis=-1)
    velocity = group.velocities.mean(axis=-1)
    speed = np.abs(velocity)
    if not (speed >= SLOWEST).all():
        slow = f"A group that moves by {speed.min():.2f} m/s on average has no direction"
        raise MocapError(f"{slow}; {SLOWEST:g} m/s is the least.")
    rotation = velocity / speed
    inverse = rotation[..., None].conj()
    places = (group.places - middle[..., None]) * inverse
    return Configuration(places, group.velocities * inverse), rotation, middle


def compare(
    first: Configuration, second: Configuration, *, starts: tuple[float, ...] = STARTS, rounds: int = ROUNDS
) -> Match:
    """Match the members of two groups, and align the second with the first [ours].

    The RMS over members of |p - T p'|² + τ² |v - e^{iθ} v'|² is reduced, τ = 0.7 s, in alternation. For a
    given T = (θ, move) the best order is an assignment; for a given order the best T has a closed form,
    θ = arg(Σ (p - p̄)(p' - p̄')* + τ² Σ v v'*), move = p̄ - e^{iθ} p̄'. Both lower the same sum, so it ends. It
    starts where the mean velocities point, and half a radian to either side.

    Parameters
    ----------
    first, second : (..., N); leading axes broadcast, and each pair is matched by itself.
    starts : radians, the turns to start from.
    rounds : the largest number of rounds.

    Raises
    ------
    MocapError : for groups of different sizes.

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
    members = first.places.shape[-1]
    if second.places.shape[-1] != members:
        raise MocapError(f"Groups of {members} and {second.places.shape[-1]} members cannot be matched.")
    fields = np.broadcast_arrays(*first, *second)
    leading = fields[0].shape[:-1]
    rows = [field.reshape(-1, members) for field in fields]
    first_rows = Configuration(*rows[:2])
    second_rows = Configuration(*rows[2:])
    trials = [_alternate(first_rows, second_rows, start, rounds) for start in starts]
    best = first_least([match.rms for match in trials], EQUAL, axis=0)
    best_fields = [np.stack(field)[best, np.arange(len(best))] for field in zip(*trials, strict=True)]
    return Match._make(field.reshape((*leading, *field.shape[1:])) for field in best_fields)


def _alternate(first: Configuration, second: Configuration, start: float, rounds: int) -> Match:
    """Alternate between assignment and alignment of M pairs, (M, N) each, until no pair improves.

    The first rotation is from one mean velocity to the other, and `start` radians more.
    """
    direction = first.velocities.mean(axis=1)
    second_direction = second.velocities.mean(axis=1)
    turn = np.exp(1j * (np.angle(direction * second_direction.conj()) + start))
    move = first.places.mean(axis=1) - turn * second.places.mean(axis=1)
    match = Match(np.full(len(turn), np.inf), np.zeros(0, int), turn, move)
    for _ in range(rounds):
        previous = match.rms
        squares = assignment_costs(first, second, match.turn, match.move)
        # Whole numbers have no rounding, so equal orders stay equal.
        order = np.array([linear_sum_assignment(costs)[1] for costs in whole_steps(squares, EQUAL_COSTS)])
        match = _align(first, second, order)
        if (match.rms > previous - EQUAL).all():
            break
    return match


def _align(first: Configuration, second: Configuration, order: Indices) -> Match:
    """Compute the best rotation and translation for an order of the second's members: the closed form."""
    places, velocities = (np.take_along_axis(field, order, axis=1) for field in second)
    middle = first.places.mean(axis=1)
    second_middle = places.mean(axis=1)
    offsets = first.places - middle[:, None]
    second_offsets = places - second_middle[:, None]
    correlation = (offsets * second_offsets.conj()).sum(axis=1)
    correlation = correlation + SECONDS**2 * (first.velocities * velocities.conj()).sum(axis=1)
    turn = correlation / np.maximum(np.abs(correlation), TINY)
    move = middle - turn * second_middle
    residual = np.abs(first.places - turn[:, None] * places - move[:, None])
    change = np.abs(first.velocities - turn[:, None] * velocities)
    squares = residual**2 + SECONDS**2 * change**2
    return Match(np.sqrt(squares.mean(axis=1)), order, turn, move)


def assignment_costs(first: Configuration, second: Configuration, turn: Points, move: Points) -> Array:
    """Compute the cost of matching member i of the first with member j of the second, (M, N, N) m².

    Examples
    --------
    Two stand 1 m apart. Two others were turned and moved, and go twice as fast: this adds 0.7² m² everywhere.

    >>> one = Configuration(np.array([[0j, 1 + 0j]]), np.array([[1 + 0j, 1 + 0j]]))
    >>> other = Configuration(np.array([[5j, 6j]]), np.array([[2j, 2j]]))
    >>> assignment_costs(one, other, np.array([-1j]), np.array([-5 + 0j])).round(2).tolist()
    [[[0.49, 1.49], [1.49, 0.49]]]
    """
    aligned_places = turn[:, None] * second.places + move[:, None]
    aligned_velocities = turn[:, None] * second.velocities
    residual = first.places[:, :, None] - aligned_places[:, None]
    change = first.velocities[:, :, None] - aligned_velocities[:, None]
    squared_change = change.real**2 + change.imag**2
    return np.asarray(residual.real**2 + residual.imag**2 + SECONDS**2 * squared_change)


class Clusters(NamedTuple):
    """Nodes, which frame each was, and the share of the simulation within `reach` of one.

    `distances` (S, S), metres: of any two of the S frames that were looked at.
    """

    nodes: tuple[Configuration, ...]
    frames: Indices
    covered: float
    distances: Array


def cluster(flock: Configuration, *, nodes: int = 8, reach: float = 0.5) -> Clusters:
    """Choose configurations that recur [LCF05, nodes]; the rule is ours.

    Each node is the frame with the most frames within `reach` that are near no node yet. Comparing is
    O(S² N³) for S frames of N members: this is the longest part of building a graph.

    Parameters
    ----------
    flock : as `simulate` gives it.
    nodes : how many to choose at most; fewer where all are covered.
    reach : metres, RMS.

    Raises
    ------
    MocapError : for a group that stands.

    Warns
    -----
    MocapWarning : where less than 80 % of the simulation are within `reach` of a node.

    Examples
    --------
    Of one frame a second, two are enough; eight that reach less far leave out 2 %:

    >>> from mocap.methods.groups.flocking import simulate
    >>> found, fine = cluster(simulate(4, 60)), cluster(simulate(4, 60), reach=0.3)
    >>> found.frames.tolist(), found.covered
    ([440, 190], 1.0)
    >>> len(fine.nodes), round(fine.covered, 2)
    (8, 0.98)

    Notebook: 19-group-graphs
    """
    step = round(EVERY * RATE)
    seen, _, _ = seen_from_itself(Configuration(*(field[::step] for field in flock)))
    rows = list(map(Configuration, *seen))
    distances = np.zeros((len(rows),) * 2)
    for row in range(1, len(rows)):  # with all earlier ones, from the direction of the velocities alone
        earlier = Configuration(*(field[:row] for field in seen))
        rms = compare(rows[row], earlier, starts=(0.0,), rounds=2).rms
        distances[row, :row] = distances[:row, row] = rms
    free: Mask = np.ones(len(distances), bool)
    chosen: list[int] = []
    while len(chosen) < nodes and free.any():
        best = int(((distances < reach) & free).sum(axis=1).argmax())
        chosen.append(best)
        free &= distances[best] >= reach
    covered = 1 - float(free.mean())
    if covered < COVERED:
        coverage = f"{len(chosen)} nodes are within {reach:g} m of {covered:.0%} of what was simulated"
        warn(f"{coverage}: take more nodes, or a larger reach.")
    return Clusters(tuple(rows[row] for row in chosen), np.array(chosen) * step, covered, distances)
