"""How clean-up changes knees, feet and the root, clip by clip and rate by rate.

    python figures/clean_knees.py [--rates 30 60 120] [--seconds 12] [--only WORD ...]
                                  [--longer-marks SECONDS] [--longer-steps FACTOR]

The clips are the bundled ones and those of the folder that `MOCAP_DATA` names, which are skipped if it is not
there. Clips on which constants of the clean-up were chosen are summed up apart from those held out: subject
127 of the CMU database without trial 4, and a clip of subject 11.

Marks may be made longer at both ends of each plant of the first foot, by seconds, and steps by a factor.

Snap: the largest second difference of a knee's angle from frame to frame, over the largest one in the second
around it before the clean-up; 1.6 can hardly be seen. Angular accelerations below 1440 degrees/s² count as so
much, 0.1 degrees from frame to frame at 120 Hz: straight legs of some captured clips are straight to the last
digit, and have to bend. Root: the same ratio for the root's position. Slide: the largest distance of a
planted joint from its mean position, before and after, millimetres. Kept: frames in which a foot is marked,
and is still afterwards, percent; longer marks do not count. Rise and list: the largest changes of the root's
height, millimetres, and of the direction of the pelvis, degrees.
"""

import argparse
import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d

import mocap
from mocap import datasets, feet
from mocap._shared.arrays import Array
from mocap.body import Motion, find_legs, joint_positions, resample, rotations
from mocap.errors import MocapError

CHOSEN_ON = (
    "02/*.amc",
    "03/*.amc",
    "16/*.amc",
    "49/*.amc",
    "../hw3/*.AMC",
    "../bvh/*/*.bvh",
    "127/127_04.amc",
)
HELD_OUT = ("127/127_0[!4].amc", "127/127_[!0]*.amc", "../odd/fairmotion/11*.amc")
RATES = (30.0, 60.0, 120.0)  # frames per second
AROUND = 0.5  # seconds before and after a frame, in which is what is usual
LEAST_SNAP = 1440.0  # degrees per second squared
LEAST_JUMP = 0.001  # metres, of the root
VISIBLE = 1.6  # times what is usual


class Row(NamedTuple):
    """What clean-up does to a clip."""

    snap: float
    root: float
    slide_before: float
    slide: float
    kept: int
    planted: int
    rise: float
    list: float


def bundled() -> Iterator[tuple[str, Callable[[], Motion]]]:
    """Yield the names of the bundled clips, and functions that load them."""
    for name in datasets.SAMPLES:
        yield name, lambda name=name: datasets.sample(name)


def captured(folder: Path, patterns: Sequence[str]) -> Iterator[tuple[str, Callable[[], Motion]]]:
    """Yield the names of clips in a folder, and functions that load them."""
    for pattern in patterns:
        paths = sorted(folder.glob(pattern))
        if not paths:
            print(f"{pattern}: not in {folder}.")
        for path in paths:
            yield f"{path.parent.name[:8]}/{path.stem}", lambda path=path: mocap.load(path)


def knee_angles(motion: Motion) -> Array:
    """Return the angles of the knees between thigh and shank, (F, L), degrees."""
    positions = joint_positions(motion)
    angles = []
    for leg in find_legs(motion.skeleton):
        thigh = positions[:, leg.hip] - positions[:, leg.knee]
        shank = positions[:, leg.ankle] - positions[:, leg.knee]
        across = np.linalg.norm(np.cross(thigh, shank), axis=-1)
        angles.append(np.degrees(np.arctan2(across, (thigh * shank).sum(axis=-1))))
    return np.stack(angles, axis=-1)


def snaps(original: Array, changed: Array, fps: float, floor: float) -> float:
    """Return the largest second difference of curves (F, C) over what is usual around it, or over `floor`."""
    usual = np.abs(np.diff(original, 2, axis=0))
    window = 2 * round(AROUND * fps) + 1
    usual = maximum_filter1d(usual, window, axis=0, mode="nearest")
    return float((np.abs(np.diff(changed, 2, axis=0)) / np.maximum(usual, floor)).max())


def slide(motion: Motion) -> float:
    """Return the largest distance of a planted joint from its mean position, millimetres."""
    positions = joint_positions(motion)
    largest = 0.0
    for name, mark in motion.contacts.items():
        joint = motion.skeleton.index(name)
        for start, stop in feet.runs(mark):
            plant = positions[start:stop, joint]
            largest = max(largest, float(np.linalg.norm(plant - plant.mean(axis=0), axis=-1).max()))
    return 1000 * largest


