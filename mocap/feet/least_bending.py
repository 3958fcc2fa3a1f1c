"""The hips and knees that hold all footplants with the smoothest correction: step 3 of [KSG02].

The unknowns of a frame are the root's rise, the list of the pelvis, and an additional angle of each knee. The
corrections e of the root, the pelvis, each knee and each ankle minimise

    Σ w² (|e_{f-1} - 2 e_f + e_{f+1}|² + κ⁴ |e_f|²)

over the clip: the sum of step 5, with a weight w and a duration 1 / κ for each kind of correction. While a
foot stands, the distance from hip to ankle and the angle of the knee must agree: the gap between the two is
a residual with a large weight, as is the angle by which a knee is too straight.

The angle of a knee has the largest weight of the corrections. The ankles of captured clips tremble by a
millimetre while they stand. The knee's angle does not, because the hip trembles with them. If the ankle is
held still, either the hip or the knee trembles, and near a straight leg a millimetre at the hip is several
degrees at the knee: knee popping. Therefore the hips take up what is fast, and the knees what is slow.

The minimum is found by damped Gauss-Newton steps, which keep root and pelvis within their bounds. The
unknowns of a frame depend only on its neighbours, so that each step solves a banded system.
"""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import NamedTuple
from mocap.feet.ankle_targets import FLAT, FootTarget, band_product, bending_bands
from mocap.feet.hip_heights import Pelvis
from mocap.feet.leg_track import ROUNDING, dot
from mocap.feet.tuned import TUNED

MOST = 0.0235  # of the leg's length, 2 cm for a leg of 0.85 m: the largest rise or fall of the root
MOST_LIST = np.radians(4.0)  # radians: the largest list of the pelvis, half of what it lists in a walk
UNSEEN = 0.006  # of the leg's length, 5 mm: a knee may jump by so much more than usual between two pictures
SHOWN = 1 / 30  # seconds between two pictures of a film
USUAL = 99.9  # percent of a clip's own jumps that count as usual
STEP = 1e-5  # metres and radians, for differences that approximate derivatives

DAMPING = 1e-3  # of the first step, a fraction of the diagonal
LESS_DAMPING = 0.2  # factor after a step that gains
MORE_DAMPING = 10.0  # factor after one that does not

# Rows of the unknowns: two of the body, then one for each leg. Corrections begin with the same two rows.
RISE = 0
LIST = 1
BODY = 2

# Rows of a leg's corrections
KNEE = slice(0, 3)
ANKLE = slice(3, 6)
ANGLE = 6
GAP = 7
STRAIGHT = 8
LEG = 9  # how many

Pose = tuple[Array, Array]  # a knee's angle (..., F), radians, and the vector from hip to ankle (..., F, 3)
Excess = tuple[slice, Array]  # of which legs, and by how much their plants exceed bounds, (F,)


class Held(NamedTuple):
    """A correction that holds the footplants.

    Parameters
    ----------
    rise : of the root, shape (F,), metres.
    angle : of the list of the pelvis, shape (F,), radians.
    targets : the targets over which feet have rolled.
    poses : of each leg, the angle of its knee (F,), radians, and the vector from hip to ankle (F, 3), metres.
    excesses : amounts (F,) and the legs whose plants they concern. An amount is positive where the root's
        rise is too large, a knee jumps too far from one picture of a film to the next, or a leg is too short.
    """

    rise: Array
    angle: Array
    targets: list[FootTarget]
    poses: list[Pose]
    excesses: list[Excess]

    @property
    def worst(self) -> float:
        """The largest excess, metres; 0 if there is none."""
        return max((float(amount.max()) for _, amount in self.excesses), default=0.0)


