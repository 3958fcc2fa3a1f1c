"""How long a key takes, in forward kinematics of the same clip.

pytest -m benchmark -n 0 -s tests/benchmarks/test_warping.py
"""

import timeit

import pytest

from mocap.body.kinematics import forward_kinematics
from mocap.datasets.samples import sample
from mocap.editing.displacements import displaced
from mocap.editing.edits import posed
from mocap.editing.keys import keys_around, offsets
from mocap.editing.retiming import retime
from tests.editing.test_posing import post

pytestmark = pytest.mark.benchmark

WALK = sample("walk_straight")[:480]


def share(work):
    """Return how many forward kinematics of 4 s of motion some work takes; the best of five runs."""
    once, unit = (min(timeit.repeat(c, number=3, repeat=5)) for c in (work, lambda: forward_kinematics(WALK)))
    print(f"\n{once / unit:.1f} forward kinematics, {1000 * once / 3:.1f} ms")
    return once / unit


def test_a_key_is_met_in_ten_forward_kinematics():
    place = post(WALK, 238)
    drag = lambda: displaced(WALK, offsets(WALK, keys_around(WALK, 238, posed(WALK, 238, {"rhand": place}))))  # noqa: E731
    assert share(drag) < 10


def test_a_retiming_takes_fifteen_forward_kinematics():
    assert share(lambda: retime(WALK, [(0, 0), (2, 1), (4.9, 3.9)])) < 15
