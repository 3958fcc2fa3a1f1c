"""Plan the way of a group: past check points, between obstacles, beside other groups [LCF05].

That a search strings clips together is from there; the weighted A* and what a state promises are ours.
"""

from cmath import phase
from collections.abc import Iterator
from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Points
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups.flocking import RATE
from mocap.methods.groups.group_graphs import GroupGraph, Placed
from mocap.methods.groups.scenes import Exits, Obstacles, Scene

PACE = 1.05  # m/s, at which a group is expected to go on
TURNING = 1.3  # seconds per radian still to turn
CELL, SECTOR = 0.7, 0.3  # metres and radians: groups that stand nearer than this are one state
MOST = 4000  # states to expand


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
    NoWalk : where no way was found, with how far it came, what ended the search, and what would help.

    Examples
    --------
    >>> from mocap.methods.groups.group_graphs import build_group
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
    obstacles, course = Obstacles(scene, bounds=bounds), _Course.of(scene, weight)
    exits = [Exits(graph, node) for node in range(len(graph.nodes))]
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
        for promise, after in course.go_on(leaving, obstacles.free(leaving, state.at, state.frames), state):
            count += 1
            heappush(waiting, (promise, count, after))
    why = f"the limit of {most} states ended the search" if waiting else "obstacles closed every way"
    raise NoWalk(
        f"No way past point {farthest + 1} of {len(scene.points)} was found: {why} ({len(seen)} tried). "
        + _what_helps(graph, scene, closed=not waiting)
    )


def _what_helps(graph: GroupGraph, scene: Scene, *, closed: bool) -> str:
    """Say what to change where no way was found; the gap named just lets the narrowest node through."""
    wide = min(np.ptp(node.places.imag) for node in graph.nodes) + 2 * scene.body
    if closed:
        return f"Start farther off or turned, take fewer members, or leave gaps of {wide:.1f} m."
    return f"Set a point on the way, take fewer members, leave gaps of {wide:.1f} m, or allow more states."


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

    def go_on(self, exits: Exits, rows: Indices, state: _State) -> Iterator[tuple[float, _State]]:
        """Walk some of the clips that leave a node: the promise and the state after each."""
        if not len(rows):
            return
        points, ways = state.at.sees(self.points), exits.middles[rows]
        close = (np.abs(ways - points[state.goal]) < self.near).any(axis=1)
        passed = [
            self._passed(way, points, state.goal) if hit else (state.goal, 0)
            for way, hit in zip(ways, close, strict=True)
        ]
        left = self._left(points, ways[:, -1], exits.turns[rows], [goal for goal, _ in passed])
        for row, (goal, frame), seconds in zip(rows.tolist(), passed, left.tolist(), strict=True):
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
