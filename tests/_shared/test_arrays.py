"""Runs and ranges against plain loops."""

from itertools import groupby

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import ranges, runs


@given(st.lists(st.booleans()))
def test_runs_are_the_groups_of_true(marks):
    groups = [list(group) for key, group in groupby(range(len(marks)), key=marks.__getitem__) if key]
    found = runs(np.array(marks, bool))
    assert found.shape == (len(groups), 2)
    assert found.tolist() == [[group[0], group[-1] + 1] for group in groups]


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 5))))
def test_ranges_count_up_from_each(pairs):
    first, counts = np.array(pairs, int).reshape(-1, 2).T
    assert ranges(first, counts).tolist() == [n for f, c in pairs for n in range(f, f + c)]
