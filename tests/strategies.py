"""Random inputs for the property tests."""

import numpy as np
from hypothesis import strategies as st

from mocap.body import Motion, PlanarTransform, Skeleton, rotations

seeds = st.integers(0, 2**32 - 1)

planar = st.builds(PlanarTransform, st.floats(-3.1, 3.1), st.floats(-50, 50), st.floats(-50, 50))

# Where transitions leave and enter two clips of 70 frames or more, with windows of 8.
ends = st.lists(st.tuples(*[st.integers(0, 1), st.integers(0, 62)] * 2), max_size=9)


def random_skeleton(random: np.random.Generator, joints: int) -> Skeleton:
    parents = [-1, *(random.integers(0, j) for j in range(1, joints))]
    offsets = random.normal(size=(joints, 3)) * 0.3
    offsets[0] = 0
    return Skeleton([f"joint{j}" for j in range(joints)], parents, offsets)


def random_quaternions(random: np.random.Generator, *shape: int) -> np.ndarray:
    return rotations.from_rotvec(random.normal(size=(*shape, 3)))


def random_motion(seed: int, frames: int = 5, joints: int = 6, *, skeleton: Skeleton | None = None) -> Motion:
    """Return a motion without sense: any skeleton, any pose, never twice the same."""
    random = np.random.default_rng(seed)
    skeleton = skeleton or random_skeleton(random, joints)
    return Motion(
        skeleton,
        np.array([0, 1, 0]) + random.normal(size=(frames, 3)),
        random_quaternions(random, frames, len(skeleton)),
        30.0,
        f"random{seed}",
        contacts={skeleton.names[-1]: random.random(frames) < 0.5},
    )


def glide(path: np.ndarray) -> Motion:
    """Move a dot along a line at 30 Hz, to these metres."""
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    return Motion(dot, path[:, None] * [1.0, 0, 0], np.tile(rotations.IDENTITY, (len(path), 1, 1)), 30.0)


def wave(frames: int, *, period: float = 40, phase: float = 0.0, name: str = "wave", seed: int = 0) -> Motion:
    """Return a swinging two-bone arm that glides along z: smooth, periodic, and so full of transitions."""
    arm = Skeleton(
        ["root", "elbow", "hand", "side"],
        [-1, 0, 1, 0],
        [[0, 0, 0], [0, 0.4, 0], [0.3, 0.2, 0], [0.2, 0, 0.1]],
    )
    t = 2 * np.pi * np.arange(frames) / period + phase
    noise = np.random.default_rng(seed).normal(size=(frames, 3)).cumsum(0) * 2e-4
    turns = np.zeros((frames, 4, 3))
    turns[:, 0, 1] = 0.3 * np.sin(t)
    turns[:, 1, 0] = 0.6 * np.sin(t)
    turns[:, 1, 2] = 0.4 * np.cos(t)
    roots = np.stack([0.05 * np.cos(t), 1 + 0.02 * np.sin(2 * t), np.arange(frames) * 0.02], 1) + noise
    return Motion(arm, roots, rotations.from_rotvec(turns), 30.0, name, contacts={"hand": np.sin(t) > 0})
