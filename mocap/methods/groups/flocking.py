"""A flock of walking people, simulated by Reynolds' three rules [Rey87], with random drift of each member.

Members are repelled by those who are near, attracted by those in sight, and align their velocities with them.
Each also steers towards a desired velocity and keeps a pace. The parameters are those of walking people, not
of birds [ours]. Each member's desired velocity drifts at random: its *whim*. Without whims a flock settles
into a lattice that hardly changes, and a graph of it would be small.

Points on the ground are complex numbers, z + ix, at ten frames per second.
"""

from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, Indices, Points, ranges
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError
from mocap.methods.groups.tuned import TUNED

RATE = 10.0  # frames per second
APART = 0.6  # metres, the distance below which members collide
BODY = 0.35  # metres that a member keeps from a wall


SELF = 1e9  # metres, a distance of each member from itself at which no rule applies
SCREEN = 1e-6  # metres by which members may be farther apart along z: above all rounding
STILL = 1e-9  # m/s or m/s², a divisor for members that do not move

Disc = tuple[complex, float]
"""An obstacle: its centre on the ground and its radius, metres."""


class Flock(NamedTuple):
    """Parameters of the flocking rules: lengths in metres, speeds in m/s, accelerations in m/s².

    Members repel within `space`, and align and cohere within `sight`. `separate`, `gather`, `align`, `steer`
    and `keep` are the weights of the rules. `whim` scales the drift of each member's desired velocity. Discs
    nearer than `avoid` repel. Flocks side by side may differ in `gather` and `avoid`, (K, 1).

    Examples
    --------
    >>> Flock(pace=1.3).pace
    1.3
    """

    sight: float = 4.0
    space: float = 1.4
    separate: float = 3.0
    gather: float | Array = 0.35
    align: float = 0.8
    steer: float = 0.9
    pace: float = 1.1
    keep: float = 1.0
    slowest: float = 0.5
    fastest: float = 1.6
    accelerate: float = 1.5
    whim: float = 0.5
    avoid: float | Array = 2.0


class Configuration(NamedTuple):
    """The `positions` and `velocities` of N members, (..., N) complex each.

    Leading axes are further configurations: frames, ten per second, or runs side by side.

    Examples
    --------
    >>> Configuration(np.array([0j, 1j]), np.array([1 + 0j, 1 + 0j])).velocities.mean()
    np.complex128(1+0j)
    """

    positions: Points
    velocities: Points


def whims(shape: tuple[int, ...], rules: Flock, random: np.random.Generator) -> Iterator[Points]:
    """Yield the whims of the members frame by frame: random drifts of direction and pace about the group's.

    Both are Ornstein-Uhlenbeck processes, which decay in two and in four seconds.

    Parameters
    ----------
    shape : the shape of the group, (..., N), with any leading axes for runs side by side.
    rules : `whim` scales the drift.
    random : draws the whims.

    Yields
    ------
    Complex numbers of that shape: a direction times a fraction of the pace.
    """
    step = 1 / RATE
    drift = np.sqrt(1 / RATE) * rules.whim
    direction = np.zeros(shape)
    pace = np.zeros(shape)
    while True:
        direction += -step * direction / TUNED.direction_time + drift * random.normal(size=shape)
        pace += -step * pace / TUNED.pace_time + drift * TUNED.pace_whim * random.normal(size=shape)
        yield np.asarray(np.exp(1j * direction) * np.clip(1 + pace, *TUNED.paces))


def steering_force(
    group: Configuration, desired: Points, rules: Flock, external: Points | float = 0.0
) -> Points:
    """Compute the acceleration of each member by the flocking rules [Rey87], m/s².

    separate · Σ ê (space - d) / space over those nearer than `space`, gather · (mean position - p) and
    align · (mean velocity - v) over those in sight, steer · (desired direction - v̂) and
    keep · (desired pace - |v|) v̂ [ours], limited to `accelerate`.

    Parameters
    ----------
    group : positions and velocities, (..., N). Leading axes are independent runs.
    desired : (..., N), the desired direction times a fraction of the pace.
    rules : the parameters.
    external : (..., N), additional accelerations, such as from discs and walls, or towards a goal.

    Examples
    --------
    Two walk side by side at their pace. At 0.3 m they repel each other with the largest force, at 0.7 m with
    3 · 0.5 - 0.35 · 0.7 m/s². At 3 m they attract each other by 0.35 · 3 m/s², and 5 m is out of sight:

    >>> pairs = np.array([0, 1j]) * [[0.3], [0.7], [3.0], [5.0]]
    >>> force = steering_force(Configuration(pairs, 1.1 + 0 * pairs), 1 + 0 * pairs, Flock())
    >>> force[:, 1].imag.round(3).tolist()
    [1.5, 1.255, -1.05, 0.0]
    """
    velocities = group.velocities
    direction = np.sign(velocities)  # of length 1, and 0 for 0
    pace_error = np.abs(desired) * rules.pace - np.abs(velocities)
    force = _flocking_force(group, rules)
    force = force + rules.steer * (np.sign(desired) - direction) + external
    force = force + rules.keep * pace_error * direction
    return np.asarray(force * np.minimum(1, rules.accelerate / np.maximum(np.abs(force), STILL)))


