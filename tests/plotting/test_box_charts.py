"""Pictures of parametric motion graphs show the numbers that they are given."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_rgba

from mocap.plotting import box_chart, boxes_image
from mocap.plotting.style import ASTRAY, CURVES, QUIET


def test_good_bad_and_other_targets_have_their_colours():
    drawn = box_chart([-40, 0, 40], [2.0, 3.5, 9], (-60, 10), limits=(3, 4))
    wanted = [to_rgba(colour) for colour in (CURVES[0], QUIET, ASTRAY)]
    np.testing.assert_allclose(drawn.targets.get_facecolors(), wanted)
    np.testing.assert_allclose(drawn.targets.get_offsets(), [[-40, 2], [0, 3.5], [40, 9]])
    assert drawn.box.get_x() == -60 and drawn.box.get_width() == 70
    labels = [text.get_text() for text in drawn.targets.axes.texts]
    assert labels == ["T_GOOD", "T_BAD"]


def test_boxes_lie_over_the_costs_of_all_pairs():
    costs = np.arange(12.0).reshape(3, 4)
    ax = plt.figure().add_subplot()
    drawn = boxes_image(costs, (-60, 60), [[-60, -10], [-30, 30], [5, 60]], ax=ax)
    np.testing.assert_array_equal(drawn.costs.get_array(), costs.T)
    assert drawn.sides[0].get_xdata().tolist() == [-60, 0, 60]
    assert drawn.sides[0].get_ydata().tolist() == [-60, -30, 5]
