"""Acclaim skeletons and motions, against kinematics by hand straight from the files' own numbers."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocap.body.kinematics import joint_positions
from mocap.errors import FormatError
from mocap.files import load_save
from mocap.files.asf import read_skeleton
from tests.files.acclaim_clips import AMC, ASF, read_clip
from tests.refusals import refused, refused_texts


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


BROKEN_ASF = [
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
]
test_a_broken_asf_is_refused_at_its_line = refused_texts(
    read_skeleton,
    "a.asf",
    *((ASF.replace(old, new, 1), said) for old, new, said in BROKEN_ASF),
    (ASF.replace("hip", "arm_end"), "a.asf: expected bones whose ends have new names"),
    kind=FormatError,
)


def where(motion, frame):
    return dict(zip(motion.skeleton.names, joint_positions(motion)[frame].round(9) + 0.0, strict=True))


def close(points, expected):
    return all(np.allclose(points[name], expected[name], atol=1e-8) for name in expected)


def test_positions_worked_out_by_hand(write):
    motion = read_clip(write)
    assert (len(motion), motion.fps, motion.name) == (2, 120.0, "a")
    ends = {"thigh": [0, 4, 0], "thigh_end": [0, 2, 0], "arm": [0, 5, 0], "arm_end": [1, 5, 0]}
    rest = {"root": [0, 5, 0], **ends}
    assert close(where(motion, 0), rest)
    # The thigh's own x axis points along +y (its axis is z by 90°): 90° about y leaves -y as it is.
    # The arm: 90° about z takes +x to +y, where 90° about y does nothing. The root: 90° about y, moved by x.
    ends = {"thigh": [1, 4, 0], "thigh_end": [1, 2, 0], "arm_end": [1, 6, 0]}
    assert close(where(motion, 1), {"root": [1, 5, 0], **ends})


def test_units(write):
    metres, inches = (read_clip(write, ASF.replace("0.0254", length)) for length in ("0.0254", "1"))
    assert np.allclose(joint_positions(inches), 0.0254 * joint_positions(metres))
    asf = read_skeleton(write("a.asf", ASF), scale=0.5)
    assert np.allclose(asf.skeleton.offsets[3], [0, -1, 0])
    bare = ASF.replace("  length 0.0254   # so that a unit is a metre\n", "")
    assert np.allclose(joint_positions(read_clip(write, bare)), joint_positions(inches))


def test_degrees_and_radians(write):
    expected = read_clip(write).rotations
    radians = AMC.replace("90", repr(math.pi / 2))
    in_radians = ASF.replace("angle deg", "angle rad").replace("0 0 90 XYZ", f"0 0 {math.pi / 2!r} XYZ")
    for asf, text in [
        (ASF, radians.replace(":DEGREES", ":RADIANS")),
        (in_radians, AMC),
        (in_radians, radians.replace(":DEGREES\n", "")),
        (in_radians.replace("rad\n", "Radians\n"), AMC),
        (ASF.replace("angle deg", "angle degrees"), AMC),
        (ASF, AMC.replace(":DEGREES\n", "")),
    ]:
        assert np.allclose(read_clip(write, asf, text).rotations, expected)
        angles = load_save.read_angles(write("a.amc", text), skeleton=write("a.asf", asf))
        assert np.allclose(angles["arm"], [[0, 0], [90, 90]])


OTHERWISE = [
    lambda asf, text: (asf.replace("\n", "\r\n"), text.replace("\n", "\r\n")),
    lambda asf, text: (asf.replace(" ", "\t"), text.replace(" ", "\t  ")),
    lambda asf, text: (asf, "1\n" + text.split("1\n", 1)[1]),
    lambda asf, text: (asf, text.rstrip()),
    lambda asf, text: (asf, text.replace("root", "\n# here\nroot").replace("arm 90 90", "arm 90 90 # up")),
    lambda asf, text: (asf, text.replace("\n1\n", "\n1 # first\n")),
    lambda asf, text: (asf, text.replace("thigh 90 0\narm 90 90", "arm 90 90\nthigh 90 0")),
    lambda asf, text: (asf, text.replace("90", "9.0e+001")),
    lambda asf, text: (asf, text.replace("\n1\n", "\n41\n").replace("\n2\n", "\n42\n")),
    lambda asf, text: (asf.replace("0 0 90 XYZ", "-7.6e-016, 0 90   xyz"), text),
    lambda asf, text: (asf.replace(":hierarchy", ":namespace x\n:hierarchy"), text),
    lambda asf, text: (asf.replace("TX TY TZ RX RY RZ", "rx ry rz tz ty tx"), flipped(text)),
]


@pytest.mark.parametrize("change", OTHERWISE)
def test_the_same_motion_written_otherwise(write, change):
    expected = read_clip(write)
    motion = read_clip(write, *change(ASF, AMC))
    assert np.allclose(motion.rotations, expected.rotations, atol=1e-12)
    assert np.allclose(motion.root_positions, expected.root_positions)


def flipped(text):
    text = text.replace("root 0 5 0 0 0 0", "root 0 0 0 0 5 0")
    return text.replace("root 1 5 0 0 90 0", "root 0 90 0 0 5 1")


def test_the_root_at_rest_offsets_the_motion(write):
    asf = ASF.replace("position 0 0 0", "position 0 0 2").replace("orientation 0 0 0", "orientation 90 0 0")
    points = where(read_clip(write, asf), 0)
    ends = {"thigh": [0, 5, 1], "thigh_end": [0, 5, -1], "arm_end": [1, 5, 2]}
    assert close(points, {"root": [0, 5, 2], **ends})


def test_bones_that_would_stretch_are_refused(write):
    asf = ASF.replace("dof rz ry", "dof rz l")
    assert len(read_clip(write, asf, AMC.replace("arm 90 90", "arm 90 0"))) == 2
    keeps = "0 for 'l' of 'arm', since bones keep their lengths, got 90 in frame 1"
    refused(keeps, read_clip, write, asf, kind=FormatError)


BROKEN_AMC = [
    (
        "thigh 90 0",
        "thigh 90",
        "line 10: expected 2 numbers for 'thigh' .rx rz. after 1 complete frames, got 1",
    ),
    ("thigh 90 0", "thigh 90 0 0", "line 10: expected 2 numbers .*got 3"),
    ("thigh 90 0", "thigh 90 x", "line 10: .*got 'x' as number 2"),
    ("thigh 90 0", "thigh 90 nan", "line 10: .*got 'nan' as number 2"),
    ("thigh 90 0", "knee 90 0", "line 10: expected another bone of the skeleton, got 'knee'"),
    ("thigh 90 0", "arm 90 0", "line 11: expected another bone of the skeleton, got 'arm'"),
    ("thigh 90 0", "hip 1", "line 10: expected 0 numbers for 'hip'"),
    ("arm 90 90\n", "", "line 10: expected numbers for arm, got the end of the frame after 1 complete"),
    ("arm 90 90\n", "arm 9", "line 11: expected 2 numbers for 'arm' .*after 1 complete frames, got 1"),
    ("\n2\n", "\n3\n", "line 8: expected frame 2, got frame 3"),
    ("\n1\n", "\n", "line 4: expected the number of the first frame, got 'root"),
    ("\n1\n", "\n<<<<<<< HEAD\n1\n", "line 4: .*unresolved merge"),
    ("arm 90 90", "=======", "line 11: .*'======='"),
]


@pytest.mark.parametrize(("old", "new", "message"), BROKEN_AMC)
def test_a_broken_amc_is_refused_at_its_line(write, old, new, message):
    assert old in AMC
    refused(message, read_clip, write, amc_text=AMC.replace(old, new), kind=FormatError)


@pytest.mark.parametrize("text", [":DEGREES\n", "# only this\n"])
def test_an_empty_clip_is_refused(write, text):
    refused("expected frames, got none", read_clip, write, amc_text=text, kind=FormatError)


def test_a_comment_may_tell_the_rate(write):
    assert read_clip(write, amc_text=f"# fps 29.97\n{AMC}").fps == 29.97
    assert read_clip(write, amc_text=f"# fps 29.97\n{AMC}", fps=60.0).fps == 60.0
    assert read_clip(write, amc_text=f"# fps are many\n{AMC}", fps=60.0).fps == 60.0
    for wrong in ("0", "-1", "nan"):
        with pytest.raises(FormatError, match="line 1: expected frames per second, above 0"):
            read_clip(write, amc_text=f"# fps {wrong}\n{AMC}")


@pytest.mark.parametrize("axes", ["XYZ", "ZYX", "YZX", "XZY", "ZXY", "YXZ"])
def test_any_order_of_axes_agrees_with_kinematics_by_hand(write, axes):
    """Turns about fixed axes, the first one first: the root's, then the thigh's between its axis and back."""
    asf = ASF.replace("0 0 90 XYZ", f"20 -130 70 {axes}")
    text = AMC.replace("thigh 90 0", "thigh 33 -71").replace("root 1 5 0 0 90 0", "root 1 5 2 -40 110 25")
    turned = {"X": 20, "Y": -130, "Z": 70}
    root, axis, thigh = (
        Rotation.from_euler(order.lower(), angles, degrees=True)
        for order, angles in (("xyz", [-40, 110, 25]), (axes, [turned[a] for a in axes]), ("xz", [33, -71]))
    )
    hip = np.add([1, 5, 2], root.apply([0, -1, 0]))
    ends = {"thigh": hip, "thigh_end": hip + (root * axis * thigh * axis.inv()).apply([0, -2, 0])}
    assert close(where(read_clip(write, asf, text), 1), ends)
