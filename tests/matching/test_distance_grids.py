"""The closed form against an optimiser, fast grids and paths in them against plain loops; other metrics."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from mocap.body import Motion, PlanarTransform, Skeleton, euler, rotations
from mocap.errors import SkeletonMismatch
from mocap.matching import align, distance_grids, local_minima
from mocap.matching.distance_grids import cloud_distances, distance_grid, tiled_distances
from mocap.matching.other_metrics import HOMEWORK_WEIGHTS, METRICS, euler_grid, file_angles, root_grid
from mocap.matching.point_clouds import distinct_joints, rms_distance, unit_weights
from mocap.matching.prepared_clouds import cloud
from mocap.matching.time_paths import origins, path_mean, path_sums, time_path, trace
from tests.oracles import distance_oracle, least_sum, longest_run, path_sum, squared_distance
from tests.refusals import refusals, refused
from tests.strategies import planar, random_motion, random_quaternions, seeds, wave
from tests.tuning import tune


def sizes(points, window):
    """S of every window as the docstring of `distance_grid` defines it, above heights of 0."""
    windows = np.stack([points[i : i + window].reshape(-1, 3) for i in range(len(points) - window + 1)])
    ground = windows[..., [0, 2]] - windows[..., [0, 2]].mean(1, keepdims=True)
    return (windows[..., 1] ** 2 + (ground**2).sum(-1)).mean(1)


def random_points(seed, frames, points=6, reach=1.0):
    return np.random.default_rng(seed).normal(size=(frames, points, 3)) * reach


@given(seeds, st.integers(1, 7), st.booleans(), st.booleans())
def test_the_grid_is_the_loop_over_windows(seed, window, weighted, tapered):
    """As in [KGP02, Eq. 1], with equal weights or any, of the points and of the frames in a window."""
    a, b, random = random_points(seed, 9), random_points(seed + 1, 7), np.random.default_rng(seed)
    weights = random.random(6) + np.eye(6)[0] if weighted else None
    taper = random.random(window) + np.eye(window)[0] if tapered else None
    grid = distance_grid(a, b, window=window, joint_weights=weights, taper=taper)
    expected = distance_oracle(a, b, window, weights, taper)
    assert grid == pytest.approx(expected, abs=1e-12)


def test_a_taper_of_one_frame_compares_that_frame():
    a, b = random_points(0, 9), random_points(1, 7)
    last = distance_grid(a, b, window=3, taper=[0, 0, 1])
    assert last == pytest.approx(distance_grid(a[2:], b[2:], window=1), abs=1e-12)
    equal = distance_grid(a, b, window=3, taper=[7, 7, 7])
    assert equal == pytest.approx(distance_grid(a, b, window=3), abs=1e-15)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_any_number_of_threads_gives_the_same_grid_bit_for_bit(dtype, monkeypatch):
    tune(monkeypatch, distance_grids, small_grid=0)
    tune(monkeypatch, distance_grids, tile=(16, 24))
    a, b = random_points(0, 90).astype(dtype), random_points(1, 70).astype(dtype)
    for others in (a, b):
        alone, default, several = (distance_grid(a, others, window=3, jobs=jobs) for jobs in (1, None, 5))
        assert np.array_equal(alone, default) and np.array_equal(alone, several)


@given(seeds, st.integers(1, 12), st.sampled_from([0.0, 1.0, 100.0, 3e4]), planar)
def test_the_error_bound_holds_wherever_a_clip_is(seed, window, away, transform):
    """`away` metres from the origin, and walking on from there."""
    random = np.random.default_rng(seed)
    way = np.cumsum(random.normal(size=(30, 1, 3)) * [0.05, 0.0, 0.05], axis=0)
    a = random_points(seed, 30, reach=0.3) + way + [away, 0, -away]
    b = transform.apply_points(random_points(seed + 1, 25, reach=0.3) + way[5:])
    b[3:20] = transform.apply_points(a[3:20] - [away, 0, -away])  # some windows are nearly or quite alike
    truth = distance_oracle(a, b, window)
    size = sizes(a, window)[:, None] + sizes(b, window)
    a32, b32 = a.astype(np.float32), b.astype(np.float32)
    truth32 = distance_oracle(a32.astype(float), b32.astype(float), window)
    digits = 1e-15 * max(np.abs(a).max(), np.abs(b).max())  # metres that the points themselves are off
    assert np.all(np.abs(distance_grid(a, b, window=window) - truth) <= 1e-14 * size + digits * size**0.5)
    single = distance_grid(a32, b32, window=window)
    assert single.dtype == np.float32
    assert np.all(np.abs(single - truth32) <= 4e-6 * size)


@given(seeds, planar)
def test_a_clip_is_at_no_distance_from_itself_moved_anywhere(seed, transform):
    """As in [KGP02, 3.1]; a window tells forwards from backwards, which a frame does not."""
    points, motion = random_points(seed, 9), random_motion(seed)
    one, three = (distance_grid(points, points[::-1], window=window)[::-1] for window in (1, 3))
    assert one.diagonal() == pytest.approx(0, abs=1e-12) and three.min() > 1e-4
    grid = distance_grid(motion, transform.apply_motion(motion), window=3)
    assert not grid.diagonal().any()  # what would be rounding is 0
    assert grid == pytest.approx(grid.T, abs=1e-9)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("frames", [30, 700])
def test_the_grid_of_a_clip_and_itself_is_exactly_symmetric(dtype, frames):
    points = random_points(3, frames, points=2).astype(dtype)
    grid = distance_grid(points, points.copy(), window=10)
    assert grid.dtype == dtype
    assert np.array_equal(grid, grid.T)
    assert grid.min() >= 0
    assert grid.diagonal().max() <= 8e-6 * 6 * np.finfo(dtype).eps / np.finfo(np.float32).eps
    # Whatever one half is a copy of, it is the grid.
    longer = np.concatenate([points, points[:1]])
    assert np.abs(grid - distance_grid(points, longer, window=10)[:, : len(grid)]).max() < 1e-5


@given(st.integers(1, 40), st.integers(1, 40), st.booleans())
def test_tiles_cover_a_grid_once(rows, columns, upper):
    a, b = (
        cloud(random_points(n, n), np.zeros(6), np.full(6, 1 / 6), 1, np.float64) for n in (rows, columns)
    )
    worked = []

    def kept(*parts, **options):
        worked.append(cloud_distances(*parts, **options))
        return worked[-1]

    with pytest.MonkeyPatch.context() as patch:
        tune(patch, distance_grids, tile=(7, 11))
        patch.setattr(distance_grids, "cloud_distances", kept)
        grid = tiled_distances(a, b, upper=upper)
    seen = np.isfinite(grid)
    assert sum(tile.size for tile in worked) == seen.sum()
    assert grid[seen] == pytest.approx(cloud_distances(a, b)[seen], abs=1e-12)
    assert np.all(seen[np.triu_indices(rows, 0, columns)])
    assert upper or seen.all()


POINTS = np.ones((5, 2, 3))


def against(points, **settings):
    return distance_grid(POINTS, points, **{"window": 2} | settings)


test_what_has_no_distance_is_refused = refusals(
    (SkeletonMismatch, "joints: elbow", lambda: distance_grid(wave(9), random_motion(0), window=2)),
    ("resample one first", lambda: distance_grid(wave(9), replace(wave(9), fps=60), window=2)),
    ("'wave' has 9 frames, too few .* of 10", lambda: distance_grid(wave(20), wave(9), window=10)),
    *((f"one frame, got {k}", lambda k=k: distance_grid(wave(9), wave(9), window=k)) for k in (0, 2.5)),
    ("2 and 3 points do not match", against, np.zeros((5, 3, 3))),
    (r"shape \(F, P, 3\), got \(5, 3\)", against, np.zeros((5, 3))),
    (r"got \(5, 0, 3\)", against, np.zeros((5, 0, 3))),
    ("has 0 frames", against, np.zeros((0, 2, 3))),
    (r"holds nan at \[0, 0, 0\]", against, np.full((5, 2, 3), np.nan)),
    ("holds 1e[+]30", against, np.full((5, 2, 3), 1e30)),
    *(
        ("must be 2 numbers, not negative and not all 0", lambda w=w: against(POINTS, joint_weights=w))
        for w in ([1, 1, 1], [1, -1], [0, 0], [1, np.nan])
    ),
    (r"two dimensions, got shape \(3,\)", local_minima, np.ones(3)),
    (r"NaN at \[2, 1\]", local_minima, np.array([[1.0, 2.0], [3.0, 4.0], [5.0, np.nan]])),
)


def minima_by_loops(grid, below):
    rows, columns = grid.shape
    found = []
    for i, j in np.ndindex(rows, columns):
        around = [(i + r, j + c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)]
        inside = [(r, c) for r, c in around if 0 <= r < rows and 0 <= c < columns]
        lower = all((grid[n], n) > (grid[i, j], (i, j)) for n in inside)
        if lower and grid[i, j] < below:
            found.append([i, j])
    return found


@given(seeds, st.integers(1, 7), st.integers(1, 7), st.sampled_from([1, 2, 2.5, np.inf]))
def test_minima_are_lower_than_all_neighbours_and_ties_go_to_the_first(seed, rows, columns, below):
    """As in [KGP02, 3.2]."""
    grid = np.random.default_rng(seed).integers(0, 5, (rows, columns))
    assert local_minima(grid, below).tolist() == minima_by_loops(grid, below)


def test_grids_without_minima():
    assert local_minima(np.full((3, 3), np.inf)).shape == (0, 2)
    for shape in ((0, 3), (3, 0), (0, 0)):
        assert local_minima(np.empty(shape)).shape == (0, 2)
    assert local_minima(np.ones((2, 2)), below=1).shape == (0, 2)


@settings(max_examples=8)
@given(seeds)
def test_no_optimiser_finds_a_better_alignment(seed):
    """As in [KGP02, Eqs. 2-4]."""
    random = np.random.default_rng(seed)
    points, others = random.normal(size=(2, 12, 3))
    weights = random.random(12)
    best = squared_distance(align(points, others, weights), points, others, weights)
    for start in np.linspace(-np.pi, np.pi, 4, endpoint=False):
        found = minimize(squared_distance, [start, 0, 0], args=(points, others, weights))
        assert best <= found.fun + 1e-6


test_clouds_and_weights_that_are_none_are_refused = refusals(
    (re.escape(f"got {[1.0] * 7 + [-1.0]}."), unit_weights, [1.0] * 7 + [-1.0], 8),
    (re.escape("got an array of shape (9,) from -1 to 1."), unit_weights, [1.0] * 8 + [-1.0], 9),
    (r"shapes \(4, 3\) and \(5, 3\) do not match", align, np.zeros((4, 3)), np.zeros((5, 3))),
    ("both need", align, np.zeros(3), np.zeros(3)),
    ("both need", align, np.zeros((4, 2)), np.zeros((4, 2))),
    (r"holds nan at \[0, 0\]", align, np.full((4, 3), np.nan), np.zeros((4, 3))),
    ("holds inf", align, np.zeros((4, 3)), np.full((4, 3), np.inf)),
    ("within 1e[+]06 m", align, np.zeros((4, 3)), np.full((4, 3), 1e200)),
)


def test_a_joint_that_is_its_parent_is_no_point_of_its_own():
    """Not the second joint's child either, and joints along each axis are."""
    offsets = [[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]]
    assert distinct_joints(Skeleton([*"abcdef"], [-1, 0, 1, 2, 2, 1], offsets)) == [0, 1, 3, 4, 5]


