"""A motion copied onto another body: every joint with a role looks where the same joint of the source looks.

Global turns are copied, not those against the parent. So a joint that one of the bodies lacks costs nothing,
and rest poses do not matter. The feet of a copy may slide and sink: `retarget` goes on from here.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses, forward_kinematics, joint_positions
from mocap.body.motion import Motion
from mocap.editing.body_roles import SIDES
from mocap.editing.stances import Stance, heading_by_hips
from mocap.errors import MocapError

# The roles that a joint's bones lead to. Head, ankles and balls lead to none; a hand goes with its forearm.
BELOW = {
    "pelvis": ("waist", "chest", "left hip", "right hip"),
    "waist": ("chest",),
    "chest": ("neck", "head", "left shoulder", "right shoulder"),
    "neck": ("head",),
}
LIMBS = ("clavicle", "shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
BELOW |= {f"{s} {above}": (f"{s} {below}",) for s in SIDES for way in LIMBS for above, below in pairwise(way)}
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
    >>> from mocap.editing.stances import stance_of
    >>> walk = sample("walk_straight")
    >>> stance = stance_of(walk)
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
    local = _local(poses, source, target)
    start = Motion(target.skeleton, np.zeros((len(motion), 3)), local, motion.fps, motion.name, motion.labels)
    hips, own = (
        positions[:, [leg.hip for leg in stance.legs]].mean(axis=1)  # (F, 3)
        for positions, stance in ((poses.positions, source), (joint_positions(start), target))
    )
    centre = hips[0] * [1, 0, 1]
    wanted = centre + (hips - centre) * [scale, 0, scale]
    wanted[:, 1] = target.height("ankle") + ratio * (hips[:, 1] - source.height("ankle"))
    names = {motion.skeleton.names[j]: target.skeleton.names[target.roles[r]]
             for r, j in source.roles.items() if r in target.roles}  # fmt: skip
    contacts = {names[old]: mark for old, mark in motion.contacts.items() if old in names}
    return replace(start, root_positions=wanted - own, contacts=contacts)


def _local(poses: GlobalPoses, source: Stance, target: Stance) -> Array:
    """Turn the target's joints against their parents, (F, J, 4).

    A joint without a turn of its own keeps the stance's; a root above the pelvis turns with the heading only.
    """
    parents, looks = target.skeleton.parents, _bone_turns(source, target)
    seen = rotations.from_matrix(poses.matrices)
    world = np.empty((len(seen), len(parents), 4))
    facing = rotations.about_y(heading_by_hips(poses.positions, source.roles))
    world[:, 0] = rotations.multiply(facing, target.turns[0])
    for joint, above in enumerate(parents):
        if joint in looks:
            own, turn = looks[joint]
            world[:, joint] = rotations.multiply(seen[:, own], turn)
        elif joint:
            still = rotations.multiply(rotations.inverse(target.turns[above]), target.turns[joint])
            world[:, joint] = rotations.multiply(world[:, above], still)
    local = rotations.multiply(rotations.inverse(world[:, parents]), world)
    local[:, 0] = world[:, 0]
    return np.asarray(local / np.linalg.norm(local, axis=-1, keepdims=True))


def _bone_turns(source: Stance, target: Stance) -> dict[int, tuple[int, Array]]:
    """Find for each of the target's joints the source's joint, and C (4,), the turn between how both look.

    Joints belong together by role, or by name where they have none.
    """
    role_of = {joint: role for role, joint in target.roles.items()}
    looks = {}
    for joint, name in enumerate(target.skeleton.names):
        role = role_of.get(joint)
        own = source.roles.get(role or "")
        if role is None and name in source.skeleton.names:
            own = source.skeleton.index(name)
        if own is None:
            continue
        above = target.skeleton.path_to_root(joint)
        role = next((f"{side} elbow" for side in SIDES if target.roles.get(f"{side} wrist") in above), role)
        stands = rotations.multiply(_laid(role, source, target), target.turns[joint])
        looks[joint] = (own, rotations.multiply(rotations.inverse(source.turns[own]), stands))
    return looks


def _laid(role: str | None, source: Stance, target: Stance) -> Array:
    """Find A, the smallest turn that lays the target's bones at a joint on the source's, (4,)."""
    both = [below for below in BELOW.get(role or "", ()) if below in source.roles and below in target.roles]
    bones = np.array([[stance.bone(str(role), below) for below in both] for stance in (target, source)])
    bones = bones.reshape(2, -1, 3)
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    bones = (bones / np.maximum(lengths, SHORT))[:, (lengths > SHORT).all(axis=(0, 2))]
    if not bones.size:
        return rotations.IDENTITY
    if bones.shape[1] == 1:
        return rotations.between(*bones[:, 0])
    # The three axes, with next to no weight, choose the smallest turn where the bones lie on one line.
    weights = [1.0] * bones.shape[1] + [SMALL] * 3
    turn, _ = Rotation.align_vectors(np.r_[bones[1], np.eye(3)], np.r_[bones[0], np.eye(3)], weights)
    return np.asarray(turn.as_quat(scalar_first=True))
