"""Inspect a clip: how long it is, how far it goes, how tall the body is, and what is wrong with it.

The thresholds lie beyond what people do. They were checked on 132 trials of the CMU database at 120 Hz, of
subjects 02, 03, 16, 49 and 127.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.errors import printable, shortened, warn

# Frames in a row that repeat the frame before. Two trials have such frames, 6 and 13 in a row; in the
# others no frame repeats the one before.
FROZEN = 3

# Metres per second. The fastest runs reach 5.5.
TELEPORT = 5.0

# How many times faster than the median of the frames around. Above 5 m/s, no root moves more than 1.4 times
# as fast, except in one trial: 17 times. Below 5 m/s, one who stands and starts to move reaches 26 times.
SUDDEN = 5.0
AROUND = 5  # frames on either side

# Radians per frame: 45°. At 120 Hz, 99.99 % of all turns stay below 31°. Of the 28 trials with a turn above
# 45°, 16 have one above 150°, which no joint can do in a frame.
SNAP = np.pi / 4

# Radians per second. At 30 Hz, 45° per frame is only 24 radians per second, and joints of trials without a
# snap reach 36.
FAST = 50.0

# How many times further than its joint an angle turns in an Euler flip. In a snap both turn about as far.
FLIP = 2.0

# Metres. The sole of a shoe is about as thick, and markers are not that exact: the lowest joint of subject
# 16 is 2 cm under the floor, those of the others up to 9 cm.
UNDER = 0.03

# Metres. Beyond these, a wrong unit of length is likelier than a body so small or so tall.
SMALLEST, TALLEST = 0.15, 3.5

STILL = 1e-9  # metres, or entries of a quaternion: less than the digits of a file can say


class Flaw(NamedTuple):
    """What is wrong, in which frames (counted from 0, in order), and a few words more.

    Examples
    --------
    >>> print(Flaw("frozen", [3, 4, 5, 9]))
    frozen in frame 3-5, 9
    """

    kind: str
    frames: list[int]
    detail: str = ""

    def __str__(self) -> str:
        stretches = runs(np.isin(np.arange(self.frames[-1] + 1), self.frames))
        shown = ", ".join(f"{a}" if b == a + 1 else f"{a}-{b - 1}" for a, b in stretches[:4])
        more = f" and {len(stretches) - 4} more" if len(stretches) > 4 else ""
        return f"{self.kind} in frame {shown}{more}{self.detail and f' ({self.detail})'}"


class Report(NamedTuple):
    """A clip's measures in metres and radians, and its flaws: what `inspect` returns."""

    motion: Motion
    height: float
    turn: float
    path: float
    flaws: list[Flaw]

    def table(self) -> str:
        """Write the report in a few aligned lines."""
        motion, degrees = self.motion, round(np.degrees(self.turn))
        side = f"{'left' if degrees > 0 else 'right'} " if degrees else ""
        doubt = "" if SMALLEST < self.height < TALLEST else ": is its scale right?"
        rows = [
            ("clip", motion.name),
            ("frames", f"{len(motion)} at {motion.fps:g} Hz, {motion.duration:.2f} s"),
            ("joints", f"{len(motion.skeleton)}"),
            ("height", f"{self.height:.2f} m{doubt}"),
            ("heading", f"turns {side}by {abs(degrees)}° in all"),
            ("path", f"{self.path:.2f} m over the ground"),
            ("flaws", "none found" if not self.flaws else str(self.flaws[0])),
            *(("", str(flaw)) for flaw in self.flaws[1:]),
        ]
        return "\n".join(f"{name:<8} {printable(text)}" for name, text in rows)


def warn_of_size(motions: Iterable[Motion]) -> None:
    """Warn of the first body that nobody has, so that all that is measured in metres would be wrong.

    Warns
    -----
    MocapWarning : for a body below 0.15 m or above 3.5 m: its unit of length is likelier to be wrong.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> warn_of_size([sample("walk_straight")])
    """
    for motion in motions:
        height = height_of(joint_positions(motion))
        if not SMALLEST < height < TALLEST:
            warn(f"'{shortened(motion.name)}' is {height:.2g} m tall: is its scale right?")
            return


