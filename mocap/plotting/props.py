"""Things around a body, as polygons: discs on the ground, and boxes such as a stone, a step or a table."""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array

# The corners of a face, in order: whether the coordinate along each axis of the face is the larger one.
IS_LARGER_FIRST = [0, 1, 1, 0]
IS_LARGER_SECOND = [0, 0, 1, 1]


def rims(discs: ArrayLike) -> Array:
    """Compute points on the rims of discs on the ground, shape (N, 48, 3).

    Parameters
    ----------
    discs : shape (N, 3), x, z and radius in metres.

    Examples
    --------
    >>> rims([[3, 4, 1]])[0, ::12].round(6).tolist()
    [[3.0, 0.0, 5.0], [4.0, 0.0, 4.0], [3.0, 0.0, 3.0], [2.0, 0.0, 4.0]]
    """
    x, z, radius = np.reshape(np.asarray(discs, float), (-1, 3)).T[..., None]
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rim_x = x + radius * np.sin(angle)
    rim_z = z + radius * np.cos(angle)
    return np.stack([rim_x, np.zeros_like(rim_x), rim_z], axis=-1)


def diamonds(marks: ArrayLike, yaw: float = 0.0) -> Array:
    """Compute the corners of diamonds on the ground, shape (N, 4, 3).

    Parameters
    ----------
    marks : shape (N, 3), x and z of the middle, and the distance to a corner, metres.
    yaw : the direction from which they are upright, radians about +y, where 0 looks towards -z.

    Examples
    --------
    >>> diamonds([[3, 4, 1]])[0].round(6).tolist()
    [[4.0, 0.0, 4.0], [3.0, 0.0, 3.0], [2.0, 0.0, 4.0], [3.0, 0.0, 5.0]]
    """
    x, z, radius = np.reshape(np.asarray(marks, float), (-1, 3)).T[..., None]
    angle = yaw + np.pi / 2 * np.arange(4)
    corner_x = x + radius * np.cos(angle)
    corner_z = z - radius * np.sin(angle)
    return np.stack([corner_x, np.zeros_like(corner_x), corner_z], axis=-1)


def boxes_with(boxes: ArrayLike, moved: ArrayLike) -> Array:
    """Return boxes at each translation of the bodies that use them, the lowest and the highest corners.

    Parameters
    ----------
    boxes : shape (N, 6), x, y and z of the lowest corner, and of the highest one, metres.
    moved : translations, shape (3,) or (M, 3), metres. Equal ones count once.

    Returns
    -------
    The corners, shape (K, 2, 3), metres.

    Examples
    --------
    >>> boxes_with([[0, 0, 0, 1, 0.2, 1]], [[0, 0, 0], [2, 0, 0], [0, 0, 0]]).tolist()
    [[[0.0, 0.0, 0.0], [1.0, 0.2, 1.0]], [[2.0, 0.0, 0.0], [3.0, 0.2, 1.0]]]
    """
    ends = np.reshape(np.asarray(boxes, float), (-1, 2, 3))
    shifts = np.unique(np.reshape(np.asarray(moved, float), (-1, 3)), axis=0)
    return np.asarray((shifts[:, None, None] + ends).reshape(-1, 2, 3))


def box_faces(boxes: ArrayLike, eye: ArrayLike) -> list[tuple[int, Array]]:
    """List the faces of boxes that an eye sees, the boxes from the farthest to the nearest.

    Parameters
    ----------
    boxes : shape (N, 6) or (N, 2, 3), x, y and z of the lowest corner, and of the highest one, metres.
    eye : the position of the eye, shape (3,), metres.

    Returns
    -------
    For each face the axis to which it is perpendicular, and its corners, shape (4, 3).

    Examples
    --------
    >>> seen = box_faces([[0, 0, 0, 1, 0.2, 1]], eye=[0.5, 5, 3])
    >>> [axis for axis, _ in seen]
    [1, 2]
    >>> seen[0][1][:, 1].tolist()  # the face on top
    [0.2, 0.2, 0.2, 0.2]
    """
    viewpoint = np.asarray(eye, float)
    ends = np.reshape(np.asarray(boxes, float), (-1, 2, 3))
    distances = np.linalg.norm(ends.mean(axis=1) - viewpoint, axis=-1)
    faces = []
    for low, high in ends[np.argsort(-distances)]:
        for axis in range(3):
            if low[axis] <= viewpoint[axis] <= high[axis]:
                continue
            first_axis = (axis + 1) % 3
            second_axis = (axis + 2) % 3
            corners = np.empty((4, 3))
            corners[:, axis] = high[axis] if viewpoint[axis] > high[axis] else low[axis]
            corners[:, first_axis] = np.where(IS_LARGER_FIRST, high[first_axis], low[first_axis])
            corners[:, second_axis] = np.where(IS_LARGER_SECOND, high[second_axis], low[second_axis])
            faces.append((axis, corners))
    return faces