def hold_plants(targets: Sequence[FootTarget], pelvis: Pelvis) -> Held:
    """Find the smoothest correction that brings planted ankles to their targets.

    In the paper: [KSG02, step 3]. There the root moves in all directions, and step 4 may stretch the legs.

    Parameters
    ----------
    targets : where each leg's ankle must be in F frames. While it is in the air, the leg only points there;
        while only the ball stands, the foot rotates about it.
    pelvis : from which the legs hang.
    """
    change = _least_bent(targets, pelvis)
    solved = [_pose(target, pelvis, leg, change) for leg, target in enumerate(targets)]
    hips = [target.track.hip + _shift(pelvis, leg, change) for leg, target in enumerate(targets)]
    ankles = [hip + wanted for hip, (_, wanted) in zip(hips, solved, strict=True)]
    led = [target.led(ankle) for target, ankle in zip(targets, ankles, strict=True)]
    # The gap that is left, some micrometres, is closed: no leg is stretched.
    change[RISE] = np.clip(change[RISE], *_reach(led, pelvis, change))
    poses = []
    for leg, target in enumerate(led):
        free, wanted = _pose(target, pelvis, leg, change)
        closed = np.copysign(target.track.flexion_at(np.sqrt(dot(wanted, wanted))), free)
        bend = np.where(target.planted, closed, free)
        change[BODY + leg] = bend - target.track.flexion
        poses.append((bend, wanted))
    return Held(change[RISE], change[LIST], led, poses, _excesses(led, pelvis, change, poses))


def _excesses(
    targets: Sequence[FootTarget], pelvis: Pelvis, change: Array, poses: Sequence[Pose]
) -> list[Excess]:
    """Return where a correction exceeds the bounds of the root, the knees and the legs."""
    length = targets[0].track.length
    span = max(1, round(SHOWN * targets[0].track.motion.fps))
    knees = np.array([target.track.knee.T for target in targets])
    jumps = np.linalg.norm(_jumps(knees, span), axis=1)
    usual = np.maximum(np.percentile(jumps, USUAL, method="lower"), jumps)
    moved = np.array([_leg(target, pelvis, leg, change)[KNEE] for leg, target in enumerate(targets)])
    jolts = np.linalg.norm(_jumps(knees + moved / TUNED.knee, span), axis=1) - usual
    all_legs = slice(None)
    risen_too_far = np.abs(change[RISE]) - MOST * length - ROUNDING
    excesses = [(all_legs, risen_too_far), (all_legs, jolts.max(axis=0) - UNSEEN * length)]
    for leg, target in enumerate(targets):
        _, wanted = poses[leg]
        distance = np.sqrt(dot(wanted, wanted))
        missing = distance - target.track.reach(0.0) - ROUNDING
        excesses.append((slice(leg, leg + 1), np.where(target.planted, missing, -1.0)))
    return [excess for excess in excesses if (excess[1] > 0).any()]


def _shift(pelvis: Pelvis, leg: int, change: Array) -> Array:
    """Return the displacement of a leg's hip, (..., F, 3), metres, by a change (..., 2 + L, F)."""
    return pelvis.shift(leg, change[..., RISE, :], change[..., LIST, :])


def _pose(target: FootTarget, pelvis: Pelvis, leg: int, change: Array) -> Pose:
    """Return the angle of a knee and the vector from hip to ankle; while a foot stands they may disagree."""
    bend = target.track.flexion + change[..., BODY + leg, :]
    hip = target.track.hip + _shift(pelvis, leg, change)
    wanted = target.ankle - hip
    rolls = target.rolls
    distance = target.track.reach(bend)[..., rolls]
    wanted[..., rolls, :] = target.rolled(hip[..., rolls, :], distance)
    return bend, wanted


def _reach(targets: Sequence[FootTarget], pelvis: Pelvis, change: Array) -> tuple[Array, Array]:
    """Return the lowest and the highest rise at which all planted legs reach, (F,) each, metres."""
    bound = MOST * targets[0].track.length
    listed = change.copy()
    listed[RISE] = 0.0
    lowest = np.full(change.shape[-1], -bound)
    highest = np.full(change.shape[-1], bound)
    for leg, target in enumerate(targets):
        rolls = target.rolls
        foot = np.linalg.norm(target.places[1] - target.ankle, axis=1) - FLAT
        place = np.where(rolls[:, None], target.places[1], target.ankle)
        place = place - _shift(pelvis, leg, listed)
        fall, rise = target.track.rises(place, np.where(rolls, foot, 0.0))
        lowest = np.where(target.planted, np.maximum(lowest, fall), lowest)
        highest = np.where(target.planted, np.minimum(highest, rise), highest)
    # If one leg asks for a lower root than another, the lower one counts.
    return np.minimum(lowest, highest), highest


