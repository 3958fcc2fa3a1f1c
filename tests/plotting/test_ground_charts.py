"""What lies on the ground is where it is, and x points to the left, as for somebody who looks along z."""

import numpy as np
import pytest
from matplotlib.patches import Circle

from mocap.datasets import sample
from mocap.plotting import asked_and_walked, draw_group_plan, ground_tracks, path_from_above
from mocap.plotting.style import SOURCES
from tests.strategies import wave


def test_a_path_from_above_is_not_mirrored():
    motion = wave(30)
    path, start = path_from_above(motion)
    assert np.transpose(path.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert path.axes.xaxis_inverted()
    path_from_above(motion, ax=path.axes)
    assert path.axes.xaxis_inverted()
    assert start.get_xdata() == pytest.approx(motion.root_positions[0, 0])


def test_the_path_asked_for_lies_under_the_path_walked():
    motion = wave(30)
    asked, walked, start = asked_and_walked([[0, 0], [0, 1], [1, 1]], motion)
    assert np.transpose(asked.get_data()).tolist() == [[0, 0], [0, 1], [1, 1]]
    assert np.transpose(walked.get_data()) == pytest.approx(motion.root_positions[:, [0, 2]])
    assert asked.get_zorder() <= walked.get_zorder()
    assert (asked.get_color(), walked.get_color()) == ("#000000", "#E69F00")
    assert start.get_ydata() == pytest.approx(motion.root_positions[0, 2])


def test_tracks_have_the_ways_and_the_facings():
    lines = ground_tracks([wave(90), walk := sample("walk_straight")[:240]])
    assert [line.get_color() for line in lines] == list(SOURCES[:2])
    assert lines[1].get_xdata() == pytest.approx(walk.root_positions[:, 0])
    ahead = np.diff(lines[1].axes.collections[-1].get_segments(), axis=1)[:, 0]
    assert np.hypot(*ahead.T) == pytest.approx(0.25)
    assert np.abs(np.degrees(np.arctan2(*ahead.T))).max() < 30


def test_a_plan_shows_every_member_every_point_and_every_obstacle():
    places = np.linspace(0, 6, 50)[:, None] + np.array([0j, 1.5j, -1.5j])
    figure = draw_group_plan(places, [6 + 0j, 9 + 1j], [(3 + 4j, 0.5)], near=0.8)
    (ax,) = figure.axes
    for line, way in zip(ax.lines, places.T, strict=True):
        np.testing.assert_allclose(line.get_xydata(), np.stack([way.imag, way.real], axis=1))
    assert sorted(p.radius for p in ax.patches if isinstance(p, Circle)) == [0.5, 0.8, 0.8]
    assert [text.get_text() for text in ax.texts] == ["1", "2"] and ax.xaxis_inverted()
    assert draw_group_plan(np.ones((5, 1), complex), ax=ax) is figure
    assert len(ax.lines) == 4 and ax.xaxis_inverted()
