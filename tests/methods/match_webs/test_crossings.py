import numpy as np
import pytest

from mocap.methods.match_webs.crossings import crossings


def test_a_path_serves_a_query_in_either_of_its_clips(bundled):
    """Ask for the rows of a path: its columns. Ask for its columns: its rows."""
    web = bundled.web
    firsts, lasts = web.ends
    for number in range(0, len(web), 37):
        cells, costs = web.path(number)
        for side in (0, 1):
            start, stop = firsts[number, side], lasts[number, side] + 1
            there = [
                crossing
                for crossing in crossings(web, start, stop, web.below)
                if crossing.start == cells[0, 1 - side] and crossing.stop == cells[-1, 1 - side] + 1
            ]
            assert any(crossing.cost == pytest.approx(float(costs.mean()), abs=1e-5) for crossing in there)


def test_what_a_path_does_not_cover_is_carried_on_straight_but_not_beyond_the_clip(bundled):
    web = bundled.web
    for start in range(20, 250, 23):
        for crossing in crossings(web, start, start + 30, web.below):
            clip = web.clip_at(crossing.start)
            assert web.starts[clip] <= crossing.start < crossing.stop <= web.starts[clip + 1]
            assert crossing.own[-1] - crossing.own[0] + 1 >= 0.9 * 30
            assert crossing.cost <= web.below
            assert len(crossing.own) == len(crossing.other) == len(set(crossing.own))
            assert (np.diff(crossing.other) >= 0).all()
            if crossing.start > web.starts[clip]:
                assert abs(crossing.start - (crossing.other[0] - (crossing.own[0] - start))) <= 1
