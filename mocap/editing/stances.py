"""How a body stands upright: what two bodies have in common, whatever their rest poses are.

A rest pose says little. Some files rest with the arms out, some with the arms down, and in some all bones lie
along one line. So two bodies are compared as they stand: feet flat, heading +z.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.quantities import described
from mocap._shared.records import dataclass
from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.limbs import FEET, SIDES, Leg, find_legs, heading_by_hips, roles, with_roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.pins import with_plants
from mocap.errors import MocapError, shortened, warn

# Degrees. A rest pose stands where the hips are level and the thighs hang, within these. The files at hand
# keep to 0 and 20 (CMU), 0 and 1 (others), or are 90 and 90 off: their rest poses are no stances.
LEVEL = 30.0  # degrees
HANGING = 45.0  # degrees

# A clip that is no longer is a pose: in it, feet that stand cannot be told from feet that swing.
FRAMES_OF_A_POSE = 2
SECONDS_OF_A_POSE = 0.1

# Of the leg's length. In a pose that stands, the ankles differ in height and along the heading by no more. In
# a step they do: where the legs pass each other one foot is raised, and where both stand one is ahead.
RAISED = 0.05
AHEAD = 0.25

# Of the leg's length: from a floor at y = 0 the lowest joint of a pose is no farther. Else the pose is
# relative to its root, and its lowest joint is taken to be on the floor.
UNDER_FLOOR = 0.05
OVER_FLOOR = 0.2

# Percent of the heights of an ankle over its ball while the ball stands, for an ankle that never stands. The
# 10th and the 50th of captured clips are 1 cm below and above the height of an ankle that stands.
OF_RUNS = 25


@dataclass(frozen=True, eq=False, repr=False)
class Stance:
    """How a skeleton stands upright on its flat feet, heading +z.

    Parameters
    ----------
    skeleton : J joints.
    roles : {role: joint}, from `roles`.
    turns : shape (J, 4), quaternions: how each joint is turned in the world.
    heights : {role: metres} of both ankles and balls over the floor.

    Raises
    ------
    MocapError : for heights that no foot of this length has.

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
        """Where the joints are in this stance, seen from joint 0, shape (J, 3), metres."""
        points = np.zeros((len(self.skeleton), 3))
        for joint, above in enumerate(self.skeleton.parents[1:], start=1):
            points[joint] = points[above] + rotations.rotate(self.turns[above], self.skeleton.offsets[joint])
        return points

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The left and the right leg."""
        return find_legs(self.skeleton)

    @property
    def leg(self) -> float:
        """How long a leg is from hip to ankle, the mean of both, metres."""
        return float(np.mean([leg.lengths(self.skeleton)[:2].sum() for leg in self.legs]))

    def height(self, part: str) -> float:
        """Give the mean height of both ankles ("ankle"), or both balls ("ball"), over the floor, metres."""
        return (self.heights[f"left {part}"] + self.heights[f"right {part}"]) / 2

    def drop(self, side: str) -> float:
        """Give how far the ball of a side is below its ankle on a flat foot, metres."""
        return self.heights[f"{side} ankle"] - self.heights[f"{side} ball"]

    def bone(self, start: str, end: str) -> Array:
        """Give the way from one role's joint to another's, (3,), metres."""
        return np.asarray(self.points[self.roles[end]] - self.points[self.roles[start]])


def stance_of(motion: Motion, *, mean: bool = False, clips: Iterable[Motion] = ()) -> Stance:
    """Take the stance of a motion's skeleton: its rest pose where that stands, else the mean over the motion.

    A motion of one or two frames, or less than 0.1 s, is a pose. It is the stance, if it stands.

    The mean needs no rest pose that means anything. The idea is ours: each joint's mean turn against the
    body's heading, which is square to the hips' line; a foot's own, while it stands flat, against where it
    points. The mean of rotations is SciPy's, which does not depend on the signs of their quaternions.

    Parameters
    ----------
    motion : a walk, where the rest pose means nothing; its feet give the heights in any case. Its plants are
        marked if they are not yet.
    mean : take the mean, even where the rest pose stands.
    clips : other motions of the same body. They are read one by one if an ankle or a ball of `motion` never
        stands, as in a run, and the first with feet that stand gives the heights.

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
    heights = _heights_of_body(motion, joints, clips)
    if not mean:
        with suppress(MocapError):
            return stance_of_zero(motion.skeleton, heights)
    pose = forward_kinematics(motion)
    world = np.swapaxes(rotations.from_matrix(pose.matrices), 0, 1)  # (J, F, 4)
    heading = heading_by_hips(pose.positions, legs)
    turns = rotations.mean(rotations.multiply(rotations.about_y(-heading), world))
    for leg in legs:
        foot = [leg.ankle, leg.ball]
        flat = np.logical_and(*(motion.contacts[motion.skeleton.names[joint]] for joint in foot))
        if flat.any() and leg.has_ball:
            along = (pose.positions[:, leg.ball] - pose.positions[:, leg.ankle])[flat]
            back = rotations.about_y(-np.arctan2(along[:, 0], along[:, 2]))
            turns[foot] = rotations.mean(rotations.multiply(back, world[foot][:, flat]))
    return Stance(motion.skeleton, joints, turns, heights)


