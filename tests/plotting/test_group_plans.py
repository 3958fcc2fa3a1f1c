"""The plan shows every member, every point and every obstacle."""

import numpy as np
import pytest
from matplotlib.patches import Circle

from mocap.plotting.group_plans import draw_group_plan


def test_all_are_drawn_where_they_are():
    places = np.linspace(0, 6, 50)[:, None] + np.array([0j, 1.5j, -1.5j])
    figure = draw_group_plan(places, [6 + 0j, 9 + 1j], [(3 + 4j, 0.5)], near=0.8)
    (ax,) = figure.axes
    for line, way in zip(ax.lines, places.T, strict=True):
        np.testing.assert_allclose(line.get_xdata(), way.imag)
        np.testing.assert_allclose(line.get_ydata(), way.real)
    discs = [patch for patch in ax.patches if isinstance(patch, Circle)]
    assert sorted(disc.radius for disc in discs) == [0.5, 0.8, 0.8]
    assert [text.get_text() for text in ax.texts] == ["1", "2"]
    left, right = ax.get_xlim()
    assert left > right  # x points to the left, as for somebody who looks along z


def test_it_can_be_drawn_on_other_axes():
    figure = draw_group_plan(np.zeros((5, 2), complex) + 1j)
    again = draw_group_plan(np.ones((5, 1), complex), ax=figure.axes[0])
    assert again is figure and len(figure.axes[0].lines) == pytest.approx(3)
