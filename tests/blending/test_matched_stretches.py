"""Stretches drawn around matches: their middles agree, and each draw is the same."""

import numpy as np

from mocap.blending import draw_stretches
from mocap.datasets import sample
from mocap.matching import point_cloud
from tests.refusals import refused

CLIPS = [sample(name)[:480] for name in ("walk_curve_1", "walk_curve_2")]
HOW = {"window": 40, "below": 0.05, "reach": 70}


def test_the_middles_match_and_the_second_is_aligned():
    pairs = draw_stretches(CLIPS, 4, **HOW)
    for a, b in pairs:
        assert len(a) == len(b) == 140
        assert {a.name, b.name} == {clip.name for clip in CLIPS}
        gap = point_cloud(a[50:90]) - point_cloud(b[50:90])
        assert np.sqrt((gap**2).sum(-1).mean()) < 0.05


def test_pairs_are_different_and_the_same_in_each_call():
    first, second = draw_stretches(CLIPS, 4, **HOW), draw_stretches(CLIPS, 4, **HOW)
    starts = [(a.root_positions[0].tolist(), b.root_positions[0].tolist()) for a, b in first]
    assert starts == [(a.root_positions[0].tolist(), b.root_positions[0].tolist()) for a, b in second]
    assert len({str(start) for start in starts}) == 4


def test_too_few_matches_are_an_error():
    refused(r"^\d+ matches have 70 frames before .* 9999 were asked for", draw_stretches, CLIPS, 9999, **HOW)
