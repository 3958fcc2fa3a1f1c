"""Strides of a clip, cut out and measured: curves of joint angles that can be compared between bodies.

All angles are measured between joint positions, because every skeleton has these, whatever the rest pose of
its bones. A stride starts where the ankle is farthest ahead of the hips, some 0.03 strides before the heel
strikes, and ends where the same ankle is farthest ahead again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from mocap._shared.arrays import Array, Indices
from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import roles
from mocap.body.motion import Motion

ANGLES = (
    "hip",
    "knee",
    "ankle",
    "foot pitch",
    "pelvis turn",
    "pelvis list",
    "thorax turn",
    "shoulder",
    "elbow",
)
SAMPLES = 101  # of a curve over the stride: 0, 1, ... 100 %
MID_STANCE = slice(18, 29)  # percent of the stride: the sole is flat, its pitch is zero there
OTHER = {"left": "right", "right": "left"}
LEFT = 0  # axes of positions as seen from the hips
UP = 1
AHEAD = 2


class Seen(NamedTuple):
    """A clip as seen from its hips, frame by frame.

    `joints` (F, J, 3) are positions to the left, up and ahead of the point on the floor below the hips,
    metres; `hips` (F, 3) is the middle between the hip joints in the world; `heading` (F,) the direction of
    travel about +y from +z, radians.
    """

    joints: Array
    hips: Array
    heading: Array


class Stride(NamedTuple):
    """A stride of one leg.

    `side` is "left" or "right", `start` and `stop` are frames; `seconds`, `speed` (m/s), `turn_rate` (degrees
    per second to the left); `opposite` is the fraction of the stride at which the other foot is farthest
    ahead. `curves` holds arrays (101,): the `ANGLES` in degrees, and "height" of the hips, "tip" of the toes'
    joint and "radius" of the path's bend in metres.
    """

    side: str
    start: int
    stop: int
    seconds: float
    speed: float
    turn_rate: float
    opposite: float
    curves: Mapping[str, Array]

    @property
    def step(self) -> float:
        """Half the stride's length, metres."""
        return self.speed * self.seconds / 2


def see_from_hips(motion: Motion) -> Seen:
    """Express joint positions in a frame that follows the hips and faces along their path."""
    role = roles(motion.skeleton)
    positions = joint_positions(motion)
    hips = (positions[:, role["left hip"]] + positions[:, role["right hip"]]) / 2
    ground_track = gaussian_filter1d(hips[:, [0, 2]], 0.25 * motion.fps, axis=0)
    velocity = np.gradient(ground_track, axis=0)
    heading = np.unwrap(np.arctan2(velocity[:, 0], velocity[:, 1]))
    from_hips = positions - (hips * [1, 0, 1])[:, None]
    joints = rotations.rotate(rotations.about_y(-heading)[:, None], from_hips)
    return Seen(joints, hips, np.asarray(heading))


def _from_hanging(bone: Array) -> Array:
    """Angle of bones (F, 3) ahead of hanging straight down, degrees."""
    return np.asarray(np.degrees(np.arctan2(bone[:, AHEAD], -bone[:, UP])))


def _about_vertical(across: Array) -> Array:
    """Angle by which lines across the body (F, 3) bring their end ahead, degrees."""
    level = np.hypot(across[:, LEFT], across[:, AHEAD])
    return np.asarray(np.degrees(np.arcsin(across[:, AHEAD] / level)))


def _angle_between(first: Array, second: Array) -> Array:
    lengths = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    cosine = (first * second).sum(axis=-1) / lengths
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def side_curves(motion: Motion, seen: Seen, side: str) -> dict[str, Array]:
    """Measure the angles of one side of the body in every frame.

    Returns
    -------
    {name of `ANGLES`, "height" or "tip": (F,)}, degrees and metres. Hip, shoulder and foot pitch are angles
    to the vertical or the floor. The ankle's is left without the pitch of the sole, which `find_strides`
    adds after it has found which pitch is that of a flat sole.
    """
    role = roles(motion.skeleton)
    opposite = OTHER[side]

    def bone(start: str, end: str) -> Array:
        return np.asarray(seen.joints[:, role[end]] - seen.joints[:, role[start]])

    thigh = _from_hanging(bone(f"{side} hip", f"{side} knee"))
    shank = _from_hanging(bone(f"{side} knee", f"{side} ankle"))
    sole = bone(f"{side} ankle", f"{side} ball")
    upper_arm = bone(f"{side} shoulder", f"{side} elbow")
    pelvis = bone(f"{opposite} hip", f"{side} hip")
    thorax = bone(f"{opposite} shoulder", f"{side} shoulder")
    forearm = bone(f"{side} elbow", f"{side} wrist")
    legs = {"hip": thigh, "knee": thigh - shank, "ankle": -shank}
    pitch = np.arctan2(sole[:, UP], sole[:, AHEAD])
    listing = np.arcsin(pelvis[:, UP] / np.linalg.norm(pelvis, axis=-1))
    trunk = {"foot pitch": np.degrees(pitch), "pelvis turn": _about_vertical(pelvis)}
    trunk |= {"pelvis list": np.degrees(listing), "thorax turn": _about_vertical(thorax)}
    arms = {"shoulder": _from_hanging(upper_arm), "elbow": _angle_between(upper_arm, forearm)}
    ball = seen.joints[:, role[f"{side} ball"], UP]
    return legs | trunk | arms | {"height": seen.hips[:, UP], "tip": ball}


