"""Compare the bundled gait with captured people: `python figures/walking_sheet.py OUT [FOLDER ...]`.

Prints three tables: speeds, steps and angles of single gaits; the fraction of the stride within one standard
deviation of the captured people; smoothness of the clips. Writes sheets of twelve phases of a stride to
OUT, from the side, from the front and from above. Each folder holds the clips of one person, as `cmu/16`; the
tables name the folder. Captured clips are measured only: none is stored.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import curve_fit
from stride_measures import (
    ANGLES,
    Stride,
    find_strides,
    fraction_within_one_sd,
    is_plain_walk,
    is_straight,
    mean_of,
    median_curve,
    see_from_hips,
)
from walking import generate_walk

import mocap
from mocap import datasets, plotting
from mocap._shared.arrays import Array
from mocap.body import circle, rotations
from mocap.body.motion import Motion
from mocap.quality import foot_sliding, judge

SUFFIXES = (".amc", ".bvh")
LEAST_STRIDES = 2  # of a person, to be compared
CURVED = (15.0, 80.0)  # degrees per second: strides in curves
MANY = 10  # strides in curves, from which a time of turning is fitted
BRISK = 1.45  # m/s: faster walks are left out where speeds are compared
PHASES = 12  # drawn of a stride
PACES = (1.15, 1.3)  # m/s
RADII = (1.0, 2.0)  # metres
SHOWN = {"16": "16_47", "02": "02_01", "49": "49_01"}  # captured strides on the sheets
MID_STANCE = 28  # percent of the stride
STRIKE = 2  # percent: the foot is farthest ahead a little earlier


class Captured(NamedTuple):
    """A stride, and the clip that it is from."""

    motion: Motion
    stride: Stride


class View(NamedTuple):
    """A direction to look from: axes of the picture (0 left, 1 up, 2 ahead), and the sign of the first."""

    across: int
    upwards: int
    sign: int


VIEWS = {"side": View(2, 1, 1), "front": View(0, 1, -1), "above": View(2, 0, 1)}


def load_people(folders: Sequence[Path]) -> dict[str, list[Captured]]:
    """Load the strides of plain walking of every person.

    Returns
    -------
    {name of the person's folder: strides}; files that cannot be read, or have no legs, are left out.
    """
    people: dict[str, list[Captured]] = {}
    for folder in folders:
        strides = people.setdefault(folder.name, [])
        for file in sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES):
            try:
                motion = mocap.load(file)
                cut = find_strides(motion)
            except mocap.MocapError:
                continue
            strides.extend(Captured(motion, stride) for stride in cut if is_plain_walk(stride))
    return people


def select(people: Mapping[str, Sequence[Captured]], *, curved: bool) -> dict[str, list[Stride]]:
    """Select each person's straight strides, or those in curves; persons with too few are left out."""
    chosen = {}
    for person, captured in people.items():
        strides = [capture.stride for capture in captured]
        if curved:
            strides = [stride for stride in strides if CURVED[0] < abs(stride.turn_rate) < CURVED[1]]
        else:
            strides = [stride for stride in strides if is_straight(stride)]
        if len(strides) >= LEAST_STRIDES:
            chosen[person] = strides
    return chosen


def generated_gaits() -> dict[str, list[Stride]]:
    """Measure the bundled straight walk, and new walks on straight lines and circles."""
    gaits = {"walk_straight": find_strides(datasets.sample("walk_straight"))}
    for pace in PACES:
        walk = generate_walk([[0, 0], [0, 8], [0, 16]], speed=pace)
        gaits[f"{pace} m/s"] = find_strides(walk)
    for radius in RADII:
        gaits[f"circle of {radius:g} m"] = find_strides(generate_walk(circle(radius).points))
    return gaits


def gait_row(name: str, strides: Sequence[Stride]) -> str:
    """Row of the table of gaits: means of numbers, and medians of angles."""
    knee = median_curve(strides, "knee")
    tips = [stride.curves["tip"] for stride in strides]
    clearance = np.mean([tip[72:92].min() - np.percentile(tip, 5) for tip in tips])
    bob = np.mean([np.ptp(stride.curves["height"]) for stride in strides])
    cells = [f"{mean_of(strides, key):.2f}" for key in ("speed", "seconds", "step")]
    flexions = [knee[STRIKE], knee[MID_STANCE], knee[40:60].min(), knee.max()]
    cells += [f"{flexion:.0f}" for flexion in flexions]
    cells += [f"{100 * metres:.1f}" for metres in (clearance, bob)]
    for angle in ("hip", "ankle", "shoulder", "elbow"):
        curve = median_curve(strides, angle)
        cells.append(f"{curve.min():.0f} to {curve.max():.0f}")
    return f"| {name} | {len(strides)} | {' | '.join(cells)} |"


def table_of_gaits(gaits: Mapping[str, Sequence[Stride]]) -> Iterator[str]:
    """Table of speeds, steps and angles."""
    head = "gait | strides | m/s | s | step, m | knee at strike | mid stance | least late | most"
    head += " | ball clears, cm | bob, cm | hip | ankle | shoulder | elbow"
    yield f"| {head} |"
    yield "|---" * (head.count("|") + 1) + "|"
    for name, strides in gaits.items():
        yield gait_row(name, strides)


def percent_within(strides: Sequence[Stride], people: Sequence[Sequence[Stride]], angle: str) -> float:
    """Percent of the stride in which the median stride is within one standard deviation of the people."""
    curves = [median_curve(person, angle) for person in people]
    return 100 * fraction_within_one_sd(median_curve(strides, angle), curves)


def table_of_fractions(
    gaits: Mapping[str, Sequence[Stride]], people: Mapping[str, Sequence[Stride]]
) -> Iterator[str]:
    """Table of percents of the stride within one standard deviation of the people, angle by angle.

    In the last column each person is compared with all others.
    """
    yield f"within one SD of {len(people)} people ({', '.join(people)}), % of the stride"
    yield ""
    yield f"| angle | {' | '.join(gaits)} | a person, of the others |"
    yield "|---" * (len(gaits) + 2) + "|"
    groups = list(people.values())
    for angle in ANGLES:
        cells = [f"{percent_within(strides, groups, angle):.0f}" for strides in gaits.values()]
        mutual = []
        for number, person in enumerate(groups):
            company = groups[:number] + groups[number + 1 :]
            mutual.append(percent_within(person, company, angle))
        yield f"| {angle} | {' | '.join(cells)} | {np.mean(mutual):.0f} |"


def turning_time(strides: Sequence[Stride]) -> float:
    """Time τ, seconds, by which a person slows down in curves: v (1 + τ ω) = w, by least squares.

    The speed w is the median of the strides that turn by less than 6 degrees per second.
    """
    speeds = np.array([stride.speed for stride in strides])
    rates = np.radians([abs(stride.turn_rate) for stride in strides])
    straight = float(np.median(speeds[rates < np.radians(6)]))
    times, _ = curve_fit(lambda rate, time: straight / (1 + time * rate), rates, speeds, p0=[0.2])
    return float(times[0])


def table_of_turning(people: Mapping[str, Sequence[Captured]]) -> Iterator[str]:
    """Table of the times by which people slow down in curves."""
    yield "| person | strides in curves | time of turning, s |"
    yield "|---|---|---|"
    for person, count in select(people, curved=True).items():
        strides = [capture.stride for capture in people[person] if capture.stride.speed < BRISK]
        if len(count) >= MANY and any(abs(stride.turn_rate) < 6 for stride in strides):
            yield f"| {person} | {len(count)} | {turning_time(strides):.2f} |"


def second_differences(motion: Motion, joint: str) -> float:
    """99th percentile of the angular acceleration of a joint of both legs, degrees / s²."""
    columns = [motion.skeleton.index(side + joint) for side in "lr"]
    turns = motion.rotations[:, columns]
    steps = rotations.to_rotvec(rotations.multiply(rotations.inverse(turns[:-1]), turns[1:]))
    size = np.linalg.norm(np.diff(steps, axis=0), axis=-1) * motion.fps**2
    return float(np.degrees(np.percentile(size, 99)))


def smoothness_row(name: str, motion: Motion) -> str:
    """Row of the table of smoothness."""
    slides = [plant.distance for plant in foot_sliding(motion)]
    worst = judge(motion).worst
    metres = np.linalg.norm(np.diff(motion.root_positions[:, [0, 2]], axis=0), axis=-1).sum()
    joints = [f"{second_differences(motion, joint):.0f}" for joint in ("tibia", "foot")]
    speed = f"{metres / motion.duration:.2f}"
    slide = f"{10 * max(slides, default=0.0):.3f}"
    cells = [name, speed, slide, f"{worst.name} {worst.ratio:.2f}", *joints]
    return f"| {' | '.join(cells)} |"


def table_of_smoothness(people: Mapping[str, Sequence[Captured]]) -> Iterator[str]:
    """Table of foot sliding, judgement and accelerations, of bundled and captured clips."""
    yield "| clip | m/s | slide, mm | judge's worst | knee, °/s² | ankle, °/s² |"
    yield "|---" * 6 + "|"
    for name in datasets.SAMPLES:
        yield smoothness_row(f"{name}, bundled", datasets.sample(name))
    for capture in shown(people):
        yield smoothness_row(f"{capture.motion.name}, captured", capture.motion)


def shown(people: Mapping[str, Sequence[Captured]]) -> Iterator[Captured]:
    """Choose the first stride of each captured clip that is shown."""
    for person, clip in SHOWN.items():
        strides = [capture for capture in people.get(person, ()) if capture.motion.name == clip]
        yield from strides[:1]


def draw_body(ax: Axes, pose: Array, motion: Motion, place: float, view: View) -> None:
    """Draw the bones of a pose (J, 3), seen from the hips, at a place on the sheet."""
    across = place + view.sign * pose[:, view.across]
    upwards = pose[:, view.upwards]
    for start, end, side in zip(*plotting.bones(motion.skeleton), strict=True):
        ax.plot(across[[start, end]], upwards[[start, end]], color=plotting.COLOURS[side], linewidth=1.5)


def draw_stride(ax: Axes, title: str, captured: Captured, view: View) -> None:
    """Draw a row of phases of a stride."""
    joints = see_from_hips(captured.motion).joints.copy()
    first = captured.stride.start
    last = captured.stride.stop
    joints[..., 1] -= np.percentile(joints[first:last, :, 1].min(axis=1), 10)
    for number in range(PHASES):
        frame = first + (last - first) * number // PHASES
        draw_body(ax, joints[frame], captured.motion, 0.95 * number, view)
        ax.text(0.95 * number, -0.25, f"{100 * number // PHASES}%", ha="center", fontsize=7)
    ax.set_title(title, fontsize=9, loc="left", pad=0)
    ax.set(aspect="equal", xlim=(-0.7, 0.95 * PHASES))
    ax.set_ylim((-0.6, 0.6) if view.upwards == 0 else (-0.3, 1.95))
    ax.set_axis_off()


def draw_sheets(rows: Mapping[str, Captured], out: Path) -> None:
    """Write a sheet for each view."""
    for name, view in VIEWS.items():
        height = 1.1 if view.upwards == 0 else 2.1
        figure, axes = plt.subplots(len(rows), 1, figsize=(15.5, height * len(rows)), squeeze=False)
        for ax, (title, captured) in zip(axes[:, 0], rows.items(), strict=True):
            draw_stride(ax, title, captured, view)
        figure.subplots_adjust(0, 0, 1, 0.97, hspace=0.08)
        figure.savefig(out / f"walking_{name}.png", dpi=72)
        plt.close(figure)


def left_stride(motion: Motion, number: int) -> Captured:
    """Choose a stride of the left leg."""
    strides = [stride for stride in find_strides(motion) if stride.side == "left"]
    return Captured(motion, strides[min(number, len(strides) - 1)])


def rows_of_sheets(people: Mapping[str, Sequence[Captured]]) -> dict[str, Captured]:
    """Choose the strides that are drawn: a bundled one, and captured ones."""
    rows = {"bundled: walk_straight": left_stride(datasets.sample("walk_straight"), 3)}
    return rows | {f"captured: {capture.motion.name}": capture for capture in shown(people)}


def main(arguments: Sequence[str]) -> None:
    """Print the tables and write the sheets."""
    if not arguments:
        sys.exit(str(__doc__).splitlines()[0])
    out = Path(arguments[0])
    people = load_people([Path(folder) for folder in arguments[1:]])
    gaits = generated_gaits()
    straight = select(people, curved=False)
    curved = select(people, curved=True)
    print(*table_of_gaits(gaits | straight), "", sep="\n")
    if len(straight) > LEAST_STRIDES:
        print(*table_of_fractions(gaits, straight), "", sep="\n")
    else:
        print("No fractions: give the folders of three captured persons or more.\n")
    if len(curved) > LEAST_STRIDES:
        circles = {name: strides for name, strides in gaits.items() if "circle" in name}
        print("In curves:", *table_of_fractions(circles, curved), "", sep="\n")
    print(*table_of_turning(people), "", sep="\n")
    print(*table_of_smoothness(people), sep="\n")
    draw_sheets(rows_of_sheets(people), out)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main(sys.argv[1:])
