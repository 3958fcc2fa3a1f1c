"""What the diagrams of aligning draw: the means, the best turn, and the distance at each angle."""

import numpy as np
import pytest

from mocap import datasets, resample
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
    return float(figure.axes[0].get_title().split(": ")[1].removesuffix(" cm RMS"))


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


def test_the_curve_over_a_turn_has_its_valley_at_the_closed_form(pair):
    a, b = (point_cloud(motion).reshape(-1, 3) for motion in pair)
    best = np.degrees(align(a, b).angle)
    curve, _ = diagrams.turning(*pair, degrees=180).axes[1].lines
    angles, lefts = curve.get_xydata().T
    assert abs(angles[lefts.argmin()] - best) <= 1.5
    _, dot = diagrams.turning(*pair, degrees=best).axes[1].lines
    assert dot.get_xydata()[0] == pytest.approx([best, lefts.min()], abs=0.1)
    rising = np.diff(np.roll(lefts[:-1], -lefts.argmin())) > 0
    assert np.count_nonzero(np.diff(rising)) == 1  # up to one highest point, then down


@pytest.mark.parametrize("degrees", [-60, 100])
def test_the_curve_over_a_turn_ends_at_its_dot_and_its_axes_stay(pair, degrees):
    shown = diagrams.turning(*pair, degrees=degrees).axes[1]
    curve, dot = shown.lines
    assert curve.get_xydata()[-1] == pytest.approx(dot.get_xydata()[0])
    assert curve.get_xdata().max() == degrees
    whole = diagrams.turning(*pair, degrees=180).axes[1]
    assert (shown.get_xlim(), shown.get_ylim()) == (whole.get_xlim(), whole.get_ylim())
    assert shown.get_title().startswith(f"{degrees}°: ".replace("-", "−"))
