"""Distance between configurations of a group, and the clusters of those that recur [LCF05].

A configuration is the positions and velocities of all members of a group. Two configurations are similar if
an order of the members and a planar rigid transform align one with the other, as two windows of clips are
similar if a planar transform aligns their points. All of this is ours. [LCF05] says only that configurations
are clustered.
"""

import numpy as np
from scipy.optimize import linear_sum_assignment

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least, whole_steps
from mocap.errors import MocapError, warn
from mocap.methods.groups.flocking import RATE, Configuration
from mocap.methods.groups.tuned import TUNED

# m² and metres: orders of the members whose costs differ by less are equal, as are RMS distances. Rounding is
# about 1e-12. Similar configurations differ by decimetres.
EQUAL_COSTS = 1e-6
EQUAL = 1e-9

CACHED = 200_000  # costs that are computed at a time, which stay in the processor's cache

TINY = 1e-12  # m², the correlation of positions and velocities below which there is no best rotation


class Match(NamedTuple):
    """A match of two configurations: p ↦ rotation · p[order] + translation, and the RMS residual, metres.

    `order` (..., N): the member of the second group that corresponds to each member of the first.

    Examples
    --------
    >>> Match(np.array(0.1), np.array([1, 0]), np.array(1j), np.array(2j)).order
    array([1, 0])
    """

    rms: Array
    order: Indices
    rotation: Points
    translation: Points


def seen_from_itself(group: Configuration) -> tuple[Configuration, Points, Points]:
    """Express a group relative to its centre and mean velocity, with the transform back to the ground.

    Raises
    ------
    MocapError : for a group slower than 0.2 m/s, which has no direction.

    Examples
    --------
    A group moves to the left at 0.2 m/s, the lowest speed that has a direction:

    >>> group = Configuration(np.array([5j, 7j]), np.array([0.1j, 0.3j]))
    >>> local, rotation, translation = seen_from_itself(group)
    >>> local.positions.real.round(6).tolist(), local.velocities.real.round(6).tolist()
    ([-1.0, 1.0], [0.1, 0.3])
    >>> complex(rotation), complex(translation)
    (1j, 6j)

    Notebook: 19-group-graphs
    """
    middle = group.positions.mean(axis=-1)
    velocity = group.velocities.mean(axis=-1)
    speed = np.abs(velocity)
    if not (speed >= TUNED.slowest).all():
        slow = f"A group that moves by {speed.min():.2f} m/s on average has no direction"
        raise MocapError(f"{slow}; {TUNED.slowest:g} m/s is the least.")
    rotation = velocity / speed
    inverse = rotation[..., None].conj()
    positions = (group.positions - middle[..., None]) * inverse
    return Configuration(positions, group.velocities * inverse), rotation, middle


def compare(
    first: Configuration,
    second: Configuration,
    *,
    starts: tuple[float, ...] = TUNED.starts,
    rounds: int = TUNED.rounds,
) -> Match:
    """Match the members of two groups, and align the second with the first [ours].

    Alternating minimisation of the mean over members of |p - T p'|² + τ² |v - e^{iθ} v'|², τ = 0.7 s. For a
    given T = (θ, t), the best order is a linear assignment problem. For a given order, the best T is
    θ = arg(Σ (p - p̄)(p' - p̄')* + τ² Σ v v'*), t = p̄ - e^{iθ} p̄'. Both steps lower the same sum, so the
    alternation converges to a local minimum. It starts from the rotation that aligns the mean velocities,
    and from half a radian to the left and to the right of it.

    Parameters
    ----------
    first, second : (..., N). Leading axes broadcast, and each pair is matched independently.
    starts : radians, the initial rotations, relative to that of the mean velocities.
    rounds : the largest number of rounds.

    Raises
    ------
    MocapError : for groups of different sizes.

    Examples
    --------
    A group that was rotated, translated and renumbered is the same group:

    >>> group = Configuration(np.array([0j, 1 + 0j, 3j]), np.array([1 + 0j, 1 + 0.1j, 1 - 0.1j]))
    >>> other = Configuration(1j * group.positions[::-1] + 5, 1j * group.velocities[::-1])
    >>> match = compare(group, other)
    >>> float(match.rms) < 1e-9, match.order
    (True, array([2, 1, 0]))

    Notebook: 19-group-graphs
    """
    members = first.positions.shape[-1]
    if second.positions.shape[-1] != members:
        raise MocapError(f"Groups of {members} and {second.positions.shape[-1]} members cannot be matched.")
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

    The initial rotation aligns the mean velocities, plus `start` radians.
    """
    direction = first.velocities.mean(axis=1)
    second_direction = second.velocities.mean(axis=1)
    rotation = np.exp(1j * (np.angle(direction * second_direction.conj()) + start))
    translation = first.positions.mean(axis=1) - rotation * second.positions.mean(axis=1)
    match = Match(np.full(len(rotation), np.inf), np.zeros(0, int), rotation, translation)
    for _ in range(rounds):
        previous = match.rms
        match = _align(first, second, _best_orders(first, second, match.rotation, match.translation))
        if (match.rms > previous - EQUAL).all():
            break
    return match


def _best_orders(
    first: Configuration, second: Configuration, rotation: Points, translation: Points
) -> Indices:
    """Find the order of the second's members that matches the first's at the least cost, (M, N)."""
    pairs, members = first.positions.shape
    block = max(1, CACHED // members**2)
    orders = []
    for start in range(0, pairs, block):
        rows = slice(start, start + block)
        first_rows = Configuration(*(field[rows] for field in first))
        second_rows = Configuration(*(field[rows] for field in second))
        squares = assignment_costs(first_rows, second_rows, rotation[rows], translation[rows])
        # Integers have no rounding errors: orders of equal cost stay equal.
        orders += [linear_sum_assignment(costs)[1] for costs in whole_steps(squares, EQUAL_COSTS)]
    return np.array(orders)


def _align(first: Configuration, second: Configuration, order: Indices) -> Match:
    """Compute the best rotation and translation for an order of the second's members: the closed form."""
    positions, velocities = (np.take_along_axis(field, order, axis=1) for field in second)
    middle = first.positions.mean(axis=1)
    second_middle = positions.mean(axis=1)
    offsets = first.positions - middle[:, None]
    second_offsets = positions - second_middle[:, None]
    correlation = (offsets * second_offsets.conj()).sum(axis=1)
    correlation = correlation + TUNED.velocity_seconds**2 * (first.velocities * velocities.conj()).sum(axis=1)
    rotation = correlation / np.maximum(np.abs(correlation), TINY)
    translation = middle - rotation * second_middle
    residual = np.abs(first.positions - rotation[:, None] * positions - translation[:, None])
    change = np.abs(first.velocities - rotation[:, None] * velocities)
    squares = residual**2 + TUNED.velocity_seconds**2 * change**2
    return Match(np.sqrt(squares.mean(axis=1)), order, rotation, translation)


