"""All frames of some clips side by side: 27 features of each, standardised, and poses with velocities.

The body's frame is the root's ground track and heading, smoothed so that the sway of a step does not count as
turning. All numbers are seen from there: x to the body's left, y up, z ahead.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Indices, Mask, Points, frozen
from mocap._shared.records import dataclass
from mocap.body import rotations
from mocap.body.concatenation import concatenate, require_compatible
from mocap.body.kinematics import joint_positions, velocities
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import heading, on_ground
from mocap.errors import MocapError

AHEAD = np.array([1 / 3, 2 / 3, 1.0])  # seconds: Holden's 20, 40 and 60 frames at 60 Hz
SMOOTH = 0.2  # seconds, the standard deviation of a Gaussian; without it 27 % more cuts on CMU 16's walks
GROUPS = {
    "feet": slice(0, 6),
    "foot velocities": slice(6, 12),
    "hip velocity": slice(12, 15),
    "places ahead": slice(15, 21),
    "directions ahead": slice(21, 27),
}
POSE = slice(0, 15)  # feet and hips
FUTURE = slice(15, 27)  # places and directions ahead
WEIGHTS = dict(zip(GROUPS, (0.75, 1.0, 1.0, 1.0, 1.5), strict=True))  # [Hol20]
END = 1.0  # seconds before a clip's end from which no frame is found: its future is not known


def body_track(motion: Motion) -> tuple[Points, Array]:
    """Follow the body over the ground, without the sway of its steps: places z + ix and headings, (F,).

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> ground, facing = body_track(sample("walk_straight"))
    >>> ground.shape
    (1158,)
    """
    ground = on_ground(motion.root_positions)
    facing = np.unwrap(heading(motion.rotations[:, 0]))
    rows = np.stack([ground.real, ground.imag, facing])
    z, x, facing = gaussian_filter1d(rows, SMOOTH * motion.fps, mode="nearest")
    return z + 1j * x, facing


def features(motion: Motion) -> Array:
    """Describe each frame by 27 numbers [Hol20]: what the body does, and where it will be.

    Both ankles' places (6) and velocities (6), the hips' velocity (3), where the body will be after 1/3, 2/3
    and 1 s (6), and which way it will face then (6). A clip's last second looks ahead to the last frame.

    Parameters
    ----------
    motion : F frames, two legs that `body.find_legs` knows.

    Returns
    -------
    Shape (F, 27), metres, metres per second and shares of 1, in the order of `GROUPS`.

    Raises
    ------
    MocapError : for a skeleton whose legs are not found.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = features(sample("walk_straight"))
    >>> walk.shape, walk[100, 20].round(1)  # after one second she is 1 m ahead
    ((1158, 27), np.float64(1.3))
    >>> left, right = walk[:, 0:3].mean(axis=0), walk[:, 3:6].mean(axis=0)
    >>> left.round(2).tolist(), right.round(2).tolist()  # ankles: left, up and ahead of the middle
    ([0.05, 0.11, -0.02], [-0.06, 0.11, -0.01])

    Notebook: 18-motion-matching
    """
    ground, facing = body_track(motion)
    positions = joint_positions(motion)
    speeds = velocities(positions, motion.fps)
    back = np.exp(-1j * facing)
    ankles = [leg.ankle for leg in find_legs(motion.skeleton)]
    columns = [_seen(positions[:, ankle], back, ground) for ankle in ankles]
    columns += [_seen(speeds[:, joint], back) for joint in (*ankles, 0)]
    frames = np.arange(len(motion))[:, None]
    then = np.minimum(frames + np.round(AHEAD * motion.fps).astype(int), len(motion) - 1)
    translations = (ground[then] - ground[:, None]) * back[:, None]
    turned = np.exp(1j * (facing[then] - facing[:, None]))
    return np.hstack([*columns, ahead_columns(translations), ahead_columns(turned)])


def ahead_columns(ahead: Points) -> Array:
    """Write complex numbers z + ix, (..., 3) of them, as the six columns (x, z, x, z, x, z).

    Examples
    --------
    >>> ahead_columns(np.array([1 + 2j, 3 + 4j, 5 + 6j])).tolist()
    [2.0, 1.0, 4.0, 3.0, 6.0, 5.0]

    Notebook: 18-motion-matching
    """
    columns = np.stack([ahead.imag, ahead.real], axis=-1, dtype=float)
    return columns.reshape(*ahead.shape[:-1], -1)


def _seen(vectors: Array, back: Points, origin: Points | float = 0.0) -> Array:
    """See vectors (F, 3) from the body, which is turned back: to its left, up, ahead."""
    seen = (on_ground(vectors) - origin) * back
    return np.stack([seen.imag, vectors[:, 1], seen.real], axis=1)


@dataclass(frozen=True, eq=False)
class PoseDatabase:
    """T frames of some clips, ready to be searched and played; `tabulate` makes it.

    Parameters
    ----------
    clips : of one skeleton and one rate; `motion` is all of them, one behind the other.
    values : shape (T, 27), standardised features; `mean` and `scale` (27,) made them so.
    usable : shape (T,), frames that a search may find.
    last : shape (T,), the number of the last frame of each frame's clip.
    ground, heading, drift, spin : shape (T,): where the body is and faces, and its velocity and turning.
    speeds : shape (T, J + 1, 3): the root's in m/s, then each joint's in its own frame, rad/s.
    """

    clips: tuple[Motion, ...]
    motion: Motion
    values: Array
    mean: Array
    scale: Array
    usable: Mask
    last: Indices
    ground: Points
    heading: Array
    drift: Points
    spin: Array
    speeds: Array

    def __len__(self) -> int:
        return len(self.values)


def standardise(values: Array) -> tuple[Array, Array, Array]:
    """Take the mean off, and divide each group by its mean standard deviation over its weight [Hol20].

    The weights are `WEIGHTS`. One scale for each group, because a column that hardly varies must not be
    blown up.

    Parameters
    ----------
    values : shape (T, 27), as `features` gives them.

    Returns
    -------
    The standardised values, the mean and the scale, (27,) each.

    Raises
    ------
    MocapError : for a group that does not vary.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> values, mean, scale = standardise(features(sample("walk_circle")))
    >>> [round(float(values[:, GROUPS[name]].std(axis=0).mean()), 2) for name in GROUPS]
    [0.75, 1.0, 1.0, 1.0, 1.5]
    """
    scale = np.empty(values.shape[1])
    for name, columns in GROUPS.items():
        deviation = float(values[:, columns].std(axis=0).mean())
        if deviation < 1e-9:
            raise MocapError(f"The '{name}' never vary in these clips, so they cannot be compared.")
        scale[columns] = deviation / WEIGHTS[name]
    mean = values.mean(axis=0)
    return (values - mean) / scale, mean, scale


def tabulate(clips: Sequence[Motion]) -> PoseDatabase:
    """Prepare clips for motion matching; the time is linear in their frames.

    Parameters
    ----------
    clips : of one skeleton and one rate; a clip no longer than a second serves only to be played to its end.

    Raises
    ------
    MocapError : for no clips, none that is longer than a second, and as `standardise`.
    SkeletonMismatch : for clips of different skeletons.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> table = tabulate([body.resample(datasets.sample("walk_curve_1"), 30)])
    >>> table.values.shape == (len(table), 27), len(table) - int(table.usable.sum())
    (True, 30)
    >>> tabulate([table.motion[:32]]).usable.nonzero()[0].tolist()  # the last second is left out
    [0, 1]

    Notebook: 18-motion-matching
    """
    clips = require_compatible(clips)
    rate = clips[0].fps
    longest = max(clips, key=len)
    if len(longest) <= END * rate + 1:
        lasts = f"the longest, '{longest.name}', lasts {longest.duration:.2f} s"
        raise MocapError(f"A search leaves out the last {END:g} s of each clip; {lasts}.")
    frames = [len(clip) for clip in clips]
    values, mean, scale = standardise(np.concatenate([features(clip) for clip in clips]))
    values = frozen(values, np.float64)
    usable = np.concatenate([np.arange(count)[::-1] >= END * rate for count in frames])
    last = np.repeat(np.cumsum(frames) - 1, frames)
    tracks: Any = (np.concatenate(part) for part in zip(*map(_tracks, clips), strict=True))
    return PoseDatabase(clips, concatenate(clips), values, mean, scale, usable, last, *tracks)


def _tracks(clip: Motion) -> tuple[Any, ...]:
    """Follow the body with its velocity and its turning, and the speeds of its pose."""
    ground, facing = body_track(clip)
    speeds = np.concatenate([velocities(clip.root_positions, clip.fps)[:, None], turn_speeds(clip)], axis=1)
    moving: Points = np.gradient(ground) * clip.fps
    turning = velocities(facing, clip.fps)
    return ground, facing, moving, turning, speeds


def turn_speeds(motion: Motion) -> Array:
    """Measure how fast each joint turns in its own frame, (F, J, 3) rad/s: the mean of the two steps around.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> turn_speeds(sample("walk_straight")).shape
    (1158, 38, 3)
    """
    steps = rotations.difference(motion.rotations[:-1], motion.rotations[1:]) * motion.fps
    means = (steps[1:] + steps[:-1]) / 2
    return np.concatenate([steps[:1], means, steps[-1:]])
