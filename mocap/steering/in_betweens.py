"""Between two poses at two places in a given time: a walk through the clips, brought to both."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement
from mocap.editing.path_editing import plants_kept, warn_of_plants
from mocap.errors import MocapError, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.end_bending import MOST_PACE, MOST_TURN, Arrived, bend_to
from mocap.steering.held_ends import meet_poses, stand
from mocap.steering.moments import Moment, choices
from mocap.steering.two_sided_search import Joined, TwoSided
from mocap.synthesis.walk_to_motion import to_motion, with_plants

TRIED = 24  # walks that are bent, of all that were found
LONGEST = 120.0  # seconds
POSE = 0.1  # metres by which joints may be moved where ends fade into the poses, the root mean square

# Times that feet are cleaned up and ends brought to the poses. The clean-up may let go what it should hold at
# the ends, by up to 1° of a joint; feet then slide by up to 0.3 mm. After the second round they do not.
ROUNDS = 2


@dataclass(frozen=True, eq=False)
class InBetween:
    """A motion from one moment to another, and what it took; `in_between` shows an example.

    Parameters
    ----------
    motion : N + 1 frames, the first and the last of them the poses asked for.
    laid : the same before its feet were cleaned up.
    graph, walk : where it comes from.
    start, end : the moments asked for.
    arrived : the walk before its ends faded, and by how much it was turned, lengthened and retimed.
    faded : the displacement that was added to meet the poses.
    seams : how many transitions there are.
    """

    motion: Motion
    laid: Motion
    graph: MotionGraph
    walk: list[Edge]
    start: Moment
    end: Moment
    arrived: Arrived
    faded: Displacement
    seams: int

    @property
    def kept(self) -> float:
        """The share of the planted frames that the clean-up kept."""
        return plants_kept(self.motion, self.laid)

    def report(self) -> str:
        """Say what was bent, lengthened, retimed and faded to meet what was asked for."""
        took = self.arrived
        steps, pace = (f"{values.min():.2f} to {values.max():.2f}" for values in (took.steps, took.pace))
        moved, warped = (np.linalg.norm(part, axis=-1).max() for part in self.faded)
        return (
            f"{self.motion.duration:.2f} s, {self.seams} seams; turned by up to "
            f"{np.degrees(np.abs(took.turned).max()):.0f}° per second, steps {steps} times as long, played "
            f"{pace} times as fast, ends moved by {100 * moved:.1f} cm and {np.degrees(warped):.0f}°, "
            f"{self.kept:.0%} of the plants kept"
        )


def in_between(graph: MotionGraph | CompiledGraph, start: Moment, end: Moment, seconds: float) -> InBetween:
    """Find a motion from one pose to another, each at its place, in a given time.

    Walks from both poses that meet half-way give what the clips can do. Of the best of them the one is taken
    that need be changed least: its path is bent [Gle01] and its steps are lengthened, its time is stretched,
    and its ends fade into the poses. Then its feet are cleaned up. The papers ask for a path; that a walk
    arrives at a pose in time is ours.

    Parameters
    ----------
    graph : pruned.
    start, end : poses of the graph's skeleton, at their places. Frames of its own clips are met best.
    seconds : from the first frame to the last, rounded to whole frames.

    Returns
    -------
    The motion, and what it took.

    Raises
    ------
    NoWalk : where no walk arrives though its pace and its steps change by up to a quarter, its turning by up
        to 60° per second and the poses at its ends by up to 10 cm; the sentence says what would help.
    MocapError : for a time that is too short or too long to be one, and legs that cannot be found.
    SkeletonMismatch : for a pose of another skeleton.

    Warns
    -----
    MocapWarning : for plants that are let go.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> start, end = Moment(clips[0], 40, (0, 0), 0.0), Moment(clips[1], 100, (1, 3), 0.5)
    >>> found = in_between(graph, start, end, 4.0)
    >>> len(found.motion), found.motion.root_positions[-1, [0, 2]].round(4)
    (121, array([1., 3.]))
    """
    graph = compile_graph(graph)
    if not (np.isfinite(seconds) and 2 / graph.fps <= seconds <= LONGEST):
        raise MocapError(f"A motion lasts from {2 / graph.fps:.2f} to {LONGEST:g} s, got {seconds} s.")
    frames = round(seconds * graph.fps)
    near = (choices(graph, moment, way=way, limit=POSE) for moment, way in ((start, 1), (end, -1)))
    search = TwoSided(graph, (next(near), next(near)), frames)
    source, found = with_plants(graph.source), []
    for joined in search.best(TRIED):
        walk = [graph.edges[edge] for edge in joined.edges]
        played = to_motion(source, walk, place=joined.place)[joined.first : joined.first + joined.frames + 1]
        found.append((joined, bend_to(played, frames + 1, joined.end, joined.apart)))
    joined, arrived = _least(found, search)
    laid, faded = meet_poses(replace(arrived.motion, name="in between"), start, end)
    motion = laid
    for _ in range(ROUNDS):
        motion, _ = meet_poses(stand(motion), start, end, speed=False)
    walk, seams = [graph.edges[edge] for edge in joined.edges], int(graph.blended[joined.edges].sum())
    between = InBetween(motion, laid, graph.source, walk, start, end, arrived, faded, seams)
    warn_of_plants(motion.name, between.kept, 3)
    return between


def _least(found: list[tuple[Joined, Arrived]], search: TwoSided) -> tuple[Joined, Arrived]:
    """Take the walk that arrives and is changed least, or say why there is none."""
    turned = [float(np.abs(arrived.turned).max()) for _, arrived in found]
    arriving = [n for n, (_, arrived) in enumerate(found) if arrived.lack <= POSE / 2]
    if good := [found[n] for n in arriving if turned[n] <= MOST_TURN]:
        return min(good, key=lambda pair: pair[0].cost + pair[1].price)
    seconds, apart = search.frames / search.graph.fps, abs(search.there - search.here)
    if not found:
        helps = "give another time, other poses, or a graph with a higher threshold"
        pace = f"{MOST_PACE:g} times its pace"
        raise NoWalk(f"No walk leads from one pose to the other in {seconds:.1f} s at {pace}: {helps}.")
    if arriving:
        turn, most = np.degrees([min(turned[n] for n in arriving), MOST_TURN])
        must = f"walks must be turned by {turn:.0f}° per second; the limit is {most:.0f}°"
        helps = f"give about {seconds * turn / most:.1f} s, or let the end face another way"
        raise NoWalk(f"To arrive in {seconds:.1f} s, {must}: {helps}.")
    lack = min(arrived.lack for _, arrived in found)
    reach = apart - lack
    too_far = reach > search.speed * seconds / 2  # else it is the way to turn that takes the time
    helps = f"about {seconds * apart / reach:.1f} s" if too_far else "another time, or another way to face"
    ends = f"walks end {lack:.1f} m from the place that is {apart:.1f} m away"
    raise NoWalk(f"In {seconds:.1f} s {ends}: give {helps}.")
