"""Inspection of a clip: its duration, its path, the body's height, and flaws of the data.

The thresholds are beyond what people do; `limits` has them, and the clips on which they were checked.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.planar import heading
from mocap.errors import printable, shortened, warn
from mocap.quality.limits import LIMITS
from mocap.quality.measures import STEP, main_joints

REST_POSE = "rest pose"  # kinds of flaws
ZEROS = "nothing but zeros"

AT_REST = 1e-3  # radians: captured joints are never all as close to their rest pose
STILL = 1e-9  # metres, or entries of a quaternion: less than the precision of the numbers in a file

SHOWN = 4  # stretches of frames that the text of a flaw lists
NAMED = 3  # joints that the text of an Euler flip lists


class Flaw(NamedTuple):
    """A kind of flaw, its frames (counted from 0, in order), and a detail in a few words.

    Examples
    --------
    >>> print(Flaw("frozen", [3, 4, 5, 9]))
    frozen in frame 3-5, 9
    """

    kind: str
    frames: list[int]
    detail: str = ""

    def stretches(self) -> list[list[int]]:
        """Return the stretches of consecutive frames, each as its first frame and the one after its last.

        Examples
        --------
        >>> Flaw("frozen", [3, 4, 5, 9]).stretches()
        [[3, 6], [9, 10]]
        """
        rows = runs(np.isin(np.arange(self.frames[-1] + 1), self.frames))
        return [[int(start), int(stop)] for start, stop in rows]

    def as_dict(self) -> dict[str, Any]:
        """Return the flaw as a dictionary of plain numbers and texts, for JSON."""
        return {"kind": self.kind, "stretches": self.stretches(), "detail": self.detail}

    def __str__(self) -> str:
        stretches = self.stretches()
        shown = [f"{start}" if stop == start + 1 else f"{start}-{stop - 1}" for start, stop in stretches]
        text = f"{self.kind} in frame {', '.join(shown[:SHOWN])}"
        if len(shown) > SHOWN:
            text += f" and {len(shown) - SHOWN} more"
        if self.detail:
            text += f" ({self.detail})"
        return text


class Report(NamedTuple):
    """The measures of a clip, in metres and radians, and its flaws, as returned by `inspect`."""

    motion: Motion
    height: float
    heading_change: float
    path: float
    flaws: list[Flaw]

    def table(self) -> str:
        """Format the report as a few aligned lines of text."""
        motion = self.motion
        frames = f"{len(motion)} at {motion.fps:g} Hz, {motion.duration:.2f} s"
        height = f"{self.height:.2f} m"
        if not LIMITS.smallest < self.height < LIMITS.tallest:
            height += ": is its scale right?"
        degrees = round(np.degrees(self.heading_change))
        side = " left" if degrees > 0 else " right" if degrees < 0 else ""
        heading = f"turns{side} by {abs(degrees)}° in all"
        path = f"{self.path:.2f} m over the ground"
        flaws = [str(flaw) for flaw in self.flaws] or ["none found"]
        measures = {
            "clip": motion.name,
            "frames": frames,
            "joints": f"{len(motion.skeleton)}",
            "height": height,
            "heading": heading,
            "path": path,
            "flaws": flaws[0],
        }
        rows = [*measures.items(), *(("", flaw) for flaw in flaws[1:])]
        return "\n".join(f"{name:<8} {printable(text)}" for name, text in rows)

    def as_dict(self) -> dict[str, Any]:
        """Return the report as a dictionary of plain numbers and texts, for JSON: metres, seconds, radians.

        Examples
        --------
        >>> from mocap.datasets.samples import sample
        >>> list(inspect(sample("walk_straight")).as_dict())[:5]
        ['name', 'frames', 'fps', 'duration', 'joints']
        """
        motion = self.motion
        counts = {"frames": len(motion), "fps": motion.fps, "duration": motion.duration}
        marks = {"labels": [*motion.labels], "contacts": [*motion.contacts]}
        measures = {"height": self.height, "heading_change": self.heading_change, "path": self.path}
        flaws = [flaw.as_dict() for flaw in self.flaws]
        joints = {"joints": len(motion.skeleton)}
        return {"name": motion.name, **counts, **joints, **marks, **measures, "flaws": flaws}


def warn_of_size(motions: Iterable[Motion]) -> None:
    """Warn about the first body of an impossible height, for which all measures in metres would be wrong.

    Warns
    -----
    MocapWarning : for a body below 0.15 m or above 3.5 m, whose unit of length is probably wrong.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> warn_of_size([sample("walk_straight")])
    """
    for motion in motions:
        height = height_of(joint_positions(motion))
        if not LIMITS.smallest < height < LIMITS.tallest:
            warn(f"'{shortened(motion.name)}' is {height:.2g} m tall: is its scale right?")
            return


def inspect(motion: Motion, angles: Mapping[str, Array] | None = None) -> Report:
    """Measure a clip and detect flaws in its data.

    Parameters
    ----------
    motion : F frames.
    angles : the Euler angles of the file, shape (F, axes) for each joint, degrees, as returned by
        `files.read_angles`. An angle that jumps while its joint does not may mislead other programs.

    Returns
    -------
    A report. Height: the median over time of the body's vertical extent. Heading: its total change,
    positive to the left. Path: the length of the root's path over the ground. Flaws: frozen stretches,
    teleports of the root, joints that snap, Euler flips, frames of zeros, rest poses from which the body
    leaps, and joints below the floor.

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
    positions = joint_positions(motion)
    flaws = []
    for kind, frames, detail in _marked_frames(motion, positions, angles or {}):
        if frames.any():
            flaws.append(Flaw(kind, np.flatnonzero(frames).tolist(), detail))
    headings = np.unwrap(heading(motion.rotations[:, 0]))
    x_steps, z_steps = np.diff(motion.root_positions[:, [0, 2]], axis=0).T
    path = float(np.hypot(x_steps, z_steps).sum())
    return Report(motion, height_of(positions), float(headings[-1] - headings[0]), path, flaws)


