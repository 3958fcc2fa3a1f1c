"""Random input and answers, right and wrong, for `01b-motion-files.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body import euler, rotations


def acclaim(axis: Array, angles: Array) -> Array:
    c, m = (euler.from_euler("xyz", np.radians(turns)) for turns in (axis, angles))
    return rotations.multiply(rotations.multiply(c, m), rotations.inverse(c))


def draw_acclaim_turn(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw the angles of two turns: mostly different ones, sometimes the same, opposite, or none."""
    axis, angles = rng.uniform(-80, 80, (2, 3)).round(1)
    special = [axis, -axis, np.zeros(3)]
    return axis, np.array([*special, *[angles] * 12][rng.integers(15)])


def draw_strikes(rng: np.random.Generator) -> tuple[Mask]:
    """Draw runs of standing and swinging; half of them begin with standing."""
    runs = rng.integers(1, 12, rng.integers(3, 9))
    return (np.repeat((np.arange(len(runs)) + rng.integers(2)) % 2, runs).astype(bool),)


def strikes(contact: Mask) -> Indices:
    return np.flatnonzero(contact[1:] & ~contact[:-1]) + 1
