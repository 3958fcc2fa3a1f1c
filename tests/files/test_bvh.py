"""BVH files: small ones worked out by hand, round trips, and files that others wrote."""

import csv
import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mocap.body import Motion, Skeleton, euler, joint_positions, resample, rotations
from mocap.datasets import sample
from mocap.errors import FormatError, MocapWarning
from mocap.files import load_save
from tests.files.acclaim_clips import TEXTS
from tests.refusals import refused, refused_texts, unwarned
from tests.strategies import random_motion, seeds, wave

BVH = TEXTS["BVH"]


@pytest.fixture
def write(write):
    return partial(write, "a.bvh")


def where(motion, frame):
    return dict(zip(motion.skeleton.names, joint_positions(motion)[frame], strict=True))


def test_positions_worked_out_by_hand(write):
    motion = load_save.load(write(BVH))
    assert motion.skeleton.names == ("hips", "left leg", "left leg_end", "left leg_end2", "head")
    assert motion.skeleton.parents.tolist() == [-1, 0, 1, 1, 0]
    assert (len(motion), motion.fps, motion.name) == (2, 30.0, "a")
    points = where(motion, 0)
    assert np.allclose(points["hips"], [0, 1, 0])
    assert np.allclose(points["left leg_end2"], [0.1, 0.5, 0.2])
    # The leg's R = Rz Rx takes -y to -z, and that stays under z; +z to -y, and that to +x. Then the hips' Ry.
    points = where(motion, 1)
    assert np.allclose(points["left leg"], [0, 1, 0.4])
    assert np.allclose(points["left leg_end"], [-0.5, 1, 0.4])
    assert np.allclose(points["left leg_end2"], [-0.5, 1, 0.2])


def test_scale_and_fps(write):
    path = write(BVH)
    metres = load_save.load(path, scale=1.0, fps=24.0)
    assert metres.fps == 24.0
    assert np.allclose(joint_positions(metres), 100 * joint_positions(load_save.load(path)))


def in_frames(text, old, new):
    hierarchy, frames = text.split("MOTION")
    return f"{hierarchy}MOTION{frames.replace(old, new)}"


ROOT = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"


OTHERWISE = [
    lambda text: text.replace("\n", "\r\n"),
    lambda text: text.replace("\t", "  "),
    lambda text: text.rstrip(),
    lambda text: text.replace("\n{", " {").replace("}\n", "} \n\n"),
    lambda text: text.replace(" 90", " 9.0e+001").replace(": ", ":\t"),
    lambda text: text.replace("Frames: 2", "Frames : 2").replace("Frame Time", "frame  time"),
    lambda text: text.replace("100 50 0 0 90", "100 50\n0 0 90"),
    lambda text: text.replace("OFFSET 1 2 3", "OFFSET 0 0 0"),
    lambda text: (
        text.replace(ROOT, "CHANNELS 6 Zrotation Xrotation Yrotation Zposition Xposition Yposition")
        .replace("\n0 100 0 0 0 0 ", "\n0 0 0 0 0 100 ")
        .replace("\n0 100 50 0 0 90 ", "\n0 0 90 50 0 100 ")
    ),
    lambda text: in_frames(text.replace("3 Yrotation Zrotation Xrotation", "0"), " 0 0 0\n", "\n"),
    lambda text: in_frames(
        text.replace("OFFSET 0 40 0", "OFFSET 9 9 9").replace("3 Yr", "6 Xposition Yposition Zposition Yr"),
        " 0 0 0\n",
        " 0 40 0 0 0 0\n",
    ),
    lambda text: in_frames(
        text.replace("OFFSET 0 40 0", "OFFSET 0 9 0").replace("3 Yr", "4 Yposition Yr"),
        " 0 0 0\n",
        " 40 0 0 0\n",
    ),
]


