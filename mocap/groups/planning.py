"""Plan the way of a group: past check points, between obstacles, beside other groups [LCF05].

A weighted A* over clips. Because every clip's extent is known, most tests for collisions are one comparison
of discs; this is the known bounds of [LCF05]. The rest is ours.
"""

from cmath import phase
from collections.abc import Iterator
from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.errors import MocapError, NoWalk
from mocap.groups.flocking import APART, RATE, Disc
from mocap.groups.group_clips import GroupClip
from mocap.groups.group_graphs import GroupGraph, Placed

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
        """Raise MocapError for what makes no sense, and for a start inside a disc."""
        if not self.points or not np.isfinite(self.points).all():
            raise MocapError(f"A scene has one point to pass or more, all finite; got {self.points}."[:200])
        if not (0 < self.near < np.inf and 0 <= self.body < np.inf):
            raise MocapError(
                "A scene is passed within more than 0 m and kept clear of by 0 m or more; "
                f"got {self.near} m and {self.body} m."
            )
        if any(other.ndim != 2 or not len(other) or not np.isfinite(other).all() for other in self.others):
            raise MocapError("Other groups are finite places in a table of a frame or more by members.")
        for centre, radius in self.discs:
            if not (np.isfinite(centre) and np.isfinite(radius) and radius > 0):
                raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
            if abs(start - centre) < radius:
                raise MocapError(
                    f"The group starts inside the obstacle at x={centre.imag:g}, z={centre.real:g}."
                )


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
    before: "_State | None"
    clip: int

    def walk(self) -> list[int]:
        """List the numbers of the clips that led here."""
        clips: list[int] = []
        state: _State | None = self
        while state is not None and state.before is not None:
            clips.append(state.clip)
            state = state.before
        return clips[::-1]

    def sees(self, spots: Points) -> Points:
        """Say where spots of the ground lie as the group sees them."""
        return (spots - self.at.move) / self.at.turn


class _Exits:
    """The clips that leave a node, side by side: their bounds, and the ways of their middles, (C, F)."""

    def __init__(self, graph: GroupGraph, node: int) -> None:
        self.numbers = graph.leaving(node)
        self.clips = [graph.clips[number] for number in self.numbers]
        self.centres = np.array([clip.disc[0] for clip in self.clips])
        self.radii = np.array([clip.disc[1] for clip in self.clips])
        self.turns = np.array([clip.turn for clip in self.clips])
        middles = [clip.places.mean(axis=1) for clip in self.clips]
        longest = max(map(len, middles), default=0)
        self.middles = np.array([np.pad(way, (0, longest - len(way)), "edge") for way in middles])


class _Obstacles:
    """What a clip may run into, and how often bounds alone were enough."""

    def __init__(self, scene: Scene, *, bounds: bool) -> None:
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.others, self.bounds = scene.others, bounds
        self.tested = self.spared = 0

    def free(self, exits: _Exits, state: _State) -> list[int]:
        """List which of the clips that leave a node keep clear of all, from where the group stands."""
        spots = state.sees(self.spots)
        reach = exits.radii[:, None] + self.sizes
        near = np.abs(exits.centres[:, None] - spots) <= (reach if self.bounds else np.inf)
        self.spared += near.size - int(near.sum())
        blocked: set[int] = set()
        for row, disc in np.argwhere(near).tolist():
            if row not in blocked and self._hits(exits.clips[row], spots[disc], self.sizes[disc]):
                blocked.add(row)
        return [
            row
            for row, clip in enumerate(exits.clips)
            if row not in blocked and all(self._apart(clip, state, other) for other in self.others)
        ]

    def _hits(self, clip: GroupClip, spot: complex, size: float) -> bool:
        """Say whether a member comes too near to a disc, frame by frame."""
        self.tested += 1
        return bool(np.abs(clip.places - spot).min() < size)

    def _apart(self, clip: GroupClip, state: _State, other: Points) -> bool:
        """Say whether a clip keeps away from the members of another group in the same frames."""
        frames = state.frames + np.arange(len(clip.places))
        others = state.sees(other[np.minimum(frames, len(other) - 1)])
        if self.bounds and np.abs(others - clip.disc[0]).min() > clip.disc[1] + APART:
            self.spared += 1
            return True
        self.tested += 1
        return bool(np.abs(clip.places[:, :, None] - others[:, None]).min() >= APART)