def _heights_of_body(motion: Motion, joints: Mapping[str, int], clips: Iterable[Motion]) -> dict[str, float]:
    """Measure the heights of standing feet in a motion, or else in clips of its body, or else of balls."""
    try:
        return standing_heights(motion, joints)
    except MocapError as error:
        for clip in clips:
            if clip.skeleton == motion.skeleton and not is_pose(clip):
                with suppress(MocapError):
                    return standing_heights(with_plants(clip), joints)
        heights = heights_from_balls(motion, joints)
        warn(f"{error} Heights are estimated from the balls alone.")
        return heights


def is_pose(motion: Motion) -> bool:
    """Return whether a motion is too short to tell feet that stand from feet that swing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> is_pose(walk[:2]), is_pose(walk[:13])
    (True, False)
    """
    return len(motion) <= FRAMES_OF_A_POSE or motion.duration < SECONDS_OF_A_POSE


def stance_of_pose(motion: Motion) -> Stance:
    """Take a pose as the stance: the mean of few frames in which a body stands, such as a T-pose.

    Its heading becomes +z. Feet keep their rotation against it, and their heights over the floor at y = 0.

    Parameters
    ----------
    motion : one frame, or a few.

    Raises
    ------
    MocapError : for a pose that does not stand: hips that are not level, thighs that do not hang, or one foot
        higher than, or ahead of, the other.

    Warns
    -----
    MocapWarning : for a pose far from the floor, as its lowest joint is then taken to be on the floor.

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
    pose = forward_kinematics(motion)
    world = np.swapaxes(rotations.from_matrix(pose.matrices), 0, 1)  # (J, F, 4)
    heading = heading_by_hips(pose.positions, find_legs(skeleton))
    turns = rotations.mean(rotations.multiply(rotations.about_y(-heading), world))
    heights = pose.positions[..., 1].mean(axis=0)
    joints = roles(skeleton)
    stance = Stance(skeleton, joints, turns, {role: float(heights[joints[role]]) for role in FEET})
    faults = _faults_of_pose(stance)
    if faults:
        raise MocapError(f"The pose in '{shortened(motion.name)}' does not stand: {faults}.")
    lowest = float(heights.min())
    if not -UNDER_FLOOR <= lowest / stance.leg <= OVER_FLOOR:
        place = f"is {abs(lowest):.2f} m {'below' if lowest < 0 else 'above'} y = 0"
        warn(f"'{shortened(motion.name)}': the lowest joint {place}, and is taken to be on the floor.")
        stance = replace(stance, heights={role: height - lowest for role, height in stance.heights.items()})
    return stance


def _slants(stance: Stance) -> tuple[float, float]:
    """Measure how far the hips are off level, and the thighs off hanging, degrees."""
    level = _degrees(stance.bone("right hip", "left hip"), [1, 0, 0])
    hanging = max(_degrees(stance.bone(f"{side} hip", f"{side} knee"), [0, -1, 0]) for side in SIDES)
    return level, hanging


def _faults_of_pose(stance: Stance) -> str:
    """Say why a pose does not stand; nothing if it does."""
    level, hanging = _slants(stance)
    if level > LEVEL or hanging > HANGING:
        return f"its hips are {level:.0f}° off level, its thighs {hanging:.0f}° off hanging"
    _, rise, lead = np.abs(stance.bone("right ankle", "left ankle")) / stance.leg
    if rise > RAISED or lead > AHEAD:
        height, distance = 100 * stance.leg * np.array([rise, lead])
        return f"one ankle is {height:.0f} cm higher and {distance:.0f} cm further ahead than the other"
    return ""


def stance_of_zero(skeleton: Skeleton, heights: Mapping[str, float] | float) -> Stance:
    """Take a skeleton's rest pose, all rotations zero, as its stance, and lay its feet flat.

    A foot that hangs at rest, by more than 45°, is laid straight ahead.

    Parameters
    ----------
    skeleton : its rest pose must stand upright and head +z.
    heights : metres over the floor by role, as `standing_heights` measures them; or one number for both
        balls, with the ankles as far above as in the rest pose.

    Raises
    ------
    MocapError : for a rest pose that does not stand: hips not level with the left one at +x, or thighs that
        do not hang; such files need `stance_of` a clip.

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
    level, hanging = _slants(rest)
    if level > LEVEL or hanging > HANGING:
        angles = f"its hips are {level:.0f}° off level, its thighs {hanging:.0f}° off hanging"
        raise MocapError(f"The rest pose of {skeleton!r} does not stand: {angles}; give stance_of a walk.")
    bones = {side: rest.bone(f"{side} ankle", f"{side} ball") for side in SIDES}
    if not isinstance(heights, Mapping):
        rises = {side: bone[1] for side, bone in bones.items()}
        of_ankles = {f"{side} ankle": heights - rise for side, rise in rises.items()}
        heights = {role: of_ankles.get(role, heights) for role in FEET}
    stance = replace(rest, heights=heights)
    for (side, bone), leg in zip(bones.items(), stance.legs, strict=True):
        if not leg.has_ball:
            continue
        drop = stance.drop(side)
        ahead = bone[[0, 2]]
        ahead = ahead if np.hypot(*ahead) > abs(bone[1]) else np.array([0.0, 1.0])
        ahead = ahead / np.hypot(*ahead) * np.sqrt(bone @ bone - drop**2)
        foot = [joint for joint in range(len(turns)) if leg.ankle in skeleton.path_to_root(joint)]
        turns[foot] = rotations.between(bone, [ahead[0], -drop, ahead[1]])
    return replace(stance, turns=turns)