def assignment_costs(
    first: Configuration, second: Configuration, rotation: Points, translation: Points
) -> Array:
    """Compute the cost of matching member i of the first with member j of the second, (M, N, N) m².

    Examples
    --------
    Two members are 1 m apart. The second group is the first one, transformed and at twice the speed, which
    adds 0.7² m² to every cost:

    >>> one = Configuration(np.array([[0j, 1 + 0j]]), np.array([[1 + 0j, 1 + 0j]]))
    >>> other = Configuration(np.array([[5j, 6j]]), np.array([[2j, 2j]]))
    >>> assignment_costs(one, other, np.array([-1j]), np.array([-5 + 0j])).round(2).tolist()
    [[[0.49, 1.49], [1.49, 0.49]]]
    """
    aligned_positions = rotation[:, None] * second.positions + translation[:, None]
    aligned_velocities = rotation[:, None] * second.velocities
    rows = _coordinates(first.positions, first.velocities)
    columns = _coordinates(aligned_positions, aligned_velocities)
    # |a - b|² = |a|² - 2 a·b + |b|², whose middle term is a product of matrices.
    costs = rows @ (-2 * columns.swapaxes(1, 2))
    costs += (rows**2).sum(axis=2)[:, :, None]
    costs += (columns**2).sum(axis=2)[:, None]
    return np.asarray(costs)


def _coordinates(positions: Points, velocities: Points) -> Array:
    """Return the coordinates between which costs are squared distances, (M, N, 4): p and τ v by parts."""
    scaled = TUNED.velocity_seconds * velocities
    return np.stack([positions.real, positions.imag, scaled.real, scaled.imag], axis=2)


class Clusters(NamedTuple):
    """Nodes, their frames, and the fraction of the simulation within `reach` of a node.

    `distances` (S, S), metres: between all pairs of the S frames that were compared.
    """

    nodes: tuple[Configuration, ...]
    frames: Indices
    covered: float
    distances: Array


def cluster(flock: Configuration, *, nodes: int = 8, reach: float = 0.5) -> Clusters:
    """Choose configurations that recur [LCF05, nodes], by a greedy rule of ours.

    Each node is the frame with the most frames within `reach` that no earlier node covers. The comparison
    takes O(S² N³) for S frames of N members, most of the time of building a graph.

    Parameters
    ----------
    flock : as from `simulate`.
    nodes : largest number of nodes. There are fewer if these cover all frames.
    reach : metres, RMS.

    Raises
    ------
    MocapError : for a group that stands still.

    Warns
    -----
    MocapWarning : if less than 80 % of the simulation is within `reach` of a node.

    Examples
    --------
    Two nodes cover all frames within 0.5 m. Within 0.3 m, eight nodes cover 98 %:

    >>> from mocap.methods.groups.flocking import simulate
    >>> flock = simulate(4, 60)
    >>> coarse = cluster(flock)
    >>> coarse.frames.tolist(), coarse.covered
    ([440, 190], 1.0)
    >>> fine = cluster(flock, reach=0.3)
    >>> len(fine.nodes), round(fine.covered, 2)
    (8, 0.98)

    Notebook: 19-group-graphs
    """
    step = round(TUNED.node_interval * RATE)
    seen, _, _ = seen_from_itself(Configuration(*(field[::step] for field in flock)))
    rows = list(map(Configuration, *seen))
    distances = np.zeros((len(rows),) * 2)
    for row in range(1, len(rows)):  # compare with all earlier frames, from one start
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
    if covered < TUNED.covered:
        coverage = f"{len(chosen)} nodes are within {reach:g} m of {covered:.0%} of the simulation"
        warn(f"{coverage}: take more nodes, or a larger reach.")
    return Clusters(tuple(rows[row] for row in chosen), np.array(chosen) * step, covered, distances)
