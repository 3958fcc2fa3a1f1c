"""A body surface for viewers: each bone is a rigid capsule, a cylinder with hemispherical ends.

The radius is a rule of our own: it grows with the length of the limb below a bone, as a thigh is thicker than
a shank, and a shank than a toe. The rule needs no joint names, and works for bodies of any size and with any
number of fingers. Only heads are identified by their names.
"""

import re
from collections.abc import Iterator

import numpy as np

from mocap._shared.arrays import Array, Indices
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.skeleton import Skeleton, reaches

AROUND = 10  # vertices of a ring
RINGS = (-90, -50, -15, 15, 50, 90)  # degrees: the latitudes of the rings of a ball
LEAST = 1e-4  # fraction of the longest limb: a shorter bone gets no capsule
THICK = 0.06  # radius, fraction of √(longest limb · limb from the start of the bone)
HEAD = 0.075  # radius of a head, fraction of the longest limb
HEAD_DISTANCE = 0.7  # from the joint of a head to its centre, fraction of that radius, if it is a leaf
SKULL = 0.2  # length of the capsule of a bone that starts at a head, fraction of the bone
SKULL_START = 0.4  # start of this capsule, fraction of the bone


class Capsule(NamedTuple):
    """A capsule, in metres: its joint, the start and the vector of its axis, and its radius."""

    joint: int
    start: Array
    vector: Array
    radius: float


def body(skeleton: Skeleton) -> tuple[Array, Array, Indices, Indices]:
    """Build a surface of capsules around the bones of a skeleton in its rest pose.

    Parameters
    ----------
    skeleton : J joints.

    Returns
    -------
    A skinned surface: positions (V, 3), metres, normals (V, 3), the joints (V,) that influence the vertices,
    and the vertex indices (T, 3) of its triangles. A vertex is influenced by the joint at which its bone
    starts. A skeleton without bones gets a small ball.

    Examples
    --------
    >>> positions, *_ = body(Skeleton(["hip", "knee"], [-1, 0], [[0, 0, 0], [0, -0.4, 0]]))
    >>> positions.min(axis=0).round(2)
    array([-0.02, -0.42, -0.02])
    """
    longest = reaches(skeleton)[0] or 1.0
    capsules = list(_capsules(skeleton, longest))
    if not capsules:
        capsules = [Capsule(0, np.zeros(3), np.zeros(3), THICK * longest)]
    surfaces = [_surface(capsule) for capsule in capsules]
    positions, normals = np.swapaxes(surfaces, 0, 1)  # (C, V / C, 3) each
    count = positions.shape[1]
    joints = np.repeat([capsule.joint for capsule in capsules], count)
    first_vertices = count * np.arange(len(capsules))
    corners = _triangles() + first_vertices[:, None, None]
    return positions.reshape(-1, 3), normals.reshape(-1, 3), joints, corners.reshape(-1, 3)


def _capsules(skeleton: Skeleton, longest: float) -> Iterator[Capsule]:
    """Yield a capsule for each bone. That of a bone that starts at a head is nearly a ball.

    A head from which no bone starts gets a ball, on the extension of the bone that leads to it.
    """
    limbs = reaches(skeleton)
    head_radius = HEAD * longest
    is_head = [_is_head(name) for name in skeleton.names]
    if not any(is_head) and "head" in skeleton.roles:
        is_head[skeleton.index(skeleton.roles["head"])] = True
    for joint in range(1, len(skeleton)):
        parent = int(skeleton.parents[joint])
        bone = skeleton.offsets[joint]
        length = np.linalg.norm(bone)
        if length > 0 and is_head[joint] and not skeleton.children(joint):
            centre = skeleton.rest[joint] + HEAD_DISTANCE * head_radius / length * bone
            yield Capsule(joint, centre, np.zeros(3), head_radius)
        if length > LEAST * longest:
            start = skeleton.rest[parent]
            radius = THICK * np.sqrt(longest * (length + limbs[joint]))
            if is_head[parent]:
                yield Capsule(parent, start + SKULL_START * bone, SKULL * bone, max(radius, head_radius))
            else:
                yield Capsule(parent, start, bone, radius)


def _is_head(name: str) -> bool:
    """Return whether a joint is a head, by its name; `Head_end` and similar names are not."""
    return re.search("head(?!.*(end|top|nub|site))", name.lower()) is not None


def _surface(capsule: Capsule) -> tuple[Array, Array]:
    """Compute the positions and the normals (V, 3) of the vertices of a capsule, ring by ring.

    The rings form a ball, whose upper half is translated along the bone.
    """
    start = capsule.start
    vector = capsule.vector
    if vector[1] < 0:  # start from the other end: the shortest rotation from up to down is not unique
        start = start + vector
        vector = -vector
    length = float(np.linalg.norm(vector))
    rotation = rotations.IDENTITY
    if length:
        rotation = rotations.between([0.0, 1.0, 0.0], vector / length)
    longitudes, latitudes = np.meshgrid(2 * np.pi * np.arange(AROUND) / AROUND, np.radians(RINGS))
    x = np.cos(latitudes) * np.sin(longitudes)
    z = np.cos(latitudes) * np.cos(longitudes)
    ball = np.stack([x, np.sin(latitudes), z], axis=-1)
    heights = np.where(latitudes > 0, length, 0.0)
    upright = capsule.radius * ball + heights[..., None] * [0.0, 1.0, 0.0]
    positions = start + rotations.rotate(rotation, upright.reshape(-1, 3))
    return positions, rotations.rotate(rotation, ball.reshape(-1, 3))


def _triangles() -> Indices:
    """Return the triangles of a capsule, (T, 3), as indices of its vertices.

    Each quadrilateral between two rings is divided into two triangles. At a pole, a ring is a point, and the
    quadrilateral is a triangle.
    """
    vertices = np.arange(len(RINGS) * AROUND).reshape(len(RINGS), AROUND)
    low = vertices[:-1]
    high = vertices[1:]
    low_neighbour = np.roll(low, -1, axis=1)
    high_neighbour = np.roll(high, -1, axis=1)
    based_below = np.stack([low, low_neighbour, high_neighbour], axis=-1)
    based_above = np.stack([low, high_neighbour, high], axis=-1)
    return np.concatenate([based_below[1:], based_above[:-1]]).reshape(-1, 3)
