"""Plan the way of a group: past check points, between obstacles, beside other groups [LCF05].

A weighted A* over clips. Because every clip's extent is known, most tests for collisions are one comparison
of discs; this is the known bounds of [LCF05]. The rest is ours.
"""

from dataclasses import dataclass
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


@dataclass(frozen=True, eq=False)
class _State:
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


class _Obstacles:
    """What a clip may run into, and how often bounds alone were enough."""

    def __init__(self, scene: Scene, *, bounds: bool) -> None:
        self.scene, self.bounds = scene, bounds
        self.tested = self.spared = 0

    def free(self, clip: GroupClip, state: _State) -> bool:
        """Say whether a clip keeps clear of all, when the group stands where a state says."""
        _, turn, move = state.at
        centre, radius = turn * clip.disc[0] + move, clip.disc[1]
        for spot, size in self.scene.discs:
            if self.bounds and abs(spot - centre) > radius + size + self.scene.body:
                self.spared += 1
                continue
            self.tested += 1
            if (np.abs(turn * clip.places + (move - spot)) < size + self.scene.body).any():
                return False
        frames = state.frames + np.arange(len(clip.places))
        return all(
            self._apart(clip, state, other[np.minimum(frames, len(other) - 1)], centre)
            for other in self.scene.others
        )

    def _apart(self, clip: GroupClip, state: _State, others: Points, centre: complex) -> bool:
        """Say whether a clip keeps away from other members in the same frames, (F + 1, M)."""
        if self.bounds and np.abs(others - centre).min() > clip.disc[1] + APART:
            self.spared += 1
            return True
        self.tested += 1
        places = state.at.turn * clip.places + state.at.move
        return bool(np.abs(places[:, :, None] - others[:, None]).min() >= APART)


def plan_group(  # noqa: PLR0913 (where, from where, and how thoroughly)
    graph: GroupGraph,
    scene: Scene,
    *,
    start: Placed | None = None,
    weight: float = 2.0,
    most: int = MOST,
    bounds: bool = True,
) -> GroupWalk:
    """Find clips that lead a group past all points and clear of all obstacles.

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
    """
    begin = start or Placed(0)
    if not 0 <= begin.node < len(graph.nodes):
        raise MocapError(f"There is no node {begin.node}: this graph has {len(graph.nodes)}.")
    scene.check(begin.move)
    obstacles, remaining = _Obstacles(scene, bounds=bounds), _remaining(scene)
    leaving = [graph.leaving(node) for node in range(len(graph.nodes))]
    middles = [clip.places.mean(axis=1) for clip in graph.clips]
    first = _State(begin, 0, 0, 0.0, None, -1)
    waiting, count, farthest = [(0.0, 0, first)], 0, 0
    seen: set[tuple[float, ...]] = set()
    while waiting and len(seen) < most:
        state = heappop(waiting)[2]
        farthest = max(farthest, state.goal)
        if state.goal == len(scene.points):
            return GroupWalk(state.walk(), state.seconds, len(seen), obstacles.tested, obstacles.spared)
        if (key := _key(state, timed=bool(scene.others))) in seen:
            continue
        seen.add(key)
        for number in leaving[state.at.node]:
            if obstacles.free(graph.clips[number], state):
                after = _after(graph.clips[number], number, middles[number], state, scene)
                count += 1
                heappush(waiting, (_promise(after, scene, remaining, weight, middles[number]), count, after))
    why = f"the limit of {most} states ended the search" if waiting else "obstacles closed every way"
    raise NoWalk(
        f"No way past point {farthest + 1} of {len(scene.points)} was found: {why} ({len(seen)} tried)."
    )


def _remaining(scene: Scene) -> Array:
    """Measure the metres from each point to the last one."""
    legs = np.abs(np.diff(scene.points))
    return np.append(np.cumsum(legs[::-1])[::-1], 0.0)


def _key(state: _State, *, timed: bool) -> tuple[float, ...]:
    """Put states that stand alike into one cell; with other groups about, only at the same time."""
    node, turn, move = state.at
    cell = (round(move.real / CELL), round(move.imag / CELL), round(float(np.angle(turn)) / SECTOR))
    return (node, state.goal, *cell, *([state.frames] if timed else []))


def _after(clip: GroupClip, number: int, middle: Points, state: _State, scene: Scene) -> _State:
    """Walk a clip: where the group stands after it, and which points it has passed."""
    _, turn, move = state.at
    way, goal, frame = turn * middle + move, state.goal, 0
    while goal < len(scene.points):
        close = np.flatnonzero(np.abs(way[frame:] - scene.points[goal]) < scene.near)
        if not len(close):
            break
        frame += int(close[0])
        goal += 1
    at = Placed(clip.end, turn * clip.turn, turn * clip.move + move)
    frames = state.frames + len(clip.places) - 1
    done = goal == len(scene.points)
    return _State(at, goal, frames, (state.frames + frame if done else frames) / RATE, state, number)


def _promise(state: _State, scene: Scene, remaining: Array, weight: float, middle: Points) -> float:
    """Add the seconds so far and, weighed, those still expected."""
    if state.goal == len(scene.points) or state.before is None:
        return state.seconds
    here = state.before.at.turn * middle[-1] + state.before.at.move
    ahead = scene.points[state.goal] - here
    metres = max(abs(ahead) - scene.near, 0.0) + float(remaining[state.goal])
    turning = abs(float(np.angle(ahead / state.at.turn)))
    return float(state.seconds + weight * (metres / PACE + TURNING * turning))
