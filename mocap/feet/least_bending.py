"""The root's height and the knees that hold all plants and bend the least: step 3 of [KSG02].

While an ankle stands, the root's height says how its knee is bent. While only the ball stands, the knee may
bend as it likes, and the foot turns about the ball; and so may a knee in the air. So the unknowns are the
root's rise in each frame, and each knee's extra angle in each frame in which its ankle does not stand. The
best are those whose corrections e, of the root and of each knee and ankle, are the least of

    Σ |e_{f-1} - 2 e_f + e_{f+1}|² + κ⁴ Σ |e_f|²

over the whole clip: the sum of step 5. The root's rise has a bound, and so has each knee's jump from one
picture of a film to the next. They are found by damped Gauss-Newton steps, which hold the root at its bound,
and by multipliers for the jumps (an augmented Lagrangian). What is unknown in a frame meets only its
neighbours, so a step solves a banded system.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_propagation, maximum_filter1d

from mocap._shared.arrays import Array, Mask
from mocap.feet.ankle_targets import FLAT, FootTarget, band_product, bending_bands
from mocap.feet.leg_track import ROUNDING, UP, dot

# Of the leg's length: 2 cm for a leg of 0.85 m. The root rises or falls by no more.
MOST = 0.0235

# Of the leg's length: 5 mm. A knee may jump by so much from one picture of a film (30 Hz) to the next beyond
# what is usual. Of a figure 400 pixels high that is less than one; four times as much is plain to see.
UNSEEN = 0.006
SHOWN = 1 / 30  # seconds between two pictures
USUAL = 99.9  # percent of a clip's own jumps: what all but one in a thousand stay below is no jolt

# Seconds in which a correction of the root and of knees dies away, 1 / κ. With 0.05 eight walks slowed to a
# quarter accelerate by 1.21 to 1.45 times as much as they did; with 0.1 knees turn by a tenth further, and
# what is a second away is changed by some micrometres.
NEAR = 0.075

# How much a metre of the root and of an ankle counts, where a metre of a knee counts 1, one that a leg lacks
# 30, and one that a knee jumps too far √10, for a curve that bends freely, all squared. With 4 for the root
# knees turn by 3.6° instead of 2.6° (95 % of the frames of slow and straight-legged walks); with 0.5 for
# ankles a straight-legged stop at 120 Hz accelerates by 1.22 times as much as it did, with 1.5 by 1.18. Jumps
# count twice as much in each solution; else a straight-legged run lets go of a tenth of its planted frames.
ROOT, FOOT, STIFF, HARD, HARDER = 2.0, 1.5, 30.0, 10.0, 2.0

# At most: solutions, each with new multipliers; steps in each; the gain of a step that is the last one. With
# 20 solutions a slow walk accelerates by 2.2 times as much as it did; with 12 steps a stand on straight legs
# by 1.8 times. The multipliers come only nearer to their aim, so that is a little less than `UNSEEN`.
TRIES, STEPS, GAIN, AIM = 10, 20, 1e-3, 0.9

STEP = 1e-5  # metres and radians, for slopes

Pose = tuple[Array, Array]  # a knee's angle (..., F), radians, and the way from hip to ankle (..., F, 3)
Excess = tuple[slice, Array]  # of which legs, and by how much their plants go beyond bounds, (F,)


def hold_plants(targets: Sequence[FootTarget]) -> tuple[Array, list[FootTarget], list[Pose], list[Excess]]:
    """Find the smoothest correction that brings planted ankles to their targets.

    In the paper: [KSG02, step 3]. There the root moves in all directions, and step 4 may stretch the legs.

    A knee that still jumps too far is pushed back by as much, again and again (an augmented Lagrangian), and
    is no longer bent backwards there.

    Parameters
    ----------
    targets : where each leg's ankle must be in F frames. While it is in the air, the leg only points there;
        while only the ball stands, the foot turns about it.

    Returns
    -------
    The root's rise (F,), metres; the targets over which feet have rolled; each knee's angle (F,), radians,
    with the way from hip to ankle (F, 3), metres; by how much plants go beyond bounds, and whose plants they
    are: the amount (F,) is above 0 where the root's rise is too large, a knee jumps too far from one picture
    of a film to the next, or a leg is too short.
    """
    tracks = [target.track for target in targets]
    span, own = max(1, round(SHOWN * tracks[0].motion.fps)), np.array([track.knee.T for track in tracks])
    change, length = np.zeros((1 + len(tracks), own.shape[-1])), tracks[0].length
    usual, push = np.linalg.norm(_jumps(own, span), axis=1), np.zeros_like(own)
    usual = np.maximum(np.percentile(usual, USUAL, method="lower"), usual)  # (L, F)
    most = usual + AIM * UNSEEN * length
    for hard in HARD * HARDER ** np.arange(TRIES):
        change = _least_bent(targets, change, push, most, (span, hard))
        poses = [_pose(target, change[0], extra) for target, extra in zip(targets, change[1:], strict=True)]
        ends = [way + change[0][:, None] * UP for _, way in poses]
        targets = [target.led(target.track.hip + end) for target, end in zip(targets, ends, strict=True)]
        jumps = _jumps(own + _knees(_displacements(targets, change)), span)
        beyond = np.linalg.norm(jumps, axis=1) - usual  # than it did, and than is usual
        if not (jolting := beyond > UNSEEN * length).any():
            break
        push = _beyond(jumps + push, most) / HARDER
        near = maximum_filter1d(jolting, 2 * span + 1, axis=1)
        targets = [_eased(target, jolts) for target, jolts in zip(targets, near, strict=True)]
    poses = [_pose(target, change[0], extra) for target, extra in zip(targets, change[1:], strict=True)]
    excesses = [(slice(None), abs(change[0]) - MOST * length - ROUNDING)]
    excesses += [(slice(None), beyond.max(axis=0) - UNSEEN * length)]
    for n, (target, (_, wanted)) in enumerate(zip(targets, poses, strict=True)):
        lack = np.linalg.norm(wanted, axis=1) - target.track.long(0.0) - ROUNDING
        excesses.append((slice(n, n + 1), np.where(target.planted, lack, -1.0)))
    return change[0], list(targets), poses, [excess for excess in excesses if (excess[1] > 0).any()]


def _eased(target: FootTarget, jolts: Mask) -> FootTarget:
    """Let a knee that jolts no longer be bent backwards in the run of frames in which it was."""
    back = target.side == -1
    return target._replace(side=np.where(binary_propagation(back & jolts, mask=back), 1.0, target.side))


def _pose(target: FootTarget, rise: Array, extra: Array) -> Pose:
    """Give the knee's angle (..., F), radians, and the way from hip to ankle (..., F, 3) of a risen root."""
    track, free = target.track, target.track.own + extra
    hip = track.hip + rise[..., None] * UP
    wanted, rolls = target.ankle - hip, target.rolls
    wanted[..., rolls, :] = target.rolled(hip[..., rolls, :], track.long(free)[..., rolls])
    held = track.bend(np.sqrt(dot(wanted, wanted)))
    held *= np.where(rolls, np.copysign(1.0, free), target.side)
    return np.where(target.planted, held, free), wanted


