"""Trials of the constants of editing: `python figures/tune/editing.py [--quick] [--clips FOLDER]`.

In five seconds of each clip a foot steps on a stone of 20 cm, a hand is held 37 cm away for 0.4 s, and head
and neck pass below a bar at 0.8 of the head's height. Off: the largest distance of a joint from its
constraint, mm. Shakes: the 95th percentile of accelerations within half a second of the constraints, over
the clip's own. Tips: the largest change of the trunk's direction for the hand, degrees. Neck: the largest
angle by which the head bends further against the trunk under the bar. Hips: how far the root moves for the
stone, cm. Sunk: how far a joint is lower than it may be, mm. Jolts: the largest second difference of the
toes' angle, degrees per frame². The trials of paths, cycles, stances and retargeting are in
`_editing_paths.py`.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from _editing_paths import FIXED
from _editing_paths import TRIALS as PATH_TRIALS
from _trials import Clips, Collection, Row, Study, Trial, cmu

from mocap._shared.arrays import Array, runs
from mocap.body import Motion, find_legs, joint_positions, rotations
from mocap.body.foot_joints import feet_of, toe_tips
from mocap.editing import (
    Pins,
    edit,
    hierarchy,
    join_pins,
    keep_turned,
    pin,
    pin_errors,
    plant_pins,
    posed,
    tuned,
)
from mocap.editing.foot_cleaning import raised
from mocap.editing.solver import solve
from mocap.editing.stages import Stage
from mocap.editing.toes import bend_toes, lowest_allowed
from mocap.feet import clean_up, mark_plants

SECONDS = 5.0  # of a clip
START = 0.1  # seconds; some arms snap in the first frames of captured clips
STONE = 0.2  # metres
HELD = 0.4  # seconds for which the hand is held
AHEAD = (-0.15, 0.3, 0.15)  # metres from the wrist, to the body's left, up and ahead
BAR = 0.8  # of the height of the head
WAY = 0.25  # metres before and behind the bar
EVENT = 0.5  # seconds before and after constraints in which accelerations are compared
BOW = (0.0, -0.15, 0.1)  # metres by which a head is dragged
HIGHER = 0.02  # metres by which toes are asked to be higher than they are
NOISE = ("hand", "finger", "thumb", "_end")  # of names of joints whose accelerations are those of markers


@cache
def walks(clips: Clips) -> list[Motion]:
    """Return the first seconds of clips, with clean feet."""
    starts = [clip[round(START * clip.fps) :][: round(SECONDS * clip.fps)] for clip in clips]
    return [clean_up(mark_plants(walk)) for walk in starts]


def stone(walk: Motion) -> Pins:
    """Put the second step of the left foot on a stone."""
    pins = plant_pins(walk)
    leg = find_legs(walk.skeleton)[0]
    start, stop = runs(walk.contacts[walk.skeleton.names[leg.ball]])[1]
    rise = np.zeros(pins.low.shape)
    rise[start:stop, np.isin(pins.joints, (leg.ankle, leg.ball)), 1] = STONE
    return Pins(pins.joints, pins.low + rise, pins.high + rise)


def hand(walk: Motion) -> Pins:
    """Hold the right wrist at one position, and planted feet at theirs."""
    wrist = walk.skeleton.index("rwrist")
    middle = len(walk) // 2
    half = round(HELD / 2 * walk.fps)
    offset = rotations.rotate(walk.rotations[middle, 0], AHEAD)
    position = joint_positions(walk)[middle, wrist] + offset
    return join_pins(plant_pins(walk), pin(walk, wrist, range(middle - half, middle + half), position))


def bar(walk: Motion) -> Pins:
    """Hang a bar across the path, under which head and neck must pass."""
    positions = joint_positions(walk)
    height = BAR * positions[:, walk.skeleton.index("head"), 1].mean()
    along = (walk.root_positions[-1] - walk.root_positions[0]) * [1, 0, 1]
    along /= np.linalg.norm(along)
    offsets = (positions - walk.root_positions[len(walk) // 2]) @ along
    parts = [plant_pins(walk)]
    for name in ("head", "upperneck", "lowerneck"):
        below = np.abs(offsets[:, walk.skeleton.index(name)]) < WAY
        parts.append(pin(walk, name, below, [-np.inf] * 3, [np.inf, height, np.inf]))
    return join_pins(*parts)


def shakes(motion: Motion, walk: Motion, pins: Pins) -> float:
    """Compare accelerations around constraints with the clip's own."""
    frames = np.flatnonzero(pin_errors(walk, pins).max(axis=1) > 0.01)
    margin = round(EVENT * walk.fps)
    event = slice(max(0, frames[0] - margin), frames[-1] + margin)
    joints = [n for n, name in enumerate(walk.skeleton.names) if not any(word in name for word in NOISE)]
    peaks = []
    for clip in (motion, walk):
        jumps = np.diff(joint_positions(clip)[event][:, joints], 2, axis=0)
        peaks.append(np.percentile(np.linalg.norm(jumps, axis=-1), 95))
    return float(peaks[0] / peaks[1])


