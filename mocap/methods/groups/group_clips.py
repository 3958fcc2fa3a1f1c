"""Clips of a whole group that lead from node to node, and end exactly there.

From a node a run is simulated that turns by a given angle. A goal is laid where it is most like the run's
end. Then the run is simulated once more, and each member is drawn to its place in the goal: a
*constrained simulation*, as [LCF05] calls it. What is left is bent away, and members that come too near are
pushed apart. How the papers do it ([AMC03], too) we could not read: the steps are ours.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap._shared.records import dataclass
from mocap.methods.groups import flocking
from mocap.methods.groups.configurations import compare
from mocap.methods.groups.flocking import APART, RATE, Configuration, Flock

BENDS = (-1.2, -0.6, 0.0, 0.6, 1.2)  # radians
SHIFTS = (-0.3, 0.0, 0.3)  # metres to the left, so that a way finds the middle of a gap
SECONDS = 4.0  # of a clip: shorter ones must be bent harder
PULL = 2.0  # m/s² per metre from where a member should be; damped so that it just does not swing
HARDEST = 2.2  # m/s²; a clip with a larger acceleration is dropped
ROUNDS = 60  # of pushing apart
STILL = 2  # frames at either end that no push moves


@dataclass(frozen=True, eq=False)
class GroupClip:
    """A way of N members from one node to another, F + 1 frames, seen from the start's configuration.

    In the paper: [LCF05, bounds].

    Parameters
    ----------
    start, end : numbers of the nodes.
    places, velocities : shape (F + 1, N), complex; the last frame is the end's, turned and moved.
    order : shape (N,): the member that starts in slot s ends in slot `order[s]`.
    turn, move : lay the end's configuration.
    """

    start: int
    end: int
    places: Points
    velocities: Points
    order: Indices
    turn: complex
    move: complex

    @cached_property
    def disc(self) -> tuple[complex, float]:
        """A centre and a radius within which all members stay: the known bounds of [LCF05]."""
        z, x = self.places.real, self.places.imag
        centre = complex((z.min() + z.max()) / 2, (x.min() + x.max()) / 2)
        return centre, float(np.abs(self.places - centre).max())


def run_from(
    starts: Configuration, bends: Array, random: np.random.Generator, goals: Configuration | None = None
) -> Configuration:
    """Simulate R runs of four seconds side by side, freely or drawn to goals.

    Parameters
    ----------
    starts : (R, N).
    bends : (R,) radians by which each run turns.
    random : draws the whims.
    goals : (R, N), where each member should be at the end, and how it should move then. From the middle of
        the run on it is drawn by 2/s² (s - p) + 2 √2/s (v' - v) to the spot s where it would be by now if
        it came there straight on at its last velocity v'. Then it keeps apart from others only where they
        come nearer than 0.63 m, and does not flock [ours].

    Returns
    -------
    Places and velocities, shape (F + 1, R, N).
    """
    rules = Flock() if goals is None else Flock(separate=0.0, gather=0.0, align=0.0)
    wishes, frames = flocking.whims(starts.places.shape, rules, random), [starts]
    total = round(SECONDS * RATE)
    pull: Points | float = 0.0
    for frame in range(total):
        now, done = frames[-1], frame / total
        if goals is not None:
            spots = goals.places - (1 - done) * SECONDS * goals.velocities
            pull = PULL * (spots - now.places) + 2 * np.sqrt(PULL) * (goals.velocities - now.velocities)
        wish = np.exp(1j * bends * min(1.0, 1.6 * done))[:, None] * next(wishes)
        frames.append(flocking.advance(now, wish, rules, min(1.0, 2 * done) * pull))
    return Configuration(*np.swapaxes(frames, 0, 1))


def bend_to(run: Configuration, goal: Configuration) -> Points:
    """Bend trajectories (F + 1, N) to end at a goal with its velocities; their start stays as it is.

    Added is a (3 s² - 2 s³) + b (s³ - s²), s = t / T: zero and level at the start. a and b are such that the
    last place, and the step to it, are the goal's: so the next clip goes on without a jerk.

    Examples
    --------
    >>> places = np.linspace(0, 1, 11)[:, None] + 0j
    >>> run = Configuration(places, np.ones((11, 1), complex))
    >>> bend_to(run, Configuration(np.array([1 + 1j]), np.array([1 + 0j])))[[0, 10], 0]
    array([0.+0.j, 1.+1.j])

    Notebook: 19-group-graphs
    """
    frames = len(run.places) - 1
    share = np.linspace(0, 1, frames + 1)[:, None]
    level, slope = 3 * share**2 - 2 * share**3, share**3 - share**2
    missing = goal.places - run.places[-1]
    change = (goal.velocities - run.velocities[-1]) / RATE  # of the last step
    return np.asarray(run.places + level * missing + slope * ((1 - level[-2]) * missing - change) / slope[-2])


def part(paths: Points) -> tuple[Points, bool]:
    """Push members apart who come too near, each push spread over time; both ends stay as they are.

    Returns
    -------
    The paths, and whether no two are nearer than 0.60 m in any frame.

    Examples
    --------
    Two who would run into each other:

    >>> steps = np.linspace(0, 4, 41)
    >>> paths = np.stack([steps + 0.1j, 4 - steps - 0.1j], axis=1)
    >>> free, done = part(paths)
    >>> done, bool(flocking.nearest_two(paths).min() < 0.6 <= flocking.nearest_two(free).min())
    (True, True)
    >>> moved = np.abs(free - paths)[:, 0]
    >>> np.flatnonzero(moved)[[0, -1]].tolist(), float(moved.max().round(3))  # they meet in frame 20
    ([14, 26], 0.204)

    Two side by side, 0.5 m apart but for the ends: these stay, and what is near them moves less:

    >>> paths = np.stack([steps, steps + 1j * np.pad(np.full(35, 0.5), 3, constant_values=0.7)], axis=1)
    >>> pushed = (part(paths)[0] - paths)[:, 1].imag.round(3).tolist()
    >>> pushed[:8], pushed[-3:]
    ([0.0, 0.0, 0.017, 0.05, 0.084, 0.105, 0.095, 0.091], [0.017, 0.0, 0.0])
    """
    ends = np.minimum(np.arange(len(paths)), np.arange(len(paths))[::-1])
    weight = np.clip((ends - STILL + 1) / 4, 0, 1)[:, None]
    added = np.zeros_like(paths)
    for _ in range(ROUNDS):
        if flocking.nearest_two(paths + added).min() >= APART:
            return paths + added, True
        push = flocking.push_apart(paths + added, APART + 0.02)
        for _ in range(4):
            push[1:-1] = (push[:-2] + 2 * push[1:-1] + push[2:]) / 4
        added += 1.5 * push * weight
    return paths + added, bool(flocking.nearest_two(paths + added).min() >= APART)


def clips_from(
    start: int, nodes: Sequence[Configuration], random: np.random.Generator
) -> tuple[list[GroupClip], int]:
    """Make clips from one node to each, for each bend and each shift aside [LCF05, clips].

    Returns
    -------
    The clips in which nobody comes nearer than 0.60 m or needs more than 2.2 m/s², and how many were made.
    """
    every = Configuration(*np.swapaxes(nodes, 0, 1))  # (K, N)
    angles = np.array(BENDS)
    rows, ends, shift = map(np.ravel, np.meshgrid(range(len(angles)), range(len(nodes)), SHIFTS))
    copies = Configuration(*(np.tile(part, (len(rows), 1)) for part in nodes[start]))
    free = run_from(Configuration(*(part[: len(angles)] for part in copies)), angles, random)
    match = compare(Configuration(*(part[-1][:, None] for part in free)), every, rounds=4)  # (B, K)
    order, turn, move = (part[rows, ends] for part in match[1:])
    move = move + 1j * shift * turn
    places, velocities = (turn[:, None] * np.take_along_axis(part[ends], order, axis=-1) for part in every)
    goals = Configuration(places + move[:, None], velocities)
    runs, clips = run_from(copies, angles[rows], random, goals), []
    for row, end in enumerate(ends.tolist()):
        goal, run = (Configuration(*(part[..., row, :] for part in some)) for some in (goals, runs))
        paths, apart = part(bend_to(run, goal))
        hardest = np.abs(np.diff(paths, 2, axis=0)).max() * RATE**2  # m/s²
        if apart and hardest <= HARDEST:
            speeds = np.gradient(paths, 1 / RATE, axis=0)
            speeds[0], speeds[-1] = nodes[start].velocities, goal.velocities
            place = order[row], complex(turn[row]), complex(move[row])
            clips.append(GroupClip(start, end, paths, speeds, *place))
    return clips, len(rows)
