"""Where a group should go, and a plan: past check points, between obstacles, beside others [LCF05].

That a search strings clips together is from there, and so are known bounds: because every clip's extent is
known, most tests for collisions are one comparison of discs. The weighted A* and what a state promises are
ours.
"""

from cmath import phase
from collections.abc import Iterator, Sequence
from heapq import heappop, heappush
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Indices, Points
from mocap._shared.ties import whole_steps
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups.flocking import APART, RATE, Disc
from mocap.methods.groups.group_clips import SHIFTS
from mocap.methods.groups.group_graphs import GroupGraph

PACE = 1.05  # m/s, at which a group is expected to go on
TURNING = 1.3  # seconds per radian still to turn
CELL, SECTOR = 0.7, 0.3  # metres and radians: groups that stand nearer than this are one state
MOST = 4000  # states to expand

EQUAL = 1e-6  # seconds: ways that promise to take as long; the first one found goes on first


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

    def check(self, start: complex, members: Sequence[complex] | Points = ()) -> None:
        """Raise MocapError for what makes no sense, and a start in a disc; NoWalk for members near one.

        Examples
        --------
        The middle may start on the rim, and a member 0.25 m from it, as this scene asks:

        >>> scene = Scene((8 + 0j,), ((4 + 0j, 0.5),), body=0.25)
        >>> scene.check(3.5 + 0j, [3.25 + 0j])
        """
        if not self.points or np.ndim(self.points) != 1 or not np.isfinite([start, *self.points]).all():
            says = f"A scene has finite points z + ix to pass, one or more, from a start; got {self.points}"
            raise MocapError(f"{says[:160]} from {start}.")
        for centre, radius in self.discs:
            if not (np.isfinite(centre) and 0 < radius < np.inf):
                raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
            at = f"obstacle at x={centre.imag:g}, z={centre.real:g}"
            if abs(start - centre) < radius:
                raise MocapError(f"The group starts inside the {at}.")
            if len(members) and (gap := np.abs(np.subtract(members, centre)) - radius).min() < self.body:
                far = f"Member {gap.argmin() + 1} starts {gap.min():.2f} m from the rim of the {at}"
                raise NoWalk(f"{far}: {self.body:g} m is the least.")


class Search:
    """All clips of a graph side by side, what they may run into, and how often bounds alone were enough.

    Parameters
    ----------
    graph : whose clips, which all last as long.
    scene : whose discs and other groups.
    """

    def __init__(self, graph: GroupGraph, scene: Scene) -> None:
        clips = graph.clips
        self.graph, self.scene, self.places = graph, scene, np.array([clip.places for clip in clips])
        self.middles, self.turns = self.places.mean(axis=2), np.array([clip.turn for clip in clips])
        self.centres, self.radii = (
            np.array(part) for part in zip(*(clip.disc for clip in clips), strict=True)
        )
        self.leaving = [np.array(graph.leaving(node), int) for node in range(len(graph.nodes))]
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.tested = self.spared = 0

    def free(self, node: int, turn: complex, move: complex, frame: int) -> Indices:
        """List the clips that leave a node, turned and moved, and keep clear of all, from a frame on."""
        clips, spots = self.leaving[node], (self.spots - move) / turn  # as the group sees them
        near = np.abs(self.centres[clips, None] - spots) <= self.radii[clips, None] + self.sizes
        self.spared += near.size - int(near.sum())
        free = np.ones(len(clips), bool)
        for disc in np.flatnonzero(near.any(axis=0)):
            rows = np.flatnonzero(near[:, disc] & free)  # a clip that hits one disc is not tested again
            self.tested += len(rows)
            apart = np.abs(self.places[clips[rows]] - spots[disc]).min(axis=(1, 2))
            free[rows] = apart >= self.sizes[disc]
        frames = frame + np.arange(self.places.shape[1])
        for other in self.scene.others:
            members = (other[np.minimum(frames, len(other) - 1)] - move) / turn
            for row in np.flatnonzero(free):
                clip = clips[row]
                if np.abs(members - self.centres[clip]).min() > self.radii[clip] + APART:
                    self.spared += 1
                    continue
                self.tested += 1
                free[row] = np.abs(self.places[clip][:, :, None] - members[:, None]).min() >= APART
        return clips[free]

    def go_on(self, state: "State") -> Iterator[tuple[float, "State"]]:
        """Walk the clips that are free: the seconds expected from each one's end on, and the state there."""
        node, turn, move, passed, start, _, walked = state
        clips, near = self.free(node, turn, move, start), self.scene.near
        points, ways = (np.array(self.scene.points) - move) / turn, self.middles[clips]
        goals, frames = np.full(len(clips), passed), np.zeros(len(clips), int)
        for row in np.flatnonzero((np.abs(ways - points[passed]) < near).any(axis=1)):
            for point in points[passed:]:
                if not (close := np.abs(ways[row, frames[row] :] - point) < near).any():
                    break
                goals[row], frames[row] = goals[row] + 1, frames[row] + close.argmax()
        legs = np.abs(np.diff(self.scene.points))
        goal = np.minimum(goals, len(legs))
        ahead = points[goal] - ways[:, -1]
        metres = np.maximum(np.abs(ahead) - near, 0.0) + np.append(np.cumsum(legs[::-1])[::-1], 0.0)[goal]
        left = metres / PACE + TURNING * np.abs(np.angle(ahead / self.turns[clips]))
        last = start + ways.shape[1] - 1
        seconds = np.where(goals == len(points), start + frames, last) / RATE
        rows = (part.tolist() for part in (clips, goals, seconds, left))
        for number, goal, until, more in zip(*rows, strict=True):
            clip = self.graph.clips[number]
            at = turn * clip.turn, turn * clip.move + move
            yield more, State(clip.end, *at, goal, last, until, (*walked, number))


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


