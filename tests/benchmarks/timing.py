"""Ratios of processor times within one run, each held to a bound.

Seconds would measure the machine. A benchmark therefore divides the time of one work by that of another,
both in this process and in turns. Of each work the fastest run counts: other processes take time, and never
give any. A ratio above its bound is marked in the table at the end of a run; at twice its bound the test
fails, because even the fastest runs differ by some tenths from machine to machine and from run to run.
"""

import time
from typing import NamedTuple

import numpy as np

FAILS_AT = 2.0  # times the bound
POSE = np.ones((38, 4))  # one quaternion for each joint of the bundled body
MATRIX = np.random.default_rng(0).normal(size=(400, 400))
ADDITIONS = 250


class Ratio(NamedTuple):
    """The result of one benchmark, and its bound."""

    benchmark: str
    value: float
    bound: float

    @property
    def fails(self) -> bool:
        """Whether the ratio reaches twice its bound, or is no number."""
        return not self.value < FAILS_AT * self.bound

    @property
    def mark(self) -> str:
        """Return what the table says behind the ratio."""
        if self.fails:
            return "FAILS"
        return "over its bound" if self.value > self.bound else ""


HELD: list[Ratio] = []  # of this run, in order


def fastest(*works, repeats=5):
    """Return the least CPU seconds of each work, all of which run in turns."""
    seconds = []
    for _ in range(repeats):
        for work in works:
            start = time.process_time()
            work()
            seconds.append(time.process_time() - start)
    return np.array(seconds).reshape(repeats, -1).min(axis=0)


def ratio(work, base, repeats=5):
    """Return the time of a work, divided by that of its base."""
    work_seconds, base_seconds = fastest(work, base, repeats=repeats)
    return float(work_seconds / base_seconds)


def add_poses():
    """Add 250 pairs of poses, which takes some 0.1 ms: a step as quick makes 10 000 poses per second."""
    for _ in range(ADDITIONS):
        np.add(POSE, POSE)


def yardstick():
    """Do a fixed piece of work, the base of works that have no natural one: some 10 ms.

    About half of its time goes to calls of NumPy for one pose, and half to a product of matrices.
    """
    for _ in range(40):
        add_poses()
    MATRIX @ MATRIX


def draw_empty_axes():
    """Make a figure with empty axes and draw it, the base of works that draw."""
    import matplotlib.pyplot as plt  # here: the other benchmarks need no pictures

    figure, _ = plt.subplots()
    figure.canvas.draw()
    plt.close(figure)


def hold(benchmark, value, bound):
    """Note and print a ratio, and fail if it reaches twice its bound.

    Parameters
    ----------
    benchmark : its name in the history, as "clean_up, in forward kinematics". No two have the same.
    value : the ratio.
    bound : the ratio up to which all is well.
    """
    if benchmark in {held.benchmark for held in HELD}:
        raise ValueError(f"There is a benchmark '{benchmark}' already: name one of them otherwise.")
    held = Ratio(benchmark, float(value), float(bound))
    HELD.append(held)
    print(f"\n{benchmark}: {held.value:.3g}, bound {held.bound:.3g} {held.mark}")
    assert not held.fails, f"{benchmark}: {held.value:.3g} is {FAILS_AT:g} times the bound {held.bound:.3g}"
