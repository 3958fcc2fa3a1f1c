"""The figure of the walking page and of players: tapered capsules around a body, for any joint names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body.body_sides import sides
from mocap.body.limbs import roles
from mocap.body.skeleton import Skeleton, reaches
from mocap.errors import MocapError
from mocap.files.gltf_capsules import THICK

LEG = 0.86  # metres from hip to ankle of the person to whom the radii below apply
LEG_PARTS = ("left hip", "left knee", "left ankle")
LEVEL = ("pelvis", "chest")  # parts whose axis to the left is exact, instead of the axis along the part
TRUNK = ("pelvis", "chest", "neck", "head", "left shoulder", "left elbow", "left wrist")
SIDES = {"left": 1, "right": -1}

# The roles at the start and the end of each part, and the roles at its left and its right.
AXES = {
    "pelvis": ("pelvis", "chest", "left hip", "right hip"),
    "waist": ("waist", "chest", "left shoulder", "right shoulder"),
    "chest": ("pelvis", "neck", "left shoulder", "right shoulder"),
    "neck": ("neck", "head", "left shoulder", "right shoulder"),
    "head": ("neck", "head", "left shoulder", "right shoulder"),
    "hip": ("hip", "knee", "left hip", "right hip"),
    "knee": ("knee", "ankle", "left hip", "right hip"),
    "ankle": ("ankle", "ball", "left hip", "right hip"),
    "ball": ("ankle", "ball", "left hip", "right hip"),
    "shoulder": ("shoulder", "elbow", "left shoulder", "right shoulder"),
    "elbow": ("elbow", "wrist", "left shoulder", "right shoulder"),
    "wrist": ("elbow", "wrist", "left shoulder", "right shoulder"),
}

# Columns of a packed piece.
PART = 0
START = slice(1, 4)
START_RADIUS = 4
END = slice(5, 8)
END_RADIUS = 8
FLATNESS = 9

SHORTEST_BONE = 1e-3  # fraction of the longest limb: a shorter bone gets no capsule
TIP = 0.05  # fraction of the longest limb that is added to the limb below the end of a bone


class Piece(NamedTuple):
    """A capsule at the joint of a `role`, with ends in metres and radii for a person with a leg of `LEG`."""

    role: str
    start: Array
    start_radius: float
    end: Array
    end_radius: float
    flatness: float = 1.0
    side: int = 0  # 1 left, -1 right


def figure(skeleton: Skeleton) -> list[list[Any]]:
    """Return the capsules of a body in rows [joint, start, radius, end, radius, flatness, side], metres.

    The ends are relative to the joint in the pose without rotations. A body whose legs, arms and trunk have
    unknown names gets a capsule for each bone, as in the glTF writer.
    """
    joints = _roles(skeleton)
    if not set(TRUNK) <= set(joints):
        return list(_bones(skeleton).values())
    positions = {role: skeleton.rest[joint] for role, joint in joints.items()}
    bones = np.diff([positions[role] for role in LEG_PARTS], axis=0)
    size = float(np.linalg.norm(bones, axis=1).sum()) / LEG
    pieces = [*_trunk(positions, size), *_limbs(positions, size, "left"), *_limbs(positions, size, "right")]
    rows = []
    for piece in pieces:
        origin = positions[piece.role]
        start = _end(piece.start - origin, piece.start_radius * size)
        end = _end(piece.end - origin, piece.end_radius * size)
        rows.append([joints[piece.role], *start, *end, piece.flatness, piece.side])
    return rows


def posed(skeleton: Skeleton, drawn: Indices) -> dict[str, list[list[Any]]]:
    """Return the capsules of a body for a player, which has the positions of joints but no rotations.

    Parameters
    ----------
    skeleton : J joints.
    drawn : the indices of the joints whose positions the player has, in order.

    Returns
    -------
    parts : rows [origin, from, to, left, right, level], with indices of drawn joints. The axes of a part
        point to its left, along it, and ahead. If `level` is 1, the axis to the left is exact, else the axis
        along the part.
    pieces : rows as in `figure`, relative to the axes of a part, whose index comes first.
    """
    joints = _roles(skeleton)
    if set(TRUNK) <= set(joints):
        pieces = [(row[0], row) for row in figure(skeleton)]
        spans = _spans(joints)
    else:
        pieces = list(_bones(skeleton).items())
        spans = {child: (row[0], row[0], child, row[0], row[0], False) for child, row in pieces}
    parts = {joint: spans[joint] for joint, _ in pieces}
    order = list(parts)

    def index(joint: int) -> int:
        """Return the index of a joint among the drawn joints, or that of its nearest drawn ancestor."""
        return int(np.searchsorted(drawn, joint)) if joint in drawn else index(int(skeleton.parents[joint]))

    def in_axes(joint: int, end: list[float]) -> list[float]:
        """Return the coordinates of an end along the axes of a part."""
        return [round(value, 4) for value in (_axes(skeleton.rest, parts[joint]) @ end).tolist()]

    packed_parts = []
    for *spanning, level in parts.values():
        packed_parts.append([*map(index, spanning), int(level)])
    packed_pieces = []
    for joint, (_, start, start_radius, end, *rest) in pieces:
        ends = [in_axes(joint, start), start_radius, in_axes(joint, end)]
        packed_pieces.append([order.index(joint), *ends, *rest])
    return {"parts": packed_parts, "pieces": packed_pieces}


def capsules_at(character: Mapping[str, Any], pose: Array) -> Array:
    """Compute the capsules of a packed character in a pose, as `capsulesAt` in `player_body.js` does.

    Parameters
    ----------
    character : a packed character with the `parts` and `pieces` of `posed`.
    pose : positions of its drawn joints, shape (J, 3), metres.

    Returns
    -------
    Shape (P, 12): an end and its radius, the other end and its radius, the direction in which the capsule is
    flattened, its flatness.
    """
    pieces = np.array([np.hstack(row) for row in character["pieces"]])
    parts = [character["parts"][int(part)] for part in pieces[:, PART]]
    axes = np.array([_axes(pose, part) for part in parts])
    origins = pose[[origin for origin, *_ in parts]]
    starts = origins + (pieces[:, START, None] * axes).sum(1)
    ends = origins + (pieces[:, END, None] * axes).sum(1)
    ahead = np.cross(axes[:, 0], ends - starts) + 1e-6 * axes[:, 2]
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    start_radii = pieces[:, START_RADIUS]
    end_radii = pieces[:, END_RADIUS]
    return np.column_stack([starts, start_radii, ends, end_radii, ahead, pieces[:, FLATNESS]])


def _spans(joints: Mapping[str, int]) -> dict[int, tuple[Any, ...]]:
    """Return the part (origin, from, to, left, right, level) of each joint with axes, as joint indices."""
    spans: dict[int, tuple[Any, ...]] = {}
    for role, joint in joints.items():
        *side, part = role.split()
        if part in AXES:
            names = [name if name in joints else " ".join([*side, name]) for name in AXES[part]]
            spans[joint] = (joint, *(joints[name] for name in names), part in LEVEL)
    return spans


def _axes(positions: Array, part: tuple[int, ...]) -> Array:
    """Compute the axes of a part, in rows, as `axesOf` in `player_body.js` does."""
    _, start, end, left, right, level = part
    along = positions[end] - positions[start]
    across = positions[left] - positions[right]
    if level:
        x = across / np.linalg.norm(across)
        y = _perpendicular(along, x)
    else:
        y = along / np.linalg.norm(along)
        x = _perpendicular(across, y)
    return np.array([x, y, np.cross(x, y)])


def _perpendicular(a: Array, b: Array) -> Array:
    """Return the unit vector of the component of a that is orthogonal to the unit vector b."""
    v = a - a @ b * b
    length = float(np.linalg.norm(v))
    return v / length if length > 1e-6 else _perpendicular(np.roll(b, -1), b)


def _roles(skeleton: Skeleton) -> Mapping[str, int]:
    """Return the joints by their roles, or none if the names of the legs are unknown."""
    try:
        return roles(skeleton)
    except MocapError:
        return {}


def feet(skeleton: Skeleton) -> list[list[int]]:
    """Return the ankle and the ball of both feet, if they are known."""
    joints = _roles(skeleton)
    return [[joints[f"{side} ankle"], joints[f"{side} ball"]] for side in SIDES] if joints else []


def _end(position: Array, radius: float) -> tuple[list[float], float]:
    """Round the position and the radius of an end of a capsule."""
    return position.round(4).tolist(), round(radius, 4)


def _trunk(positions: Mapping[str, Array], size: float) -> Iterator[Piece]:
    """Yield the capsules of the trunk and the head."""

    def up(height: float, ahead: float = 0.0) -> Array:
        return np.array([0.0, height, ahead]) * size

    waist = "waist" if "waist" in positions else "pelvis"
    belly = positions[waist]
    head = positions["head"]
    left_hip = positions["left hip"]
    right_hip = positions["right hip"]
    left_shoulder = positions["left shoulder"]
    right_shoulder = positions["right shoulder"]
    hips = (left_hip + right_hip) / 2
    chest = (left_shoulder + right_shoulder) / 2
    ribs = 0.55 * belly + 0.45 * chest + up(0.05)

    left = 0.72 * left_hip + 0.28 * hips + up(0.02)
    right = 0.72 * right_hip + 0.28 * hips + up(0.02)
    yield Piece("pelvis", left, 0.094, right, 0.094, 0.95)
    yield Piece(waist, belly + up(0.02), 0.108, (belly + chest) / 2 + up(0.02), 0.116, 0.78)
    yield Piece("chest", ribs, 0.118, chest - up(0.07), 0.142, 0.72)
    left = 0.74 * left_shoulder + 0.26 * chest - up(0.015)
    right = 0.74 * right_shoulder + 0.26 * chest - up(0.015)
    yield Piece("chest", left, 0.062, right, 0.062)
    yield Piece("neck", positions["neck"] - up(0.03), 0.068, head, 0.05)
    yield Piece("head", head + up(0.03, 0.03), 0.062, head + up(0.075, 0.025), 0.086, 0.9)
    yield Piece("head", head + up(0.1, -0.012), 0.096, head + up(0.115, 0.012), 0.096, 0.9)


def _limbs(positions: Mapping[str, Array], size: float, side: str) -> Iterator[Piece]:
    """Yield the capsules of the leg and the arm of a side."""
    pieces = [*_leg(positions, size, side), *_arm(positions, size, side)]
    for piece in pieces:
        yield piece._replace(role=f"{side} {piece.role}", side=SIDES[side])


def _leg(positions: Mapping[str, Array], size: float, side: str) -> Iterator[Piece]:
    """Yield the capsules of a leg, without its side."""
    hip = positions[f"{side} hip"]
    knee = positions[f"{side} knee"]
    ankle = positions[f"{side} ankle"]
    ball = positions[f"{side} ball"]
    shank = ankle - knee
    back = np.array([0, 0, -size])
    down = np.array([0, -size, 0])
    calf = 0.015 * back
    yield Piece("hip", hip, 0.086, knee, 0.056)
    yield Piece("knee", knee, 0.056, ankle, 0.036)
    yield Piece("knee", knee + 0.14 * shank + calf, 0.048, knee + 0.42 * shank + calf, 0.05)
    yield Piece("ankle", ankle, 0.036, ball, 0.036)
    yield Piece("ankle", ankle + 0.03 * down + 0.03 * back, 0.038, ball, 0.036)
    yield Piece("ball", ball, 0.036, ball + 0.008 * down - 0.06 * back, 0.026)


def _arm(positions: Mapping[str, Array], size: float, side: str) -> Iterator[Piece]:
    """Yield the capsules of an arm, without its side. The hand is aligned with the forearm."""
    shoulder = positions[f"{side} shoulder"]
    elbow = positions[f"{side} elbow"]
    wrist = positions[f"{side} wrist"]
    hand = size * (wrist - elbow) / np.linalg.norm(wrist - elbow)
    yield Piece("shoulder", shoulder, 0.05, elbow, 0.038)
    yield Piece("elbow", elbow, 0.039, wrist, 0.027)
    yield Piece("wrist", wrist + 0.02 * hand, 0.03, wrist + 0.075 * hand, 0.037, 0.7)
    yield Piece("wrist", wrist + 0.08 * hand, 0.034, wrist + 0.155 * hand, 0.018, 0.7)


def _bones(skeleton: Skeleton) -> dict[int, list[Any]]:
    """Return a capsule for each bone, as in `figure`, by the joint at its end."""
    limbs = reaches(skeleton)
    longest = limbs[0]
    pieces = {}
    side_of = sides(skeleton)
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    for joint in range(1, len(skeleton)):
        length = lengths[joint]
        if length > SHORTEST_BONE * longest:
            below = np.array([length, TIP * longest]) + limbs[joint]  # limb below each end, metres
            start_radius, end_radius = THICK * np.sqrt(longest * below)
            parent = int(skeleton.parents[joint])
            start = _end(np.zeros(3), start_radius)
            end = _end(skeleton.offsets[joint], end_radius)
            pieces[joint] = [parent, *start, *end, 1, SIDES.get(side_of[parent], 0)]
    return pieces
