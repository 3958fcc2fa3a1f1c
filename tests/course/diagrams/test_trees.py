"""The pose that grows joint by joint, read back from its artists."""

import numpy as np
import pytest

from mocap import datasets
from mocap.body.kinematics import joint_positions
from mocap.course.diagrams import down_the_tree

WALK = datasets.sample("walk_straight")[100:120]


@pytest.mark.parametrize("joint", [0, 5, 37])
def test_the_joints_up_to_one_stand_where_the_package_puts_them(joint):
    code, ax = down_the_tree(WALK, 7)(joint)[0].figure.axes
    (dots,) = [line for line in ax.lines if line.get_linestyle() == "None" and line.get_markersize() == 4]
    across_and_up = joint_positions(WALK)[7, : joint + 1][:, [2, 1]]
    assert np.transpose(dots.get_data()) == pytest.approx(across_and_up)
    (bones,) = ax.collections
    assert (len(bones.get_segments()) > 0) == (joint > 0)
    ((low, high),) = [patch.get_bbox().intervaly for patch in code.patches]
    marked = [text.get_text().strip() for text in code.texts if low < text.get_position()[1] < high]
    assert marked[0].startswith("parent =" if joint else "places, turns =")
    assert len(marked) == (4 if joint else 1)  # the loop's second line stands on two
