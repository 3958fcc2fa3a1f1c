"""What is written reads back as it was, or is not written."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import euler, rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, SkeletonMismatch
from mocap.files import load_save
from mocap.files.acclaim_writer import to_acclaim, to_amc, widened
from tests.refusals import refused
from tests.strategies import random_quaternions, seeds

DOFS = ["", "x", "z", "yx", "zy", "xz", "xyz", "zxy", "yzx"]


@st.composite
def motions(draw):
    """Return a motion that fits its dofs, in any axes, with leaves that may be called as ends are."""
    random = np.random.default_rng(draw(seeds))
    count, frames = draw(st.integers(2, 9)), draw(st.integers(1, 6))
    parents = np.array([-1, *(random.integers(0, joint) for joint in range(1, count))])
    names = ["hips", *(f"bone{joint}" for joint in range(1, count))]
    for joint in range(1, count):
        name = f"{names[parents[joint]]}_end"
        if random.random() < 0.4 and name not in names:
            names[joint] = name
    offsets = random.normal(size=(count, 3)) * (random.random((count, 1)) < 0.8)
    dofs = ["xyz", *random.choice(DOFS, count - 1)]
    axes = random_quaternions(random, count)
    axes[0] = rotations.IDENTITY
    local = np.tile(rotations.IDENTITY, (frames, count, 1))
    for joint, order in enumerate(dofs):
        if order:
            own = euler.from_euler(str(order), random.uniform(-4, 4, (frames, len(order))))
            own = rotations.multiply(rotations.multiply(axes[joint], own), rotations.inverse(axes[joint]))
            local[:, joint] = own
    skeleton = Skeleton(names, parents, offsets, axes, dofs)
    return Motion(
        skeleton, random.normal(size=(frames, 3)), local, draw(st.sampled_from([24.0, 30.3, 120.0]))
    )


def same_places(back, motion):
    names = ["root", *motion.skeleton.names[1:]]
    order = [back.skeleton.index(name) for name in names]
    return np.abs(joint_positions(back)[:, order] - joint_positions(motion)).max()


@given(motions(), st.sampled_from([None, 0.01, 1.0]))
def test_what_is_written_reads_back(tmp_path_factory, motion, scale):
    folder = tmp_path_factory.mktemp("clip")
    load_save.save(motion, folder / "a.amc", precision=11, scale=scale)
    back = load_save.load(folder / "a.amc")
    assert same_places(back, motion) < 1e-9
    assert back.fps == motion.fps
    # By now all joints are bones, and what comes back is the same to the last joint.
    load_save.save(back, folder / "b.AMC", precision=11, scale=scale)
    again = load_save.load(folder / "b.AMC")
    again.skeleton.require_same(back.skeleton)
    assert again.skeleton.dofs == back.skeleton.dofs
    assert rotations.angle_between(again.rotations, back.rotations).max() < 1e-10
    assert (folder / "a.asf").read_text().count("\n") == (folder / "b.asf").read_text().count("\n")


@given(motions(), seeds)
def test_any_motion_is_written_with_wide_bones(tmp_path_factory, motion, seed):
    folder = tmp_path_factory.mktemp("clip")
    turns = random_quaternions(np.random.default_rng(seed), len(motion), len(motion.skeleton))
    load_save.save(replace(motion, rotations=turns), folder / "a.amc", precision=11, widen=True)
    assert same_places(load_save.load(folder / "a.amc"), replace(motion, rotations=turns)) < 1e-9


LEG = Skeleton(
    ["root", "thigh", "shin", "shin_end"],
    [-1, 0, 1, 2],
    [[0, 0, 0], [0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]],
    dofs=["xyz", "xz", "x", ""],
)


def leg(thigh, shin, frames=4):
    """Turn the leg by Euler angles (x, y, z), more of them from frame to frame."""
    angles = np.zeros((frames, 4, 3))
    angles[:, 1], angles[:, 2] = thigh, shin
    angles *= np.arange(frames)[:, None, None]
    return Motion(LEG, np.zeros((frames, 3)), euler.from_euler("xyz", angles), 30.0, "step")


def test_what_would_be_lost_is_named(tmp_path):
    motion = leg([0.3, 0, 0.1], [0.2, 0.05, 0.0])
    for name, joint in (("shin", "shin"), ("step", "shin")):
        message = rf"'{joint}', which turns about rx, would lose 8.6° in frame 3. .*widen=True.*a .bvh file"
        refused(message, load_save.save, motion, tmp_path / f"{name}.amc")
    assert not list(tmp_path.iterdir())
    load_save.save(motion, tmp_path / "step.amc", widen=True, precision=9)
    assert same_places(load_save.load(tmp_path / "step.amc"), motion) < 1e-9
    with pytest.raises(MocapError, match=r"in frame 3, and 1 more bones less\."):
        load_save.save(leg([0.3, 0.01, 0], [0.2, 0.05, 0.0]), tmp_path / "other.amc")


def test_an_end_that_turns_is_not_dropped(tmp_path):
    turns = np.tile(rotations.IDENTITY, (2, 4, 1))
    turns[1, 3] = rotations.about_y(0.5)
    motion = Motion(LEG, np.zeros((2, 3)), turns, 30.0)
    with pytest.raises(MocapError, match=r"'shin_end', which turns about no axis, would lose 29° in frame 1"):
        load_save.save(motion, tmp_path / "a.amc")
    for name in ("a.amc", "a.bvh"):
        load_save.save(motion, tmp_path / name, widen=True)
        back = load_save.load(tmp_path / name)
        back.skeleton.require_same(LEG)
        assert rotations.angle_between(back.rotations, turns).max() < 1e-7


def test_an_existing_skeleton_is_fitted(tmp_path):
    load_save.save(leg([0.3, 0, 0.1], [0.2, 0, 0]), tmp_path / "first.amc")
    before = (tmp_path / "first.asf").read_bytes()
    motion = leg([0.1, 0, 0.2], [0.5, 0, 0])
    load_save.save(motion, tmp_path / "second.amc", skeleton=tmp_path / "first.asf", precision=9)
    assert not (tmp_path / "second.asf").exists()
    assert same_places(load_save.load(tmp_path / "second.amc"), motion) < 1e-9
    with pytest.raises(MocapError, match="'shin', which turns about rx"):
        load_save.save(leg([0, 0, 0], [0, 1, 0]), tmp_path / "third.amc", skeleton=tmp_path / "first.asf")
    with pytest.raises(MocapError, match="leave skeleton= out, or widen"):
        load_save.save(motion, tmp_path / "third.amc", skeleton=tmp_path / "first.asf", widen=True)
    other = replace(motion, skeleton=replace(LEG, offsets=LEG.offsets * 2))
    with pytest.raises(SkeletonMismatch, match="'shin' sits 40 cm apart"):
        load_save.save(other, tmp_path / "third.amc", skeleton=tmp_path / "first.asf")
    assert (tmp_path / "first.asf").read_bytes() == before


def test_a_root_at_rest_somewhere_and_one_that_cannot_move(tmp_path):
    motion = leg([0.3, 0, 0.1], [0.2, 0, 0])
    load_save.save(motion, tmp_path / "a.amc")
    text = (tmp_path / "a.asf").read_text()
    text = text.replace("position 0 0 0", "position 1 2 3").replace(
        "orientation 0 0 0", "orientation 40 50 60"
    )
    (tmp_path / "b.asf").write_text(text)
    load_save.save(motion, tmp_path / "c.amc", skeleton=tmp_path / "b.asf", precision=9)
    assert same_places(load_save.load(tmp_path / "c.amc", skeleton=tmp_path / "b.asf"), motion) < 1e-9
    (tmp_path / "b.asf").write_text(text.replace("TX TY TZ", "TX TZ"))
    with pytest.raises(MocapError, match=r"gives its root no ty: 'step' would lose 0.11 m in frame 0"):
        load_save.save(motion, tmp_path / "c.amc", skeleton=tmp_path / "b.asf")


def test_a_skeleton_that_others_may_need_is_not_replaced(tmp_path):
    motion = leg([0.3, 0, 0.1], [0.2, 0, 0])
    load_save.save(motion, tmp_path / "a.amc")
    load_save.save(motion, tmp_path / "a.amc")
    refused(r"a.asf holds another skeleton", load_save.save, motion, tmp_path / "a.amc", widen=True)


@pytest.mark.parametrize("order", ["xyz", "zxy", "yx", "x"])
def test_curves_are_continuous(order):
    bone = replace(LEG, dofs=["xyz", order, "x", ""])
    steps = np.arange(400)[:, None] * [0.05, 0.035, -0.02][: len(order)] + 0.1
    turns = np.tile(rotations.IDENTITY, (400, 4, 1))
    turns[:, 1] = euler.from_euler(order, steps)
    text = to_amc(Motion(bone, np.zeros((400, 3)), turns, 30.0), to_acclaim(bone))
    written = np.array([line.split()[1:] for line in text.split("\n") if line.startswith("thigh")], float)
    assert np.allclose(written - np.degrees(steps), (written - np.degrees(steps))[0], atol=1e-5)


def test_a_companion_of_real_clips(real_data, tmp_path):
    for name in ("cmu/16/16_15.amc", "cmu/49/49_08.amc", "bvh/pybvh/bvh_test1.bvh"):
        motion = load_save.load(real_data / name)
        load_save.save(motion, tmp_path / "a.amc", precision=10)
        assert same_places(load_save.load(tmp_path / "a.amc"), motion) < 1e-9
        (tmp_path / "a.asf").unlink()
    skeleton = real_data / "cmu/16/16.asf"
    motion = load_save.load(real_data / "cmu/16/16_15.amc")
    load_save.save(motion, tmp_path / "a.amc", skeleton=skeleton, precision=10)
    back = load_save.load(tmp_path / "a.amc", skeleton=skeleton)
    assert same_places(back, motion) < 1e-9
    assert len(widened(motion).dofs) == 38


@pytest.mark.parametrize("name", ["left leg", "a#", "(a", "a,b", ":a", "12", "Root", "end", "", "a\u200b"])
def test_names_that_would_break_the_file_are_refused(name):
    refused("cannot hold a joint called", to_acclaim, Skeleton(["hips", name], [-1, 0], np.zeros((2, 3))))


def test_a_root_alone_and_endless_numbers_are_refused(tmp_path):
    refused("needs a joint below the root", to_acclaim, Skeleton(["hips"], [-1], np.zeros((1, 3))))
    far = replace(leg([0, 0, 0], [0, 0, 0]), root_positions=np.full((4, 3), 1e12))
    for name in ("a.amc", "a.bvh"):
        refused(r"goes 1e.09 units far", load_save.save, far, tmp_path / name)
    refused("precision must be 0 to 15 digits", load_save.save, far, tmp_path / "a.bvh", precision=99)
    assert not list(tmp_path.iterdir())
