"""Toes that bend so that their tips stay above the floor.

The clean-up of feet rotates a foot about its ball, and retargeting copies the rotations of toes to longer
ones. Both push the tips of the toes through the floor. Ankles and balls have their own constraints, therefore
the toes bend about their lateral axis, as at toe-off. The method is ours.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.ndimage import convolve1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.foot_joints import Feet
from mocap.body.kinematics import hinge_of, joint_positions
from mocap.body.legs import Leg
from mocap.body.motion import Motion
from mocap.editing.poses import MotionOrPoses, Poses, poses_of
from mocap.editing.tuned import TUNED

SLACK = 0.001  # metres: a tip that is lower by less is left alone
SHORT = 1e-9  # metres: toes that point straight down in every frame have no lateral axis, and stay


def lowest_heights(clips: Sequence[Motion]) -> Array:
    """Compute the lowest height of each joint in clips of one skeleton, (J,), metres."""
    return np.asarray(np.min([joint_positions(clip)[..., 1].min(axis=0) for clip in clips], axis=0))


def lowest_allowed(motion: MotionOrPoses, feet: Feet, lowest: Array | None = None) -> Array:
    """Compute the lowest height of each joint that is allowed after an edit, (F, J), metres.

    A joint may be on the floor, y = 0, or as far under it as it was in the same frame. An ankle, and what is
    below it, may nowhere be lower than the lowest of its positions.

    Parameters
    ----------
    motion : F frames, before the edit.
    feet : from `feet_of`.
    lowest : the lowest height of each joint in the clips that the motion is made of, (J,), metres; by default
        in the motion itself.

    Examples
    --------
    >>> from mocap.body.foot_joints import feet_of
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> allowed = lowest_allowed(walk, feet_of(walk))[:, walk.skeleton.index("ltoes_end")]
    >>> bool(np.ptp(allowed) == 0), round(float(allowed[0]), 3)  # this tip is never under the floor
    (True, 0.017)
    """
    poses = poses_of(motion)
    heights = poses.positions[..., 1]
    lowest = heights.min(axis=0) if lowest is None else lowest
    allowed = np.minimum(heights, 0.0)
    joints = feet.joints
    allowed[:, joints] = np.maximum(lowest[joints], allowed[:, joints])
    return allowed


def bend_toes(motion: MotionOrPoses, allowed: Array, feet: Feet) -> Motion:
    """Bend toes so that their tips are no lower than allowed.

    Only the rotations of the balls change. A bend begins and ends smoothly within 0.05 s.

    Parameters
    ----------
    motion : F frames of J joints.
    allowed : the lowest height of each joint, (F, J), metres, as `lowest_allowed` computes it; only those of
        toe tips matter.
    feet : from `feet_of`.

    Returns
    -------
    The same frames; the motion itself if no tip is lower by more than a millimetre, or it has no toes.

    Examples
    --------
    >>> from mocap.body.foot_joints import feet_of
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:120]
    >>> feet = feet_of(walk)
    >>> raised = bend_toes(walk, lowest_allowed(walk, feet) + 0.02, feet)  # 2 cm higher than they ever were
    >>> tip = walk.skeleton.index("ltoes_end")
    >>> [round(float(joint_positions(clip)[:, tip, 1].min()), 3) for clip in (walk, raised)]
    [0.017, 0.036]
    """
    poses = poses_of(motion)
    source = poses.motion
    local = source.rotations.copy()
    for leg, tips in zip(feet.legs, feet.tips, strict=True):
        if not tips or (poses.positions[:, tips, 1] >= allowed[:, tips] - SLACK).all():
            continue
        axis = _lateral_axis(poses, leg, tips)
        angles = [_angles(poses, leg.ball, tip, axis, allowed[:, tip] - SLACK) for tip in tips]
        bends = _eased(np.max(angles, axis=0), source.fps)[:, None] * axis
        local[:, leg.ball] = rotations.multiply(local[:, leg.ball], rotations.from_rotvec(bends))
    if np.array_equal(local, source.rotations):
        return source
    return replace(source, rotations=local)


def _lateral_axis(poses: Poses, leg: Leg, tips: Sequence[int]) -> Array:
    """Find the axis about which toes bend upwards, a unit vector in the frame of the ball, (3,)."""
    toes = poses.positions[:, tips].mean(axis=1) - poses.positions[:, leg.ball]
    level_lengths = np.hypot(toes[:, 0], toes[:, 2])
    slopes = np.arctan2(np.abs(toes[:, 1]), level_lengths)
    frames = slopes <= max(TUNED.toe_level, float(slopes.min()))
    lateral = np.cross(toes[frames], [0.0, 1.0, 0.0])
    lateral /= np.maximum(np.linalg.norm(lateral, axis=1, keepdims=True), SHORT)
    axis = np.einsum("fji,fj->i", poses.matrices[frames, leg.ball], lateral)
    axis /= max(float(np.linalg.norm(axis)), SHORT)
    hinge = hinge_of(poses.motion, leg.ball)
    if hinge is None or abs(hinge @ axis) < np.cos(TUNED.toe_level):
        return np.asarray(axis)
    return np.asarray(hinge * np.sign(hinge @ axis))


def _angles(poses: Poses, ball: int, tip: int, axis: Array, lowest: Array) -> Array:
    """Compute the smallest bends, radians, that raise a tip to the lowest heights allowed, (F,).

    Bent by θ, the tip is at the height c + r cos(θ - φ): c is the part along the axis, φ the bend at which it
    is highest.
    """
    toe = poses.positions[:, tip] - poses.positions[:, ball]
    axes = poses.matrices[:, ball] @ axis
    along = np.einsum("fi,fi->f", toe, axes)[:, None] * axes
    level = toe - along
    upright = np.cross(axes, level)
    rise = lowest - poses.positions[:, ball, 1] - along[:, 1]
    radius = np.maximum(np.hypot(level[:, 1], upright[:, 1]), SLACK)
    highest = np.arctan2(upright[:, 1], level[:, 1])
    angles = highest - np.arccos(np.clip(rise / radius, -1.0, 1.0))
    angles[poses.positions[:, tip, 1] >= lowest] = 0.0
    return np.asarray(np.clip(angles, 0.0, TUNED.toe_bend))


def _eased(angles: Array, fps: float) -> Array:
    """Compute a smooth curve that is nowhere below the angles, (F,)."""
    reach = max(1, round(TUNED.toe_ease * fps))
    window = np.hanning(2 * reach + 3)[1:-1]
    wide = maximum_filter1d(angles, 2 * reach + 1, mode="nearest")
    return np.asarray(convolve1d(wide, window / window.sum(), mode="nearest"))
