"""Turns of a real walker that were held out, made from straighter and sharper ones."""

import numpy as np
import pytest
import turns_held_out
from turns_held_out import CASES, WAYS

pytestmark = pytest.mark.exhaustive
CURVES, STRIKES, PLAIN, ANYWHERE = WAYS


@pytest.fixture(scope="module")
def strides(real_data):
    with pytest.warns(match="may not be the same kind of motion"):  # straight on, and turns by 180°
        return turns_held_out.walker(real_data / "bvh" / "puppy0512_motion_graph")


@pytest.mark.parametrize("case", CASES[:2], ids=str)
def test_straight_on_and_90_degrees_make_45(strides, case):
    """Knee, hip, stride and sway, each within two standard deviations of the real turns."""
    found = turns_held_out.compare(strides, case)
    assert np.abs(found.off(CURVES)).max() <= 2
    off = {way: np.abs(found.off(way)).mean() for way in WAYS}
    assert off[CURVES] < off[STRIKES] < off[ANYWHERE] and off[CURVES] < off[PLAIN]
    assert np.abs(found.off(ANYWHERE)).max() > 4


@pytest.mark.parametrize("case", CASES[2:], ids=str)
def test_sharper_turns_have_the_knees_and_hips_of_real_ones(strides, case):
    """And the length, unless the strides on either side are all shorter: no blend is longer than both."""
    found = turns_held_out.compare(strides, case)
    assert np.abs(found.off(CURVES)[[0, 1, 3]]).max() <= 2 and found.off(ANYWHERE)[0] < -2
    assert np.abs(found.off(CURVES)).max() <= 3
    real, straighter, sharper, made = (
        some[:, 2].mean() for some in (found.real, found.straighter, found.sharper, found.made[CURVES])
    )
    if case == CASES[2]:
        assert abs(found.off(CURVES)[2]) <= 2
    else:
        assert sharper < made < straighter < real
