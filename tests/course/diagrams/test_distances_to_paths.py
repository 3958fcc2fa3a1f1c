"""Behind a corner that it cuts, a walk is on the path again, but not at the point of equal arc length."""

import numpy as np
import pytest

from mocap.body.ground_path import GroundPath, arcs
from mocap.course.diagrams.distances_to_paths import nearest_points, two_distances

CORNER = GroundPath([[0, 0], [0, 3], [3, 3]])
CUT = arcs((0, 0), 0.0, [(1.5, 0), (0.75 * np.pi, np.pi / 2), (1.5, 0)])  # a quarter circle of 1.5 m
SAVED = 6 - CUT.length


@pytest.mark.parametrize("step", [0, 4, 8])
def test_a_thread_of_each_kind_at_every_moment_so_far(step):
    ground, curves = two_distances(CORNER, CUT)(step)[0].figure.axes
    threads = [line.get_xydata().reshape(-1, 16, 2)[:, :15] for line in ground.lines[2:5:2]]
    assert [len(some) for some in threads] == [step + 1] * 2
    for moment, thread in enumerate(threads[0]):  # at equal arc length
        along = CUT.length * moment / 8
        assert thread[[0, -1]] == pytest.approx(np.vstack([CUT.at([along]), CORNER.at([along])]), abs=1e-9)
    assert curves.lines[0].get_xdata().max() == pytest.approx(CUT.length * step / 8, abs=1e-9)


def test_behind_the_corner_one_distance_is_zero_and_the_other_what_was_saved():
    figure = two_distances(CORNER, CUT)()[0].figure
    even, near = figure.axes[1].lines[:2]
    assert near.get_ydata()[-1] == pytest.approx(0, abs=0.1)
    assert even.get_ydata()[-1] == pytest.approx(100 * SAVED, abs=0.1)
    assert near.get_ydata().max() == pytest.approx(100 * 1.5 * (1 - np.sqrt(0.5)), abs=1)
    labels = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    assert labels == ["at equal arc length (Eq. 9)", "to the nearest point"]


def test_the_nearest_point_is_the_nearest():
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 4, (50, 2))
    fine = CORNER.resampled(0.001).points
    found = np.hypot(*(points - nearest_points(CORNER, points)).T)
    truth = np.hypot(*(points[:, None] - fine).transpose(2, 0, 1)).min(axis=1)
    assert found == pytest.approx(truth, abs=0.005)