@pytest.mark.parametrize("change", OTHERWISE)
def test_the_same_motion_written_otherwise(write, change):
    expected = load_save.load(write(BVH))
    motion = load_save.load(write(change(BVH)))
    expected.skeleton.require_same(motion.skeleton)
    assert motion.fps == expected.fps
    assert np.allclose(joint_positions(motion), joint_positions(expected), atol=1e-12)


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XY", "Z"])
def test_any_order_of_channels(write, order):
    names = " ".join(f"{axis}rotation" for axis in order)
    angles = dict(zip("XYZ", [20.0, -130.0, 70.0], strict=True))
    text = BVH.replace("3 Yrotation Zrotation Xrotation", f"{len(order)} {names}")
    numbers = " ".join(str(angles[axis]) for axis in order)
    motion = load_save.load(write(in_frames(text, " 0 0 0\n", f" {numbers}\n")))
    expected = np.eye(3)
    for axis in order:  # the first stands on the left
        expected = expected @ rotations.to_matrix(euler.from_euler(axis, [np.radians(angles[axis])]))
    head = motion.skeleton.index("head")
    assert np.allclose(rotations.to_matrix(motion.rotations[1, head]), expected)


RATES = {30.0: ["0.0333333", "0.033333", "0.033", repr(1 / 30)], 120.0: ["0.008333", "8.33333e-03"]}
RATES |= {60.0: ["0.01666", "0.016667"], 24.0: ["0.0416667"], 25.0: ["0.04"], 59.94: [repr(1 / 59.94)]}
RATES |= {2.5: ["0.4"], 0.1: ["10"], 100.0: ["0.01", "0.0100"], 62.0: ["0.016129"], 128.0: ["0.0078125"]}
RATES[30.0] += ["0.03333300", "0.033330"]


@pytest.mark.parametrize("fps", RATES)
def test_frame_rates(write, fps):
    for seconds in RATES[fps]:
        assert load_save.load(write(BVH.replace("0.0333333", seconds))).fps == pytest.approx(fps, rel=1e-12)


@pytest.mark.parametrize(("seconds", "fps"), [("0.008", 120), ("0.017", 60), ("0.016", 60), ("0.03", 30)])
def test_a_frame_time_of_few_digits_is_read_as_a_usual_rate_and_that_is_said(write, seconds, fps):
    path = write(BVH.replace("0.0333333", seconds))
    with pytest.warns(MocapWarning, match=f"{seconds} s has few digits: it is read as {fps} Hz"):
        assert load_save.load(path).fps == fps
    assert load_save.load(path, fps=125.0).fps == 125


@pytest.mark.parametrize("count", [0, 1, 3, 7])
def test_a_header_that_counts_other_frames_than_follow_is_corrected_and_that_is_said(write, count):
    expected = load_save.load(write(BVH))
    path = write(BVH.replace("Frames: 2", f"Frames: {count}"))
    with pytest.warns(MocapWarning, match=f"the header says {count} frames, and 2 whole ones follow"):
        motion = load_save.load(path)
    assert motion == expected


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "shift-jis"])
def test_files_in_other_encodings_are_the_same(tmp_path, encoding):
    text = BVH.replace("left leg", "左足").replace("\n", "\r\n")
    (tmp_path / "a.bvh").write_bytes(text.encode(encoding))
    motion = load_save.load(tmp_path / "a.bvh")
    assert "左足" in motion.skeleton.names
    (tmp_path / "a.bvh").write_text(text, "utf-8")
    assert motion == load_save.load(tmp_path / "a.bvh")


def test_the_end_of_a_file_of_dos_is_no_number(write):
    dos = BVH.replace("\n", "\r\n")
    assert load_save.load(write(f"{dos}\x1a")) == load_save.load(write(BVH))


def test_decimal_commas_are_read_as_points_and_that_is_said(write):
    with_points = BVH.replace(" 90", " 90.5").replace("OFFSET 10 0 0", "OFFSET 10.25 0 0")
    expected = load_save.load(write(with_points))
    with pytest.warns(MocapWarning, match="its numbers have decimal commas"):
        assert load_save.load(write(re.sub(r"(?<=\d)\.(?=\d)", ",", with_points))) == expected


