"""Bending of walks onto a line, frame by frame, as `walk_bending.js` does it on the walking page.

A walk goes along its own smooth path, and turns only as its clips turn. Path editing [Gle01] carries each
frame from its own path to the line: the planar transform of a frame is N'(s) N⁻¹, where N is the moving frame
of its own path, and N' that of the line at the same arc length s. A foot that stands is then carried by the
transform of the middle of its stance, so that it neither slides nor pivots. The leg is solved for it, and the
root sinks where a leg would be too short. `editing.bend` does the same with a clean-up of the whole motion.
Here a frame depends only on the stances around it, and a page can bend a walk while it grows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from mocap._shared.arrays import Array, Indices, Mask, Points
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.ground_path import GroundPath
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform, heading, on_ground
from mocap.editing.path_editing import moving_frames, ride_of
from mocap.editing.pins import with_plants
from mocap.errors import MocapError
from mocap.graphs.edge_tables import Edge, EdgeTable, edge_table
from mocap.graphs.motion_graph import MotionGraph
from mocap.synthesis.walk_to_motion import to_motion, transforms_along

BRIDGED = 2  # frames: a foot that lifts for so short a time stands on
SHORTEST = 3  # frames: a shorter stance is none
FADE = 8  # frames from the first and the last frame of a walk to the nearest stance of a foot
STRAIGHTEST = np.radians(4.0)  # radians: no knee is straightened further
DEEPEST = 0.05  # metres by which the root sinks at most
SINKING = 4  # frames before and after, over which the root sinks
TINY = 1e-9  # metres, and square metres


class SmoothPath(NamedTuple):
    """The smooth path of a clip: headings (F,), radians, and points z + ix of the ground (F,), metres."""

    heading: Array
    points: Points


class Limb(NamedTuple):
    """A leg, and the axis of its knee in the frame of its thigh, a unit vector (3,)."""

    leg: Leg
    axis: Array


class Stance(NamedTuple):
    """The frames [start, end) of a foot that stands, and the motion of its ankle in them, which holds it.

    `angle` (radians) and `displacement` (z + ix, metres), shape (end - start,), start at the carried ankle.
    """

    start: int
    end: int
    angle: Array
    displacement: Points


def smooth_path(clip: Motion) -> SmoothPath:
    """Return the path about which the root of a clip sways, or that of the root if the body only stands.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> path = smooth_path(sample("walk_straight"))
    >>> path.points.shape, bool(abs(path.heading).max() < 0.5)  # it goes along z
    ((1158,), True)
    """
    try:
        ride = ride_of(clip)
    except MocapError:
        return SmoothPath(np.unwrap(heading(clip.rotations[:, 0])), on_ground(clip.root_positions))
    frames = moving_frames(ride.path, ride.along)
    return SmoothPath(np.asarray(frames.angle), on_ground(ride.path.at(ride.along)))


def limbs_of(clips: Sequence[Motion]) -> list[Limb]:
    """Return the legs of a body, with the mean axes of their knees over all clips; none if it has no legs.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> [(limb.axis.round(1) + 0.0).tolist() for limb in limbs_of([sample("walk_straight")])]
    [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    """
    try:
        legs = find_legs(clips[0].skeleton)
    except MocapError:
        return []
    across = np.zeros((len(legs), 3))
    for clip in clips:
        poses = forward_kinematics(clip)
        for number, leg in enumerate(legs):
            hip, knee, ankle = (poses.positions[:, joint] for joint in leg[:3])
            world = np.cross(knee - hip, ankle - knee)
            across[number] += np.einsum("fji,fj->i", poses.matrices[:, leg.hip], world)
    lengths = np.maximum(np.linalg.norm(across, axis=1, keepdims=True), TINY)
    return [Limb(leg, axis) for leg, axis in zip(legs, across / lengths, strict=True)]


def standing(clip: Motion, limbs: Sequence[Limb]) -> Mask:
    """Return when the ankle and the ball of each leg stand, shape (2 L, F) for L legs."""
    if not limbs:
        return np.zeros((0, len(clip)), bool)
    marked = with_plants(clip, [limb.leg for limb in limbs])
    joints = [joint for limb in limbs for joint in (limb.leg.ankle, limb.leg.ball)]
    return np.array([marked.contacts[clip.skeleton.names[joint]] for joint in joints], bool)


class Bendable(NamedTuple):
    """The data of clips that bending needs: their legs, and for each clip its smooth path and its stances."""

    limbs: list[Limb]
    paths: list[SmoothPath]
    stands: list[Mask]

    @classmethod
    def of(cls, clips: Sequence[Motion]) -> Bendable:
        """Measure clips of one skeleton."""
        limbs = limbs_of(clips)
        return cls(limbs, [smooth_path(clip) for clip in clips], [standing(clip, limbs) for clip in clips])


def bend_onto(
    graph: MotionGraph, edges: Sequence[Edge], line: GroundPath, bendable: Bendable | None = None
) -> Motion:
    """Bend a walk through a graph onto a line: the twin of the walking page, frame by frame.

    Parameters
    ----------
    graph : the graph.
    edges : consecutive edges, which `to_motion` converts to F frames.
    line : the line. Its start is where the walk begins. Beyond its end, the walk goes straight on.
    bendable : of the clips, if it is known.

    Returns
    -------
    F frames, whose root sways about the line, and whose feet stand still.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clip = body.resample(datasets.sample("walk_straight"), 30)
    >>> graph = graphs.from_transitions([clip], [], window=10)
    >>> bent = bend_onto(graph, [((0, 0), (0, len(clip)), 0)], body.circle(2.0))
    >>> distance = np.hypot(*(bent.root_positions[:, [0, 2]] - [2.0, 0.0]).T)  # from the centre of the circle
    >>> bool(abs(distance - 2.0).mean() < 0.02)
    True
    """
    limbs, paths, marks = bendable or Bendable.of(graph.clips)
    table = edge_table(graph, edges)
    walk = to_motion(graph, edges)
    path, along = _path_of_walk(paths, table)
    carried = moving_frames(line, along) @ path.inverse()
    poses = forward_kinematics(walk)
    clip, frame = table.owner.T
    stands = np.array([marks[c][:, f] for c, f in zip(clip, frame, strict=True)]).T
    targets = []
    for number, limb in enumerate(limbs):
        feet = [on_ground(poses.positions[:, joint]) for joint in (limb.leg.ankle, limb.leg.ball)]
        stances = _stances(feet, stands[2 * number : 2 * number + 2], carried)
        targets.append(_between_stances(stances, len(walk)))
    return _posed(walk, poses, carried, limbs, targets)


def _path_of_walk(paths: Sequence[SmoothPath], table: EdgeTable) -> tuple[PlanarTransform, Array]:
    """Return the moving frames of a walk's own path, and the metres along it, (F,)."""
    transforms = transforms_along(table, PlanarTransform(0.0, 0.0, 0.0))

    def gathered(frames: Indices, edge: Indices) -> tuple[Array, Points, Array]:
        """Gather the headings, the points and the steps of the clips, and transform them."""
        angle = np.angle(transforms.rotation[edge])
        headings = angle + [paths[clip].heading[frame] for clip, frame in frames]
        points = np.array([paths[clip].points[frame] for clip, frame in frames])
        previous = np.array([paths[clip].points[max(frame - 1, 0)] for clip, frame in frames])
        moved = transforms.rotation[edge] * points + transforms.translation[edge]
        return headings, moved, np.abs(points - previous)

    headings, points, steps = gathered(table.here, table.of)
    entered = gathered(table.there, np.where(table.blended[table.of], table.of + 1, table.of))
    weight = 1 - table.alpha
    headings = headings + weight * _wrapped(entered[0] - headings)
    points = points + weight * (entered[1] - points)
    steps = steps + weight * (entered[2] - steps)
    steps[0] = 0.0
    return PlanarTransform(headings, points.imag, points.real), np.cumsum(steps)


def _stances(feet: Sequence[Points], stands: Mask, carried: PlanarTransform) -> Iterator[Stance]:
    """Yield the stances of a foot.

    Parameters
    ----------
    feet : the ankle and the ball in the walk that is not bent, (F,) each.
    stands : shape (2, F), when they stand.
    carried : the transforms of the F frames.
    """
    rotation = carried.rotation
    translation = carried.translation
    for start, end in _runs(np.asarray(stands.any(axis=0))):
        middle = (start + end) // 2
        frames = slice(start, end)
        held = [rotation[middle] * foot[frames] + translation[middle] for foot in feet]
        slide = np.zeros(end - start, complex)
        standing_parts = np.zeros(end - start)
        for place, mark in zip(held, stands[:, frames], strict=True):
            if mark.any():
                slide[mark] += (place[mark].mean() - place)[mark]
                standing_parts[mark] += 1
        slide /= np.maximum(standing_parts, 1)
        ankle = rotation[frames] * feet[0][frames] + translation[frames]
        angle = np.angle(rotation[middle] / rotation[frames])
        yield Stance(start, end, angle, held[0] + slide - ankle)


def _runs(marks: Mask) -> list[tuple[int, int]]:
    """List the runs [start, end) of marked frames, joined over short gaps, without short runs.

    Examples
    --------
    >>> _runs(np.array([0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1], bool))
    [(1, 6)]
    """
    edges = np.flatnonzero(np.diff(marks, prepend=False, append=False))
    runs: list[list[int]] = []
    for start, end in edges.reshape(-1, 2).tolist():
        if runs and start - runs[-1][1] <= BRIDGED:
            runs[-1][1] = end
        else:
            runs.append([start, end])
    return [(start, end) for start, end in runs if end - start >= SHORTEST]


def _between_stances(stances: Iterator[Stance], frames: int) -> tuple[Array, Points]:
    """Return the angle and the motion of an ankle in all frames, eased from stance to stance, (F,) each."""
    angle = np.zeros(frames)
    displacement = np.zeros(frames, complex)
    last: _Held | None = None
    for stance in stances:
        held = _Held(stance.start, stance.angle[0], stance.displacement[0])
        _ease(angle, displacement, last or _Held(max(0, stance.start - FADE) - 1), held)
        angle[stance.start : stance.end] = stance.angle
        displacement[stance.start : stance.end] = stance.displacement
        last = _Held(stance.end - 1, stance.angle[-1], stance.displacement[-1])
    if last:
        _ease(angle, displacement, last, _Held(last.frame + FADE + 1))
    return angle, displacement


class _Held(NamedTuple):
    """The motion of an ankle in a frame: its angle, radians, and its displacement z + ix, metres."""

    frame: int
    angle: float = 0.0
    displacement: complex = 0j


def _ease(angle: Array, displacement: Points, start: _Held, end: _Held) -> None:
    """Write a smooth step between two frames into the frames between them."""
    frames = np.arange(start.frame + 1, min(end.frame, len(angle)))
    share = (frames - start.frame) / (end.frame - start.frame)
    weight = share**2 * (3 - 2 * share)
    angle[frames] = start.angle + weight * (end.angle - start.angle)
    displacement[frames] = start.displacement + weight * (end.displacement - start.displacement)


def _posed(
    walk: Motion,
    poses: GlobalPoses,
    carried: PlanarTransform,
    limbs: Sequence[Limb],
    targets: Sequence[tuple[Array, Points]],
) -> Motion:
    """Carry the frames of a walk, lower the root where a leg is too short, and solve the legs."""
    solutions = [
        _Solution.of(poses, limb, carried, *target) for limb, target in zip(limbs, targets, strict=True)
    ]
    sinking = np.zeros(len(walk))
    for solution in solutions:
        sinking = np.maximum(sinking, solution.shortfall())
    sinking = maximum_filter1d(sinking, 2 * SINKING + 1, mode="constant")
    sinking = uniform_filter1d(sinking, 2 * SINKING + 1, mode="nearest")
    bent = carried.apply_motion(walk)
    roots = bent.root_positions - sinking[:, None] * np.array([0.0, 1.0, 0.0])
    local = bent.rotations.copy()
    for solution in solutions:
        solution.write(local, walk, sinking)
    return replace(bent, root_positions=roots, rotations=local)


class _Solution(NamedTuple):
    """A leg in the F frames of a walk that is not bent: as the body is carried, so is the whole solution.

    `wanted` are the vectors from hip to ankle that hold the foot, and `angle` the rotation of the foot.
    """

    limb: Limb
    matrices: Array
    thigh: Array
    shank: Array
    wanted: Array
    angle: Array

    @classmethod
    def of(
        cls, poses: GlobalPoses, limb: Limb, carried: PlanarTransform, angle: Array, displacement: Points
    ) -> _Solution:
        """Collect the vectors of a leg, and the vector from its hip to its target."""
        hip, knee, ankle = (poses.positions[:, joint] for joint in limb.leg[:3])
        uncarried = displacement / carried.rotation
        shift = np.stack([uncarried.imag, np.zeros(len(displacement)), uncarried.real], axis=1)
        return cls(limb, poses.matrices, knee - hip, ankle - knee, ankle - hip + shift, angle)

    def axes(self) -> Array:
        """Return the axis of the knee in each frame, (F, 3)."""
        return np.asarray(self.matrices[:, self.limb.leg.hip] @ self.limb.axis)

    def flexion(self) -> tuple[Array, Array, Array]:
        """Return s, r and φ, (F,) each: with its knee bent by φ, a leg is √(s + 2 r cos φ) long."""
        axis = self.axes()
        along = _dot(self.shank, axis)
        across = self.shank - along[:, None] * axis
        level = along * _dot(self.thigh, axis)
        size = _dot(self.thigh, self.thigh) + _dot(self.shank, self.shank) + 2 * level
        cosine = _dot(self.thigh, across)
        sine = _dot(self.thigh, np.cross(axis, across))
        return size, np.hypot(cosine, sine), -np.arctan2(sine, cosine)

    def shortfall(self) -> Array:
        """Return by how much the hip must sink for the leg to reach its target, (F,), metres."""
        size, radius, flexion = self.flexion()
        straightest = np.minimum(np.abs(flexion), STRAIGHTEST)
        longest = size + 2 * radius * np.cos(straightest)
        level = self.wanted[:, 0] ** 2 + self.wanted[:, 2] ** 2
        sinking = -self.wanted[:, 1] - np.sqrt(np.maximum(longest - level, 0.0))
        return np.clip(sinking, 0.0, DEEPEST)

    def write(self, local: Array, walk: Motion, sinking: Array) -> None:
        """Write the rotations of the hip, the knee and the ankle relative to their parents."""
        leg = self.limb.leg
        axis = self.axes()
        wanted = self.wanted + sinking[:, None] * np.array([0.0, 1.0, 0.0])
        size, radius, flexion = self.flexion()
        cosine = (_dot(wanted, wanted) - size) / (2 * np.maximum(radius, TINY))
        bend = np.arccos(np.clip(cosine, -1.0, np.cos(np.minimum(np.abs(flexion), STRAIGHTEST))))
        fold = rotations.from_rotvec((bend - flexion)[:, None] * axis)
        folded = self.thigh + rotations.rotate(fold, self.shank)
        swing = rotations.between(folded, wanted)
        sole = rotations.multiply(
            rotations.inverse(rotations.multiply(swing, fold)), rotations.about_y(self.angle)
        )
        # A rotation of the world comes on top of that of a joint, seen from the frame of its parent.
        for joint, rotation in zip(leg[:3], (swing, fold, sole), strict=True):
            parent = rotations.from_matrix(self.matrices[:, walk.skeleton.parents[joint]])
            seen = rotations.multiply(rotations.multiply(rotations.inverse(parent), rotation), parent)
            local[:, joint] = rotations.multiply(seen, walk.rotations[:, joint])


def _dot(a: Array, b: Array) -> Array:
    """Return the inner products of vectors (F, 3), shape (F,)."""
    return np.asarray(np.einsum("fc,fc->f", a, b))


def _wrapped(angle: Array) -> Array:
    """Wrap angles to [-π, π)."""
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)