def _bounds(targets: Sequence[FootTarget]) -> tuple[Array, Array]:
    """Give how far the root may fall and rise for all planted legs to reach, (F,) each, metres."""
    most, every = MOST * targets[0].track.length, []
    for target in targets:
        foot = (np.linalg.norm(target.places[1] - target.ankle, axis=1) - FLAT) * target.rolls
        place = np.where(target.rolls[:, None], target.places[1], target.ankle)
        every.append(np.where(target.planted, target.track.rises(place, foot), [[-most], [most]]))
    # Where one leg asks for a lower root than another or than the bound, the lower one counts.
    top = np.minimum(np.min(every, axis=0)[1], most)
    return np.minimum(np.maximum(np.max(every, axis=0)[0], -most), top), top


def _displacements(targets: Sequence[FootTarget], change: Array) -> Array:
    """Give how far the root and each knee and ankle are moved, and what each leg lacks, (1 + 7 L, F).

    The rows are the root's height, and for each leg three of its knee, three of its ankle, and its lack.
    """
    legs = [_leg(target, change[0], extra) for target, extra in zip(targets, change[1:], strict=True)]
    return np.concatenate([ROOT * change[:1], *legs])


def _slopes(targets: Sequence[FootTarget], change: Array, here: Array) -> Array:
    """Give how fast all that is displaced `here` (1 + 7 L, F) goes with each unknown, (1 + L, 1 + 7 L, F)."""
    slopes = np.zeros((len(change), *here.shape))
    slopes[0, 0] = ROOT
    for leg, target in enumerate(targets, 1):
        rows = slice(7 * leg - 6, 7 * leg + 1)
        lower = _leg(target, change[0] - [[STEP], [0.0]], change[leg] - [[0.0], [STEP]])
        slopes[[0, leg], rows] = (here[rows] - lower) / STEP
    return slopes