@pytest.mark.parametrize(("gap", "points"), [(4e-10, [0, 1]), (6e-10, [0, 1, 2])])
def test_joints_coincide_within_a_nanometre(gap, points):
    fork = Skeleton(["root", "l", "r"], [-1, 0, 0], [[0, 0, 0], [0, 1, 0], [0, 1, gap]])
    assert distinct_joints(fork) == points


def test_the_rms_distance_of_a_moved_motion_is_how_far_it_was_moved():
    motion = wave(10)
    assert rms_distance(motion, PlanarTransform(0.0, 3.0, 4.0).apply_motion(motion)) == pytest.approx(5)


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


@pytest.mark.parametrize("metric", METRICS.values(), ids=METRICS)
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


slopes = st.integers(1, 3)
sides = st.integers(2, 11)


def random_grid(seed, rows, columns):
    return np.random.default_rng(seed).random((rows, columns))


@given(seeds, sides, sides, slopes)
def test_no_path_has_a_lower_sum(seed, rows, columns, slope):
    """As in [KG03, time path]."""
    grid = random_grid(seed, rows, columns)
    best = least_sum(grid, slope)
    if not np.isfinite(best):
        refused(f"at most {slope + 1} to 1", time_path, grid, slope=slope)
        return
    path = time_path(grid, slope=slope)
    assert path_sum(grid, path) == pytest.approx(best, abs=1e-14)
    assert path[0].tolist() == [0, 0] and path[-1].tolist() == [rows - 1, columns - 1]
    assert set(map(tuple, np.diff(path, axis=0).tolist())) <= {(1, 1), (1, 0), (0, 1)}
    assert longest_run(path) <= slope


