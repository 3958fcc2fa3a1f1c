"""The product and the tree find the frame that a plain loop finds; the future is what the springs say."""

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.methods.motion_matching.frame_features import FUTURE, features
from mocap.methods.motion_matching.nearest_frames import FrameSearch, Wants, foresee, next_frame
from tests.methods.motion_matching.matched import walks


def queries(count, seed=0):
    """Real poses with other futures: what a character asks."""
    table, random = walks(), np.random.default_rng(seed)
    rows = table.values[random.integers(0, len(table), count)].copy()
    rows[:, FUTURE] = table.values[random.integers(0, len(table), count)][:, FUTURE]
    return rows


@pytest.mark.parametrize("future", [1.0, 0.25])
def test_product_and_tree_find_what_a_loop_finds(future):
    table = walks()
    product, tree = (FrameSearch(table, future=future, tree=kind) for kind in (False, True))
    weigh = np.ones(27)
    weigh[FUTURE] = future
    for number, query in enumerate(queries(60)):
        now, near = 37 * number, 6
        best = min(
            (frame for frame in np.flatnonzero(table.usable) if abs(frame - now) >= near),
            key=lambda frame: (((query - table.values[frame]) * weigh) ** 2).sum(),
        )
        cost = (((query - table.values[best]) * weigh) ** 2).sum()
        for search in (product, tree):
            found, paid = search.nearest(query, now, near)
            assert paid == pytest.approx(cost, rel=1e-4)  # 32 bits may take a twin
            assert search.cost(query, found) == pytest.approx(paid)
            assert abs(found - now) >= near and table.usable[found]


def test_frames_near_now_are_not_found():
    table = walks()
    search = FrameSearch(table)
    assert search.nearest(table.values[200], now=200, near=0)[0] == 200
    assert abs(search.nearest(table.values[200], now=200, near=6)[0] - 200) >= 6


@pytest.mark.parametrize("tree", [False, True])
def test_where_all_frames_are_near_none_is_found_and_the_character_plays_on(tree):
    table = walks()
    among = np.zeros(len(table), bool)
    among[100:104] = True
    search = FrameSearch(table, among=among, tree=tree)
    assert search.nearest(table.values[50], now=102, near=6) == (-1, np.inf)
    assert next_frame(search, table.values[50], 102, near=6, staying=5.0) == 102


def test_it_plays_on_unless_another_frame_is_better():
    table = walks()
    search, query = FrameSearch(table), queries(1)[0]
    found, cost = search.nearest(query, 0, 6)
    assert next_frame(search, query, 0, near=6, staying=cost + 1e-6) == found
    assert next_frame(search, query, 0, near=6, staying=cost) == 0
    assert next_frame(search, query, 0, near=6, staying=np.inf) == found


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


@pytest.mark.parametrize("name", ["every", "halflife", "fade"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_times_are_above_0(name, value):
    with pytest.raises(MocapError, match=f"'{name}' is a number of seconds above 0"):
        Wants(**{name: value}).check()


@pytest.mark.parametrize("name", ["future", "bonus", "near"])
def test_weights_are_not_negative(name):
    with pytest.raises(MocapError, match=f"'{name}' is a number from 0 on, got -1"):
        Wants(**{name: -1}).check()


def test_a_search_among_no_frames_is_refused():
    with pytest.raises(MocapError, match="No frame of these clips can be found"):
        FrameSearch(walks(), among=np.zeros(len(walks()), bool))
