"""Group steering without a plan: a flock steers to the next point and away from obstacles.

Steering is enough on open ground. From a pocket of obstacles a flock does not escape. `lead_group` is the
function to call for a group that must arrive: it returns the faster of steering and planning.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import NoWalk
from mocap.methods.groups.flocking import APART, RATE, Configuration, Disc, Flock, advance, nearest_two, whims
from mocap.methods.groups.group_graphs import GroupGraph, play_group
from mocap.methods.groups.planning import GroupWalk, Scene, plan_group
from mocap.methods.groups.tuned import TUNED

LIMIT = 120.0  # seconds, the longest simulation


def steer_group(
    start: Configuration, scene: Scene, *, rules: Flock | None = None, seed: int = 0, limit: float = LIMIT
) -> tuple[Configuration, int]:
    """Simulate a flock that steers to each point in turn and away from discs [Rey87].

    The flock may stay in a pocket of obstacles, and come too near to them. `lead_group` also plans, and
    returns a solution without collisions.

    Parameters
    ----------
    start : positions and velocities of the members.
    scene : points and obstacles. Other groups are not avoided.
    rules, seed : as for `simulate`.
    limit : seconds after which the simulation ends.

    Returns
    -------
    The trajectories of the members, and the number of points that were passed.

    Examples
    --------
    Steering is enough on open ground. After three seconds the first point has not been reached:

    >>> start = Configuration(np.array([0j, 1j, -1j]), np.ones(3, complex))
    >>> for limit in (60.0, 3.0):
    ...     flock, passed = steer_group(start, Scene((10 + 2j, 18 - 3j)), limit=limit)
    ...     print(passed, len(flock.positions))
    2 241
    0 31

    Notebook: 19-group-graphs
    """
    scene.check(complex(start.positions.mean()))
    frames = []
    for flock, passed in _steering(start, scene, rules or Flock(), seed):
        frames.append(flock)
        if passed == len(scene.points) or len(frames) > limit * RATE:
            break
    return Configuration(*np.swapaxes(frames, 0, 1)), int(passed)


def _steering(
    flock: Configuration, scene: Scene, rules: Flock, seed: int
) -> Iterator[tuple[Configuration, Indices]]:
    """Yield flocks that steer, (..., N), frame by frame, and the number of points that each has passed."""
    points = np.array(scene.points)
    passed = np.zeros(flock.positions.shape[:-1], int)
    for whim in whims(flock.positions.shape, rules, np.random.default_rng(seed)):
        yield flock, passed
        goal = points[np.minimum(passed, len(points) - 1)]
        direction = np.exp(1j * np.angle(goal - flock.positions.mean(axis=-1)))
        repulsion = away_from(scene.discs, flock.positions, rules.avoid)
        flock = advance(flock, direction[..., None] * whim, rules, repulsion)
        is_near = np.abs(flock.positions.mean(axis=-1) - goal) < scene.radius
        passed = passed + (is_near & (passed < len(points)))


def lead_group(
    graph: GroupGraph,
    scene: Scene,
    *,
    start: PlanarTransform = IDENTITY,
    most: int = TUNED.states,  # reads: name: users give it as a keyword
) -> tuple[Configuration, GroupWalk | None]:
    """Return the faster of two collision-free solutions: a plan, or a flock that steers [ours].

    A clip turns by at most 1.2 rad in four seconds. A flock without whims therefore arrives sooner at a goal
    to the side or behind. Sixteen flocks with different cohesion and distances from discs steer side by side.
    The first that arrives wins, if it kept the distances from discs and other members that a plan keeps.

    Parameters
    ----------
    graph, scene, start, most : as for `plan_group`.

    Returns
    -------
    The trajectories of the members until the group's middle passes the last point, and the plan, which is
    None if the flock steers.

    Raises
    ------
    MocapError, NoWalk : as for `plan_group`, if no flock arrives either.

    Examples
    --------
    >>> from mocap.methods.groups.group_graphs import build_group
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> goal_behind = Scene((-9 + 0j,))
    >>> flock, plan = lead_group(graph, goal_behind)
    >>> plan is None, (len(flock.positions) - 1) / RATE, plan_group(graph, goal_behind).seconds
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
    frames = round(plan.seconds * RATE) + 1
    return Configuration(*(field[:frames] for field in played)), plan


def _steered(graph: GroupGraph, scene: Scene, start: PlanarTransform, limit: float) -> Configuration | None:
    """Steer several flocks side by side, and return the first that arrives without a collision."""
    avoid = np.tile(TUNED.avoidances, len(TUNED.cohesions))[:, None]
    gather = np.repeat(TUNED.cohesions, len(TUNED.avoidances))[:, None]
    count = len(avoid)
    positions, velocities = (np.tile(start.rotation * field, (count, 1)) for field in graph.nodes[0])
    starts = Configuration(positions + start.translation, velocities)
    frames: list[Configuration] = []
    has_arrived: Mask = np.zeros(count, bool)
    rules = Flock(whim=0.0, avoid=avoid, gather=gather)
    for flocks, passed in _steering(starts, scene, rules, seed=0):
        if has_arrived.all() or len(frames) > limit * RATE:
            break
        frames.append(flocks)
        for row in np.flatnonzero(~has_arrived & (passed == len(scene.points))):
            has_arrived[row] = True
            rows = [[field[row] for field in frame] for frame in frames]
            flock = Configuration(*np.swapaxes(rows, 0, 1))
            if _is_clear(flock, scene):
                return flock
    return None


def _is_clear(flock: Configuration, scene: Scene) -> bool:
    """Return whether a flock keeps the distances of a plan: between members, from other groups and discs."""
    distances = [nearest_two(flock.positions).min()]
    frames = np.arange(len(flock.positions))
    for group in scene.others:
        members = group[np.minimum(frames, len(group) - 1)]
        distances.append(np.abs(flock.positions[:, :, None] - members[:, None]).min())
    return bool(min(distances) >= APART and (clearances(flock, scene) >= scene.body).all())


def away_from(discs: Sequence[Disc], positions: Points, avoid: float | Array = 2.0) -> Points:
    """Compute the accelerations of members (..., N) away from discs nearer than `avoid`, 3 m/s² per metre.

    Examples
    --------
    Members 1, 1.9 and 2.1 m from the rim, and one inside:

    >>> members = np.array([0j, -0.9 + 0j, -1.1 + 0j, 1.25 + 0j])
    >>> away_from([(1.5 + 0j, 0.5)], members).real.round(2).tolist()
    [-3.0, -0.3, 0.0, -6.75]

    Flocks side by side, whose members are half a metre from the rim, may differ in `avoid`:

    >>> away_from([(1 + 0j, 0.5)], np.zeros((2, 1)), np.array([[0.8], [2.0]])).real.round(2).tolist()
    [[-0.9], [-4.5]]
    """
    offsets = positions[..., None] - np.array([centre for centre, _ in discs], complex)
    radii = np.array([radius for _, radius in discs])
    depths = np.expand_dims(avoid, -1) - np.abs(offsets) + radii
    return np.asarray((TUNED.disc_force * np.maximum(depths, 0) * np.sign(offsets)).sum(axis=-1))


def clearances(flock: Configuration, scene: Scene) -> Array:
    """Measure the smallest distance of a member from the rim of each disc, metres, negative inside.

    Examples
    --------
    >>> clearances(Configuration(np.array([[0j, 3j]]), np.zeros((1, 2))), Scene((1j,), ((5j, 1.0),)))
    array([1.])

    Notebook: 19-group-graphs
    """
    return np.array([np.abs(flock.positions - centre).min() - radius for centre, radius in scene.discs])