class Strain(NamedTuple):
    """What makes a clip hard to clean up: marks longer by seconds, and steps by a factor."""

    marks: float
    steps: float

    def on(self, motion: Motion) -> Motion:
        """Make the marks and the steps of a marked motion longer."""
        roots = motion.root_positions * [self.steps, 1.0, self.steps]
        first = find_legs(motion.skeleton)[0]
        width = 2 * round(self.marks * motion.fps) + 1
        contacts = dict(motion.contacts)
        for name in {motion.skeleton.names[joint] for joint in (first.ankle, first.ball)} & set(contacts):
            contacts[name] = maximum_filter1d(contacts[name], width)
        return replace(motion, root_positions=roots, contacts=contacts)


def measure(motion: Motion, strain: Strain) -> Row:
    """Clean a motion up, and measure what has changed."""
    marks = feet.mark_plants(motion).contacts
    marked = strain.on(replace(motion, contacts=marks))
    cleaned = feet.clean_up(marked)
    angles = knee_angles(marked)
    kept = [np.sum(cleaned.contacts[name] & mark) for name, mark in marks.items()]
    planted = sum(mark.sum() for mark in marks.values())
    lists = rotations.angle_between(marked.rotations[:, 0], cleaned.rotations[:, 0])
    rises = np.abs(cleaned.root_positions - marked.root_positions)
    snap = snaps(angles, knee_angles(cleaned), motion.fps, LEAST_SNAP / motion.fps**2)
    root = snaps(marked.root_positions, cleaned.root_positions, motion.fps, LEAST_JUMP)
    slides = (slide(marked), slide(cleaned))
    changes = (1000 * float(rises.max()), float(np.degrees(lists.max())))
    return Row(snap, root, *slides, int(sum(kept)), int(planted), *changes)


HEAD = f"{'':<42}{'Hz':>5}{'snap':>7}{'root':>7}{'slide':>8}{'':>10}{'kept':>9}{'rise':>7}{'list':>6}"


def line(name: str, rate: float, row: Row) -> str:
    """Write a row of the table."""
    kept = 100 * row.kept / max(row.planted, 1)
    ratios = f"{row.snap:7.2f}{row.root:7.2f}"
    slides = f"{row.slide_before:8.1f}{row.slide:10.6f}"
    changes = f"{row.rise:7.1f}{row.list:6.2f}"
    return f"{name[:41]:<42}{rate:5.0f}{ratios}{slides}{kept:9.2f}{changes}"


def summary(rate: float, rows: list[Row]) -> str:
    """Write what holds of all clips at a rate."""
    ratios = np.array([row.snap for row in rows])
    quantiles = np.percentile(ratios, [50, 95, 100])
    kept = 100 * sum(row.kept for row in rows) / sum(row.planted for row in rows)
    seen = f"{(ratios > VISIBLE).sum()} of {len(rows)} clips above {VISIBLE}"
    spread = "median {:.2f}, 95 % {:.2f}, worst {:.2f}".format(*quantiles)
    slides = max(row.slide for row in rows)
    return f"{rate:.0f} Hz: snap {spread}, {seen}; slide at most {slides:.6f} mm; kept {kept:.2f} %"


Table = dict[float, list[Row]]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--rates", nargs="+", type=float, default=RATES)
    parser.add_argument("--seconds", type=float, default=12.0, help="of each clip")
    parser.add_argument("--only", nargs="+", default=[""], help="clips whose names have one of these words")
    parser.add_argument("--longer-marks", type=float, default=0.0, help="seconds, at both ends of a plant")
    parser.add_argument("--longer-steps", type=float, default=1.0, help="factor")
    options = parser.parse_args()
    strain = Strain(options.longer_marks, options.longer_steps)
    warnings.simplefilter("ignore", mocap.MocapWarning)
    folder = Path(os.environ.get("MOCAP_DATA", "."))
    parts = {
        "chosen on": [*bundled(), *captured(folder, CHOSEN_ON)],
        "held out": captured(folder, HELD_OUT),
    }
    print(HEAD)
    tables: dict[str, Table] = {}
    for part, clips in parts.items():
        tables[part] = {rate: [] for rate in options.rates}
        for name, load in clips:
            if any(word in name for word in options.only):
                clip = load()
                add_rows(tables[part], name, clip[: round(options.seconds * clip.fps)], strain)
    for part, table in tables.items():
        for rate, rows in table.items():
            if rows:
                print(f"{part}, {summary(rate, rows)}")


def add_rows(table: Table, name: str, clip: Motion, strain: Strain) -> None:
    """Measure a clip at all rates, and print its rows."""
    for rate, rows in table.items():
        try:
            row = measure(resample(clip, rate) if clip.fps != rate else clip, strain)
        except MocapError as error:
            print(f"{name}: {error}")
            return
        rows.append(row)
        print(line(name, rate, row), flush=True)


if __name__ == "__main__":
    main()
