"""Knees that jolt no more than they did: what a clean-up adds is smoothed where it would show.

Captured hips tremble by a millimetre. While the foot trembled with them the knee hardly moved. Now that the
foot stands still, a knee that is nearly straight makes a centimetre of the millimetre: knee popping.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import sparse

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.leg_ik import bend_and_swing
from mocap.feet.leg_track import UP, LegTrack

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


class Aimed(NamedTuple):
    """A leg, where its ankle must be, and the direction from there to the hip, (F, 3)."""

    track: LegTrack
    target: FootTarget
    inward: Array

    def ankle(self, shift: Array) -> Array:
        """Move the ankle's target towards the hip by `shift` (F,), metres."""
        return np.asarray(self.target.ankle + shift[:, None] * self.inward)

    def knee(self, rise: Array, shift: Array) -> Array:
        """Find the knee, (F, 3), when the root has risen and the ankle's target is shifted."""
        hip = self.track.hip + rise[:, None] * UP
        swing = bend_and_swing(self.track, self.ankle(shift) - hip)[1]
        return np.asarray(hip + rotations.rotate(swing, self.track.bones[0]))


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
    legs = [_aim(track, target) for track, target in zip(tracks, targets, strict=True)]
    free = np.array([np.ones(len(rise), bool), *(~target.planted for target in targets)])  # (1 + L, F)
    ceiling, bound = _ceiling(legs), _bound(tracks)
    change = np.zeros(free.shape)
    for left in reversed(range(PASSES)):
        knees = np.stack([leg.knee(rise + change[0], x) for leg, x in zip(legs, change[1:], strict=True)])
        sizes = np.linalg.norm(np.diff(knees, 2, axis=1), axis=-1)
        if not left or not np.any(sizes > bound):
            break
        excess = np.where(sizes > bound, 1 - AIM * bound / np.maximum(sizes, bound), 0.0)
        slopes = _slopes(legs, knees, rise, change) * free[:, None, :, None]
        change += _solve_changes(knees, slopes, excess, change)
        change[0] = np.minimum(rise + change[0], ceiling) - rise
    moved = [leg.target._replace(ankle=leg.ankle(x)) for leg, x in zip(legs, change[1:], strict=True)]
    return moved, rise + change[0], np.pad((sizes / bound).max(axis=0) - 1, 1, constant_values=-1.0)


def _aim(track: LegTrack, target: FootTarget) -> Aimed:
    """Add the direction from an ankle's target to its hip."""
    inward = track.hip - target.ankle
    return Aimed(track, target, inward / np.linalg.norm(inward, axis=-1, keepdims=True))


def _ceiling(legs: Sequence[Aimed]) -> Array:
    """Find how far the root may rise at most, (F,), metres, for planted feet to be reached."""
    highest = [
        np.where(target.planted, track.highest(target.ankle, track.hinge.reach), np.inf)
        for track, target, _ in legs
    ]
    return np.asarray(np.min(highest, axis=0))


def _bound(tracks: Sequence[LegTrack]) -> Array:
    """Measure how large each knee's second differences may be, shape (L, F - 2), metres."""
    own = np.linalg.norm(np.diff([track.knee for track in tracks], 2, axis=1), axis=-1)
    return np.asarray(np.maximum(np.percentile(own, USUAL, method="lower"), own) + LOST_IN_POSES)


def _slopes(legs: Sequence[Aimed], knees: Array, rise: Array, change: Array) -> Array:
    """Measure how far each knee moves for each change, shape (1 + L, L, F, 3): the rise, then the ankles."""
    slopes = np.zeros((1 + len(legs), *knees.shape))
    for n, leg in enumerate(legs):
        lower = leg.knee(rise + change[0] - STEP, change[1 + n])
        inner = leg.knee(rise + change[0], change[1 + n] + STEP)
        slopes[0, n], slopes[1 + n, n] = (knees[n] - lower) / STEP, (inner - knees[n]) / STEP
    return slopes


def _solve_changes(knees: Array, slopes: Array, excess: Array, change: Array) -> Array:
    """Solve for changes (1 + L, F) that take the share `excess` (L, F - 2) off the knees' accelerations."""
    kinds, frames = change.shape
    # A sparse matrix from all changes to all second differences: each row is a coordinate of a knee in a
    # frame, and depends on the changes in that frame and in the two next to it.
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
