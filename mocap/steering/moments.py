"""A pose at a place on the ground, and the frames of a graph's clips that look like it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import minimum_filter1d

from mocap._shared.arrays import Array, Indices, Points
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, lay_on, place
from mocap.errors import MocapError, NoWalk
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import clip_rows
from mocap.matching.point_clouds import align, point_cloud

AHEAD = 0.1  # seconds from a pose to the one before or after it, and between two choices at least
MOST = 6  # frames of the clips that are tried for each pose


@dataclass(frozen=True, eq=False)
class Moment:
    """A pose at a place: one frame of a motion, which may be a node's clip or any motion of the skeleton.

    Parameters
    ----------
    motion, frame : the pose; the frames around it say how fast it moves. -1 is the last frame.
    position : (x, z) of the root, metres; by default where it is in the motion.
    direction : which way the body faces, radians, as `body.heading` reads it; by default as in the motion.

    Raises
    ------
    MocapError : for a frame that is not in the motion, and places that are not finite.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> Moment(sample("walk_circle"), 30, position=(1, 2), direction=0.0).placed().root_positions[:, [0, 2]]
    array([[1., 2.]])
    """

    motion: Motion
    frame: int = 0
    position: ArrayLike | None = None
    direction: float | None = None

    def __post_init__(self) -> None:
        count = len(self.motion)
        if not -count <= self.frame < count:
            raise MocapError(f"'{self.motion.name}' has {count} frames; there is no frame {self.frame}.")
        object.__setattr__(self, "frame", int(self.frame) % count)
        self.placed()  # which refuses places that make no sense

    def placed(self, step: int = 0) -> Motion:
        """Give the pose at its place, one frame; or the frame `step` frames from it, moved with it."""
        now = self.motion[self.frame : self.frame + 1]
        direction = float(heading(now.rotations[0, 0])) if self.direction is None else self.direction
        at = now.root_positions[0, [0, 2]] if self.position is None else self.position
        there = place(now, direction, at)
        return lay_on(now, there).apply_motion(self.motion[self.frame + step : self.frame + step + 1])

    def has(self, step: int) -> bool:
        """Say whether the motion has a frame `step` frames from the moment."""
        return 0 <= self.frame + step < len(self.motion)


class Choices(NamedTuple):
    """K frames that look like a moment: which they are, and how their clips are laid there.

    `stretch` (K,): the edge that plays the frame; `since` (K,): its number among the edge's frames; `turn`
    and `move` (K,): p ↦ turn · p + move lays its clip on the moment; `off` (K,): the distance, metres.
    """

    stretch: Indices
    since: Indices
    turn: Points
    move: Points
    off: Array


def choices(graph: CompiledGraph, moment: Moment, *, way: int, limit: float) -> Choices:
    """Find the frames of a graph's clips that look most like a moment and move as it does.

    The distance is the one of [KGP02, Eqs. 1-4] over two poses that are 0.1 s apart; over one where the
    moment's motion ends there. The frames are at least 0.1 s apart, too.

    Parameters
    ----------
    graph, moment : the graph and the pose.
    way : whether the frame after the pose counts, 1, as for a start, or the one before it, -1, as for an end.
    limit : the largest distance, metres.

    Raises
    ------
    NoWalk : where no frame is as near.
    SkeletonMismatch : for a pose of another skeleton.
    """
    clips = graph.source.clips
    clips[0].skeleton.require_same(moment.motion.skeleton)
    own, step = (way * max(1, round(AHEAD * fps)) for fps in (moment.motion.fps, graph.fps))
    poses = [moment.placed(), *([moment.placed(own)] if moment.has(own) else [])]
    rows = np.flatnonzero(~graph.blended[graph.plays.edge])
    here, clouds = graph.plays.here[rows], np.concatenate([point_cloud(clip) for clip in clips])
    then = [clip_rows(clips, here + np.array([0, n * step])) for n in range(len(poses))]
    points = np.concatenate([clouds[frames] for frames in then], axis=1)
    asked = np.broadcast_to(np.concatenate([point_cloud(pose)[0] for pose in poses]), points.shape)
    laid = align(asked, points)
    each = PlanarTransform(*(np.asarray(part)[:, None] for part in laid))
    off = np.sqrt(((each.apply_points(points) - asked) ** 2).sum(axis=-1).mean(axis=-1))
    # Of frames nearer than the step only the least stays; lanes of clips lie further apart than that.
    lane = clip_rows(clips, here) + abs(step) * here[:, 0]
    lanes = np.full(int(lane.max()) + 1, np.inf)
    lanes[lane] = off
    least = minimum_filter1d(lanes, 2 * abs(step) + 1, mode="constant", cval=np.inf)
    good = np.flatnonzero(off == least[lane])
    good = good[np.argsort(off[good], kind="stable")[:MOST]]
    if off[good[0]] > limit:
        far = f"is {off[good[0]]:.2f} m off the nearest pose of the clips, and {limit:g} m is the limit"
        frame = f"Frame {moment.frame} of '{moment.motion.name:.60}'"
        raise NoWalk(f"{frame} {far}: take a pose more like theirs.")
    good = good[off[good] <= limit]
    edge = graph.plays.edge[rows[good]]
    return Choices(edge, rows[good] - graph.first[edge], laid.turn[good], laid.move[good], off[good])
