"""⊕ and ⊖ undo each other, in each joint's own frame; splines add up to 1."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocap.datasets.samples import sample
from mocap.editing.displacements import Displacement, difference, displaced, spline_basis
from mocap.errors import SkeletonMismatch
from tests.refusals import refusals
from tests.strategies import random_motion, seeds


def random_change(seed, frames=5, joints=6, most=3.0):
    random = np.random.default_rng(seed)
    turns = random.normal(size=(frames, joints, 3))
    turns *= most * random.random((frames, joints, 1)) / np.linalg.norm(turns, axis=-1, keepdims=True)
    return Displacement(random.normal(size=(frames, 3)), turns)


@given(seeds, seeds)
def test_adding_and_taking_the_difference_undo_each_other(motion, change):
    """As in [LS99, displacement map]."""
    base, change = random_motion(motion), random_change(change)
    again = difference(displaced(base, change), base)
    np.testing.assert_allclose(again.root, change.root, atol=1e-14)
    np.testing.assert_allclose(again.turns, change.turns, atol=1e-12)


def test_what_is_not_turned_keeps_its_numbers_to_the_last_bit():
    walk = sample("walk_straight")[:20]
    turns = np.zeros((20, 38, 3))
    turns[:, 3, 0] = 0.1
    edited = displaced(walk, Displacement(np.zeros((20, 3)), turns))
    others = np.arange(38) != 3
    assert np.array_equal(edited.rotations[:, others], walk.rotations[:, others])
    assert np.array_equal(edited.root_positions, walk.root_positions)
    assert edited.contacts.keys() == walk.contacts.keys()


def test_a_basis_has_the_values_of_uniform_cubic_splines():
    """As in [Gle98, smooth change]."""
    rows = spline_basis(11, 5).toarray()
    np.testing.assert_allclose(rows[0], [1 / 6, 4 / 6, 1 / 6, 0, 0], atol=1e-15)
    np.testing.assert_allclose(rows[5], [0, 1 / 6, 4 / 6, 1 / 6, 0], atol=1e-15)
    np.testing.assert_allclose(rows[2], [0.036, 0.538667, 0.414667, 0.010667, 0], atol=1e-6)


@given(st.integers(1, 300), st.floats(0.1, 1000))
def test_the_splines_of_a_frame_add_up_to_1(frames, spacing):
    basis = spline_basis(frames, spacing)
    assert basis.shape == (frames, max(1, round((frames - 1) / spacing)) + 3)
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, atol=1e-12)
    assert np.diff(basis.indptr).max() <= 4 and basis.data.min() >= 0


WALK = sample("walk_straight")[:20]
OTHER = replace(WALK.skeleton, names=[f"x{n}" for n in WALK.skeleton.names])
SHORT = Displacement(np.zeros((10, 3)), np.zeros((10, 38, 3)))

test_what_has_no_difference_is_refused = refusals(
    (SkeletonMismatch, "joint", difference, WALK, replace(WALK, skeleton=OTHER, contacts={})),
    ("has 20 frames, 'walk_straight' has 10", difference, WALK, WALK[:10]),
    ("has 20 frames, its displacement 10", displaced, WALK, SHORT),
    *(("above 0", spline_basis, *wrong) for wrong in ((0, 1), (5, 0), (5, -1), (5, np.nan))),
)
