"""Bidirectional search between two poses: walks from the start and back from the end meet half-way.

A search from one side finds walks that pass near the end, but few that end in its pose. Therefore walks are
extended from both sides. Each node at which walks from both sides end joins them, so that n walks from each
side give up to n² walks. This is the bidirectional search of I. Pohl (1971), with a beam for each of its two
fronts.

The walks are `States`: `along` is their length in metres, and `macro_edge` the edge of their last step.
Positions are in the world: p ↦ rotation · p + translation transforms the clip of a walk's last node. If walk
a from the start meets walk b from the end, the transforms of their clips should be equal. Bending removes the
difference.

Steps are also `States`, namely walks of one edge each. Their points are the N nodes of the graph, then the K
frames similar to the start, points N to N + K - 1, and then the frames similar to the end.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import minimum_filter1d

from mocap._shared.arrays import Array, Indices, Points, ranges
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import clip_rows
from mocap.matching.point_clouds import align, point_cloud
from mocap.methods.in_betweening.tuned import TUNED
from mocap.steering.layered_search import LayeredSearch, States, standing, start_states

PEAK = 1.4  # ratio of the maximum to the mean of a smooth change that is level at both ends


class Candidates(NamedTuple):
    """K frames similar to a pose, and the planar transforms that align their clips with it.

    Parameters
    ----------
    stretch : shape (K,), the edge that contains the frame.
    since : shape (K,), the number of the frame in the edge.
    rotation, translation : shape (K,), p ↦ rotation · p + translation aligns the clip with the pose.
    distance : shape (K,), the distance from the pose, metres.
    """

    stretch: Indices
    since: Indices
    rotation: Points
    translation: Points
    distance: Array


def pose_at(motion: Motion, direction: int, frames: int = 0) -> Motion:
    """Return the pose `frames` after a motion's first frame, or, for direction -1, before its last frame."""
    number = frames if direction > 0 else len(motion) - 1 - frames
    return motion[number : number + 1]


def find_candidates(graph: CompiledGraph, motion: Motion, *, direction: int, limit: float) -> Candidates:
    """Find the frames of a graph's clips that are most similar to a motion's first or last pose and velocity.

    The distance is that of [KGP02, Eqs. 1-4] over two poses that are 0.1 s apart, or over one pose if the
    motion is shorter. The candidates are also at least 0.1 s apart.

    Parameters
    ----------
    graph : the compiled graph.
    motion : a motion that begins or ends with the pose.
    direction : 1 for its first frame, as at a start, and -1 for its last frame, as at an end.
    limit : the largest distance, metres.

    Raises
    ------
    NoWalk : if no frame is within the limit.
    SkeletonMismatch : for a pose of another skeleton.
    """
    clips = graph.source.clips
    clips[0].skeleton.require_same(motion.skeleton)
    step = max(1, round(TUNED.ahead * graph.fps))
    pose_step = max(1, round(TUNED.ahead * motion.fps))
    poses = [pose_at(motion, direction, frames) for frames in (0, pose_step) if frames < len(motion)]
    rows = np.flatnonzero(~graph.blended[graph.of])
    frames = graph.here[rows]  # (N, 2), clips and frames
    clouds = np.concatenate([point_cloud(clip) for clip in clips])
    offsets = [np.array([0, n * direction * step]) for n in range(len(poses))]
    points = np.concatenate([clouds[clip_rows(clips, frames + offset)] for offset in offsets], axis=1)
    target = np.concatenate([point_cloud(pose)[0] for pose in poses])
    target = np.broadcast_to(target, points.shape)
    aligned = align(target, points)
    transforms = PlanarTransform(*(np.asarray(part)[:, None] for part in aligned))
    squares = ((transforms.apply_points(points) - target) ** 2).sum(axis=-1)
    distance = np.sqrt(squares.mean(axis=-1))
    chosen = _separate_minima(distance, clip_rows(clips, frames) + step * frames[:, 0], step)
    nearest = distance[chosen[0]]
    if nearest > limit:
        pose = f"The {'first' if direction > 0 else 'last'} pose of '{motion.name:.60}'"
        excess = f"is {nearest:.2f} m off the nearest pose of the clips, and {limit:g} m is the limit"
        raise NoWalk(f"{pose} {excess}: take a pose more like theirs.")
    chosen = chosen[distance[chosen] <= limit]
    edge = graph.of[rows[chosen]]
    since = rows[chosen] - graph.first[edge]
    return Candidates(edge, since, aligned.rotation[chosen], aligned.translation[chosen], distance[chosen])


