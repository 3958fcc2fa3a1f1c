"""Random input and answers, right and wrong, for `11-warping.toml`."""

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.rotations import from_rotvec, inverse, multiply, to_rotvec


def draw_offset_curve(rng: np.random.Generator) -> tuple[Array, int, Array, Array]:
    """Draw a joint's rotations, a key, the pose asked for there (of either sign), and the shares."""
    q = from_rotvec(rng.normal(size=3) + rng.normal(scale=0.15, size=(20, 3)).cumsum(axis=0))
    key = int(rng.integers(5, 15))
    pose = multiply(q[key], from_rotvec(rng.normal(size=3))) * rng.choice([-1, 1])
    share = np.clip(1 - np.abs(np.arange(20) - key) / 6, 0, 1)
    return q, key, pose, share


def own(q: Array, key: int, pose: Array) -> Array:
    """Give the offset at the key, in the joint's own frame."""
    return to_rotvec(multiply(inverse(q[key]), pose))


def long_way(quaternion: Array) -> Array:
    """Give a rotation vector without taking the shorter of the two ways."""
    w, v = quaternion[0], quaternion[1:]
    return np.asarray(2 * np.arctan2(np.linalg.norm(v), w) * v / np.linalg.norm(v))


def draw_cardinal_slopes(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw keys at uneven times, and a tension."""
    count = int(rng.integers(3, 7))
    return rng.uniform(3, 30, count).cumsum(), rng.normal(size=count), float(rng.uniform(0.1, 0.9))


def cardinal(at: Array, values: Array, tension: float) -> Array:
    slopes = np.zeros(len(at))
    slopes[1:-1] = (1 - tension) * (values[2:] - values[:-2]) / (at[2:] - at[:-2])
    return slopes
