"""Planning for a group: a sequence of clips that passes points and avoids obstacles and other groups [LCF05].

The search for a sequence of clips and the bounds of clips are those of [LCF05]: because the extent of each
clip is known, most collision tests compare two discs. The weighted A* and its cost estimate are ours.
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
from mocap.methods.groups.group_graphs import GroupGraph
from mocap.methods.groups.tuned import TUNED

EQUAL = 1e-6  # seconds: estimates that differ by less are equal, and the first state found is expanded first


class Scene(NamedTuple):
    """The points that a group must pass, and its obstacles.

    `points` (complex, metres) are passed in order: the group's middle comes within `radius` of each. Members
    keep `body` metres from the rims of `discs`, and 0.60 m from the members of `others`. These are positions
    (F, N) at ten frames per second, starting at the same time. After its last frame, another group stands
    still.

    Examples
    --------
    >>> Scene((8 + 0j,), ((4 + 0j, 0.5),)).radius
    1.0
    """

    points: tuple[complex, ...]
    discs: tuple[Disc, ...] = ()
    radius: float = 1.0
    body: float = 0.3
    others: tuple[Points, ...] = ()  # reads: name: users give it as a keyword

    def check(self, start: complex, members: Sequence[complex] | Points = ()) -> None:
        """Validate a scene and the start of a group.

        Raises
        ------
        MocapError : for invalid points and discs, and a start inside a disc.
        NoWalk : for a member that starts too near a disc.

        Examples
        --------
        The middle may start on the rim, and in this scene a member 0.25 m from it:

        >>> scene = Scene((8 + 0j,), ((4 + 0j, 0.5),), body=0.25)
        >>> scene.check(3.5 + 0j, [3.25 + 0j])
        """
        is_list = bool(self.points) and np.ndim(self.points) == 1
        if not is_list or not np.isfinite([start, *self.points]).all():
            problem = (
                f"A scene has finite points z + ix to pass, one or more, from a start; got {self.points}"
            )
            raise MocapError(f"{problem[:160]} from {start}.")
        for disc in self.discs:
            self._check_disc(disc, start, members)

    def _check_disc(self, disc: Disc, start: complex, members: Sequence[complex] | Points) -> None:
        """Raise for an invalid disc, for one that contains the start, and for members near its rim."""
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
    """Expansion of states in the search, with the clips of a graph as arrays and counts of collision tests.

    Parameters
    ----------
    graph : the graph of the group, whose clips all have the same duration.
    scene : points, discs and other groups.
    """

    def __init__(self, graph: GroupGraph, scene: Scene) -> None:
        clips = graph.clips
        centres, radii = zip(*(clip.disc for clip in clips), strict=True)
        self.graph = graph
        self.scene = scene
        self.positions = np.array([clip.positions for clip in clips])  # (clips, frames, members)
        self.middles = self.positions.mean(axis=2)
        self.rotations = np.array([clip.rotation for clip in clips])
        self.centres = np.array(centres)  # discs that bound all positions of a clip
        self.radii = np.array(radii)
        self.leaving = [np.array(graph.leaving(node), int) for node in range(len(graph.nodes))]
        self.disc_centres = np.array([centre for centre, _ in scene.discs], dtype=np.complex128)
        self.disc_radii = np.array([radius + scene.body for _, radius in scene.discs])
        self.tested = 0  # pairs of a clip and an obstacle that were tested frame by frame
        self.spared = 0  # pairs for which the bounds were enough

    def free(self, node: int, rotation: complex, translation: complex, frame: int) -> Indices:
        """List the clips from a node, at a transform and a frame, that do not collide."""
        clips = self.leaving[node]
        free = self._clear_of_discs(
            clips, (self.disc_centres - translation) / rotation
        )  # relative to the node
        frames = frame + np.arange(self.positions.shape[1])
        for group in self.scene.others:
            members = (group[np.minimum(frames, len(group) - 1)] - translation) / rotation
            for row in np.flatnonzero(free):
                free[row] = self._is_clear_of(members, clips[row])
        return clips[free]

    def _clear_of_discs(self, clips: Indices, centres: Points) -> Mask:
        """Mark the clips that do not collide with the discs, whose centres are relative to the node."""
        distances = np.abs(self.centres[clips, None] - centres)
        bounds_meet = distances <= self.radii[clips, None] + self.disc_radii
        self.spared += bounds_meet.size - int(bounds_meet.sum())
        free = np.ones(len(clips), bool)
        for disc in np.flatnonzero(bounds_meet.any(axis=0)):
            # A clip that collides with one disc is not tested again.
            rows = np.flatnonzero(bounds_meet[:, disc] & free)
            self.tested += len(rows)
            nearest = np.abs(self.positions[clips[rows]] - centres[disc]).min(axis=(1, 2))
            free[rows] = nearest >= self.disc_radii[disc]
        return free

    def _is_clear_of(self, members: Points, clip: int) -> bool:
        """Return whether a clip keeps 0.60 m from the members of another group, (frames, members)."""
        from_centre = np.abs(members - self.centres[clip]).min()
        if from_centre > self.radii[clip] + APART:
            self.spared += 1
            return True
        self.tested += 1
        distances = np.abs(self.positions[clip][:, :, None] - members[:, None])
        return bool(distances.min() >= APART)

    def go_on(self, state: "State") -> Iterator[tuple[float, "State"]]:
        """Extend a state by each free clip: yield the expected seconds after it, and the new state."""
        clips = self.free(state.node, state.rotation, state.translation, state.frames)
        points = (np.array(self.scene.points) - state.translation) / state.rotation  # relative to the node
        paths = self.middles[clips]
        goals, passed_at = self._pass_points(paths, points, state.goal)
        remaining = self._expected_seconds(paths[:, -1], self.rotations[clips], points, goals)
        last = state.frames + paths.shape[1] - 1
        seconds = np.where(goals == len(points), state.frames + passed_at, last) / RATE
        rows = (column.tolist() for column in (clips, goals, seconds, remaining))
        for number, goal, elapsed, expected in zip(*rows, strict=True):
            clip = self.graph.clips[number]
            rotation = state.rotation * clip.rotation
            translation = state.rotation * clip.translation + state.translation
            walk = (*state.clips, number)
            yield expected, State(clip.end, rotation, translation, goal, last, elapsed, walk)

    def _pass_points(self, paths: Points, points: Points, goal: int) -> tuple[Indices, Indices]:
        """Count the points that are passed at the end of each path, if `goal` points were passed before.

        Also return the frame in which each path passes its last point.
        """
        goals = np.full(len(paths), goal)
        frames = np.zeros(len(paths), int)
        passes_any = (np.abs(paths - points[goal]) < self.scene.radius).any(axis=1)
        for row in np.flatnonzero(passes_any):
            for point in points[goal:]:
                is_near = np.abs(paths[row, frames[row] :] - point) < self.scene.radius
                if not is_near.any():
                    break
                goals[row] += 1
                frames[row] += is_near.argmax()
        return goals, frames

    def _expected_seconds(self, ends: Points, rotations: Points, points: Points, goals: Indices) -> Array:
        """Estimate the time from the ends of clips to the last point, and for the first rotation."""
        legs = np.abs(np.diff(self.scene.points))
        after_point = np.append(np.cumsum(legs[::-1])[::-1], 0.0)  # metres from each point to the last one
        goal = np.minimum(goals, len(points) - 1)
        offset = points[goal] - ends
        metres = np.maximum(np.abs(offset) - self.scene.radius, 0.0) + after_point[goal]
        return np.asarray(metres / TUNED.pace + TUNED.turning * np.abs(np.angle(offset / rotations)))


class GroupWalk(NamedTuple):
    """A planned walk: the numbers of its clips, its duration, seconds, and the effort of the search.

    The effort is the number of `expanded` states, of pairs of a clip and an obstacle that were `tested` frame
    by frame, and of pairs that were `spared` because of their bounds.

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
    """A group at the end of a clip: at a `node`, with its transform p ↦ rotation · p + translation.

    `goal` is the number of points passed, `frames` the number of frames since the start. `seconds` is the
    elapsed time, until the last point if it is passed. `clips` is the walk to this state.
    """

    node: int
    rotation: complex
    translation: complex
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
    most: int = TUNED.states,  # reads: name: users give it as a keyword
) -> GroupWalk:
    """Find a sequence of clips that leads a group past all points and around all obstacles [LCF05, search].

    Weighted A*: the next state to expand has the smallest sum of elapsed time and `weight` times the expected
    remaining time. The estimate is the distance over all remaining points at 1.05 m/s, plus 1.3 s per radian
    between the heading and the next point. Of similar states, at one node within a cell of 0.7 m and 0.3 rad
    and with the same next point, only the first is expanded. `lead_group` also steers, and returns the
    faster of both.

    Parameters
    ----------
    graph : the graph of the group.
    scene : points and obstacles.
    start : the transform of the first node, 0, to the ground. By default at the origin, heading to +z.
    weight : a larger weight finds a path faster, but a longer path.
    most : largest number of states to expand.

    Raises
    ------
    MocapError : for an invalid scene.
    NoWalk : if no path was found, with the number of points passed, the reason, and a remedy.

    Examples
    --------
    >>> from mocap.methods.groups.group_graphs import build_group
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> plan = plan_group(graph, Scene((9 + 2j,), ((5 + 0j, 0.5),)))
    >>> plan.clips, plan.seconds
    ([12, 3, 0], 9.0)
    >>> plan_group(graph, Scene((1.5 + 0j,))).seconds  # the middle moves 0.5 m
    0.5

    Notebook: 19-group-graphs
    """
    members = start.rotation * graph.nodes[0].positions + start.translation
    scene.check(complex(start.translation), members)
    search = Search(graph, scene)
    state = State(0, complex(start.rotation), complex(start.translation))
    waiting = [(0.0, 0, state)]  # estimate, count, state
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
            estimate = float(whole_steps(successor.seconds + remaining, EQUAL))
            heappush(waiting, (estimate, count, successor))
    raise _no_path(graph, scene, farthest, limit=most if waiting else None)


def _cell(state: State, *, with_others: bool) -> tuple[float, ...]:
    """Return the cell of a state, in which only the first state is expanded.

    If there are other groups, only states at the same time share a cell.
    """
    row = round(state.translation.real / TUNED.cell)
    column = round(state.translation.imag / TUNED.cell)
    sector = round(phase(state.rotation) / TUNED.sector)
    return state.node, state.goal, row, column, sector, state.frames if with_others else 0


def _no_path(graph: GroupGraph, scene: Scene, farthest: int, limit: int | None) -> NoWalk:
    """Return the error for a failed search: the points passed, the reason, and a remedy."""
    if limit is not None:
        reason = f"the limit of {limit} states ended the search"
        advice = "Add a point before it, allow more states"
    else:
        reason = "obstacles closed every path"
        advice = "Start farther off or turned"
    narrowest = min(np.ptp(node.positions.imag) for node in graph.nodes)
    gap = narrowest + 2 * scene.body + TUNED.shifts[-1]
    failure = f"No path past point {farthest + 1} of {len(scene.points)} was found: {reason}"
    return NoWalk(f"{failure}. {advice}, take fewer members, or leave gaps of {gap:.1f} m.")