def _flocking_force(group: Configuration, rules: Flock) -> Points:
    """Compute the accelerations by separation, cohesion and alignment, (..., N)."""
    positions, velocities = group
    if not (rules.separate or np.any(rules.gather) or rules.align):
        return np.zeros_like(positions)
    offsets, distances = _offsets(positions)
    in_sight = distances < rules.sight
    count = np.maximum(in_sight.sum(-1), 1)
    repulsion = offsets / distances * (rules.space - distances) / rules.space
    separation = np.where(distances < rules.space, repulsion, 0).sum(-1)
    # Not by @, whose threads spin: at 96 members they take longer than the sums.
    cohesion = np.einsum("...ij,...j->...i", in_sight, positions) / count - positions
    alignment = np.einsum("...ij,...j->...i", in_sight, velocities) / count - velocities
    attraction = rules.gather * cohesion + rules.align * alignment
    return np.asarray(rules.separate * separation + np.where(in_sight.any(-1), attraction, 0))


def _offsets(positions: Points) -> tuple[Points, Array]:
    """Compute the offsets of member i from member j, (..., N, N), and distances, which exclude i = j."""
    offsets = positions[..., :, None] - positions[..., None, :]
    return offsets, np.abs(offsets) + SELF * np.eye(positions.shape[-1])


def advance(
    group: Configuration, desired: Points, rules: Flock, external: Points | float = 0.0, room: float = np.inf
) -> Configuration:
    """Advance a flock by one frame, and separate members who are too near, in three passes [ours].

    A member farther than `room` from the line x = 0 is moved back by up to 2 cm in each pass. Larger steps
    would be visible as jerks.

    Examples
    --------
    >>> still = Configuration(np.array([0j, 5j]), np.array([1 + 0j, 1 + 0j]))
    >>> advance(still, np.ones(2, complex), Flock(whim=0)).positions.real.round(2)
    array([0.1, 0.1])
    """
    velocities = group.velocities + steering_force(group, desired, rules, external) / RATE
    speeds = np.abs(velocities)
    velocities = velocities * np.clip(speeds, rules.slowest, rules.fastest) / np.maximum(speeds, STILL)
    positions = group.positions + velocities / RATE
    for _ in range(TUNED.separations):
        moved = positions + push_apart(positions, APART + TUNED.spare)
        excess = moved.imag - np.clip(moved.imag, -room, room)
        moved = moved - 1j * np.clip(excess, -TUNED.wall_push, TUNED.wall_push)
        if np.array_equal(moved, positions):
            break
        positions = moved
    return Configuration(positions, (positions - group.positions) * RATE)


def push_apart(positions: Points, distance: float) -> Points:
    """Compute the displacements (..., N) that separate pairs nearer than a distance, half for each member.

    Examples
    --------
    >>> push_apart(np.array([0j, 0.4 + 0j]), 0.6).round(2)
    array([-0.1+0.j,  0.1+0.j])
    """
    return pushes(positions, near_pairs(positions, distance), distance)


class Pairs(NamedTuple):
    """Pairs of members of the same group: their indices in the flattened positions, and their distances."""

    first: Indices
    second: Indices
    distances: Array


def near_pairs(positions: Points, distance: float) -> Pairs:
    """Find the pairs of members, (..., N), nearer than a distance, each pair once [ours].

    The members of each group are sorted by z. Only those that follow one another within the distance along z
    are compared, a few pairs where all would be N (N - 1) / 2.

    Examples
    --------
    Two groups of three members. In the first, the members 0 and 2 are near each other, and in the second
    nobody is:

    >>> near_pairs(np.array([[0j, 5 + 0j, 0.3j], [0j, 1 + 0j, 2 + 0j]]), 0.6)
    Pairs(first=array([0]), second=array([2]), distances=array([0.3]))
    """
    members = positions.shape[-1]
    groups = positions.reshape(-1, members)
    order = np.argsort(groups.real, axis=1)
    numbers = (order + members * np.arange(len(groups))[:, None]).ravel()
    ordered = positions.ravel()[numbers]
    # The groups are laid out one behind the other, too far apart for pairs of members of two groups.
    spacing = np.ptp(groups.real) + 2 * distance
    along = ordered.real + spacing * np.repeat(np.arange(len(groups)), members)
    rank = np.arange(len(along))
    followers = np.searchsorted(along, along + distance + SCREEN) - rank - 1
    first = np.repeat(rank, followers)
    second = ranges(rank + 1, followers)
    distances = np.abs(ordered[first] - ordered[second])
    is_near = distances < distance
    return Pairs(numbers[first[is_near]], numbers[second[is_near]], distances[is_near])


