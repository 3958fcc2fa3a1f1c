"""Inverse kinematics of a leg in closed form, in plain numbers: two legs in one frame are too few for arrays.

A leg is two bones with a hinge between them, the knee. The knee's flexion sets the distance from hip to
ankle, and a rotation at the hip then points the leg at its target [TGB00]. All bones keep their lengths.
A target beyond the leg's reach is brought within it as people do: by a heel that lifts, while the ball of
the foot stays, or by a lower hip. Lengths are in metres.
"""

from __future__ import annotations

import math

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import forward_kinematics, hinge_of
from mocap.body.legs import Leg
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.steering.plain_vectors import (
    UP,
    Quaternion,
    Vector,
    add,
    axis_rotation,
    conjugate,
    cross,
    dot,
    length,
    multiply,
    rotate,
    shortest_arc,
    subtract,
)
from mocap.steering.tuned import TUNED

CLIP_FRAMES = 3000  # frames of a clip that show how its knees bend


def hinge_angle(axis: Vector, base: Vector, segment: Vector, distance: float) -> float:
    """Return the angle of a hinge that brings the end of a segment to a distance from a point.

    A rotation by δ about the axis n turns the segment s, and |b - R s| = d for a point b, both seen from the
    hinge, where

        P cos δ + Q sin δ = C,    P = b·s - (b·n)(s·n),    Q = b·(n × s),
        C = (|b|² + |s|² - d²) / 2 - (b·n)(s·n).

    Its two solutions are atan2(Q, P) ∓ arccos(C / √(P² + Q²)). The first one is flexed in the positive
    direction of the axis.

    Parameters
    ----------
    axis : unit vector.
    base : from the hinge to the point, from the knee to the hip.
    segment : from the hinge to its end, from the knee to the ankle.
    distance : metres; one out of reach is replaced by the nearest one within it.

    Returns
    -------
    Radians, in [-π, π].

    Examples
    --------
    A straight leg of two bones of 1 m flexes by 90° to bring its ends within √2 m:

    >>> angle = hinge_angle((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), math.sqrt(2))
    >>> round(math.degrees(angle), 6)
    90.0
    """
    along = dot(base, axis) * dot(segment, axis)
    cosine_part = dot(base, segment) - along
    sine_part = dot(base, cross(axis, segment))
    needed = (dot(base, base) + dot(segment, segment) - distance * distance) / 2 - along
    largest = math.hypot(cosine_part, sine_part)
    cosine = max(-1.0, min(1.0, needed / largest)) if largest else 1.0
    angle = math.atan2(sine_part, cosine_part) - math.acos(cosine)
    return math.remainder(angle, 2 * math.pi)


def soft_reach(target: float, unchanged: float, length: float) -> float:
    """Limit the distance of an ankle from its hip softly, so that a knee does not snap straight.

    Up to s, the larger of 97 % of the leg's length and the distance in the clip, a distance stays as it is.
    Beyond, it approaches e, 99.9 % of the length:  e - (e - s) exp(-(d - s) / (e - s)).

    Parameters
    ----------
    target, unchanged : distances of the target and of the ankle in the clip, metres.
    length : of the straight leg, metres.

    Examples
    --------
    >>> [round(soft_reach(target, 0.9, 1.0), 4) for target in (0.95, 0.98, 1.0, 1.2)]
    [0.95, 0.9785, 0.9887, 0.999]
    """
    start = max(TUNED.soft_reach * length, unchanged)
    room = TUNED.longest_reach * length - start
    if target <= start:
        return target
    return start + room * -math.expm1((start - target) / room) if room > 0 else start


def knee_axis(motion: Motion, leg: Leg) -> Vector:
    """Find the axis of a knee in its joint's frame; a positive rotation about it flexes the knee.

    It is the hinge of the clip. A knee that is no hinge in its file has the mean of shank × thigh, which is
    perpendicular to both and weighs a frame by the sine of its flexion.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> [round(number, 3) for number in knee_axis(sample("walk_straight"), Leg(2, 3, 4, 5))]
    [1.0, 0.0, 0.0]
    """
    clip = motion[:CLIP_FRAMES]
    positions, matrices = forward_kinematics(clip)
    shank = positions[:, leg.ankle] - positions[:, leg.knee]
    thigh = positions[:, leg.hip] - positions[:, leg.knee]
    normals = np.einsum("fba,fb->fa", matrices[:, leg.knee], np.cross(shank, thigh))
    mean: Array = normals.mean(axis=0)
    hinge = hinge_of(clip, leg.knee)
    axis = mean if hinge is None else hinge * np.sign(hinge @ mean)
    x, y, z = (axis / np.linalg.norm(axis)).tolist()
    return x, y, z


