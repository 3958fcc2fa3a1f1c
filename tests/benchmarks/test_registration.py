"""How fast registration is, as ratios within one run, on a machine that does nothing else meanwhile.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_registration.py
"""

import numpy as np
import pytest

from mocap.blending import mix, register
from mocap.datasets import sample
from mocap.matching.distance_grids import distance_grid
from mocap.matching.point_clouds import point_cloud
from mocap.matching.time_paths import time_path
from tests.benchmarks.timing import fastest
from tests.blending.registered import walks

pytestmark = pytest.mark.benchmark
THIRDS = np.full(3, 1 / 3)


def clouds(frames):
    return [point_cloud(sample(name)[: 4 * frames : 4]) for name in ("walk_circle", "walk_curve_1")]


@pytest.mark.parametrize("frames", [118, 471])
def test_a_time_path_takes_at_most_one_and_a_half_of_its_grid(frames):
    ours, theirs = clouds(frames)
    grid = np.sqrt(distance_grid(ours, theirs, window=5))
    whole, path, free = fastest(
        lambda: distance_grid(ours, theirs, window=5),
        lambda: time_path(grid),
        lambda: time_path(grid, slack=36),
        turns=9,
    )
    print(f"\n{frames} frames: grid {1000 * whole:.1f} ms, path {path / whole:.2f} grids, ", end="")
    print(f"with free ends {free / whole:.2f}; {1e9 * path / grid.size:.0f} ns for each cell")
    assert path <= 1.5 * whole


def scalar_sums(grid, slope):
    """The same sums cell by cell."""
    rows, columns = grid.shape
    best = np.full((rows, columns, 2 * slope + 1), np.inf)
    best[0, 0, 0] = 2 * grid[0, 0]
    for i in range(rows):
        for j in range(columns):
            cost = grid[i, j]
            if i and j:
                best[i, j, 0] = 2 * cost + best[i - 1, j - 1].min()
            if i:
                best[i, j, 1] = cost + best[i - 1, j, 0]
                best[i, j, 2 : slope + 1] = cost + best[i - 1, j, 1:slope]
            if j:
                best[i, j, slope + 1] = cost + best[i, j - 1, 0]
                best[i, j, slope + 2 :] = cost + best[i, j - 1, slope + 1 : -1]
    return best


def test_row_by_row_is_at_least_fifteen_times_as_fast_as_cell_by_cell():
    ours, theirs = clouds(118)
    grid = np.sqrt(distance_grid(ours, theirs, window=5))
    rows, cells = fastest(lambda: time_path(grid), lambda: scalar_sums(grid, 2), turns=3)
    print(f"\ncell by cell takes {cells / rows:.0f} times as long as row by row")
    assert cells >= 15 * rows


def test_registering_and_blending_take_few_forward_kinematics():
    clips = [walks()[speed, 0] for speed in (0.8, 1.1, 1.4)]
    registration = register(clips)
    kinematics, registering, blending, summing = fastest(
        lambda: [point_cloud(clip) for clip in clips],
        lambda: register(clips),
        lambda: mix(registration, THIRDS),
        lambda: mix(registration, THIRDS, rounds=0),
        turns=7,
    )
    print(f"\nregister {registering / kinematics:.1f}, mix {blending / kinematics:.1f}, ", end="")
    print(f"by bare sums {summing / kinematics:.1f} times the clips' forward kinematics")
    assert registering <= 10 * kinematics
    assert blending <= 10 * kinematics
