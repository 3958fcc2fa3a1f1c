"""All frames of some clips side by side: their features, standardised, and their poses with velocities."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points, frozen
from mocap.body import rotations
from mocap.body.kinematics import velocities
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.methods.motion_matching.frame_features import GROUPS, body_track, features

WEIGHTS = {  # [Hol20]
    "feet": 0.75,
    "foot velocities": 1.0,
    "hip velocity": 1.0,
    "places ahead": 1.0,
    "directions ahead": 1.5,
}
END = 1.0  # seconds before a clip's end from which no frame is found: its future is not known


@dataclass(frozen=True, eq=False)
class PoseDatabase:
    """T frames of some clips, ready to be searched and played; `tabulate` makes it.

    Parameters
    ----------
    clips : of one skeleton and one rate.
    labels, contacts : as those of the clips, (T,) each.
    values : shape (T, 27), standardised features; `mean` and `scale` (27,) made them so.
    usable : shape (T,), frames that a search may find.
    last : shape (T,), the number of the last frame of each frame's clip.
    ground, heading, drift, spin : shape (T,): where the body is and faces, and its velocity and turning.
    roots, turns : shape (T, 3) and (T, J, 4), the poses.
    speeds : shape (T, J + 1, 3): the root's in m/s, then each joint's in its own frame, rad/s.
    """

    clips: tuple[Motion, ...]
    labels: Mapping[str, Mask]
    contacts: Mapping[str, Mask]
    values: Array
    mean: Array
    scale: Array
    usable: Mask
    last: Indices
    ground: Points
    heading: Array
    drift: Points
    spin: Array
    roots: Array
    turns: Array
    speeds: Array

    def __len__(self) -> int:
        return len(self.values)

    @property
    def fps(self) -> float:
        """Frames per second, the same for all clips."""
        return self.clips[0].fps


def standardise(values: Array, weights: Mapping[str, float]) -> tuple[Array, Array, Array]:
    """Take the mean off, and divide each group by its mean standard deviation over its weight [Hol20].

    One scale for each group, because a column that hardly varies must not be blown up.

    Parameters
    ----------
    values : shape (T, 27), as `features` gives them.
    weights : a number from 0 on for each group of `GROUPS`; 0 leaves a group out.

    Returns
    -------
    The standardised values, the mean and the scale, (27,) each; a group of weight 0 has the scale infinity.

    Raises
    ------
    MocapError : for unknown groups, weights below 0 or all 0, and a group that does not vary.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> values, mean, scale = standardise(features(sample("walk_circle")), WEIGHTS)
    >>> [round(float(values[:, GROUPS[name]].std(axis=0).mean()), 2) for name in GROUPS]
    [0.75, 1.0, 1.0, 1.0, 1.5]
    """
    if set(weights) != set(GROUPS) or not all(np.isfinite(w) and w >= 0 for w in weights.values()):
        raise MocapError(f"Weights are numbers from 0 on for {', '.join(GROUPS)}; got {dict(weights)}."[:200])
    if not any(weights.values()):
        raise MocapError("All weights are 0: then all frames are alike.")
    scale = np.empty(values.shape[1])
    for name, columns in GROUPS.items():
        deviation = float(values[:, columns].std(axis=0).mean())
        if weights[name] and deviation < 1e-9:
            raise MocapError(f"The '{name}' never vary in these clips, so they cannot be compared.")
        scale[columns] = deviation / weights[name] if weights[name] else np.inf
    mean = values.mean(axis=0)
    return (values - mean) / scale, mean, scale


def tabulate(clips: Sequence[Motion], *, weights: Mapping[str, float] = WEIGHTS) -> PoseDatabase:
    """Prepare clips for motion matching; the time is linear in their frames.

    Parameters
    ----------
    clips : of one skeleton and one rate; a clip no longer than a second serves only to be played to its end.
    weights : of the groups of features, as for `standardise`.

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

    Notebook: 18-motion-matching
    """
    if not clips:
        raise MocapError("Motion matching needs at least one clip, got none.")
    require_alike(clips)
    rate, longest = clips[0].fps, max(clips, key=len)
    if len(longest) <= END * rate + 1:
        raise MocapError(
            f"No clip is longer than the {END:g} s that a search leaves out at its end; "
            f"the longest, '{longest.name}', lasts {longest.duration:.2f} s."
        )
    frames = [len(clip) for clip in clips]
    values, mean, scale = standardise(np.concatenate([features(clip) for clip in clips]), weights)
    tracks: Any = (np.concatenate(part) for part in zip(*map(_tracks, clips), strict=True))
    return PoseDatabase(
        tuple(clips),
        _marks([clip.labels for clip in clips], frames),
        _marks([clip.contacts for clip in clips], frames),
        frozen(values, np.float64),
        mean,
        scale,
        np.concatenate([np.arange(count)[::-1] >= END * rate for count in frames]),
        np.repeat(np.cumsum(frames) - 1, frames),
        *tracks,
    )


def _tracks(clip: Motion) -> tuple[Any, ...]:
    """Follow the body with its velocity and its turning, and the pose with its speeds."""
    ground, facing = body_track(clip)
    speeds = np.concatenate([velocities(clip.root_positions, clip.fps)[:, None], turn_speeds(clip)], axis=1)
    moving: Points = np.gradient(ground) * clip.fps
    turning = velocities(facing, clip.fps)
    return ground, facing, moving, turning, clip.root_positions, clip.rotations, speeds


def turn_speeds(motion: Motion) -> Array:
    """Measure how fast each joint turns in its own frame, (F, J, 3) rad/s: the mean of the two steps around.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> turn_speeds(sample("walk_straight")).shape
    (1201, 38, 3)
    """
    relative = rotations.multiply(rotations.inverse(motion.rotations[:-1]), motion.rotations[1:])
    steps = rotations.to_rotvec(relative) * motion.fps
    return np.concatenate([steps[:1], (steps[1:] + steps[:-1]) / 2, steps[-1:]])


def _marks(marks: Sequence[Mapping[str, Mask]], frames: Sequence[int]) -> dict[str, Mask]:
    """Put marks in a row; one that a clip lacks is off there."""
    names = dict.fromkeys(name for own in marks for name in own)
    rows = list(zip(marks, frames, strict=True))
    return {n: np.concatenate([own.get(n, np.zeros(count, bool)) for own, count in rows]) for n in names}