COMMAS = {
    "comma and blank": lambda text: re.sub(r"(?m)(?<=\d) (?=[-\d])", ", ", text),
    "comma": lambda text: re.sub(r"(?m)(?<=\d) (?=[-\d])", ",", text),
    "semicolon": lambda text: re.sub(r"(?m)(?<=\d) (?=[-\d])", ";", text),
    "comma before the channels": lambda text: re.sub(r"(CHANNELS \d) (\w+) ", r"\1, \2, ", text),
}


@pytest.mark.parametrize("change", COMMAS.values(), ids=COMMAS)
def test_separators_are_read_as_blanks_and_that_is_said(write, change):
    text = BVH.replace(" 90", " 90.5")
    expected = load_save.load(write(text))
    with pytest.warns(MocapWarning, match="separated by commas or semicolons"):
        assert load_save.load(write(change(text))) == expected


def test_decimal_commas_between_separators_are_points(write):
    text = BVH.replace(" 90", " 90.5").replace("OFFSET 10 0 0", "OFFSET 10.25 0 0")
    expected = load_save.load(write(text))
    german = re.sub(r"(?<=\d)\.(?=\d)", ",", text)
    with pytest.warns(MocapWarning) as told:
        assert load_save.load(write(re.sub(r"(?<=\d) (?=[-\d])", "; ", german))) == expected
    assert ["decimal" in str(told[0].message), "separated" in str(told[1].message)] == [True, True]


@pytest.mark.parametrize("part", ["Frame Time: 0.0333333", "OFFSET 10.25 0 0", "90.5"])
def test_a_decimal_comma_in_one_part_only_is_a_point(write, part):
    text = BVH.replace(" 90", " 90.5").replace("OFFSET 10 0 0", "OFFSET 10.25 0 0")
    expected = load_save.load(write(text))
    with pytest.warns(MocapWarning, match="decimal commas"):
        assert load_save.load(write(text.replace(part, part.replace(".", ",")))) == expected


def test_commas_in_names_stay(write):
    named = load_save.load(write(BVH.replace("JOINT head", "JOINT head, left; 2#1")))
    assert "head, left; 2#1" in named.skeleton.names


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("HIERARCHY", "# made by hand\n\nHIERARCHY", 1),
        ("HIERARCHY", "Exported on Monday,\nin centimetres\nHIERARCHY", 2),
        ("MOTION", "// the frames\nMOTION", 1),
        ("\n0 100 50", "\n# frame 1\n0 100 50", 1),
    ],
)
def test_comments_are_left_out_and_that_is_said(write, old, new, count):
    expected = load_save.load(write(BVH))
    with pytest.warns(MocapWarning, match=f"comments are left out, {count} in all, such as"):
        assert load_save.load(write(BVH.replace(old, new))) == expected


def test_a_last_row_that_was_cut_off_is_left_out_and_that_is_said(write):
    expected = load_save.load(write(BVH))[:1]
    said = "line 33, the last one, ends after 8 of 12 numbers: left out"
    with pytest.warns(MocapWarning, match=said) as told:
        assert load_save.load(write(BVH.replace("90 90 0 0 0 0", "90 9"))) == expected
    assert len(told) == 1  # the header counts the frame that was cut off
    with pytest.warns(MocapWarning, match="left out"):
        assert load_save.load(write(BVH.replace("90 90 0 0 0 0", "90 -"))) == expected


def test_joints_of_equal_names_get_a_number_and_that_is_said(write):
    with pytest.warns(MocapWarning, match="1 joints have the name of another, such as 'left leg'"):
        motion = load_save.load(write(BVH.replace("JOINT head", "JOINT left leg")))
    assert motion.skeleton.names[-1] == "left leg_2"
    expected = load_save.load(write(BVH))
    assert np.array_equal(joint_positions(motion), joint_positions(expected))


