"""The figure of the walking page: tapered capsules around the parts of a body, whatever they are called."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.skeleton import Skeleton
from mocap.editing.body_roles import roles
from mocap.errors import MocapError
from mocap.files.gltf_capsules import THICK, reaches, rest

LEG = 0.86  # metres from hip to ankle of the person whose radii stand below
TRUNK = ("pelvis", "chest", "neck", "head", "left shoulder", "left elbow", "left wrist")

Piece = tuple[str, Array, float, Array, float, float, int]
"""The joint's role; one end, its radius, the other end, its radius; flatness; side: 1 left, -1 right."""


def figure(skeleton: Skeleton) -> list[list[Any]]:
    """Give the capsules of a body: [joint, end, radius, other end, radius, flatness, side], metres.

    The ends are seen from the joint while no joint is turned. A body whose legs, arms and trunk have no known
    names gets a capsule for each bone, as the glTF writer draws it.
    """
    who = known(skeleton)
    if not set(TRUNK) <= set(who):
        return _bones(skeleton)
    places = rest(skeleton)
    at = {role: places[joint] for role, joint in who.items()}
    leg = np.linalg.norm(np.diff([at[f"left {part}"] for part in ("hip", "knee", "ankle")], axis=0), axis=1)
    size = float(leg.sum()) / LEG
    pieces = [*_trunk(at, size), *_limbs(at, size, "left", 1), *_limbs(at, size, "right", -1)]
    return [
        [who[role], *_end(a - at[role], ra * size), *_end(b - at[role], rb * size), flat, side]
        for role, a, ra, b, rb, flat, side in pieces
    ]


def known(skeleton: Skeleton) -> Mapping[str, int]:
    """Give the roles of joints; none where the legs have no known names."""
    try:
        return roles(skeleton)
    except MocapError:
        return {}


def feet(skeleton: Skeleton) -> list[list[int]]:
    """Give the ankle and the ball of both feet, where they are known."""
    who = known(skeleton)
    return [[who[f"{side} ankle"], who[f"{side} ball"]] for side in ("left", "right")] if who else []


def _end(place: Array, radius: float) -> tuple[list[float], float]:
    return place.round(4).tolist(), round(radius, 4)


def _trunk(at: Mapping[str, Array], size: float) -> list[Piece]:
    def up(height: float, ahead: float = 0.0) -> Array:
        return np.array([0.0, height, ahead]) * size

    waist = "waist" if "waist" in at else "pelvis"
    hips, arms = ([at[f"{side} {part}"] for side in ("left", "right")] for part in ("hip", "shoulder"))
    middle, chest, head = (hips[0] + hips[1]) / 2, (arms[0] + arms[1]) / 2, at["head"]
    hip, other = (0.72 * hip + 0.28 * middle + up(0.02) for hip in hips)
    shoulder, far = (0.74 * arm + 0.26 * chest - up(0.015) for arm in arms)
    ribs = 0.55 * at[waist] + 0.45 * chest + up(0.05)
    return [
        ("pelvis", hip, 0.094, other, 0.094, 0.95, 0),
        (waist, at[waist] + up(0.02), 0.108, (at[waist] + chest) / 2 + up(0.02), 0.116, 0.78, 0),
        ("chest", ribs, 0.118, chest - up(0.07), 0.142, 0.72, 0),
        ("chest", shoulder, 0.062, far, 0.062, 1.0, 0),
        ("neck", at["neck"] - up(0.03), 0.068, head, 0.05, 1.0, 0),
        ("head", head + up(0.03, 0.03), 0.062, head + up(0.075, 0.025), 0.086, 0.9, 0),
        ("head", head + up(0.1, -0.012), 0.096, head + up(0.115, 0.012), 0.096, 0.9, 0),
    ]


def _limbs(at: Mapping[str, Array], size: float, side: str, sign: int) -> list[Piece]:
    hip, knee, ankle, ball = (at[f"{side} {part}"] for part in ("hip", "knee", "ankle", "ball"))
    shoulder, elbow, wrist = (at[f"{side} {part}"] for part in ("shoulder", "elbow", "wrist"))
    shank, back, down = ankle - knee, np.array([0, 0, -size]), np.array([0, -size, 0])
    hand = size * (wrist - elbow) / np.linalg.norm(wrist - elbow)
    calf = 0.015 * back
    rows = [
        ("hip", hip, 0.086, knee, 0.056, 1.0),
        ("knee", knee, 0.056, ankle, 0.036, 1.0),
        ("knee", knee + 0.14 * shank + calf, 0.048, knee + 0.42 * shank + calf, 0.05, 1.0),
        ("ankle", ankle, 0.036, ball, 0.036, 1.0),
        ("ankle", ankle + 0.03 * down + 0.03 * back, 0.038, ball, 0.036, 1.0),
        ("ball", ball, 0.036, ball + 0.008 * down - 0.06 * back, 0.026, 1.0),
        ("shoulder", shoulder, 0.05, elbow, 0.038, 1.0),
        ("elbow", elbow, 0.039, wrist, 0.027, 1.0),
        ("wrist", wrist + 0.02 * hand, 0.03, wrist + 0.075 * hand, 0.037, 0.7),
        ("wrist", wrist + 0.08 * hand, 0.034, wrist + 0.155 * hand, 0.018, 0.7),
    ]
    return [(f"{side} {part}", *row, sign) for part, *row in rows]  # type: ignore[misc]


def _bones(skeleton: Skeleton) -> list[list[Any]]:
    behind, lengths = reaches(skeleton), np.linalg.norm(skeleton.offsets, axis=-1)
    longest, pieces = behind[0], []
    for joint in range(1, len(skeleton)):
        if lengths[joint] > 1e-3 * longest:
            further = np.array([lengths[joint], 0.05 * longest]) + behind[joint]
            start, end = THICK * np.sqrt(longest * further)
            parent = int(skeleton.parents[joint])
            pieces.append([parent, *_end(np.zeros(3), start), *_end(skeleton.offsets[joint], end), 1, 0])
    return pieces
