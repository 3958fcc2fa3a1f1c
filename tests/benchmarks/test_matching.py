"""What memory a search for transitions takes; its ratios are in test_ratios.py.

Run it alone, and see the numbers: pytest -m benchmark -n 0 -s tests/benchmarks/test_matching.py
"""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.benchmark


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
