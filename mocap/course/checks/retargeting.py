"""Random input and answers, right and wrong, for `13-retargeting.toml`."""

from functools import reduce

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.rotations import from_rotvec, inverse, multiply


def scaled_way(hips: Array, ratio: float, heights: tuple[float, float], centre: Array) -> Array:
    """Scale a way about a centre (x, z), and heights from one standing height to another."""
    scaled = np.array(hips)
    scaled[:, [0, 2]] = centre + ratio * (hips[:, [0, 2]] - centre)
    scaled[:, 1] = heights[1] + ratio * (hips[:, 1] - heights[0])
    return scaled


def product(*quaternions: Array) -> Array:
    return reduce(multiply, quaternions)
