"""How the time of long works grows: the exponent p of "seconds = constant · size ^ p".

See the exponents: pytest -m benchmark -n 0 -s tests/benchmarks/test_growth.py

Each work is timed at three sizes, each twice the one before. The exponent is that between the last two, as a
constant part, such as reading a graph, counts less there.
"""

from functools import cache

import numpy as np
import pytest

from mocap.blending import register
from mocap.body import GroundPath
from mocap.editing import retime
from mocap.methods.groups import build_group
from mocap.steering import walk_crowd
from mocap.synthesis import random_walk, to_motion
from tests.benchmarks.timing import fastest, hold
from tests.bundled import walking
from tests.refusals import quietly

pytestmark = pytest.mark.benchmark


def print_exponent(name, sizes, unit, work, bound, repeats=2):
    """Time a work at three sizes, print the seconds and the exponent, and hold the exponent to its bound."""
    seconds = fastest(*(lambda size=size: quietly(work, size) for size in sizes), repeats=repeats)
    exponent = np.log(seconds[2] / seconds[1]) / np.log(sizes[2] / sizes[1])
    times = ", ".join(f"{size} {unit}: {time:.2f} s" for size, time in zip(sizes, seconds, strict=True))
    print(f"\n{name}: {times}; exponent {exponent:.2f}")
    hold(f"{name}, exponent", exponent, bound)


@cache
def walk_at_two_paces(seconds):
    """Return a random walk, and the same walk up to 3 s later and earlier."""
    source = walking().source
    walk = to_motion(source, random_walk(source, seconds=seconds, seed=1))
    third = walk.duration / 3
    return walk, retime(
        walk, [(0, 0), (third, third + 3), (2 * third, 2 * third - 3), (3 * third, 3 * third)]
    )


def test_registering_long_walks():
    """All cells of the grid would make the exponent 2, and dense curves of time would make it 3."""
    sizes = (150, 300, 600)
    for seconds in sizes:
        walk_at_two_paces(seconds)
    print_exponent("register", sizes, "s", lambda seconds: register(walk_at_two_paces(seconds)), 1.3)


def lines_through_one_place(count):
    """Return lines of 20 m, whose starts and ends are 1 m apart for 30 of them, and which all cross."""
    directions = np.exp(1j * np.pi * np.arange(count) / count)
    return [GroundPath(10 * np.array([[d.real, d.imag], [-d.real, -d.imag]])) for d in directions]


def test_a_crowd_that_crosses_one_place():
    """A search of the walk of each character around all others would make the exponent 2."""
    crowds = {}

    def walk(count):
        crowds[count] = walk_crowd(walking(), lines_through_one_place(count))

    print_exponent("walk_crowd", (7, 14, 28), "characters", walk, 1.5, repeats=1)
    assert min(crowd.nearest.min() for crowd in crowds.values()) >= 0.8


def test_a_group_of_more_members():
    """Two configurations are compared by an assignment, whose time grows with the cube of the members."""
    print_exponent("build_group", (8, 16, 32), "members", build_group, 1.6, repeats=1)