def _leg(target: FootTarget, pelvis: Pelvis, leg: int, change: Array) -> Array:
    """Return the weighted corrections of a leg, (..., 9, F), by a change (..., 2 + L, F)."""
    track = target.track
    bend, wanted = _pose(target, pelvis, leg, change)
    shift = _shift(pelvis, leg, change)
    distance = np.sqrt(dot(wanted, wanted))
    knee = shift + track.swung_thigh(bend, wanted) - (track.knee - track.hip)
    stretch = np.where(target.planted, 1.0, track.reach(bend) / distance)
    ankle = shift + stretch[..., None] * wanted - (track.ankle - track.hip)
    lever = track.length / 4
    angle = TUNED.angle * lever * (bend - track.flexion)
    gap = TUNED.closed * np.where(target.planted, distance - track.reach(bend), 0.0)
    straightened = np.maximum(target.least_bend - bend, 0.0)
    straight = TUNED.bent * lever * np.where(target.planted, straightened, 0.0)
    angles = np.stack([angle, gap, straight], axis=-1)
    rows = np.concatenate([TUNED.knee * knee, TUNED.foot * ankle, angles], axis=-1)
    return np.moveaxis(rows, -1, -2)


def _corrections(targets: Sequence[FootTarget], pelvis: Pelvis, change: Array) -> Array:
    """Return all weighted corrections, (2 + 9 L, F): root, pelvis, then those of each leg."""
    legs = [_leg(target, pelvis, leg, change) for leg, target in enumerate(targets)]
    weights = [[TUNED.root], [TUNED.list * pelvis.half]]
    return np.concatenate([weights * change[:BODY], *legs])


def _derivatives(targets: Sequence[FootTarget], pelvis: Pelvis, change: Array, corrections: Array) -> Array:
    """Return the derivatives of all corrections by the unknowns of their frame, (2 + L, 2 + 9 L, F)."""
    derivatives = np.zeros((len(change), *corrections.shape))
    derivatives[RISE, RISE] = TUNED.root
    derivatives[LIST, LIST] = TUNED.list * pelvis.half
    for leg, target in enumerate(targets):
        unknowns = [RISE, LIST, BODY + leg]
        smaller = np.repeat(change[None], len(unknowns), axis=0)
        smaller[np.arange(len(unknowns)), unknowns] -= STEP
        rows = _rows(leg)
        derivatives[unknowns, rows] = (corrections[rows] - _leg(target, pelvis, leg, smaller)) / STEP
    return derivatives


def _rows(leg: int) -> slice:
    """Return which of all corrections are a leg's."""
    return slice(BODY + LEG * leg, BODY + LEG * (leg + 1))


def _bands(legs: int, frames: int, fps: float) -> tuple[Array, Array]:
    """Return the matrices of the sum by their bands, and which rows are smooth corrections.

    The bands have shape (2 + 9 L, 3, F), as of `bending_bands`; gaps and straight knees do not have to be
    smooth, so that their matrix is diagonal.
    """
    ones = np.ones(frames)
    kinds = {
        fade: bending_bands(ones, (fade * fps) ** -4.0)
        for fade in (TUNED.fade, TUNED.list_fade, TUNED.angle_fade)
    }
    bands = np.repeat(kinds[TUNED.fade][None], BODY + LEG * legs, axis=0)
    bands[LIST] = kinds[TUNED.list_fade]
    smooth = np.ones(len(bands), bool)
    for leg in range(legs):
        start = _rows(leg).start
        bands[start + ANGLE] = kinds[TUNED.angle_fade]
        bands[start + GAP] = bending_bands(0 * ones, 1.0)
        bands[start + STRAIGHT] = bending_bands(0 * ones, (TUNED.fade * fps) ** -4.0)
        smooth[[start + GAP, start + STRAIGHT]] = False
    return bands, smooth


