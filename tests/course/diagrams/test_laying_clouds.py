"""What the diagrams of aligning draw: the means, the best turn, and the distance at each angle."""

import numpy as np
import pytest

from mocap import datasets, resample
from mocap.body import PlanarTransform
from mocap.course import diagrams
from mocap.matching import align, point_cloud


@pytest.fixture(scope="module")
def pair():
    first = resample(datasets.sample("walk_curve_1"), 30)[50:60]
    second = resample(datasets.sample("walk_curve_2"), 30)[20:30]
    return first, second


def means(figure):
    marks = [line.get_xydata() for line in figure.axes[0].lines if line.get_marker() == "P"]
    return np.array([places[0] for places in marks if len(places)])


def left(figure):
    return float(figure.axes[0].get_title().rpartition(": ")[2].removesuffix(" cm RMS"))


def test_the_steps_show_means_centring_angle_and_shift(pair):
    figures = [diagrams.laying_on(*pair, step=step) for step in (1, 2, 3, 4)]
    own = [point_cloud(motion).mean(axis=(0, 1))[[0, 2]] for motion in pair]
    assert means(figures[0]) == pytest.approx(np.array(own))
    for figure in figures[1:3]:
        assert means(figure) == pytest.approx(np.zeros((2, 2)), abs=1e-9)
    assert means(figures[3]) == pytest.approx(np.array([own[0], own[0]]))


def test_what_is_left_in_the_end_is_what_align_leaves(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    best = 100 * np.sqrt(((a - align(a, b).apply_points(b)) ** 2).sum(-1).mean())
    lefts = [left(diagrams.laying_on(*pair, step=step)) for step in (1, 2, 3, 4)]
    assert lefts == sorted(lefts, reverse=True)
    assert lefts[2:] == pytest.approx([best, best], abs=0.05)


def test_the_curve_over_a_turn_has_one_valley_at_the_closed_form_and_the_dot_is_on_it(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    best = np.degrees(align(a, b).angle)

    def fitted(points, angle):
        turn = PlanarTransform(angle, 0.0, 0.0)
        return turn.apply_points(points) + (a.mean(0) - turn.apply_points(b).mean(0)) * [1, 0, 1]

    shown = diagrams.turning(*pair, fitted)(60)[0].figure
    curve, dot = shown.axes[1].lines
    angles, lefts = curve.get_xydata().T
    assert abs(angles[lefts.argmin()] - best) <= 3
    rising = np.diff(np.roll(lefts[:-1], -lefts.argmin())) > 0
    assert np.count_nonzero(np.diff(rising)) == 1  # up to one highest point, then down
    at, height = dot.get_xydata()[0]
    assert (at, height) == (60, lefts[angles == 60])
    assert shown.axes[0].get_title() == f"60°: {height:.1f} cm RMS"


def test_moved_by_hand_threads_and_the_distance_follow(pair):
    (ax,) = diagrams.laid(*pair, lambda points: points + np.array([0, 0, 3])).axes
    own = [point_cloud(motion).mean(axis=(0, 1))[[0, 2]] for motion in pair]
    assert means(ax.figure) == pytest.approx(np.array([own[0], own[1] + [0, 3]]))
    a, b = (point_cloud(motion) for motion in pair)
    assert left(ax.figure) == pytest.approx(
        100 * np.sqrt(((a - b - [0, 0, 3]) ** 2).sum(-1).mean()), abs=0.05
    )


def test_the_arrow_of_the_products_is_the_best_angle(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    (ax,) = diagrams.products(*pair).axes
    assert ax.get_title() == f"the sum leads at {np.degrees(align(a, b).angle):.0f}°".replace("-", "−")