@given(seeds, st.integers(4, 8), st.integers(4, 8), slopes)
def test_free_ends_give_the_least_mean_of_all_ends(seed, rows, columns, slope):
    """As in [KG03, time path]."""
    grid, slack = random_grid(seed, rows, columns), 2
    begins = [(i, 0) for i in range(slack + 1)] + [(0, j) for j in range(1, slack + 1)]
    means = []
    for begin in begins:
        for end in [(rows - 1 - i, columns - 1 - j) for i, j in begins]:
            frames = end[0] - begin[0] + end[1] - begin[1] + 2
            means.append(least_sum(grid, slope, begin, end) / frames)
    if not np.isfinite(min(means)):
        return
    path = time_path(grid, slope=slope, slack=slack)
    assert path_mean(grid, path) == pytest.approx(min(means), abs=1e-12)
    assert longest_run(path) <= slope


@given(seeds, st.integers(2, 7), st.integers(2, 7), slopes)
def test_begun_anywhere_the_sums_are_those_of_a_local_alignment(seed, rows, columns, slope):
    costs = random_grid(seed, rows, columns) - 0.5
    sums = path_sums(costs, np.ones(costs.shape, bool), slope=slope)
    begins = origins(sums)
    for end in np.ndindex(rows, columns):
        best = min(least_sum(costs, slope, begin, end) for begin in np.ndindex(end[0] + 1, end[1] + 1))
        path = trace(sums, end)
        assert path_sum(costs, path) == pytest.approx(sums.totals[end], abs=1e-12)
        assert sums.totals[end] == pytest.approx(best, abs=1e-12)
        assert divmod(begins[end], columns) == tuple(path[0])
        assert longest_run(path) <= slope


def test_slope_1_lays_eight_frames_on_four():
    assert len(time_path(np.ones((8, 4)), slope=1)) == 8


test_what_has_no_path_is_refused = refusals(
    (r"of two dimensions, got \(0, 4\)", time_path, np.ones((0, 4))),
    ("a grid of finite numbers", time_path, [[1.0, np.nan], [1.0, 1.0]]),
    ("9 frames cannot be laid on 4 with .* 1: at most 2 to 1", lambda: time_path(np.ones((9, 4)), slope=1)),
    ("from 1 to 63 and slack .* got 0 and 0", lambda: time_path(np.ones((4, 4)), slope=0)),
    ("less than the 4 frames of a clip, got 2 and -1", lambda: time_path(np.ones((4, 4)), slack=-1)),
    ("less than the 4 frames of a clip, got 2 and 4", lambda: time_path(np.ones((9, 4)), slack=4)),
)
