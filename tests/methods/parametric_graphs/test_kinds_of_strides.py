"""A graph of kinds from clips in one call, and the changes between them."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.errors import MocapError, NoWalk, SkeletonMismatch
from mocap.methods.parametric_graphs import build_kinds
from mocap.methods.parametric_graphs.kinds_of_strides import _pairs, changing_strides
from tests.methods.parametric_graphs.built import SMALL, clips, jogs, strides, walk_and_jog
from tests.refusals import refused


def test_walk_and_jog_of_the_bundled_clips_with_both_changes():
    graph = walk_and_jog().graph
    assert set(graph) == {"walk", "jog", "walk to jog", "jog to walk"} and graph.number_of_edges() == 6
    assert graph.has_edge("walk to jog", "jog") and not graph.has_edge("walk", "jog")


def test_strides_may_be_given_and_a_threshold():
    graph = build_kinds({"walk": strides()}, good=0.03, sampling=SMALL)
    assert list(graph.graph.edges) == [("walk", "walk")]
    wide = build_kinds({"walk": strides()}, good=0.03, widest=2.0, sampling=SMALL)
    assert wide.space("walk").high > graph.space("walk").high


@pytest.mark.parametrize(
    ("kinds", "changes", "error", "sentence"),
    [
        (lambda: {"walk": [clips()[3]]}, None, MocapError, "walk: A space asked by turn takes 3 strides or"),
        (lambda: {"walk": [clips()[3][:60]]}, None, MocapError, "walk: No example of 'lrl'"),
        (lambda: {"walk": strides()}, [("walk", "fly")], MocapError, "no kind 'fly'; there are: walk"),
        (dict, None, MocapError, "one kind of strides or more, got none"),
        (
            lambda: {"left": sided(1), "right": sided(-1)},
            None,
            MocapError,
            "left to right: The two kinds have",
        ),
        (
            lambda: {"faster": changing_strides(strides(), jogs())},  # they begin as a walk and end as a jog
            None,
            NoWalk,
            r"faster → faster needs T_GOOD = \d+.\d cm, more than 8: give `good`",
        ),
    ],
)
def test_what_cannot_be_built_is_refused_by_name(kinds, changes, error, sentence):
    with pytest.raises(error, match=sentence) as caught:
        build_kinds(kinds(), changes, sampling=SMALL)
    assert len(str(caught.value)) <= 200


def sided(side):
    return strides().take(side * strides().values[:, 0] > 0.6)


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
    rows, _ = _pairs(walk, walk, any_turn=False)
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