class State(NamedTuple):
    """A group at the end of a clip: at a `node`, which lies on the ground by p ↦ turn · p + move.

    `goal` counts the points passed, `frames` those walked; `seconds` are those until the last point, where
    all are passed; `clips` led here.
    """

    node: int
    turn: complex
    move: complex
    goal: int = 0
    frames: int = 0
    seconds: float = 0.0
    clips: tuple[int, ...] = ()


def plan_group(
    graph: GroupGraph,
    scene: Scene,
    *,
    start: PlanarTransform = IDENTITY,
    weight: float = 1.5,
    most: int = MOST,
) -> GroupWalk:
    """Find clips that lead a group past all points and clear of all obstacles [LCF05, search].

    Weighted A*: first goes the state with the fewest seconds so far plus `weight` times those still expected:
    the metres to the next point and on from there, over 1.05 m/s, and 1.3 s for each radian still to turn. Of
    the states at one node, within 0.7 m and 0.3 rad, with one next point, only the first goes on.

    Parameters
    ----------
    graph : of the group.
    scene : where to go.
    start : how node 0, where it stands first, lies on the ground; in the origin, going along +z, by default.
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
    >>> found.clips, found.seconds
    ([12, 3, 0], 9.0)
    >>> plan_group(graph, Scene((1.5 + 0j,))).seconds  # the middle has 0.5 m to go
    0.5
    >>> plan_group(graph, Scene((9 + 2j,), ((5 + 0j, 0.5),)), start=PlanarTransform(0, 0, 4.0))
    Traceback (most recent call last):
    mocap.errors.NoWalk: Member 1 starts -0.05 m from the rim of the obstacle at x=0, z=5: 0.3 m is the least.

    Notebook: 19-group-graphs
    """
    scene.check(complex(start.move), start.turn * graph.nodes[0].places + start.move)
    search, points = Search(graph, scene), len(scene.points)
    begin = State(0, complex(start.turn), complex(start.move))
    waiting, count, farthest = [(0.0, 0, begin)], 0, 0
    seen: set[tuple[float, ...]] = set()
    while waiting and len(seen) < most:
        state = heappop(waiting)[2]
        farthest = max(farthest, state.goal)
        if state.goal == points:
            return GroupWalk(list(state.clips), state.seconds, len(seen), search.tested, search.spared)
        # States that stand alike are one, with other groups about only at the same time.
        cell = (state.move.real / CELL, state.move.imag / CELL, phase(state.turn) / SECTOR)
        key = (state.node, state.goal, *map(round, cell), state.frames if scene.others else 0)
        if key in seen:
            continue
        seen.add(key)
        for left, after in search.go_on(state):
            count += 1
            promise = after.seconds + (0.0 if after.goal == points else weight * left)
            heappush(waiting, (float(whole_steps(promise, EQUAL)), count, after))
    why = f"the limit of {most} states ended the search" if waiting else "obstacles closed every way"
    helps = "Set a point on the way, allow more states" if waiting else "Start farther off or turned"
    wide = min(np.ptp(node.places.imag) for node in graph.nodes) + 2 * scene.body + SHIFTS[-1]
    helps += f", take fewer members, or leave gaps of {wide:.1f} m"  # which let the narrowest node through
    raise NoWalk(f"No way past point {farthest + 1} of {points} was found: {why}. {helps}.")
