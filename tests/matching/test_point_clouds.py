"""The closed form against a numerical optimiser; clouds of points where they should be."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.optimize import minimize

from mocap.body import PlanarTransform, Skeleton
from mocap.matching import align
from mocap.matching.point_clouds import distinct_joints, rms_distance, unit_weights
from tests.oracles import squared_distance
from tests.refusals import refusals
from tests.strategies import seeds, wave


@settings(max_examples=8)
@given(seeds)
def test_no_optimiser_finds_a_better_alignment(seed):
    """As in [KGP02, Eqs. 2-4]."""
    random = np.random.default_rng(seed)
    points, others = random.normal(size=(2, 12, 3))
    weights = random.random(12)
    best = squared_distance(align(points, others, weights), points, others, weights)
    for start in np.linspace(-np.pi, np.pi, 4, endpoint=False):
        found = minimize(squared_distance, [start, 0, 0], args=(points, others, weights))
        assert best <= found.fun + 1e-6


test_clouds_and_weights_that_are_none_are_refused = refusals(
    (re.escape(f"got {[1.0] * 7 + [-1.0]}."), unit_weights, [1.0] * 7 + [-1.0], 8),
    (re.escape("got an array of shape (9,) from -1 to 1."), unit_weights, [1.0] * 8 + [-1.0], 9),
    (r"shapes \(4, 3\) and \(5, 3\) do not match", align, np.zeros((4, 3)), np.zeros((5, 3))),
    ("both need", align, np.zeros(3), np.zeros(3)),
    ("both need", align, np.zeros((4, 2)), np.zeros((4, 2))),
    (r"holds nan at \[0, 0\]", align, np.full((4, 3), np.nan), np.zeros((4, 3))),
    ("holds inf", align, np.zeros((4, 3)), np.full((4, 3), np.inf)),
    ("within 1e[+]06 m", align, np.zeros((4, 3)), np.full((4, 3), 1e200)),
)


def test_a_joint_that_is_its_parent_is_no_point_of_its_own():
    """Not the second joint's child either, and joints along each axis are."""
    offsets = [[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]]
    assert distinct_joints(Skeleton([*"abcdef"], [-1, 0, 1, 2, 2, 1], offsets)) == [0, 1, 3, 4, 5]


@pytest.mark.parametrize(("gap", "points"), [(4e-10, [0, 1]), (6e-10, [0, 1, 2])])
def test_joints_coincide_within_a_nanometre(gap, points):
    fork = Skeleton(["root", "l", "r"], [-1, 0, 0], [[0, 0, 0], [0, 1, 0], [0, 1, gap]])
    assert distinct_joints(fork) == points


def test_the_rms_distance_of_a_moved_motion_is_how_far_it_was_moved():
    motion = wave(10)
    assert rms_distance(motion, PlanarTransform(0.0, 3.0, 4.0).apply_motion(motion)) == pytest.approx(5)
