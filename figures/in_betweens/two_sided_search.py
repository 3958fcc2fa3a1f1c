"""States from the start and walks back from the end, which meet half-way.

A search from one side finds many walks that pass near the end, and few that stand there as asked. So walks
are lengthened from both sides. Every node where one of each kind stands joins two of them: n walks from each
side give up to n² walks. This is the bidirectional search of I. Pohl (1971) with beams for its two fronts.

The walks are `States`, whose `along` are their metres and whose `hop` is the edge of their last step. All
places are in the world: p ↦ turn · p + move lays the clip of a walk's last node. Where walk a from the
start meets walk b from the end, b's clip lies where a's should. The difference is what must be bent.

The steps are `States`, too, walks of one edge each: over the graph's N nodes, and from the K frames that look
like the start, points N to N + K, to those that look like the end, which come after.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from in_betweens.end_bending import MOST_PACE, MOST_STEPS, MOST_TURN, RISE, STRETCH, TURN
from mocap._shared.arrays import Array, Indices, Points, ranges
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import clip_rows
from mocap.matching.point_clouds import align, point_cloud
from mocap.steering.layered_search import LayeredSearch, States, standing, start_states

AHEAD = 0.1  # seconds from a pose to the one before or after it, and between two choices at least
MOST = 6  # frames of the clips that are tried for each pose

# What a walk costs beside `TURN` and `STRETCH`: a seam costs as much as a second that is turned by 57° per
# second.
SEAM, MATCH = 0.5, 300.0  # for each seam, and times its squared distance in m²
POSE = 100.0  # times the squared metres by which the ends are off the poses

PEAK = 1.4  # a smooth change that is level at both ends is about so many times as large as its mean
BEYOND = 100.0  # for each radian per second, or unit of a step's logarithm, that seems beyond its limit

LAYER = 0.1  # seconds; walks in one layer compete
WIDTH = 400  # walks that stay in a layer
PLACE, ANGLE = 0.1, 0.15  # metres, radians: walks at one node that differ by less stand alike
MEET = 3000  # walks from the start that are joined with those from the end
PAIRS = 3_000_000  # joins that are compared, at most


class Choices(NamedTuple):
    """K frames that look like a pose: which they are, and how their clips are laid there.

    `stretch` (K,): the edge that plays the frame; `since` (K,): its number among the edge's frames; `turn`
    and `move` (K,): p ↦ turn · p + move lays its clip on the pose; `off` (K,): the distance, metres.
    """

    stretch: Indices
    since: Indices
    turn: Points
    move: Points
    off: Array


def pose_at(motion: Motion, way: int, frames: int = 0) -> Motion:
    """Give the frame so many `frames` after a motion's first one, for `way` 1, or before its last, for -1."""
    at = frames if way > 0 else len(motion) - 1 - frames
    return motion[at : at + 1]


def choices(graph: CompiledGraph, motion: Motion, *, way: int, limit: float) -> Choices:
    """Find the frames of a graph's clips that look most like a motion's first or last pose, and move so.

    The distance is the one of [KGP02, Eqs. 1-4] over two poses that are 0.1 s apart; over one where the
    motion is shorter. The frames are at least 0.1 s apart, too.

    Parameters
    ----------
    graph, motion : the graph, and a motion that begins or ends with the pose.
    way : 1 for its first frame, as for a start, and -1 for its last one, as for an end.
    limit : the largest distance, metres.

    Raises
    ------
    NoWalk : where no frame is as near.
    SkeletonMismatch : for a pose of another skeleton.
    """
    clips = graph.source.clips
    clips[0].skeleton.require_same(motion.skeleton)
    own, step = (max(1, round(AHEAD * fps)) for fps in (motion.fps, graph.fps))
    poses = [pose_at(motion, way, frames) for frames in (0, own) if frames < len(motion)]
    rows = np.flatnonzero(~graph.blended[graph.of])
    here, clouds = graph.here[rows], np.concatenate([point_cloud(clip) for clip in clips])
    then = [clip_rows(clips, here + np.array([0, n * way * step])) for n in range(len(poses))]
    points = np.concatenate([clouds[frames] for frames in then], axis=1)
    asked = np.broadcast_to(np.concatenate([point_cloud(pose)[0] for pose in poses]), points.shape)
    laid = align(asked, points)
    each = PlanarTransform(*(np.asarray(part)[:, None] for part in laid))
    off = np.sqrt(((each.apply_points(points) - asked) ** 2).sum(axis=-1).mean(axis=-1))
    # Of frames nearer than the step only the least stays; lanes of clips lie further apart than that.
    lane = clip_rows(clips, here) + step * here[:, 0]
    lanes = np.full(int(lane.max()) + 1, np.inf)
    lanes[lane] = off
    least = minimum_filter1d(lanes, 2 * step + 1, mode="constant", cval=np.inf)
    good = np.flatnonzero(off == least[lane])
    good = good[np.argsort(off[good], kind="stable")[:MOST]]
    if off[good[0]] > limit:
        far = f"is {off[good[0]]:.2f} m off the nearest pose of the clips, and {limit:g} m is the limit"
        pose = f"The {'first' if way > 0 else 'last'} pose of '{motion.name:.60}'"
        raise NoWalk(f"{pose} {far}: take a pose more like theirs.")
    good = good[off[good] <= limit]
    edge = graph.of[rows[good]]
    return Choices(edge, rows[good] - graph.first[edge], laid.turn[good], laid.move[good], off[good])


