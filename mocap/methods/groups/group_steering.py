"""The same without a plan: a flock that steers to the next point and away from obstacles, to compare with.

On open ground this is all one needs. In a pocket of obstacles it stays for ever.
"""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.errors import MocapError
from mocap.methods.groups.flocking import RATE, Configuration, Disc, Flock, advance, stacked, unit, whims
from mocap.methods.groups.planning import Scene

DISC_FROM = 2.0  # metres from a disc at which a member begins to steer away
DISC_FORCE = 3.0  # m/s² per metre


def steer_group(
    start: Configuration,
    scene: Scene,
    *,
    rules: Flock | None = None,
    seed: int = 0,
    limit: float = 120.0,
) -> tuple[Configuration, int]:
    """Simulate a flock that steers to each point in turn and away from discs [Rey87].

    Parameters
    ----------
    start : where its members are and how they move.
    scene : where to go.
    rules, seed : as for `simulate`.
    limit : seconds after which it ends.

    Returns
    -------
    Where the members go, and how many points they passed.

    Examples
    --------
    >>> start = Configuration(np.array([0j, 1j, -1j]), np.ones(3, complex))
    >>> flock, passed = steer_group(start, Scene((5 + 0j,)), limit=20.0)
    >>> passed
    1

    Notebook: 19-group-graphs
    """
    scene.check(complex(start.places.mean()))
    rules = rules or Flock()
    rules.check()
    if not 0 < limit < np.inf:  # in a pocket it would steer for ever
        raise MocapError(f"A flock is steered for more than 0 seconds and not for ever, got {limit}.")
    wishes, frames = whims(start.places.shape, rules, np.random.default_rng(seed)), [start]
    goal = 0
    while goal < len(scene.points) and len(frames) <= limit * RATE:
        ahead = scene.points[goal] - frames[-1].places.mean()
        now = advance(
            frames[-1],
            np.exp(1j * np.angle(ahead)) * next(wishes),
            rules,
            away_from(scene.discs, frames[-1].places),
        )
        frames.append(now)
        goal += bool(abs(now.places.mean() - scene.points[goal]) < scene.near)
    return stacked(frames), goal


def away_from(discs: Sequence[Disc], places: Points) -> Points:
    """Accelerate members (N,) away from discs nearer than 2 m, by 3 m/s² for each metre.

    Examples
    --------
    >>> away_from([(1 + 0j, 0.5)], np.array([0j, 5j])).round(6)
    array([-4.5+0.j,  0. +0.j])
    """
    off = places[:, None] - np.array([centre for centre, _ in discs], complex)
    rim = np.abs(off) - np.array([radius for _, radius in discs])
    return np.asarray((DISC_FORCE * np.maximum(DISC_FROM - rim, 0) * unit(off)).sum(axis=1))


def clearances(flock: Configuration, scene: Scene) -> Array:
    """Measure how far the nearest member comes from each disc's rim, metres; below 0 inside it.

    Examples
    --------
    >>> clearances(Configuration(np.array([[0j, 3j]]), np.zeros((1, 2))), Scene((1j,), ((5j, 1.0),)))
    array([1.])

    Notebook: 19-group-graphs
    """
    return np.array([np.abs(flock.places - centre).min() - radius for centre, radius in scene.discs])
