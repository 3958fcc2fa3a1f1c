"""What the charts show, read back from their artists."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from mocap.methods.match_webs.match_search import Match
from mocap.plotting import joint_curve, match_tree, quartile_band, seen_beside_measured
from mocap.plotting.charts import box_chart
from mocap.plotting.style import ASTRAY, CURVES, QUIET, SOURCES

AT = np.arange(3.0)
FOUND = [
    Match(0, 0, 9, 0.0, -1, 0, AT, AT),
    Match(1, 0, 9, 0.01, 0, 1, AT, AT),
    Match(1, 20, 29, 0.02, 0, 1, AT, AT),
    Match(2, 0, 9, 0.01, 2, 2, AT, AT),
    Match(2, 30, 39, 0.01, 1, 2, AT, AT),
]


def colours_of(dots):
    return [tuple(colour) for colour in dots.get_facecolors()]


def test_a_joints_curve_is_in_seconds():
    values = np.arange(20.0).reshape(10, 2)
    curves = joint_curve(values, fps=10, labels=["x (m)", "y (m)"])
    assert [curve.get_ydata().tolist() for curve in curves] == values.T.tolist()
    assert curves[0].get_xdata() == pytest.approx(np.arange(10) / 10)
    (single,) = joint_curve(values[:, 0], fps=10, labels=["height (m)"])
    assert single.axes.get_ylabel() == "height (m)"


def test_a_band_reaches_from_quartile_to_quartile_about_the_median():
    samples = np.random.default_rng(0).gamma(2.0, size=(5, 41))
    median = quartile_band(range(5), samples, label="slide", colour="#112233")
    assert median.get_ydata() == pytest.approx(np.median(samples, axis=1))
    assert (median.get_label(), median.get_color()) == ("slide", "#112233")
    corners = median.axes.collections[0].get_paths()[0].vertices
    for x, row in enumerate(samples):
        heights = corners[corners[:, 0] == x, 1]
        assert (heights.min(), heights.max()) == pytest.approx(tuple(np.percentile(row, [25, 75])))
    assert quartile_band([0, 1], np.ones((2, 3)), ax=median.axes).axes is median.axes


def test_what_is_seen_stands_above_what_is_measured():
    points = [[10, 0.9, 0.0, 1.9], [20, -0.2, -1.1, 0.8], [30, 2.8, 1.4, np.inf]]
    upper, lower = seen_beside_measured(points, [10, 20], [[3, 4], [1, 2]], ("window (frames)", "jolt (m/s)"))
    guessing, curve = upper.lines
    assert not np.any(guessing.get_ydata())
    assert curve.get_ydata().tolist() == [0.9, -0.2, 2.8]
    ends = [segment[:, 1].tolist() for segment in upper.collections[0].get_segments()]
    assert ends == [[0.0, 1.9], [-1.1, 0.8], [1.4, 9.0]]  # without an upper limit the line leaves the picture
    assert upper.get_ylim()[1] < 9
    assert (lower.get_xlabel(), lower.get_ylabel()) == ("window (frames)", "measured: jolt (m/s)")
    assert lower.lines[0].get_ydata().tolist() == [3.5, 1.5]


def test_good_bad_and_other_targets_have_their_colours():
    ax = box_chart([-40, 0, 40], [2.0, 3.5, 9], (-60, 10), limits=(3, 4))
    (dots,), (box,) = ax.collections, ax.patches
    assert colours_of(dots) == [to_rgba(colour) for colour in (CURVES[0], QUIET, ASTRAY)]
    np.testing.assert_allclose(dots.get_offsets(), [[-40, 2], [0, 3.5], [40, 9]])
    assert box.get_x() == -60 and box.get_width() == 70
    assert [text.get_text() for text in ax.texts] == ["T_GOOD", "T_BAD"]


def test_each_match_stands_at_its_step_linked_with_what_found_it():
    ax = match_tree(
        FOUND, ["walk", "walk", "run", "run", "walk"], wrong=[False] * 3 + [True, False], order=[]
    )
    links, matches, wrong = ax.collections
    places = np.asarray(matches.get_offsets())
    assert places[:, 0].tolist() == [0, 1, 1, 2, 2]
    assert places[3, 1] > places[4, 1]  # no two links cross
    assert len({tuple(place) for place in places.tolist()}) == len(FOUND)
    assert links.get_segments()[2].tolist() == places[[2, 3]].tolist()
    assert np.asarray(wrong.get_offsets()).tolist() == [places[3].tolist()]
    assert tuple(wrong.get_edgecolor()[0]) == to_rgba(ASTRAY)
    assert [colours_of(matches)[n] for n in (0, 2)] == [to_rgba(c) for c in SOURCES[:2]]


def test_a_kind_keeps_its_colour_and_a_query_alone_is_a_tree():
    few = match_tree(FOUND[:2], ["run", "run"], wrong=[False] * 2, order=["walk", "run"]).collections[1]
    assert colours_of(few)[0] == to_rgba(SOURCES[1])
    alone = match_tree(FOUND[:1], ["walk"], wrong=[False], order=[])
    assert len(alone.collections[0].get_segments()) == 0
