"""The frames between ten frames and one later one, in clips that methods have not seen.

LAFAN1's measures: L2Q, of global quaternions; L2P, of global positions over their standard deviations in the
other clips; NPSS, of the quaternions' power spectra. `in between` walks through the graph of the other clips.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import Motion, rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.planar import align_frames, place
from mocap.errors import MocapError
from mocap.methods.in_betweening import in_between
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
PAST, EVERY, MOST = 10, 40, 8  # frames; frames from window to window; windows of a clip
MEASURES = {"L2Q": True, "L2P": True, "NPSS": True}
BASELINES = ("linear",)


def cases(collection: str, clips: list[Motion]) -> Iterator[Case]:
    """Yield windows of the tested clips, each laid so that its last frame before the gap is at the origin."""
    others = without(clips, TESTED)
    for length in LENGTHS:
        for clip in clips:
            for start in range(0, min(len(clip) - length - PAST, MOST * EVERY), EVERY):
                window = laid(clip[start : start + PAST + length + 1]) if clip.name in TESTED else None
                if window:
                    given = {
                        "past": window[:PAST],
                        "next": window[-1:],
                        "frames": [[length]],
                        "clips": others,
                    }
                    whole = f"{collection}, {length} frames"
                    yield Case(
                        whole, f"{clip.name}-{start}-{length}", given, (window[PAST:-1], spread(others))
                    )


def laid(window: Motion) -> Motion:
    """Lay a window so that its last past frame stands at the origin and faces +x."""
    last = window[PAST - 1 : PAST]
    return align_frames(last, place(last, np.pi / 2, (0, 0))).apply_motion(window)


@cache
def spread(clips: tuple[Motion, ...]) -> Array:
    """Give the standard deviations (J, 3) of global positions, over windows of 50 frames, every 20."""
    windows = [clip[at : at + 50] for clip in clips for at in range(0, len(clip) - 49, 20)]
    points = np.concatenate([forward_kinematics(laid(window)).positions for window in windows])
    return np.maximum(points.std(axis=0), 1e-3)


def linear(case: Case) -> Motion:
    """Move the root along a straight line, and turn each joint along the shortest arc."""
    past, then, frames = case.given["past"], case.given["next"], int(case.given["frames"][0][0])
    share = np.arange(1, frames + 1)[:, None] / (frames + 1)
    roots = (1 - share) * past.root_positions[-1] + share * then.root_positions[0]
    amounts = np.broadcast_to(share, (frames, len(past.skeleton)))
    turns = rotations.slerp(past.rotations[-1], then.rotations[0], amounts)
    return Motion(past.skeleton, roots, turns, past.fps)


def graph_walk(case: Case) -> Motion:
    """Walk through the graph of the other clips from pose to pose."""
    past, then, frames = case.given["past"], case.given["next"], int(case.given["frames"][0][0])
    found = in_between(graph(case.given["clips"]), past[PAST - 1 :], then[:1], (frames + 1) / past.fps)
    return found.motion[1:-1]


METHODS = {"linear": linear, "in between": graph_walk}


def score(case: Case, answer: Motion) -> tuple[float, float, float]:
    """Measure an answer by LAFAN1's three measures."""
    motion, deviation = case.truth
    if len(answer) != len(motion) or answer.skeleton.names != motion.skeleton.names:
        raise MocapError(f"{case.name} asks for {len(motion)} frames of the body that is given.")
    real, made = forward_kinematics(motion), forward_kinematics(answer)
    q, p = (rotations.continuous(rotations.from_matrix(some.matrices)) for some in (real, made))
    p = p * np.where((p * q).sum(axis=-1, keepdims=True) < 0, -1, 1)
    l2q = np.sqrt(((p - q) ** 2).sum(axis=(1, 2))).mean()
    l2p = np.sqrt((((made.positions - real.positions) / deviation) ** 2).sum(axis=(1, 2))).mean()
    return float(l2q), float(l2p), npss(q, p)


def npss(real: Array, made: Array) -> float:
    """Compare power spectra (F, ...) over time: the distance of their sums, weighted by the real power."""
    powers = [np.fft.fft(some.reshape(len(some), -1), axis=0).real ** 2 for some in (real, made)]
    sums = [np.cumsum(power / np.maximum(power.sum(axis=0), 1e-12), axis=0) for power in powers]
    return float(np.average(np.abs(sums[0] - sums[1]).sum(axis=0), weights=powers[0].sum(axis=0)))
