"""A change begins as one kind and ends as the other."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.errors import MocapError, SkeletonMismatch
from mocap.methods.parametric_graphs.kinds_of_strides import _pairs, changing_strides
from tests.methods.parametric_graphs.built import strides
from tests.methods.parametric_graphs.kinds import cut


def test_it_starts_as_the_first_kind_and_ends_as_the_second():
    walk, jog = cut("walk"), cut("jog")
    change = changing_strides(walk, jog)
    zero, one = change.ends
    for kind, phase in ((walk, zero), (jog, one)):
        heights = change.heights[:, phase]
        assert (
            kind.heights[:, phase].min() - 1e-9
            <= heights.min()
            <= heights.max()
            <= kind.heights[:, phase].max()
        )
    pace = np.abs(change.speeds) / np.gradient(change.seconds, change.grid, axis=1)
    assert pace[:, zero].mean() < 1.5 < 2.0 < pace[:, one].mean()
    np.testing.assert_allclose(np.linalg.norm(change.poses, axis=-1), 1, atol=1e-12)


def test_a_kind_changed_into_itself_is_itself():
    walk = cut("walk")
    same = changing_strides(walk, walk)
    rows, _ = _pairs(walk, walk)
    np.testing.assert_allclose(same.heights, walk.heights[rows], atol=1e-9)
    np.testing.assert_allclose(same.seconds, walk.seconds[rows], atol=0.01)


def test_time_goes_on():
    change = changing_strides(cut("walk"), cut("sneak"))
    assert (np.diff(change.seconds, axis=1) > 0).all()
    assert np.abs(change.seconds[:, change.ends[0]]).max() == 0


def test_kinds_that_do_not_fit_are_refused():
    walk, jog = cut("walk"), cut("jog")
    with pytest.raises(MocapError, match="over the same strikes"):
        changing_strides(walk, strides("lr"))
    with pytest.raises(MocapError, match="one rate, got 30 and 60 Hz"):
        changing_strides(walk, replace(jog, fps=60.0))
    with pytest.raises(MocapError, match="no turn in common"):
        changing_strides(walk, replace(jog, values=jog.values + 9))
    bones = replace(jog.skeleton, offsets=1.1 * jog.skeleton.offsets)
    with pytest.raises(SkeletonMismatch):
        changing_strides(walk, replace(jog, skeleton=bones))