def _leg(target: FootTarget, rise: Array, extra: Array) -> Array:
    """Give a leg's rows of the displacements, (..., 7, F).

    While the foot rolls, the leg also lacks what the knee's angle asks for, where no triangle is as long.
    """
    track, (bend, wanted) = target.track, _pose(target, rise, extra)
    far, root = np.sqrt(dot(wanted, wanted)), rise[..., None] * UP
    knee = root + track.thigh(bend, wanted) - (track.knee - track.hip)
    long = np.where(target.planted, 1.0, track.long(bend) / far)
    ankle = root + long[..., None] * wanted - (track.ankle - track.hip)
    lack = target.planted * np.maximum(far - target.reach, 0.0)
    lack += target.rolls * np.abs(far - track.long(track.own + extra))
    return np.moveaxis(np.concatenate([knee, FOOT * ankle, lack[..., None]], axis=-1), -1, -2)


def _knees(rows: Array) -> Array:
    """Take the knees' part of all rows (..., 1 + 7 L, F): (..., L, 3, F)."""
    *others, _, frames = rows.shape
    return rows[..., 1:, :].reshape(*others, -1, 7, frames)[..., :3, :]


def _least_bent(
    targets: Sequence[FootTarget], change: Array, push: Array, most: Array, jolts: tuple[int, float]
) -> Array:
    """Improve a change (1 + L, F) of the root's rise and of the knees' angles where ankles do not stand.

    Knees jump by at most `most` (L, F), as soon as their multipliers `push` (L, 3, F) are found. `jolts` are
    over how many frames, and how much one counts.
    """
    track, legs, (span, hard) = targets[0].track, len(targets), jolts
    hard /= span * (2 * span**2 + 1) / 3  # a free curve jumps so much less for a push of 1
    near = (NEAR * track.motion.fps) ** -4.0
    bands = np.repeat([bending_bands(np.ones_like(change[0]), near)], 1 + 7 * legs, axis=0)
    bands[7::7] = bending_bands(0 * change[0], STIFF**2 * near)
    own = _jumps(np.array([target.track.knee.T for target in targets]), span) + push
    weighed = partial(_weighed, targets, bands, (own, most, span, hard))
    bottom, top = _bounds(targets)
    change = np.array([np.clip(change[0], bottom, top), *change[1:]])
    (here, pull, over, cost), damping = weighed(change), 1e-3
    slopes = _slopes(targets, change, here)
    for _ in range(STEPS):
        target = np.einsum("kmf,mf->kf", slopes, pull)
        # A root at its bound stays there if it is pulled beyond.
        held = (change[0] >= top) & (target[0] < 0) | (change[0] <= bottom) & (target[0] > 0)
        terms = [(slopes, bands, 1)]
        if over.any():
            ties = np.repeat([bending_bands(hard * row.any(axis=0), 0.0, span) for row in over], 3, axis=0)
            terms.append((_knees(slopes).reshape(1 + legs, 3 * legs, -1), ties, span))
        tried = change - _gauss_newton(terms, target, damping, held)
        tried[0] = np.clip(tried[0], bottom, top)
        there, *rest, less = weighed(tried)
        gain = cost - less
        damping *= 0.2 if gain > 0 else 10.0
        if gain > 0:
            change, here, (pull, over), cost = tried, there, rest, less
        if 0 <= gain <= GAIN * abs(cost):
            break
        slopes = _slopes(targets, change, here) if gain > 0 else slopes
    return change