def with_reference(second_root):
    """A still point that carries the hips, as Bandai Namco's files have it."""
    text = BVH.replace("ROOT hips", "ROOT world\n{\nOFFSET 0 0 0\n" + ROOT + "\nJOINT hips")
    text = text.replace("\nMOTION", "\n}\nMOTION")
    text = text.replace("\n0 100 0 ", "\n0 0 0 0 0 0 0 100 0 ")
    return text.replace("\n0 100 50 ", f"\n{second_root} 0 100 50 ")


def test_a_reference_that_carries_the_hips_is_left_out(write):
    expected = load_save.load(write(BVH))
    with pytest.warns(MocapWarning, match="the still root 'world' is left out: 'hips' is the root"):
        motion = load_save.load(write(with_reference("0 0 0 0 0 0")))
    expected.skeleton.require_same(motion.skeleton)
    assert np.allclose(joint_positions(motion), joint_positions(expected))
    with pytest.warns(MocapWarning, match="the moving root 'world' is left out: 'hips' carries its travel"):
        turned = load_save.load(write(with_reference("7 0 0 0 0 90")))  # +z becomes +x
    start = where(expected, 1)
    for name, point in where(turned, 1).items():
        x, y, z = start[name]
        assert np.allclose(point, [z + 0.07, y, -x])


BROKEN = [
    ("Frames: 2", "Frames: 1e300", r"line 30: expected a number of frames, all below"),
    ("Frames: 2", "Frames: two", r"line 30: expected a number of frames, got 'two'"),
    ("Frames: 2\n", "", r"line 30: expected 'Frames: <count>' and 'Frame Time: <seconds>', got 'Frame Time"),
    ("0.0333333", "0", r"line 31: expected a frame time from 1e-05 to 10 s, got 0: give fps="),
    ("0.0333333", "30", r"line 31: expected a frame time"),
    ("0.0333333", "nan", r"line 31: expected seconds, all below"),
    (
        "90 90 0",
        "90 nan 0",
        r"line 33: expected 12 numbers after 1 complete frames, all below 1e\+09, got 'nan' as number 8",
    ),
    ("90 90 0", "90 x 0", r"line 33: expected 12 numbers .* got 'x' as number 8"),
    ("90 90 0 0 0 0", "90 9\n0", r"line 33: expected 12 numbers after 1 complete frames, got 8"),
    ("MOTION\n", "", r"expected a line 'MOTION'"),
    ("ROOT hips", "ROOT", r"line 2: expected a name after ROOT"),
    ("ROOT hips", "JOINT hips", r"line 2: expected HIERARCHY or ROOT, got 'JOINT'"),
    ("JOINT head", "ROOT head", r"line 19: expected OFFSET or .*, got 'ROOT'"),
    ("OFFSET 10 0 0", "OFFSET 10 0", r"line 8: expected 3 numbers, got 2"),
    ("OFFSET 10 0 0", "", r"line 18: expected an OFFSET before"),
    ("3 Yrotation", "4 Yrotation", r"line 22: expected the number of channels and their names"),
    ("3 Yrotation", "3 Wrotation", r"line 22: expected the number of channels"),
    ("3 Yrotation", "3 Xrotation", r"line 22: expected the number of channels .*, got 'xrotation' twice"),
    ("3 Yrotation Z", "4 Wrotation X", r"line 22: expected the number of channels .*, got 'wrotation'$"),
    ("}\nMOTION", "MOTION", r"line 27: expected .*, got the end of the hierarchy"),
    ("}\nMOTION", "}\n}\nMOTION", r"line 29: expected ROOT or MOTION, got '}'"),
    ("End Site\n\t\t{", "End Site\n\t\t", r"line 12: expected {, got 'OFFSET'"),
]
test_a_broken_file_is_refused_at_its_line = refused_texts(
    load_save.load,
    "a.bvh",
    *((BVH.replace(old, new, 1), said) for old, new, said in BROKEN),
    kind=FormatError,
)


NAMES = st.text(
    st.characters(codec="utf-8", exclude_categories=["C", "Z"], exclude_characters="{}"),
    min_size=1,
    max_size=9,
)


