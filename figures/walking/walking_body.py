"""The body that walks, and its legs: from the planted feet up to the pelvis, and down again.

The path of the pelvis over the ground and the paths of both feet are given. The pelvis gets the height at
which the loaded knees bend as their gait says; then `two_bone_ik` bends both legs down to the feet.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap.body import euler, rotations
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from walking.footsteps import Foot, FootPath
from walking.two_bone_ik import two_bone

STATURE = 1.75  # metres
FPS = 120.0
LEAST_KNEE = np.radians(6.0)  # a knee never straightens further

FIGURES: dict[str, Any] = tomllib.loads(Path(__file__).with_name("walker.toml").read_text("utf-8"))
"""All figures of the bundled clips; the file says what they are, and where they come from."""

SKELETON = Skeleton.from_table(FIGURES["body"], scale=STATURE)
HIPS = {side: SKELETON.offsets[SKELETON.index(f"{side}femur")] for side in "lr"}
THIGH, SHANK = 0.245 * STATURE, 0.246 * STATURE
FOOT = Foot(0.039 * STATURE, 0.015 * STATURE, 0.029 * STATURE, 0.074 * STATURE, 0.040 * STATURE)


def pelvis_height(
    root: Array,
    hips: Mapping[str, Array],
    feet: Mapping[str, FootPath],
    bends: Mapping[str, Array],
    weight: ArrayLike,
) -> Array:
    """Find the height of the pelvis at which each loaded knee bends as it should.

    With knee angle κ a leg is ℓ long, ℓ² = a² + b² + 2 a b cos κ, and its hip is √(ℓ² - d²) above the ankle,
    where d is their horizontal distance. The heights for both legs are averaged, weighted by load.

    Parameters
    ----------
    root : shape (F, 3), metres: the pelvis at its usual height.
    hips : {side: (F, 3)}: from the root to the hip joints, metres.
    feet : {side: the foot's path}.
    bends : {side: (F,)}: how far each knee should bend, radians.
    weight : number or shape (F,): the weight of the usual height; a leg that carries the body has weight 1.

    Returns
    -------
    Shape (F,), metres; smooth, and low enough for both legs to reach their feet with bent knees.
    """
    wishes, weights = np.multiply(weight, root[:, 1]), np.full(len(root), weight)
    limit = np.full(len(root), np.inf)
    for side, foot in feet.items():
        apart = foot.ankle - root - hips[side]
        floor = foot.ankle[:, 1] - hips[side][:, 1]
        wishes = wishes + foot.load * (floor + _rise(apart, bends[side]))
        weights = weights + foot.load
        limit = np.minimum(limit, floor + _rise(apart, LEAST_KNEE))
    height = gaussian_filter1d(wishes / weights, 0.03 * FPS)
    # The drop is widened by the radius of the filter that smooths it, so it is large enough everywhere.
    around = round(0.1 * FPS)
    drop = maximum_filter1d(np.maximum(height - limit, 0), 1 + 2 * around)
    return np.asarray(height - gaussian_filter1d(drop, 0.04 * FPS, radius=around))


def _rise(apart: Array, knee: ArrayLike) -> Array:
    """Find how far a hip is above its ankle, from the vector between them and the angle of the knee."""
    length2 = THIGH**2 + SHANK**2 + 2 * THIGH * SHANK * np.cos(knee)
    return np.asarray(np.sqrt(np.maximum(length2 - apart[:, 0] ** 2 - apart[:, 2] ** 2, 0)))


def leg(side: str, pelvis: Array, root: Array, foot: FootPath, ahead: Array) -> dict[str, Array]:
    """Bend a leg down to its foot; the knee points halfway between the foot and the pelvis.

    Parameters
    ----------
    side : "l" or "r".
    pelvis : shape (F, 4), the root's orientation.
    root : shape (F, 3), its place, metres.
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
        raise MocapError("The steps are longer than the legs: walk slower, or take a wider turn.")
    sole = rotations.multiply(rotations.about_y(foot.yaw), euler.from_euler("x", -foot.pitch[:, None]))
    turns = [pelvis, limb.upper, limb.lower, sole]
    local = {
        side + joint: rotations.multiply(rotations.inverse(above), turn)
        for joint, (above, turn) in zip(("femur", "tibia", "foot"), pairwise(turns), strict=True)
    }
    return local | {side + "toes": euler.from_euler("x", (foot.pitch - foot.toe)[:, None])}
