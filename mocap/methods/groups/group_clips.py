"""Clips of a whole group that lead from node to node and end exactly there.

A run that turns by a given angle is simulated from a node. A goal node is aligned with the end of the run.
Then the run is simulated again, and each member is attracted to its position in the goal: a *constrained
simulation* [LCF05]. The remaining residual is removed by bending the trajectories, and members that are too
near are separated. The details of [LCF05] and [AMC03] were not available. The steps are ours.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap._shared.records import dataclass
from mocap.methods.groups import flocking
from mocap.methods.groups.configurations import compare
from mocap.methods.groups.flocking import APART, RATE, Configuration, Flock
from mocap.methods.groups.tuned import TUNED


@dataclass(frozen=True, eq=False)
class GroupClip:
    """Trajectories of N members from one node to another, F + 1 frames, relative to the start node.

    In the paper: [LCF05, bounds].

    Parameters
    ----------
    start, end : numbers of the nodes.
    positions, velocities : shape (F + 1, N), complex. The last frame is the transformed end node.
    order : shape (N,): the member that starts in slot s ends in slot `order[s]`.
    rotation, translation : the planar transform of the end node, relative to the start node.
    """

    start: int
    end: int
    positions: Points
    velocities: Points
    order: Indices
    rotation: complex
    translation: complex

    @cached_property
    def disc(self) -> tuple[complex, float]:
        """The centre and the radius of a disc that bounds all positions, the known bounds of [LCF05]."""
        z = self.positions.real
        x = self.positions.imag
        centre = complex((z.min() + z.max()) / 2, (x.min() + x.max()) / 2)
        return centre, float(np.abs(self.positions - centre).max())


def run_from(
    starts: Configuration, bends: Array, random: np.random.Generator, goals: Configuration | None = None
) -> Configuration:
    """Simulate R runs of four seconds side by side, free or attracted to goals.

    Parameters
    ----------
    starts : (R, N), the initial positions and velocities of the members.
    bends : (R,), the angle by which each run turns, radians.
    random : draws the whims.
    goals : (R, N), positions and velocities of the members at the end. A member at p with velocity v is
        accelerated by 2/s² (q - p) + 2 √2/s (v' - v), with full strength in the second half of the run. Here
        q is its position on the straight path that reaches the goal with its final velocity v'. It is
        separated from others nearer than 0.63 m, and the other flocking rules do not apply [ours].

    Returns
    -------
    Positions and velocities, shape (F + 1, R, N).
    """
    rules = Flock() if goals is None else Flock(separate=0.0, gather=0.0, align=0.0)
    whims = flocking.whims(starts.positions.shape, rules, random)
    frames = [starts]
    total = round(TUNED.seconds * RATE)
    for frame in range(total):
        group = frames[-1]
        fraction = frame / total
        rotation = np.exp(1j * bends * min(1.0, TUNED.bend_pace * fraction))
        attraction = 0.0 if goals is None else _attraction(group, goals, (1 - fraction) * TUNED.seconds)
        desired = rotation[:, None] * next(whims)
        frames.append(
            flocking.advance(group, desired, rules, min(1.0, TUNED.pull_pace * fraction) * attraction)
        )
    return Configuration(*np.swapaxes(frames, 0, 1))


def _attraction(group: Configuration, goals: Configuration, seconds: float) -> Points:
    """Compute the accelerations (R, N) towards the straight paths that reach the goals in `seconds`."""
    targets = goals.positions - seconds * goals.velocities
    spring = TUNED.pull * (targets - group.positions)
    damping = 2 * np.sqrt(TUNED.pull) * (goals.velocities - group.velocities)
    return np.asarray(spring + damping)


def bend_to(run: Configuration, goal: Configuration) -> Points:
    """Bend trajectories (F + 1, N) so that they end at a goal with its velocities. The start is unchanged.

    The displacement is a (3 s² - 2 s³) + b (s³ - s²), s = t / T, a Hermite cubic whose value and slope are
    zero at the start. The coefficients a and b fit the last position and the last step to the goal, so that
    the next clip continues without a jerk.

    Examples
    --------
    >>> positions = np.linspace(0, 1, 11)[:, None] + 0j
    >>> run = Configuration(positions, np.ones((11, 1), complex))
    >>> bend_to(run, Configuration(np.array([1 + 1j]), np.array([1 + 0j])))[[0, 10], 0]
    array([0.+0.j, 1.+1.j])

    Notebook: 19-group-graphs
    """
    s = np.linspace(0, 1, len(run.positions))[:, None]
    value_basis = 3 * s**2 - 2 * s**3
    slope_basis = s**3 - s**2
    residual = goal.positions - run.positions[-1]
    step_residual = (goal.velocities - run.velocities[-1]) / RATE
    slope_scale = (1 - value_basis[-2]) * residual - step_residual
    return np.asarray(run.positions + value_basis * residual + slope_basis * slope_scale / slope_basis[-2])


def separate(paths: Points) -> tuple[Points, bool]:
    """Separate members who come too near, by displacements that are smooth over time and zero at the ends.

    Parameters
    ----------
    paths : shape (F, N), complex, metres.

    Returns
    -------
    The paths, and whether all members keep 0.60 m apart in every frame.

    Examples
    --------
    Two members who would collide in frame 20:

    >>> steps = np.linspace(0, 4, 41)
    >>> paths = np.stack([steps + 0.1j, 4 - steps - 0.1j], axis=1)
    >>> separated, is_clear = separate(paths)
    >>> is_clear, [float(flocking.nearest_two(each).min().round(2)) for each in (paths, separated)]
    (True, [0.2, 0.61])
    """
    frames = np.arange(len(paths))
    from_end = np.minimum(frames, frames[::-1])
    weights = np.clip((from_end - TUNED.held_frames + 1) / TUNED.ease, 0, 1)[:, None]
    distance = APART + TUNED.parting_spare
    displacements = np.zeros_like(paths)
    for _ in range(TUNED.parting_rounds):
        separated = paths + displacements
        pairs = flocking.near_pairs(separated, distance)
        if (pairs.distances >= APART).all():
            return separated, True
        push = flocking.pushes(separated, pairs, distance)
        for _ in range(TUNED.smoothings):
            push[1:-1] = (push[:-2] + 2 * push[1:-1] + push[2:]) / 4
        displacements += TUNED.overshoot * push * weights
    separated = paths + displacements
    return separated, len(flocking.near_pairs(separated, APART).distances) == 0


def clips_from(
    start: int, nodes: Sequence[Configuration], random: np.random.Generator
) -> tuple[list[GroupClip], int]:
    """Simulate clips from one node to each node, for each bend and each lateral shift [LCF05, clips].

    Returns
    -------
    The clips in which members keep 0.60 m apart and accelerate by at most 2.2 m/s², and the number of clips
    that were tried.
    """
    all_nodes = Configuration(*np.swapaxes(nodes, 0, 1))  # (K, N)
    angles = np.array(TUNED.bends)
    grid = np.meshgrid(range(len(angles)), range(len(nodes)), TUNED.shifts)
    bends, ends, shifts = map(np.ravel, grid)
    starts = Configuration(*(np.tile(field, (len(bends), 1)) for field in nodes[start]))
    free_starts = Configuration(*(field[: len(angles)] for field in starts))
    free_runs = run_from(free_starts, angles, random)
    free_ends = Configuration(*(field[-1][:, None] for field in free_runs))
    match = compare(free_ends, all_nodes, rounds=4)  # (B, K)
    order, rotation, translation = (field[bends, ends] for field in match[1:])
    translation = translation + 1j * shifts * rotation
    ordered = Configuration(*(np.take_along_axis(field[ends], order, axis=-1) for field in all_nodes))
    goal_positions = rotation[:, None] * ordered.positions + translation[:, None]
    goals = Configuration(goal_positions, rotation[:, None] * ordered.velocities)
    runs = run_from(starts, angles[bends], random, goals)
    clips = []
    for row, end in enumerate(ends.tolist()):
        goal = Configuration(*(field[row] for field in goals))
        run = Configuration(*(field[:, row] for field in runs))
        paths, is_clear = separate(bend_to(run, goal))
        if is_clear and _peak_acceleration(paths) <= TUNED.hardest:
            velocities = np.gradient(paths, 1 / RATE, axis=0)
            velocities[0] = nodes[start].velocities
            velocities[-1] = goal.velocities
            transform = complex(rotation[row]), complex(translation[row])
            clips.append(GroupClip(start, end, paths, velocities, order[row], *transform))
    return clips, len(bends)


def _peak_acceleration(paths: Points) -> float:
    """Measure the largest acceleration of any member, m/s²."""
    return float(np.abs(np.diff(paths, 2, axis=0)).max() * RATE**2)
