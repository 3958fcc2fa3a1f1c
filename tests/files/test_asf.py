"""The skeleton of Acclaim files, and what is wrong with some of them."""

import math

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.files.asf import read_skeleton
from tests.files.acclaim_clips import ASF


def test_joints_sit_where_bones_start(write):
    skeleton = read_skeleton(write("a.asf", ASF)).skeleton
    assert skeleton.names == ("root", "hip", "thigh", "thigh_end", "arm", "arm_end")
    assert skeleton.parents.tolist() == [-1, 0, 1, 2, 0, 4]
    offsets = [[0, 0, 0], [0, 0, 0], [0, -1, 0], [0, -2, 0], [0, 0, 0], [1, 0, 0]]
    assert np.allclose(skeleton.offsets, offsets)


def test_joints_remember_how_their_file_tells_angles(write):
    skeleton = read_skeleton(write("a.asf", ASF)).skeleton
    assert skeleton.dofs == ("xyz", "", "xz", "", "zy", "")
    half = math.sqrt(0.5)
    assert np.allclose(skeleton.axes[2], [half, 0, 0, half])
    assert np.allclose(skeleton.axes[[0, 1, 3, 4, 5]], [1, 0, 0, 0])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("dof rz ry", "dof rz rq", "line 47: expected some of rx ry rz"),
        ("dof rz ry", "dof rz rz", "each once"),
        ("0 0 90 XYZ", "0 0 90 XXZ", "line 28: expected an order of axes"),
        ("0 0 90 XYZ", "0 90 XYZ", "line 28: expected 3 numbers for 'axis'"),
        ("length 2", "length two", "line 27: expected 1 number for 'length'"),
        ("     length 2\n", "", "line 23: expected a 'length' line"),
        ("name thigh", "name hip", "line 25: expected a new bone's name"),
        ("length 0.0254", "length 0", "line 6: expected a length of"),
        ("angle deg", "angle grad", "line 7: expected angle deg or rad"),
        (":hierarchy", ":bonedata", "line 49: expected one :bonedata section"),
        (":hierarchy\n", ":hierarchie\n", "expected a :hierarchy section"),
        ("hip thigh", "hip shin", "expected bones of :bonedata"),
        ("hip thigh", "hip arm", "expected bones of :bonedata"),
        ("hip thigh", "hip root", "expected bones of :bonedata"),
        ("hip thigh", "shin thigh", "expected bones of :bonedata"),
        ("root hip arm", "", "expected bones below 'root'"),
        ("  end\n:hierarchy", ":hierarchy", "line 41: expected 'end' to this 'begin'"),
        ("order TX TY TZ RX RY RZ", "", "expected a 'order' line"),
        ("# a leg", "a leg", "line 1: expected a section"),
    ],
)
def test_a_broken_asf_is_refused_at_its_line(write, old, new, message):
    assert old in ASF
    with pytest.raises(FormatError, match=message):
        read_skeleton(write("a.asf", ASF.replace(old, new, 1)))


def test_a_bone_named_as_the_end_of_another_is_refused(write):
    with pytest.raises(FormatError, match=r"a.asf: expected bones whose ends have new names"):
        read_skeleton(write("a.asf", ASF.replace("hip", "arm_end")))
