"""Changes from one kind of strides to another."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.errors import SkeletonMismatch
from mocap.methods.parametric_graphs.strides import changing_strides
from tests.methods.parametric_graphs.built import jogs, strides
from tests.refusals import refused


def test_it_starts_as_the_first_kind_and_ends_as_the_second():
    walk, jog = strides(), jogs()
    change = changing_strides(walk, jog)
    zero, one = change.ends
    for kind, phase in ((walk, zero), (jog, one)):
        heights = change.heights[:, phase]
        lowest, highest = (end(kind.heights[:, phase]) for end in (np.min, np.max))
        assert lowest - 1e-9 <= heights.min() <= heights.max() <= highest + 1e-9
    pace = np.abs(change.speeds) / np.gradient(change.seconds, change.grid, axis=1)
    assert pace[:, zero].mean() < 1.5 < 2.0 < pace[:, one].mean()
    np.testing.assert_allclose(np.linalg.norm(change.poses, axis=-1), 1, atol=1e-12)
    assert (np.diff(change.seconds, axis=1) > 0).all() and not change.seconds[:, zero].any()


def test_a_kind_changed_into_itself_is_itself():
    walk = strides()
    same = changing_strides(walk, walk)
    rows = np.abs(walk.heights[:, None] - same.heights).max(axis=-1).argmin(axis=0)
    assert len(set(rows)) == len(same) == 60
    np.testing.assert_allclose(same.heights, walk.heights[rows], atol=1e-9)
    np.testing.assert_allclose(same.seconds, walk.seconds[rows], atol=0.01)


def test_kinds_that_do_not_fit_are_refused():
    walk, jog = strides(), jogs()
    refused("over the same phases", changing_strides, walk, strides("lr"))
    refused("one rate, got 30 and 60 Hz", changing_strides, walk, replace(jog, fps=60.0))
    refused("no turn in common", changing_strides, walk, replace(jog, values=jog.values + 9))
    bones = replace(jog.skeleton, offsets=1.1 * jog.skeleton.offsets)
    with pytest.raises(SkeletonMismatch):
        changing_strides(walk, replace(jog, skeleton=bones))
