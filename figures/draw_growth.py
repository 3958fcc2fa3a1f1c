"""Measure how the search for transitions grows with the number of frames, and draw it.

`python figures/draw_growth.py FOLDER`, where FOLDER holds subject 16 of the CMU database, `16.asf` and its
`.amc` files. The clips are those at 30 Hz, from each of four starting frames, repeated up to the number of
frames. Each size runs in a process of its own, so that its memory can be measured; two threads work.
"""

import json
import resource
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np

import mocap
from mocap.matching import find_transitions

FOLDER = Path(__file__).parent
SIZES = (5_000, 10_000, 20_000, 40_000, 80_000, 200_000)
CMU = 650_000  # frames of the whole database at 30 Hz


def clips_of(folder: Path, frames: int) -> list[mocap.Motion]:
    """Repeat a folder's clips until they have at least this many frames."""
    takes = [mocap.load(path) for path in sorted(folder.glob("*.amc"))]
    short = [take[start::4] for start in range(4) for take in takes if len(take) > 60]
    clips: list[mocap.Motion] = []
    while sum(map(len, clips)) < frames:
        clips.append(short[len(clips) % len(short)])
    return clips


def measure(folder: Path, frames: int) -> dict[str, float]:
    """Find the transitions below 2 cm; measure the seconds, and the most megabytes that the process took."""
    clips = clips_of(folder, frames)
    start, busy = time.perf_counter(), time.process_time()
    with ThreadPoolExecutor(2) as pool:
        found = find_transitions(clips, window=10, below=0.02, executor=pool)
    seconds, busy = time.perf_counter() - start, time.process_time() - busy
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    frames = sum(map(len, clips))
    return {"frames": frames, "seconds": seconds, "cpu": busy, "memory": memory, "found": len(found)}


def draw(runs: list[dict[str, float]]) -> None:
    """Draw CPU seconds and memory against frames, and the square law up to the whole database."""
    frames, busy, memory = (np.array([run[key] for run in runs]) for key in ("frames", "cpu", "memory"))
    law = busy[-1] / frames[-1] ** 2
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    span = np.geomspace(frames[0], CMU, 50)
    axes[0].plot(span, law * span**2, color="#999999", linewidth=1, label="as the square of the frames")
    axes[0].plot(frames, busy, "o", color="#0072B2", label="measured")
    axes[0].plot(CMU, law * CMU**2, "o", mfc="none", color="#D55E00")
    label = f"the whole CMU database:\n{law * CMU**2 / 60:.0f} core minutes"
    axes[0].annotate(label, (CMU, law * CMU**2), (-9, 0), textcoords="offset points", ha="right", va="center")
    axes[0].plot(6000, 25 * 60, "s", color="#CC79A7", label="Kovar et al., 2002")
    axes[0].set(
        xscale="log",
        yscale="log",
        ylim=(None, 3 * law * CMU**2),
        xlabel="frames at 30 Hz",
        ylabel="core seconds",
        title="time",
    )
    axes[0].legend(loc="lower right", fontsize=8)
    axes[1].plot(frames / 1000, memory, "o-", color="#0072B2")
    axes[1].set(xlabel="thousand frames at 30 Hz", ylabel="MB", ylim=(0, None), title="memory, clips and all")
    for ax in axes:
        ax.grid(alpha=0.3)
    figure.savefig(FOLDER / "growth.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    if len(sys.argv) == 3:
        print(json.dumps(measure(folder, int(sys.argv[2]))))
    else:
        runs = []
        for size in SIZES:
            command = [sys.executable, __file__, str(folder), str(size)]
            runs.append(
                json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
            )
            print(runs[-1], flush=True)
        draw(runs)
