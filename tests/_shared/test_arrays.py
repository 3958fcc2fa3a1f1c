"""Runs and ranges against plain loops; a step that starts and ends at rest; a collector that pauses."""

import gc
from itertools import groupby

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.arrays import ranges, runs
from mocap._shared.collector import uncollected
from mocap._shared.easing import quintic_step


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


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_the_step_starts_and_ends_at_rest_and_unaccelerated(end):
    near = quintic_step(end + np.array([-2e-4, -1e-4, 0, 1e-4, 2e-4]))
    assert near == pytest.approx(end, abs=1e-10)
    assert np.diff(near, 2) / 1e-8 == pytest.approx(0, abs=0.02)


@pytest.mark.parametrize("switch", [gc.disable, gc.enable])
def test_the_collector_pauses_and_is_left_as_it_was(switch):
    switch()
    before = gc.isenabled()
    try:
        with pytest.raises(ZeroDivisionError), uncollected():
            assert not gc.isenabled()
            raise ZeroDivisionError
        assert gc.isenabled() == before
    finally:
        gc.enable()
