"""Trials of the limits of flaws and measures: `python figures/tune/quality.py [--quick] [--clips FOLDER]`.

Each limit is tried on the clips as they are, and on copies with a flaw that it must find. Clean: the
percentage of clips that are reported, at best those with true flaws alone. Flawed: the percentage of copies
that are reported; the flaws are small, medium and large, and a limit need not find the small ones: 2, 4 or 8
frames that repeat the one before; a root that leaps by 10, 30 or 100 cm for a frame; a knee that turns by
30°, 60° or 120° for a frame; the rest pose in 1, 2 or 5 frames before the clip; a body 2, 5 or 10 cm lower,
or 10, 20 or 30 cm higher; read as centimetres in place of inches, metres and millimetres; shaken by 2, 5 or
10 mm; sliding at 95, 90 or 80 % of its pace; knees that bend backwards; the bones of one side 1, 3 or 5 %
longer; 5, 15 or 45 frames left out; a second half that is moved aside by 3, 10 or 30 cm, or in which a hip is
rotated by 9°, 23° or 57°; a pose that is held for 0.1, 0.3 or 1 s; a body that dips by 3, 6 or 12 cm for half
a second. Clips keep their own frame rate, as some limits are for a frame. `figures/judged_faults.py` tries
all measures of `judge` together.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from _trials import WALKS, Clips, Collection, Measure, Row, Study, Trial, cmu

from mocap.body import Motion, find_legs, rotations
from mocap.quality import Judgement, inspect, judge, limits, spread

LONGEST = 6.0  # seconds of a clip that are judged
DIP = 0.5  # seconds
Copies = Callable[[Motion], Iterator[Motion]]


def repeating(clip: Motion) -> Iterator[Motion]:
    """Repeat a frame."""
    for count in (2, 4, 8):
        frames = np.arange(len(clip))
        middle = len(clip) // 2
        frames[middle : middle + count + 1] = middle
        yield frames_of(clip, frames)


def frames_of(clip: Motion, frames: np.ndarray) -> Motion:
    """Return some frames of a clip."""
    roots = clip.root_positions[frames]
    return replace(clip, root_positions=roots, rotations=clip.rotations[frames], contacts={}, labels={})


def leaping(clip: Motion) -> Iterator[Motion]:
    """Move the root in one frame."""
    for metres in (0.1, 0.3, 1.0):
        roots = clip.root_positions.copy()
        roots[len(clip) // 2, 0] += metres
        yield replace(clip, root_positions=roots)


def snapping(clip: Motion) -> Iterator[Motion]:
    """Turn a knee in one frame."""
    knee = find_legs(clip.skeleton)[0].knee
    for degrees in (30, 60, 120):
        turned = clip.rotations.copy()
        middle = len(clip) // 2
        turned[middle, knee] = rotations.multiply(turned[middle, knee], about_x(degrees))
        yield replace(clip, rotations=turned)


def after_rest_poses(clip: Motion) -> Iterator[Motion]:
    """Put the rest pose before a clip."""
    for count in (1, 2, 5):
        frames = np.maximum(0, np.arange(len(clip) + count) - count)
        extended = frames_of(clip, frames)
        turned = extended.rotations.copy()
        turned[:count] = rotations.IDENTITY
        yield replace(extended, rotations=turned)


def about_x(degrees: float) -> np.ndarray:
    """Return a rotation about the axis x."""
    half = np.radians(degrees) / 2
    return np.array([np.cos(half), np.sin(half), 0.0, 0.0])


def lifted(clip: Motion, heights: tuple[float, ...]) -> Iterator[Motion]:
    """Lift a body from the ground; a negative height lowers it."""
    for height in heights:
        yield replace(clip, root_positions=clip.root_positions + np.array([0, height, 0]))


def scaled(clip: Motion, factors: tuple[float, ...]) -> Iterator[Motion]:
    """Read a clip in another unit."""
    for factor in factors:
        skeleton = replace(clip.skeleton, offsets=clip.skeleton.offsets * factor)
        yield replace(clip, skeleton=skeleton, root_positions=clip.root_positions * factor)


def shaken(clip: Motion) -> Iterator[Motion]:
    """Shake the root."""
    random = np.random.default_rng(0)
    for metres in (0.002, 0.005, 0.01):
        noise = metres * random.normal(size=clip.root_positions.shape)
        yield replace(clip, root_positions=clip.root_positions + noise)


def sliding(clip: Motion) -> Iterator[Motion]:
    """Shorten the way over the ground, without the steps."""
    for factor in (0.95, 0.9, 0.8):
        yield replace(clip, root_positions=clip.root_positions * [factor, 1, factor])


def backwards(clip: Motion) -> Iterator[Motion]:
    """Bend the knees backwards."""
    knees = [leg.knee for leg in find_legs(clip.skeleton)]
    bent = clip.rotations.copy()
    bent[:, knees] = rotations.inverse(bent[:, knees])
    yield replace(clip, rotations=bent)


def lopsided(clip: Motion) -> Iterator[Motion]:
    """Lengthen the bones of one side."""
    skeleton = clip.skeleton
    is_longer = np.array([skeleton.partner(joint) > joint for joint in range(len(skeleton))])
    for factor in (1.01, 1.03, 1.05):
        offsets = skeleton.offsets.copy()
        offsets[is_longer] *= factor
        yield replace(clip, skeleton=replace(skeleton, offsets=offsets))


def cut(clip: Motion) -> Iterator[Motion]:
    """Leave out some frames, as a cut without a blend does."""
    for count in (5, 15, 45):
        middle = len(clip) // 2
        yield frames_of(clip, np.delete(np.arange(len(clip)), slice(middle, middle + count)))


def aside_halfway(clip: Motion) -> Iterator[Motion]:
    """Move the second half aside."""
    for metres in (0.03, 0.1, 0.3):
        roots = clip.root_positions.copy()
        roots[len(clip) // 2 :, 0] += metres
        yield replace(clip, root_positions=roots)


def rotated_halfway(clip: Motion) -> Iterator[Motion]:
    """Rotate a hip in the second half."""
    hip = find_legs(clip.skeleton)[0].hip
    for degrees in (9, 23, 57):
        turned = clip.rotations.copy()
        second = slice(len(clip) // 2, None)
        turned[second, hip] = rotations.multiply(turned[second, hip], about_x(degrees))
        yield replace(clip, rotations=turned)


def held(clip: Motion) -> Iterator[Motion]:
    """Hold the pose in the middle of a clip."""
    for seconds in (0.1, 0.3, 1.0):
        counts = np.ones(len(clip), int)
        counts[len(clip) // 2] += round(seconds * clip.fps)
        yield frames_of(clip, np.repeat(np.arange(len(clip)), counts))


def dipping(clip: Motion) -> Iterator[Motion]:
    """Lower a body for half a second."""
    seconds = np.abs(np.arange(len(clip)) - len(clip) // 2) / clip.fps
    ramp = np.clip(2 - 4 * seconds / DIP, 0, 1)
    for metres in (0.03, 0.06, 0.12):
        yield replace(clip, root_positions=clip.root_positions - metres * ramp[:, None] * [0, 1, 0])


def has_leaps(clip: Motion) -> bool:
    """Tell whether frames of a clip count as leaps in the data."""
    return bool(np.isnan(spread([clip]).velocity[0]).any())


def has_flaw(kind: str, clip: Motion) -> bool:
    """Tell whether `inspect` reports a kind of flaw."""
    return any(flaw.kind == kind for flaw in inspect(clip).flaws)


def has_impossible_height(clip: Motion) -> bool:
    """Tell whether `inspect` doubts the scale."""
    return "is its scale right?" in inspect(clip).table()


def exceeds(measure: str, clip: Motion) -> bool:
    """Tell whether `judge` finds a measure beyond its limit."""
    return any(row.name == measure and row.ratio > 1 for row in judge(clip).measures)


def tried(clips: Clips, is_reported: Callable[[Motion], bool], copies: Copies) -> Row:
    """Count clips and flawed copies that are reported."""
    short = [clip[: round(LONGEST * clip.fps)] for clip in clips]
    clean = [is_reported(clip) for clip in short]
    flawed = [is_reported(copy) for clip in short for copy in copies(clip)]
    return {"clean, %": 100 * float(np.mean(clean)), "flawed, %": 100 * float(np.mean(flawed))}


def flaws(kind: str, copies: Copies) -> Measure:
    """Return a measure that tries a flaw of `inspect`."""
    return partial(tried, is_reported=partial(has_flaw, kind), copies=copies)


def measure_of(name: str, copies: Copies) -> Measure:
    """Return a measure that tries one of `judge`."""
    return partial(tried, is_reported=partial(exceeds, name), copies=copies)


def against_itself(clips: Clips) -> Row:
    """Judge clips, and cuts in them, against the whole clips."""
    short = [clip[: round(LONGEST * clip.fps)] for clip in clips]
    clean = [is_jolted(clip, clip) for clip in short]
    flawed = [is_jolted(copy, clip) for clip in short for copy in cut(clip)]
    return {"clean, %": 100 * float(np.mean(clean)), "flawed, %": 100 * float(np.mean(flawed))}


def is_jolted(motion: Motion, clip: Motion) -> bool:
    """Tell whether a motion jolts more than its clip."""
    return any(row.name == "jolt" and row.ratio > 1 for row in judge(motion, against=[clip]).measures)


def stretched(clips: Clips) -> Row:
    """Report bones that change their length by 2, 4 or 8 mm."""
    clip = clips[0][: round(LONGEST * clips[0].fps)]
    lengths = (0.002, 0.004, 0.008)
    reported = [measured(judge(clip, stretch={"spine": length}), "bones") > 1 for length in lengths]
    return {"clean, %": 0.0, "flawed, %": 100 * float(np.mean(reported))}


def aside(clips: Clips) -> Row:
    """Report walks that are 0 (clean), or 5, 10 or 20 cm beside their path."""
    clean = [path_ratio(clip, 0.0) > 1 for clip in clips]
    flawed = [path_ratio(clip, shift) > 1 for clip in clips for shift in (0.05, 0.1, 0.2)]
    return {"clean, %": 100 * float(np.mean(clean)), "flawed, %": 100 * float(np.mean(flawed))}


def path_ratio(clip: Motion, shift: float) -> float:
    """Judge the beginning of a clip against its own path, moved aside."""
    short = clip[: round(LONGEST * clip.fps)]
    return measured(judge(short, path=short.root_positions[::10, [0, 2]] + [shift, 0.0]), "path")


def measured(judgement: Judgement, name: str) -> float:
    """Return the ratio of a measure to its limit."""
    return next(row.ratio for row in judgement.measures if row.name == name)


LOWERED = partial(lifted, heights=(-0.02, -0.05, -0.1))
RAISED = partial(lifted, heights=(0.1, 0.2, 0.3))
SMALLER = partial(scaled, factors=(0.01, 1 / 25.4, 1 / 2.54))
LARGER = partial(scaled, factors=(2.54, 25.4, 100.0))
FROZEN = flaws("frozen", repeating)
TELEPORT = flaws("teleport", leaping)
SNAP = flaws("snap", snapping)
REST_POSE = flaws("rest pose", after_rest_poses)
HEIGHT_SMALL = partial(tried, is_reported=has_impossible_height, copies=SMALLER)
HEIGHT_LARGE = partial(tried, is_reported=has_impossible_height, copies=LARGER)
BENT = measure_of("bent", backwards)
JOLT = measure_of("jolt", aside_halfway)
CUT = measure_of("cut", cut)
SNAPPING = measure_of("snap", rotated_halfway)
STANDSTILL = measure_of("frozen", held)

# reads: statement: a table
TRIALS = {
    "frozen": Trial(FROZEN, (1, 2, 5, 10)),
    "teleport": Trial(TELEPORT, (20.0, 2.0, 3.0, 10.0)),
    "sudden": Trial(TELEPORT, (1.5, 2.0, 10.0, 30.0)),
    "sudden_frames": Trial(TELEPORT, (1, 2, 10)),
    "snap": Trial(SNAP, (np.radians(20), np.radians(30), np.radians(60), np.radians(90))),
    "fast": Trial(SNAP, (150.0, 25.0, 35.0, 100.0)),
    "rest_leap": Trial(REST_POSE, (1.0, 2.0, 5.0, 10.0)),
    "under": Trial(flaws("under the floor", LOWERED), (0.01, 0.02, 0.05, 0.09)),
    "smallest": Trial(HEIGHT_SMALL, (1.0, 0.05, 0.5)),
    "tallest": Trial(HEIGHT_LARGE, (2.5, 5.0, 50.0)),
    "leap": Trial(partial(tried, is_reported=has_leaps, copies=cut), (2.0, 3.0, 8.0, 20.0)),
    "jolt": Trial(JOLT, (4.0, 3.0, 8.0, 16.0)),
    "jolt_floor": Trial(JOLT, (0.03, 0.3)),
    "jolt_ceiling": Trial(JOLT, (0.2, 0.8, 1.6)),
    "seam_jolt": Trial(against_itself, (1.0, 1.2, 2.0, 4.0)),
    "cut": Trial(CUT, (3.0, 2.0, 6.0, 12.0)),
    "cut_floor": Trial(CUT, (0.002, 0.02)),
    "cut_ceiling": Trial(CUT, (0.01, 0.04)),
    "tremble": Trial(measure_of("tremble", shaken), (2.0, 1.0, 3.0, 8.0)),
    "snap_ratio": Trial(SNAPPING, (4.0, 3.0, 8.0, 12.0)),
    "snap_floor": Trial(SNAPPING, (0.5, 1.4)),
    "snap_ceiling": Trial(SNAPPING, (1.1, 2.0, 3.0)),
    "still": Trial(STANDSTILL, (0.05, 0.005, 0.2)),
    "halting": Trial(STANDSTILL, (0.1, 0.05, 0.5)),
    "standstill": Trial(STANDSTILL, (0.05, 0.03, 0.3, 1.0)),
    "slip": Trial(measure_of("slip", sliding), (6.0, 3.0, 9.0, 20.0)),
    "foot_sliding": Trial(measure_of("foot_sliding", sliding), (1.0, 0.5, 4.0, 8.0)),
    "sliding_speed": Trial(measure_of("sliding_speed", sliding), (8.0, 4.0, 2.0, 30.0)),
    "toes": Trial(measure_of("toes", dipping), (3.0, 2.0, 7.0, 9.0)),
    "sunk": Trial(measure_of("sunk", LOWERED), (3.0, 1.0, 2.0, 9.0)),
    "aloft": Trial(measure_of("aloft", RAISED), (10.0, 15.0, 35.0)),
    "lopsided": Trial(measure_of("lopsided", lopsided), (5.0, 10.0, 40.0)),
    "bones": Trial(stretched, (2.0, 1.0, 10.0)),
    "rotation": Trial(measure_of("rotation", snapping), (1000.0, 1500.0, 3000.0, 5000.0)),
    "path": Trial(aside, (5.0, 2.0, 10.0, 25.0)),
    "shortest": Trial(measure_of("size", SMALLER), (0.5, 0.25, 1.0)),
    "longest": Trial(measure_of("size", LARGER), (1.8, 2.2, 5.0)),
    "backwards": Trial(BENT, (0.0, 5.0, 20.0, 40.0)),
    "folded": Trial(BENT, (90.0, 120.0, 170.0)),
    "about_one_axis": Trial(BENT, (0.0, 0.25, 0.9)),
    "sure_bend": Trial(BENT, (0.0, 0.2, 0.4)),
}
FIXED = {
    "flip": "in a snap an angle changes as much as its joint rotates, so any value above 1 tells them apart"
}
OTHERS = Collection(
    "CMU 02 and 49, ten clips each", cmu("02", *range(1, 11)) + cmu("49", *range(1, 11)), None
)
CMU = Collection("CMU 16, 26 walks", cmu("16", *range(11, 35), 47, 58), None)
BUNDLED = Collection("four bundled walks", WALKS, None)
STUDY = Study(limits, TRIALS, FIXED, (BUNDLED, CMU, OTHERS), None)

if __name__ == "__main__":
    STUDY.main(__doc__)
