"""A flock of walking people, simulated by Reynolds's three rules [Rey87], with whims of their own.

Each member keeps away from those who are near, stays with those it sees, and goes as they go. It also steers
towards a wish, and keeps a pace. The figures are those of walking people, not of birds [ours]. Without whims
a flock settles into a lattice that hardly ever changes, so that there is nothing to build a graph of.

Points on the ground are complex, z + ix, ten of them per second.
"""

from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap._shared.records import NamedTuple
from mocap.errors import MocapError

RATE = 10.0  # frames per second
SETTLE = 20.0  # seconds that are left out at the start
APART = 0.6  # metres; members nearer than this collide
MARGIN = 0.03  # metres, by which simulated members keep further apart
WALL_FORCE = 3.0  # m/s² per metre too near to a wall
BODY = 0.35  # metres that a member keeps from a wall
HELD = 0.02  # metres by which a wall puts a member back, in each pass
FREELY = 0.7  # share of a corridor's half in which no member minds the wall

Disc = tuple[complex, float]
"""An obstacle: its centre on the ground and its radius, metres."""


class Flock(NamedTuple):
    """The rules' figures; lengths in metres, speeds in m/s, accelerations in m/s².

    Those nearer than `space` are kept away from, those within `sight` are stayed and gone with; `separate`,
    `gather`, `align`, `steer` and `keep` weigh the rules. `whim` is how much each member's wish drifts. Discs
    nearer than `avoid` push away. Flocks side by side may differ in `gather` and `avoid`, (K, 1).

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
    """Where N members are and how they move: `places` and `velocities`, (..., N) complex each.

    Leading axes hold other configurations: frames, ten per second, or runs side by side.

    Examples
    --------
    >>> Configuration(np.array([0j, 1j]), np.array([1 + 0j, 1 + 0j])).velocities.mean()
    np.complex128(1+0j)
    """

    places: Points
    velocities: Points


def whims(shape: tuple[int, ...], rules: Flock, random: np.random.Generator) -> Iterator[Points]:
    """Yield frame by frame each member's own wish: a direction and a pace that drift about the group's.

    Parameters
    ----------
    shape : of the members, with any leading axes for runs side by side.
    rules : how much they drift.
    random : draws them.

    Yields
    ------
    Complex numbers of that shape: a direction times a share of the pace.
    """
    step, root = 1 / RATE, np.sqrt(1 / RATE) * rules.whim
    direction, mood = np.zeros(shape), np.zeros(shape)
    while True:
        direction += -step * direction / 2.0 + root * random.normal(size=shape)
        mood += -step * mood / 4.0 + root * 0.35 * random.normal(size=shape)
        yield np.asarray(np.exp(1j * direction) * np.clip(1 + mood, 0.6, 1.4))


def steering_force(now: Configuration, wish: Points, rules: Flock, besides: Points | float = 0.0) -> Points:
    """Work out each member's acceleration by the rules [Rey87], m/s².

    separate · Σ ê (space - d) / space over those nearer than `space`, gather · (mean place - p) and
    align · (mean velocity - v) over those in sight, steer · (wish - v̂) and keep · (pace - |v|) v̂ [ours],
    cut at `accelerate`.

    Parameters
    ----------
    now : places and velocities, (..., N); each leading axis holds other runs.
    wish : (..., N), direction times share of the pace.
    rules : the figures.
    besides : (..., N), what else accelerates the members: discs, walls, or a place to reach.

    Examples
    --------
    Two walk side by side at their pace. At 0.3 m they push each other away as hard as they can, at 0.7 m with
    3 · 0.5 - 0.35 · 0.7 m/s². At 3 m they are drawn together by 0.35 · 3 m/s², and at 5 m they see nobody:

    >>> pairs = np.array([0, 1j]) * [[0.3], [0.7], [3.0], [5.0]]
    >>> force = steering_force(Configuration(pairs, 1.1 + 0 * pairs), 1 + 0 * pairs, Flock())
    >>> force[:, 1].imag.round(3).tolist()
    [1.5, 1.255, -1.05, 0.0]
    """
    places, velocities = now
    gap = places[..., :, None] - places[..., None, :]
    far = np.abs(gap) + 1e9 * np.eye(places.shape[-1])
    seen = far < rules.sight
    count = np.maximum(seen.sum(-1), 1)
    away = np.where(far < rules.space, gap / far * (rules.space - far) / rules.space, 0).sum(-1)
    # Not by @, whose threads spin: at 96 members they take longer than the sums.
    middle = np.einsum("...ij,...j->...i", seen, places) / count - places
    alike = np.einsum("...ij,...j->...i", seen, velocities) / count - velocities
    ahead = np.sign(velocities)  # of length 1, and 0 for 0
    force = rules.separate * away + np.where(seen.any(-1), rules.gather * middle + rules.align * alike, 0)
    force = force + rules.steer * (np.sign(wish) - ahead) + besides
    force = force + rules.keep * (np.abs(wish) * rules.pace - np.abs(velocities)) * ahead
    return np.asarray(force * np.minimum(1, rules.accelerate / np.maximum(np.abs(force), 1e-9)))


def advance(
    now: Configuration, wish: Points, rules: Flock, besides: Points | float = 0.0, room: float = np.inf
) -> Configuration:
    """Go on by one frame; those who come too near are put apart, half each, in three passes [ours].

    Who is further than `room` from the line x = 0 is put back to it by up to 2 cm a pass: harder, and the
    members would be jerked.

    Examples
    --------
    >>> still = Configuration(np.array([0j, 5j]), np.array([1 + 0j, 1 + 0j]))
    >>> advance(still, np.ones(2, complex), Flock(whim=0)).places.real.round(2)
    array([0.1, 0.1])
    """
    velocities = now.velocities + steering_force(now, wish, rules, besides) / RATE
    speeds = np.abs(velocities)
    velocities = velocities * np.clip(speeds, rules.slowest, rules.fastest) / np.maximum(speeds, 1e-9)
    places = now.places + velocities / RATE
    for _ in range(3):
        places = places + push_apart(places, APART + MARGIN)
        beyond = places.imag - np.clip(places.imag, -room, room)
        places = places - 1j * np.clip(beyond, -HELD, HELD)
    return Configuration(places, (places - now.places) * RATE)


def push_apart(places: Points, apart: float) -> Points:
    """Say how far each member must move, (..., N), so that no two are nearer than `apart`: half each.

    Examples
    --------
    >>> push_apart(np.array([0j, 0.4 + 0j]), 0.6).round(2)
    array([-0.1+0.j,  0.1+0.j])
    """
    gap = places[..., :, None] - places[..., None, :]
    far = np.abs(gap) + 1e9 * np.eye(places.shape[-1])
    return np.asarray(np.where(far < apart, gap / far * (apart - far) / 2, 0).sum(-1))


def simulate(
    count: int, seconds: float, *, corridor: float = np.inf, rules: Flock | None = None, seed: int = 0
) -> Configuration:
    """Let a flock wander over open ground, or walk along a corridor [LCF05, simulation].

    Parameters
    ----------
    count : members, from 2 on.
    seconds : how long, after 20 seconds that are left out.
    corridor : metres between two walls, left and right of the line x = 0; there the group keeps to the line.
    rules : their figures.
    seed : of the start, the drifting heading of the group, and the whims.

    Raises
    ------
    MocapError : for fewer than two members, and a corridor in which nobody can walk.

    Examples
    --------
    >>> flock = simulate(6, 30)
    >>> flock.places.shape, bool(nearest_two(flock.places).min() > APART)
    ((300, 6), True)
    >>> narrow = simulate(6, 30, corridor=2.0)
    >>> bool(np.ptp(narrow.places.imag, axis=1).mean() < 1.5)
    True

    Notebook: 19-group-graphs
    """
    if not (2 <= count < np.inf and count == int(count)):
        raise MocapError(f"A group has two members or more, got {count}.")
    if not corridor > 2 * BODY + APART:
        raise MocapError(f"A corridor is wider than {2 * BODY + APART:g} m, got {corridor} m.")
    count, rules, random = int(count), rules or Flock(), np.random.default_rng(seed)
    start = random.normal(0, 1.5, (2, count))
    now = Configuration(start[0] + 1j * start[1], np.ones(count, complex))
    wishes, heading, bend, frames = whims((count,), rules, random), 0.0, 0.0, []
    room, wall = corridor / 2 - BODY, np.zeros(count, complex)
    for _ in range(round((seconds + SETTLE) * RATE)):
        bend += -bend / 3.0 / RATE + np.sqrt(1 / RATE) * 0.25 * random.normal()
        heading += np.clip(bend, -0.5, 0.5) / RATE
        if room < np.inf:
            beside = now.places.imag
            heading = -0.3 * np.clip(beside.mean(), -1, 1)
            wall = -1j * WALL_FORCE * (beside - np.clip(beside, -FREELY * room, FREELY * room))
        now = advance(now, np.exp(1j * heading) * next(wishes), rules, wall, room)
        frames.append(now)
    return Configuration(*np.swapaxes(frames[round(SETTLE * RATE) :], 0, 1))


def nearest_two(places: Points) -> Array:
    """Measure the least distance of any two members in each frame, (F,) of (F, N); inf for one alone.

    Examples
    --------
    >>> nearest_two(np.array([[0j, 3 + 4j, 1j]])), nearest_two(np.array([[0j]]))
    (array([1.]), array([inf]))

    Notebook: 19-group-graphs
    """
    gap = np.abs(places[..., :, None] - places[..., None, :])
    return np.asarray(np.where(np.eye(places.shape[-1], dtype=bool), np.inf, gap).min(axis=(-2, -1)))