def _farthest_ahead(motion: Motion, seen: Seen, side: str) -> Indices:
    """Frames in which an ankle is farthest ahead of the hips."""
    ahead = seen.joints[:, roles(motion.skeleton)[f"{side} ankle"], AHEAD]
    smooth = gaussian_filter1d(ahead, 0.02 * motion.fps)
    frames, _ = find_peaks(smooth, distance=max(1, round(0.3 * motion.fps)), prominence=0.15)
    return np.asarray(frames)


def _cut(curves: Mapping[str, Array], start: int, stop: int) -> dict[str, Array]:
    """Sample the curves of a stride at 0 to 100 %, and set the pitch of the flat sole to zero."""
    frames = np.linspace(start, stop, SAMPLES)
    cut = {name: np.interp(frames, np.arange(len(curve)), curve) for name, curve in curves.items()}
    cut["foot pitch"] = cut["foot pitch"] - np.median(cut["foot pitch"][MID_STANCE])
    cut["ankle"] = cut["ankle"] + cut["foot pitch"]
    return cut


def find_strides(motion: Motion, shortest: float = 0.8, longest: float = 1.6) -> list[Stride]:
    """Cut a clip into the strides of both legs.

    Parameters
    ----------
    motion : with legs and arms that `roles` finds.
    shortest, longest : seconds of a stride; others are left out.

    Returns
    -------
    The strides in which the other foot comes ahead exactly once.

    Raises
    ------
    MocapError : for a body without legs.

    Examples
    --------
    >>> from mocap import datasets
    >>> stride = find_strides(datasets.sample("walk_straight"))[0]
    >>> 0.8 < stride.seconds < 1.6, stride.curves["knee"].shape
    (True, (101,))
    """
    seen = see_from_hips(motion)
    strides = []
    for side, opposite_side in OTHER.items():
        curves = side_curves(motion, seen, side)
        opposites = _farthest_ahead(motion, seen, opposite_side)
        for start, stop in pairwise(_farthest_ahead(motion, seen, side).tolist()):
            seconds = (stop - start) / motion.fps
            inside = opposites[(opposites > start) & (opposites < stop)]
            if not shortest < seconds < longest or len(inside) != 1:
                continue
            track = seen.hips[start : stop + 1][:, [0, 2]]
            length = float(np.linalg.norm(np.diff(track, axis=0), axis=-1).sum())
            turn = float(np.degrees(seen.heading[stop] - seen.heading[start]))
            opposite = float(inside[0] - start) / (stop - start)
            numbers = (seconds, length / seconds, turn / seconds, opposite)
            strides.append(Stride(side, start, stop, *numbers, _cut(curves, start, stop)))
    return strides


def is_plain_walk(stride: Stride) -> bool:
    """Tell whether a stride is one of plain walking: 0.75 to 1.75 m/s, even steps, a knee that swings."""
    knee = stride.curves["knee"]
    turned = abs(stride.curves["pelvis turn"]).max()
    even = 0.75 < stride.speed < 1.75 and 0.4 < stride.opposite < 0.6
    swinging = 45 < knee.max() < 80 and 55 < knee.argmax() < 85
    heel_first = stride.curves["foot pitch"][0] > 5
    return bool(even and swinging and heel_first and knee[20:50].min() < 35 and turned < 20)


def is_straight(stride: Stride, limit: float = 12.0) -> bool:
    """Tell whether a stride turns by no more than so many degrees."""
    return abs(stride.turn_rate * stride.seconds) < limit


def median_curve(strides: Sequence[Stride], angle: str) -> Array:
    """Median over strides of a curve, shape (101,)."""
    return np.asarray(np.median([stride.curves[angle] for stride in strides], axis=0))


def mean_of(strides: Sequence[Stride], key: str) -> float:
    """Mean over strides of a number of theirs, as "speed"."""
    return float(np.mean([getattr(stride, key) for stride in strides]))


def fraction_within_one_sd(curve: Array, people: Sequence[Array]) -> float:
    """Fraction of the stride in which a curve is within one standard deviation of the people's mean.

    Each curve (101,) is taken less its own mean, because skeletons differ in their zero. The standard
    deviation is that of a sample, √(Σ (x - x̄)² / (n - 1)), at each percent of the stride.

    Examples
    --------
    >>> low, high = np.linspace(-1, 1, 101), np.linspace(-3, 3, 101)
    >>> fraction_within_one_sd((low + high) / 2, [low, high])
    1.0
    """
    rows = np.array([row - row.mean() for row in people])
    distance = abs(curve - curve.mean() - rows.mean(axis=0))
    return float(np.mean(distance <= rows.std(axis=0, ddof=1) + 1e-12))
