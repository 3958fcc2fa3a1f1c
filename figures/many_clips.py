"""Measure how the search for transitions grows with the number of frames.

    python figures/many_clips.py FOLDER FRAMES                 # one thread, by the search that is chosen
    python figures/many_clips.py FOLDER FRAMES --all-pairs     # by products of all pairs
    python figures/many_clips.py FOLDER FRAMES --workers 4     # on processes

FOLDER holds subjects of the CMU database, each in a folder with its `.asf` and `.amc` files. So many frames
of different motion are not at hand, so a set is made of these clips. Each time a clip is taken, at random, it
is played at other, changing speeds, and all its joints are rotated by small angles that change. Prints
seconds, CPU seconds of all processes, the most megabytes that this process held, with the clips, and the
number of transitions below 4 cm.
"""

import argparse
import os
import resource
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

import mocap
from mocap.body import rotations
from mocap.matching import find_transitions, minima

BELOW = 0.04  # metres
WINDOW = 10  # frames
RATE = 30.0  # frames per second, of the set
SKIP = 4  # frames of 120 Hz in one of the set
SHORTEST = 120  # frames of 120 Hz
SPREAD = 1.75  # degrees by which a joint is rotated, standard deviation


def varied(take: mocap.Motion, random: np.random.Generator) -> mocap.Motion:
    """Play a take at another, changing speed, with each joint rotated by a small angle."""
    count = len(take)
    speed = np.exp(random.normal(0, 0.1))
    pace = speed * (1 + 0.2 * np.sin(np.arange(count) / random.uniform(40, 120)))
    times = np.cumsum(SKIP * pace)
    frames = np.round(times[times < count - 1]).astype(int)

    shape = (take.rotations.shape[1], 3)
    constant = random.normal(0, SPREAD, shape)  # degrees
    phase = random.uniform(0, 6, shape)
    rate = random.uniform(0.02, 0.1, shape)
    swing = np.sin(np.arange(len(frames))[:, None, None] * rate + phase)
    offsets = rotations.from_rotvec(np.radians(constant + swing))
    rotated = rotations.multiply(take.rotations[frames], offsets)
    return mocap.Motion(take.skeleton, take.root_positions[frames], rotated, RATE)


def clips_of(folder: Path, count: int) -> list[mocap.Motion]:
    """Make clips of so many frames on one skeleton, from all takes of a folder."""
    takes = list(takes_of(folder))
    random = np.random.default_rng(0)
    clips: list[mocap.Motion] = []
    missing = count
    while missing > 0:
        take = takes[random.integers(len(takes))]
        clip = replace(varied(take, random), name=str(len(clips)))
        clips.append(clip if missing - len(clip) > WINDOW else clip[: max(missing, WINDOW)])
        missing -= len(clips[-1])
    return clips


def takes_of(folder: Path) -> Iterator[mocap.Motion]:
    """Load the takes of at least a second, all on the skeleton of the first."""
    skeleton = None
    for path in sorted(folder.glob("*/*.amc")):
        take = mocap.load(path)
        skeleton = skeleton or take.skeleton
        if len(take) > SHORTEST and len(take.skeleton) == len(skeleton):
            yield replace(take, skeleton=skeleton)


def cpu_seconds() -> float:
    """Return the CPU seconds of this process and of its workers that have ended."""
    kinds = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    usages = [resource.getrusage(kind) for kind in kinds]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def peak() -> float:
    """Return the megabytes that this process took at most."""
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1000


def main() -> None:
    """Make the set, search it, and print what it took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("frames", type=int)
    parser.add_argument("--all-pairs", action="store_true")
    parser.add_argument("--workers", type=int)
    options = parser.parse_args()
    if options.all_pairs:
        minima.TUNED = replace(minima.TUNED, few_windows=options.frames)
    clips = clips_of(options.folder, options.frames)
    Path("/proc/self/clear_refs").write_text("5")  # forget the peak of reading the takes
    start = time.perf_counter()
    start_cpu = cpu_seconds()
    if options.workers:
        with ProcessPoolExecutor(options.workers) as pool:
            transitions = find_transitions(clips, window=WINDOW, below=BELOW, executor=pool, jobs=1)
    else:
        transitions = find_transitions(clips, window=WINDOW, below=BELOW, jobs=1)
    seconds = time.perf_counter() - start
    spent = f"{seconds:.1f} s, {cpu_seconds() - start_cpu:.1f} CPU s, {peak():.0f} MB"
    print(f"{sum(map(len, clips))} frames, {os.cpu_count()} cores: {spent}, {len(transitions)} transitions")


if __name__ == "__main__":
    main()