class Joined(NamedTuple):
    """A walk from start to end: its edges, and the frames that it plays of them.

    `edges`: numbers in the compiled graph; `first`: the frames of the first edge that it leaves out;
    `frames`: how many there are from the start to the end; `place`: lays the first clip; `end`: where the
    last frame's root must come to, a ground point; `apart`: by how much it must be turned there, radians;
    `cost`: of its seams, and of the poses at its ends.
    """

    edges: Indices
    first: int
    frames: int
    place: PlanarTransform
    end: complex
    apart: float
    cost: float


class TwoSided:
    """A search between two poses; `best` gives the walks that need the least bending and the fewest seams.

    Parameters
    ----------
    graph : the compiled graph.
    near : the frames that look like the start, and those that look like the end.
    frames : from the start to the end.
    """

    def __init__(self, graph: CompiledGraph, near: tuple[Choices, Choices], frames: int) -> None:
        self.graph, self.frames = graph, frames
        self.starts, self.ends = starts, ends = near
        self.steps = steps_between(graph, starts, ends)
        # Where the root is at each point, in the coordinates of its clip.
        first = graph.first
        roots = [graph.ground[first[some.stretch] + some.since] for some in near]
        self.at = np.concatenate([graph.at, *roots])
        self.speed = float(np.percentile(graph.step * graph.fps, 75))
        self.here, self.there = (
            complex(some.move[0] + some.turn[0] * at[0]) for some, at in zip(near, roots, strict=True)
        )

    def best(self, most: int) -> list[Joined]:
        """Join the walks of both sides, and give the cheapest ones; none where no two of them meet."""
        half, rest = self.frames / 2, (MOST_PACE - 0.5) * self.frames
        turn = self.steps.turn.conj()  # of the same steps, walked from where they enter to where they leave
        backwards = self.steps._replace(
            node=self.steps.trail, trail=self.steps.node, turn=turn, move=-turn * self.steps.move
        )
        first, last = (len(self.graph.nodes) + n for n in (0, len(self.starts.off)))
        there = _Front(self, self.steps, self.starts, first, (self.there, half))
        back = _Front(self, backwards, self.ends, last, (self.here, rest))
        for front in (there, back):
            for _ in front:
                pass
        middle = States.join(there.arrived)
        middle = middle.take(np.argsort(middle.cost, kind="stable")[:MEET])
        behind = States.join(back.history)
        # Pair every walk of one side with those of the other that stand at the same node, `PAIRS` at most.
        order = np.argsort(behind.node, kind="stable")
        first_of, stop = (np.searchsorted(behind.node[order], middle.node, s) for s in ("left", "right"))
        count = np.where(np.cumsum(stop - first_of) > PAIRS, 0, stop - first_of)
        one, other = np.repeat(np.arange(len(count)), count), order[ranges(first_of, count)]
        price = self.prices(middle.take(one), behind.take(other))
        order = np.argsort(price, kind="stable")
        order = order[np.isfinite(price[order])]
        _, first_of = np.unique(one[order], return_index=True)  # with each walk from the start its best end
        cheap = order[np.sort(first_of)[:most]]
        return [self.join(there.trace(middle, int(one[n])), back.trace(behind, int(other[n]))) for n in cheap]

    def prices(self, one: States, other: States) -> Array:
        """Estimate what each pair of walks that meet costs with all that is left to bend.

        The end is off by a turn Δ and by a vector. A turn that grows evenly takes the first away, and turns
        the way from start to end by Δ/2. What then lies across the way, by an angle a, takes a curve there
        and back, ∫ φ̇² = 12 a² / T. What lies along it, a share r of the metres walked, takes longer steps or
        a bend of ∫ φ̇² = 24 r / T, as the chord of an arc of θ is shorter than the arc by θ² / 24. Only longer
        steps lead further than the metres walked.
        """
        seconds = self.frames / self.graph.fps
        turn = other.turn * one.turn.conj()
        end = turn.conj() * (self.there - other.move) + one.move
        apart, metres = np.angle(turn), np.maximum(one.along + other.along, 0.1)
        way, asked = (end - self.here) * np.exp(0.5j * apart), self.there - self.here
        across = np.abs(((asked - way) * np.exp(-1j * np.angle(way))).imag) / metres
        along = np.abs(abs(asked) - np.abs(way)) / metres
        further = np.log(np.maximum(abs(asked) / metres, 1.0))
        pace = np.log(np.maximum((one.frames + other.frames) / self.frames, 1e-3))
        price = one.cost + other.cost + STRETCH * seconds * (pace**2 + further**2)
        price += TURN / seconds * (apart**2 + 12 * across**2)
        price += np.minimum(STRETCH * seconds * along**2, TURN / seconds * 24 * along)
        turning = PEAK * (np.abs(apart) + 6 * across) / seconds
        price += BEYOND * np.maximum(turning - MOST_TURN, 0.0)
        price += BEYOND * np.maximum(PEAK * further - np.log(MOST_STEPS), 0.0)
        return np.where(np.abs(pace) <= (1 - RISE) * np.log(MOST_PACE), price, np.inf)

    def join(self, there: States, back: States) -> Joined:
        """List the edges of two walks that meet."""
        starts, ends, graph = self.starts, self.ends, self.graph
        edges = np.concatenate([there.hop[1:], back.hop[:0:-1]])
        point = int(back.node[0])
        start, end = int(there.node[0]) - len(graph.nodes), point - len(graph.nodes) - len(starts.off)
        turn, laid = complex(starts.turn[start]), complex(ends.turn[end])
        return Joined(
            edges,
            int(starts.since[start]),
            int(there.frames[-1] + back.frames[-1]),
            PlanarTransform.from_complex(turn, complex(starts.move[start])),
            complex(ends.move[end] + laid * self.at[point]),
            float(np.angle(laid / (turn * np.prod(graph.turn[edges])))),
            float(there.cost[-1] + back.cost[-1]),
        )


