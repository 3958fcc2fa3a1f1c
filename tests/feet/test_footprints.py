"""Footprints against a count by hand."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body.kinematics import joint_positions
from mocap.feet.footprints import find_footprints, standing_tracks
from tests.strategies import wave


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_each_run_of_contact_is_one_print(down):
    motion = replace(wave(len(down)), contacts={"hand": down})
    runs = [(key, len(list(group))) for key, group in groupby(down)]
    prints = find_footprints(motion)
    assert len(prints) == sum(key for key, _ in runs)
    covered = np.zeros(len(down), bool)
    for step in prints:
        covered[step.start : step.end] = True
        x, _, z = joint_positions(motion)[step.start : step.end, 2].mean(axis=0)
        assert (step.x, step.z) == pytest.approx((x, z))
    assert covered.tolist() == down


def test_without_contacts_there_are_no_prints():
    assert find_footprints(replace(wave(5), contacts={})) == []


def test_tracks_have_gaps_where_no_joint_stands():
    motion = replace(wave(4), contacts={"hand": [1, 1, 0, 1], "root": [0, 0, 0, 0]})
    tracks = standing_tracks(motion)
    hand = joint_positions(motion)[:, motion.skeleton.index("hand")][:, [0, 2]]
    assert tracks[[0, 1, 3]] == pytest.approx(hand[[0, 1, 3]])
    assert np.isnan(tracks[[2, 4, 5, 6, 7, 8, 9]]).all()
    assert len(tracks) == 10
    assert standing_tracks(replace(wave(5), contacts={})).shape == (0, 2)