def _separate_minima(distance: Array, lane: Indices, step: int) -> Indices:
    """Return the `TUNED.candidates` smallest distances, each the least of the frames within `step`.

    `lane` numbers the frames, with gaps longer than `step` between clips.
    """
    lanes = np.full(int(lane.max()) + 1, np.inf)
    lanes[lane] = distance
    minima = minimum_filter1d(lanes, 2 * step + 1, mode="constant", cval=np.inf)
    chosen = np.flatnonzero(distance == minima[lane])
    return chosen[np.argsort(distance[chosen], kind="stable")[: TUNED.candidates]]


class Joined(NamedTuple):
    """A walk from start to end: its edges, and their frames that it plays.

    Parameters
    ----------
    edges : the numbers of its edges in the compiled graph.
    first : the number of frames of the first edge that are left out.
    frames : the number of frames from the start to the end.
    transform : the transform that aligns the first clip with the start.
    end : the ground point that the root must reach in the last frame.
    angle : the additional rotation of the last frame, radians.
    cost : the cost of its seams and of the poses at its ends.
    """

    edges: Indices
    first: int
    frames: int
    transform: PlanarTransform
    end: complex
    angle: float
    cost: float


class TwoSided:
    """A bidirectional search for walks between two poses that need little bending and few seams.

    Parameters
    ----------
    graph : the compiled graph.
    ends : the frames similar to the start, and those similar to the end.
    frames : the number of frames from the start to the end.
    """

    def __init__(self, graph: CompiledGraph, ends: tuple[Candidates, Candidates], frames: int) -> None:
        self.graph = graph
        self.frames = frames
        self.starts, self.ends = ends
        self.steps = steps_between(graph, *ends)
        # The position of the root at each point, in the coordinates of its clip.
        roots = [graph.ground[graph.first[end.stretch] + end.since] for end in ends]
        self.roots = np.concatenate([graph.at, *roots])
        self.speed = float(np.percentile(graph.step * graph.fps, 75))
        self.begin = self._first_position(self.starts, roots[0])
        self.finish = self._first_position(self.ends, roots[1])

    @staticmethod
    def _first_position(end: Candidates, roots: Points) -> complex:
        """Return the ground point of the best candidate's root."""
        return complex(end.translation[0] + end.rotation[0] * roots[0])

    def best(self, count: int) -> list[Joined]:
        """Join the walks of both sides, and return those of lowest cost, or none if no two of them meet."""
        nodes = len(self.graph.nodes)
        forward = _Front(self, self.steps, self.starts, nodes)
        forward.aim(self.finish, self.frames / 2)
        backward = _Front(self, self._reversed_steps(), self.ends, nodes + len(self.starts.distance))
        backward.aim(self.begin, (TUNED.most_pace - 0.5) * self.frames)
        for front in (forward, backward):
            for _ in front:
                pass
        middle = States.join(forward.arrived)
        middle = middle.take(np.argsort(middle.cost, kind="stable")[: TUNED.meeting])
        ending = States.join(backward.history)
        first, second = pairs_at_nodes(middle.node, ending.node)
        price = self.prices(middle.take(first), ending.take(second))
        order = np.argsort(price, kind="stable")
        order = order[np.isfinite(price[order])]
        _, cheapest = np.unique(first[order], return_index=True)  # the best end of each walk from the start
        chosen = order[np.sort(cheapest)[:count]]
        pairs = zip(first[chosen].tolist(), second[chosen].tolist(), strict=True)
        return [self.join(forward.trace(middle, a), backward.trace(ending, b)) for a, b in pairs]

    def _reversed_steps(self) -> States:
        """Return the reversed steps, from the point that they enter to the point that they leave."""
        rotation = self.steps.rotation.conj()
        translation = -rotation * self.steps.translation
        return self.steps._replace(
            node=self.steps.trail, trail=self.steps.node, rotation=rotation, translation=translation
        )

    def prices(self, first: States, second: States) -> Array:
        """Estimate the cost of each pair of walks that meet, including the cost of bending.

        The residual at the end is a rotation Δ and a vector. A rotation that grows linearly removes the
        first, and rotates the line from start to end by Δ/2. The remaining offset across this line, by an
        angle a, requires a curve and a counter-curve, ∫ φ̇² = 12 a² / T. The offset along it, a fraction r of
        the metres walked, requires longer steps, or a bend of ∫ φ̇² = 24 r / T, since the chord of an arc of
        θ is shorter than the arc by θ² / 24. A target beyond the metres walked requires longer steps.
        """
        seconds = self.frames / self.graph.fps
        rotation = second.rotation * first.rotation.conj()
        end = rotation.conj() * (self.finish - second.translation) + first.translation
        angle = np.angle(rotation)
        metres = np.maximum(first.along + second.along, 0.1)
        line = (end - self.begin) * np.exp(0.5j * angle)
        target = self.finish - self.begin
        across = np.abs(((target - line) * np.exp(-1j * np.angle(line))).imag) / metres
        along = np.abs(abs(target) - np.abs(line)) / metres
        longer = np.log(np.maximum(abs(target) / metres, 1.0))
        pace = np.log(np.maximum((first.frames + second.frames) / self.frames, 1e-3))
        price = first.cost + second.cost + TUNED.stretch * seconds * (pace**2 + longer**2)
        price += TUNED.turn / seconds * (angle**2 + 12 * across**2)
        price += np.minimum(TUNED.stretch * seconds * along**2, TUNED.turn / seconds * 24 * along)
        turning = PEAK * (np.abs(angle) + 6 * across) / seconds
        price += TUNED.beyond_limit * np.maximum(turning - TUNED.most_turn, 0.0)
        price += TUNED.beyond_limit * np.maximum(PEAK * longer - np.log(TUNED.most_steps), 0.0)
        return np.where(np.abs(pace) <= (1 - TUNED.rise) * np.log(TUNED.most_pace), price, np.inf)

    def join(self, forward: States, backward: States) -> Joined:
        """Concatenate two walks that meet."""
        graph = self.graph
        edges = np.concatenate([forward.macro_edge[1:], backward.macro_edge[:0:-1]])
        point = int(backward.node[0])
        start = int(forward.node[0]) - len(graph.nodes)
        end = point - len(graph.nodes) - len(self.starts.distance)
        start_rotation = complex(self.starts.rotation[start])
        end_rotation = complex(self.ends.rotation[end])
        angle = float(np.angle(end_rotation / (start_rotation * np.prod(graph.rotation[edges]))))
        transform = PlanarTransform.from_complex(start_rotation, complex(self.starts.translation[start]))
        target = complex(self.ends.translation[end] + end_rotation * self.roots[point])
        frames = int(forward.frames[-1] + backward.frames[-1])
        cost = float(forward.cost[-1] + backward.cost[-1])
        return Joined(edges, int(self.starts.since[start]), frames, transform, target, angle, cost)


