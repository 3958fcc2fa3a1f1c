"""A motion copied onto another body: every joint with a role looks where the same joint of the source looks.

Global turns are copied, not those against the parent. So a joint that one of the bodies lacks costs nothing,
and rest poses do not matter. The feet of a copy may slide and sink: `retarget` goes on from here.
"""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses, forward_kinematics, joint_positions
from mocap.body.motion import Motion
from mocap.editing.stances import heading_by_hips
from mocap.editing.upright_bodies import Stance
from mocap.errors import MocapError

# The roles that a joint's bones lead to. Head, ankles and balls lead to none; a hand goes with its forearm.
BELOW = {
    "pelvis": ("waist", "chest", "left hip", "right hip"),
    "waist": ("chest",),
    "chest": ("neck", "head", "left shoulder", "right shoulder"),
    "neck": ("head",),
}
BELOW |= {
    f"{side} {above}": (f"{side} {below}",)
    for side in ("left", "right")
    for above, below in (
        ("clavicle", "shoulder"),
        ("shoulder", "elbow"),
        ("elbow", "wrist"),
        ("hip", "knee"),
        ("knee", "ankle"),
    )
}
SHORT = 1e-6  # metres: a shorter bone points nowhere
SMALL = 1e-9


def copied(motion: Motion, source: Stance, target: Stance, *, scale: float | None = None) -> Motion:
    """Copy a motion onto another body: its turns, and the way of its hips, scaled [Gle98, scaled start].

    R_t(f) = R_s(f) C with C = R_s(stance)⁻¹ A R_t(stance). A is the smallest turn that lays the target's
    bones at that joint on the source's, both as they stand; hands go with their forearms, and there is none
    for head and feet. Joints without a role, but with the same name in both, take A = 1; others stay as they
    are to their parents. The middle of the hips goes `scale` times as far over the ground from where it
    starts, and its height over the standing ankles is the legs' ratio times the source's.

    Scaling the way about a centre is [Gle98]'s. Roles, stances and C are ours: the paper's bodies have the
    same tree and the same rest pose.

    Parameters
    ----------
    motion : F frames of the source's skeleton.
    source, target : how both bodies stand.
    scale : of the way over the ground; by default the ratio of the legs, which keeps the steps in proportion.

    Returns
    -------
    F frames of the target's skeleton, with the source's name, labels, and contacts under the target's names.

    Raises
    ------
    SkeletonMismatch : for a motion of another skeleton than the source's.
    MocapError : for a scale that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import stance_of_walk
    >>> walk = sample("walk_straight")
    >>> stance = stance_of_walk(walk)
    >>> same = copied(walk, stance, stance)
    >>> bool(abs(joint_positions(same) - joint_positions(walk)).max() < 1e-12)
    True

    Notebook: 13-retargeting
    """
    source.skeleton.require_same(motion.skeleton)
    ratio = target.leg / source.leg
    scale = ratio if scale is None else scale
    if not (np.isfinite(scale) and scale > 0):
        raise MocapError(f"A way over the ground needs a scale above 0, got {scale}.")
    poses = forward_kinematics(motion)
    local = _local(_global(motion, poses, source, target), target)
    start = Motion(target.skeleton, np.zeros((len(motion), 3)), local, motion.fps, motion.name, motion.labels)
    hips = _hips(poses.positions, source)
    centre = hips[0] * [1, 0, 1]
    wanted = centre + (hips - centre) * [scale, 0, scale]
    wanted[:, 1] = target.height("ankle") + ratio * (hips[:, 1] - source.height("ankle"))
    roots = wanted - _hips(joint_positions(start), target)
    names = {motion.skeleton.names[j]: target.skeleton.names[target.roles[r]]
             for r, j in source.roles.items() if r in target.roles}  # fmt: skip
    contacts = {names[old]: mark for old, mark in motion.contacts.items() if old in names}
    return Motion(target.skeleton, roots, local, motion.fps, motion.name, motion.labels, contacts)


def _hips(positions: Array, stance: Stance) -> Array:
    """Give the middle of the hips, (F, 3)."""
    return np.asarray(positions[:, [leg.hip for leg in stance.legs]].mean(axis=1))


