"""Where a group should go, and a plan: past check points, between obstacles, beside others [LCF05].

That a search strings clips together is from there, and so are known bounds: because every clip's extent is
known, most tests for collisions are one comparison of discs. The weighted A* and what a state promises are
ours.
"""

from cmath import phase
from collections.abc import Iterator, Sequence
from heapq import heappop, heappush

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap._shared.ties import whole_steps
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups.flocking import APART, RATE, Disc
from mocap.methods.groups.group_clips import SHIFTS
from mocap.methods.groups.group_graphs import GroupGraph

PACE = 1.05  # m/s, at which a group is expected to go on
TURNING = 1.3  # seconds per radian still to turn
CELL = 0.7  # metres; groups in one cell and one sector are one state
SECTOR = 0.3  # radians
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
    near: float = 1.0  # reads: name: users give it as a keyword
    body: float = 0.3
    others: tuple[Points, ...] = ()  # reads: name: users give it as a keyword

    def check(self, start: complex, members: Sequence[complex] | Points = ()) -> None:
        """Raise MocapError for what makes no sense, and a start in a disc; NoWalk for members near one.

        Examples
        --------
        The middle may start on the rim, and a member 0.25 m from it, as this scene asks:

        >>> scene = Scene((8 + 0j,), ((4 + 0j, 0.5),), body=0.25)
        >>> scene.check(3.5 + 0j, [3.25 + 0j])
        """
        is_list = bool(self.points) and np.ndim(self.points) == 1
        if not is_list or not np.isfinite([start, *self.points]).all():
            says = f"A scene has finite points z + ix to pass, one or more, from a start; got {self.points}"
            raise MocapError(f"{says[:160]} from {start}.")
        for disc in self.discs:
            self._check_disc(disc, start, members)

    def _check_disc(self, disc: Disc, start: complex, members: Sequence[complex] | Points) -> None:
        """Raise for a disc that is none, that holds the start, or whose rim is near a member."""
        centre, radius = disc
        if not (np.isfinite(centre) and 0 < radius < np.inf):
            raise MocapError(f"An obstacle has a centre and a radius above 0, got {centre}, {radius}.")
        obstacle = f"obstacle at x={centre.imag:g}, z={centre.real:g}"
        if abs(start - centre) < radius:
            raise MocapError(f"The group starts inside the {obstacle}.")
        if not len(members):
            return
        distances = np.abs(np.subtract(members, centre)) - radius  # to the rim
        if distances.min() < self.body:
            member = f"Member {distances.argmin() + 1} starts {distances.min():.2f} m from the rim"
            raise NoWalk(f"{member} of the {obstacle}: {self.body:g} m is the least.")


