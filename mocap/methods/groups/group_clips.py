"""Clips of a whole group that lead from node to node, and end exactly there.

From a node many runs are simulated, to bend by given angles. The run that ends most like a goal is bent so
that it ends exactly there; then members that come too near are pushed apart. This stands for the constrained
simulation of [LCF05], after [AMC03], whose texts we could not have: the steps are ours.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.methods.groups.configurations import compare
from mocap.methods.groups.flocking import (
    APART,
    RATE,
    Configuration,
    Flock,
    Trajectories,
    advance,
    nearest_two,
    push_apart,
    stacked,
    whims,
)

BENDS = (-1.2, -0.6, 0.0, 0.6, 1.2)  # radians
SECONDS = 4.0  # of a clip: shorter ones must be bent harder
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
    disc : a centre and a radius within which all members stay: the known bounds of [LCF05].
    """

    start: int
    end: int
    places: Points
    velocities: Points
    order: Indices
    turn: complex
    move: complex
    disc: tuple[complex, float]


class Drawn(NamedTuple):
    """How a set of clips came about: how many were tried, how many collide or are too hard, and by how much.

    `bent` (T,): the RMS metres by which each end had to be bent; `collided` (T,) before and after pushing
    apart: (T, 2); `hardest` (T,): the largest acceleration, m/s².
    """

    bent: Array
    collided: Array
    hardest: Array

    @property
    def tried(self) -> int:
        """All clips that were made."""
        return len(self.bent)

    @property
    def kept(self) -> int:
        """Those without a collision or too hard an acceleration."""
        return int((~self.collided[:, 1].astype(bool) & (self.hardest <= HARDEST)).sum())


def run_from(
    node: Configuration, bend: float, runs: int, rules: Flock, random: np.random.Generator
) -> Trajectories:
    """Simulate runs of four seconds side by side that start at a node of N members and turn by `bend`.

    Parameters
    ----------
    node : where all start.
    bend : radians.
    runs : how many, R.
    rules, random : as for `whims`.

    Returns
    -------
    Places and velocities, shape (F + 1, R, N).
    """
    now = Configuration(*(np.tile(part, (runs, 1)) for part in node))
    wishes, frames, total = whims(now.places.shape, rules, random), [now], round(SECONDS * RATE)
    for frame in range(total):
        heading = bend * min(1.0, 1.6 * frame / total)
        frames.append(advance(frames[-1], np.exp(1j * heading) * next(wishes), rules))
    return stacked(frames)


def bend_to(run: Trajectories, goal: Configuration) -> Points:
    """Bend trajectories (F + 1, N) to end at a goal with its velocities; their start stays as it is.

    Added is a (3 s² - 2 s³) + b (s³ - s²), s = t / T: zero and level at the start. a and b are such that the
    last place, and the step to it, are the goal's: so the next clip goes on without a jerk.

    Examples
    --------
    >>> places = np.linspace(0, 1, 11)[:, None] + 0j
    >>> run = Trajectories(places, np.ones((11, 1), complex))
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
    >>> done, bool(nearest_two(paths).min() < 0.6 <= nearest_two(free).min())
    (True, True)
    """
    ends = np.minimum(np.arange(len(paths)), np.arange(len(paths))[::-1])
    weight = np.clip((ends - STILL + 1) / 4, 0, 1)[:, None]
    added = np.zeros_like(paths)
    for _ in range(ROUNDS):
        if nearest_two(paths + added).min() >= APART:
            return paths + added, True
        push = push_apart(paths + added, APART + 0.02)
        for _ in range(4):
            push[1:-1] = (push[:-2] + 2 * push[1:-1] + push[2:]) / 4
        added += 1.5 * push * weight
    return paths + added, bool(nearest_two(paths + added).min() >= APART)


def accelerations(paths: Points) -> Array:
    """Measure accelerations along paths (F, N), (F - 2, N) m/s².

    Examples
    --------
    >>> accelerations(np.array([[0j], [0.1 + 0j], [0.3 + 0j]])).round(6)
    array([[10.]])
    """
    return np.asarray(np.abs(np.diff(paths, 2, axis=0)) * RATE**2)


def clips_from(
    start: int, nodes: Sequence[Configuration], runs: Trajectories
) -> list[tuple[GroupClip, tuple[float, bool, bool, float]]]:
    """Make a clip to each node out of the run that ends most like it [LCF05, clips].

    Parameters
    ----------
    start : the node that all runs leave.
    nodes : the goals.
    runs : shape (F + 1, R, N), as `run_from` gives them.

    Returns
    -------
    For each node a clip, and what `Drawn` says of it: bent, collided before, collided after, hardest.
    """
    ends = Configuration(*(part[-1] for part in runs))
    made = []
    for end, goal in enumerate(nodes):
        match = compare(ends, goal, rounds=4)
        best = int(match.rms.argmin())
        order, turn, move = match.order[best], complex(match.turn[best]), complex(match.move[best])
        there = Configuration(turn * goal.places[order] + move, turn * goal.velocities[order])
        bent = bend_to(Trajectories(*(part[:, best] for part in runs)), there)
        paths, free = part(bent)
        velocities = np.gradient(paths, 1 / RATE, axis=0)
        velocities[0], velocities[-1] = nodes[start].velocities, there.velocities
        middle = paths.mean(axis=1)
        reach = np.ptp(middle.real) / 2 + middle.real.min(), np.ptp(middle.imag) / 2 + middle.imag.min()
        disc = complex(*reach), float(np.abs(paths - complex(*reach)).max())
        clip = GroupClip(start, end, paths, velocities, order, turn, move, disc)
        before = bool(nearest_two(bent).min() < APART)
        made.append((clip, (float(match.rms[best]), before, not free, float(accelerations(paths).max()))))
    return made