class _Front(LayeredSearch):
    """The walks of one side from the points `first` on, to a place, until they are so many frames long."""

    def __init__(
        self, of: TwoSided, steps: States, seeds: Choices, first: int, to: tuple[complex, float]
    ) -> None:
        nodes = first + np.arange(len(seeds.off))
        super().__init__(start_states(nodes, seeds.turn, seeds.move), WIDTH)
        self.of, (self.goal, self.most) = of, to
        self.steps = steps.take(np.argsort(steps.trail, kind="stable"))
        self.offsets = np.searchsorted(self.steps.trail, np.arange(len(of.at) + 1))

    def expand(self, states: States) -> States:
        """Lengthen every walk by every step that leaves its point."""
        count = np.diff(self.offsets)[states.node]
        of, step = np.repeat(np.arange(len(count)), count), ranges(self.offsets[states.node], count)
        return states.then(of, self.steps.take(step))

    def score(self, states: States) -> Array:
        """Rate walks by their cost, and by how much longer steps must become to reach the goal in time."""
        place = states.move + states.turn * self.of.at[states.node]
        left = np.maximum(self.of.frames - states.frames, 1) / self.of.graph.fps
        short = np.log(np.maximum(np.abs(self.goal - place) / (self.of.speed * left), 1.0))
        return np.asarray(states.cost + STRETCH * left * short**2)

    def cells(self, states: States) -> Indices:
        """Give the point, and cells of the ground and of directions."""
        return standing(states, self.of.at, PLACE, ANGLE)

    def layers(self, states: States) -> Indices:
        """Count layers of `LAYER` seconds."""
        return states.frames // max(1, round(LAYER * self.of.graph.fps))

    def still_going(self, states: States) -> States:
        """Put aside every walk that is long enough, for any of them may be joined."""
        long = states.frames >= self.most
        self.arrived.append(states.take(long))
        return states.take(~long)


def steps_between(graph: CompiledGraph, starts: Choices, ends: Choices) -> States:
    """List all edges of a graph as steps, with those from each start to the next node, and to each end.

    Each is a walk of one step from the point `trail` to the point `node`, along the edge `hop`.
    """
    number = {node: n for n, node in enumerate(graph.nodes)}
    leaves, every = np.array([number[edge[0]] for edge in graph.edges]), np.arange(len(graph.edges))
    one, other = np.nonzero(  # an end on the same stretch as a start, after it
        (starts.stretch[:, None] == ends.stretch) & (starts.since[:, None] <= ends.since)
    )
    start = len(graph.nodes) + np.arange(len(starts.off))
    end = len(graph.nodes) + len(starts.off) + np.arange(len(ends.off))
    come, go, both = starts.stretch, ends.stretch, starts.stretch[one]
    begun, ended = POSE * starts.off**2, POSE * ends.off**2
    seam = np.where(graph.blended, SEAM + MATCH * graph.cost**2, 0.0)
    parts = [  # point left, point entered, edge, its first frame and the one after its last, and the cost
        (leaves, graph.target, every, 0 * every, graph.frames, seam),
        (start, graph.target[come], come, starts.since, graph.frames[come], begun),
        (leaves[go], end, go, 0 * go, ends.since, ended),
        (start[one], end[other], both, starts.since[one], ends.since[other], begun[one] + ended[other]),
    ]
    left, entered, edge, begin, stop, cost = map(np.concatenate, zip(*parts, strict=True))
    metres, row = np.concatenate([[0.0], np.cumsum(graph.step)]), graph.first[edge]
    along = metres[row + stop] - metres[row + begin]
    return States(entered, graph.turn[edge], graph.move[edge], along, stop - begin, cost, left, edge)
