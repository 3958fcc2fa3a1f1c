"""Stances: bodies that stand upright, which can be compared whatever their rest poses are.

The rest pose of a file may be of any kind: arms out, arms down, or all bones along one line. Therefore two
bodies are compared in their stances: feet flat, heading +z.
"""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import dataclass
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses, forward_kinematics
from mocap.body.legs import Leg, heading_by_hips
from mocap.body.limbs import FEET, SIDES, find_legs, roles, with_roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.foot_heights import heights_of_body, is_pose
from mocap.editing.pins import with_plants
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, shortened, warn


@dataclass(frozen=True, eq=False, repr=False)
class Stance:
    """A pose in which a skeleton stands upright on flat feet, heading +z.

    Parameters
    ----------
    skeleton : J joints.
    roles : {role: joint}, from `roles`.
    turns : shape (J, 4), quaternions: the global rotations of the joints.
    heights : {role: metres} of both ankles and balls above the floor.

    Raises
    ------
    MocapError : for heights that are impossible with the length of the feet.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stance = stance_of(sample("walk_straight"))
    >>> stance, round(stance.heights["left ankle"], 2)
    (Stance(38 joints, legs 0.86 m), 0.07)
    """

    skeleton: Skeleton
    roles: Mapping[str, int]
    turns: Array
    heights: Mapping[str, float]

    def __post_init__(self) -> None:
        for side, leg in zip(SIDES, self.legs, strict=True):
            length = leg.lengths(self.skeleton)[2]
            if leg.has_ball and not abs(self.drop(side)) < length:
                height = f"The {side} ankle would stand {100 * self.drop(side):.3g} cm over its ball"
                raise MocapError(f"{height}; the foot is {100 * length:.3g} cm long.")

    def __repr__(self) -> str:
        return f"Stance({len(self.skeleton)} joints, legs {self.leg:.2f} m)"

    @cached_property
    def points(self) -> Array:
        """Positions of the joints relative to joint 0, shape (J, 3), metres."""
        points = np.zeros((len(self.skeleton), 3))
        for joint, parent in enumerate(self.skeleton.parents[1:], start=1):
            bone = rotations.rotate(self.turns[parent], self.skeleton.offsets[joint])
            points[joint] = points[parent] + bone
        return points

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The left and the right leg."""
        return find_legs(self.skeleton)

    @property
    def leg(self) -> float:
        """Length of a leg from hip to ankle, the mean of both, metres."""
        return float(np.mean([leg.lengths(self.skeleton)[:2].sum() for leg in self.legs]))

    def height(self, part: str) -> float:
        """Return the mean height of both ankles ("ankle") or both balls ("ball"), metres."""
        return (self.heights[f"left {part}"] + self.heights[f"right {part}"]) / 2

    def drop(self, side: str) -> float:
        """Return the height of an ankle above the ball of its flat foot, metres."""
        return self.heights[f"{side} ankle"] - self.heights[f"{side} ball"]

    def bone(self, start: str, end: str) -> Array:
        """Return the vector from the joint of one role to that of another, (3,), metres."""
        return np.asarray(self.points[self.roles[end]] - self.points[self.roles[start]])


def stance_of(motion: Motion, *, mean: bool = False, clips: Iterable[Motion] = ()) -> Stance:
    """Find the stance of a motion's skeleton: its rest pose if that stands, or else a mean over the motion.

    A motion of one or two frames, or less than 0.1 s, is a pose. It is the stance, if it stands.

    The mean does not depend on the rest pose. The method is ours: the mean rotation of each joint relative to
    the heading of the body, which is perpendicular to the line through the hips. The rotation of a foot is
    the mean over frames in which it is flat, relative to its own direction. The mean of rotations is SciPy's,
    which does not depend on the signs of quaternions.

    Parameters
    ----------
    motion : a walk, for a skeleton whose rest pose does not stand; heights are always those of its feet. Its
        footplants are marked if they are not yet.
    mean : whether to take the mean even if the rest pose stands.
    clips : other motions of the same body. They are read one by one if an ankle or a ball of `motion` never
        stands, as in a run, and the first with standing feet gives the heights.

    Raises
    ------
    MocapError : for a motion in which no ball ever stands, and a pose that does not stand.

    Warns
    -----
    MocapWarning : for ankles whose height is estimated while the balls stand, and for a pose far off the
        floor at y = 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stance_of(sample("walk_straight")).turns[0]
    array([1., 0., 0., 0.])

    Notebook: 13-retargeting
    """
    motion = with_roles(motion)
    if is_pose(motion):
        return stance_of_pose(motion)
    joints = roles(motion.skeleton)
    legs = find_legs(motion.skeleton)
    motion = with_plants(motion, legs)
    heights = heights_of_body(motion, joints, clips)
    if not mean:
        with suppress(MocapError):
            return stance_of_zero(motion.skeleton, heights)
    poses = forward_kinematics(motion)
    turns = _mean_rotations(poses, legs)
    for leg in legs:
        foot = [leg.ankle, leg.ball]
        flat = np.logical_and(*(motion.contacts[motion.skeleton.names[joint]] for joint in foot))
        if flat.any() and leg.has_ball:
            bones = (poses.positions[:, leg.ball] - poses.positions[:, leg.ankle])[flat]
            headings = np.arctan2(bones[:, 0], bones[:, 2])
            flat_rotations = np.swapaxes(rotations.from_matrix(poses.matrices[:, foot][flat]), 0, 1)
            turns[foot] = rotations.mean(rotations.multiply(rotations.about_y(-headings), flat_rotations))
    return Stance(motion.skeleton, joints, turns, heights)


def _mean_rotations(poses: GlobalPoses, legs: Sequence[Leg]) -> Array:
    """Compute the mean global rotations of joints relative to the heading by the hips, (J, 4)."""
    world = np.swapaxes(rotations.from_matrix(poses.matrices), 0, 1)  # (J, F, 4)
    headings = heading_by_hips(poses.positions, legs)
    return rotations.mean(rotations.multiply(rotations.about_y(-headings), world))


def stance_of_pose(motion: Motion) -> Stance:
    """Return a pose as a stance: the mean of few frames in which a body stands, such as a T-pose.

    Its heading becomes +z. Feet keep their rotation relative to it, and their heights over the floor, y = 0.

    Parameters
    ----------
    motion : one frame, or a few.

    Raises
    ------
    MocapError : for a pose that does not stand: hips that are not level, thighs that do not hang, or one foot
        higher than, or ahead of, the other.

    Warns
    -----
    MocapWarning : for a pose far from the floor. Its lowest joint is then assumed to be on the floor.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> standing = replace(walk[:1], rotations=np.tile([1.0, 0, 0, 0], (1, 38, 1)))
    >>> round(stance_of_pose(standing).height("ankle"), 3)
    0.028
    """
    motion = with_roles(motion)
    skeleton = motion.skeleton
    poses = forward_kinematics(motion)
    heights = poses.positions[..., 1].mean(axis=0)
    joints = roles(skeleton)
    of_feet = {role: float(heights[joints[role]]) for role in FEET}
    stance = Stance(skeleton, joints, _mean_rotations(poses, find_legs(skeleton)), of_feet)
    fault = _tilt_of(stance) or _step_of(stance)
    if fault:
        raise MocapError(f"The pose in '{shortened(motion.name)}' does not stand: {fault}.")
    lowest = float(heights.min())
    if not -TUNED.pose_below <= lowest / stance.leg <= TUNED.pose_above:
        place = f"is {abs(lowest):.2f} m {'below' if lowest < 0 else 'above'} y = 0"
        warn(f"'{shortened(motion.name)}': the lowest joint {place}, and is taken to be on the floor.")
        stance = replace(stance, heights={role: height - lowest for role, height in stance.heights.items()})
    return stance


def _tilt_of(stance: Stance) -> str:
    """Describe the angles of hips and thighs of a stance that is not upright; "" if it is."""
    level = _degrees(stance.bone("right hip", "left hip"), [1, 0, 0])
    hanging = max(_degrees(stance.bone(f"{side} hip", f"{side} knee"), [0, -1, 0]) for side in SIDES)
    if level > TUNED.hips_level or hanging > TUNED.thighs_hanging:
        return f"its hips are {level:.0f}° off level, its thighs {hanging:.0f}° off hanging"
    return ""


def _step_of(stance: Stance) -> str:
    """Describe the distances between the ankles of a stance that is part of a step; "" if it is none."""
    _, rise, lead = np.abs(stance.bone("right ankle", "left ankle")) / stance.leg
    if rise > TUNED.ankle_rise or lead > TUNED.ankle_lead:
        height, distance = 100 * stance.leg * np.array([rise, lead])
        return f"one ankle is {height:.0f} cm higher and {distance:.0f} cm further ahead than the other"
    return ""


def stance_of_zero(skeleton: Skeleton, heights: Mapping[str, float] | float) -> Stance:
    """Return the rest pose of a skeleton, all rotations zero, as a stance with flat feet.

    A foot that points down at rest, by more than 45°, is rotated straight ahead.

    Parameters
    ----------
    skeleton : its rest pose must stand upright and head +z.
    heights : metres above the floor by role, as from `standing_heights`; or one number for both balls, with
        the ankles as far above as in the rest pose.

    Raises
    ------
    MocapError : for a rest pose that does not stand: hips that are not level with the left one at +x, or
        thighs that do not hang. Such files need `stance_of` a clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> stance = stance_of_zero(walk.skeleton, 0.026)
    >>> stance.points[walk.skeleton.index("lfoot")].round(2)
    array([ 0.09, -0.94,  0.04])
    """
    turns = np.tile(rotations.IDENTITY, (len(skeleton), 1))
    rest = Stance(skeleton, roles(skeleton), turns, dict.fromkeys(FEET, 0.0))
    fault = _tilt_of(rest)
    if fault:
        raise MocapError(f"The rest pose of {skeleton!r} does not stand: {fault}; give stance_of a walk.")
    bones = {side: rest.bone(f"{side} ankle", f"{side} ball") for side in SIDES}
    if not isinstance(heights, Mapping):
        of_ankles = {f"{side} ankle": heights - bone[1] for side, bone in bones.items()}
        heights = {role: of_ankles.get(role, heights) for role in FEET}
    stance = replace(rest, heights=heights)
    for (side, bone), leg in zip(bones.items(), stance.legs, strict=True):
        if leg.has_ball:
            foot = [joint for joint in range(len(turns)) if leg.ankle in skeleton.path_to_root(joint)]
            turns[foot] = rotations.between(bone, _flat_bone(bone, stance.drop(side)))
    return replace(stance, turns=turns)


def _flat_bone(bone: Array, drop: float) -> Array:
    """Rotate the bone from an ankle to a ball (3,) until the ball is `drop` metres lower than the ankle."""
    level = bone[[0, 2]]
    is_upright = np.hypot(*level) <= abs(bone[1])
    ahead = np.array([0.0, 1.0]) if is_upright else level
    ahead = ahead / np.hypot(*ahead) * np.sqrt(bone @ bone - drop**2)
    return np.array([ahead[0], -drop, ahead[1]])


def _degrees(vector: Array, axis: list[int]) -> float:
    """Compute the angle between a vector and an axis, degrees."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(vector, axis)), np.dot(vector, axis))))
