"""The root's height and the knees that hold all plants and bend the least: step 3 of [KSG02].

While a foot stands, the root's height says how its knee is bent; a knee in the air may bend as it likes. So
the unknowns are the root's rise in each frame, and each knee's extra angle in each frame in the air. The best
are those whose corrections e, of the root and of each knee, are the least of

    Σ w |e_{f-1} - 2 e_f + e_{f+1}|² + κ⁴ Σ |e_f|²

over the whole clip: the sum of step 5. A planted knee's angle follows (step 4). They are found by damped
Gauss-Newton steps; what is unknown in a frame meets only its neighbours, so a step solves a banded system.
"""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_propagation, maximum_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.body import rotations
from mocap.feet.ankle_targets import FALL, FootTarget, band_product, bending_bands
from mocap.feet.leg_track import ROUNDING, UP, LegTrack

# Of the leg's length: 2 cm for a leg of 0.85 m. A plant that would move the root further is let go.
MOST = 0.0239

# Of the leg's length: 5 mm. A knee may jump by so much from one picture of a film (30 Hz) to the next beyond
# what is usual. Of a figure 400 pixels high that is less than one; four times as much is plain to see.
UNSEEN = 0.006
SHOWN = 1 / 30  # seconds between two pictures
USUAL = 99.9  # percent of a clip's own jumps: what all but one in a thousand stay below is no jolt

# Seconds in which a correction of the root and of knees dies away, 1 / κ. With 0.1 knees turn half as far
# again.
NEAR = 0.05

# How much a metre of the root counts, where a metre of a knee counts 1, and one beyond a bound 30, all
# squared. With 4 for the root knees turn by 3.6° instead of 2.6° (95 % of the frames of slow and straight
# legged walks); with 10 or 100 for bounds plants and jolts are the same.
ROOT, STIFF = 2.0, 30.0

# At most: solutions, each with what jolts counting double; steps in each; the gain of a step that is the last
# one. With 5 solutions twice as many captured clips lose plants. Each doubling comes only nearer to its aim,
# so that is a little less than `UNSEEN`.
TRIES, STEPS, GAIN, AIM = 10, 12, 1e-3, 0.9

STEP = 1e-5  # metres and radians, for slopes

Legs = Sequence[tuple[LegTrack, FootTarget]]


def hold_plants(
    tracks: Sequence[LegTrack], targets: Sequence[FootTarget]
) -> tuple[Array, list[Array], list[tuple[slice, Array]]]:
    """Find the smoothest correction that brings planted ankles to their targets.

    In the paper: [KSG02, step 3]. There the root moves in all directions, and step 4 may stretch the legs.

    What still goes beyond its bound counts double, and double again, so that the frames around it share it.
    And a knee that jumps too far is pushed back by as much, again and again (Lagrange multipliers).

    Parameters
    ----------
    tracks : the legs in F frames.
    targets : where each one's ankle must be; while it is in the air, the leg only points there.

    Returns
    -------
    The root's rise (F,), metres; each knee's angle (F,), radians; by how much plants go beyond bounds, and
    whose plants they are: the amount (F,) is above 0 where the root's rise is too large, a knee jumps too far
    from one picture of a film to the next, or a leg is too short.
    """
    legs = list(zip(tracks, targets, strict=True))
    frames, fps, length = len(targets[0].ankle), tracks[0].motion.fps, tracks[0].length
    change, stress = np.zeros((1 + len(legs), frames)), np.ones((1 + len(legs), frames))
    span, knees = max(1, round(SHOWN * fps)), slice(1, 1 + len(legs))
    own, push = np.array([track.knee for track in tracks]), np.zeros((2 + 2 * len(legs), frames, 3))
    usual = np.linalg.norm(_jumps(own, span), axis=-1)  # (L, F)
    usual = np.maximum(np.percentile(usual, USUAL, method="lower"), usual)
    for _ in range(TRIES):
        change = _least_bent(legs, stress, change, push)
        jumps = _jumps(own + _displacements(legs, change)[knees], span)
        beyond = (size := np.linalg.norm(jumps, axis=-1)) - usual  # than it did, and than is usual
        jolting = beyond > AIM * UNSEEN * length
        # Near a jolt the root may only go far to spare it, and near a plant out of reach it must.
        must = maximum_filter1d(jolting.any(axis=0) | (_highest(legs) < -MOST * length), 12 * span + 1)
        over = np.vstack([(abs(change[0]) > MOST * length) & ~must, jolting])
        if not over.any():
            break
        near = maximum_filter1d(over, 2 * span + 1, axis=1)
        stress *= np.where(near, 2.0, 1.0)
        # A push against a jump takes just so much off it, for a curve that bends freely.
        more = np.maximum(beyond, 0.0) / np.maximum(size, ROUNDING) / (span * (2 * span**2 + 1) / 3)
        push[knees] -= _jumps(more[..., None] * jumps, span)
        legs = [_bent_forwards(*leg, jolts) for leg, jolts in zip(legs, near[1:], strict=True)]
    poses = [_pose(*leg, change[0], extra) for leg, extra in zip(legs, change[1:], strict=True)]
    far, jolts = abs(change[0]) - MOST * length, beyond.max(axis=0) - UNSEEN * length
    excesses = [(slice(None), far), (slice(None), jolts)]
    for n, ((track, target), (_, wanted)) in enumerate(zip(legs, poses, strict=True)):
        lack = np.linalg.norm(wanted, axis=-1) - track.long(0.0) - ROUNDING
        excesses.append((slice(n, n + 1), np.where(target.planted, lack, -1.0)))
    return change[0], [bend for bend, _ in poses], [excess for excess in excesses if (excess[1] > 0).any()]