def height_of(positions: Array) -> float:
    """Measure the vertical extent of a body, the median over its frames, from positions (F, J, 3)."""
    return float(np.median(np.ptp(positions[..., 1], axis=1)))


def _marked_frames(
    motion: Motion, positions: Array, angles: Mapping[str, Array]
) -> Iterator[tuple[str, Mask, str]]:
    """Yield each kind of flaw, the frames (F,) that have it, and a detail in a few words."""
    rotation_angles = rotations.angle_between(motion.rotations[1:], motion.rotations[:-1])  # (F - 1, J)
    too_fast = max(LIMITS.snap, LIMITS.fast / motion.fps)  # radians: large for a frame, and fast for a joint
    yield "frozen", _frozen(motion), ""
    zeros = _zeros(motion)
    yield ZEROS, zeros, ""
    yield REST_POSE, _rest_poses(motion, rotation_angles) & ~zeros, ""
    yield "teleport", *_teleports(motion)
    yield "snap", *_snaps(motion, rotation_angles, too_fast)
    yield "Euler flip", *_flips(motion, rotation_angles, too_fast, angles)
    yield "under the floor", *_under_the_floor(motion, positions)


def _frozen(motion: Motion) -> Mask:
    """Mark frames that are equal to the one before to the bit, which does not happen in captured motion."""
    numbers = np.hstack([motion.root_positions, motion.rotations.reshape(len(motion), -1)])
    repeats = np.append(False, (numbers[1:] == numbers[:-1]).all(axis=1))
    for start, stop in runs(repeats):
        repeats[start:stop] = stop - start >= LIMITS.frozen
    return repeats


def _zeros(motion: Motion) -> Mask:
    """Mark frames with the root at the origin and all rotations equal to the identity."""
    rotation_errors = np.abs(np.abs(motion.rotations) - rotations.IDENTITY).max(axis=(1, 2))
    root_errors = np.abs(motion.root_positions).max(axis=1)
    return np.asarray((rotation_errors < STILL) & (root_errors < STILL))


