"""Feet that stay where they stand, while a character moves on: no later frame is known.

A foot that stands is held where it came down: its position on the ground, and its heading as long as its
ankle stands. When only the ball stands, the foot pivots about it, as feet do. The leg follows by inverse
kinematics. A leg that is too short for that lifts its heel, and the hips are lowered by a spring. When the
foot lifts, its offset from the clip fades by another critically damped spring, so that nothing jumps. The
positions are those of footskate cleanup [KSG02]; the spring that fades them is a game's inertialization
[Bol18]. To fade without knowing the next frames is what control needs.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.steering.characters import Pose
from mocap.steering.leg_reach import JointedLeg, PlacedLeg, knee_axis
from mocap.steering.plain_vectors import Vector, subtract
from mocap.steering.tuned import TUNED

UNCHANGED = 1e-9  # metres or radians: a foot with a smaller offset is as in its clip


def fade(offset: complex, velocity: complex, halflife: float, seconds: float) -> tuple[complex, complex]:
    """Return an offset and its velocity after some seconds in which a critically damped spring fades it.

    x(t) = (x₀ + (v₀ + y x₀) t) exp(-y t) with y = 2 ln 2 / halflife.

    Examples
    --------
    >>> offset, velocity = fade(1 + 0j, 0j, halflife=0.12, seconds=0.12)
    >>> round(offset.real, 4), round(velocity.real, 3)
    (0.5966, -4.004)
    """
    stiffness = 2 * math.log(2) / halflife
    drift = velocity + offset * stiffness
    decay = math.exp(-stiffness * seconds)
    return decay * (offset + drift * seconds), decay * (velocity - drift * stiffness * seconds)


class HeldFoot:
    """The state of one foot: how far it is from its clip, and which of its joints is held.

    `offset` is that of the ankle on the ground, z + ix in metres, and `yaw` that of the foot's heading,
    radians, with their velocities. `lift` is the angle by which the heel is lifted about the ball, radians.
    `anchor` is the joint that is held at `position`, or None.

    Parameters
    ----------
    halflife : seconds, of the spring that fades offset and yaw in the air.
    seconds : per frame.

    Examples
    --------
    An ankle comes down at 0. While it stands, the clip moves on by 1 cm, and the foot does not:

    >>> foot = HeldFoot(halflife=0.12, seconds=1 / 30)
    >>> for place in (0.0, 0.01):
    ...     foot.follow(ankle=place + 0j, toes=0.1 + 0j, ankle_stands=True, ball_stands=False)
    >>> foot.anchor, foot.offset
    ('ankle', (-0.01+0j))
    """

    def __init__(self, halflife: float, seconds: float) -> None:
        self.halflife = halflife
        self.seconds = seconds
        self.offset = self.offset_velocity = 0j
        self.yaw = self.yaw_velocity = 0.0
        self.lift = self.lift_velocity = 0.0
        self.anchor: str | None = None
        self.position = 0j  # of the anchor
        self.heading = 0.0  # of a foot whose ankle is held, radians
        self.shown: dict[str, complex] = {}  # positions of the joints that stood in the previous frame

    def follow(self, ankle: complex, toes: complex, *, ankle_stands: bool, ball_stands: bool) -> None:
        """Take the next frame of the clip, and hold the foot or let its offset fade.

        Parameters
        ----------
        ankle : its position on the ground in the clip, z + ix.
        toes : the vector from there to the ball.
        ankle_stands, ball_stands : the contacts.
        """
        offset = self.offset
        yaw = self.yaw
        anchor = "ankle" if ankle_stands else "ball" if ball_stands else None
        if anchor != self.anchor:
            self._change_anchor(anchor, ankle, toes, ball_stands=ball_stands)
        if anchor == "ankle":
            self.yaw = math.remainder(self.heading - cmath.phase(toes), 2 * math.pi)
            self.offset = self.position - ankle
        else:
            self.yaw, self.yaw_velocity = map(_real, self._faded(self.yaw, self.yaw_velocity))
            if anchor == "ball":
                self.offset = self.position - ankle - toes * cmath.exp(1j * self.yaw)
            else:
                self.offset, self.offset_velocity = self._faded(self.offset, self.offset_velocity)
        if anchor is not None:
            self.offset_velocity = (self.offset - offset) / self.seconds
        if anchor == "ankle":
            self.yaw_velocity = math.remainder(self.yaw - yaw, 2 * math.pi) / self.seconds
        positions = self._positions(ankle, toes)
        stands = {"ankle": ankle_stands, "ball": ball_stands}
        self.shown = {joint: place for joint, place in positions.items() if stands[joint]}

    def lift_heel(self, needed: float) -> None:
        """Lift the heel as far as needed, radians, or lower it by its spring if that is slower."""
        lift = self.lift
        faded, velocity = fade(lift, self.lift_velocity, TUNED.heel_halflife, self.seconds)
        self.lift = max(needed, faded.real)
        self.lift_velocity = velocity.real if self.lift > needed else (needed - lift) / self.seconds

    def _positions(self, ankle: complex, toes: complex) -> dict[str, complex]:
        """Return the positions of ankle and ball with the offset."""
        shown = ankle + self.offset
        return {"ankle": shown, "ball": shown + toes * cmath.exp(1j * self.yaw)}

    def _change_anchor(self, anchor: str | None, ankle: complex, toes: complex, *, ball_stands: bool) -> None:
        """Hold another joint: where it stood in the previous frame, or where it comes down now.

        A ball that stands stays also in the frame in which its ankle comes down.
        """
        if self.anchor == "ball" and ball_stands:
            self.offset = self.position - ankle - toes * cmath.exp(1j * self.yaw)
        if anchor is not None:
            self.position = self.shown.get(anchor, self._positions(ankle, toes)[anchor])
            self.heading = cmath.phase(toes) + self.yaw
        self.anchor = anchor

    def _faded(self, offset: complex, velocity: complex) -> tuple[complex, complex]:
        return fade(offset, velocity, self.halflife, self.seconds)


def _real(number: complex) -> float:
    return number.real


class HeldFeet:
    """Holds the feet of a character where they stand, one pose after the other.

    Parameters
    ----------
    clip : a motion of the character's skeleton and frame rate, which shows how its knees bend.
    halflife : seconds, of the spring by which the offset of a foot in the air fades.

    Raises
    ------
    MocapError : for legs that are not found, and a half-life that is not positive.

    Examples
    --------
    The body moves aside by 2 cm. The left foot, which stands, stays:

    >>> import numpy as np
    >>> from mocap.datasets.samples import sample
    >>> clip = sample("walk_straight")
    >>> feet = HeldFeet(clip)
    >>> stands = {"lfoot": True, "ltoes": True, "rfoot": False, "rtoes": False}
    >>> pose = Pose(clip.root_positions[0], clip.rotations[0], blending=False, contacts=stands)
    >>> moved = pose._replace(root_position=pose.root_position + np.array([0.02, 0, 0]))
    >>> shown = [feet.hold(pose) for pose in (pose, moved)]
    >>> [(round(foot.offset.imag, 6), foot.anchor) for foot in feet.feet]
    [(-0.02, 'ankle'), (0.0, None)]
    """

    def __init__(self, clip: Motion, *, halflife: float = TUNED.foot_halflife) -> None:
        if not 0 < halflife < math.inf:
            raise MocapError(
                f"The half-life of a foot's offset is a positive number of seconds, got {halflife}."
            )
        self.names = clip.skeleton.names
        legs = find_legs(clip.skeleton)
        self.legs = [JointedLeg(clip.skeleton, leg, knee_axis(clip, leg)) for leg in legs]
        self.lowered = 0.0  # metres, of the hips
        self.lowering = 0.0  # metres per second
        self.feet = [HeldFoot(halflife, 1 / clip.fps) for _ in legs]

    def hold(self, pose: Pose) -> Pose:
        """Return the next pose with its standing feet held: the legs bend, and the hips are lowered."""
        placed_legs = [jointed.place(pose.root_position, pose.rotations) for jointed in self.legs]
        for jointed, foot, placed in zip(self.legs, self.feet, placed_legs, strict=True):
            self._follow(jointed, foot, placed, pose)
        self._lower(placed_legs)
        rotations = pose.rotations.copy()
        for jointed, foot, placed in zip(self.legs, self.feet, placed_legs, strict=True):
            offset = (foot.offset.imag, self.lowered, foot.offset.real)  # seen from the lowered hip
            can_lift = "ball" in foot.shown or (foot.anchor is None and jointed.trails(placed, offset))
            foot.lift_heel(jointed.heel_lift(placed, offset, foot.yaw) if can_lift else 0.0)
            if max(abs(foot.offset), abs(foot.yaw), foot.lift, self.lowered) > UNCHANGED:
                for joint, rotation in jointed.bend(placed, offset, foot.yaw, foot.lift).items():
                    rotations[joint] = rotation
        root_position = pose.root_position - np.array([0.0, self.lowered, 0.0])
        return pose._replace(root_position=root_position, rotations=rotations)

    def _follow(self, jointed: JointedLeg, foot: HeldFoot, placed: PlacedLeg, pose: Pose) -> None:
        """Advance a foot to the next frame of its clip."""
        leg = jointed.leg
        ankle = placed.positions[leg.ankle]
        toes = subtract(placed.positions[leg.ball], ankle) if leg.has_ball else jointed.forward(placed)
        ankle_stands = pose.contacts.get(self.names[leg.ankle], False)
        ball_stands = pose.contacts.get(self.names[leg.ball], False)
        foot.follow(ground(ankle), ground(toes), ankle_stands=ankle_stands, ball_stands=ball_stands)

    def _lower(self, placed_legs: list[PlacedLeg]) -> None:
        """Lower the hips by their spring, towards where both legs reach their targets."""
        needed = 0.0
        for jointed, foot, placed in zip(self.legs, self.feet, placed_legs, strict=True):
            offset = (foot.offset.imag, 0.0, foot.offset.real)
            needed = max(needed, jointed.shortfall(placed, offset))
        goal = min(needed, TUNED.lowest_hips)
        seconds = self.feet[0].seconds
        missing, velocity = fade(self.lowered - goal, self.lowering, TUNED.hip_halflife, seconds)
        self.lowered = goal + missing.real
        self.lowering = velocity.real

    def twists(self) -> list[float]:
        """Return by how much each foot whose ankle stands is turned from its clip, radians."""
        return [foot.yaw for foot in self.feet if foot.anchor == "ankle"]


def ground(vector: Vector) -> complex:
    """Return a vector on the ground, z + ix.

    Examples
    --------
    >>> ground((1.0, 2.0, 3.0))
    (3+1j)
    """
    return complex(vector[2], vector[0])