def _global(motion: Motion, poses: GlobalPoses, source: Stance, target: Stance) -> dict[int, Array]:
    """Turn the target's joints in the world, (F, 4) each, where a joint of the source turns them."""
    looks = bone_turns(source, target)
    joints, turns = zip(*looks.values(), strict=True)
    world_of_source = rotations.from_matrix(poses.matrices[:, joints])
    world = dict(zip(looks, np.swapaxes(rotations.multiply(world_of_source, turns), 0, 1), strict=True))
    if 0 not in world:  # a root above the pelvis turns with the heading only
        heading = heading_by_hips(poses.positions, source.roles)
        world[0] = rotations.multiply(rotations.about_y(heading), target.turns[0])
    return world


def bone_turns(source: Stance, target: Stance) -> dict[int, tuple[int, Array]]:
    """Find for each of the target's joints the source's joint and C, the turn between how both look.

    Returns
    -------
    {target's joint: (source's joint, C (4,))}, by role, or by name where a joint has none.
    """
    pairs = {target.roles[role]: joint for role, joint in source.roles.items() if role in target.roles}
    role_of = {joint: role for role, joint in target.roles.items()}
    for joint, name in enumerate(target.skeleton.names):
        if joint not in role_of and name in source.skeleton.names:
            pairs[joint] = source.skeleton.index(name)
    looks = {}
    for joint, own in pairs.items():
        role = next((f"{side} elbow" for side in _hands(joint, target)), role_of.get(joint))
        stands = rotations.multiply(_laid(role, source, target), target.turns[joint])
        looks[joint] = (own, rotations.multiply(rotations.inverse(source.turns[own]), stands))
    return looks


def _hands(joint: int, stance: Stance) -> list[str]:
    """Name the side of a joint at or below a wrist."""
    above = stance.skeleton.path_to_root(joint)
    return [side for side in ("left", "right") if stance.roles.get(f"{side} wrist") in above]


def _laid(role: str | None, source: Stance, target: Stance) -> Array:
    """Find A, the smallest turn that lays the target's bones at a joint on the source's, (4,)."""
    both = [below for below in BELOW.get(role or "", ()) if below in source.roles and below in target.roles]
    onto, bones = (np.array([_bone(stance, role, below) for below in both]) for stance in (source, target))
    known = [bool(pair.any(axis=-1).all()) for pair in np.stack([onto, bones], axis=1)] if both else []
    if not any(known):
        return rotations.IDENTITY
    onto, bones = onto[known], bones[known]
    if len(bones) == 1:
        return rotations.between(bones[0], onto[0])
    # The three axes, with next to no weight, choose the smallest turn where the bones lie on one line.
    weights = [1.0] * len(bones) + [SMALL] * 3
    turn, _ = Rotation.align_vectors(np.r_[onto, np.eye(3)], np.r_[bones, np.eye(3)], weights)
    return np.asarray(turn.as_quat(scalar_first=True))


def _bone(stance: Stance, role: str | None, below: str) -> Array:
    """Give the direction from a role's joint to that of a role below, (3,); 0 where they coincide."""
    bone = stance.points[stance.roles[below]] - stance.points[stance.roles[str(role)]]
    length = np.linalg.norm(bone)
    return np.asarray(bone / length if length > SHORT else np.zeros(3))


def _local(world: Mapping[int, Array], target: Stance) -> Array:
    """Turn joints against their parents, (F, J, 4); those without a turn of their own keep the stance's."""
    parents, every = target.skeleton.parents, [world[0]]
    local = [world[0]]
    for joint in range(1, len(parents)):
        above = every[parents[joint]]
        back = rotations.inverse(above if joint in world else target.turns[parents[joint]])
        own = rotations.multiply(back, world.get(joint, target.turns[joint]))
        local.append(np.broadcast_to(own, above.shape))
        every.append(world[joint] if joint in world else rotations.multiply(above, own))
    stacked = np.stack(local, axis=1)
    return np.asarray(stacked / np.linalg.norm(stacked, axis=-1, keepdims=True))
