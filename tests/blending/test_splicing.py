"""A clip laid on another is as near as the distance grid says; frames are put in a row without a gap."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending.joining import lay_window_on, splice
from mocap.errors import MocapError, SkeletonMismatch
from mocap.matching.distance_grids import distance_grid
from mocap.matching.point_clouds import point_cloud
from tests.strategies import planar, random_motion, wave

A, B = wave(30, name="a"), wave(20, phase=1.0, name="b", seed=1)
GRIDS = {window: distance_grid(A, B, window=window) for window in (1, 8)}


@given(st.sampled_from([*GRIDS]), st.integers(0, 22), st.integers(0, 12), planar)
def test_the_windows_agree_as_well_as_the_distance_grid_says(window, i, j, transform):
    laid = lay_window_on(A, i, transform.apply_motion(B), j, window)
    gaps = point_cloud(A)[i : i + window] - point_cloud(laid)[j : j + window]
    assert (gaps**2).sum(-1).mean() == pytest.approx(GRIDS[window][i, j], abs=1e-9)


@pytest.mark.parametrize(("i", "j"), [(-1, 0), (0, -1), (23, 0), (0, 13)])
def test_a_window_lies_within_both_clips(i, j):
    name = "'a', which has 30" if i else "'b', which has 20"
    with pytest.raises(MocapError, match=f"window of 8 frames from frame {i or j} runs off {name}"):
        lay_window_on(A, i, B, j, 8)


def test_motions_must_go_together():
    with pytest.raises(SkeletonMismatch):
        lay_window_on(A, 0, random_motion(0, frames=20), 0, 5)
    with pytest.raises(MocapError, match="at least one frame, got 0"):
        lay_window_on(A, 0, B, 0, 0)


@pytest.mark.parametrize(("i", "j"), [(0, 0), (1, 1), (3, 19), (30, 20), (0, 20)])
def test_spliced_frames_stand_in_a_row(i, j):
    middle = A[5:7]
    spliced = splice(A, i, middle, B, j)
    for field in ("root_positions", "rotations"):
        parts = getattr(A, field)[:i], getattr(middle, field), getattr(B, field)[j:]
        assert np.array_equal(getattr(spliced, field), np.concatenate(parts))
    assert spliced.name == "a to b"
