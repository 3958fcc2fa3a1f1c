"""A simple body to look at: each bone is a capsule, a cylinder with round ends, fixed to its joint.

The thickness is our own rule: a bone is the thicker the further the limb goes on behind it, as a thigh is
thicker than a shank, and a shank than a toe. So a body of any size and with any number of fingers looks like
one, without a table of names; only a head is known by its name.
"""

import re
from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap.body import rotations
from mocap.body.skeleton import Skeleton

AROUND = 10  # corners of a ring
RINGS = (-90, -50, -15, 15, 50, 90)  # degrees from the middle of a ball up to its poles
LEAST = 1e-4  # of the longest limb: a shorter bone gets no capsule
THICK = 0.06  # of the geometric mean of the longest limb and of what is left of it behind a joint
HEAD = 0.075  # of the longest limb: the radius of a head


Piece = tuple[
    int, Array, Array, float
]  # a joint; where a capsule starts, its length and direction, its radius


def reaches(skeleton: Skeleton) -> Array:
    """Give how far the limbs go on behind each joint, along the bones, (J,), metres.

    Examples
    --------
    >>> leg = Skeleton(["hip", "knee", "ankle"], [-1, 0, 1], [[0, 0, 0], [0, -0.4, 0], [0, -0.5, 0]])
    >>> reaches(leg)
    array([0.9, 0.5, 0. ])
    """
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    behind = np.zeros(len(skeleton))
    for joint in range(len(skeleton) - 1, 0, -1):
        parent = skeleton.parents[joint]
        behind[parent] = max(behind[parent], lengths[joint] + behind[joint])
    return behind


def body(skeleton: Skeleton) -> tuple[Array, Array, Indices, Indices]:
    """Put a capsule around each bone of a skeleton at rest.

    Parameters
    ----------
    skeleton : J joints.

    Returns
    -------
    A skinned surface: places and normals (V, 3), the joints (V,) that carry them, those at which their bones
    start, and the corners (T, 3) of its triangles. A skeleton without a bone gets one small ball.

    Examples
    --------
    >>> places, *_ = body(Skeleton(["hip", "knee"], [-1, 0], [[0, 0, 0], [0, -0.4, 0]]))
    >>> places.min(axis=0).round(2)
    array([-0.02, -0.42, -0.02])
    """
    longest = reaches(skeleton)[0] or 1.0
    pieces = list(_pieces(skeleton, longest)) or [(0, np.zeros(3), np.zeros(3), THICK * longest)]
    capsules = [_capsule(start, bone, radius) for _, start, bone, radius in pieces]
    places, normals = np.swapaxes(capsules, 0, 1)  # (P, V / P, 3) each
    count = places.shape[1]
    corner = np.arange(count).reshape(len(RINGS), AROUND)
    below, above = corner[:-1], corner[1:]
    beside, over = np.roll(below, -1, axis=1), np.roll(above, -1, axis=1)
    lower, upper = np.stack([below, beside, over], axis=-1), np.stack([below, over, above], axis=-1)
    corners = np.concatenate([lower[1:], upper[:-1]]).reshape(-1, 3)  # at a pole a ring is one point
    corners = corners + count * np.arange(len(pieces))[:, None, None]
    joints = np.repeat([joint for joint, *_ in pieces], count)
    return places.reshape(-1, 3), normals.reshape(-1, 3), joints, corners.reshape(-1, 3)


def _pieces(skeleton: Skeleton, longest: float) -> Iterator[Piece]:
    """Give a capsule for each bone; around one that starts at a head, it is a ball rather than a limb.

    A head from which no bone starts gets a ball further along the bone that leads to it.
    """
    behind, places, ball = reaches(skeleton), skeleton.rest, HEAD * longest
    heads = [re.search("head(?!.*(end|top|nub|site))", name.lower()) for name in skeleton.names]
    for joint, (parent, bone) in enumerate(zip(skeleton.parents.tolist(), skeleton.offsets, strict=True)):
        length = np.linalg.norm(bone) if joint else 0.0
        if length > 0 and heads[joint] and not skeleton.children(joint):
            yield joint, places[joint] + 0.7 * ball / length * bone, np.zeros(3), ball
        if length > LEAST * longest:
            start, radius = places[parent], THICK * np.sqrt(longest * (length + behind[joint]))
            if heads[parent]:
                start, bone, radius = start + 0.4 * bone, 0.2 * bone, max(radius, ball)
            yield parent, start, bone, radius


def _capsule(start: Array, bone: Array, radius: float) -> tuple[Array, Array]:
    """Build rings from pole to pole; the upper half of the ball that they make is moved along the bone."""
    if bone[1] < 0:  # the same capsule from its other end: no turn from up to down is the shortest
        start, bone = start + bone, -bone
    length = float(np.linalg.norm(bone))
    turn = rotations.between([0.0, 1.0, 0.0], bone / length) if length else rotations.IDENTITY
    around, up = np.meshgrid(2 * np.pi * np.arange(AROUND) / AROUND, np.radians(RINGS))
    ball = np.stack([np.cos(up) * np.sin(around), np.sin(up), np.cos(up) * np.cos(around)], axis=-1)
    moved = radius * ball + length * (up > 0)[..., None] * [0.0, 1.0, 0.0]
    return start + rotations.rotate(turn, moved.reshape(-1, 3)), rotations.rotate(turn, ball.reshape(-1, 3))
