"""The metrics side by side, each against its formula."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from mocap.body import Motion, Skeleton, euler, rotations
from mocap.errors import SkeletonMismatch
from mocap.matching.distance_grids import distance_grid
from mocap.matching.other_metrics import HOMEWORK_WEIGHTS, euler_grid, file_angles, root_grid
from tests.refusals import refused
from tests.strategies import random_motion, random_quaternions, seeds, wave

DOFS = ["xyz", "xyz", "zx", "y", "zyx", ""]


def body_motion(seed, frames=6):
    """Random angles of joints with axes and dofs of their own; and these angles in degrees."""
    random = np.random.default_rng(seed)
    names = ["root", "lowerback", "lfemur", "ltibia", "rhumerus", "rhumerus_end"]
    axes = random_quaternions(random, 6)
    axes[0] = rotations.IDENTITY
    skeleton = Skeleton(names, np.arange(-1, 5), random.normal(size=(6, 3)), axes, DOFS)
    turns = np.tile(rotations.IDENTITY, (frames, 6, 1))
    angles = {}
    for joint, dofs in enumerate(DOFS):
        if dofs:
            limit = [180, 90, 180] if len(dofs) == 3 else [90, 90] if len(dofs) == 2 else [180]
            angles[joint] = random.uniform(-1, 1, (frames, len(dofs))) * limit
            own = euler.from_euler(dofs, np.radians(angles[joint]))
            turned = rotations.multiply(axes[joint], own)
            turns[:, joint] = rotations.multiply(turned, rotations.inverse(axes[joint]))
    return Motion(skeleton, random.normal(size=(frames, 3)), turns, 30.0, f"body{seed}"), angles


ALL = [root_grid, euler_grid, distance_grid]


@pytest.mark.parametrize("metric", ALL)
def test_all_metrics_have_one_interface(metric):
    (a, _), (b, _) = body_motion(0, 9), body_motion(0, 7)
    grid = metric(a, b, window=3)
    assert grid.shape == (7, 5)
    assert grid.min() >= 0
    assert metric(b, a, window=3) == pytest.approx(grid.T)
    assert metric(a, a, window=3).diagonal() == pytest.approx(0, abs=1e-5)
    for window, message in ((8, "'body0' has 7 frames, too few for a window of 8"), (0, "got 0")):
        refused(message, metric, a, b, window=window)
    refused("elbow", metric, a, wave(9), window=2, kind=SkeletonMismatch)


def test_root_grid_adds_metres_and_radians():
    a = random_motion(0, frames=6)
    b = replace(random_motion(1, frames=4, skeleton=a.skeleton), name="b")
    grid = root_grid(a, b, window=2)
    for i, j in np.ndindex(*grid.shape):
        steps = [
            np.linalg.norm(a.root_positions[i + f] - b.root_positions[j + f])
            + rotations.angle_between(a.rotations[i + f, 0], b.rotations[j + f, 0])
            for f in range(2)
        ]
        assert grid[i, j] == pytest.approx(np.mean(steps))
    assert root_grid(a, replace(b, rotations=-b.rotations), window=2) == pytest.approx(grid)


@given(seeds)
def test_the_files_own_angles_come_back(seed):
    motion, angles = body_motion(seed)
    for joint, told in angles.items():
        gap = file_angles(motion, joint) - told
        assert (gap + 180) % 360 - 180 == pytest.approx(0, abs=1e-4)


def test_the_euler_grid_adds_wrapped_differences_bone_by_bone():
    (a, angles), (b, others) = body_motion(0, 6), body_motion(0, 6)
    b, others = replace(a, rotations=a.rotations[::-1]), {j: v[::-1] for j, v in angles.items()}
    grid = euler_grid(a, b, window=2)
    for i, j in np.ndindex(*grid.shape):
        total = 0.0
        for f in range(2):
            for joint in (1, 2, 3, 4):
                gap = (angles[joint][i + f] - others[joint][j + f] + 180) % 360 - 180
                total += HOMEWORK_WEIGHTS[a.skeleton.names[joint]] * np.linalg.norm(gap)
        assert grid[i, j] == pytest.approx(total)


def test_a_body_without_the_homeworks_bones_is_refused():
    refused("no bone with a weight: lowerback", euler_grid, wave(9), wave(9), window=2)
