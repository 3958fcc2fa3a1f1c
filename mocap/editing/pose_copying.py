"""The poses of one body, copied to another one: global rotations, and the scaled path of the hips [Gle98].

Rotations are copied in the world, not relative to the parent: a joint that one body lacks changes nothing,
and rest poses do not matter.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.legs import heading_by_hips
from mocap.body.limbs import SIDES
from mocap.body.motion import Motion
from mocap.editing.poses import MotionOrPoses, Poses, poses_of
from mocap.editing.stances import Stance
from mocap.errors import MocapError

# Roles at the far ends of a joint's bones. Head, ankles and balls have none; a hand moves with its forearm.
BELOW = {
    "pelvis": ("waist", "chest", "left hip", "right hip"),
    "waist": ("chest",),
    "chest": ("neck", "head", "left shoulder", "right shoulder"),
    "neck": ("head",),
}
BONES = (*pairwise(("clavicle", "shoulder", "elbow", "wrist")), *pairwise(("hip", "knee", "ankle")))
BELOW |= {f"{side} {above}": (f"{side} {below}",) for side in SIDES for above, below in BONES}
SHORT = 1e-6  # metres: a shorter bone has no direction
SMALL = 1e-9  # weight of each axis, next to 1 for bones


def copied(motion: MotionOrPoses, source: Stance, target: Stance, *, scale: float | None = None) -> Motion:
    """Copy global rotations to another body, and the scaled path of the hips [Gle98, scaled start].

    R_t(f) = R_s(f) C with C = R_s(stance)⁻¹ A R_t(stance). A is the smallest rotation that aligns the bones
    of the target at that joint with those of the source, in their stances; hands have that of their forearms,
    head and feet have A = 1. So have joints without a role, but with the same name in both bodies. Others
    stay as they are relative to their parents. The path of the middle of the hips on the ground is scaled by
    `scale` about its start, and its height above the standing ankles by the ratio of the legs.

    Scaling about a centre is [Gle98]'s. Roles, stances and C are ours: the bodies in the paper have the same
    tree and the same rest pose.

    Parameters
    ----------
    motion : F frames of the source's skeleton.
    source, target : the stances of both bodies.
    scale : of the path on the ground; by default the ratio of the legs, for steps in proportion.

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
    poses = poses_of(motion)
    motion = poses.motion
    source.skeleton.require_same(motion.skeleton)
    ratio = target.leg / source.leg
    scale = ratio if scale is None else scale
    if not (np.isfinite(scale) and scale > 0):
        raise MocapError(f"The scale of a path must be above 0, got {scale}.")
    world = _copied_rotations(poses, source, target)
    parents = target.skeleton.parents
    local = rotations.multiply(rotations.inverse(world[:, parents]), world)
    local[:, 0] = world[:, 0]
    local /= np.linalg.norm(local, axis=-1, keepdims=True)
    start = Motion(target.skeleton, np.zeros((len(motion), 3)), local, motion.fps, motion.name, motion.labels)
    hips = _middle_of_hips(poses.positions, source)
    centre = hips[0] * [1, 0, 1]
    wanted = centre + (hips - centre) * [scale, 0, scale]
    wanted[:, 1] = target.height("ankle") + ratio * (hips[:, 1] - source.height("ankle"))
    roots = wanted - _middle_of_hips(joint_positions(start), target)
    contacts = {name: motion.contacts[old] for old, name in _contact_names(motion, source, target)}
    return replace(start, root_positions=roots, contacts=contacts)


def _copied_rotations(poses: Poses, source: Stance, target: Stance) -> Array:
    """Copy the global rotations of the source's joints, (F, J, 4), J joints of the target."""
    seen = rotations.from_matrix(poses.matrices)
    parents = target.skeleton.parents
    world = np.empty((len(seen), len(parents), 4))
    for joint, (image, turn) in enumerate(_bone_turns(source, target)):
        if image is not None:
            base = seen[:, image]
        elif joint:
            base = world[:, parents[joint]]
        else:
            base = rotations.about_y(heading_by_hips(poses.positions, source.legs))
        world[:, joint] = rotations.multiply(base, turn)
    return world


def _middle_of_hips(positions: Array, stance: Stance) -> Array:
    """Compute the middle of both hips, (F, 3), from positions of the stance's joints (F, J, 3)."""
    return np.asarray(positions[:, [leg.hip for leg in stance.legs]].mean(axis=1))


def _contact_names(motion: Motion, source: Stance, target: Stance) -> Iterator[tuple[str, str]]:
    """Yield the joints that have contacts, and the target's joints of the same roles, by name.

    The ball of a foot without toes is its ankle, and has that one's contacts.
    """
    feet = [leg.ankle for leg in target.legs if not leg.has_ball]
    for name in motion.contacts:
        for role, joint in source.roles.items():
            image = target.roles.get(role)
            is_extra = role.endswith("ball") and image in feet
            if motion.skeleton.names[joint] == name and image is not None and not is_extra:
                yield name, target.skeleton.names[image]


def _bone_turns(source: Stance, target: Stance) -> list[tuple[int | None, Array]]:
    """Find for each joint of the target the joint of the source whose rotation it copies, and C (4,).

    Joints correspond by role, or by name if they have none. Without a corresponding joint (None), C is
    relative to the parent, or for a root above the pelvis to the heading.
    """
    # Of a foot without toes, ankle and ball are one joint: it has the role of the ankle.
    role_of = {joint: role for role, joint in reversed([*target.roles.items()])}
    copies: list[tuple[int | None, Array]] = []
    for joint, name in enumerate(target.skeleton.names):
        role = role_of.get(joint)
        image = source.roles.get(role or "")
        if role is None and name in source.skeleton.names:
            image = source.skeleton.index(name)
        path = target.skeleton.path_to_root(joint)
        stands = target.turns[joint]
        if image is not None:
            hands = (side for side in SIDES if target.roles.get(f"{side} wrist") in path)
            role = next((f"{side} elbow" for side in hands), role)
            stands = rotations.multiply(_alignment(role, source, target), stands)
            base = source.turns[image]
        else:
            base = target.turns[path[1]] if joint else rotations.IDENTITY
        copies.append((image, rotations.multiply(rotations.inverse(base), stands)))
    return copies


def _alignment(role: str | None, source: Stance, target: Stance) -> Array:
    """Compute A, the smallest rotation that aligns the target's bones at a joint with the source's, (4,)."""
    shared = [end for end in BELOW.get(role or "", ()) if end in source.roles and end in target.roles]
    bones = np.array([[stance.bone(str(role), end) for end in shared] for stance in (target, source)])
    bones = bones.reshape(2, -1, 3)
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    bones = (bones / np.maximum(lengths, SHORT))[:, (lengths > SHORT).all(axis=(0, 2))]
    if not bones.size:
        return rotations.IDENTITY
    if bones.shape[1] == 1:
        return rotations.between(*bones[:, 0])
    # The three axes, with small weights, select the smallest rotation if all bones are on one line.
    from_target, onto_source = (np.vstack([side, np.eye(3)]) for side in bones)
    weights = [1.0] * bones.shape[1] + [SMALL] * 3
    turn, _ = Rotation.align_vectors(onto_source, from_target, weights)
    return np.asarray(turn.as_quat(scalar_first=True))
