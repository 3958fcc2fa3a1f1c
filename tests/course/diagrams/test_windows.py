"""What diagrams compute, and what they refuse; test_drawn.py holds what they draw."""

import numpy as np
import pytest

from mocap.body import GroundPath
from mocap.course import diagrams
from mocap.course.diagrams.ground import nearest_points
from tests.refusals import refusals

test_windows_that_do_not_fit_are_refused = refusals(
    (
        r"Windows of 4 frames do not fit into an array of shape \(3, 3\)",
        lambda: diagrams.diagonal_sums(np.ones((3, 3)), window=4, step=1),
    )
)


def test_the_nearest_point_is_the_nearest():
    corner, points = GroundPath([[0, 0], [0, 3], [3, 3]]), np.random.default_rng(0).uniform(-1, 4, (50, 2))
    found = np.hypot(*(points - nearest_points(corner, points)).T)
    truth = np.hypot(*(points[:, None] - corner.resampled(0.001).points).transpose(2, 0, 1)).min(axis=1)
    assert found == pytest.approx(truth, abs=0.005)
