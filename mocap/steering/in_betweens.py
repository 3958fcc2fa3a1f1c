"""Between two poses at two places in a given time: a walk through the clips, brought to both."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading
from mocap.editing.displacements import Displacement
from mocap.editing.path_editing import plants_kept
from mocap.errors import MocapError, MocapWarning, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.edge_tables import Edge
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.end_bending import STRETCH, TURN, Arrived, Limits, bend_to, played
from mocap.steering.held_ends import meet_poses, stand
from mocap.steering.moments import Choices, Moment, choices
from mocap.steering.two_sided_search import Joined, TwoSided
from mocap.synthesis.walk_to_motion import to_motion, with_plants

CHOICES = 6  # frames of the clips that are tried for each pose
TRIED = 24  # walks that are bent, of all that were found
LONGEST = 120.0  # seconds

# Times that feet are cleaned up and ends brought to the poses. The clean-up may let go what it should hold at
# the ends, by up to 1° of a joint; feet then slide by up to 0.3 mm. After the second round they do not.
ROUNDS = 2


class Missed(NamedTuple):
    """How far a motion is from a pose: metres of the root, degrees of the heading, degrees of any joint."""

    place: float
    heading: float
    pose: float


@dataclass(frozen=True, eq=False)
class InBetween:
    """A motion from one moment to another, and what it took; `in_between` shows an example.

    Parameters
    ----------
    motion : N + 1 frames, the first and the last of them the poses asked for.
    laid : the same before its feet were cleaned up.
    graph, walk : where it comes from.
    start, end : the moments asked for.
    turned : shape (N,), the turning that was added, radians per second.
    steps : shape (N,), times which the steps were made longer.
    pace : shape (N,), times which the clips are played faster.
    faded : the displacement that was added to meet the poses.
    seams : how many transitions there are.
    """

    motion: Motion
    laid: Motion
    graph: MotionGraph
    walk: list[Edge]
    start: Moment
    end: Moment
    turned: Array
    steps: Array
    pace: Array
    faded: Displacement
    seams: int

    @cached_property
    def missed(self) -> tuple[Missed, Missed]:
        """How far the motion is from both poses, measured on it."""
        return _missed(self.motion, 0, self.start), _missed(self.motion, -1, self.end)

    @property
    def kept(self) -> float:
        """The share of the planted frames that the clean-up kept."""
        return plants_kept(self.motion, self.laid)

    def report(self) -> str:
        """Say what was asked for and met, and what was bent, lengthened, retimed and faded for it."""
        steps, pace = (f"{values.min():.2f} to {values.max():.2f}" for values in (self.steps, self.pace))
        worst = Missed(*(max(pair) for pair in zip(*self.missed, strict=True)))
        moved, warped = (np.linalg.norm(part, axis=-1).max() for part in self.faded)
        return (
            f"{self.motion.duration:.2f} s, {self.seams} seams; missed by {1000 * worst.place:.1f} mm, "
            f"{worst.heading:.2f}° of heading and {worst.pose:.2f}° of a joint; turned by up to "
            f"{np.degrees(np.abs(self.turned).max()):.0f}° per second, steps {steps} times as long, played "
            f"{pace} times as fast, ends moved by {100 * moved:.1f} cm and {np.degrees(warped):.0f}°, "
            f"{self.kept:.0%} of the plants kept"
        )


def in_between(
    graph: MotionGraph | CompiledGraph,
    start: Moment,
    end: Moment,
    seconds: float,
    *,
    limits: Limits | None = None,
) -> InBetween:
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
    limits : by how much the walk may be changed.

    Returns
    -------
    The motion, and what it took.

    Raises
    ------
    NoWalk : where no walk arrives within the limits; the sentence says what would help.
    MocapError : for a time that is too short or too long to be one, legs that cannot be found, and limits
        and moments that make no sense.
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
    graph, limits = compile_graph(graph), limits or Limits()
    if not (np.isfinite(seconds) and 2 / graph.fps <= seconds <= LONGEST):
        raise MocapError(f"A motion lasts from {2 / graph.fps:.2f} to {LONGEST:g} s, got {seconds} s.")
    frames = round(seconds * graph.fps)
    near = _near(graph, start, 1, limits), _near(graph, end, -1, limits)
    search = TwoSided(graph, near, frames, limits)
    source = with_plants(graph.source)
    found = [_changed(source, graph, joined, frames, limits) for joined in search.best(TRIED)]
    return _met(graph, _least(found, limits, search), start, end)


def _near(graph: CompiledGraph, moment: Moment, way: int, limits: Limits) -> Choices:
    """Find the frames of the clips that look like a pose, or refuse it."""
    near = choices(graph, moment, way=way, most=CHOICES)
    close = near.off <= limits.pose
    if not close.any():
        raise NoWalk(
            f"Frame {moment.frame} of '{moment.motion.name:.60}' is {near.off[0]:.2f} m off the nearest pose "
            f"of the clips, and {limits.pose:g} m is the limit: take a pose more like theirs."
        )
    return near.take(close)


class _Changed(NamedTuple):
    """A walk that was changed to arrive."""

    joined: Joined
    arrived: Arrived
    pace: Array

    @property
    def price(self) -> float:
        """What the changes cost."""
        turned, log = self.arrived.turned, np.log(self.arrived.steps)
        stretched = log @ log + np.log(self.pace) @ np.log(self.pace)
        changes = TURN * (turned @ turned) + STRETCH * stretched
        return float(self.joined.cost + changes / self.arrived.motion.fps)

    @property
    def turn(self) -> float:
        """The fastest turning that was added, radians per second."""
        return float(np.abs(self.arrived.turned).max())


def _changed(
    source: MotionGraph, graph: CompiledGraph, joined: Joined, frames: int, limits: Limits
) -> _Changed:
    """Play a walk in as many frames as asked for, and bend it to its end."""
    place = PlanarTransform.from_complex(joined.turn, joined.move)
    motion = to_motion(source, [graph.edges[edge] for edge in joined.edges], place=place)
    motion, pace = played(motion[joined.first : joined.first + joined.frames + 1], frames + 1)
    return _Changed(joined, bend_to(motion, joined.end, joined.apart, limits), pace)


def _least(found: list[_Changed], limits: Limits, search: TwoSided) -> _Changed:
    """Take the walk within the limits that is changed least, or say why there is none."""
    arriving = [walk for walk in found if walk.arrived.lack <= limits.pose / 2]
    good = [walk for walk in arriving if walk.turn <= limits.turn]
    if good:
        return min(good, key=lambda walk: walk.price)
    seconds, apart = search.frames / search.graph.fps, abs(search.there - search.here)
    if not found:
        raise NoWalk(
            f"No walk leads from one pose to the other in {seconds:.1f} s at {limits.pace:g} times its pace: "
            "give another time, other poses, or a graph with a higher threshold."
        )
    if arriving:
        best = min(arriving, key=lambda walk: walk.turn)
        turn, most = np.degrees([best.turn, limits.turn])
        raise NoWalk(
            f"To arrive in {seconds:.1f} s, walks must be turned by {turn:.0f}° per second; the limit is "
            f"{most:.0f}°: give about {seconds * turn / most:.1f} s, or let the end face another way."
        )
    lack = min(walk.arrived.lack for walk in found)
    reach = apart - lack
    too_far = reach > search.speed * seconds / 2  # else it is the way to turn that takes the time
    raise NoWalk(
        f"In {seconds:.1f} s walks end {lack:.1f} m from the place that is {apart:.1f} m away: give "
        + (f"about {seconds * apart / reach:.1f} s." if too_far else "another time, or another way to face.")
    )


def _met(graph: CompiledGraph, changed: _Changed, start: Moment, end: Moment) -> InBetween:
    """Let the ends fade into the poses, and clean up the feet."""
    laid, faded = meet_poses(replace(changed.arrived.motion, name="in between"), start, end)
    motion = laid
    for _ in range(ROUNDS):
        motion, _ = meet_poses(stand(motion), start, end, speed=False)
    edges, arrived = changed.joined.edges, changed.arrived
    took = (arrived.turned, arrived.steps, changed.pace, faded, int(graph.blended[edges].sum()))
    walk = [graph.edges[edge] for edge in edges]
    found = InBetween(motion, laid, graph.source, walk, start, end, *took)
    if found.kept < 1:
        warnings.warn(
            f"'{motion.name}': {1 - found.kept:.0%} of the planted frames are let go: to hold them would "
            "move the root by more than 2 cm, stretch a leg or jolt a knee.",
            MocapWarning,
            stacklevel=3,
        )
    return found


def _missed(motion: Motion, frame: int, moment: Moment) -> Missed:
    """Measure how far a frame is from a pose at its place."""
    asked = moment.placed()
    turns = rotations.angle_between(motion.rotations[frame], asked.rotations[0])
    faces = heading(motion.rotations[frame, 0]) - heading(asked.rotations[0, 0])
    place = np.linalg.norm(motion.root_positions[frame] - asked.root_positions[0])
    wrapped = abs((float(faces) + np.pi) % (2 * np.pi) - np.pi)
    return Missed(float(place), float(np.degrees(wrapped)), float(np.degrees(turns).max()))