def direction(motion: Motion, lower: str, upper: str) -> Array:
    """Compute the direction from a joint to another one, unit vectors (F, 3)."""
    positions = joint_positions(motion)
    vectors = positions[:, motion.skeleton.index(upper)] - positions[:, motion.skeleton.index(lower)]
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def tips(motion: Motion, walk: Motion) -> float:
    """Return the largest change of the trunk's direction, degrees."""
    cosines = (direction(motion, "root", "lowerneck") * direction(walk, "root", "lowerneck")).sum(axis=-1)
    return float(np.degrees(np.arccos(np.clip(cosines, -1, 1)).max()))


def neck_bend(motion: Motion) -> Array:
    """Compute the angles between trunk and neck, (F,), degrees."""
    cosines = (direction(motion, "root", "lowerneck") * direction(motion, "lowerneck", "head")).sum(axis=-1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosines, -1, 1))))


def edited(clips: Clips) -> Row:
    """Edit all walks: a stone, a hand and a bar each."""
    return _measured(clips, edit)


def upright(clips: Clips) -> Row:
    """Hold a hand of each walk while the trunk keeps its rotation."""
    errors = []
    turned = []
    shaken = []
    for walk in walks(clips):
        trunk = keep_turned(walk, "thorax", slice(None))
        pins = join_pins(hand(walk), trunk)
        motion = edit(walk, pins)
        errors.append(1000 * float(pin_errors(motion, hand(walk)).max()))
        turned.append(float(np.degrees(pin_errors(motion, trunk).max() / tuned.TUNED.arm)))
        shaken.append(shakes(motion, walk, pins))
    return {"off, mm": max(errors), "trunk turned, °": max(turned), "shakes, worst": max(shaken)}


def levelled(clips: Clips) -> Row:
    """Edit all walks by levels."""
    return _measured(clips, lambda walk, pins: hierarchy(walk, pins)[0])


def reached(clips: Clips) -> Row:
    """Bring each frame by itself to its constraints."""
    chosen = tuned.TUNED
    stage = Stage(weight=chosen.reach_weight, damping=chosen.reach_damping, passes=chosen.reach_passes)
    return _measured(clips, lambda walk, pins: solve(walk, pins, [stage]).motion)


def _measured(clips: Clips, method: Callable[[Motion, Pins], Motion]) -> Row:
    """Measure a method by the requests above."""
    errors = []
    shaken = []
    tipped = []
    bent = []
    hips = []
    for walk in walks(clips):
        for request in (stone, hand, bar):
            pins = request(walk)
            motion = method(walk, pins)
            errors.append(1000 * float(pin_errors(motion, pins).max()))
            shaken.append(shakes(motion, walk, pins))
            if request is stone:
                moved = np.linalg.norm(motion.root_positions - walk.root_positions, axis=-1)
                hips.append(100 * float(moved.max()))
            elif request is hand:
                tipped.append(tips(motion, walk))
            else:
                bent.append(float((neck_bend(motion) - neck_bend(walk)).max()))
    row = {"off, mm": max(errors), "shakes, mean": float(np.mean(shaken)), "shakes, worst": max(shaken)}
    return row | {"tips, °": max(tipped), "neck, °": max(bent), "hips, cm": max(hips)}


