"""How long reading, writing and kinematics take, as ratios to the bare work they cannot do without.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_files.py
"""

import subprocess
import sys
import time

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion
from mocap.files import load_path, load_save

pytestmark = pytest.mark.benchmark


def seconds(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def hold(benchmark, work, bare, most=3):
    """Compare with the bare work, taking turns: the least time of each, when nothing else disturbed it."""
    benchmark(work)
    times = [(seconds(work), seconds(bare)) for _ in range(9)]
    ratio = np.divide(*np.min(times, axis=0))
    print(f"\n{benchmark.name}: {ratio:.2f} times the bare work, at most {most}")
    assert ratio <= most


@pytest.fixture(scope="module")
def clip(real_data):
    return real_data / "hw3/walk_fwd_circle.AMC"


@pytest.fixture(scope="module")
def motion(clip):
    return load_save.load(clip)


def numbers_of(path):
    """Return the numbers alone of a file's frames, as text."""
    text = path.read_text()
    text = text.partition("Frame Time")[2].partition("\n")[2] or text.partition(":DEGREES")[2]
    return " ".join(word for word in text.split() if not word[0].isalpha())


def test_reading_amc(benchmark, clip):
    numbers = numbers_of(clip)
    hold(benchmark, lambda: load_save.load(clip), lambda: np.array(numbers.split(), float))


def test_reading_bvh(benchmark, motion, tmp_path):
    load_save.save(motion, tmp_path / "a.bvh")
    numbers = numbers_of(tmp_path / "a.bvh")
    hold(benchmark, lambda: load_save.load(tmp_path / "a.bvh"), lambda: np.array(numbers.split(), float))


def test_writing(benchmark, motion, tmp_path):
    path = tmp_path / "a.bvh"
    load_save.save(motion, path)
    values = np.array(numbers_of(path).split(), float)
    hold(
        benchmark,
        lambda: load_save.save(motion, path),
        lambda: "%.6f " * len(values) % tuple(values.tolist()),
    )


def test_forward_kinematics(benchmark, motion):
    local = np.tile(motion.rotations, (3, 1, 1))[:15000]
    long = Motion(motion.skeleton, np.zeros((15000, 3)), local, 120.0)
    turns = rotations.to_matrix(np.swapaxes(local, 0, 1))  # (J, F, 3, 3)
    parents = motion.skeleton.parents

    def chain():
        whole = np.empty_like(turns)
        whole[0] = turns[0]
        for joint in range(1, len(parents)):
            whole[joint] = whole[parents[joint]] @ turns[joint]

    hold(benchmark, lambda: forward_kinematics(long), chain)


@pytest.mark.parametrize("step", ["L 12.3 45.6 L 22.1 17.9 ", "12.3 45.6 22.1 17.9 ", "c 1 2 3 4 5 6 l 7 8 "])
def test_a_drawing_of_twice_the_length_takes_twice_as_long(benchmark, tmp_path, step):
    for name, count in (("half", 30_000 // len(step)), ("whole", 60_000 // len(step))):
        (tmp_path / f"{name}.svg").write_text(f'<svg><path d="M 0 0 {step * count}"/></svg>')
    hold(benchmark, lambda: load_path(tmp_path / "whole.svg"), lambda: load_path(tmp_path / "half.svg"))


def test_importing_is_light():
    code = "import time, mocap, sys; assert 'matplotlib' not in sys.modules; print(time.process_time())"
    runs = [subprocess.check_output([sys.executable, "-c", code], text=True) for _ in range(5)]
    assert min(map(float, runs)) < 0.25
