"""Trials of the constants of files: `python figures/tune/files.py [--quick] [--clips FOLDER ...]`.

The clips are written to files as other programs might have written them, and read again.

- `stretch`, `strayed`, `rotation_weight`: the shins of a .bvh file change their length by 0.5, 1, 3 and 6 cm
  in the course of the clip. Read: the percentage of files that are read. Off: the largest distance of a joint
  from its position in these files. Twist: the largest angle between a joint's rotation and the file's.
- All constants of the space, from `least_joints` to `still_foot`: each clip is written in five units, with y
  and with z up. Right: the percentage of the spaces that are found. Wrong in silence: the percentage that is
  read in another space without a word.
- `root_height`, `floor_error`: each clip on its floor, and with its hips at 0, as if its positions were
  relative to the root's offset, which is 5 cm too high, right, or too low. Right: the percentage of clips in
  which it is known whether to add the offset.
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
from mocap.body.skeleton import reaches
from mocap.files import tuned
from mocap.files.gltf import LARGEST_INT16
from mocap.files.rigid_bones import fit
from mocap.files.space_evidence import frames_to_look_at, gather
from mocap.files.spaces import UPRIGHT, decide

CHANGES = (0.005, 0.01, 0.03, 0.06)  # metres by which bones change their length
FRAMES = 150  # of a clip
TRIED_UNITS = (1.0, 0.1, 0.01, 0.0254, 0.056444)  # metres


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


def in_spaces(clips: Clips) -> Row:
    """Write clips in several units, with y and with z up, and decide their space again."""
    right = silent = 0
    spaces = [(unit, up) for unit in TRIED_UNITS for up in ("y", "z")]
    for clip in clips:
        frames, rate = frames_to_look_at(clip.root_positions, clip.fps)
        positions = joint_positions(clip)[frames]
        for unit, up in spaces:
            turned = rotations.rotate(rotations.inverse(UPRIGHT[up]), positions / unit)
            evidence = gather(clip.skeleton.parents, turned, rate)
            space = decide([evidence] if evidence else [], (0.01, "y"), scale=None, up=None)
            is_right = (space.scale, space.up) == (unit, up)
            right += is_right
            silent += not is_right and not space.sentence({"scale": "scale=", "up": "up="})
    count = len(clips) * len(spaces)
    return {"right, %": 100 * right / count, "wrong in silence, %": 100 * silent / count}


def with_offsets(clips: Clips) -> Row:
    """Decide whether to add the root's offset, for clips on their floor and clips with their hips at 0."""
    decided: list[bool] = []
    for clip in clips:
        frames, rate = frames_to_look_at(clip.root_positions, clip.fps)
        positions = joint_positions(clip)[frames]
        hips = float(np.median(clip.root_positions[:, 1]))
        for error in (-0.05, 0.0, 0.05):
            offset = np.array([0.0, hips + error, 0.0])
            for shift, use in ((0.0, "ignore"), (hips, "add")):
                evidence = gather(clip.skeleton.parents, positions - [0.0, shift, 0.0], rate, offset)
                space = decide([evidence] if evidence else [], (1.0, "y"), scale=1.0, up="y")
                decided.append(space.root_offset == use)
    return {"right, %": 100 * float(np.mean(decided))}


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

SPACES = {
    "least_joints": (3, 20, 50),
    "looked_at_rate": (10.0, 60.0),
    "looked_at_frames": (100, 1000),
    "moving_speed": (0.0, 0.1, 0.5),
    "sideways_travel": (0.1, 2.0),
    "mirrored_bones": (0.01, 0.3),
    "airborne": (0.01, 0.1),
    "air_frames": (4, 12),
    "air_time": ((0.05, 3.0), (0.3, 0.8)),
    "parabola_error": (0.001, 0.02),
    "fall_acceleration": ((0.1, 400.0), (4.0, 20.0)),
    "least_seconds": (0.8, 3.0),
    "shortest_cycle": (0.2, 0.7),
    "longest_cycle": (1.0, 4.0),
    "repeated_pose": (0.1, 0.6),
    "adult_height": ((1.55, 0.06), (1.55, 0.24), (1.4, 0.12)),
    "sure_height": ((1.4, 1.7), (1.0, 2.5)),
    "likely_height": ((1.5, 1.8), (0.5, 3.0)),
    "person_height": ((1.2, 1.9), (0.1, 5.0)),
    "default_height": ((0.5, 3.0), (0.01, 100.0)),
    "sure_unit": (0.8, 0.99),
    "probable_unit": (0.5, 0.95),
    "common_units": ((0.01,), (1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.056444)),
    "confirming_clock": (0.2, 1.0),
    "refuting_clock": (0.3, 2.0),
    "clock_weight": (1.0, 8.0),
    "sure_axis": (0.3, 3.0),
    "probable_axis": (1.0, 4.0),
    "still_foot": (0.0, 0.2, 0.7),
}
# reads: statement: a table
TRIALS = {
    "stretch": Trial(stretched, (0.002, 0.005, 0.05, 0.1)),
    "strayed": Trial(stretched, (1.0, 2.0, 5.0)),
    "rotation_weight": Trial(stretched, (0.0, 1e-4, 1e-2, 1.0)),
    **{name: Trial(in_spaces, values) for name, values in SPACES.items()},
    "root_height": Trial(with_offsets, (0.05, 0.45, 0.6)),
    "floor_error": Trial(with_offsets, (0.02, 0.05, 0.2)),
    "carried": Trial(binary, (2.0, 0.0, 0.1, 0.5)),
}
FIXED = {
    "same_body": "between the ratio of two adults, 1.3, and that of two units, 1.77 (5.64 cm and 1 dm)",
    "carried_length": "above the length of a hand that has fingers on one side only; swords are longer",
    "frames_of_props": "the lengths of bones do not change; more frames only take longer",
}
STUDY = Study(tuned, TRIALS, FIXED, (SHORT, MIXED))

if __name__ == "__main__":
    STUDY.main(__doc__)
