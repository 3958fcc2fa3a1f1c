"""Measure the loops of many clips: `python figures/loops.py FOLDER`.

Writes the table `loops.md` beside this script. The folder holds `cmu` and `bvh`.
"""

import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import mocap
from mocap.editing.cycles import find_loop, loop, seam_jolt
from mocap.errors import MocapError, MocapWarning

PAGE = Path(__file__).with_name("loops.md")
TRIALS = {
    "02": (1, 3, 4, 5, 6, 7, 10),
    "16": (1, 5, 8, 11, 17, 22, 33, 35, 41, 58),
    "49": (1, 2, 6, 9, 15, 18, 22),
    "127": (3, 5, 17, 25),
}
PATTERNS = ("bvh/bandai_namco/*.bvh", "bvh/20tab/test_mocapbank.bvh")
RATE = 30.0  # frames per second at which motion is compared


def clips(folder: Path) -> Iterator[mocap.Motion]:
    """Load the clips."""
    for subject, trials in TRIALS.items():
        for trial in trials:
            yield mocap.load(folder / "cmu" / subject / f"{subject}_{trial:02}.amc")
    for pattern in PATTERNS:
        for path in sorted(folder.glob(pattern)):
            yield mocap.load(path)


def mean_speed(motion: mocap.Motion) -> float:
    """Measure the mean speed of all joints, metres per second."""
    steps = np.diff(mocap.resample(motion, RATE).positions, axis=0)
    return float(np.linalg.norm(steps, axis=-1).mean() * RATE)


def row(clip: mocap.Motion) -> str:
    """Write the row of a clip."""
    try:
        cycle = find_loop(clip)
        closed = loop(clip, cycle)
    except MocapError as error:
        return f"| {clip.name} | {clip.duration:.1f} | refused: {error} | | | | |"
    seconds = f"{clip.duration:.1f} | {closed.duration:.2f}"
    distances = f"{100 * cycle.seam:.1f} | {100 * cycle.missed:.1f}"
    moves = f"{mean_speed(closed) / mean_speed(clip):.2f}"
    return f"| {clip.name} | {seconds} | {distances} | {moves} | {seam_jolt(clip, closed):.1f} |"


HEAD = """# The loops of many clips

`python figures/loops.py` writes this page. Seam: the distance between the ends of a cycle. Missed: the mean
distance of the other frames of the clip from the cycle; beyond some 10 cm the clip holds no whole cycle, and
`mocap loop` says so. Moves: the mean speed of the joints in the cycle, relative to that in the clip. Jolt:
the largest acceleration in the seam, relative to the 99th percentile in the clip, which `mocap loop` prints.

| clip | seconds | cycle, s | seam, cm | missed, cm | moves | jolt |
|---|---|---|---|---|---|---|"""


def main() -> None:
    """Write the table."""
    warnings.simplefilter("ignore", MocapWarning)
    lines = [HEAD]
    for clip in clips(Path(sys.argv[1])):
        lines.append(row(clip))
        print(lines[-1], flush=True)
    PAGE.write_text("\n".join([*lines, ""]), "utf-8")


if __name__ == "__main__":
    main()
