"""CPU time of an edit of 0.2 s in a clip of ten minutes: `python figures/long_clip_edit.py`.

The clip repeats the bundled walks, at 30 Hz. A hand must reach 15 cm higher for 0.2 s, in the middle of it.
Printed are the median CPU time of five edits, and whether all frames more than a second away are unchanged to
the bit.
"""

from __future__ import annotations

import time

import numpy as np

from mocap import Motion, concatenate, datasets, resample
from mocap.editing import edit, pin

WALKS = ("walk_straight", "walk_curve_1", "walk_curve_2", "stop_and_go")
RATE = 30.0  # Hz
MINUTES = 10
EDITED = 0.2  # seconds
RISE = np.array([0.0, 0.15, 0.0])  # metres
FAR = 1.0  # seconds from the edit: frames beyond stay
TRIALS = 5


def long_clip() -> Motion:
    """Repeat the bundled walks for ten minutes."""
    walks = [resample(datasets.sample(name), RATE) for name in WALKS]
    frames = round(60 * MINUTES * RATE)
    rounds = 1 + frames // sum(len(walk) for walk in walks)
    return concatenate(walks * rounds, "ten minutes")[:frames]


def timed_edit(clip: Motion, start: int) -> tuple[float, Motion]:
    """Raise a hand from a frame; return the CPU time of the edit, seconds, and its result."""
    stop = start + round(EDITED * RATE)
    wrist = clip.skeleton.index("lwrist")
    reached = clip[start:stop].positions[:, wrist] + RISE
    began = time.process_time()
    constraint = pin(clip, "lwrist", range(start, stop), reached)
    edited = edit(clip, constraint)
    return time.process_time() - began, edited


def main() -> None:
    """Print the CPU time, and whether far frames are unchanged."""
    clip = long_clip()
    start = len(clip) // 2
    trials = [timed_edit(clip, start) for _ in range(TRIALS)]
    edited = trials[0][1]
    frames = np.arange(len(clip))
    margin = round(FAR * RATE)
    is_far = (frames < start - margin) | (frames >= start + round(EDITED * RATE) + margin)
    unchanged = np.array_equal(edited.rotations[is_far], clip.rotations[is_far])
    unchanged &= np.array_equal(edited.root_positions[is_far], clip.root_positions[is_far])
    seconds = np.median([cpu for cpu, _ in trials])
    print(f"{len(clip)} frames: {seconds:.2f} CPU-s; frames farther than {FAR:g} s unchanged: {unchanged}")


if __name__ == "__main__":
    main()