class Search:
    """All clips of a graph side by side, their obstacles, and how often bounds alone were enough.

    Parameters
    ----------
    graph : whose clips, which all last as long.
    scene : whose discs and other groups.
    """

    def __init__(self, graph: GroupGraph, scene: Scene) -> None:
        clips = graph.clips
        centres, radii = zip(*(clip.disc for clip in clips), strict=True)
        self.graph = graph
        self.scene = scene
        self.places = np.array([clip.places for clip in clips])  # (clips, frames, members)
        self.middles = self.places.mean(axis=2)
        self.turns = np.array([clip.turn for clip in clips])
        self.centres = np.array(centres)  # discs that hold all places of a clip
        self.radii = np.array(radii)
        self.leaving = [np.array(graph.leaving(node), int) for node in range(len(graph.nodes))]
        self.spots = np.array([spot for spot, _ in scene.discs], dtype=np.complex128)
        self.sizes = np.array([radius + scene.body for _, radius in scene.discs])
        self.tested = 0  # pairs of a clip and an obstacle, frame by frame
        self.spared = 0  # pairs for which the bounds were enough

    def free(self, node: int, turn: complex, move: complex, frame: int) -> Indices:
        """List the clips that leave a node, turned and moved, and keep clear of all, from a frame on."""
        clips = self.leaving[node]
        free = self._clear_of_discs(clips, (self.spots - move) / turn)  # as the group sees them
        frames = frame + np.arange(self.places.shape[1])
        for group in self.scene.others:
            members = (group[np.minimum(frames, len(group) - 1)] - move) / turn
            for row in np.flatnonzero(free):
                free[row] = self._is_clear_of(members, clips[row])
        return clips[free]

    def _clear_of_discs(self, clips: Indices, spots: Points) -> Mask:
        """Mark the clips whose members keep clear of all discs, with centres at these spots."""
        distances = np.abs(self.centres[clips, None] - spots)
        bounds_meet = distances <= self.radii[clips, None] + self.sizes
        self.spared += bounds_meet.size - int(bounds_meet.sum())
        free = np.ones(len(clips), bool)
        for disc in np.flatnonzero(bounds_meet.any(axis=0)):
            rows = np.flatnonzero(
                bounds_meet[:, disc] & free
            )  # a clip that hits one disc is not tested again
            self.tested += len(rows)
            nearest = np.abs(self.places[clips[rows]] - spots[disc]).min(axis=(1, 2))
            free[rows] = nearest >= self.sizes[disc]
        return free

    def _is_clear_of(self, members: Points, clip: int) -> bool:
        """Check whether a clip keeps 0.60 m away from members of another group, (frames, members)."""
        from_centre = np.abs(members - self.centres[clip]).min()
        if from_centre > self.radii[clip] + APART:
            self.spared += 1
            return True
        self.tested += 1
        distances = np.abs(self.places[clip][:, :, None] - members[:, None])
        return bool(distances.min() >= APART)

    def go_on(self, state: "State") -> Iterator[tuple[float, "State"]]:
        """Extend a state by each free clip: yield the seconds expected after it, and the new state."""
        clips = self.free(state.node, state.turn, state.move, state.frames)
        points = (np.array(self.scene.points) - state.move) / state.turn  # as the group sees them
        paths = self.middles[clips]
        goals, passed_at = self._pass_points(paths, points, state.goal)
        remaining = self._expected_seconds(paths[:, -1], self.turns[clips], points, goals)
        last = state.frames + paths.shape[1] - 1
        seconds = np.where(goals == len(points), state.frames + passed_at, last) / RATE
        rows = (column.tolist() for column in (clips, goals, seconds, remaining))
        for number, goal, elapsed, expected in zip(*rows, strict=True):
            clip = self.graph.clips[number]
            turn = state.turn * clip.turn
            move = state.turn * clip.move + state.move
            yield expected, State(clip.end, turn, move, goal, last, elapsed, (*state.clips, number))

    def _pass_points(self, paths: Points, points: Points, goal: int) -> tuple[Indices, Indices]:
        """Count the points that have been passed after each path, of which `goal` had been passed before it.

        Also return the frame of the path in which it passed its last point.
        """
        goals = np.full(len(paths), goal)
        frames = np.zeros(len(paths), int)
        passes_any = (np.abs(paths - points[goal]) < self.scene.near).any(axis=1)
        for row in np.flatnonzero(passes_any):
            for point in points[goal:]:
                is_near = np.abs(paths[row, frames[row] :] - point) < self.scene.near
                if not is_near.any():
                    break
                goals[row] += 1
                frames[row] += is_near.argmax()
        return goals, frames

    def _expected_seconds(self, ends: Points, turns: Points, points: Points, goals: Indices) -> Array:
        """Estimate the time from the ends of clips to the last point, at `PACE`, and for the first turn."""
        legs = np.abs(np.diff(self.scene.points))
        after_point = np.append(np.cumsum(legs[::-1])[::-1], 0.0)  # metres from each point to the last one
        goal = np.minimum(goals, len(points) - 1)
        ahead = points[goal] - ends
        metres = np.maximum(np.abs(ahead) - self.scene.near, 0.0) + after_point[goal]
        return np.asarray(metres / PACE + TURNING * np.abs(np.angle(ahead / turns)))


class GroupWalk(NamedTuple):
    """A planned path: numbers of clips, its seconds, and the effort of the search.

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
    most: int = MOST,  # reads: name: users give it as a keyword
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
    scene.check(complex(start.translation), start.rotation * graph.nodes[0].places + start.translation)
    search = Search(graph, scene)
    state = State(0, complex(start.rotation), complex(start.translation))
    waiting = [(0.0, 0, state)]  # promise, count, state
    count = 0
    farthest = 0  # points passed
    seen: set[tuple[float, ...]] = set()
    while waiting and len(seen) < most:
        _, _, state = heappop(waiting)
        farthest = max(farthest, state.goal)
        if state.goal == len(scene.points):
            return GroupWalk(list(state.clips), state.seconds, len(seen), search.tested, search.spared)
        cell = _cell(state, with_others=bool(scene.others))
        if cell in seen:
            continue
        seen.add(cell)
        for expected, successor in search.go_on(state):
            count += 1
            remaining = 0.0 if successor.goal == len(scene.points) else weight * expected
            promise = float(whole_steps(successor.seconds + remaining, EQUAL))
            heappush(waiting, (promise, count, successor))
    raise _no_way(graph, scene, farthest, limit=most if waiting else None)


def _cell(state: State, *, with_others: bool) -> tuple[float, ...]:
    """Return the same numbers for similar states, which count as one.

    With other groups about, states are similar only at the same time.
    """
    row = round(state.move.real / CELL)
    column = round(state.move.imag / CELL)
    sector = round(phase(state.turn) / SECTOR)
    return state.node, state.goal, row, column, sector, state.frames if with_others else 0


def _no_way(graph: GroupGraph, scene: Scene, farthest: int, limit: int | None) -> NoWalk:
    """Describe a search without success: the points passed, what ended it, and what would help."""
    if limit is not None:
        reason = f"the limit of {limit} states ended the search"
        advice = "Set a point on the way, allow more states"
    else:
        reason = "obstacles closed every way"
        advice = "Start farther off or turned"
    narrowest = min(np.ptp(node.places.imag) for node in graph.nodes)
    gap = narrowest + 2 * scene.body + SHIFTS[-1]
    failure = f"No way past point {farthest + 1} of {len(scene.points)} was found: {reason}"
    return NoWalk(f"{failure}. {advice}, take fewer members, or leave gaps of {gap:.1f} m.")
