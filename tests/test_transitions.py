"""Minima against a loop over neighbours, and transitions against what they promise."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from mocap.errors import MocapError
from mocap.matching import distance_grid, point_cloud
from mocap.progress import bar
from mocap.transitions import find_transitions, local_minima
from tests.strategies import wave

CLIPS = [wave(70, name="a"), wave(50, phase=1.0, name="b", seed=1)]


def minima_by_loops(grid, below):
    rows, columns = grid.shape
    found = []
    for i, j in np.ndindex(rows, columns):
        around = [(i + r, j + c) for r in (-1, 0, 1) for c in (-1, 0, 1) if (r, c) != (0, 0)]
        inside = [(r, c) for r, c in around if 0 <= r < rows and 0 <= c < columns]
        lower = all((grid[n], n) > (grid[i, j], (i, j)) for n in inside)
        if lower and grid[i, j] < below:
            found.append([i, j])
    return found


@given(
    arrays.arrays(float, st.tuples(st.integers(1, 6), st.integers(1, 6)), elements=st.integers(0, 4)),
    st.floats(0, 5),
)
def test_minima_are_lower_than_all_neighbours_and_ties_go_to_the_first(grid, below):
    assert local_minima(grid, below).tolist() == minima_by_loops(grid, below)


def test_transitions_are_the_minima_of_every_pair_both_ways():
    found = find_transitions(CLIPS, window=8, below=0.1)
    assert {(t.source, t.target) for t in found} == {(0, 0), (0, 1), (1, 0), (1, 1)}
    grid = distance_grid(*CLIPS, window=8)
    assert [[t.leave, t.enter] for t in found if (t.source, t.target) == (0, 1)] == (
        local_minima(grid, 0.01).tolist()
    )
    there = {(t.source, t.leave, t.target, t.enter): t for t in found}
    for (a, i, b, j), t in there.items():
        assert there[b, j, a, i].cost == t.cost


def test_the_transform_leaves_the_cost_that_is_told():
    for t in find_transitions(CLIPS, window=8, below=0.1):
        points = point_cloud(CLIPS[t.source])[t.leave : t.leave + 8]
        others = t.transform.points(point_cloud(CLIPS[t.target])[t.enter : t.enter + 8])
        assert np.sqrt(((points - others) ** 2).sum(-1).mean()) == pytest.approx(t.cost, abs=1e-9)
        assert t.cost < 0.1


def test_windows_of_one_clip_do_not_overlap():
    same = [t for t in find_transitions(CLIPS, window=8, below=1.0) if t.source == t.target]
    assert same
    assert all(abs(t.leave - t.enter) >= 8 for t in same)


def test_the_pairs_of_clips_are_shown_as_they_are_done():
    seen = []
    find_transitions(
        CLIPS, window=8, below=0.1, progress=lambda pairs: seen.append(list(pairs)) or bar(pairs)
    )
    assert seen == [[(0, 0), (0, 1), (1, 1)]]


@pytest.mark.parametrize("below", [0, -1, np.nan])
def test_a_threshold_must_be_positive(below):
    with pytest.raises(MocapError, match="threshold must be above 0 m"):
        find_transitions(CLIPS, window=8, below=below)


def test_a_clip_shorter_than_the_window_is_named():
    with pytest.raises(MocapError, match="'c' has 7 frames, too few for a window of 8"):
        find_transitions([*CLIPS, replace(wave(7), name="c")], window=8, below=0.1)


def test_no_clips_have_no_transitions():
    assert find_transitions([], window=8, below=0.1) == []