def _least_bent(targets: Sequence[FootTarget], pelvis: Pelvis) -> Array:
    """Minimise the sum by damped Gauss-Newton steps: the root's rise, the list and the knees' angles."""
    track = targets[0].track
    frames = len(track.hip)
    bounds = np.array([[MOST * track.length], [MOST_LIST]])
    bands, smooth = _bands(len(targets), frames, track.motion.fps)
    change = np.zeros((BODY + len(targets), frames))
    corrections = _corrections(targets, pelvis, change)
    cost = _cost(bands, corrections)
    damping = DAMPING
    derivatives = _derivatives(targets, pelvis, change, corrections)
    for _ in range(TUNED.steps):
        pull = np.einsum("kmf,mf->kf", derivatives, band_product(bands, corrections))
        # A root or a pelvis at its bound stays there if it is pulled beyond.
        held = (np.abs(change[:BODY]) >= bounds) & (pull[:BODY] * change[:BODY] < 0)
        diagonal = np.einsum("kmf,mf->kf", derivatives[:, smooth] ** 2, bands[smooth, 0])
        tried = change - _gauss_newton(derivatives, bands, pull, damping * diagonal, held)
        tried[:BODY] = np.clip(tried[:BODY], -bounds, bounds)
        tried_corrections = _corrections(targets, pelvis, tried)
        gain = cost - _cost(bands, tried_corrections)
        if gain <= 0:
            damping *= MORE_DAMPING
            continue
        is_last = gain <= TUNED.gain * cost
        change = tried
        corrections = tried_corrections
        cost -= gain
        if is_last:
            break
        damping *= LESS_DAMPING
        derivatives = _derivatives(targets, pelvis, change, corrections)
    return change


def _cost(bands: Array, corrections: Array) -> float:
    """Return the sum that is minimised."""
    return float((corrections * band_product(bands, corrections)).sum())


def _gauss_newton(derivatives: Array, bands: Array, pull: Array, damping: Array, held: Mask) -> Array:
    """Solve (Σ Sᵀ B S + damping) x = pull for a step x, (K, F).

    Parameters
    ----------
    derivatives : S of each of M rows by each of K unknowns, (K, M, F).
    bands : B, a symmetric matrix for each row by its lower diagonals, (M, 3, F).
    pull : shape (K, F).
    damping : what is added to the diagonal, (K, F).
    held : where the first two unknowns stay, (2, F).
    """
    kinds, frames = pull.shape
    # The unknowns of a frame are neighbours, so that the matrix has K lower diagonals for each frame.
    whole = np.zeros((3 * kinds, frames, kinds))
    for later in range(min(3, frames)):
        weighted = bands[:, later, : frames - later] * derivatives[..., : frames - later]
        parts = np.einsum("kmf,lmf->klf", weighted, derivatives[..., later:])
        for first, second in np.ndindex(kinds, kinds):
            row = later * kinds + second - first
            if row >= 0:
                whole[row, : frames - later, first] += parts[first, second]
    # Where nothing depends on an unknown, the step is 0.
    whole[0] += damping.T + 1e-9 * damping.max() + np.finfo(float).tiny
    whole[0, :, :BODY] += np.where(held.T, 1e9 * whole[0].max(), 0.0)
    step = solveh_banded(whole.reshape(len(whole), -1), pull.T.ravel(), lower=True)
    return np.asarray(step.reshape(frames, kinds).T)


def _jumps(curves: Array, span: int) -> Array:
    """Return the second differences over `span` frames of curves (..., F), 0 near their ends."""
    jumps = np.zeros_like(curves)
    middle = slice(span, max(curves.shape[-1] - span, span))
    later = curves[..., 2 * span :]
    earlier = curves[..., : -2 * span]
    jumps[..., middle] = later - 2 * curves[..., middle] + earlier
    return jumps
