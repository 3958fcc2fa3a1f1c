"""The body that walks: its skeleton, its measures, and its legs, bent down to given feet."""

from __future__ import annotations

import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from walking.footsteps import Foot, FootPath
from walking.two_bone_ik import two_bone

STATURE = 1.75  # metres
FPS = 120.0
TOO_LONG = "The steps are longer than the legs: walk slower, or take a wider turn."

FIGURES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("walker.toml").read_text("utf-8"))
"""All figures of the bundled clips; the file says what they are, and where they come from."""

SKELETON = Skeleton.from_table(FIGURES["body"], scale=STATURE)
HIPS = {side: SKELETON.offsets[SKELETON.index(f"{side}femur")] for side in "lr"}
THIGH = 0.245 * STATURE
SHANK = 0.246 * STATURE
FOOT = Foot(
    ankle=0.039 * STATURE,
    ball=0.015 * STATURE,
    heel=0.029 * STATURE,
    instep=0.074 * STATURE,
    toe=0.040 * STATURE,
)


class LegAngles(NamedTuple):
    """A leg as seen from the pelvis, which faces along the path: angles of shape (F,), radians.

    `thigh` is the angle of the thigh ahead of hanging straight down, `knee` the flexion, and `splay` the
    angle by which the line from hip to ankle leads to the left.
    """

    thigh: Array
    knee: Array
    splay: Array


def leg_length(knee: ArrayLike) -> Array:
    """Distance from hip to ankle, metres, for a knee's flexion in radians.

    It is √(a² + b² + 2 a b cos κ) with the lengths a, b of thigh and shank, by the law of cosines.

    Examples
    --------
    >>> float(leg_length(0.0).round(6))
    0.85925
    """
    squares = THIGH**2 + SHANK**2 + 2 * THIGH * SHANK * np.cos(knee)
    return np.asarray(np.sqrt(squares))


def knee_of(length: ArrayLike) -> Array:
    """Flexion of the knee, radians, for a distance from hip to ankle: the inverse of `leg_length`.

    A leg that is longer than its bones is straight.
    """
    squares = np.square(length) - THIGH**2 - SHANK**2
    return np.asarray(np.arccos(np.clip(squares / (2 * THIGH * SHANK), -1, 1)))


def hip_above_ankle(reach: Array, knee: ArrayLike) -> Array:
    """Height of a hip above its ankle, metres.

    Parameters
    ----------
    reach : shape (F, 3): from the hip to the ankle, metres; its height is not used.
    knee : flexion, radians.

    Returns
    -------
    √(ℓ² - x² - z²), with the leg's length ℓ; shape (F,). 0.1 m where the ankle is too far away.
    """
    squares = leg_length(knee) ** 2 - reach[:, 0] ** 2 - reach[:, 2] ** 2
    return np.asarray(np.sqrt(np.maximum(squares, 0.01)))


def _thigh_ahead_of_leg(knee: Array) -> Array:
    """Angle between the thigh and the line from hip to ankle, radians."""
    return np.asarray(np.arctan2(SHANK * np.sin(knee), THIGH + SHANK * np.cos(knee)))


def to_leg_angles(reach: Array) -> LegAngles:
    """Read the angles of legs off the vectors from hip to ankle.

    Parameters
    ----------
    reach : shape (F, 3): to the left, up and ahead, metres.

    Examples
    --------
    >>> angles = to_leg_angles(np.array([[0.0, -0.8, 0.0]]))
    >>> np.degrees(angles.knee).round(1)
    array([42.8])
    """
    length = np.linalg.norm(reach, axis=-1)
    knee = knee_of(length)
    thigh = np.arctan2(reach[:, 2], -reach[:, 1]) + _thigh_ahead_of_leg(knee)
    return LegAngles(thigh, knee, np.arcsin(reach[:, 0] / length))


def from_leg_angles(angles: LegAngles) -> Array:
    """Vectors (F, 3) from hip to ankle, to the left, up and ahead: the inverse of `to_leg_angles`."""
    length = leg_length(angles.knee)
    ahead = angles.thigh - _thigh_ahead_of_leg(angles.knee)
    level = length * np.cos(angles.splay)
    across = length * np.sin(angles.splay)
    return np.stack([across, -level * np.cos(ahead), level * np.sin(ahead)], axis=-1)


def leg(side: str, pelvis: Array, root: Array, foot: FootPath, ahead: Array) -> dict[str, Array]:
    """Bend a leg down to its foot; the knee points halfway between the foot and the pelvis.

    Parameters
    ----------
    side : "l" or "r".
    pelvis : shape (F, 4), the root's orientation.
    root : shape (F, 3), its position, metres.
    foot : the foot's path.
    ahead : shape (F, 3), unit vectors: where the pelvis faces.

    Returns
    -------
    {joint: rotations (F, 4) relative to the parent}, for hip, knee, ankle and toes.

    Raises
    ------
    MocapError : where the leg is too short for the step.
    """
    toes = np.stack([np.sin(foot.yaw), np.zeros_like(foot.yaw), np.cos(foot.yaw)], axis=-1)
    hip = root + rotations.rotate(pelvis, HIPS[side])
    limb = two_bone(hip, foot.ankle, (THIGH, SHANK), ahead + toes)
    if not limb.reached.all():
        raise MocapError(TOO_LONG)
    sole = rotations.multiply(rotations.about_y(foot.yaw), euler.from_euler("x", -foot.pitch[:, None]))
    turns = [pelvis, limb.upper, limb.lower, sole]
    local = {}
    for joint, (above, turn) in zip(("femur", "tibia", "foot"), pairwise(turns), strict=True):
        local[side + joint] = rotations.multiply(rotations.inverse(above), turn)
    return local | {side + "toes": euler.from_euler("x", (foot.pitch - foot.toe)[:, None])}