def pairs_at_nodes(first: Indices, second: Indices) -> tuple[Indices, Indices]:
    """Pair each walk of one side with those of the other that end at the same node, at most `TUNED.pairs`.

    Parameters
    ----------
    first, second : the nodes at which the walks of both sides end, (N,) and (M,).

    Returns
    -------
    The rows of the pairs in `first` and in `second`.

    Examples
    --------
    >>> [rows.tolist() for rows in pairs_at_nodes(np.array([7, 4]), np.array([4, 7, 4]))]
    [[0, 1, 1], [1, 0, 2]]
    """
    order = np.argsort(second, kind="stable")
    begin = np.searchsorted(second[order], first, "left")
    stop = np.searchsorted(second[order], first, "right")
    count = np.where(np.cumsum(stop - begin) > TUNED.pairs, 0, stop - begin)
    return np.repeat(np.arange(len(count)), count), order[ranges(begin, count)]


class _Front(LayeredSearch):
    """The walks of one side, which start at the candidates, points `first`, `first` + 1 and so on."""

    def __init__(self, search: TwoSided, steps: States, seeds: Candidates, first: int) -> None:
        nodes = first + np.arange(len(seeds.distance))
        super().__init__(start_states(nodes, seeds.rotation, seeds.translation), TUNED.beam)
        self.search = search
        self.aim(0j, 0.0)
        self.steps = steps.take(np.argsort(steps.trail, kind="stable"))
        self.offsets = np.searchsorted(self.steps.trail, np.arange(len(search.roots) + 1))

    def aim(self, goal: complex, frames: float) -> None:
        """Set the goal of the walks on the ground, and the number of frames of a complete walk."""
        self.goal = goal
        self.longest = frames

    def expand(self, states: States) -> States:
        """Extend each walk by each step that leaves its point."""
        count = np.diff(self.offsets)[states.node]
        rows = np.repeat(np.arange(len(count)), count)
        step = ranges(self.offsets[states.node], count)
        return states.then(rows, self.steps.take(step))

    def score(self, states: States) -> Array:
        """Rate walks by their cost, and by the longer steps needed to reach the goal in time."""
        position = states.translation + states.rotation * self.search.roots[states.node]
        remaining = np.maximum(self.search.frames - states.frames, 1) / self.search.graph.fps
        reach = self.search.speed * remaining
        shortfall = np.log(np.maximum(np.abs(self.goal - position) / reach, 1.0))
        return np.asarray(states.cost + TUNED.stretch * remaining * shortfall**2)

    def cells(self, states: States) -> Indices:
        """Return the point and the cells of position and heading of each walk."""
        return standing(states, self.search.roots, TUNED.cell, TUNED.angle)

    def layers(self, states: States) -> Indices:
        """Return the number of the layer, of `TUNED.layer` seconds, of each walk."""
        return states.frames // max(1, round(TUNED.layer * self.search.graph.fps))

    def still_going(self, states: States) -> States:
        """Store each walk that is long enough, because any of them may be joined, and return the others."""
        is_long = states.frames >= self.longest
        self.arrived.append(states.take(is_long))
        return states.take(~is_long)


