"""A pose at a place on the ground, and the frames of a graph's clips that look like it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import minimum_filter1d

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, place
from mocap.errors import MocapError
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.matching.point_clouds import align, point_cloud

AHEAD = 0.1  # seconds from a pose to the one before or after it, and between two choices at least


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
        root, faces = now.root_positions[0], float(heading(now.rotations[0, 0]))
        direction = faces if self.direction is None else self.direction
        there = place(now, direction, root[[0, 2]] if self.position is None else self.position)
        turn = PlanarTransform(direction - faces, 0.0, 0.0)
        x, _, z = there.root_positions[0] - turn.apply_points(root)
        chosen = self.frame + step
        return turn._replace(x=x, z=z).apply_motion(self.motion[chosen : chosen + 1])

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

    def take(self, rows: Indices | Mask) -> Choices:
        """Take some of the frames."""
        return Choices._make(values[rows] for values in self)


def choices(graph: CompiledGraph, moment: Moment, *, way: int, most: int) -> Choices:
    """Find the frames of a graph's clips that look most like a moment and move as it does.

    The distance is the one of [KGP02, Eqs. 1-4] over two poses that are 0.1 s apart; over one where the
    moment's motion ends there.

    Parameters
    ----------
    graph, moment : the graph and the pose.
    way : whether the frame after the pose counts, 1, as for a start, or the one before it, -1, as for an end.
    most : how many frames; they are at least 0.1 s apart.

    Raises
    ------
    SkeletonMismatch : for a pose of another skeleton.
    """
    graph.source.clips[0].skeleton.require_same(moment.motion.skeleton)
    own, step = (way * max(1, round(AHEAD * fps)) for fps in (moment.motion.fps, graph.fps))
    poses = [moment.placed(), *([moment.placed(own)] if moment.has(own) else [])]
    asked = np.concatenate([point_cloud(pose)[0] for pose in poses])
    edge = graph.plays.edge
    rows = np.flatnonzero(~graph.blended[edge])
    clip, frame = graph.plays.here[rows].T
    parts: list[tuple[NDArray[Any], ...]] = []
    for number in np.unique(clip):
        mine = rows[clip == number]
        frames = frame[clip == number]
        off, laid = _distances(asked, graph.source.clips[number], frames, step)
        good = _least(off, frames, abs(step))
        row = mine[good]
        since = row - graph.tracks.first[edge[row]]
        parts.append((edge[row], since, laid.turn[good], laid.move[good], off[good]))
    found = Choices(*(np.concatenate(numbers) for numbers in zip(*parts, strict=True)))
    return found.take(np.argsort(found.off, kind="stable")[:most])


def _distances(asked: Array, clip: Motion, frames: Indices, step: int) -> tuple[Array, PlanarTransform]:
    """Lay frames of a clip, and those `step` after them, on one or two poses; give what is left, metres."""
    cloud = point_cloud(clip)
    poses = len(asked) // cloud.shape[1]
    then = [np.clip(frames + n * step, 0, len(cloud) - 1) for n in range(poses)]
    points = np.concatenate([cloud[rows] for rows in then], axis=1)
    asked = np.broadcast_to(asked, points.shape)
    laid = align(asked, points)
    each = PlanarTransform(*(np.asarray(part)[:, None] for part in laid))
    return np.sqrt(((each.apply_points(points) - asked) ** 2).sum(axis=-1).mean(axis=-1)), laid


def _least(off: Array, frames: Indices, apart: int) -> Indices:
    """List the frames of a clip for which no other frame within `apart` frames is nearer."""
    lanes = np.full(int(frames.max()) + 1, np.inf)
    lanes[frames] = off
    least = minimum_filter1d(lanes, 2 * apart + 1, mode="constant", cval=np.inf)
    return np.flatnonzero(off == least[frames])
