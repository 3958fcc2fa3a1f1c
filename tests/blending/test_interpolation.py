"""Blending's invariants."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from mocap.blending.interpolation import blend
from mocap.body import rotations
from mocap.errors import MocapError, SkeletonMismatch
from tests.strategies import planar, random_motion, seeds


def pair(seed):
    a = random_motion(seed)
    return a, random_motion(seed + 1, skeleton=a.skeleton)


@given(seeds)
def test_the_ends_are_the_motions_themselves(seed):
    a, b = pair(seed)
    for weight, source in ((1.0, a), (0.0, b)):
        mixed = blend(a, b, np.full(5, weight))
        assert mixed.root_positions == pytest.approx(source.root_positions)
        assert rotations.angle_between(mixed.rotations, source.rotations) == pytest.approx(0, abs=1e-6)


@given(seeds, planar)
def test_moving_then_blending_is_blending_then_moving(seed, transform):
    a, b = pair(seed)
    weights = np.linspace(1, 0, 5)
    first = blend(transform.apply_motion(a), transform.apply_motion(b), weights)
    last = transform.apply_motion(blend(a, b, weights))
    assert first.root_positions == pytest.approx(last.root_positions, abs=1e-9)
    assert rotations.angle_between(first.rotations, last.rotations) == pytest.approx(0, abs=1e-6)


def test_marks_come_from_the_larger_weight():
    a, b = pair(3)
    a = replace(a, contacts={"joint5": True}, labels={"walk": True})
    b = replace(b, contacts={"joint5": False}, labels={"run": True})
    mixed = blend(a, b, [1.0, 0.6, 0.5, 0.4, 0.0])
    assert mixed.contacts["joint5"].tolist() == [True, True, True, False, False]
    assert mixed.labels["walk"].tolist() == [True, True, True, False, False]
    assert mixed.labels["run"].tolist() == [False, False, False, True, True]


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([0.5] * 4, r"got 5, 5, \(4,\)"),
        ([0.5] * 4 + [1.001], r"lie in \[0, 1\]"),
        ([0.5] * 4 + [-0.001], r"lie in \[0, 1\]"),
        ([np.nan] * 5, r"lie in \[0, 1\]"),
    ],
)
def test_weights_must_fit(weights, message):
    with pytest.raises(MocapError, match=message):
        blend(*pair(0), weights)


def test_both_motions_have_as_many_frames():
    a, b = pair(0)
    for short, long, frames in ((a[:4], b, "4, 5"), (a, b[:4], "5, 4")):
        for count in (4, 5):
            with pytest.raises(MocapError, match=rf"got {frames}, \({count},\)"):
                blend(short, long, np.zeros(count))


def test_skeletons_must_be_the_same():
    with pytest.raises(SkeletonMismatch):
        blend(random_motion(0), random_motion(1), np.zeros(5))
