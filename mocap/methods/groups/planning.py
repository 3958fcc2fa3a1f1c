"""Where a group should go, and a plan: past check points, between obstacles, beside others [LCF05].

That a search strings clips together is from there, and so are known bounds: because every clip's extent is
known, most tests for collisions are one comparison of discs. The weighted A* and what a state promises are
ours.
"""

from cmath import phase
from collections.abc import Iterator
from heapq import heappop, heappush
from typing import Any, NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups.flocking import APART, RATE, Disc
from mocap.methods.groups.group_clips import SHIFTS, GroupClip
from mocap.methods.groups.group_graphs import GroupGraph, Placed

PACE = 1.05  # m/s, at which a group is expected to go on
TURNING = 1.3  # seconds per radian still to turn
CELL, SECTOR = 0.7, 0.3  # metres and radians: groups that stand nearer than this are one state
MOST = 4000  # states to expand


class Scene(NamedTuple):
    """Where a group should go, and what stands in its way.

    `points` (complex, metres) to pass in order, the group's middle within `near` of each; `discs` to stay
    clear of, by `body` for each member; `others`, (F, N) places of members of other groups, ten per second
    from the same moment on, to stay 0.60 m away from. An other stays where its places end.

    Examples
    --------
    >>> Scene((8 + 0j,), ((4 + 0j, 0.5),)).near
    1.0
    """

    points: tuple[complex, ...]
    discs: tuple[Disc, ...] = ()
    near: float = 1.0
    body: float = 0.3
    others: tuple[Points, ...] = ()

    def check(self, start: complex) -> None:
        """Raise MocapError for what makes no sense, and for a start nowhere or inside a disc."""
        if not self.points or np.ndim(self.points) != 1 or not np.isfinite([start, *self.points]).all():
            says = f"A scene has finite points z + ix to pass, one or more, from a start; got {self.points}"
            raise MocapError(f"{says[:160]} from {start}.")
        for centre, radius in self.discs:
            if not (np.isfinite(centre) and 0 < radius < np.inf):
                raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
            if abs(start - centre) < radius:
                at = f"x={centre.imag:g}, z={centre.real:g}"
                raise MocapError(f"The group starts inside the obstacle at {at}.")


class Exits(NamedTuple):
    """The C clips that leave a node, side by side, which all last as long.

    `places` (C, F, N), complex, and their `middles` (C, F); `centres`, `radii` and `turns` (C,).
    """

    numbers: list[int]
    clips: list[GroupClip]
    places: Points
    middles: Points
    centres: Points
    radii: Array
    turns: Points

    @classmethod
    def of(cls, graph: GroupGraph, node: int) -> "Exits":
        """Take the clips that leave a node, which all last as long."""
        numbers = graph.leaving(node)
        clips = [graph.clips[number] for number in numbers]
        bounds: Any = zip(*((*clip.disc, clip.turn) for clip in clips), strict=True)
        places = np.array([clip.places for clip in clips])
        return cls(numbers, clips, places, places.mean(axis=2), *map(np.array, bounds))


class Obstacles:
    """What a clip may run into, and how often bounds alone were enough.

    Parameters
    ----------
    scene : whose discs and other groups.
    """

    def __init__(self, scene: Scene) -> None:
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.others = scene.others
        self.tested = self.spared = 0

    def free(self, exits: Exits, at: Placed, frame: int) -> Indices:
        """List which of the clips that leave a node keep clear of all, laid at a place, from a frame on."""
        spots = at.sees(self.spots)
        near = np.abs(exits.centres[:, None] - spots) <= exits.radii[:, None] + self.sizes
        self.spared += near.size - int(near.sum())
        free = np.ones(len(exits.clips), bool)
        for disc in np.flatnonzero(near.any(axis=0)):
            rows = np.flatnonzero(near[:, disc] & free)  # a clip that hits one disc is not tested again
            self.tested += len(rows)
            free[rows] = np.abs(exits.places[rows] - spots[disc]).min(axis=(1, 2)) >= self.sizes[disc]
        frames = frame + np.arange(exits.places.shape[1])
        for other in self.others:
            members = at.sees(other[np.minimum(frames, len(other) - 1)])
            for row in np.flatnonzero(free):
                if np.abs(members - exits.centres[row]).min() > exits.radii[row] + APART:
                    self.spared += 1
                    continue
                self.tested += 1
                free[row] = np.abs(exits.places[row][:, :, None] - members[:, None]).min() >= APART
        return np.flatnonzero(free)


class GroupWalk(NamedTuple):
    """A planned way: numbers of clips, its seconds, and what the search took.

    `expanded` states; `tested` pairs of clip and obstacle frame by frame, `spared` by their bounds.

    Examples
    --------
    >>> GroupWalk([3, 1], 8.0, 2, 0, 12).clips
    [3, 1]
    """

    clips: list[int]
    seconds: float
    expanded: int
    tested: int
    spared: int


class _State(NamedTuple):
    """A group that has come to the end of a clip: `goal` counts the points passed, `frames` those walked."""

    at: Placed
    goal: int
    frames: int
    seconds: float  # until the last point, where all are passed
    clips: tuple[int, ...]  # that led here