def dragged(clips: Clips) -> Row:
    """Drag the head down, and a hand away, near and almost out of reach, in single poses."""
    errors = []
    tipped = []
    bent = []
    for walk in walks(clips):
        wrist = walk.skeleton.index("rwrist")
        for frame in (len(walk) // 3, len(walk) // 2):
            pose = walk[frame : frame + 1]
            for factor in (1.0, 2.0):
                offset = factor * rotations.rotate(walk.rotations[frame, 0], AHEAD)
                position = joint_positions(pose)[0, wrist] + offset
                result = posed(walk, frame, {"rwrist": position})
                errors.append(1000 * float(np.linalg.norm(joint_positions(result)[0, wrist] - position)))
                tipped.append(tips(result, pose))
        middle = len(walk) // 2
        pose = walk[middle : middle + 1]
        head = joint_positions(pose)[0, walk.skeleton.index("head")]
        result = posed(walk, middle, {"head": head + np.array(BOW)})
        bent.append(float((neck_bend(result) - neck_bend(pose)).max()))
    row = {"off, mm": max(errors), "tips, °": max(tipped), "tips, mean": float(np.mean(tipped))}
    return row | {"neck, °": max(bent)}


def toes(clips: Clips) -> Row:
    """Bend toes so that their tips are 2 cm higher than they ever were."""
    sunk = []
    jolts = []
    for walk in walks(clips):
        feet = feet_of(walk)
        allowed = lowest_allowed(walk, feet) + HIGHER
        result = bend_toes(walk, allowed, feet)
        for leg in find_legs(walk.skeleton):
            tip_joints = toe_tips(walk.skeleton, leg)
            below = allowed[:, tip_joints] - joint_positions(result)[:, tip_joints, 1]
            sunk.append(1000 * float(below.max(initial=0.0)))
            angles = rotations.angle_between(walk.rotations[:, leg.ball], result.rotations[:, leg.ball])
            jolts.append(float(np.degrees(np.abs(np.diff(angles, 2)).max())))
    return {"sunk, mm": max(sunk), "jolts, °": max(jolts)}


def sunken(clips: Clips) -> Row:
    """Raise walks that are 2 mm and 6 mm too low."""
    changed = 0
    sunk = []
    for walk in walks(clips):
        feet = feet_of(walk)
        allowed = lowest_allowed(walk, feet)
        for metres in (0.002, 0.006):
            low = replace(walk, root_positions=walk.root_positions - [0, metres, 0])
            result = raised(low, allowed - metres, feet)
            changed += not np.array_equal(result.root_positions, low.root_positions)
            sunk.append(1000 * max(0.0, -float(joint_positions(result)[..., 1].min())))
    return {"changed": changed, "sunk, mm": max(sunk)}


BUNDLED = Collection("two bundled walks", ("walk_straight", "walk_curve_1"))
CAPTURED = Collection("CMU 16, 02 and 49", (*cmu("16", 15, 58), *cmu("02", 1), *cmu("49", 1)), 60.0)

# reads: statement: a table
TRIALS = {
    "arm": Trial(upright, (0.03, 0.1, 1.0)),
    "effort": Trial(edited, (0.02, 0.3, 3.0)),
    "trunk": Trial(edited, (1.0, 4.0, 64.0)),
    "neck": Trial(edited, (1.0, 16.0, 64.0)),
    "pose_trunk": Trial(dragged, (1.0, 4.0, 64.0)),
    "pose_neck": Trial(dragged, (1.0, 64.0)),
    "level_trunk": Trial(levelled, (1.0, 16.0)),
    "level_neck": Trial(levelled, (1.0, 32.0)),
    "knots": Trial(edited, (0.5, 0.06, 0.25)),
    "decay": Trial(edited, (0.0, 0.1, 0.5)),
    "weight": Trial(edited, (1000.0, 10.0)),
    "lead": Trial(edited, (0.0, 0.1, 0.5)),
    "close_decay": Trial(edited, (0.02, 0.12)),
    "close_weight": Trial(edited, (1e4, 1e5)),
    "close_damping": Trial(edited, (1.0, 10.0)),
    "reach_weight": Trial(reached, (10.0, 1000.0)),
    "reach_damping": Trial(reached, (1.0, 0.1)),
    "reach_passes": Trial(reached, (4, 30)),
    "pose_weight": Trial(dragged, (300.0, 100.0)),
    "pose_damping": Trial(dragged, (1.0, 0.1)),
    "pose_passes": Trial(dragged, (8, 20)),
    "level_passes": Trial(levelled, (2, 16)),
    "gain": Trial(edited, (1e-3, 1e-6)),
    "loss": Trial(edited, (3e-5, 1e-8)),
    "fall": Trial(edited, (2.0, 10.0)),
    "rise": Trial(edited, (3.0, 30.0)),
    "leap": Trial(edited, (3.0, 0.1)),
    "bar_damping": Trial(edited, (1.0, 100.0, 10_000.0)),
    "margin": Trial(edited, (0.3, 3.0)),
    "sunk": Trial(sunken, (0.001, 0.01)),
    "toe_ease": Trial(toes, (0.0, 0.15)),
    "toe_bend": Trial(toes, (0.35, 1.0)),
    "toe_level": Trial(toes, (0.1, 1.2)),
}
STUDY = Study(tuned, TRIALS | PATH_TRIALS, FIXED, (BUNDLED, CAPTURED), 60.0)

if __name__ == "__main__":
    STUDY.main(__doc__)