class PlacedLeg(NamedTuple):
    """The global positions and rotations of the joints from the root to a ball, by the joint's index."""

    positions: dict[int, Vector]
    rotations: dict[int, Quaternion]


class JointedLeg:
    """A leg of a skeleton, with the axis of its knee, that can be placed and bent in one frame.

    Parameters
    ----------
    skeleton : J joints.
    leg : of this skeleton.
    axis : the knee's, as from `knee_axis`.

    Examples
    --------
    The left ankle of the rest pose is moved ahead by 5 cm, for which the hip and the knee bend:

    >>> from mocap.datasets.samples import SKELETON
    >>> leg = JointedLeg(SKELETON, Leg(2, 3, 4, 5), (1.0, 0.0, 0.0))
    >>> rest = np.tile([1.0, 0, 0, 0], (38, 1))
    >>> placed = leg.place(np.array([0.0, 1, 0]), rest)
    >>> for joint, rotation in leg.bend(placed, (0.0, 0.02, 0.05), 0.0).items():
    ...     rest[joint] = rotation
    >>> moved = leg.place(np.array([0.0, 1, 0]), rest)
    >>> np.subtract(moved.positions[4], placed.positions[4]).round(6) + 0.0
    array([0.  , 0.02, 0.05])
    """

    def __init__(self, skeleton: Skeleton, leg: Leg, axis: Vector) -> None:
        self.leg = leg
        self.axis = axis
        self.length = float(leg.lengths(skeleton)[:2].sum())
        self.path = skeleton.path_to_root(leg.ball)[::-1]
        self.parents = {joint: int(skeleton.parents[joint]) for joint in self.path[1:]}
        self.offsets = {joint: _vector(skeleton.offsets[joint]) for joint in self.path[1:]}

    def place(self, root: Array, rotations: Array) -> PlacedLeg:
        """Compute the joints' positions and rotations, from the root's position (3,) and rotations (J, 4)."""
        local = rotations[self.path].tolist()
        positions = {0: _vector(root)}
        placed: dict[int, Quaternion] = {0: tuple(local[0])}
        for joint, rotation in zip(self.path[1:], local[1:], strict=True):
            parent = self.parents[joint]
            positions[joint] = add(positions[parent], rotate(placed[parent], self.offsets[joint]))
            placed[joint] = multiply(placed[parent], rotation)
        return PlacedLeg(positions, placed)

    def forward(self, placed: PlacedLeg) -> Vector:
        """Return the direction in which the knee points: perpendicular to its axis and the vertical."""
        return cross(rotate(placed.rotations[self.leg.knee], self.axis), UP)

    def shortfall(self, placed: PlacedLeg, offset: Vector) -> float:
        """Return by how much the hip must be lower, so that the ankle reaches a target; metres.

        The target counts as reached where `soft_reach` leaves it as it is. A target so far aside that no
        lower hip brings it within reach is measured from its height.

        Parameters
        ----------
        placed : the leg as it is.
        offset : of the target from the ankle, metres.
        """
        hip, _, ankle, _ = self.leg
        start = subtract(placed.positions[ankle], placed.positions[hip])
        x, y, z = add(start, offset)
        reach = max(TUNED.soft_reach * self.length, length(start))
        aside = x * x + z * z
        if aside + y * y <= reach * reach:
            return 0.0
        return max(0.0, -y - math.sqrt(max(0.0, reach * reach - aside)))

    def heel_lift(self, placed: PlacedLeg, offset: Vector, yaw: float) -> float:
        """Return by which angle the heel must lift, so that the ball of the foot stays where it is; radians.

        The foot pivots about its ball until its ankle is as near to the hip as `soft_reach` allows. A foot
        ahead of the hip does not: to lift its heel would not bring its ankle nearer. Without a ball, 0.

        Parameters
        ----------
        placed : the leg as it is.
        offset : of the target from the ankle, metres.
        yaw : of the foot, radians about the vertical.
        """
        hip, _, ankle, _ = self.leg
        start = subtract(placed.positions[ankle], placed.positions[hip])
        target = add(start, offset)
        distance = length(target)
        reach = soft_reach(distance, length(start), self.length)
        if reach >= distance or not self.leg.has_ball:
            return 0.0
        foot = self._foot(placed, yaw)
        x, y, z = foot
        lift = hinge_angle(_lateral(foot), add(target, foot), foot, reach)
        slope = math.atan2(-y, math.hypot(x, z))
        return max(0.0, min(lift, TUNED.steepest_foot - slope))

    def trails(self, placed: PlacedLeg, offset: Vector) -> bool:
        """Return whether the target of the ankle is behind the hip, seen in the direction of the foot."""
        hip, _, ankle, _ = self.leg
        x, _, z = add(subtract(placed.positions[ankle], placed.positions[hip]), offset)
        toes_x, _, toes_z = self._foot(placed, 0.0)
        return x * toes_x + z * toes_z < 0

    def _foot(self, placed: PlacedLeg, yaw: float) -> Vector:
        """Return the vector from the ankle to the ball of a foot that is turned by a yaw."""
        _, _, ankle, ball = self.leg
        foot = subtract(placed.positions[ball], placed.positions[ankle])
        return rotate(axis_rotation(UP, yaw), foot)

    def bend(self, placed: PlacedLeg, offset: Vector, yaw: float, lift: float = 0.0) -> dict[int, Quaternion]:
        """Move the ankle by an offset, turn knee and foot by a yaw, lift the heel; return local rotations.

        The knee flexes by F about its axis to the distance of the target. The leg turns by the yaw Y about
        the vertical, as a hip does above a foot that stands, and swings by the shortest arc S to its target.
        The foot is lifted by L about its ball, and its toes stay as they are. With the global rotations G of
        joints and their parents P, the local rotations are P⁻¹ S Y G of the hip, P⁻¹ F G of the knee,
        (S Y F P)⁻¹ L Y G of the ankle, and (L Y P)⁻¹ Y G of the ball.

        Parameters
        ----------
        placed : the leg as it is.
        offset : metres. A target that is too far is approached, see `soft_reach`.
        yaw : radians about the vertical.
        lift : of the heel, radians about the ball.
        """
        hip, knee, ankle, ball = self.leg
        positions, rotations = placed
        thigh = subtract(positions[hip], positions[knee])
        shank = subtract(positions[ankle], positions[knee])
        foot = self._foot(placed, yaw)
        raised = axis_rotation(_lateral(foot), lift)
        towards_ball = subtract(foot, rotate(raised, foot))
        target = add(add(subtract(shank, thigh), offset), towards_ball)  # from the hip
        turn = axis_rotation(UP, yaw)
        foot_rotation = multiply(raised, turn)
        distance = soft_reach(length(target), length(subtract(shank, thigh)), self.length)
        axis = rotate(rotations[knee], self.axis)
        flexion = axis_rotation(axis, hinge_angle(axis, thigh, shank, distance))
        turned = rotate(turn, subtract(rotate(flexion, shank), thigh))
        leg_rotation = multiply(shortest_arc(turned, target), turn)
        above_hip, above_knee, above_ankle = (rotations[self.parents[joint]] for joint in (hip, knee, ankle))
        new_thigh = multiply(leg_rotation, rotations[hip])
        new_shank = multiply(flexion, rotations[knee])
        new_foot = multiply(foot_rotation, rotations[ankle])
        new_above_ankle = multiply(leg_rotation, multiply(flexion, above_ankle))
        bent = {
            hip: multiply(conjugate(above_hip), new_thigh),
            knee: multiply(conjugate(above_knee), new_shank),
            ankle: multiply(conjugate(new_above_ankle), new_foot),
        }
        if lift:
            new_above_ball = multiply(foot_rotation, rotations[self.parents[ball]])
            bent[ball] = multiply(conjugate(new_above_ball), multiply(turn, rotations[ball]))
        return bent


def _lateral(foot: Vector) -> Vector:
    """Return the horizontal axis across a foot, about which a positive rotation lifts its heel."""
    x, _, z = foot
    ahead = math.hypot(x, z)
    return (z / ahead, 0.0, -x / ahead) if ahead else (1.0, 0.0, 0.0)


def _vector(values: Array) -> Vector:
    x, y, z = values.tolist()
    return x, y, z
