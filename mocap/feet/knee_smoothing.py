"""Knees that jolt no more than they did: what a clean-up adds is smoothed where it would show.

Captured hips tremble by a millimetre. While the foot trembled with them the knee hardly moved. Now that the
foot stands still, a knee that is nearly straight makes a centimetre of the millimetre: knee popping.
"""

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.leg_track import UP, LegTrack, bend_and_swing

# Percent of a clip's own frames: what all but one in a thousand stay below is no jolt. With 99 captured
# walks lose 2 % of their planted frames; with 100 their knees accelerate by 3 % more (99.9 % of the
# frames).
USUAL = 99.9

# At most: in each, a knee's path is taken as linear in the changes. 5 or 20 give the same on the four sets.
PASSES = 10

# Of the bound: what a pass aims at, for it does not quite meet its aim. With 1 walks keep 99.1 % of their
# planted frames instead of 99.8 %.
AIM = 0.99

# How much other accelerations count, where one that jolts counts 1, and how much the changes themselves
# count. Half or twice as much changes the knees' accelerations (99.9 % of the frames) by less than 0.1 %.
QUIET = 0.1
NEAR = 0.03

STEP = 1e-4  # metres, for slopes; half or twice as much makes no difference

# Metres per frame²: what rotations lose of a pose. With 0 a clean clip would be changed by half a
# millimetre.
LOST_IN_POSES = 1e-7


def smooth_knees(
    tracks: Sequence[LegTrack], targets: Sequence[FootTarget], rise: Array
) -> tuple[list[FootTarget], Array, Array]:
    """Change the root's rise, and the targets of feet in the air, so that no knee jolts more than it did.

    A knee jolts where its acceleration is larger than it was in that frame, and larger than what 99.9 % of
    the knees' accelerations were. There the second differences of its path, which are linear in small
    changes x, must fall to that bound. Least squares over them, over all others with a tenth of the weight,
    and over x itself gives x. Where no knee jolts, nothing changes.

    Parameters
    ----------
    tracks : the legs in F frames.
    targets : where each leg's ankle must be.
    rise : how far the root has risen, shape (F,), metres.

    Returns
    -------
    The new targets and the new rise, and by what share of its bound the worst knee still jolts, (F,).
    """
    if len(rise) < 3:
        return list(targets), rise, np.zeros(len(rise))
    legs = list(zip(tracks, targets, strict=True))
    free = np.array([np.ones(len(rise), bool), *(~target.planted for target in targets)])  # (1 + L, F)
    # How far the root may rise for planted feet to be reached, and how large each second difference may be.
    ceiling = np.min(
        [np.where(t.planted, leg.highest(t.ankle, leg.reach), np.inf) for leg, t in legs], axis=0
    )
    own = np.linalg.norm(np.diff([track.knee for track in tracks], 2, axis=1), axis=-1)  # (L, F - 2)
    bound = np.maximum(np.percentile(own, USUAL, method="lower"), own) + LOST_IN_POSES
    change = np.zeros(free.shape)  # of the root's rise, and of the way that each ankle goes to its hip
    for left in reversed(range(PASSES)):
        risen, shifts = rise + change[0], change[1:]
        knees = np.stack([_knee(*leg, risen, shift) for leg, shift in zip(legs, shifts, strict=True)])
        sizes = np.linalg.norm(np.diff(knees, 2, axis=1), axis=-1)
        if not left or not np.any(sizes > bound):
            break
        excess = np.where(sizes > bound, 1 - AIM * bound / np.maximum(sizes, bound), 0.0)
        slopes = np.zeros((len(free), *knees.shape))  # how far each knee moves for each change
        for n, (leg, shift) in enumerate(zip(legs, shifts, strict=True)):
            slopes[0, n] = (knees[n] - _knee(*leg, risen - STEP, shift)) / STEP
            slopes[1 + n, n] = (_knee(*leg, risen, shift + STEP) - knees[n]) / STEP
        change += _solve_changes(knees, slopes * free[:, None, :, None], excess, change)
        change[0] = np.minimum(rise + change[0], ceiling) - rise
    moved = [leg[1]._replace(ankle=_ankle(*leg, shift)) for leg, shift in zip(legs, change[1:], strict=True)]
    return moved, rise + change[0], np.pad((sizes / bound).max(axis=0) - 1, 1, constant_values=-1.0)


def _ankle(track: LegTrack, target: FootTarget, shift: Array) -> Array:
    """Move an ankle's target towards the hip by `shift` (F,), metres."""
    inward = track.hip - target.ankle
    inward = inward / np.linalg.norm(inward, axis=-1, keepdims=True)
    return np.asarray(target.ankle + shift[:, None] * inward)


def _knee(track: LegTrack, target: FootTarget, rise: Array, shift: Array) -> Array:
    """Find the knee, (F, 3), when the root has risen and the ankle's target is shifted."""
    hip = track.hip + rise[:, None] * UP
    swing = bend_and_swing(track, _ankle(track, target, shift) - hip)[1]
    return np.asarray(hip + rotations.rotate(swing, track.knee - track.hip))


def _solve_changes(knees: Array, slopes: Array, excess: Array, change: Array) -> Array:
    """Solve for changes (1 + L, F) that take the share `excess` (L, F - 2) off the knees' accelerations."""
    (kinds, frames), axes = change.shape, [*np.ndindex(len(knees), 3)]
    second = sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(frames - 2, frames))
    # A block for each coordinate of a knee and each kind of change: its second differences, for each change.
    blocks = [[second @ sparse.diags(slopes[kind, n, :, c]) for kind in range(kinds)] for n, c in axes]
    bends = sparse.bmat(blocks, format="csr")
    bends.eliminate_zeros()
    weight = np.where(excess > 0, 1.0, QUIET).repeat(3, axis=0).ravel()
    aim = -(excess[..., None] * np.diff(knees, 2, axis=1)).swapaxes(1, 2).ravel()
    cost = bends.T @ sparse.diags(weight) @ bends + NEAR * sparse.identity(change.size)
    pull = bends.T @ (weight * aim) - NEAR * change.ravel()
    return np.asarray(sparse.linalg.spsolve(cost.tocsc(), pull)).reshape(kinds, frames)
