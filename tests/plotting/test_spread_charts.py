"""Bands hold the middle half of their samples; rows show each step of each walk."""

import numpy as np
import pytest

from mocap.plotting.spread_charts import quartile_band, seen_beside_measured, walk_rows


def test_a_band_reaches_from_quartile_to_quartile_about_the_median():
    samples = np.random.default_rng(0).gamma(2.0, size=(5, 41))
    median, quartiles = quartile_band(range(5), samples, label="slide", colour="#112233")
    assert median.get_ydata() == pytest.approx(np.median(samples, axis=1))
    assert median.get_label() == "slide"
    assert median.get_color() == "#112233"
    corners = quartiles.get_paths()[0].vertices
    for x, row in enumerate(samples):
        heights = corners[corners[:, 0] == x, 1]
        assert (heights.min(), heights.max()) == pytest.approx(tuple(np.percentile(row, [25, 75])))


def test_bands_share_axes():
    first = quartile_band([0, 1], np.ones((2, 3))).median
    second = quartile_band([0, 1], np.ones((2, 3)), ax=first.axes)
    assert second.median.axes is first.axes
    assert second.quartiles.axes is first.axes


def test_rows_show_transitions_by_cost_and_nothing_after_the_end():
    costs = np.array([[0.0, 150.0, np.nan], [300.0, 0.0, 0.0]])
    image = walk_rows(costs, highest=400.0)
    steps, transitions = image.axes.images
    assert steps.get_array().mask.tolist() == np.isnan(costs).tolist()
    assert transitions is image
    assert image.get_array().compressed().tolist() == [150.0, 300.0]
    assert image.get_clim() == (0, 400.0)
    assert image.axes.get_xlabel() == "step of the walk"


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
