"""The same without a plan: a flock that steers to the next point, away from obstacles; and the quicker way.

On open ground steering is all one needs. In a pocket of obstacles it stays for ever.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.methods.groups.flocking import APART, RATE, Configuration, Disc, Flock, advance, nearest_two, whims
from mocap.methods.groups.group_graphs import GroupGraph, play_group
from mocap.methods.groups.planning import MOST, GroupWalk, Scene, plan_group

DISC_FORCE = 3.0  # m/s² per metre
LIMIT = 120.0  # seconds
AVOID, GATHER = np.meshgrid((0.8, 1.2, 1.6, 2.0), (0.0, 0.35, 1.0, 2.0))
TRIED = Flock(whim=0.0, avoid=AVOID.reshape(-1, 1), gather=GATHER.reshape(-1, 1))


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
    On open ground steering is enough. After three seconds it has not yet come to the first point:

    >>> start = Configuration(np.array([0j, 1j, -1j]), np.ones(3, complex))
    >>> for limit in (60.0, 3.0):
    ...     flock, passed = steer_group(start, Scene((10 + 2j, 18 - 3j)), limit=limit)
    ...     print(passed, len(flock.places))
    2 241
    0 31

    Notebook: 19-group-graphs
    """
    scene.check(complex(start.places.mean()))
    frames = []
    for now, passed in _steering(start, scene, rules or Flock(), seed):
        frames.append(now)
        if passed == len(scene.points) or len(frames) > limit * RATE:
            break
    return Configuration(*np.swapaxes(frames, 0, 1)), int(passed)


def _steering(
    now: Configuration, scene: Scene, rules: Flock, seed: int
) -> Iterator[tuple[Configuration, Indices]]:
    """Yield frame by frame where flocks that steer are, (..., N), and how many points each has passed."""
    points, goals = np.array(scene.points), np.zeros(now.places.shape[:-1], int)
    for wish in whims(now.places.shape, rules, np.random.default_rng(seed)):
        yield now, goals
        goal = points[np.minimum(goals, len(points) - 1)]
        ahead = np.exp(1j * np.angle(goal - now.places.mean(axis=-1)))
        now = advance(now, ahead[..., None] * wish, rules, away_from(scene.discs, now.places, rules.avoid))
        goals = goals + ((np.abs(now.places.mean(axis=-1) - goal) < scene.near) & (goals < len(points)))


def lead_group(
    graph: GroupGraph, scene: Scene, *, start: PlanarTransform = IDENTITY, most: int = MOST
) -> tuple[Configuration, GroupWalk | None]:
    """Take the quicker of two ways that keep clear: the planned one, or that of a flock that steers [ours].

    Clips turn by 1.2 rad in four seconds, so to a goal aside or behind a flock without whims comes sooner.
    Sixteen steer side by side, which stay together and avoid discs more or less. The first that is there, and
    kept clear of discs and of others as a plan does, leads.

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
    >>> plan is None, (len(flock.places) - 1) / RATE, plan_group(graph, goal_behind).seconds
    (True, 10.6, 18.8)
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
    """Steer by all of `TRIED` side by side; take the first that is there in time, clear as a plan."""
    places, velocities = (np.tile(start.rotation * part, (AVOID.size, 1)) for part in graph.nodes[0])
    frames: list[Configuration] = []
    there: Mask = np.zeros(len(places), bool)
    for now, passed in _steering(Configuration(places + start.translation, velocities), scene, TRIED, 0):
        if there.all() or len(frames) > limit * RATE:
            break
        frames.append(now)
        for row in np.flatnonzero(~there & (passed == len(scene.points))):
            there[row] = True
            flock = Configuration(*np.swapaxes([[part[row] for part in frame] for frame in frames], 0, 1))
            gaps, clock = [nearest_two(flock.places).min()], np.arange(len(frames))
            for other in scene.others:
                members = other[np.minimum(clock, len(other) - 1)]
                gaps.append(np.abs(flock.places[:, :, None] - members[:, None]).min())
            if min(gaps) >= APART and (clearances(flock, scene) >= scene.body).all():
                return flock
    return None


def away_from(discs: Sequence[Disc], places: Points, avoid: float | Array = 2.0) -> Points:
    """Accelerate members (..., N) away from discs nearer than `avoid`, by 3 m/s² for each metre.

    Examples
    --------
    Members 1, 1.9 and 2.1 m from the rim, and one inside:

    >>> away_from([(1.5 + 0j, 0.5)], np.array([0j, -0.9 + 0j, -1.1 + 0j, 1.25 + 0j])).real.round(2).tolist()
    [-3.0, -0.3, 0.0, -6.75]

    Of the flocks that `lead_group` steers some avoid a rim half a metre off more, some less:

    >>> away_from([(1 + 0j, 0.5)], np.zeros((4, 1)), AVOID[0, :, None]).real.round(2).ravel().tolist()
    [-0.9, -2.1, -3.3, -4.5]
    """
    off = places[..., None] - np.array([centre for centre, _ in discs], complex)
    near = np.expand_dims(avoid, -1) - np.abs(off) + np.array([radius for _, radius in discs])
    return np.asarray((DISC_FORCE * np.maximum(near, 0) * np.sign(off)).sum(axis=-1))


def clearances(flock: Configuration, scene: Scene) -> Array:
    """Measure how far the nearest member comes from each disc's rim, metres; below 0 inside it.

    Examples
    --------
    >>> clearances(Configuration(np.array([[0j, 3j]]), np.zeros((1, 2))), Scene((1j,), ((5j, 1.0),)))
    array([1.])

    Notebook: 19-group-graphs
    """
    return np.array([np.abs(flock.places - centre).min() - radius for centre, radius in scene.discs])