def plan_group(
    graph: GroupGraph, scene: Scene, *, start: Placed | None = None, weight: float = 1.5, most: int = MOST
) -> GroupWalk:
    """Find clips that lead a group past all points and clear of all obstacles [LCF05, search].

    Weighted A*: first goes the state with the fewest seconds so far plus `weight` times those still expected:
    the metres to the next point and on from there, over 1.05 m/s, and 1.3 s for each radian still to turn. Of
    the states at one node, within 0.7 m and 0.3 rad, with one next point, only the first goes on.

    Parameters
    ----------
    graph : of the group.
    scene : where to go.
    start : where the group stands; at node 0 in the origin, going along +z, by default.
    weight : more finds a way sooner, and a longer one.
    most : states to expand at most.

    Raises
    ------
    MocapError : for a scene that makes no sense.
    NoWalk : where no way was found, with how far it came, what ended the search, and what would help.

    Examples
    --------
    >>> from mocap.methods.groups.group_graphs import build_group
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> found = plan_group(graph, Scene((9 + 2j,), ((5 + 0j, 0.5),)))
    >>> 7 < found.seconds < 20
    True

    Notebook: 19-group-graphs
    """
    begin = start or Placed(0)
    _check_start(graph, begin, scene)
    obstacles, points = Obstacles(scene), len(scene.points)
    exits = {node: Exits.of(graph, node) for node in {clip.start for clip in graph.clips}}
    waiting, count, farthest = [(0.0, 0, _State(begin, 0, 0, 0.0, ()))], 0, 0
    seen: set[tuple[float, ...]] = set()
    while waiting and len(seen) < most:
        state = heappop(waiting)[2]
        farthest = max(farthest, state.goal)
        if state.goal == points:
            return GroupWalk(list(state.clips), state.seconds, len(seen), obstacles.tested, obstacles.spared)
        # States that stand alike are one, with other groups about only at the same time.
        node, turn, move = state.at
        cell = (move.real / CELL, move.imag / CELL, phase(turn) / SECTOR)
        key = (node, state.goal, *map(round, cell), state.frames if scene.others else 0)
        if key in seen:
            continue
        seen.add(key)
        if (leaving := exits.get(state.at.node)) is None:
            continue
        rows = obstacles.free(leaving, state.at, state.frames)
        for left, after in _go_on(leaving, rows, state, scene):
            count += 1
            promise = after.seconds + (0.0 if after.goal == points else weight * left)
            heappush(waiting, (promise, count, after))
    why = _why(graph, scene, most if waiting else 0)
    raise NoWalk(f"No way past point {farthest + 1} of {points} was found: {why}")


def _why(graph: GroupGraph, scene: Scene, most: int) -> str:
    """Say why no way was found, and what would help; the gap named lets the narrowest node through."""
    wide = min(np.ptp(node.places.imag) for node in graph.nodes) + 2 * scene.body + SHIFTS[-1]
    why = f"the limit of {most} states ended the search" if most else "obstacles closed every way"
    helps = "Set a point on the way, allow more states" if most else "Start farther off or turned"
    return f"{why}. {helps}, take fewer members, or leave gaps of {wide:.1f} m."


def _check_start(graph: GroupGraph, start: Placed, scene: Scene) -> None:
    """Raise MocapError for a start or a scene that makes no sense, NoWalk for a member too near to a disc."""
    scene.check(start.move)
    places = start.turn * graph.nodes[start.node].places + start.move
    for centre, radius in scene.discs:
        gap = np.abs(places - centre) - radius
        if gap.min() < scene.body:
            rim = f"the rim of the obstacle at x={centre.imag:g}, z={centre.real:g}"
            far = f"Member {gap.argmin() + 1} starts {gap.min():.2f} m from {rim}"
            raise NoWalk(f"{far}: {scene.body:g} m is the least.")


def _go_on(exits: Exits, rows: Indices, state: _State, scene: Scene) -> Iterator[tuple[float, _State]]:
    """Walk some of the clips that leave a node: the seconds expected from its end on, and the state there."""
    points, ways = state.at.sees(np.array(scene.points)), exits.middles[rows]
    goals, frames = np.full(len(rows), state.goal), np.zeros(len(rows), int)
    for row in np.flatnonzero((np.abs(ways - points[state.goal]) < scene.near).any(axis=1)):
        for point in points[state.goal :]:
            if not (close := np.abs(ways[row, frames[row] :] - point) < scene.near).any():
                break
            goals[row], frames[row] = goals[row] + 1, frames[row] + close.argmax()
    legs = np.abs(np.diff(scene.points))
    goal = np.minimum(goals, len(legs))
    ahead = points[goal] - ways[:, -1]
    metres = np.maximum(np.abs(ahead) - scene.near, 0.0) + np.append(np.cumsum(legs[::-1])[::-1], 0.0)[goal]
    left = metres / PACE + TURNING * np.abs(np.angle(ahead / exits.turns[rows]))
    last = state.frames + ways.shape[1] - 1
    passed = np.where(goals == len(points), state.frames + frames, last) / RATE
    for row, at, seconds, more in zip(rows, goals.tolist(), passed.tolist(), left.tolist(), strict=True):
        clip = exits.clips[row]
        yield more, _State(state.at.after(clip), at, last, seconds, (*state.clips, exits.numbers[row]))
