"""How a body stands upright: what two bodies have in common, whatever their rest poses are.

A rest pose says little. Some files rest with the arms out, some with the arms down, and in some all bones lie
along one line. So two bodies are compared as they stand: feet flat, heading +z.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.body_roles import FEET, legs_among, roles
from mocap.editing.upright_bodies import Stance, joint_points
from mocap.errors import MocapError
from mocap.feet.footplants import mark_plants

# Degrees. A rest pose stands where the hips are level and the thighs hang, within these. The files at hand
# keep to 0 and 20 (CMU), 0 and 1 (others), or are 90 and 90 off: their rest poses are no stances.
LEVEL, HANGING = 30.0, 45.0


def stance_of_zero(
    skeleton: Skeleton, heights: Mapping[str, float] | float, *, told: Mapping[str, str] | None = None
) -> Stance:
    """Take a skeleton's rest pose, all rotations zero, as its stance, and lay its feet flat.

    Parameters
    ----------
    skeleton : its rest pose must stand upright and head +z.
    heights : metres over the floor by role, as `standing_heights` measures them; or one number for both
        balls, with the ankles as far above as in the rest pose.
    told : roles given by hand.

    Raises
    ------
    MocapError : for a rest pose that does not stand: hips not level with the left one at +x, or thighs that
        do not hang; such files need `stance_of_walk` of a clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> stance = stance_of_zero(walk.skeleton, standing_heights(walk))
    >>> stance.points[walk.skeleton.index("lfoot")].round(2)
    array([ 0.09, -0.94,  0.04])
    """
    who = roles(skeleton, told)
    turns = np.tile(rotations.IDENTITY, (len(skeleton), 1))
    points = joint_points(skeleton, turns)
    if not _upright(who, points):
        level, hanging = _off_upright(who, points)
        raise MocapError(
            f"The rest pose of {skeleton!r} does not stand: its hips are {level:.0f}° off level, its thighs "
            f"{hanging:.0f}° off hanging; give stance_of_walk of a clip."
        )
    if not isinstance(heights, Mapping):
        rises = {
            side: points[who[f"{side} ankle"], 1] - points[who[f"{side} ball"], 1]
            for side in ("left", "right")
        }
        heights = {role: heights + rises[role.split()[0]] * role.endswith("ankle") for role in FEET}
    stance = Stance(skeleton, who, turns, dict(heights))
    return replace(stance, turns=_flat_feet(stance))


def _off_upright(who: Mapping[str, int], points: Array) -> tuple[float, float]:
    """Measure how far the hips are off level, the left one at +x, and the thighs off hanging, degrees."""
    across = points[who["left hip"]] - points[who["right hip"]]
    thighs = [points[who[f"{side} knee"]] - points[who[f"{side} hip"]] for side in ("left", "right")]
    return _degrees(across, [1, 0, 0]), max(_degrees(thigh, [0, -1, 0]) for thigh in thighs)


def _upright(who: Mapping[str, int], points: Array) -> bool:
    level, hanging = _off_upright(who, points)
    return level <= LEVEL and hanging <= HANGING


def _degrees(vector: Array, other: list[int]) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(vector, other)), np.dot(vector, other))))


def _flat_feet(stance: Stance) -> Array:
    """Turn each foot, with the joints below it, so that ankle and ball are at the stance's heights.

    A foot that hangs at rest, by more than 45°, is laid straight ahead.
    """
    turns, points = np.array(stance.turns), stance.points
    for side, leg in zip(("left", "right"), stance.legs, strict=True):
        bone = points[leg.ball] - points[leg.ankle]
        drop = stance.heights[f"{side} ankle"] - stance.heights[f"{side} ball"]
        ahead = bone[[0, 2]] if np.hypot(*bone[[0, 2]]) > abs(bone[1]) else np.array([0.0, 1.0])
        ahead = ahead / np.hypot(*ahead) * np.sqrt(bone @ bone - drop**2)
        lay = rotations.between(bone, [ahead[0], -drop, ahead[1]])
        foot = [joint for joint in range(len(turns)) if leg.ankle in stance.skeleton.path_to_root(joint)]
        turns[foot] = rotations.multiply(lay, turns[foot])
    return turns


def stance_of_walk(motion: Motion, *, told: Mapping[str, str] | None = None) -> Stance:
    """Take the mean over a walk as the stance of its skeleton; this needs no rest pose that means anything.

    The idea is ours: each joint's mean turn against the body's heading, which is square to the hips' line; a
    foot's own, while it stands flat, against where it points. The mean of rotations is SciPy's, which does
    not depend on the signs of their quaternions.

    Parameters
    ----------
    motion : upright, with feet that stand flat at times; its plants are marked if they are not yet.
    told : roles given by hand.

    Raises
    ------
    MocapError : for a clip in which no foot stands.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stance = stance_of_walk(sample("walk_straight"))
    >>> rotations.rotate(stance.turns[0], [0, 0, 1]).round(1) + 0.0  # the pelvis looks ahead
    array([0., 0., 1.])
    """
    who = roles(motion.skeleton, told)
    pose = forward_kinematics(motion)
    world = rotations.from_matrix(pose.matrices)
    heading = heading_by_hips(pose.positions, who)
    seen = rotations.multiply(rotations.about_y(-heading)[:, None], world)
    turns = rotations.mean(np.swapaxes(seen, 0, 1))
    flat = _standing(motion, who)
    for side in ("left", "right"):
        ankle, ball = (who[f"{side} {part}"] for part in ("ankle", "ball"))
        down = flat[f"{side} ankle"] & flat[f"{side} ball"]
        if down.any():
            along = (pose.positions[:, ball] - pose.positions[:, ankle])[down]
            back = rotations.about_y(-np.arctan2(along[:, 0], along[:, 2]))
            standing = np.swapaxes(world[down][:, [ankle, ball]], 0, 1)
            turns[[ankle, ball]] = rotations.mean(rotations.multiply(back, standing))
    return Stance(motion.skeleton, who, turns, standing_heights(motion, told=told))


def stance_of(motion: Motion, *, told: Mapping[str, str] | None = None) -> Stance:
    """Take the stance of a motion's skeleton: its rest pose where that stands, else the mean over the motion.

    Parameters
    ----------
    motion : a walk, where the rest pose means nothing; its feet give the heights in any case.
    told : roles given by hand.

    Raises
    ------
    MocapError : for a motion in which an ankle or a ball never stands.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stance_of(sample("walk_straight")).turns[0]
    array([1., 0., 0., 0.])

    Notebook: 13-retargeting
    """
    who = roles(motion.skeleton, told)
    turns = np.tile(rotations.IDENTITY, (len(motion.skeleton), 1))
    if _upright(who, joint_points(motion.skeleton, turns)):
        return stance_of_zero(motion.skeleton, standing_heights(motion, told=told), told=told)
    return stance_of_walk(motion, told=told)


def heading_by_hips(positions: Array, who: Mapping[str, int]) -> Array:
    """Read where a body heads, square to the line of its hips, from positions (F, J, 3); radians (F,).

    Examples
    --------
    >>> heading_by_hips(np.array([[[0.0, 1, 0.1], [0, 1, -0.1]]]), {"left hip": 0, "right hip": 1}).round(4)
    array([-1.5708])
    """
    across = positions[:, who["left hip"]] - positions[:, who["right hip"]]
    return np.asarray(np.arctan2(-across[:, 2], across[:, 0]))


def standing_heights(motion: Motion, *, told: Mapping[str, str] | None = None) -> dict[str, float]:
    """Measure how high ankles and balls are while they stand: medians, metres, by role.

    Parameters
    ----------
    motion : on a floor at y = 0; its plants are marked if they are not yet.
    told : roles given by hand.

    Raises
    ------
    MocapError : for an ankle or a ball that never stands.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> {role: round(height, 3) for role, height in standing_heights(sample("walk_straight")).items()}
    {'left ankle': 0.068, 'left ball': 0.026, 'right ankle': 0.068, 'right ball': 0.026}
    """
    who = roles(motion.skeleton, told)
    down, positions = _standing(motion, who), joint_positions(motion)
    heights = {}
    for role in FEET:
        side = role.split()[0]
        flat = down[f"{side} ankle"] & down[f"{side} ball"]
        frames = flat if flat.any() else down[role]
        if not frames.any():
            raise MocapError(f"In '{motion.name}' the {role} never stands: give the stance of another clip.")
        heights[role] = float(np.median(positions[frames, who[role], 1]))
    return heights


def _standing(motion: Motion, who: Mapping[str, int]) -> dict[str, Mask]:
    """Read, or find, when ankles and balls stand, (F,) booleans by role."""
    names = {role: motion.skeleton.names[who[role]] for role in FEET}
    if not set(names.values()) <= set(motion.contacts):
        motion = mark_plants(motion, legs_among(who))
    return {role: motion.contacts[name] for role, name in names.items()}