def pushes(positions: Points, pairs: Pairs, distance: float) -> Points:
    """Compute the displacements (..., N) that move the members of each pair to a distance, half for each.

    Examples
    --------
    >>> positions = np.array([0j, 0.4 + 0j])
    >>> pushes(positions, near_pairs(positions, 0.6), 0.8).round(2)
    array([-0.2+0.j,  0.2+0.j])
    """
    displacements = np.zeros(positions.size, complex)
    first, second, distances = pairs
    if not len(first):
        return displacements.reshape(positions.shape)
    members = positions.shape[-1]
    offsets = positions.ravel()[first] - positions.ravel()[second]
    halves = offsets / distances * (distance - distances) / 2
    is_pushed = np.zeros(positions.size, bool)
    is_pushed[first] = True
    is_pushed[second] = True
    row = np.cumsum(is_pushed) - 1  # of each pushed member
    terms = np.zeros((np.count_nonzero(is_pushed), members), complex)  # of each of them, by each other member
    terms[row[first], second % members] = halves
    terms[row[second], first % members] = -halves
    displacements[is_pushed] = terms.sum(axis=1)
    return displacements.reshape(positions.shape)


def simulate(
    count: int, seconds: float, *, corridor: float = np.inf, rules: Flock | None = None, seed: int = 0
) -> Configuration:
    """Simulate a flock that wanders over open ground, or walks along a corridor [LCF05, simulation].

    Parameters
    ----------
    count : number of members, at least 2.
    seconds : duration, after the first 20 seconds, which are left out.
    corridor : metres between two walls left and right of the line x = 0, along which the group then walks.
    rules : parameters of the members.
    seed : seed of the start, of the drifting heading of the group, and of the whims.

    Raises
    ------
    MocapError : for fewer than two members, and a corridor that is too narrow to walk in.

    Examples
    --------
    >>> flock = simulate(6, 30)
    >>> flock.positions.shape, float(nearest_two(flock.positions).min().round(2))
    ((300, 6), 0.92)

    In a corridor of 2 m, the group is narrower:

    >>> narrow = simulate(6, 30, corridor=2.0)
    >>> [float(np.ptp(group.positions.imag, axis=1).mean().round(1)) for group in (flock, narrow)]
    [2.2, 1.2]

    Notebook: 19-group-graphs
    """
    if not (2 <= count < np.inf and count == int(count)):
        raise MocapError(f"A group has two members or more, got {count}.")
    if not corridor > 2 * BODY + APART:
        raise MocapError(f"A corridor is wider than {2 * BODY + APART:g} m, got {corridor} m.")
    members = int(count)
    rules = rules or Flock()
    random = np.random.default_rng(seed)
    start = random.normal(0, 1.5, (2, members))  # metres
    group = Configuration(start[0] + 1j * start[1], np.ones(members, complex))
    member_whims = whims((members,), rules, random)
    heading = 0.0
    turning_rate = 0.0  # rad/s
    room = corridor / 2 - BODY
    wall_force = np.zeros(members, complex)
    frames = []
    for _ in range(round((seconds + TUNED.settle) * RATE)):
        drift = np.sqrt(1 / RATE) * TUNED.rate_drift * random.normal()
        turning_rate += -turning_rate / TUNED.rate_time / RATE + drift
        heading += np.clip(turning_rate, -TUNED.fastest_rotation, TUNED.fastest_rotation) / RATE
        if room < np.inf:
            lateral = group.positions.imag
            heading = -TUNED.line_pull * np.clip(lateral.mean(), -1, 1)
            free = TUNED.free_width * room
            wall_force = -1j * TUNED.wall_force * (lateral - np.clip(lateral, -free, free))
        group = advance(group, np.exp(1j * heading) * next(member_whims), rules, wall_force, room)
        frames.append(group)
    return Configuration(*np.swapaxes(frames[round(TUNED.settle * RATE) :], 0, 1))


def nearest_two(positions: Points) -> Array:
    """Compute the smallest distance between two members in each frame, (F,) from (F, N), inf for one member.

    Examples
    --------
    >>> nearest_two(np.array([[0j, 3 + 4j, 1j]])), nearest_two(np.array([[0j]]))
    (array([1.]), array([inf]))

    Notebook: 19-group-graphs
    """
    distances = np.abs(positions[..., :, None] - positions[..., None, :])
    is_self = np.eye(positions.shape[-1], dtype=bool)
    return np.asarray(np.where(is_self, np.inf, distances).min(axis=(-2, -1)))
