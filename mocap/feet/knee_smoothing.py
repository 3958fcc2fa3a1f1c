"""Knees that jolt no more than they did: what a clean-up adds is eased where it would show.

Captured hips tremble by a millimetre. While the foot trembled with them the knee did not mind; now that the
foot stands still, a knee that is nearly straight makes a centimetre of the millimetre.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import sparse

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses
from mocap.body.limbs import Leg
from mocap.body.motion import Motion
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.leg_ik import KneeHinge, bend_and_swing, knee_hinge

USUAL = 99.9  # percent: all but one frame in a thousand
PASSES = 10  # in each a knee's path is linear in what is changed
AIM = 0.99  # of the bound, for what is aimed at is not quite met
QUIET = 0.1  # how much the jolts count that are usual already, and those of feet in the air
NEAR = 0.03  # how much the changes themselves count
STEP = 1e-4  # metres, for slopes
ROUNDING = 1e-7  # metres: what poses written as rotations lose
UP = np.array([0.0, 1.0, 0.0])


class _Limb(NamedTuple):
    """A leg over F frames: its hinge, hip and bones, and its ankle's target with the way inwards."""

    hinge: KneeHinge
    hip: Array
    bones: tuple[Array, Array]
    ankle: Array
    inward: Array

    def knee(self, rise: Array, shift: Array) -> Array:
        """Find the knee, (F, 3), when the root has risen and the ankle is shifted towards the hip."""
        hip = self.hip + rise[:, None] * UP
        wanted = self.ankle + shift[:, None] * self.inward - hip
        swing = bend_and_swing(self.hinge, self.bones, wanted)[1]
        return np.asarray(hip + rotations.rotate(swing, self.bones[0]))

    def ceiling(self, planted: Mask) -> Array:
        """How far the root may rise at most, (F,), metres, for the leg to reach where it is planted."""
        apart = self.hip - self.ankle
        level = apart[:, 0] ** 2 + apart[:, 2] ** 2
        highest = np.sqrt(np.maximum(self.hinge.reach**2 - level, 0.0)) - apart[:, 1]
        return np.where(planted, highest, np.inf)


def smooth_knees(
    motion: Motion, legs: Sequence[Leg], poses: GlobalPoses, targets: Sequence[FootTarget], rise: Array
) -> tuple[Array, list[FootTarget], Array]:
    """Change the root's rise, and the targets of feet in the air, so that no knee jolts more than it did.

    A knee jolts where its acceleration is larger than it was in that frame and than what 99.9 % of the knees'
    accelerations were. There the second differences of its path, linear in the changes x, shall fall
    to that bound; least squares over them, over all others with a tenth of the weight, and over x itself.
    Where no knee jolts nothing changes.

    Parameters
    ----------
    motion, legs, poses : the motion, its legs and its poses before.
    targets : where each leg's ankle shall be.
    rise : how far the root has risen, shape (F,), metres.

    Returns
    -------
    The rise and the targets anew, and by what share of its bound the worst knee still jolts, (F,).
    """
    if len(motion) < 3:
        return rise, list(targets), np.zeros(len(motion))
    limbs = [_limb(motion, *pair, poses) for pair in zip(legs, targets, strict=True)]
    ceiling = np.min([limb.ceiling(target.planted) for limb, target in zip(limbs, targets, strict=True)], 0)
    free = np.array([np.ones(len(motion), bool), *(~target.planted for target in targets)])  # (1 + L, F)
    own = np.linalg.norm(np.diff(poses.positions[:, [leg.knee for leg in legs]], 2, axis=0), axis=-1).T
    bound = np.maximum(np.percentile(own, USUAL, method="lower"), own) + ROUNDING  # (L, F - 2)
    change = np.zeros(free.shape)
    for left in reversed(range(PASSES)):
        knees = np.stack([limb.knee(rise + change[0], x) for limb, x in zip(limbs, change[1:], strict=True)])
        sizes = np.linalg.norm(np.diff(knees, 2, axis=1), axis=-1)
        if not left or not np.any(sizes > bound):
            break
        excess = np.where(sizes > bound, 1 - AIM * bound / np.maximum(sizes, bound), 0.0)
        slopes = _slopes(limbs, knees, rise, change) * free[:, None, :, None]
        change += _eased(knees, slopes, excess, change)
        change[0] = np.minimum(rise + change[0], ceiling) - rise
    moved = [
        target._replace(ankle=limb.ankle + x[:, None] * limb.inward)
        for target, limb, x in zip(targets, limbs, change[1:], strict=True)
    ]
    return rise + change[0], moved, np.pad((sizes / bound).max(axis=0) - 1, 1, constant_values=-1.0)


def _limb(motion: Motion, leg: Leg, target: FootTarget, poses: GlobalPoses) -> _Limb:
    hip, knee, ankle = (poses.positions[:, joint] for joint in leg[:3])
    hinge = knee_hinge(leg, poses, motion.skeleton.names[leg.knee])
    inward = hip - target.ankle
    inward = inward / np.linalg.norm(inward, axis=-1, keepdims=True)
    return _Limb(hinge, hip, (knee - hip, ankle - knee), target.ankle, inward)


def _slopes(limbs: Sequence[_Limb], knees: Array, rise: Array, change: Array) -> Array:
    """Measure how far each knee moves for each change, shape (1 + L, L, F, 3): the rise, then the ankles."""
    slopes = np.zeros((1 + len(limbs), *knees.shape))
    for n, limb in enumerate(limbs):
        lower = limb.knee(rise + change[0] - STEP, change[1 + n])
        inner = limb.knee(rise + change[0], change[1 + n] + STEP)
        slopes[0, n], slopes[1 + n, n] = (knees[n] - lower) / STEP, (inner - knees[n]) / STEP
    return slopes


def _eased(knees: Array, slopes: Array, excess: Array, change: Array) -> Array:
    """Solve for the changes (1 + L, F) that take off the share `excess` (L, F - 2) of the knees' jolts."""
    kinds, frames = change.shape
    windows = sliding_window_view(slopes, 3, axis=2) * [1.0, -2.0, 1.0]  # (1 + L, L, F - 2, 3, 3 frames)
    kind, _, frame, _, tap = np.ogrid[tuple(map(slice, windows.shape))]
    column = np.broadcast_to(kind * frames + frame + tap, windows.shape)
    row = np.broadcast_to(
        np.arange(windows[0, ..., 0].size).reshape(windows[0, ..., :1].shape), windows.shape
    )
    entries = windows != 0
    places = (row[entries], column[entries])
    bends = sparse.csr_matrix((windows[entries], places), shape=(row.max() + 1, change.size))
    weight = np.where(excess > 0, 1.0, QUIET)[..., None] * np.ones(3)
    aim = -excess[..., None] * np.diff(knees, 2, axis=1)
    cost = bends.T @ sparse.diags(weight.ravel()) @ bends + NEAR * sparse.identity(change.size)
    pull = bends.T @ (weight * aim).ravel() - NEAR * change.ravel()
    return np.asarray(sparse.linalg.spsolve(cost.tocsc(), pull)).reshape(kinds, frames)
