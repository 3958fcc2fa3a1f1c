"""What the diagrams of quaternions show, read back from their artists."""

import numpy as np
import pytest

from mocap import datasets
from mocap.body.rotations import multiply
from mocap.course.diagrams import quaternions


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


def test_two_orders_of_the_same_turns_end_in_two_poses():
    figure = quaternions.turns_in_order(datasets.sample("walk_straight").skeleton, multiply)
    heads = [np.ravel(ax.lines[0].get_data_3d()) for ax in figure.axes]  # matplotlib's order: z, x, y
    assert len(heads) == 6
    assert heads[0] == pytest.approx(heads[3])
    assert heads[2][1] > 0.4  # face down, the head towards x
    assert heads[5][0] > 0.4  # on its side, the head towards z
