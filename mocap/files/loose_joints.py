"""Joints of a file that are no part of a body: a root that stays where it is, targets, swords, cameras.

Their distance from their parents changes, so that no rigid skeleton holds them. The body is the largest part
whose bones keep their lengths, if it has limbs. The method is ours.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.joint_trees import world_positions
from mocap.body.limb_pairs import LIMITS, limb_pairs
from mocap.body.limb_search import UP
from mocap.body.limb_tree import BodyTree, largest_part
from mocap.errors import shortened, warn
from mocap.files.bvh_hierarchy import Joint

LOOSE = 0.02  # metres: if no bone changes its length by more, all joints are part of the body
STRETCHED = 0.5  # of a bone's usual length: a bone that changes by less is stretched, and not loose
SHOWN = 4  # joints that the warning names


def without_loose_joints(
    path: str | Path, joints: Sequence[Joint], positions: Array, local: Array
) -> tuple[list[Joint], Array, Array]:
    """Leave out the joints that are no part of the body.

    Parameters
    ----------
    path : the file, for the warning.
    joints : J joints of a hierarchy.
    positions : in the parents' frames, (F, J, 3), metres; of the root in the world.
    local : rotations relative to the parents, (F, J, 4).

    Returns
    -------
    The same for the joints of the body, of which the first is the root. Without limbs, or if all joints are
    part of one body, what was given.

    Warns
    -----
    MocapWarning : with the joints that are left out.
    """
    if not np.ptp(positions[:, 1:], axis=0).any():
        return list(joints), positions, local
    lengths = np.linalg.norm(positions[:, 1:], axis=-1)
    if not (np.ptp(lengths, axis=0) > LOOSE).any():
        return list(joints), positions, local
    frames = np.linspace(0, len(positions) - 1, min(len(positions), LIMITS.frames)).astype(int)
    parents = np.array([joint.parent for joint in joints])
    world = world_positions(parents, positions[frames], local[frames])
    body = largest_part(parents, world)
    is_body = limb_pairs(BodyTree(parents, world, UP)) and not _is_stretched(parents, lengths, body)
    if len(body) == len(joints) or not is_body:
        return list(joints), positions, local
    root_positions, root_rotations = _pose_in_world(joints, positions, local, body[0])
    positions = positions[:, body].copy()
    positions[:, 0] = root_positions
    local = local[:, body].copy()
    local[:, 0] = root_rotations
    kept = [replace(joints[body[0]], parent=-1)]
    kept += [replace(joints[joint], parent=body.index(joints[joint].parent)) for joint in body[1:]]
    names = [shortened(joint.name, 30) for index, joint in enumerate(joints) if index not in body]
    hidden = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    warn(f"{path}: left out what moves apart from the body: {', '.join(names[:SHOWN])}{hidden}.")
    return kept, positions, local


def _is_stretched(parents: Array, lengths: Array, body: Sequence[int]) -> bool:
    """Tell whether a joint that hangs on the body is part of it, but for a bone that stretches.

    `lengths` (F, J - 1) are those of all bones but the root's.
    """
    hanging = [joint - 1 for joint, parent in enumerate(parents) if parent in body and joint not in body]
    changes = np.ptp(lengths[:, hanging], axis=0)
    return bool((changes < STRETCHED * np.median(lengths[:, hanging], axis=0)).any())


def _pose_in_world(
    joints: Sequence[Joint], positions: Array, local: Array, joint: int
) -> tuple[Array, Array]:
    """Return the position (F, 3) and the rotation (F, 4) of one joint in the world."""
    position = positions[:, joint]
    rotation = local[:, joint]
    parent = joints[joint].parent
    while parent >= 0:
        position = positions[:, parent] + rotations.rotate(local[:, parent], position)
        rotation = rotations.multiply(local[:, parent], rotation)
        parent = joints[parent].parent
    return position, rotation
