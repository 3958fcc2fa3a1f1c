"""Trials of the constants of the clean-up: `python figures/tune/feet.py [--quick]`.

Clips with sliding feet are cleaned up: walks whose root is pushed about, and captured walks and runs, at the
rate at which they are captured. Snap: the largest second difference of a knee's angle from frame to frame,
over the largest one in the second around it before. Root: the same ratio for the root's position. Kept:
planted frames that are kept, percent. Shake: the 99th percentile of the joints' accelerations, over the one
before. List: the largest rotation of the pelvis, degrees.

The constants of plants that cannot be held are tried on marks that are 0.23 s too long at both ends of each
plant of the first foot, and on steps that are 1.4 times as long. Kept: frames that are still marked of those
that were marked before the marks became longer, percent.
"""

import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from _trials import Clips, Collection, Row, Study, Trial, cmu

sys.path.append(str(Path(__file__).parents[1]))
from clean_knees import LEAST_SNAP, Strain, knee_angles, measure, snaps

from mocap.body import Motion, joint_positions, rotations
from mocap.feet import clean_up, mark_plants, tuned

PUSH = 0.006  # metres, the amplitude of sines that push the root
SECONDS = 5.0  # of a clip


@cache
def sliding(clips: Clips) -> list[Motion]:
    """Push the roots of clips about, so that feet slide, and mark footplants."""
    motions = []
    for clip in clips:
        motion = clip[: round(SECONDS * clip.fps)]
        push = PUSH * np.sin(np.arange(len(motion))[:, None] / motion.fps * [5, 7, 3])
        motions.append(mark_plants(replace(motion, root_positions=motion.root_positions + push)))
    return motions


def shaking(motion: Motion) -> float:
    """Return the 99th percentile of second differences of positions, metres."""
    jumps = np.linalg.norm(np.diff(joint_positions(motion), 2, axis=0), axis=-1)
    return float(np.percentile(jumps, 99))


def cleaned(clips: Clips) -> Row:
    """Clean all clips up."""
    snap = []
    root = []
    kept = []
    shake = []
    lists = []
    for motion in sliding(clips):
        result = clean_up(motion)
        snap.append(snaps(knee_angles(motion), knee_angles(result), motion.fps, LEAST_SNAP / motion.fps**2))
        root.append(snaps(motion.root_positions, result.root_positions, motion.fps, 1e-3))
        planted = np.array(list(motion.contacts.values()))
        held = np.array([result.contacts[name] for name in motion.contacts])
        kept.append(100 * float((held & planted).sum() / planted.sum()))
        shake.append(shaking(result) / shaking(motion))
        turned = rotations.angle_between(motion.rotations[:, 0], result.rotations[:, 0])
        lists.append(float(np.degrees(turned.max())))
    row = {"snap, worst": max(snap), "snap, mean": float(np.mean(snap)), "root, worst": max(root)}
    return row | {"kept, %": min(kept), "shake, worst": max(shake), "list, °": max(lists)}


def strained(clips: Clips) -> Row:
    """Clean up clips whose marks are too long, and clips whose steps are."""
    row: dict[str, object] = {}
    strains = {"long marks": Strain(marks=0.23, steps=1.0), "long steps": Strain(marks=0.0, steps=1.4)}
    for kind, strain in strains.items():
        rows = [measure(clip[: round(SECONDS * clip.fps)], strain) for clip in clips]
        planted = sum(result.planted for result in rows)
        row[f"{kind}: kept, %"] = 100 * sum(result.kept for result in rows) / planted
        row[f"{kind}: snap, worst"] = max(result.snap for result in rows)
    return row


WALKS = Collection("bundled walks, a sneak and stops", ("walk_straight", "sneak", "stop_and_go"), None)
CAPTURED = Collection("CMU 16, ten walks and runs", cmu("16", *range(15, 22), 35, 42, 45), None)
QUIET = Collection("CMU 02 and 49, quiet and straight legs", (*cmu("02", 5, 8), *cmu("49", 9, 16, 18)), None)

# reads: statement: a table
TRIALS = {
    "root": Trial(cleaned, (1.0, 6.0)),
    "list": Trial(cleaned, (2.0, 10.0)),
    "knee": Trial(cleaned, (1.0, 4.0)),
    "foot": Trial(cleaned, (1.5, 8.0)),
    "angle": Trial(cleaned, (3.0, 30.0)),
    "bent": Trial(cleaned, (30.0, 300.0)),
    "closed": Trial(cleaned, (100.0, 300.0, 3000.0)),
    "fade": Trial(cleaned, (0.05, 0.1)),
    "list_fade": Trial(cleaned, (0.01, 0.04)),
    "angle_fade": Trial(cleaned, (0.1, 0.24)),
    "swing_fade": Trial(cleaned, (0.02, 0.1)),
    "fade_frames": Trial(cleaned, (0.0, 4.0)),
    "flexion": Trial(cleaned, (8.0, 15.0)),
    "fall": Trial(strained, (0.008, 0.025)),
    "pulls": Trial(strained, (1, 8)),
    "move": Trial(strained, (0.25, 0.8)),
    "falls": Trial(strained, (0.0, 0.99)),
    "blame": Trial(strained, (0.2, 0.05)),
    "released": Trial(strained, (0.8, 0.25)),
    "steps": Trial(cleaned, (10, 40)),
    "gain": Trial(cleaned, (1e-2, 1e-4)),
}
STUDY = Study(tuned, TRIALS, {}, (WALKS, CAPTURED, QUIET), None)

if __name__ == "__main__":
    STUDY.main(__doc__)