@st.composite
def motions(draw):
    count = draw(st.integers(1, 9))
    names = draw(st.lists(NAMES, min_size=count, max_size=count, unique=True))
    parents = [-1, *(draw(st.integers(0, joint - 1)) for joint in range(1, count))]
    for joint in range(1, count):  # leaves called as End Sites are, sometimes rightly
        name = f"{names[parents[joint]]}_end{draw(st.sampled_from(['', '2', '3']))}"
        if draw(st.booleans()) and name not in names:
            names[joint] = name
    motion = random_motion(draw(seeds), draw(st.integers(1, 6)), count)
    offsets = motion.skeleton.offsets * draw(arrays(bool, (count, 1)))
    fps = draw(st.sampled_from([24.0, 30.0, 59.94, 60.0, 120.0, 0.1, 7.3]))
    return replace(motion, skeleton=Skeleton(names, parents, offsets), fps=fps, contacts={})


@given(motions())
def test_what_is_written_reads_back(tmp_path_factory, motion):
    path = tmp_path_factory.getbasetemp() / "a.bvh"
    load_save.save(motion, path, precision=11)
    back = load_save.load(path, scale=0.01, up="y")
    assert set(back.skeleton.names) == set(motion.skeleton.names)
    order = [back.skeleton.index(name) for name in motion.skeleton.names]
    assert np.abs(joint_positions(back)[:, order] - joint_positions(motion)).max() < 1e-9
    assert rotations.angle_between(back.rotations[:, order], motion.rotations).max() < 1e-9  # ends, too
    parents = [motion.skeleton.names[parent] for parent in motion.skeleton.parents[1:]]
    assert [back.skeleton.names[back.skeleton.parents[joint]] for joint in order[1:]] == parents
    assert back.fps == pytest.approx(motion.fps, rel=1e-12)
    load_save.save(back, path)
    again = load_save.load(path, scale=0.01, up="y")
    assert again.skeleton.names == back.skeleton.names  # depth first by now


def test_curves_are_continuous(tmp_path):
    steps = np.arange(400)[:, None] * [3.0, 2.0, -1.0] + [0.3, 0.7, 0.2]  # x passes ±90° again and again
    turns = euler.from_euler("ZXY", np.radians(steps))[:, None]
    spinning = Motion(Skeleton(["a"], [-1], np.zeros((1, 3))), np.zeros((400, 3)), turns, 30.0)
    load_save.save(spinning, tmp_path / "a.bvh")
    written = np.loadtxt((tmp_path / "a.bvh").read_text().split("Frame Time")[1].splitlines()[1:])[:, 3:]
    assert np.allclose(written - steps, (written - steps)[0], atol=1e-5)  # up to whole turns


NAMES_REFUSED = [(name, 30.0, "cannot hold a joint called") for name in ("a{b", " a", "a\nb", "a\tb", "")]


@pytest.mark.parametrize(
    ("name", "fps", "message"),
    [*NAMES_REFUSED, ("a", 1e-3, "resample it first"), ("a", 1e6, "resample it first")],
)
def test_names_and_rates_that_would_not_read_back_are_refused(tmp_path, name, fps, message):
    motion = Motion(Skeleton([name], [-1], np.zeros((1, 3))), np.zeros((1, 3)), [[[1, 0, 0, 0]]], fps)
    refused(message, load_save.save, motion, tmp_path / "a.bvh")
    assert not list(tmp_path.iterdir())


def test_numbers_that_no_file_holds_are_refused(tmp_path):
    far = replace(wave(4), root_positions=np.full((4, 3), 1e12))
    refused(r"goes 1e.09 units far", load_save.save, far, tmp_path / "a.bvh")
    refused("precision must be 0 to 15 digits", load_save.save, far, tmp_path / "a.bvh", precision=99)
    assert not list(tmp_path.iterdir())