class _Parts(NamedTuple):
    """Parts of edges: the points that they leave and enter, their frames [begin, stop), and their costs."""

    origin: Indices
    target: Indices
    edge: Indices
    begin: Indices
    stop: Indices
    cost: Array

    @staticmethod
    def join(groups: list[_Parts]) -> _Parts:
        """Concatenate several groups of parts."""
        return _Parts._make(np.concatenate(columns) for columns in zip(*groups, strict=True))


def steps_between(graph: CompiledGraph, starts: Candidates, ends: Candidates) -> States:
    """List the steps of the search: all edges, and the parts of edges from each start and to each end.

    Each is a walk of one step from the point `trail` to the point `node`, along the edge `macro_edge`.
    """
    number = {node: n for n, node in enumerate(graph.nodes)}
    origin = np.array([number[edge[0]] for edge in graph.edges])
    edges = np.arange(len(graph.edges))
    seam = np.where(graph.blended, TUNED.seam + TUNED.match * graph.cost**2, 0.0)
    whole = _Parts(origin, graph.target, edges, 0 * edges, graph.frames, seam)
    begin = starts.stretch
    start = len(graph.nodes) + np.arange(len(begin))
    start_cost = TUNED.end_pose * starts.distance**2
    leaving = _Parts(start, graph.target[begin], begin, starts.since, graph.frames[begin], start_cost)
    finish = ends.stretch
    end = len(graph.nodes) + len(begin) + np.arange(len(finish))
    end_cost = TUNED.end_pose * ends.distance**2
    arriving = _Parts(origin[finish], end, finish, 0 * finish, ends.since, end_cost)
    # An end on the same edge as a start, and after it.
    is_later = starts.since[:, None] <= ends.since
    a, b = np.nonzero((begin[:, None] == finish) & is_later)
    cost = start_cost[a] + end_cost[b]
    on_both = begin[a]
    direct = _Parts(start[a], end[b], on_both, starts.since[a], ends.since[b], cost)
    parts = _Parts.join([whole, leaving, arriving, direct])
    metres = np.concatenate([[0.0], np.cumsum(graph.step)])
    row = graph.first[parts.edge]
    along = metres[row + parts.stop] - metres[row + parts.begin]
    rotation = graph.rotation[parts.edge]
    translation = graph.translation[parts.edge]
    frames = parts.stop - parts.begin
    return States(parts.target, rotation, translation, along, frames, parts.cost, parts.origin, parts.edge)