def _bent_forwards(track: LegTrack, target: FootTarget, jolts: Mask) -> tuple[LegTrack, FootTarget]:
    """Let a knee that jolts no longer be bent backwards, for the whole run of frames in which it was."""
    back = target.side < 0
    forwards = binary_propagation(back & jolts, mask=back)
    return track, target._replace(side=np.where(forwards, 1.0, target.side))


def _pose(track: LegTrack, target: FootTarget, rise: Array, extra: Array) -> tuple[Array, Array]:
    """Give the knee's angle (F,), radians, and the way from hip to ankle (F, 3), for a risen root."""
    wanted = target.ankle - track.hip - rise[:, None] * UP
    held = target.side * track.bend(np.linalg.norm(wanted, axis=-1))
    return np.where(target.planted, held, track.own + extra), wanted


def _highest(legs: Legs) -> Array:
    """Give the highest rise of the root at which all planted legs still reach, (F,), metres."""
    return np.asarray(np.min([np.where(g.planted, t.highest(g.ankle), np.inf) for t, g in legs], axis=0))


def _displacements(legs: Legs, change: Array) -> Array:
    """Give how far root and knees are moved, then how far each is beyond its bound, (2 + 2 L, F, 3)."""
    rise, most = change[0][:, None] * UP, FALL * legs[0][0].length
    moved, beyond = [ROOT * rise], [rise - np.clip(rise, -most, most)]
    for (track, target), extra in zip(legs, change[1:], strict=True):
        bend, wanted = _pose(track, target, change[0], extra)
        knee = rise + track.hip + rotations.rotate(track.turns(bend, wanted)[1], track.knee - track.hip)
        moved.append(knee - track.knee)
        lack = np.maximum(np.linalg.norm(wanted, axis=-1) - track.limit, 0.0)
        beyond.append(np.where(target.planted, lack, 0.0)[:, None] * UP)
    return np.array(moved + beyond)


def _least_bent(legs: Legs, stress: Array, change: Array, push: Array) -> Array:
    """Improve a change (1 + L, F) of the root's rise and of the knees' angles in the air.

    `stress` (1 + L, F) says how much the root's bound and each knee's acceleration count in each frame,
    `push` (2 + 2 L, F, 3) which way all displacements are pushed.
    """
    near = (NEAR * legs[0][0].motion.fps) ** -4.0
    ones = np.ones_like(change[1:])
    bending = [bending_bands(weight, near) for weight in (ones[0], *stress[1:])]
    bounds = [bending_bands(0 * weight, STIFF**2 * near * weight) for weight in (stress[0], *ones)]
    bands = np.array([*bending, *bounds])
    top = _highest(legs)
    change = np.vstack([np.minimum(change[0], top), change[1:]])
    here, damping = _displacements(legs, change), 1e-3
    for _ in range(STEPS):
        lower = [_displacements(legs, change - STEP * row[:, None]) for row in np.eye(len(change))]
        pull = band_product(bands, here) - push
        tried = change - _gauss_newton((here - np.array(lower)) / STEP, bands, pull, damping)
        tried[0] = np.minimum(tried[0], top)
        there = _displacements(legs, tried)
        cost, less = (here * (pull - push)).sum(), (there * (band_product(bands, there) - 2 * push)).sum()
        damping *= 0.2 if less < cost else 10.0
        if less < cost:
            change, here = tried, there
        if 0 <= cost - less <= GAIN * abs(cost):
            break
    return change


def _gauss_newton(slopes: Array, bands: Array, pull: Array, damping: float) -> Array:
    """Solve (Σ Sᵀ B S + damping · diagonal) x = Σ Sᵀ pull for a step x, (K, F).

    Parameters
    ----------
    slopes : S, how far each of M rows moves for each of K unknowns, (K, M, F, 3).
    bands : B, a symmetric matrix for each row by its three lower diagonals, (M, 3, F).
    pull : B times what the rows are now, (M, F, 3).
    """
    kinds, _, frames, _ = slopes.shape
    # The unknowns of a frame stand side by side, so the whole has 3 K lower diagonals.
    whole = np.zeros((3 * kinds, frames, kinds))
    for later, one, other in np.ndindex(3, kinds, kinds):
        if (row := later * kinds + other - one) >= 0:
            then = np.roll(slopes[other], -later, axis=1)
            whole[row, :, one] = np.einsum("mf,mfc,mfc->f", bands[:, later], slopes[one], then)
    # Where nothing depends on an unknown, as on a planted knee's extra angle, the step is 0.
    whole[0] += damping * whole[0] + 1e-9 * whole[0].max() + np.finfo(float).tiny
    target = np.einsum("kmfc,mfc->fk", slopes, pull).ravel()
    step = solveh_banded(whole.reshape(3 * kinds, -1), target, lower=True)
    return np.asarray(step.reshape(frames, kinds).T)


def _jumps(curves: Array, span: int) -> Array:
    """Give the second differences over `span` frames of curves (L, F, 3), 0 near their ends."""
    jumps = np.zeros_like(curves)
    ahead, behind = curves[:, 2 * span :], curves[:, : -2 * span]
    jumps[:, span:-span] = ahead - 2 * curves[:, span:-span] + behind
    return jumps
