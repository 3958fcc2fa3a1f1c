"""Look a clip over: how long, how far, how tall, and what is wrong with it.

Thresholds lie beyond what people do, in the clips of the CMU database: no hips travel five times faster than
around that moment, and no joint turns by more than 45° from one frame at 120 Hz to the next.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import heading

FROZEN = 3  # frames that repeat the one before, at least
TELEPORT, SUDDEN = 5.0, 5.0  # metres a second, and how many times faster than around
SNAP, FAST = np.pi / 4, 50.0  # radians a frame, and radians a second
UNDER = 0.03  # metres below the floor that the thickness of a shoe explains


class Flaw(NamedTuple):
    """What is wrong, in which frames (counted from 0), and a few words more."""

    kind: str
    frames: list[int]
    detail: str = ""

    def __str__(self) -> str:
        breaks = [i for i in range(1, len(self.frames)) if self.frames[i] > self.frames[i - 1] + 1]
        starts, stops = [0, *breaks], [*breaks, len(self.frames)]
        runs = [(self.frames[a], self.frames[b - 1]) for a, b in zip(starts, stops, strict=True)]
        shown = ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in runs[:4])
        more = f" and {len(runs) - 4} more" if len(runs) > 4 else ""
        return f"{self.kind} in frame {shown}{more}{self.detail and f' ({self.detail})'}"


@dataclass(frozen=True)
class Report:
    """A clip's measures in metres, radians and seconds, and its flaws."""

    motion: Motion
    height: float
    turn: float
    path: float
    flaws: list[Flaw]

    def table(self) -> str:
        """Say it in a few aligned lines."""
        motion, side = self.motion, "left" if self.turn > 0 else "right"
        rows = [
            ("clip", motion.name),
            ("frames", f"{len(motion)} at {motion.fps:g} Hz, {motion.duration:.2f} s"),
            ("joints", f"{len(motion.skeleton)}"),
            ("height", f"{self.height:.2f} m"),
            ("heading", f"turns {side} by {abs(np.degrees(self.turn)):.0f}° in all"),
            ("path", f"{self.path:.2f} m over the ground"),
            ("flaws", "none found" if not self.flaws else str(self.flaws[0])),
            *(("", str(flaw)) for flaw in self.flaws[1:]),
        ]
        return "\n".join(f"{name:<8} {text}" for name, text in rows)


def inspect(motion: Motion, angles: Mapping[str, Array] | None = None) -> Report:
    """Measure a clip and look for flaws.

    Parameters
    ----------
    motion : F frames.
    angles : the file's own angles (F, axes), degrees, by joint, as `files.read_angles` gives them: where
        they jump though the joint does not, another reader may stumble.

    Returns
    -------
    Height: the median over time of the body's vertical extent; turn: how far the heading turns in all, to the
    left above 0; path: the root's over the ground; the flaws: frozen stretches, teleports of the root, joints
    that snap, Euler flips, frames of zeros, joints under the floor.

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
    heading  turns right by 0° in all
    path     0.05 m over the ground
    flaws    frozen in frame 6-8

    Notebook: 01-skeletons-and-clips
    """
    positions = joint_positions(motion)
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    steps = np.diff(motion.root_positions[:, [0, 2]], axis=0)
    turns = rotations.angle_between(motion.rotations[1:], motion.rotations[:-1])  # (F - 1, J)
    flaws = [
        *_frozen(motion),
        *_zeros(motion),
        *_teleports(motion),
        *_snaps(motion, turns),
        *_flips(motion, turns, angles or {}),
        *_under(motion, positions),
    ]
    height = float(np.median(np.ptp(positions[..., 1], axis=1)))
    return Report(motion, height, float(headings[-1] - headings[0]), float(np.hypot(*steps.T).sum()), flaws)


def _frames(flags: ArrayLike, after: int = 0) -> list[int]:
    return [int(frame) + after for frame in np.flatnonzero(flags)]


def _frozen(motion: Motion) -> list[Flaw]:
    """Find frames that repeat the one before exactly, as no living body does."""
    numbers = np.hstack([motion.root_positions, motion.rotations.reshape(len(motion), -1)])
    same = np.r_[False, (numbers[1:] == numbers[:-1]).all(axis=1), False]
    starts, stops = (np.flatnonzero(np.diff(same.astype(int)) == sign) for sign in (1, -1))
    frames = [f for a, b in zip(starts, stops, strict=True) if b - a >= FROZEN for f in range(a + 1, b + 1)]
    return [Flaw("frozen", frames)] if frames else []


def _zeros(motion: Motion) -> list[Flaw]:
    still = np.abs(np.abs(motion.rotations) - rotations.IDENTITY).max(axis=(1, 2)) < 1e-9
    frames = _frames(still & (np.abs(motion.root_positions).max(axis=1) < 1e-9))
    return [Flaw("nothing but zeros", frames)] if frames else []


def _teleports(motion: Motion) -> list[Flaw]:
    """Find steps of the root much longer than those around them."""
    speeds = np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) * motion.fps
    usual = np.array([np.median(speeds[max(0, i - 5) : i + 6]) for i in range(len(speeds))])
    frames = _frames((speeds > TELEPORT) & (speeds > SUDDEN * usual), 1)
    return [Flaw("teleport", frames, f"{speeds.max() / motion.fps:.2f} m at most")] if frames else []


def _snaps(motion: Motion, turns: Array) -> list[Flaw]:
    """Find joints that really turn too fast: in rotations, no Euler flip is among them."""
    fast = _too_fast(motion, turns)
    if not fast.any():
        return []
    joint = motion.skeleton.names[int(turns.max(axis=0).argmax())]
    return [
        Flaw("snap", _frames(fast.any(axis=1), 1), f"'{joint}' by {np.degrees(turns.max()):.0f}° at most")
    ]


def _too_fast(motion: Motion, turns: Array) -> NDArray[np.bool_]:
    return (turns > SNAP) & (turns * motion.fps > FAST)


def _flips(motion: Motion, turns: Array, angles: Mapping[str, Array]) -> list[Flaw]:
    """Find angles that jump where the joint turns no faster than joints do."""
    flips = np.zeros(turns.shape, bool)
    for name, numbers in angles.items():
        if name in motion.skeleton.names:
            joint = motion.skeleton.index(name)
            jumps = np.abs(np.diff(numbers, axis=0)).max(axis=1, initial=0.0)
            flips[:, joint] = _too_fast(motion, np.radians(jumps)) & (jumps > 2 * np.degrees(turns[:, joint]))
    frames = _frames(flips.any(axis=1), 1)
    names = [motion.skeleton.names[joint] for joint in _frames(flips.any(axis=0))]
    detail = f"angles of {', '.join(names[:3])}; as rotations they are smooth"
    return [Flaw("Euler flip", frames, detail)] if frames else []


def _under(motion: Motion, positions: Array) -> list[Flaw]:
    lowest = positions[..., 1].min(axis=1)
    if not (frames := _frames(lowest < -UNDER)):
        return []
    joint = motion.skeleton.names[int(positions[..., 1].min(axis=0).argmin())]
    return [Flaw("under the floor", frames, f"'{joint}' by {-100 * lowest.min():.0f} cm at most")]
