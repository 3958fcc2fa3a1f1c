"""What the diagrams of quaternions show, read back from their artists."""

import numpy as np
import pytest

from mocap import datasets
from mocap.course.diagrams import quaternions
from mocap.plotting.style import CURVES


def arrows(ax):
    return [complex(*text.xy) for text in ax.texts if getattr(text, "arrow_patch", None)]


@pytest.mark.parametrize("angle", [-170, 60])
def test_q_turns_by_a_half_and_q_bar_by_the_other_half_where_it_is_needed(angle):
    across, along = (arrows(ax) for ax in quaternions.half_turns(angle=angle).axes)
    half = np.exp(1j * np.radians(angle / 2))
    assert across == pytest.approx([0.8, 0.8 * half, 0.8 * half**2])
    assert along == pytest.approx([0.8j, 0.8j * half, 0.8j])


def test_the_numbers_above_are_those_of_the_products():
    text = quaternions.half_turns().get_suptitle()
    assert text.split("      ") == [
        "v = (0.00, 0.80, 0.00, 0.80)",
        "q v = (-0.40, 0.69, 0.40, 0.69)",
        "q v q̄ = (0.40, 0.69, 0.80)",
    ]


@pytest.mark.parametrize("step", [0, 1, 2])
def test_a_step_shows_one_product_more(step):
    figure = quaternions.half_turns(step)
    assert [len(arrows(ax)) for ax in figure.axes] == [step + 1, step + 1]
    assert figure.get_suptitle().count("=") == step + 1


def ways(ax):
    return {line.get_color(): line for line in ax.lines if line.get_linewidth() == 2.4}


@pytest.mark.parametrize(("angle", "short", "long"), [(300, -60, 300), (60, 60, -300), (500, 140, -220)])
def test_the_shorter_way_is_solid_and_leads_to_the_nearer_quaternion(angle, short, long):
    dial, circle = quaternions.double_cover(angle).axes
    for ax, share in ((dial, 1), (circle, 2)):
        texts = [text.get_text() for text in ax.texts]
        assert f"{short / share:+.0f}°" in texts
        assert f"{long / share:+.0f}°" in texts
        found = ways(ax)
        assert found[CURVES[0]].get_linestyle() == "-"
        assert found[CURVES[1]].get_linestyle() == "--"
    w, along = (line[-1] for line in ways(circle)[CURVES[0]].get_data())
    assert w > 0
    assert abs(np.degrees(np.arctan2(along, w)) * 2) == pytest.approx(abs(short))


def test_minus_q_lies_opposite_q():
    _, circle = quaternions.double_cover(100, step=1).axes
    points = {text.get_text(): complex(*text.get_position()) for text in circle.texts}
    assert points["q"] == pytest.approx(-points["−q"])
    assert not ways(circle)
    _, alone = quaternions.double_cover(100, step=0).axes
    assert [text.get_text() for text in alone.texts] == ["1", "q"]


@pytest.mark.parametrize("step", [0, 1, 2])
def test_two_orders_of_the_same_turns_end_in_two_poses(step):
    figure = quaternions.turns_in_order(datasets.sample("walk_straight").skeleton, step)
    assert len(figure.axes) == 2 * (step + 1)
    heads = [np.ravel(ax.lines[0].get_data_3d()) for ax in figure.axes]  # matplotlib's order: z, x, y
    first, second = heads[step], heads[-1]
    assert (np.abs(first - second).max() > 0.3) == (step > 0)
    if step == 2:
        assert first[1] > 0.4  # face down, the head towards x
        assert second[0] > 0.4  # on its side, the head towards z