def _weighed(
    targets: Sequence[FootTarget], bands: Array, bounds: tuple[Array, Array, int, float], change: Array
) -> tuple[Array, Array, Array, float]:
    """Give how far all is moved, how hard it is pulled back, by how much knees jump too far, and the sum."""
    (own, most, span, hard), moved = bounds, _displacements(targets, change)
    pull, over = band_product(bands, moved), _beyond(own + _jumps(_knees(moved), span), most)
    cost = (moved * pull).sum() + hard * (over**2).sum()
    wide = np.pad(over, [(0, 0), (0, 0), (span, span)])  # curves are 0 before and after
    _knees(pull)[:] += hard * _jumps(wide, span)[..., span:-span]
    return moved, pull, over, float(cost)


def _gauss_newton(
    terms: Sequence[tuple[Array, Array, int]], target: Array, damping: float, held: Mask
) -> Array:
    """Solve (Σ Sᵀ B S + damping · diagonal) x = target for a step x, (K, F).

    Parameters
    ----------
    terms : for each sum S, how far each of M rows moves for each of K unknowns, (K, M, F); B, a symmetric
        matrix for each row by three of its lower diagonals, (M, 3, F), and how many frames these are apart.
    target : (K, F).
    held : where the first unknown stays, (F,).
    """
    kinds, frames = target.shape
    # The unknowns of a frame stand side by side, so the whole has K lower diagonals for each frame.
    whole = np.zeros(((1 + 2 * max(span for *_, span in terms)) * kinds, frames, kinds))
    for slopes, bands, span in terms:
        for later in range(3):
            apart = later * span
            if apart >= frames:
                continue
            weighed = bands[:, later, : frames - apart] * slopes[..., : frames - apart]
            parts = np.einsum("kmf,lmf->klf", weighed, slopes[..., apart:])
            for one, other in np.ndindex(kinds, kinds):
                if (row := apart * kinds + other - one) >= 0:
                    whole[row, : frames - apart, one] += parts[one, other]
    # Where nothing depends on an unknown, as on a planted knee's extra angle, the step is 0.
    whole[0] += damping * whole[0] + 1e-9 * whole[0].max() + np.finfo(float).tiny
    whole[0, :, 0] += 1e9 * whole[0].max() * held
    step = solveh_banded(whole.reshape(len(whole), -1), target.T.ravel(), lower=True)
    return np.asarray(step.reshape(frames, kinds).T)


def _beyond(vectors: Array, most: Array) -> Array:
    """Give what vectors (..., 3, F) are longer than `most` (..., F)."""
    size = np.linalg.norm(vectors, axis=-2)
    return np.asarray(vectors * (np.maximum(size - most, 0.0) / np.maximum(size, ROUNDING))[..., None, :])


def _jumps(curves: Array, span: int) -> Array:
    """Give the second differences over `span` frames of curves (..., F), 0 near their ends."""
    jumps = np.zeros_like(curves)
    inner = curves[..., span : curves.shape[-1] - span]
    jumps[..., span : span + inner.shape[-1]] = curves[..., 2 * span :] - 2 * inner + curves[..., : -2 * span]
    return jumps
