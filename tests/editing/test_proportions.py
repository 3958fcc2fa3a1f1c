"""Bodies with other proportions."""

import numpy as np
import pytest

from mocap.editing.stances import proportioned, stance_of
from mocap.errors import MocapError
from tests.editing.bodies import adult, walk, without


def lengths(stance, *roles):
    return [np.linalg.norm(stance.skeleton.offsets[stance.roles[role]]) for role in roles]


def test_each_part_has_its_share():
    new = proportioned(adult(), legs=0.5, trunk=0.6, arms=0.7, head=0.8)
    for share, parts in {
        0.5: ["left knee", "right ankle", "right ball"],
        0.6: ["chest", "left shoulder", "left hip"],
        0.7: ["left elbow", "right wrist"],
        0.8: ["head"],
    }.items():
        assert lengths(new, *parts) == pytest.approx(share * np.array(lengths(adult(), *parts)))
    assert new.heights == pytest.approx({role: 0.5 * height for role, height in adult().heights.items()})
    assert new.leg == pytest.approx(0.5 * adult().leg)


def test_whole_numbers_are_numbers():
    assert np.allclose(
        proportioned(adult(), trunk=1, legs=0.5).skeleton.offsets[2:4],
        adult().skeleton.offsets[2:4] * [[1], [0.5]],
    )


def test_a_body_without_a_neck_has_its_head_on_the_trunk():
    body = without(walk(), "lowerneck", "upperneck")
    new = proportioned(stance_of(body), head=0.5, trunk=0.9)
    assert lengths(new, "head") == pytest.approx(0.9 * np.array(lengths(stance_of(body), "head")))


@pytest.mark.parametrize("share", [0, -1, np.nan, np.inf])
def test_bad_shares(share):
    with pytest.raises(MocapError, match="The share of the arms must be above 0"):
        proportioned(adult(), arms=share)