def plan_group(  # noqa: PLR0913 (where, from where, and how thoroughly)
    graph: GroupGraph,
    scene: Scene,
    *,
    start: Placed | None = None,
    weight: float = 2.0,
    most: int = MOST,
    bounds: bool = True,
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
    bounds : compare discs first; False tests every frame, for measuring.

    Raises
    ------
    MocapError : for a scene that makes no sense.
    NoWalk : where no way was found, with how far it came and what ended the search.

    Examples
    --------
    >>> from mocap.groups.group_graphs import build_group
    >>> graph = build_group(3, nodes=2, simulated=40.0, reach=0.4)
    >>> found = plan_group(graph, Scene((9 + 2j,), ((5 + 0j, 0.5),)))
    >>> 7 < found.seconds < 20
    True

    Notebook: 19-group-graphs
    """
    begin = start or Placed(0)
    _check_start(graph, begin, scene)
    if not 0 <= weight < np.inf:
        raise MocapError(f"A plan weighs what is left by 0 or more, got {weight}.")
    obstacles, course = _Obstacles(scene, bounds=bounds), _Course.of(scene, weight)
    exits = [_Exits(graph, node) for node in range(len(graph.nodes))]
    waiting, count, farthest = [(0.0, 0, _State(begin, 0, 0, 0.0, None, -1))], 0, 0
    seen: set[tuple[float, ...]] = set()
    while waiting and len(seen) < most:
        state = heappop(waiting)[2]
        farthest = max(farthest, state.goal)
        if state.goal == len(scene.points):
            return GroupWalk(state.walk(), state.seconds, len(seen), obstacles.tested, obstacles.spared)
        if (key := _key(state, timed=bool(scene.others))) in seen:
            continue
        seen.add(key)
        leaving = exits[state.at.node]
        for promise, after in course.go_on(leaving, obstacles.free(leaving, state), state):
            count += 1
            heappush(waiting, (promise, count, after))
    why = f"the limit of {most} states ended the search" if waiting else "obstacles closed every way"
    raise NoWalk(
        f"No way past point {farthest + 1} of {len(scene.points)} was found: {why} ({len(seen)} tried)."
    )


def _check_start(graph: GroupGraph, start: Placed, scene: Scene) -> None:
    """Raise MocapError for a start or a scene that makes no sense, NoWalk for a member too near to a disc."""
    graph.check(start)
    scene.check(start.move)
    places = start.turn * graph.nodes[start.node].places + start.move
    for centre, radius in scene.discs:
        gap = np.abs(places - centre) - radius
        if gap.min() < scene.body:
            raise NoWalk(
                f"Member {gap.argmin() + 1} starts {gap.min():.2f} m from the rim of the obstacle at "
                f"x={centre.imag:g}, z={centre.real:g}: {scene.body:g} m is the least."
            )


def _key(state: _State, *, timed: bool) -> tuple[float, ...]:
    """Put states that stand alike into one cell; with other groups about, only at the same time."""
    node, turn, move = state.at
    cell = (round(move.real / CELL), round(move.imag / CELL), round(phase(turn) / SECTOR))
    return (node, state.goal, *cell, *([state.frames] if timed else []))


class _Course(NamedTuple):
    """Points to pass within `near`, the metres from each to the last one, and the weight of what is left."""

    points: Points
    near: float
    remaining: Array
    weight: float

    @classmethod
    def of(cls, scene: Scene, weight: float) -> "_Course":
        """Measure a scene's legs."""
        legs = np.abs(np.diff(scene.points))
        remaining = np.append(np.cumsum(legs[::-1])[::-1], 0.0)
        return cls(np.array(scene.points, dtype=np.complex128), scene.near, remaining, weight)

    def go_on(self, exits: _Exits, rows: list[int], state: _State) -> Iterator[tuple[float, _State]]:
        """Walk some of the clips that leave a node: the promise and the state after each."""
        if not rows:
            return
        points, ways = state.sees(self.points), exits.middles[rows]
        close = (np.abs(ways - points[state.goal]) < self.near).any(axis=1)
        passed = [
            self._passed(way, points, state.goal) if hit else (state.goal, 0)
            for way, hit in zip(ways, close, strict=True)
        ]
        left = self._left(points, ways[:, -1], exits.turns[rows], [goal for goal, _ in passed])
        for row, (goal, frame), seconds in zip(rows, passed, left.tolist(), strict=True):
            clip, done = exits.clips[row], goal == len(points)
            frames = state.frames + len(clip.places) - 1
            so_far = (state.frames + frame if done else frames) / RATE
            turn, move = state.at.turn, state.at.move
            at = Placed(clip.end, turn * clip.turn, turn * clip.move + move)
            after = _State(at, goal, frames, so_far, state, exits.numbers[row])
            yield so_far + (0.0 if done else self.weight * seconds), after

    def _passed(self, way: Points, points: Points, goal: int) -> tuple[int, int]:
        """Say which point is next after a way, (F,), and in which frame the last one was passed."""
        frame = 0
        while goal < len(points) and (close := np.abs(way[frame:] - points[goal]) < self.near).any():
            frame += int(close.argmax())
            goal += 1
        return goal, frame

    def _left(self, points: Points, here: Points, turns: Points, goals: list[int]) -> Array:
        """Expect how many seconds are left: metres to the next point and on from there, and turning there."""
        goal = np.minimum(goals, len(points) - 1)
        ahead = points[goal] - here
        metres = np.maximum(np.abs(ahead) - self.near, 0.0) + self.remaining[goal]
        return np.asarray(metres / PACE + TURNING * np.abs(np.angle(ahead / turns)))
