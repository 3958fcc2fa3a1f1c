"""Rigid bones for a file whose joints move in their parents' frames.

Some programs write six channels for every joint, with bones that stretch by a few millimetres. Readers that
ignore these translations displace all joints below. Here each bone gets its mean length, and each joint
rotates such that its children are as close as possible to their positions in the file. The method is ours. It
uses the polar decomposition of a sum of outer products.
"""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.files.tuned import TUNED

SHORTEST = 1e-9  # metres: a shorter mean offset has no direction


def fit(parents: NDArray[np.intp], positions: Array, local: Array) -> tuple[Array, Array, Array, Array]:
    r"""Fit rigid bones, from the root down.

    A bone gets its mean direction and mean length in its parent's frame. The global rotation R of a joint
    with children at offsets o maximises Σ d · R o + λ tr(Rᵀ G), where d is the vector from the joint to the
    position of the child in the file, and G the rotation of the joint in the file: R = U diag(1, 1, ±1) Vᵀ
    from the SVD of Σ d oᵀ + λ G.

    Parameters
    ----------
    parents : shape (J,), -1 for the root, each before its children.
    positions : shape (F, J, 3), metres: of each joint in its parent's frame, of the root in the world.
    local : shape (F, J, 4), quaternions relative to the parent's frame.

    Returns
    -------
    Offsets of the bones (J, 3), rotations (F, J, 4), the change of the length of each bone in the file (J,),
    and the largest distance of each joint from its position in the file (J,). Lengths are in metres.

    Examples
    --------
    A bone points up, then sideways. The joint at its start rotates, and the bone keeps its length:

    >>> moving = np.array([[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0]]], float)
    >>> offsets, _, stretch, _ = fit(np.array([-1, 0]), moving, np.tile(rotations.IDENTITY, (2, 2, 1)))
    >>> offsets[1].round(2), float(stretch.max())
    (array([0.71, 0.71, 0.  ]), 0.0)
    """
    offsets = _mean_offsets(positions)
    targets, file_rotations = _world_poses(parents, positions, local)
    joints = targets.copy()
    matrices = file_rotations.copy()
    for joint in range(len(parents)):
        children = np.flatnonzero(parents == joint)
        bones = offsets[children]
        squares = (bones**2).sum()
        if squares > 0:
            directions = targets[:, children] - joints[:, joint, None]
            outer_products = np.einsum("fci,cj->fij", directions, bones)
            rotation_term = TUNED.rotation_weight * squares * file_rotations[:, joint]
            matrices[:, joint] = rotations.nearest(outer_products + rotation_term)
        joints[:, children] = joints[:, joint, None] + np.einsum("fij,cj->fci", matrices[:, joint], bones)
    stretch = np.ptp(np.linalg.norm(positions, axis=-1), axis=0)
    stretch[0] = 0.0
    distances = np.linalg.norm(joints - targets, axis=-1).max(axis=0)
    return offsets, _local_rotations(parents, matrices), stretch, distances


def _mean_offsets(positions: Array) -> Array:
    """Compute offsets (J, 3) of mean direction and mean length over the frames, metres; 0 for the root."""
    lengths = np.linalg.norm(positions, axis=-1).mean(axis=0)
    means = positions.mean(axis=0)
    mean_lengths = np.linalg.norm(means, axis=-1)  # shorter than `lengths` if the direction varies
    ratios = np.where(mean_lengths > SHORTEST, lengths / np.maximum(mean_lengths, SHORTEST), 1.0)
    offsets: Array = means * ratios[:, None]
    offsets[0] = 0.0
    return offsets


def _world_poses(parents: NDArray[np.intp], positions: Array, local: Array) -> tuple[Array, Array]:
    """Compute positions (F, J, 3) and rotation matrices (F, J, 3, 3) in the world. Bones may stretch."""
    joints = positions.copy()
    matrices = rotations.to_matrix(local)
    for joint in range(1, len(parents)):
        parent = parents[joint]
        bone = np.einsum("fij,fj->fi", matrices[:, parent], positions[:, joint])
        joints[:, joint] = joints[:, parent] + bone
        matrices[:, joint] = matrices[:, parent] @ matrices[:, joint]
    return joints, matrices


def _local_rotations(parents: NDArray[np.intp], matrices: Array) -> Array:
    """Convert rotation matrices in the world to quaternions relative to the parents' frames, (F, J, 4)."""
    inverses = np.swapaxes(matrices[:, parents[1:]], -1, -2)  # of the parents
    local = np.concatenate([matrices[:, :1], inverses @ matrices[:, 1:]], axis=1)
    return rotations.from_matrix(local)
