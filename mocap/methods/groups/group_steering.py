"""The same without a plan: a flock that steers to the next point, away from obstacles; and the quicker way.

On open ground steering is all one needs. In a pocket of obstacles it stays for ever.
"""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.methods.groups.flocking import (
    APART,
    RATE,
    Configuration,
    Disc,
    Flock,
    advance,
    nearest_two,
    whims,
)
from mocap.methods.groups.group_graphs import GroupGraph, play_group
from mocap.methods.groups.planning import MOST, GroupWalk, Scene, plan_group

DISC_FROM = 2.0  # metres from a disc at which a member begins to steer away
DISC_FORCE = 3.0  # m/s² per metre
LIMIT = 120.0  # seconds


def steer_group(
    start: Configuration, scene: Scene, *, rules: Flock | None = None, seed: int = 0, limit: float = LIMIT
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
    wishes, frames = whims(start.places.shape, rules, np.random.default_rng(seed)), [start]
    goal = 0
    while goal < len(scene.points) and len(frames) <= limit * RATE:
        ahead = scene.points[goal] - frames[-1].places.mean()
        wish = np.exp(1j * np.angle(ahead)) * next(wishes)
        now = advance(frames[-1], wish, rules, away_from(scene.discs, frames[-1].places))
        frames.append(now)
        goal += bool(abs(now.places.mean() - scene.points[goal]) < scene.near)
    return Configuration(*np.swapaxes(frames, 0, 1)), goal


def lead_group(
    graph: GroupGraph, scene: Scene, *, start: PlanarTransform = IDENTITY, most: int = MOST
) -> tuple[Configuration, GroupWalk | None]:
    """Take the quicker of two ways that keep clear: the planned one, or that of a flock that steers [ours].

    Clips turn by 1.2 rad in four seconds, so to a goal aside or behind a flock without whims comes sooner.
    Its way is taken where it keeps clear of discs and of others as a plan does.

    Parameters
    ----------
    graph, scene, start, most : as for `plan_group`.

    Returns
    -------
    Where the members go until the middle passes the last point, and the plan; None where the flock steers.

    Raises
    ------
    MocapError, NoWalk : as `plan_group`, where the flock does not come there either.

    Examples
    --------
    >>> from mocap.methods.groups.group_graphs import build_group
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> goal_behind = Scene((-9 + 0j,))
    >>> flock, plan = lead_group(graph, goal_behind)
    >>> plan is None, len(flock.places) / RATE < 0.7 * plan_group(graph, goal_behind).seconds
    (True, True)
    """
    try:
        plan = plan_group(graph, scene, start=start, most=most)
    except NoWalk:
        if steered := _steered(graph, scene, start, LIMIT):
            return steered, None
        raise
    if steered := _steered(graph, scene, start, plan.seconds):
        return steered, None
    played = play_group(graph, plan.clips, start)
    return Configuration(*(part[: round(plan.seconds * RATE) + 1] for part in played)), plan


def _steered(graph: GroupGraph, scene: Scene, start: PlanarTransform, limit: float) -> Configuration | None:
    """Steer without whims; None where the flock is not there in time, or not as clear of all as a plan."""
    places, velocities = (start.turn * part for part in graph.nodes[0])
    first = Configuration(places + start.move, velocities)
    flock, passed = steer_group(first, scene, rules=Flock(whim=0.0), limit=limit)
    frames, gaps = np.arange(len(flock.places)), [nearest_two(flock.places).min()]
    for other in scene.others:
        there = other[np.minimum(frames, len(other) - 1)]
        gaps.append(np.abs(flock.places[:, :, None] - there[:, None]).min())
    clear = min(gaps) >= APART and (clearances(flock, scene) >= scene.body).all()
    return flock if clear and passed == len(scene.points) else None


def away_from(discs: Sequence[Disc], places: Points) -> Points:
    """Accelerate members (N,) away from discs nearer than 2 m, by 3 m/s² for each metre.

    Examples
    --------
    >>> away_from([(1 + 0j, 0.5)], np.array([0j, 5j])).round(6)
    array([-4.5+0.j,  0. +0.j])
    """
    off = places[:, None] - np.array([centre for centre, _ in discs], complex)
    rim = np.abs(off) - np.array([radius for _, radius in discs])
    return np.asarray((DISC_FORCE * np.maximum(DISC_FROM - rim, 0) * np.sign(off)).sum(axis=1))


def clearances(flock: Configuration, scene: Scene) -> Array:
    """Measure how far the nearest member comes from each disc's rim, metres; below 0 inside it.

    Examples
    --------
    >>> clearances(Configuration(np.array([[0j, 3j]]), np.zeros((1, 2))), Scene((1j,), ((5j, 1.0),)))
    array([1.])

    Notebook: 19-group-graphs
    """
    return np.array([np.abs(flock.places - centre).min() - radius for centre, radius in scene.discs])
