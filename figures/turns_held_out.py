"""Make turns that were held out, and compare them with the real ones.

`python figures/turns_held_out.py FOLDER` writes the table `parametric.md` beside it. The folder holds the
walker's six `.bvh` clips: straight on, and turns by 45, 90 and 180 degrees. A turn by 90 degrees takes the
walker more than one stride, so that its strides turn by about 70.
"""

import sys
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np

import mocap
from mocap.body import Motion, find_legs, joint_positions, place, planar, rotations
from mocap.errors import MocapWarning
from mocap.feet import mark_plants
from mocap.methods.match_webs import MotionSpace
from mocap.methods.parametric_graphs import cut_strides, make_space, mixed_trajectory
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.made_motions import make_motion

MEASURES = ("knee, °", "hip, °", "stride, cm", "sway, cm")
WAYS = ("by curves", "by strikes", "plain, from the strike", "plain, from anywhere")
STRAIGHT, TURNS_45, TURNS_90, SHARP = (-12, 12), (24, 50), (55, 90), (100, 180)  # degrees per stride


class Case(NamedTuple):
    """Examples held out between two others, in degrees of turn to one side: 1 for left."""

    low: tuple[float, float]
    held: tuple[float, float]
    high: tuple[float, float]
    side: int

    def __str__(self) -> str:
        return f"{self.held[0]} to {self.held[1]}° to the {'left' if self.side > 0 else 'right'}"


CASES = (
    Case(STRAIGHT, TURNS_45, TURNS_90, 1),
    Case(STRAIGHT, TURNS_45, TURNS_90, -1),
    Case(TURNS_45, TURNS_90, SHARP, 1),
    Case(TURNS_90, (100, 125), (125, 180), 1),
)


class Walker(NamedTuple):
    """Steady strides of one walker, on the clock of their strikes and on that of registration curves."""

    by_strikes: Examples
    by_curves: Examples


class Compared(NamedTuple):
    """The real strides (R, 4), those on either side that others are made from, and those made in each way."""

    real: np.ndarray
    straighter: np.ndarray
    sharper: np.ndarray
    made: dict[str, np.ndarray]

    def off(self, way: str) -> np.ndarray:
        """Say how far the mean of a way is from the real mean, in standard deviations of the real ones."""
        return (self.made[way].mean(axis=0) - self.real.mean(axis=0)) / self.real.std(axis=0, ddof=1)


