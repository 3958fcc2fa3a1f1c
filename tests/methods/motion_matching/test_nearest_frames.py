"""The product finds the frame that a plain loop finds; the future is what the springs say."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.methods.motion_matching.nearest_frames import FrameSearch, foresee
from mocap.methods.motion_matching.pose_database import FUTURE, features
from tests.methods.motion_matching.matched import walks
from tests.refusals import refused


def queries(count, seed=0):
    """Real poses with other futures: what a character asks."""
    table, random = walks(), np.random.default_rng(seed)
    rows = table.values[random.integers(0, len(table), count)].copy()
    rows[:, FUTURE] = table.values[random.integers(0, len(table), count)][:, FUTURE]
    return rows


@pytest.mark.parametrize("future", [1.0, 0.25])
def test_the_product_finds_what_a_loop_finds(future):
    table, weigh = walks(), np.ones(27)
    search = FrameSearch(table, future=future)
    weigh[FUTURE] = future
    for number, query in enumerate(queries(30)):
        now, near = 37 * number, 6
        costs = (((query - table.values) * weigh) ** 2).sum(axis=1)
        costs[~table.usable | (np.abs(np.arange(len(table)) - now) < near)] = np.inf
        found, paid = search.nearest(query, now, near)
        assert paid == pytest.approx(costs.min(), rel=1e-4)  # 32 bits may take a twin
        assert search.cost(query, found) == paid == pytest.approx(costs[found])


def test_frames_near_now_are_not_found_and_where_all_are_near_none_is():
    table = walks()
    few = replace(table, usable=np.isin(np.arange(len(table)), range(100, 104)))
    assert FrameSearch(table).nearest(table.values[200], now=200, near=0)[0] == 200
    assert abs(FrameSearch(table).nearest(table.values[200], now=200, near=6)[0] - 200) >= 6
    assert FrameSearch(few).nearest(table.values[50], now=102, near=6) == (102, np.inf)


def test_to_go_on_as_the_clip_does_is_to_foresee_its_future():
    """Walking straight at one speed, the springs and the clip agree on the next second to 5 cm."""
    table = walks()
    start = sum(len(clip) for clip in table.clips[:3])
    now = start + 100
    goal = complex(table.drift[now] * np.exp(-1j * table.heading[now]))
    ahead = foresee(table, now, goal, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    np.testing.assert_allclose(ahead[:6], features(table.clips[3])[100, 15:21], atol=0.05)


def test_told_to_stop_it_keeps_facing_as_it_does():
    table = walks()
    ahead = foresee(table, 100, 0j, 0.27) * table.scale[FUTURE] + table.mean[FUTURE]
    assert np.hypot(*ahead[4:6]) < 0.4 and ahead[11] > 0.9


def test_a_search_among_no_frames_is_refused():
    table = replace(walks(), usable=np.zeros(len(walks()), bool))
    refused("No frame '' can be found", FrameSearch, table)