def inspect(motion: Motion, angles: Mapping[str, Array] | None = None) -> Report:
    """Measure a clip and look for flaws.

    Parameters
    ----------
    motion : F frames.
    angles : the file's own angles (F, axes), degrees, by joint, as `files.read_angles` gives them. Where
        an angle jumps and the joint does not, another program that reads the file may go wrong.

    Returns
    -------
    A report. Height: the median over time of the body's vertical extent. Turn: how far the heading turns in
    all, above 0 to the left. Path: how far the root goes over the ground. Flaws: frozen stretches, teleports
    of the root, joints that snap, Euler flips, frames of zeros, joints under the floor.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root", "tip"], [-1, 0], [[0, 0, 0], [0, 1, 0]])
    >>> roots = [[0, 0.5, 0.01 * min(frame, 5)] for frame in range(9)]
    >>> slide = Motion(bone, roots, np.tile(rotations.about_y(0.3), (9, 2, 1)), 120.0, "slide")
    >>> print(inspect(slide).table())
    clip     slide
    frames   9 at 120 Hz, 0.07 s
    joints   2
    height   1.00 m
    heading  turns by 0° in all
    path     0.05 m over the ground
    flaws    frozen in frame 6-8

    Notebook: 01b-motion-files
    """
    positions, names = joint_positions(motion), motion.skeleton.names
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    steps = np.diff(motion.root_positions[:, [0, 2]], axis=0)
    turns = rotations.angle_between(motion.rotations[1:], motion.rotations[:-1])  # (F - 1, J)
    too_fast = max(SNAP, FAST / motion.fps)  # radians: large for a frame, and fast for a joint
    most, lowest = turns.max(axis=0, initial=0), positions[..., 1].min(axis=0)
    unturned = np.abs(np.abs(motion.rotations) - rotations.IDENTITY).max(axis=(1, 2)) < STILL
    snapped = f"'{names[most.argmax()]}' by {np.degrees(most.max()):.0f}° at most"
    sunk = f"'{names[lowest.argmin()]}' by {-100 * lowest.min():.0f} cm at most"
    found = [
        ("frozen", _frozen(motion), ""),
        ("nothing but zeros", unturned & (np.abs(motion.root_positions).max(axis=1) < STILL), ""),
        ("teleport", *_teleports(motion)),
        ("snap", np.append(False, (turns > too_fast).any(axis=1)), snapped),
        ("Euler flip", *_flips(motion, turns, too_fast, angles or {})),
        ("under the floor", positions[..., 1].min(axis=1) < -UNDER, sunk),
    ]
    flaws = [Flaw(kind, np.flatnonzero(marks).tolist(), said) for kind, marks, said in found if marks.any()]
    turn, path = float(headings[-1] - headings[0]), float(np.hypot(*steps.T).sum())
    return Report(motion, height_of(positions), turn, path, flaws)


def height_of(positions: Array) -> float:
    """Measure how far a body reaches up, the median over its frames (F, J, 3)."""
    return float(np.median(np.ptp(positions[..., 1], axis=1)))


def _frozen(motion: Motion) -> Mask:
    """Mark frames that repeat the one before exactly, as no living body does."""
    numbers = np.hstack([motion.root_positions, motion.rotations.reshape(len(motion), -1)])
    same = np.append(False, (numbers[1:] == numbers[:-1]).all(axis=1))
    for start, stop in runs(same):
        same[start:stop] = stop - start >= FROZEN
    return same


def _teleports(motion: Motion) -> tuple[Mask, str]:
    """Mark steps of the root that are much longer than those around them."""
    speeds = np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) * motion.fps
    usual = [np.median(speeds[max(0, i - AROUND) : i + AROUND + 1]) for i in range(len(speeds))]
    sudden = (speeds > TELEPORT) & (speeds > SUDDEN * np.array(usual))
    return np.append(False, sudden), f"{speeds.max(initial=0) / motion.fps:.2f} m at most"


def _flips(motion: Motion, turns: Array, too_fast: float, angles: Mapping[str, Array]) -> tuple[Mask, str]:
    """Mark angles that jump although their joint does not: rotations have no flips."""
    flips = np.zeros(turns.shape, bool)
    for name in set(angles) & set(motion.skeleton.names):
        joint = motion.skeleton.index(name)
        jumps = np.abs(np.diff(angles[name], axis=0)).max(axis=1, initial=0.0)
        further = jumps > FLIP * np.degrees(turns[:, joint])
        flips[:, joint] = (np.radians(jumps) > too_fast) & further
    names = [motion.skeleton.names[joint] for joint in np.flatnonzero(flips.any(axis=0))[:3]]
    return np.append(False, flips.any(axis=1)), f"angles of {', '.join(names)}; as rotations they are smooth"
