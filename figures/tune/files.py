"""Trials of the constants of files: `python figures/tune/files.py [--quick] [--clips FOLDER ...]`.

The clips are written to files as other programs might have written them, and read again.

- `stretch`, `strayed`, `rotation_weight`: the shins of a .bvh file change their length by 0.5, 1, 3 and 6 cm
  in the course of the clip. Read: the percentage of files that are read. Off: the largest distance of a joint
  from its position in these files. Twist: the largest angle between a joint's rotation and the file's.
- `along_z`, `upright`: half of the files have z up. Right: the percentage of clips that have y up in the end.
- `carried`: a .glb file. Size: its kilobytes; off: the largest distance of a joint, micrometres, by the
  rounding of rotations.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from _trials import WALKS, Clips, Collection, Row, Study, Trial, cmu

import mocap
from mocap.body import Motion, find_legs, rotations
from mocap.body.kinematics import joint_positions
from mocap.files import tuned
from mocap.files.gltf import LARGEST_INT16
from mocap.files.gltf_capsules import reaches
from mocap.files.rigid_bones import fit

CHANGES = (0.005, 0.01, 0.03, 0.06)  # metres by which bones change their length
FRAMES = 150  # of a clip


def short(clips: Clips) -> Clips:
    """Return the beginnings of the clips."""
    return tuple(clip[:FRAMES] for clip in clips)


def stretched(clips: Clips) -> Row:
    """Fit rigid bones to bones that change their length."""
    limit = tuned.TUNED.stretch
    read = 0
    distances = [0.0]
    twists = [0.0]
    for clip in short(clips):
        for change in CHANGES:
            positions = changed(clip, change)
            parents = np.array(clip.skeleton.parents)
            _, fitted, stretch, strayed = fit(parents, positions, clip.rotations)
            twists.append(float(rotations.angle_between(fitted, clip.rotations).max()))
            if stretch.max() <= limit and strayed.max() <= tuned.TUNED.strayed * limit:
                read += 1
                distances.append(float(strayed.max()))
    row = {"read, %": 100 * read / (len(clips) * len(CHANGES)), "off, mm": 1000 * max(distances)}
    return row | {"twist, °": float(np.degrees(max(twists)))}


def changed(clip: Motion, metres: float) -> np.ndarray:
    """Return each joint's position in its parent's frame, with shins that grow and shrink."""
    waves = metres * np.sin(np.linspace(0, 4 * np.pi, len(clip)))[:, None]
    positions = np.tile(clip.skeleton.offsets, (len(clip), 1, 1))
    for leg in find_legs(clip.skeleton):
        shin = clip.skeleton.offsets[leg.ankle]
        positions[:, leg.ankle] += waves * shin / np.linalg.norm(shin)
    positions[:, 0] = clip.root_positions
    return positions


def turned(clips: Clips) -> Row:
    """Write clips with y up and with z up, and read which way is up."""
    right = []
    for clip in short(clips):
        for is_z_up in (False, True):
            motion = lying(clip) if is_z_up else clip
            heights = joint_positions(saved(motion, ".bvh"))[..., 1]
            right.append(bool(np.median(np.ptp(heights, axis=1)) > 1.0))
    return {"right, %": 100 * float(np.mean(right))}


def lying(clip: Motion) -> Motion:
    """Write a clip in coordinates whose z is up."""
    up = np.array([0.5**0.5, 0.5**0.5, 0.0, 0.0])
    local = rotations.multiply(rotations.multiply(up, clip.rotations), rotations.inverse(up))
    skeleton = replace(clip.skeleton, offsets=rotations.rotate(up, clip.skeleton.offsets))
    return Motion(skeleton, rotations.rotate(up, clip.root_positions), local, clip.fps, clip.name)


def saved(clip: Motion, suffix: str) -> Motion:
    """Save a clip, and load it again."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"clip{suffix}")
        mocap.save(clip, path)
        return mocap.load(path)


def binary(clips: Clips) -> Row:
    """Save a .glb file; round the rotations of its joints as the file does."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "clip.glb")
        sizes = []
        for clip in short(clips):
            mocap.save(clip, path)
            sizes.append(path.stat().st_size)
    errors = [rounding(clip) for clip in short(clips)]
    return {"size, kB": float(np.mean(sizes)) / 1000, "off, µm": 1e6 * max(errors)}


def rounding(clip: Motion) -> float:
    """Return the largest distance of a joint, metres, when rotations are rounded as in the file."""
    rounded = clip.rotations.copy()
    is_short = np.array(reaches(clip.skeleton)) <= tuned.TUNED.carried
    integers = np.round(LARGEST_INT16 * rounded[:, is_short])
    rounded[:, is_short] = integers / np.linalg.norm(integers, axis=-1, keepdims=True)
    difference = joint_positions(replace(clip, rotations=rounded)) - joint_positions(clip)
    return float(np.linalg.norm(difference, axis=-1).max())


SHORT = Collection("four bundled walks", WALKS)
MIXED = Collection("CMU 02 and 49, ten clips each", cmu("02", *range(1, 11)) + cmu("49", *range(1, 11)))

# reads: statement: a table
TRIALS = {
    "stretch": Trial(stretched, (0.002, 0.005, 0.05, 0.1)),
    "strayed": Trial(stretched, (1.0, 2.0, 5.0)),
    "rotation_weight": Trial(stretched, (0.0, 1e-4, 1e-2, 1.0)),
    "along_z": Trial(turned, (0.99, 0.5, 0.7, 0.9)),
    "upright": Trial(turned, (0.99, 0.1, 0.3, 0.8)),
    "carried": Trial(binary, (2.0, 0.0, 0.1, 0.5)),
}
STUDY = Study(tuned, TRIALS, {}, (SHORT, MIXED))

if __name__ == "__main__":
    STUDY.main(__doc__)
