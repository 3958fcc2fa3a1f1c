"""Vectors and rotations in plain numbers: for a few of them, arrays take ten times as long.

Vectors are tuples (x, y, z), and rotations are unit quaternions (w, x, y, z).
"""

from __future__ import annotations

import math

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

UP: Vector = (0.0, 1.0, 0.0)


def add(first: Vector, second: Vector) -> Vector:
    """Return the sum of two vectors.

    Examples
    --------
    >>> add((1.0, 2.0, 3.0), (1.0, 0.0, 0.0))
    (2.0, 2.0, 3.0)
    """
    x, y, z = first
    a, b, c = second
    return x + a, y + b, z + c


def subtract(first: Vector, second: Vector) -> Vector:
    """Return the difference of two vectors.

    Examples
    --------
    >>> subtract((1.0, 2.0, 3.0), (1.0, 0.0, 0.0))
    (0.0, 2.0, 3.0)
    """
    x, y, z = first
    a, b, c = second
    return x - a, y - b, z - c


def dot(first: Vector, second: Vector) -> float:
    """Return the scalar product of two vectors.

    Examples
    --------
    >>> dot((1.0, 2.0, 3.0), (1.0, 0.0, 1.0))
    4.0
    """
    x, y, z = first
    a, b, c = second
    return x * a + y * b + z * c


def cross(first: Vector, second: Vector) -> Vector:
    """Return the vector product of two vectors.

    Examples
    --------
    >>> cross((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    (0.0, 0.0, 1.0)
    """
    x, y, z = first
    a, b, c = second
    i = y * c - z * b
    j = z * a - x * c
    k = x * b - y * a
    return i, j, k


def multiply(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the product of two quaternions: the rotation by `second`, then by `first`.

    Examples
    --------
    >>> multiply((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    (0.0, 0.0, 0.0, 1.0)
    """
    w, x, y, z = first
    a, b, c, d = second
    real = w * a - x * b - y * c - z * d
    i = w * b + x * a + y * d - z * c
    j = w * c - x * d + y * a + z * b
    k = w * d + x * c - y * b + z * a
    return real, i, j, k


def conjugate(quaternion: Quaternion) -> Quaternion:
    """Return the inverse of a unit quaternion.

    Examples
    --------
    >>> conjugate((0.5, 0.5, 0.5, -0.5))
    (0.5, -0.5, -0.5, 0.5)
    """
    w, x, y, z = quaternion
    return w, -x, -y, -z


def rotate(quaternion: Quaternion, vector: Vector) -> Vector:
    """Rotate a vector: v + w t + u × t with t = 2 u × v, for the quaternion (w, u).

    Examples
    --------
    >>> rotate((0.0, 0.0, 1.0, 0.0), (1.0, 2.0, 3.0))
    (-1.0, 2.0, -3.0)
    """
    w, x, y, z = quaternion
    a, b, c = vector
    i = 2 * (y * c - z * b)
    j = 2 * (z * a - x * c)
    k = 2 * (x * b - y * a)
    new_a = a + w * i + y * k - z * j
    new_b = b + w * j + z * i - x * k
    new_c = c + w * k + x * j - y * i
    return new_a, new_b, new_c


def axis_rotation(axis: Vector, angle: float) -> Quaternion:
    """Return the rotation about a unit axis by an angle in radians.

    Examples
    --------
    >>> axis_rotation((0.0, 1.0, 0.0), math.pi)[2]
    1.0
    """
    x, y, z = axis
    sine = math.sin(angle / 2)
    return math.cos(angle / 2), sine * x, sine * y, sine * z


def shortest_arc(start: Vector, end: Vector) -> Quaternion:
    """Return the smallest rotation from one direction to another, which are not opposite.

    The quaternion (|a||b| + a·b, a × b), normalised, because half of its angle is that between a and a + b.

    Examples
    --------
    >>> [round(number, 3) for number in shortest_arc((0.0, 0.0, 2.0), (3.0, 0.0, 0.0))]
    [0.707, 0.0, 0.707, 0.0]
    """
    w = math.sqrt(dot(start, start) * dot(end, end)) + dot(start, end)
    x, y, z = cross(start, end)
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    return w / norm, x / norm, y / norm, z / norm


def length(vector: Vector) -> float:
    """Return the length of a vector.

    Examples
    --------
    >>> length((3.0, 0.0, 4.0))
    5.0
    """
    return math.sqrt(dot(vector, vector))