def test_world_positions_that_others_found(real_data):
    folder = real_data / "bvh/olaf_bvh_toolbox"
    motion = load_save.load(folder / "walk01.bvh", scale=1.0)
    with (folder / "walk01_pos.csv").open() as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    assert len(rows) == len(motion)
    names = {key[:-2] for key in rows[0]} - {"ti"}
    assert {name.replace("_end", "_End") for name in motion.skeleton.names} == names
    for index, name in enumerate(motion.skeleton.names):
        name = name.replace("_end", "_End")
        expected = [[row[f"{name}.{axis}"] for axis in "xyz"] for row in rows]
        off = np.abs(joint_positions(motion)[:, index] - expected)
        assert off.max() < 2e-4  # centimetres, printed to 5 digits


def test_a_body_that_stands_along_z_is_turned_upright(tmp_path):
    walk, back = resample(sample("walk_straight"), 30), rotations.from_rotvec([np.pi / 2, 0, 0])
    offsets, places = (rotations.rotate(back, way) for way in (walk.skeleton.offsets, walk.root_positions))
    local = rotations.multiply(rotations.multiply(back, walk.rotations), rotations.inverse(back))
    z_up = replace(walk.skeleton, offsets=offsets)
    load_save.save(replace(walk, skeleton=z_up, root_positions=places, rotations=local), tmp_path / "a.bvh")
    with pytest.warns(MocapWarning, match=r"a\.bvh: read as 1 cm a unit, z up: 1\.7"):
        upright = load_save.load(tmp_path / "a.bvh")
    order = [upright.skeleton.index(name) for name in walk.skeleton.names]
    assert np.allclose(joint_positions(upright)[:, order], joint_positions(walk), atol=1e-6)
    assert load_save.load(tmp_path / "a.bvh", up="z") == upright
    # A body that lies on its back stays as it is in the file.
    turned = np.concatenate([rotations.multiply(back, walk.rotations[:, :1]), walk.rotations[:, 1:]], axis=1)
    load_save.save(replace(walk, rotations=turned), tmp_path / "a.bvh")
    assert load_save.load(tmp_path / "a.bvh").root_positions == pytest.approx(walk.root_positions, abs=1e-6)


def two_bodies(first, second):
    """Join two BVH files of as many frames into one of two bodies."""
    (bones, frames), (other_bones, other_frames) = (text.split("MOTION\n") for text in (first, second))
    *head, blank = frames.split("\n")
    rows = [f"{row} {other}" for row, other in zip(head[2:], other_frames.split("\n")[2:-1], strict=True)]
    return "\n".join([bones + other_bones.replace("HIERARCHY\n", "") + "MOTION", *head[:2], *rows, blank])


def test_of_two_bodies_the_first_is_read_with_a_warning_and_each_by_its_number(write):
    other = BVH.replace("OFFSET 0 40 0", "OFFSET 0 60 0").replace("100 50 0 0 90", "90 50 0 0 45")
    text = two_bodies(BVH, other.replace("ROOT hips", "ROOT hips of B"))
    path = write(text)
    with pytest.warns(
        MocapWarning,
        match=r"2 bodies with the roots 'hips', 'hips of B': the first one is read\. body= chooses",
    ):
        assert load_save.load(path) == load_save.load(write(BVH))
    path = write(text)
    assert unwarned(load_save.load, path, body=1) == load_save.load(write(BVH))
    second = unwarned(load_save.load, write(text), body=2)
    assert second.skeleton.names[0] == "hips of B"
    assert np.array_equal(joint_positions(second), joint_positions(load_save.load(write(other))))


def test_bodies_may_have_joints_of_equal_names(write):
    expected = load_save.load(write(BVH))
    assert unwarned(load_save.load, write(two_bodies(BVH, BVH)), body=2) == expected


def test_a_body_that_a_file_lacks_is_refused(write):
    refused(
        r"a\.bvh holds 1 body, got 2: body= is the number of one, from 1", load_save.load, write(BVH), body=2
    )
    both = write(two_bodies(BVH, BVH))
    for number in (0, 3, 1.5):
        refused(rf"a\.bvh holds 2 bodies, got {number}", load_save.load, both, body=number)
    refused("body must be a number", load_save.load, both, body="hips")
