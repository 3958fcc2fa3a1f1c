"""The rest pose of a `.glb` file: the body stands on the floor and faces +z, whatever the file it came from.

Riggers attach a character to the rest pose, and engines show it. The zero pose of a motion file, with all
rotations zero, often stands. In other files it lies, faces elsewhere, or has all bones along one axis.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import permutations, product

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body import rotations
from mocap.body.joint_trees import GlobalPoses, place_joints
from mocap.body.legs import heading_by_hips
from mocap.body.limb_partners import limb_partners
from mocap.body.limbs import SIDES, find_legs, has_named_legs, roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened, warn

# Degrees by which a pose that stands may be off: the hips from level, a thigh or the trunk from vertical.
LEVEL = 30.0
UPRIGHT = 45.0
HANGING = 30.0  # degrees from straight down, within which a foot does not stand
MIRROR = np.array([-1.0, 1.0, 1.0])  # exchanges left and right
SMALLEST = 1e-6  # weight of the preference for small rotations, relative to squared lengths of bones
MOST_FRAMES = 2000  # of all clips, evenly spread, of which the mean pose is taken
TALL = 0.5  # fraction of these frames: those in which the body is tallest
FLAT = 0.1  # fraction of these frames: those in which a foot is lowest


def with_standing_rest(motions: Sequence[Motion]) -> list[Motion]:
    """Describe motions of one body by rotations from a rest pose that stands and faces +z.

    A rest pose that stands is kept. One that stands after quarter turns is rotated as a whole. In both, feet
    that hang are laid flat, straight ahead. Any other is replaced by the mean pose of the motions, in the
    frames in which the body is tallest, with flat feet and with limbs that mirror each other. A body whose
    legs are unknown keeps its rest pose.

    If joint j has the world rotation W_j in the new rest pose, and p is its parent, the new offset is W_p o_j
    and the new rotation W_p R_j W_j⁻¹. Joint positions do not change.

    Parameters
    ----------
    motions : one or more, on the same skeleton.

    Returns
    -------
    The motions on their new skeleton, or as they are.

    Warns
    -----
    MocapWarning : if the mean pose is taken.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> with_standing_rest([walk])[0] is walk
    True
    """
    skeleton = motions[0].skeleton
    joints = _known_roles(skeleton)
    if not joints:
        return list(motions)
    for quarter_turns in _quarter_turns():
        if _stands(rotations.rotate(quarter_turns, skeleton.rest), joints):
            world = _with_flat_feet(skeleton, quarter_turns)
            if np.array_equal(world, np.tile(rotations.IDENTITY, (len(skeleton), 1))):
                return list(motions)
            return [_rested(motion, world) for motion in motions]
    instead = ".glb files get the mean pose of their clips instead, one for all clips of a file"
    warn(f"The rest pose of '{shortened(motions[0].name, 40)}' does not stand: {instead}.")
    world = _symmetric(skeleton, _mean_pose(motions))
    return [_rested(motion, world) for motion in motions]


def _known_roles(skeleton: Skeleton) -> dict[str, int]:
    """Return the roles of joints, or {} for legs that neither roles nor names identify."""
    if has_named_legs(skeleton):
        with suppress(MocapError):
            return roles(skeleton)
    return {}


def _quarter_turns() -> list[Array]:
    """List the 24 rotations that map axes to axes, the identity first, as quaternions (4,)."""
    turns = []
    for order, signs in product(permutations(range(3)), product([1.0, -1.0], repeat=3)):
        matrix = np.diag(signs)[list(order)]
        if np.linalg.det(matrix) > 0:
            turns.append(rotations.from_matrix(matrix))
    return turns


def _stands(points: Array, joints: Mapping[str, int]) -> bool:
    """Return whether a pose, positions (J, 3), stands upright and faces +z."""
    hips = {side: points[joints[f"{side} hip"]] for side in SIDES}
    limbs = [hips[side] - points[joints[f"{side} knee"]] for side in SIDES]
    top = next((role for role in ("head", "neck", "chest") if role in joints), None)
    if top is not None:
        limbs.append(points[joints[top]] - (hips["left"] + hips["right"]) / 2)
    is_level = _degrees_between(hips["left"] - hips["right"], [1, 0, 0]) <= LEVEL
    return is_level and all(_degrees_between(limb, [0, 1, 0]) <= UPRIGHT for limb in limbs)


def _with_flat_feet(skeleton: Skeleton, quarter_turns: Array) -> Array:
    """Rotate a rest pose as a whole, and its feet if they hang; return the rotations of joints, (J, 4)."""
    world = np.tile(quarter_turns, (len(skeleton), 1))
    for leg in find_legs(skeleton):
        foot = rotations.rotate(quarter_turns, skeleton.rest[leg.ball] - skeleton.rest[leg.ankle])
        if leg.has_ball and _degrees_between(foot, [0, -1, 0]) < HANGING:
            below = [joint for joint in range(len(skeleton)) if leg.ankle in skeleton.path_to_root(joint)]
            world[below] = rotations.multiply(rotations.between(foot, [0, 0, 1]), quarter_turns)
    return world


def _degrees_between(vector: Array, axis: Sequence[float]) -> float:
    sine = np.linalg.norm(np.cross(vector, axis))
    return float(np.degrees(np.arctan2(sine, np.dot(vector, axis))))


def _mean_pose(motions: Sequence[Motion]) -> Array:
    """Compute the mean world rotation of each joint, relative to the heading by the hips, (J, 4)."""
    skeleton = motions[0].skeleton
    legs = find_legs(skeleton)
    poses = _tallest(skeleton, _spread(motions))
    world = np.swapaxes(rotations.from_matrix(poses.matrices), 0, 1)  # (J, F, 4)
    heading = heading_by_hips(poses.positions, legs)
    mean = rotations.mean(rotations.multiply(rotations.about_y(-heading), world))
    local = rotations.multiply(rotations.inverse(_of_parents(skeleton, mean)), mean)
    for leg in legs:
        if leg.has_ball:
            foot = [leg.ankle, leg.ball]
            flat = _flat_frames(poses.positions[:, foot, 1])
            bones = (poses.positions[:, leg.ball] - poses.positions[:, leg.ankle])[flat]
            straight = rotations.about_y(-np.arctan2(bones[:, 0], bones[:, 2]))
            mean[foot] = rotations.mean(rotations.multiply(straight, world[foot][:, flat]))
            _move_below(skeleton, leg.ankle, mean, local, kept=foot)
    return mean


def _symmetric(skeleton: Skeleton, world: Array) -> Array:
    """Rotate joints until left and right limbs mirror each other and the trunk is in the middle.

    Each bone b in the world has a target t: the mean of b and of the mirror image of its partner. The joint
    above rotates by the Q that maximises Σ t · Q b, over its children, and among equals is the smallest.

    Parameters
    ----------
    skeleton : J joints.
    world : shape (J, 4), the world rotations of joints in a pose that faces +z.
    """
    bones = rotations.rotate(_of_parents(skeleton, world), skeleton.offsets)
    targets = bones.copy()
    for joint, image in _images(skeleton).items():
        targets[joint] = (bones[joint] + bones[image] * MIRROR) / 2
    corrections = np.tile(rotations.IDENTITY, (len(skeleton), 1))
    for joint in range(len(skeleton)):
        children = skeleton.children(joint)
        squares = (bones[children] ** 2).sum()
        if squares > 0:
            outer_products = targets[children].T @ bones[children]
            matrix = rotations.nearest(outer_products + SMALLEST * squares * np.eye(3))
            corrections[joint] = rotations.from_matrix(matrix)
        elif joint:  # at the end of a limb
            corrections[joint] = corrections[skeleton.parents[joint]]
    return rotations.multiply(corrections, world)


def _images(skeleton: Skeleton) -> dict[int, int]:
    """Return the mirror image of each joint of the limbs, and of the trunk, whose joints are their own."""
    pairs = limb_partners(skeleton)
    images = pairs | {partner: joint for joint, partner in pairs.items()}
    for joint, partner in pairs.items():
        trunk = set(skeleton.path_to_root(joint)) & set(skeleton.path_to_root(partner))
        images |= {above: above for above in trunk}
    head = roles(skeleton).get("head", 0)
    return images | {joint: joint for joint in skeleton.path_to_root(head)}


def _spread(motions: Sequence[Motion]) -> tuple[Array, Array]:
    """Return root positions (F, 3) and rotations (F, J, 4) of frames spread evenly over all motions."""
    step = int(np.ceil(sum(map(len, motions)) / MOST_FRAMES))
    roots = np.concatenate([motion.root_positions[::step] for motion in motions])
    local = np.concatenate([motion.rotations[::step] for motion in motions])
    return roots, local


def _tallest(skeleton: Skeleton, frames: tuple[Array, Array]) -> GlobalPoses:
    """Return the poses in which the body is tallest: it may lie or crouch in others."""
    poses = place_joints(skeleton, *frames)
    heights = np.ptp(poses.positions[..., 1], axis=1)
    tall = heights >= np.quantile(heights, 1 - TALL)
    return GlobalPoses(poses.positions[tall], poses.matrices[tall])


def _flat_frames(heights: Array) -> Indices:
    """Return the frames in which a foot is flat, from the heights of its ankle and ball, (F, 2)."""
    mean_heights = heights.mean(axis=1)
    count = int(np.ceil(FLAT * len(mean_heights)))
    return np.argsort(mean_heights, kind="stable")[:count]


def _of_parents(skeleton: Skeleton, world: Array) -> Array:
    """Return the world rotation of each joint's parent, (J, 4); the identity for the root."""
    above = world[skeleton.parents]
    above[0] = rotations.IDENTITY
    return above


def _move_below(skeleton: Skeleton, top: int, world: Array, local: Array, *, kept: Sequence[int]) -> None:
    """Recompute the world rotations of the joints below a joint from their local rotations."""
    for joint in range(top + 1, len(skeleton)):
        if joint not in kept and top in skeleton.path_to_root(joint):
            world[joint] = rotations.multiply(world[skeleton.parents[joint]], local[joint])


def _rested(motion: Motion, world: Array) -> Motion:
    """Describe a motion by rotations from the pose in which joint j has the world rotation `world[j]`."""
    above = _of_parents(motion.skeleton, world)
    offsets = rotations.rotate(above, motion.skeleton.offsets)
    local = rotations.multiply(above, motion.rotations)
    local = rotations.multiply(local, rotations.inverse(world))
    # The axes of a file's angles are those of the old rest pose, and a .glb stores none.
    skeleton = replace(motion.skeleton, offsets=offsets, axes=np.empty((0, 4)), dofs=())
    return replace(motion, skeleton=skeleton, rotations=local)
