"""Measure how the search for transitions grows with the number of frames, and draw it.

`python figures/draw_growth.py FOLDER`, where FOLDER holds subjects of the CMU database, each in a folder with
its `.asf` and `.amc` files. So many frames of different motion are not at hand, so a set is made of these
clips: each time a clip is taken again, it is played at other, changing speeds, and all its joints are turned
a little. Each size runs in a process of its own, so that its memory can be measured; two threads work.

`python figures/draw_growth.py FOLDER 650000 bound` measures one size, here that of the whole database.
"""

import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np

import mocap
from mocap.body import rotations
from mocap.matching import find_transitions
from mocap.plotting import CURVES

FOLDER = Path(__file__).parent
SIZES = (5_000, 10_000, 20_000, 40_000, 80_000, 200_000)
COLOURS = {"bound": CURVES[0], "products": CURVES[1]}
BELOW = 0.04  # metres
SPREAD = 1.75  # degrees by which a joint is turned, the standard deviation


def varied(take: mocap.Motion, random: np.random.Generator) -> mocap.Motion:
    """Play a take of 120 Hz at 30 Hz and at changing speeds, with each joint turned by a small angle."""
    pace = np.exp(random.normal(0, 0.1)) * (1 + 0.2 * np.sin(np.arange(len(take)) / random.uniform(40, 120)))
    times = np.cumsum(4 * pace)
    frames = np.round(times[times < len(take) - 1]).astype(int)
    shape = (take.rotations.shape[1], 3)
    always, phase, rate = (
        random.normal(0, SPREAD, shape),
        random.uniform(0, 6, shape),
        random.uniform(0.02, 0.1, shape),
    )
    turn = np.radians(always + np.sin(np.arange(len(frames))[:, None, None] * rate + phase))
    small = np.concatenate([np.ones((*turn.shape[:-1], 1)), turn / 2], axis=-1)
    small /= np.linalg.norm(small, axis=-1, keepdims=True)
    turned = rotations.multiply(take.rotations[frames], small)
    return mocap.Motion(take.skeleton, take.root_positions[frames], turned, 30.0)


def clips_of(folder: Path, frames: int) -> list[mocap.Motion]:
    """Make clips of at least so many frames at 30 Hz, on one skeleton, from all takes that a folder holds."""
    takes = [take for path in sorted(folder.glob("*/*.amc")) if len(take := mocap.load(path)) > 120]
    takes = [replace(take, skeleton=takes[0].skeleton) for take in takes]
    random = np.random.default_rng(0)
    clips: list[mocap.Motion] = []
    total = 0
    while total < frames:
        take = takes[random.integers(len(takes))]
        clips.append(replace(varied(take, random), name=str(len(clips))))
        total += len(clips[-1])
    return clips


def measure(folder: Path, frames: int, method: str) -> dict[str, float]:
    """Find the transitions; measure the seconds, and the most megabytes that the process took."""
    clips = clips_of(folder, frames)
    Path("/proc/self/clear_refs").write_text("5")  # forget the most memory that reading the takes took
    start, busy = time.perf_counter(), time.process_time()
    with ThreadPoolExecutor(2) as pool:
        found = find_transitions(clips, window=10, below=BELOW, method=method, executor=pool)
    seconds, busy = time.perf_counter() - start, time.process_time() - busy
    memory = int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1000
    frames = sum(map(len, clips))
    return {"frames": frames, "seconds": seconds, "cpu": busy, "memory": memory, "found": len(found)}


def draw(runs: dict[str, list[dict[str, float]]]) -> None:
    """Draw CPU seconds, memory and transitions found against frames."""
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    labels = {"products": "all pairs, by products", "bound": "what the bound leaves"}
    for method, colour in COLOURS.items():
        frames = [run["frames"] / 1000 for run in runs[method]]
        for ax, key in zip(axes, ("cpu", "memory", "found"), strict=True):
            ax.plot(frames, [run[key] for run in runs[method]], "o-", color=colour, label=labels[method])
    axes[0].set(xscale="log", yscale="log", ylabel="core seconds", title="time")
    axes[1].set(ylabel="MB", ylim=(0, None), title="memory, clips and all")
    axes[2].set(xscale="log", yscale="log", ylabel="transitions", title=f"found below {100 * BELOW:g} cm")
    axes[0].legend(fontsize=8)
    for ax in axes:
        ax.set(xlabel="thousand frames at 30 Hz")
        ax.grid(alpha=0.3)
    figure.savefig(FOLDER / "growth.png", dpi=110)
    plt.close(figure)


def run_alone(folder: Path, frames: int, method: str) -> dict[str, float]:
    """Measure in a process of its own, where each thread's products take one core."""
    command = [sys.executable, __file__, str(folder), str(frames), method]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env=os.environ | {"OMP_NUM_THREADS": "1"}
    )
    return json.loads(done.stdout)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    if len(sys.argv) == 4:
        print(json.dumps(measure(folder, int(sys.argv[2]), sys.argv[3])))
    else:
        runs = {method: [run_alone(folder, frames, method) for frames in SIZES] for method in COLOURS}
        print(json.dumps(runs))
        draw(runs)
