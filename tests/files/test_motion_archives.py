"""Motions as `.npz` files: what is saved comes back, others read it too, and what is refused."""

import errno
import os
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

import mocap
from mocap._shared.archives import pack
from mocap.body import Skeleton, rotations
from mocap.errors import FormatError, MocapError
from mocap.files import amass, load_save, motion_archives, position_tables
from tests.files.test_amass import by_hand
from tests.refusals import refused, unwarned
from tests.strategies import random_motion, seeds, wave


def marked(clip):
    """Give a motion labels, contacts, roles, and axes that are not the identity."""
    random = np.random.default_rng(len(clip))
    labels = {label: random.random(len(clip)) < 0.5 for label in ("walk", "gehen, früh", "歩く", "")}
    contacts = {name: random.random(len(clip)) < 0.5 for name in clip.skeleton.names[-2:]}
    axes = rotations.from_rotvec(random.normal(size=(len(clip.skeleton), 3)))
    names = clip.skeleton.names
    skeleton = replace(clip.skeleton, axes=axes, roles={"pelvis": names[0], "left hip": names[-1]})
    return replace(clip, skeleton=skeleton, labels=labels, contacts=contacts, fps=29.97002997002997)


def smpl(frames=7, seed=1):
    """Return a motion of the SMPL body without sense."""
    return random_motion(seed, frames, skeleton=amass.SKELETON)


@given(seeds)
def test_any_motion_comes_back_to_the_bit(tmp_path_factory, seed):
    path = tmp_path_factory.getbasetemp() / "any.npz"
    motion = random_motion(seed, frames=1 + seed % 3, joints=1 + seed % 7)
    for clip in (motion, marked(motion) if len(motion.skeleton) > 1 else motion):
        load_save.save(clip, path)
        assert unwarned(load_save.load, path) == clip


def test_odd_names_come_back(tmp_path):
    clip = wave(3, name="läuft/\n\u2028 ")
    names = ["mixamorig:Hüfte", "手", " a ", '"\t']
    clip = replace(clip, skeleton=replace(clip.skeleton, names=names), contacts={"手": True})
    load_save.save(clip, tmp_path / "ä 手.npz")
    assert load_save.load(tmp_path / "ä 手.npz") == clip


def test_the_frame_rate_the_axis_and_the_roles_can_be_overruled(tmp_path):
    clip = marked(wave(9))
    load_save.save(clip, tmp_path / "a.npz")
    assert load_save.load(tmp_path / "a.npz", fps=50.0) == replace(clip, fps=50.0)
    turned = load_save.load(tmp_path / "a.npz", up="z")
    assert turned.positions[..., 1] == pytest.approx(clip.positions[..., 2], abs=1e-12)
    named = load_save.load(tmp_path / "a.npz", roles={"left hip": "elbow"})
    assert named.skeleton.roles == clip.skeleton.roles | {"left hip": "elbow"}
    refused("in metres, got a scale of 2", load_save.load, tmp_path / "a.npz", scale=2.0)


