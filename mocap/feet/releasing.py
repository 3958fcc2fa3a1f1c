"""Which footplants are released when not all of them can be held, and in which frames.

A correction exceeds its bounds where a leg is too short, the root would move too far, or a knee would jolt.
This says when something is wrong, but not with which plant: the hips take part in the correction of both
legs, and a knee jolts after its foot has left. Therefore the deviations of joints from their places decide.
A foot that stands is near its place. One that is marked before it has landed, or after it has left, is not,
and its deviation is largest at that end of the plant. So plants that are marked for too long are shortened
from their ends, and the plants of the other foot stay.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.ndimage import maximum_filter1d

from mocap._shared.arrays import Array, Mask, runs
from mocap.feet.ankle_targets import FootTarget
from mocap.feet.footplants import least_frames, settle
from mocap.feet.least_bending import Excess
from mocap.feet.leg_track import ROUNDING
from mocap.feet.tuned import TUNED


def plant_deviations(targets: Sequence[FootTarget], held: Mapping[int, Array]) -> Array:
    """Compute the distances of planted joints from where they stand, (L, 2, F), metres, 0 elsewhere.

    A joint stands at the median of its positions in the plant. The place that holds it is their mean, which
    frames in which the foot swings lead astray. Joints in `held` stand where they are held.
    """
    deviations = np.zeros((len(targets), *targets[0].marks.shape))
    for leg, target in enumerate(targets):
        track = target.track
        joints = zip(track.leg[2:], (track.ankle, track.ball), strict=True)
        for kind, (joint, path) in enumerate(joints):
            for start, stop in runs(target.marks[kind]):
                place = target.places[kind, start:stop]
                if joint not in held:
                    place = np.median(path[start:stop], axis=0)
                deviations[leg, kind, start:stop] = np.linalg.norm(path[start:stop] - place, axis=1)
    return deviations


def release(marks: Mask, excesses: Sequence[Excess], deviations: Array, fps: float) -> Mask:
    """Unmark the frames of plants to which excesses are due, and those around them.

    Of each plant these are only the frames with the largest deviations. The others may become feasible once
    the place is the mean of the frames that remain.

    Parameters
    ----------
    marks : shape (L, 2, F), when each leg's ankle and ball stand; settled.
    excesses : of legs with a plant each, above 0 somewhere.
    deviations : as of `plant_deviations`.
    fps : frames per second.

    Returns
    -------
    Settled marks, a proper subset of those given: a gap made here is as long as the shortest that `settle`
    leaves, or touches an end of the clip.
    """
    span = least_frames(fps)
    kept = marks.copy()
    blamed = _blamed_frames(marks, excesses, deviations, fps)
    for leg, joint in np.ndindex(marks.shape[:2]):
        mark = marks[leg, joint]
        amounts = np.where(blamed[leg, joint], deviations[leg, joint], -np.inf)
        largest = np.full(len(mark), np.inf)
        for start, stop in runs(mark):
            largest[start:stop] = amounts[start:stop].max()
        released = blamed[leg, joint] & (amounts >= TUNED.released * largest - ROUNDING)
        unmarked = maximum_filter1d(released, 2 * span + 1)
        kept[leg, joint] = settle(mark & ~unmarked, span)
    return kept


def _blamed_frames(marks: Mask, excesses: Sequence[Excess], deviations: Array, fps: float) -> Mask:
    """Find the planted frames to which excesses are due, (L, 2, F).

    For each local maximum of an excess, it is the frame with the largest deviation among the planted ones
    within `TUNED.blame`, or the nearest planted frame if none is. Ties are broken in favour of the frame
    that is nearer in time.
    """
    frames = np.arange(marks.shape[-1])
    width = 2 * least_frames(fps) + 1
    blamed = np.zeros_like(marks)
    for legs, amount in excesses:
        is_peak = (amount > 0) & (amount == maximum_filter1d(amount, width))
        for peak in np.flatnonzero(is_peak):
            distances = np.where(marks[legs], np.abs(frames - peak), len(frames))
            candidates = distances <= max(TUNED.blame * fps, distances.min())
            largest = deviations[legs][candidates].max()
            furthest = candidates & (deviations[legs] >= largest - ROUNDING)
            blamed[legs] |= furthest & (distances == distances[furthest].min())
    return blamed
