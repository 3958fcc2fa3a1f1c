"""The figure of the walking page and of players: tapered capsules around a body, whatever names it has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body.limbs import roles
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError
from mocap.files.gltf_capsules import THICK, reaches

LEG = 0.86  # metres from hip to ankle of the person whose radii stand below
LEVEL = ("pelvis", "chest")
TRUNK = ("pelvis", "chest", "neck", "head", "left shoulder", "left elbow", "left wrist")

HIPS, SHOULDERS = ("left hip", "right hip"), ("left shoulder", "right shoulder")
AXES = {  # of a part: what it is along, and its left
    "pelvis": ("pelvis", "chest", *HIPS),
    "waist": ("waist", "chest", *SHOULDERS),
    "chest": ("pelvis", "neck", *SHOULDERS),
    "neck": ("neck", "head", *SHOULDERS),
    "head": ("neck", "head", *SHOULDERS),
    "hip": ("hip", "knee", *HIPS),
    "knee": ("knee", "ankle", *HIPS),
    "ankle": ("ankle", "ball", *HIPS),
    "ball": ("ankle", "ball", *HIPS),
    "shoulder": ("shoulder", "elbow", *SHOULDERS),
    "elbow": ("elbow", "wrist", *SHOULDERS),
    "wrist": ("elbow", "wrist", *SHOULDERS),
}

Piece = tuple[str, Array, float, Array, float, float, int]
"""The joint's role; one end, its radius, the other end, its radius; flatness; side: 1 left, -1 right."""


def figure(skeleton: Skeleton) -> list[list[Any]]:
    """Give the capsules of a body: [joint, end, radius, other end, radius, flatness, side], metres.

    The ends are seen from the joint while no joint is turned. A body whose legs, arms and trunk have no known
    names gets a capsule for each bone, as the glTF writer draws it.
    """
    who = known(skeleton)
    if not set(TRUNK) <= set(who):
        return list(_bones(skeleton).values())
    places = skeleton.rest
    at = {role: places[joint] for role, joint in who.items()}
    leg = np.linalg.norm(np.diff([at[f"left {part}"] for part in ("hip", "knee", "ankle")], axis=0), axis=1)
    size = float(leg.sum()) / LEG
    pieces = [*_trunk(at, size), *_limbs(at, size, "left", 1), *_limbs(at, size, "right", -1)]
    return [
        [who[role], *_end(a - at[role], ra * size), *_end(b - at[role], rb * size), flat, side]
        for role, a, ra, b, rb, flat, side in pieces
    ]


def posed(skeleton: Skeleton, drawn: Indices) -> dict[str, list[list[Any]]]:
    """Give the capsules of a body for a player, which knows where the drawn joints are, but no turns.

    Returns
    -------
    `parts` of the body, each [origin, from, to, left, right, level], which count the drawn joints. The axes
    of a part point to its left, along it, and ahead; it keeps its left where `level` is 1, else what it is
    along.
    `pieces` as in `figure`, seen from the axes of a part, whose number comes first.
    """
    places, who = skeleton.rest, known(skeleton)
    if set(TRUNK) <= set(who):
        pieces = [(row[0], row) for row in figure(skeleton)]
        axes = {joint: (joint, *_along(who, role)) for role, joint in who.items() if role.split()[-1] in AXES}
    else:
        pieces = list(_bones(skeleton).items())
        axes = {child: (row[0], row[0], child, row[0], row[0], False) for child, row in pieces}
    parts = {joint: axes[joint] for joint, _ in pieces}

    def number(joint: int) -> int:  # what starts where its parent ends is drawn there
        return int(np.searchsorted(drawn, joint)) if joint in drawn else number(int(skeleton.parents[joint]))

    def seen(joint: int, end: list[float]) -> list[float]:
        return [round(value, 4) for value in (_axes(places, parts[joint]) @ end).tolist()]

    return {
        "parts": [[*map(number, row[:5]), int(row[5])] for row in parts.values()],
        "pieces": [
            [list(parts).index(joint), seen(joint, a), ra, seen(joint, b), rb, flat, side]
            for joint, (_, a, ra, b, rb, flat, side) in pieces
        ],
    }


def capsules_at(character: Mapping[str, Any], pose: Array) -> Array:
    """Place the capsules of a packed character, as `capsulesAt` in `player_body.js` does.

    Parameters
    ----------
    character : with the `parts` and `pieces` of `posed`.
    pose : of its drawn joints, shape (J, 3), metres.

    Returns
    -------
    Shape (P, 12): an end and its radius, the other end and its radius, the way it is flattened, how much.
    """
    parts, pieces = character["parts"], np.array([np.hstack(row) for row in character["pieces"]])
    axes = np.array([_axes(pose, part) for part in parts])[pieces[:, 0].astype(int)]
    origins = pose[[parts[int(number)][0] for number in pieces[:, 0]]]
    a, b = (origins + (pieces[:, at : at + 3, None] * axes).sum(1) for at in (1, 5))
    ahead = np.cross(axes[:, 0], b - a) + 1e-6 * axes[:, 2]
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    return np.column_stack([a, pieces[:, 4], b, pieces[:, 8], ahead, pieces[:, 9]])


def _along(who: Mapping[str, int], role: str) -> list[int]:
    """Give the joints that span the axes of a role, and whether it keeps its left."""
    *side, part = role.split()
    return [*(who[name if name in who else " ".join([*side, name])] for name in AXES[part]), part in LEVEL]


def _axes(places: Array, part: tuple[int, ...]) -> Array:
    """Give the axes of a part at rest, in rows, as `axesOf` in `player_body.js` does."""
    _, start, end, left, right, level = part
    along, across = places[end] - places[start], places[left] - places[right]
    x = across / np.linalg.norm(across) if level else _beside(across, along / np.linalg.norm(along))
    y = _beside(along, x) if level else along / np.linalg.norm(along)
    return np.array([x, y, np.cross(x, y)])


def _beside(a: Array, b: Array) -> Array:
    """Give the unit vector of a at right angles to the unit vector b."""
    v = a - a @ b * b
    length = float(np.linalg.norm(v))
    return v / length if length > 1e-6 else _beside(np.roll(b, -1), b)


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


def _bones(skeleton: Skeleton) -> dict[int, list[Any]]:
    behind, lengths = reaches(skeleton), np.linalg.norm(skeleton.offsets, axis=-1)
    longest, pieces = behind[0], {}
    for joint in range(1, len(skeleton)):
        if lengths[joint] > 1e-3 * longest:
            further = np.array([lengths[joint], 0.05 * longest]) + behind[joint]
            start, end = THICK * np.sqrt(longest * further)
            parent = int(skeleton.parents[joint])
            side = {"left": 1, "right": -1}.get(skeleton.side(parent), 0)
            pieces[joint] = [parent, *_end(np.zeros(3), start), *_end(skeleton.offsets[joint], end), 1, side]
    return pieces