def test_numpy_reads_the_arrays_without_this_package(tmp_path):
    clip = marked(wave(9))
    load_save.save(clip, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as arrays:
        assert np.array_equal(arrays["rotations"], clip.rotations)
        assert arrays["names"].tolist() == list(clip.skeleton.names)
        column = arrays["label_names"].tolist().index("walk")
        assert np.array_equal(arrays["labels"][:, column], clip.labels["walk"])


# The layout of AMASS ----------------------------------------------------------------------------------------


@given(seeds)
def test_a_motion_of_smpl_is_written_where_smpl_puts_its_joints(tmp_path_factory, seed):
    path = tmp_path_factory.getbasetemp() / "smpl.npz"
    motion = smpl(2, seed)
    load_save.save(motion, path)
    with np.load(path, allow_pickle=False) as arrays:
        poses = arrays["poses"]
        trans = arrays["trans"]
    x, y, z = np.moveaxis(motion.positions, -1, 0)
    z_up = np.stack([x, -z, y], axis=-1)
    for frame in range(2):
        assert np.allclose(by_hand(poses[frame, :66], trans[frame]), z_up[frame], atol=1e-12)
    assert np.allclose(load_save.load(path).positions, motion.positions, atol=1e-12)


def test_the_arrays_have_the_shapes_of_amass(tmp_path):
    load_save.save(smpl(), tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as arrays:
        shapes = {name: arrays[name].shape for name in arrays}
        assert str(arrays["gender"]) == "neutral" and float(arrays["mocap_framerate"]) == 30.0
        assert not arrays["poses"][:, 66:].any() and not arrays["betas"].any()
    amass_shapes = {"poses": (7, 156), "trans": (7, 3), "betas": (16,), "dmpls": (7, 8)}
    assert shapes | amass_shapes == shapes


def test_a_motion_of_smpl_keeps_its_rate_labels_contacts_and_roles(tmp_path):
    motion = smpl()
    clip = replace(marked(motion), skeleton=replace(motion.skeleton, roles={"pelvis": "pelvis"}))
    load_save.save(clip, tmp_path / "a.npz")
    saved = unwarned(load_save.load, tmp_path / "a.npz")
    assert saved.fps == clip.fps and saved.name == clip.name and saved.skeleton == clip.skeleton
    assert replace(saved, rotations=clip.rotations, root_positions=clip.root_positions) == clip
    assert rotations.angle_between(saved.rotations, clip.rotations).max() < 1e-12


def test_bodies_that_lie_or_hang_keep_z_up(tmp_path):
    """What is written has z up; the frames, which may say otherwise, are not asked."""
    lying = np.tile(rotations.IDENTITY, (90, 22, 1))
    lying[:, 0] = rotations.from_rotvec([np.pi / 2, 0, 0])
    for pose in (lying, rotations.multiply(rotations.from_rotvec([np.pi, 0, 0]), lying)):
        motion = mocap.Motion(amass.SKELETON, np.tile([0, 0.1, 0], (90, 1)), pose, 30.0)
        load_save.save(motion, tmp_path / "a.npz")
        assert np.allclose(unwarned(load_save.load, tmp_path / "a.npz").positions, motion.positions)


def test_a_body_of_smpl_that_went_through_a_bvh_is_still_smpl(tmp_path):
    motion = smpl()
    load_save.save(motion, tmp_path / "a.bvh", precision=9)
    through = load_save.load(tmp_path / "a.bvh", scale=0.01, up="y")
    assert through.skeleton.names != motion.skeleton.names  # another order
    load_save.save(through, tmp_path / "a.npz")
    assert np.allclose(load_save.load(tmp_path / "a.npz").positions, motion.positions, atol=1e-8)


@pytest.mark.parametrize("change", ["longer", "other tree", "more joints"])
def test_other_bodies_with_the_names_of_smpl_are_not_smpl(tmp_path, change):
    skeleton = amass.SKELETON
    if change == "longer":
        skeleton = replace(skeleton, offsets=1.01 * skeleton.offsets)
    elif change == "other tree":
        skeleton = replace(skeleton, parents=[-1, *range(21)])
    else:
        names = [*skeleton.names, "finger"]
        skeleton = Skeleton(names, [*skeleton.parents, 21], [*skeleton.offsets, [0, 0, 1]])
    motion = random_motion(3, skeleton=skeleton)
    load_save.save(motion, tmp_path / "a.npz")
    assert load_save.load(tmp_path / "a.npz") == motion


def test_arrays_that_others_changed_are_read_with_the_marks(tmp_path):
    """As a program of AMASS may: fewer numbers of a pose, in single precision, another shape of the body."""
    motion = replace(smpl(), labels={"walk": True})
    load_save.save(motion, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as archive:
        arrays = dict(archive)
    arrays["poses"] = arrays["poses"][:, :72].astype(np.float32)
    np.savez_compressed(tmp_path / "a.npz", **arrays)
    changed = load_save.load(tmp_path / "a.npz")
    assert np.allclose(changed.positions, motion.positions, atol=1e-5) and changed.labels["walk"].all()
    arrays["labels"] = arrays["labels"][:3]
    np.savez(tmp_path / "a.npz", **arrays)
    refused("'labels' to fit the other arrays", load_save.load, tmp_path / "a.npz", kind=FormatError)


# What is refused --------------------------------------------------------------------------------------------


class Trap:
    """A pickle that leaves a file when it is loaded."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return os.mkdir, (str(self.path),)


BAD = [
    ({"parents": np.array([-1, 0, 3, 0])}, "Joint 'hand' stands before its parent"),
    ({"parents": np.array([-1, 2, 1, 0])}, "Joint 'elbow' stands before its parent"),  # a circle
    ({"parents": np.array([0, 0, 1, 0])}, "Joint 0, and no other, is the root"),
    ({"parents": np.array([-1, 0, 1, 2**62])}, "Joint 'side' stands before its parent"),
    ({"parents": np.array([-1, 0, 1.5, 0])}, r"'parents' to fit the other arrays, got float64\(4,\)"),
    ({"names": np.array(["a", "b", "a", "c"])}, "given twice: a"),
    ({"names": None}, "one without names"),
    ({"rotations": None}, "one without rotations"),
    ({"contacts": None}, "one without contacts"),
    ({"rotations": np.zeros((9, 4, 3))}, "'rotations' to fit the other arrays"),
    ({"rotations": np.ones((9, 4, 4))}, "rotations are quaternions of length 1"),
    ({"rotations": np.full((9, 4, 4), 1e300)}, "rotations are quaternions of length 1"),
    ({"rotations": np.array([{}], object)}, "'rotations' to fit the other arrays, got object"),
    ({"root_positions": np.full((9, 3), np.nan)}, r"'root_positions' are finite and below 1e\+09 m"),
    ({"root_positions": np.zeros((8, 3))}, "'rotations' to fit the other arrays"),
    ({"offsets": np.full((4, 3), 1e300)}, r"'offsets' are finite and below 1e\+09 m"),
    ({"axes": np.full((4, 4), 1e300)}, "of length 1"),
    ({"dofs": np.array(["xx", "", "", ""])}, "needs dofs such as 'xyz'"),
    ({"fps": np.array(np.nan)}, r"the frame rate is from 1e-09 to 1e\+09 Hz"),
    ({"fps": np.array(-1.0)}, "the frame rate is from 1e-09"),
    ({"fps": np.array(1e-300)}, "the frame rate is from 1e-09"),
    ({"fps": np.ones(2)}, "'fps' to fit the other arrays"),
    ({"role_joints": np.array(["nobody", "root"])}, "No joint 'nobody'"),
    ({"contact_names": np.array(["nobody", "side"])}, "No joint 'nobody'"),
    ({"contact_names": np.array(["side", "side"])}, "no name comes twice in 'contact_names'"),
    ({"label_names": np.array(["a"])}, "'labels' to fit the other arrays"),
    ({"labels": np.ones((9, 4))}, "'labels' to fit the other arrays, got float64"),
    ({"version": np.array(2)}, "version 1, got version 2, which a newer mocap wrote"),
    ({"format": np.array("mocap: a cake")}, "arrays 'poses' and 'trans', as AMASS archives have"),
]


@pytest.mark.parametrize(("changes", "message"), BAD)
def test_a_broken_archive_is_one_sentence(tmp_path, changes, message):
    clip = marked(wave(9))
    load_save.save(clip, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as archive:
        arrays = {**archive, **changes}
    kept = {key: array for key, array in arrays.items() if array is not None}
    np.savez(tmp_path / "a.npz", **kept)
    refused(message, load_save.load, tmp_path / "a.npz", kind=FormatError)


@pytest.mark.parametrize("key", ["rotations", "names", "name", "format", "labels"])
def test_no_pickle_is_loaded(tmp_path, key):
    load_save.save(marked(wave(9)), tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as archive:
        arrays = dict(archive)
    trap = tmp_path / "sprung"
    arrays[key] = np.array([Trap(trap)], object)
    np.savez(tmp_path / "a.npz", **arrays)
    refused("expected", load_save.load, tmp_path / "a.npz", kind=FormatError)
    (tmp_path / "b.npz").write_bytes(pickle.dumps(Trap(trap)))
    refused("expected", load_save.load, tmp_path / "b.npz", kind=FormatError)
    assert not trap.exists()


def test_a_body_of_too_many_joints_is_neither_written_nor_read(tmp_path):
    count = motion_archives.MOST_JOINTS + 1
    arrays = {"parents": np.arange(-1, count - 1), "offsets": np.ones((count, 3))}
    arrays |= {"names": np.arange(count).astype(str), "dofs": np.full(count, "x")}
    arrays |= {"axes": np.tile(rotations.IDENTITY, (count, 1)), "root_positions": np.zeros((1, 3))}
    arrays |= {"rotations": arrays["axes"][None], "fps": np.array(30.0), "name": np.array("a")}
    for key in ("label", "contact"):
        arrays |= {f"{key}_names": np.empty(0, "U1"), f"{key}s": np.empty((1, 0), bool)}
    arrays |= {"role_names": np.empty(0, "U1"), "role_joints": np.empty(0, "U1")}
    pack(tmp_path / "a.npz", {"format": np.array("mocap: a motion"), "version": np.array(1), **arrays})
    refused("at most 10000 joints", load_save.load, tmp_path / "a.npz", kind=FormatError)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": "a\0"}, "without a zero character at the end, got 'a"),
        ({"name": "x" * 1001}, "at most 1000 characters"),
        ({"name": "\udc80"}, "'name' holds characters that are not Unicode text"),
        ({"labels": {"\0": True}}, "without a zero character at the end"),
    ],
)
def test_names_that_an_array_cannot_hold_are_refused_and_the_old_file_stays(tmp_path, changes, message):
    load_save.save(wave(3), tmp_path / "a.npz")
    refused(message, load_save.save, replace(wave(4), **changes), tmp_path / "a.npz")
    assert load_save.load(tmp_path / "a.npz") == wave(3)
    assert [file.name for file in tmp_path.iterdir()] == ["a.npz"]


def test_numbers_that_amass_cannot_hold_are_refused(tmp_path):
    far = replace(smpl(), root_positions=np.full((7, 3), 2e6))
    refused("positions are below 1e6 m", load_save.save, far, tmp_path / "a.npz")
    refused("frame rate is below 1e6 Hz", load_save.save, replace(smpl(), fps=1e7), tmp_path / "a.npz")


def test_a_motion_that_goes_too_far_is_not_written(tmp_path):
    far = replace(wave(3), root_positions=np.full((3, 3), 1e9))
    refused(r"'root_positions' are finite and below 1e\+09 m", load_save.save, far, tmp_path / "a.npz")
    refused("the frame rate is from 1e-09", load_save.save, replace(wave(3), fps=1e50), tmp_path / "a.npz")


@pytest.mark.parametrize("suffix", [".npz", ".csv"])
@pytest.mark.parametrize("trouble", [KeyboardInterrupt(), OSError(errno.ENOSPC, "No space left on device")])
def test_an_interruption_or_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch, suffix, trouble):
    path = tmp_path / f"a{suffix}"
    load_save.save(wave(3), path)
    before = path.read_bytes()

    def fail(*_, **__):
        raise trouble

    monkeypatch.setattr(np, "savez_compressed", fail)
    monkeypatch.setattr(position_tables, "_rows", fail)
    with pytest.raises(KeyboardInterrupt if isinstance(trouble, KeyboardInterrupt) else MocapError):
        load_save.save(wave(4), path)
    assert path.read_bytes() == before and [file.name for file in tmp_path.iterdir()] == [path.name]
