"""Faults of rising size, and whether `judge` sees them: `python figures/judged_faults.py FOLDER...`.

Each folder below those given is a laboratory. From each, the first two clips that travel by 2 m or more
within 10 s get eleven faults in four sizes. A fault is seen if it raises the score by more than 0.05. It is
ranked if no size scores lower than the size before it. All clips of all folders are also judged as they are,
and those above a limit are listed, with the fault of the capture that one sees in their frames, if any.
`--fps 30` resamples them first. `--laboratories hw3 16` takes only some of the folders, by their names, and
`--without` leaves some out: limits are chosen with some laboratories and reported for the others.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import mocap
from mocap import datasets
from mocap._shared.arrays import Array
from mocap.body import Motion, find_legs, rotations
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.limbs import with_roles
from mocap.errors import MocapError
from mocap.quality import judge

SUFFIXES = (".amc", ".bvh")
LONGEST = 10.0  # seconds of a clip that get faults
SHORTEST = 1.0  # seconds
FARTHEST = 2.0  # metres that a clip with faults travels
EACH = 2  # clips of a laboratory that get faults
RISE = 0.05  # of the score, for a fault to be seen
TREMOR = 11.0  # Hz
IN_THE_FLOOR = 0.5  # seconds
FLOOR = 10  # percentile of the heights of the lowest joint


class Fault(NamedTuple):
    """A fault, its sizes, the function that puts it into a clip, and one that tells whether it can."""

    name: str
    sizes: tuple[float, ...]
    put: Callable[[Motion, float], Motion]
    applies: Callable[[Motion], bool] = bool  # to any clip with frames


def with_noise(clip: Motion, radians: float) -> Motion:
    """Add noise to all rotations."""
    random = np.random.default_rng(0)
    frames, joints, _ = clip.rotations.shape
    noise = rotations.from_rotvec(random.normal(0, radians, (frames, joints, len("xyz"))))
    return replace(clip, rotations=rotations.multiply(clip.rotations, noise))


def moved(clip: Motion, shift: Array) -> Motion:
    """Move the root by (F, 3) or (3,), metres."""
    return replace(clip, root_positions=clip.root_positions + shift)


def sunk(clip: Motion, metres: float) -> Motion:
    """Lower the body, from the floor on which its lowest joint stands."""
    floor = np.percentile(joint_positions(clip)[..., 1].min(axis=1), FLOOR)
    return moved(clip, np.array([0.0, -floor - metres, 0.0]))


def jumping(clip: Motion, metres: float) -> Motion:
    """Move the body sideways, from the middle of the clip."""
    shift = np.zeros((len(clip), 3))
    shift[len(clip) // 2 :, 0] = metres
    return moved(clip, shift)


def trembling(clip: Motion, metres: float) -> Motion:
    """Let the root tremble."""
    seconds = np.arange(len(clip)) / clip.fps
    shift = np.zeros((len(clip), 3))
    shift[:, 1] = metres * np.sin(2 * np.pi * TREMOR * seconds)
    return moved(clip, shift)


def sliding(clip: Motion, fraction: float) -> Motion:
    """Lengthen the path over the ground, without the steps."""
    shift = fraction * (clip.root_positions - clip.root_positions[0])
    shift[:, 1] = 0.0
    return moved(clip, shift)


def frozen(clip: Motion, seconds: float) -> Motion:
    """Repeat a frame in which the body moves, near the middle of the clip."""
    counts = np.ones(len(clip), int)
    counts[moving_frame(clip)] += round(seconds * clip.fps)
    return frames_of(clip, np.repeat(np.arange(len(clip)), counts))


def moving_frame(clip: Motion) -> int:
    """Choose the frame nearest to the middle of a clip in which the body moves as fast as in the median."""
    steps = np.linalg.norm(np.diff(joint_positions(clip), axis=0), axis=-1).mean(axis=-1)
    candidates = np.flatnonzero(steps >= np.median(steps))
    return int(candidates[np.abs(candidates - len(clip) // 2).argmin()])


def cut(clip: Motion, seconds: float) -> Motion:
    """Leave out frames in which the body moves, without a blend."""
    count = max(1, round(seconds * clip.fps))
    start = min(moving_frame(clip) + 1, len(clip) - count - 1)
    return frames_of(clip, np.delete(np.arange(len(clip)), slice(start, start + count)))


def frames_of(clip: Motion, frames: Array) -> Motion:
    """Return some frames of a clip."""
    roots = clip.root_positions[frames]
    return replace(clip, root_positions=roots, rotations=clip.rotations[frames], contacts={}, labels={})


def rotated(clip: Motion, joint: int, angles: Array) -> Motion:
    """Rotate a joint by angles (F,), radians, about the line from the right hip to the left one."""
    poses = forward_kinematics(clip)
    hips = [leg.hip for leg in find_legs(clip.skeleton)]
    to_the_left = poses.positions[:, hips[0]] - poses.positions[:, hips[1]]
    to_the_left /= np.linalg.norm(to_the_left, axis=-1, keepdims=True)
    parent = clip.skeleton.parents[joint]
    axis = np.einsum("fji,fj->fi", poses.matrices[:, parent], to_the_left)
    turned = clip.rotations.copy()
    turn = rotations.from_rotvec(angles[:, None] * axis)
    turned[:, joint] = rotations.multiply(turn, turned[:, joint])
    return replace(clip, rotations=turned)


def backwards(clip: Motion, radians: float) -> Motion:
    """Bend a knee backwards in all frames."""
    return rotated(clip, find_legs(clip.skeleton)[0].knee, np.full(len(clip), -radians))


def from_the_middle(clip: Motion, value: float) -> Array:
    """Return 0 in the first half of a clip and a value in the second."""
    return np.where(np.arange(len(clip)) < len(clip) // 2, 0.0, value)


def snapping_hip(clip: Motion, radians: float) -> Motion:
    """Rotate a hip from one frame to the next."""
    return rotated(clip, find_legs(clip.skeleton)[0].hip, from_the_middle(clip, radians))


def snapping_knee(clip: Motion, radians: float) -> Motion:
    """Bend a knee from one frame to the next."""
    return rotated(clip, find_legs(clip.skeleton)[0].knee, from_the_middle(clip, radians))


def below_ankle(clip: Motion) -> list[int]:
    """List the joints of the left foot."""
    ankle = find_legs(clip.skeleton)[0].ankle
    return [joint for joint in range(len(clip.skeleton)) if ankle in clip.skeleton.path_to_root(joint)]


def has_toes(clip: Motion) -> bool:
    """Tell whether a foot has joints beyond its ball."""
    return len(below_ankle(clip)) > len(("ankle", "ball"))


def toes_in_the_floor(clip: Motion, metres: float) -> Motion:
    """Pitch a standing foot down for half a second, with the ankle in place, so that its tip is lower."""
    ankle = find_legs(clip.skeleton)[0].ankle
    positions = joint_positions(clip)
    quarter = len(clip) // 4
    middle = quarter + int(positions[quarter:-quarter, ankle, 1].argmin())
    joints = below_ankle(clip)
    length = np.linalg.norm(positions[0, joints] - positions[0, ankle], axis=-1).max()
    seconds = np.abs(np.arange(len(clip)) - middle) / clip.fps
    ramp = np.clip(2 - 4 * seconds / IN_THE_FLOOR, 0, 1)
    return rotated(clip, ankle, ramp * np.arcsin(min(1.0, metres / length)))


# reads: statement: a table
FAULTS = (
    Fault("noise on joints, rad", (0.003, 0.01, 0.03, 0.1), with_noise),
    Fault("sunk, m", (0.02, 0.05, 0.1, 0.3), sunk),
    Fault("a knee bends backwards, rad", (0.1, 0.3, 0.6, 1.0), backwards),
    Fault("the root jumps, m", (0.01, 0.03, 0.1, 0.3), jumping),
    Fault("a hip snaps, rad", (0.05, 0.15, 0.4, 1.0), snapping_hip),
    Fault("the root trembles at 11 Hz, m", (0.002, 0.005, 0.015, 0.05), trembling),
    Fault("the path is longer, fraction", (0.03, 0.1, 0.3, 0.8), sliding),
    Fault("frozen, s", (0.1, 0.3, 1.0, 2.0), frozen),
    Fault("frames are left out, s", (0.042, 0.1, 0.2, 0.4), cut),
    Fault("a knee snaps, rad", (0.05, 0.15, 0.4, 1.0), snapping_knee),
    Fault("toes in the floor for 0.5 s, m", (0.03, 0.06, 0.12, 0.16), toes_in_the_floor, has_toes),
)

# What one sees in the frames of captured clips that exceed a limit: leaps in the data, or an uneven floor.
FAULTS_OF_CAPTURE = {
    "imusim/16_15": "the arms leap out of the T-pose in frames 1 to 4, a hand in 5 to 8",
    "16/16_15": "the arms leap out of the T-pose in frame 2, a hand in frame 7",
    "crlf_16/16_15": "the arms leap out of the T-pose in frame 2, a hand in frame 7",
    "16/16_23": "the right arm leaps out of the T-pose in frame 3",
    "16/16_28": "the right arm leaps out of the T-pose in frame 6",
    "16/16_34": "both arms, the neck and the left toes leap in frames 1, 7 and 10, by 10 to 17 degrees each",
    "16/16_01": "the left elbow, still until then, leaps by 13 degrees in frame 203",
    "16/16_11": "the pelvis leaps by 10 degrees in frame 398 and back in frame 399",
    "16/16_17": "the pelvis leaps by 30 degrees in frame 474 and back in frame 475",
    "49/49_02": "in a jump the left thigh alone swings out by 50 degrees and back in 0.15 s, frame 781",
    "49/49_04": "the last six frames repeat the one before, in mid-run",
    "03/03_02": "frames 11 to 23 repeat, the body leaps in frame 24, and the arms in 50",
    "127/127_24": "in a roll the left hip is out by 85 degrees, and swings by 60 in 0.06 s, frame 129",
    "127/127_32": "the neck leaps by 82 degrees in frame 11, and no other joint moves",
    "puppy0512_motion_graph/walk_normal_left_90": "a forearm turns over from frame 369 on; its hand rests",
    "puppy0512_motion_graph/walk_normal_right_90": "a forearm turns over from frame 1539 on; its hand rests",
    "puppy0512_motion_graph/walk_normal_right_45": "arms, chest and head leap in frames 544 to 546",
    "pybvh/bvh_test1": "a forearm turns over by 103 degrees in frame 58",
    "03/03_01": "the ground is uneven, by its title",
    "03/03_03": "the ground is uneven, by its title",
    "127/127_25": "the toe tips land 5 cm below the floor",
    "127/127_27": "the toe tips land 5 cm below the floor",
}

Clips = dict[str, list[Motion]]


def load(folders: Sequence[Path], fps: float | None) -> Clips:
    """Load the clips of all laboratories, by folder; files that cannot be read are left out, and named."""
    clips: Clips = {"bundled": [at_rate(datasets.sample(name), fps) for name in datasets.SAMPLES]}
    paths = sorted(path for folder in folders for path in folder.rglob("*"))
    for path in [path for path in paths if path.suffix.lower() in SUFFIXES]:
        try:
            clip = at_rate(mocap.load(path), fps)
        except MocapError as error:
            print(f"left out: {path.name}: {error}")
            continue
        clips.setdefault(path.parent.name, []).append(replace(clip, name=f"{path.parent.name}/{path.stem}"))
    return clips


def at_rate(clip: Motion, fps: float | None) -> Motion:
    """Resample a clip, unless it has a lower frame rate."""
    return mocap.resample(clip, fps) if fps and fps < clip.fps else clip


def chosen(clips: Clips, count: int) -> Iterator[Motion]:
    """Choose the first clips of each laboratory, at most `count`, that get faults."""
    for motions in clips.values():
        short = [with_roles(motion[: round(LONGEST * motion.fps)]) for motion in motions]
        yield from [motion for motion in short if travels(motion)][:count]


def travels(clip: Motion) -> bool:
    """Tell whether a clip is long enough, and goes far enough, for all faults."""
    steps = np.diff(clip.root_positions[:, [0, 2]], axis=0)
    return clip.duration >= SHORTEST and float(np.linalg.norm(steps, axis=-1).sum()) >= FARTHEST


def scores_of(clip: Motion, fault: Fault) -> list[float]:
    """Judge a clip as it is, and with a fault in rising sizes."""
    return [judge(clip).score, *(judge(fault.put(clip, size)).score for size in fault.sizes)]


def table_of_faults(clips: Sequence[Motion]) -> Iterator[str]:
    """Tabulate how many of the clips each fault is seen in, and how many rank its sizes."""
    yield "| fault | sizes | clips | seen in | ranked in | lowest rise of the larger two |"
    yield "|---|---|---|---|---|---|"
    for fault in FAULTS:
        motions = [motion for motion in clips if fault.applies(motion)]
        if not motions:
            continue
        scores = np.array([scores_of(motion, fault) for motion in motions])
        rises = scores[:, 1:] - scores[:, :1]
        seen = (rises > RISE).sum(axis=0)
        ranked = int((np.diff(scores, axis=1) > -RISE).all(axis=1).sum())
        of_larger = rises[:, -2:]
        worst = int(of_larger.min(axis=1).argmin())
        lowest = f"{', '.join(f'{rise:.2f}' for rise in of_larger[worst])} ({motions[worst].name})"
        sizes = " ".join(f"{size:g}" for size in fault.sizes)
        cells = [fault.name, sizes, len(motions), " ".join(map(str, seen)), ranked, lowest]
        yield f"| {' | '.join(map(str, cells))} |"


def table_of_clips(clips: Mapping[str, Sequence[Motion]]) -> Iterator[str]:
    """List the clips above a limit as they are, and count them and those whose capture is at fault."""
    yield "| laboratory | clips | above a limit | faults of the capture | largest score of the others |"
    yield "|---|---|---|---|---|"
    details = []
    for laboratory, motions in clips.items():
        judged = [judge(motion) for motion in motions if len(motion) >= 12]
        above = [judgement for judgement in judged if judgement.score > 0]
        scores = [judgement.score for judgement in judged if judgement.name not in FAULTS_OF_CAPTURE]
        at_fault = sum(judgement.name in FAULTS_OF_CAPTURE for judgement in above)
        cells = [laboratory, len(judged), len(above), at_fault, f"{max(scores, default=0.0):.2f}"]
        yield f"| {' | '.join(map(str, cells))} |"
        for judgement in above:
            rows = [measure for measure in judgement.measures if measure.ratio > 1]
            texts = [f"{row.name} {row.ratio:.2f} ({row.where})" for row in rows]
            reason = FAULTS_OF_CAPTURE.get(judgement.name, "no fault of the capture")
            details.append(f"{judgement.name}: score {judgement.score:.2f}: {'; '.join(texts)}. {reason}")
    yield from ["", *details]


def main() -> None:
    """Read the options, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--fps", type=float, help="resample clips of a higher frame rate")
    parser.add_argument("--laboratories", nargs="+", metavar="NAME", help="only these folders")
    parser.add_argument("--each", type=int, default=EACH, metavar="N", help="clips of a folder with faults")
    parser.add_argument("--without", nargs="+", default=[], metavar="NAME", help="leave these folders out")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    clips = load(options.folders, options.fps)
    kept = {name for name in options.laboratories or clips if name not in options.without}
    clips = {name: motions for name, motions in clips.items() if name in kept}
    start = time.process_time()
    print(*table_of_clips(clips), sep="\n", flush=True)
    print(f"\n{time.process_time() - start:.1f} s of CPU\n")
    for line in table_of_faults([*chosen(clips, options.each)]):
        print(line, flush=True)


if __name__ == "__main__":
    main()
