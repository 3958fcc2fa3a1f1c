"""The ground from above: what is drawn is what the transform does."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from mocap.body import PlanarTransform
from mocap.course.diagrams import alignment, compass
from mocap.datasets.samples import sample

CLIP = sample("walk_circle")
TARGET, MOVING = CLIP[:200], CLIP[400:600]
TRANSFORM = PlanarTransform(2.0, 1.5, -0.7)


def dots(ax):
    return [line.get_xydata()[0] for line in ax.lines if line.get_marker() == "o"]


@pytest.mark.parametrize("shift_first", [False, True])
def test_the_order_of_turn_and_shift_decides_on_the_place(shift_first):
    panels = alignment(TARGET, MOVING, TRANSFORM, shift_first=shift_first).axes
    turn, shift = PlanarTransform(TRANSFORM.angle, 0.0, 0.0), PlanarTransform(0.0, TRANSFORM.x, TRANSFORM.z)
    first, second = (shift, turn) if shift_first else (turn, shift)
    spot = MOVING.root_positions[0]
    wanted = [spot, first.apply_points(spot), second.apply_points(first.apply_points(spot))]
    assert [dots(ax)[0] for ax in panels] == [pytest.approx(TARGET.root_positions[-1, [0, 2]])] * 3
    assert all(ax.xaxis_inverted() for ax in panels)
    assert len(alignment(TARGET, MOVING, TRANSFORM, step=2).axes) == 2
    assert [dots(ax)[-1] for ax in panels] == [pytest.approx(point[[0, 2]]) for point in wanted]
    assert [("turned" in ax.get_title()) for ax in panels] == [False, not shift_first, shift_first]


def test_the_turn_leads_round_the_origin():
    way = next(line for line in alignment(TARGET, MOVING, TRANSFORM).axes[1].lines if line.get_ls() == "--")
    distances = np.linalg.norm(way.get_xydata(), axis=1)
    assert distances == pytest.approx(distances[0])


def arrows(ax):
    return [text.xy for text in ax.texts if not text.get_text()]


def test_a_heading_points_up_the_page_at_0_and_to_the_left_at_90():
    ax = Figure().add_subplot()
    compass({"ahead": 0.0, "left": np.pi / 2}, ax)
    assert arrows(ax) == [pytest.approx((0, 1), abs=1e-12), pytest.approx((-1, 0), abs=1e-12)]
    assert [text.get_text() for text in ax.texts if ":" in text.get_text()] == ["ahead: 0°", "left: 90°"]