def _degrees(vector: Array, axis: list[int]) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(vector, axis)), np.dot(vector, axis))))


def standing_heights(motion: Motion, joints: Mapping[str, int]) -> dict[str, float]:
    """Measure how high ankles and balls are while the foot is flat, or they stand: medians, metres, by role.

    Parameters
    ----------
    motion : on a floor at y = 0; its `contacts` say when ankles and balls stand.
    joints : the roles of its joints.

    Raises
    ------
    MocapError : for an ankle or a ball that never stands.
    """
    down = {role: motion.contacts[motion.skeleton.names[joints[role]]] for role in FEET}
    positions = joint_positions(motion)
    heights = {}
    for role in FEET:
        side = role.split()[0]
        flat = down[f"{side} ankle"] & down[f"{side} ball"]
        frames = flat if flat.any() else down[role]
        if not frames.any():
            raise MocapError(f"In '{motion.name}' the {role} never stands: give the stance of another clip.")
        heights[role] = float(np.median(positions[frames, joints[role], 1]))
    return heights


def heights_from_balls(motion: Motion, joints: Mapping[str, int]) -> dict[str, float]:
    """Estimate how high ankles and balls are when they stand, from balls alone: metres, by role.

    In a run, heels may never stand. The height of an ankle over its ball is then the lower quartile over the
    frames in which the ball stands. If the ball of one side never stands, the other side's heights are taken.

    Parameters
    ----------
    motion : on a floor at y = 0; its `contacts` say when balls stand.
    joints : the roles of its joints.

    Raises
    ------
    MocapError : if no ball ever stands.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> heights = heights_from_balls(walk, roles(walk.skeleton))
    >>> round(heights["left ball"], 3), round(heights["left ankle"], 3)
    (0.026, 0.068)
    """
    positions = joint_positions(motion)
    heights: dict[str, float] = {}
    for side, opposite in (SIDES, SIDES[::-1]):
        balls = (joints[f"{side} ball"], joints[f"{opposite} ball"])
        marks = [motion.contacts[motion.skeleton.names[ball]] for ball in balls]
        if not np.any(marks):
            name = shortened(motion.name)
            raise MocapError(f"In '{name}' no foot ever stands: give the stance of another clip.")
        stands = side if marks[0].any() else opposite
        frames = marks[0] if marks[0].any() else marks[1]
        ball = positions[frames, joints[f"{stands} ball"], 1]
        ankle = positions[frames, joints[f"{stands} ankle"], 1]
        heights[f"{side} ball"] = float(np.median(ball))
        heights[f"{side} ankle"] = heights[f"{side} ball"] + float(np.percentile(ankle - ball, OF_RUNS))
    return heights


def proportioned(
    stance: Stance, *, legs: float = 1.0, trunk: float = 1.0, arms: float = 1.0, head: float = 1.0
) -> Stance:
    """Make the legs, the trunk, the arms and the head of a body longer or shorter: a child has short legs.

    Parameters
    ----------
    stance : how the body stands.
    legs, trunk, arms, head : new lengths as shares of the old ones. The legs are all below the hips, the arms
        all below the shoulders, the head all above the neck's first joint; the rest is the trunk.

    Returns
    -------
    How the new body stands; its ankles and balls are as high as its legs are long.

    Raises
    ------
    MocapError : for a share that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> adult = stance_of(sample("walk_straight"))
    >>> child = proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    >>> round(child.leg / adult.leg, 3)
    0.55
    >>> bool((proportioned(adult).points == adult.points).all())  # without shares it is the same body
    True

    Notebook: 13-retargeting
    """
    if not isinstance(stance, Stance):
        remedy = "editing.stance_of(motion) finds one"
        raise MocapError(f"This takes a Stance, how a body stands, got {described(stance)}: {remedy}.")
    for name, share in {"legs": legs, "trunk": trunk, "arms": arms, "head": head}.items():
        if not (np.isfinite(share) and share > 0):
            raise MocapError(f"The share of the {name} must be above 0, got {share}.")
    old = stance.skeleton
    share_below = {"hip": legs, "shoulder": arms, "neck": head}
    tops = {joint: share_below.get(role.split()[-1], 0) for role, joint in stance.roles.items()}
    shares = np.full(len(old), float(trunk))
    for joint, above in enumerate(old.parents[1:], start=1):  # a parent stands before its children
        shares[joint] = tops.get(above) or shares[above]
    body = replace(old, offsets=old.offsets * shares[:, None])
    return Stance(body, stance.roles, stance.turns, {role: legs * stance.heights[role] for role in FEET})