def walker(folder: Path) -> Walker:
    """Cut the clips of a folder into steady strides: of two steps that are alike to a factor of 1.6."""
    clips = [mark_plants(mocap.resample(mocap.load(path), 30)) for path in sorted(folder.glob("*.bvh"))]
    strikes, curves = (cut_strides(clips, by=by) for by in ("strikes", "curves"))
    ground, _ = mixed_trajectory(strikes, np.eye(len(strikes)))
    first, last = strikes.ends
    ways = [
        np.abs(np.diff(part, axis=1)).sum(axis=1)
        for part in np.split(ground[:, first : last + 1], [(last - first) // 2], axis=1)
    ]
    steady = (np.abs(np.log(ways[1] / ways[0])) < np.log(1.6)) & (strikes.values[:, 1] > 0.5)
    return Walker(strikes.take(steady), curves.take(steady))


def captured(strides: Examples) -> MotionSpace[Examples]:
    """Make a space that gives each stride as it was captured, when asked for the stride's own turn."""
    values = strides.values[:, :1]
    return MotionSpace(strides, np.eye(len(values)), values, np.ptp(values, axis=0) / 2, ("turn",))


def measure(motion: Motion) -> np.ndarray:
    """Measure a stride: how far knees and hips swing, how far the foot goes, how far the root sways."""
    points, facing = joint_positions(motion), planar.heading(motion.rotations[:, 0])
    ahead = np.stack([np.sin(facing), np.zeros_like(facing), np.cos(facing)], axis=-1)
    legs = find_legs(motion.skeleton)
    knees, hips = [], []
    for leg in legs:
        thigh, shank = points[:, leg.knee] - points[:, leg.hip], points[:, leg.ankle] - points[:, leg.knee]
        lengths = np.linalg.norm(thigh, axis=-1) * np.linalg.norm(shank, axis=-1)
        knees.append(np.ptp(np.arccos(np.clip((thigh * shank).sum(axis=-1) / lengths, -1, 1))))
        hips.append(np.ptp(np.arctan2((thigh * ahead).sum(axis=-1), -thigh[:, 1])))
    foot = points[[0, -1], legs[0].ankle][:, [0, 2]]
    sideways = (np.diff(planar.on_ground(motion.root_positions)) * np.exp(-1j * facing[:-1])).imag.cumsum()
    time = np.arange(len(sideways))
    sway = np.ptp(sideways - np.polyval(np.polyfit(time, sideways, 1), time))
    stride = np.hypot(*(foot[1] - foot[0]))
    return np.array([np.degrees(np.mean(knees)), np.degrees(np.mean(hips)), 100 * stride, 100 * sway])


def stretch(space: MotionSpace[Examples], turn: float, start: float = 0.0) -> Motion:
    """Give the frames of a stride from a phase on; from the first strike they end with the last."""
    made = make_motion(space, np.array([turn]))
    return made.motion[made.frame(start) : made.frame(1.0 + start) + 1]


def plain(one: Motion, other: Motion, share: float) -> Motion:
    """Blend frame by frame: places and rotations mixed, both laid on the origin at their first frame."""
    count = min(len(one), len(other))
    one, other = (place(motion[:count], 0.0, (0, 0)) for motion in (one, other))
    roots = (1 - share) * one.root_positions + share * other.root_positions
    turns = rotations.slerp(one.rotations, other.rotations, np.full(one.rotations.shape[:2], share))
    return Motion(one.skeleton, roots, turns, one.fps)


def compare(strides: Walker, case: Case, draws: int = 40) -> Compared:
    """Make the turns that are held out, by all ways, out of those on either side of them."""
    turns = strides.by_strikes.values[:, 0]
    low, held, high = (
        (np.degrees(turns) * case.side >= band[0]) & (np.degrees(turns) * case.side <= band[1])
        for band in (case.low, case.held, case.high)
    )
    own = captured(strides.by_strikes)
    made = {}
    ends = np.sort(case.side * np.radians([case.low[0], case.high[1]]))
    for way, some in zip(WAYS, reversed(strides), strict=False):
        space = make_space(some.take(low | high), np.radians(14), *ends)
        made[way] = np.array([measure(stretch(space, turn)) for turn in turns[held]])
    for way, widest in zip(WAYS[2:], (0.0, 0.3), strict=True):
        random, rows = np.random.default_rng(0), []
        for _ in range(draws):
            a, b, wanted = (random.choice(turns[some]) for some in (low, high, held))
            start = float(random.uniform(-widest, widest))
            share = float((wanted - a) / (b - a))
            rows.append(measure(plain(stretch(own, a), stretch(own, b, start), share)))
        made[way] = np.array(rows)
    real = (np.array([measure(stretch(own, turn)) for turn in turns[some]]) for some in (held, low, high))
    return Compared(*real, made)


HEAD = """# Turns that were held out of the making

Written by `python figures/turns_held_out.py`. One walker: steady strides straight on, and in turns by 45, 90
and 180 degrees. All strides of one turn are left out, then made from those on either side: as blends of a
stride space, on the clock of registration curves and on that of the strikes; and as plain blends of two
strides, frame by frame, from the first strike on or from anywhere within 0.3 of a stride. How far the knees
bend and the thighs swing, from strike to strike of a foot how far it goes, and how far the root sways: mean,
in brackets how many standard deviations of the real strides it is off the real mean.

A blend of two strides is about as long as they are, or between. At 100 to 125 degrees the walker took longer
strides than on either side, where two slow ones are all that is sharper: no blend of those comes to them."""


def main() -> None:
    """Write the table."""
    warnings.simplefilter("ignore", MocapWarning)
    strides, lines = walker(Path(sys.argv[1])), [HEAD, ""]
    for case in CASES:
        found = compare(strides, case)
        lines += [f"## {case}", "", f"| strides | {' | '.join(MEASURES)} |", "|---" * 5 + "|"]
        names = ("real", "real, straighter", "real, sharper")
        for name, some in zip(names, found[:3], strict=True):
            spread = zip(some.mean(axis=0), some.std(axis=0, ddof=1), strict=True)
            cells = [f"{mean:.0f} ± {std:.1f}" for mean, std in spread]
            lines.append(f"| {len(some)} {name} | {' | '.join(cells)} |")
        for way in WAYS:
            row = zip(found.made[way].mean(axis=0), found.off(way), strict=True)
            lines.append(f"| {way} | {' | '.join(f'{mean:.0f} ({off:+.1f})' for mean, off in row)} |")
        lines.append("")
    (Path(__file__).parent / "parametric.md").write_text("\n".join(lines), "utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
