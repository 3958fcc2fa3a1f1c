"""The frames between ten frames and one later one, in clips that methods have not seen.

LAFAN1's measures: L2Q, of global quaternions; L2P, of global positions over their standard deviations in the
other clips; NPSS, of the quaternions' power spectra. `in between` is what `mocap inbetween` does: below a
third of a second it interpolates by cubic curves, and else it walks through the graph of the other clips.

In five frames a body only continues, so that a straight line is nearly right; the cubic curves continue
velocities, of which only those before the gap are given here.
"""

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.planar import align_frames, place
from mocap.errors import MocapError
from mocap.methods.in_betweening import SHORTEST, fill_gap, interpolate
from tasks import BANDAI, CMU_16, HOMEWORK, WALKS, Case, graph, without

CLIPS = {
    "bundled clips": (*WALKS, "stop_and_go"),
    "homework's clips": HOMEWORK,
    "CMU 16, walks": CMU_16,
    "Bandai-Namco": BANDAI,
    "LAFAN1": tuple(f"lafan1/walk{n}" for n in ("1_subject1", "1_subject2", "3_subject1", "1_subject5")),
    "100STYLE": ("Neutral/Neutral_TR1", "Neutral/Neutral_FW"),
}
TESTED = {  # the others may be learned from
    *("walk_curve_2", "walk_fwd_curve2", "16_16", "16_18", "16_20", "16_24", "16_26", "16_58"),
    *("dataset-2_walk_normal_001", "walk1_subject5", "Neutral_FW"),
}
LENGTHS = (5, 15, 30, 60)  # frames
PAST = 10  # frames before the gap
EVERY = 40  # frames from the start of a window to that of the next one
MOST_WINDOWS = 8  # of a clip, for each length
MEASURES = {"L2Q": True, "L2P": True, "NPSS": True}
BASELINES = ("linear",)


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield windows of the tested clips, each laid so that its last frame before the gap is at the origin."""
    training_clips = without(clips, TESTED)
    tested_clips = [clip for clip in clips if clip.name in TESTED]
    for length in LENGTHS:
        for clip in tested_clips:
            end = min(len(clip) - length - PAST, MOST_WINDOWS * EVERY)
            for start in range(0, end, EVERY):
                window = laid(clip[start : start + PAST + length + 1])
                name = f"{clip.name}-{start}-{length}"
                yield gap_in(window, f"{collection}, {length} frames", name, training_clips)


def gap_in(window: Motion, collection: str, name: str, training_clips: tuple[Motion, ...]) -> Case:
    """Ask for the frames of a window between its past and its last frame."""
    request = {
        "past": window[:PAST],
        "next": window[-1:],
        "frames": [[len(window) - PAST - 1]],
        "clips": training_clips,
    }
    return Case(collection, name, request, (window[PAST:-1], spread(training_clips)))


def laid(window: Motion) -> Motion:
    """Lay a window so that its last past frame stands at the origin and faces +x."""
    last = window[PAST - 1 : PAST]
    return align_frames(last, place(last, np.pi / 2, (0, 0))).apply_motion(window)


@cache
def spread(clips: tuple[Motion, ...]) -> Array:
    """Return the standard deviations (J, 3) of global positions, over windows of 50 frames, every 20."""
    windows = [clip[start : start + 50] for clip in clips for start in range(0, len(clip) - 49, 20)]
    points = np.concatenate([forward_kinematics(laid(window)).positions for window in windows])
    return np.maximum(points.std(axis=0), 1e-3)


class Gap(NamedTuple):
    """The frames before a gap, the one after it, and the number of frames between."""

    past: Motion
    target: Motion
    frames: int


def gap_of(case: Case) -> Gap:
    """Return the gap that a case asks to fill."""
    return Gap(case.given["past"], case.given["next"], int(case.given["frames"][0][0]))


def linear(case: Case) -> Motion:
    """Move the root along a straight line, and turn each joint along the shortest arc."""
    past, target, frames = gap_of(case)
    fractions = np.arange(1, frames + 1)[:, None] / (frames + 1)
    roots = (1 - fractions) * past.root_positions[-1] + fractions * target.root_positions[0]
    amounts = np.broadcast_to(fractions, (frames, len(past.skeleton)))
    joint_rotations = rotations.slerp(past.rotations[-1], target.rotations[0], amounts)
    return Motion(past.skeleton, roots, joint_rotations, past.fps)


def as_shipped(case: Case) -> Motion:
    """Interpolate a short gap, and fill a long one with a walk through the graph of the other clips."""
    past, target, frames = gap_of(case)
    seconds = (frames + 1) / past.fps
    if seconds < SHORTEST:
        return interpolate(past, target, frames + 1)[1:-1]
    return fill_gap(graph(case.given["clips"]), past, target, seconds).motion[1:-1]


METHODS = {"linear": linear, "in between": as_shipped}


def score(case: Case, answer: Motion) -> tuple[float, float, float]:
    """Measure an answer by LAFAN1's three measures."""
    motion, deviation = case.truth
    if len(answer) != len(motion) or answer.skeleton.names != motion.skeleton.names:
        raise MocapError(f"{case.name} asks for {len(motion)} frames of the body that is given.")
    true_frames = forward_kinematics(motion)
    frames = forward_kinematics(answer)
    true_quaternions = rotations.continuous(rotations.from_matrix(true_frames.matrices))
    quaternions = rotations.continuous(rotations.from_matrix(frames.matrices))
    is_opposite = (quaternions * true_quaternions).sum(axis=-1, keepdims=True) < 0
    quaternions = quaternions * np.where(is_opposite, -1, 1)

    l2q = mean_norm(quaternions - true_quaternions)
    l2p = mean_norm((frames.positions - true_frames.positions) / deviation)
    return l2q, l2p, npss(true_quaternions, quaternions)


def mean_norm(errors: Array) -> float:
    """Average over frames the Euclidean norm of the errors (F, J, N) in a frame."""
    return float(np.sqrt((errors**2).sum(axis=(1, 2))).mean())


def npss(truth: Array, answer: Array) -> float:
    """Compare power spectra (F, ...) over time: the distance of their sums, weighted by the true power."""
    true_powers = power_spectrum(truth)
    distances = np.abs(cumulated(true_powers) - cumulated(power_spectrum(answer))).sum(axis=0)
    return float(np.average(distances, weights=true_powers.sum(axis=0)))


def power_spectrum(values: Array) -> Array:
    """Return the squared real parts of the Fourier transform over time (F, columns), as LAFAN1 does."""
    return np.asarray(np.fft.fft(values.reshape(len(values), -1), axis=0).real ** 2)


def cumulated(powers: Array) -> Array:
    """Sum power spectra up to each frequency, as fractions of the whole power."""
    return np.cumsum(powers / np.maximum(powers.sum(axis=0), 1e-12), axis=0)
