"""How fast matching is, as ratios within one run, on a machine that does nothing else meanwhile.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_matching.py
Both sides of a ratio take turns, and of each the fastest turn counts.
"""

import os
import subprocess
import sys

import numpy as np
import pytest

from mocap import load, resample
from mocap.matching.distance_grids import distance_grid
from mocap.matching.point_clouds import point_cloud
from mocap.matching.transitions import find_transitions
from tests.benchmarks.timing import fastest

pytestmark = pytest.mark.benchmark
WINDOW = 10


@pytest.fixture(scope="module")
def clips(real_data):
    names = ("circle", "curve1", "curve2")
    return [resample(load(real_data / "hw3" / f"walk_fwd_{name}.AMC"), 30) for name in names]


@pytest.fixture(scope="module")
def points(clips):
    joined = np.concatenate([point_cloud(clip) for clip in clips])
    assert joined.shape == (3798, 31, 3)
    return joined


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_all_pairs_take_at_most_six_bare_products(points, dtype):
    cloud = points.astype(dtype)
    flat = np.tile(cloud.reshape(len(cloud), -1), 2)[:, : 5 * 31]  # (n, 5 P)
    product, grid = fastest(lambda: flat @ flat.T, lambda: distance_grid(cloud, cloud, window=WINDOW))
    print(f"\n{dtype.__name__}: product {product:.3f} s, grid {grid:.3f} s = {grid / product:.1f} products")
    assert grid <= 6 * product


def test_the_window_hardly_matters(points):
    cloud = points.astype(np.float32)
    short, long = fastest(*(lambda k=k: distance_grid(cloud, cloud, window=k) for k in (10, 40)))
    print(f"\nwindow 10: {short:.3f} s, 40: {long:.3f} s = {long / short:.2f} times")
    assert long <= 1.5 * short


def test_minima_and_candidates_take_at_most_twice_the_bound(points, clips):
    flat = np.tile(points.reshape(len(points), -1), 2)[:, : 5 * 31]  # 64 bits, as the search of few clips
    found = []
    product, grid, search = fastest(
        lambda: flat @ flat.T,
        lambda: distance_grid(points, points, window=WINDOW),
        lambda: found.append(len(find_transitions(clips, window=WINDOW, below=0.04))),
    )
    ratios = f"{search / grid:.1f} grids = {search / product:.1f} products"
    print(f"\n{found[0]} transitions in {search:.3f} s = {ratios}")
    assert search <= 2 * 6 * product


SEARCH = """
import sys, time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from mocap import load, resample
from mocap.matching import find_transitions

folder, names, frames, below = Path(sys.argv[1]), sys.argv[2].split(","), int(sys.argv[3]), float(sys.argv[4])
short = [resample(load(folder / name), 30) for name in names]
clips = []
while sum(map(len, clips)) < frames:
    clips.append(short[len(clips) % len(short)])
def peak():
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1000

Path("/proc/self/clear_refs").write_text("5")  # forget the peak of reading the clips
before = peak()
start, busy = time.perf_counter(), time.process_time()
with ThreadPoolExecutor(2) as pool:
    found = find_transitions(clips, window=10, below=below, executor=pool)
seconds, busy = time.perf_counter() - start, time.process_time() - busy
print(len(found), seconds, busy, peak() - before, peak())
"""


def search(folder, names, frames, below):
    """Search in a process of its own: transitions, seconds, CPU seconds, megabytes more, megabytes at all."""
    command = [sys.executable, "-c", SEARCH, str(folder), ",".join(names), str(frames), str(below)]
    alone = os.environ | {"OMP_NUM_THREADS": "1"}  # the executor's threads share the cores
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=alone)
    return [float(word) for word in done.stdout.split()]


def test_the_homeworks_clips_take_less_than_200_megabytes(real_data):
    names = [f"walk_fwd_{name}.AMC" for name in ("circle", "curve1", "curve2")]
    *_, more, whole = search(real_data / "hw3", names, 3798, 0.04)
    print(f"\n{whole:.0f} MB, clips, Python and all; {more:.0f} MB of it in the search")
    assert whole < 200


def test_eighty_thousand_frames_in_a_minute_and_500_megabytes(real_data):
    names = sorted(path.name for path in (real_data / "cmu" / "16").glob("*.amc"))
    found, seconds, busy, _, whole = search(real_data / "cmu" / "16", names, 80_000, 0.02)
    print(f"\n{found:.0f} transitions in {seconds:.0f} s ({busy:.0f} CPU seconds), {whole:.0f} MB")
    assert whole < 500
    assert busy < 120, "two cores have 120 seconds in a minute, whoever else uses them"