def _rest_poses(motion: Motion, rotation_angles: Array) -> Mask:
    """Mark frames in the rest pose, such as a T-pose before the motion, if the body leaps into or out of it.

    Parameters
    ----------
    motion : F frames.
    rotation_angles : the rotations from frame to frame, shape (F - 1, J), radians.
    """
    from_rest = rotations.angle_between(motion.rotations[:, 1:], rotations.IDENTITY)
    poses = np.asarray((from_rest < AT_REST).all(axis=1))
    steps = rotation_angles[:, 1:].sum(axis=1)  # radians, from each frame to the next
    reach = LIMITS.sudden_frames
    for start, stop in runs(poses):
        earlier_steps = steps[max(0, start - 1 - reach) : start][::-1]  # that into the rest pose comes first
        later_steps = steps[stop - 1 : stop + reach]
        poses[start:stop] = _leaps(earlier_steps) or _leaps(later_steps)
    return poses


def _leaps(steps: Array) -> bool:
    """Return whether the first of two steps or more is much larger than the others."""
    if len(steps) < 2:
        return False
    usual = np.median(steps[1:])
    return bool(steps[0] > AT_REST + LIMITS.rest_leap * usual)


def _teleports(motion: Motion) -> tuple[Mask, str]:
    """Mark steps of the root that are much longer than those of the neighbouring frames."""
    speeds = np.linalg.norm(np.diff(motion.root_positions, axis=0), axis=1) * motion.fps
    reach = LIMITS.sudden_frames
    neighbourhoods = [speeds[max(0, i - reach) : i + reach + 1] for i in range(len(speeds))]
    usual = np.array([np.median(neighbours) for neighbours in neighbourhoods])
    sudden = (speeds > LIMITS.teleport) & (speeds > LIMITS.sudden * usual)
    return np.append(False, sudden), f"{speeds.max(initial=0) / motion.fps:.2f} m at most"


def _snaps(motion: Motion, rotation_angles: Array, too_fast: float) -> tuple[Mask, str]:
    """Mark rotations from frame to frame, (F - 1, J), that are too fast for a joint."""
    largest = rotation_angles.max(axis=0, initial=0)
    name = motion.skeleton.names[largest.argmax()]
    detail = f"'{name}' by {np.degrees(largest.max()):.0f}° at most"
    is_snap = (rotation_angles > too_fast).any(axis=1) | _leaps_over_several_frames(motion, rotation_angles)
    return np.append(False, is_snap), detail


def _leaps_over_several_frames(motion: Motion, rotation_angles: Array) -> Mask:
    """Mark the fast frames of a main joint that rotates too far within 1/30 s, shape (F - 1,).

    Resampling extends a leap, such as that out of a T-pose, over several frames.
    """
    joints = main_joints(motion.skeleton)
    step = max(1, round(STEP * motion.fps))
    fastest = np.radians(LIMITS.rotation) / motion.fps  # radians per frame
    windows = max(0, len(motion) - step)
    local = motion.rotations[:, joints]
    within_step = rotations.angle_between(local[step:], local[:windows])
    in_window = np.zeros((len(rotation_angles), len(joints)), bool)
    for start in range(min(step, len(rotation_angles))):
        in_window[start : start + windows] |= within_step > fastest * step
    is_fast = rotation_angles[:, joints] > fastest
    return np.asarray((in_window & is_fast).any(axis=1))


def _flips(
    motion: Motion, rotation_angles: Array, too_fast: float, angles: Mapping[str, Array]
) -> tuple[Mask, str]:
    """Mark Euler flips: angles that jump while the rotation of their joint is continuous."""
    flips = np.zeros(rotation_angles.shape, bool)
    for name in set(angles) & set(motion.skeleton.names):
        joint = motion.skeleton.index(name)
        jumps = np.abs(np.diff(angles[name], axis=0)).max(axis=1, initial=0.0)
        exceeds_rotation = jumps > LIMITS.flip * np.degrees(rotation_angles[:, joint])
        flips[:, joint] = (np.radians(jumps) > too_fast) & exceeds_rotation
    names = [motion.skeleton.names[joint] for joint in np.flatnonzero(flips.any(axis=0))[:NAMED]]
    return np.append(False, flips.any(axis=1)), f"angles of {', '.join(names)}; as rotations they are smooth"


def _under_the_floor(motion: Motion, positions: Array) -> tuple[Mask, str]:
    """Mark frames with a joint below the floor, y = 0."""
    heights = positions[..., 1]
    lowest = heights.min(axis=0)
    detail = f"'{motion.skeleton.names[lowest.argmin()]}' by {-100 * lowest.min():.0f} cm at most"
    return heights.min(axis=1) < -LIMITS.under, detail
