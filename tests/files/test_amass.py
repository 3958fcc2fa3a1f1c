"""AMASS archives against SMPL's own rule for joints, written out by hand; and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation

from mocap.body import joint_positions, limbs
from mocap.errors import FormatError, MocapWarning
from mocap.files import amass, load_save, motion_archives
from tests.refusals import refused, told, unwarned
from tests.strategies import seeds


def numbers(frames=4, seed=0, width=156):
    random = np.random.default_rng(seed)
    return {
        "poses": random.normal(size=(frames, width)) * 0.4,
        "trans": random.normal(size=(frames, 3)),
        "betas": np.zeros(16),
        "mocap_framerate": 120.0,
        "gender": "neutral",
    }


@pytest.fixture
def archive(tmp_path):
    """Return a function that writes an archive with some arrays changed, or left out by None."""

    def write(**changes):
        arrays = {key: value for key, value in (numbers() | changes).items() if value is not None}
        np.savez(tmp_path / "walk.npz", **arrays)
        return tmp_path / "walk.npz"

    return write


def by_hand(poses, trans):
    """Place SMPL's joints with z up: each turns about itself, and `trans` moves the whole body."""
    rest = amass.SKELETON.offsets.copy()
    rest[0] = amass.PELVIS
    turns, places = [], []
    for joint, parent in enumerate(amass.SKELETON.parents):
        own = Rotation.from_rotvec(poses[3 * joint : 3 * joint + 3])
        turns.append(own if joint == 0 else turns[parent] * own)
        places.append(rest[0] + trans if joint == 0 else places[parent] + turns[parent].apply(rest[joint]))
    return np.array(places)


@given(seeds)
def test_joints_are_where_smpl_puts_them(tmp_path_factory, seed):
    path, arrays = tmp_path_factory.getbasetemp() / "a.npz", numbers(2, seed, width=66 + seed % 100)
    np.savez(path, **arrays)
    motion = load_save.load(path, up="z")
    x, z, y = np.moveaxis(joint_positions(motion), -1, 0) * np.array([1, 1, -1])[:, None, None]
    ours = np.stack([x, y, z], axis=-1)  # back to z up
    for frame in range(2):
        assert np.allclose(ours[frame], by_hand(arrays["poses"][frame], arrays["trans"][frame]), atol=1e-12)
    assert motion.fps == 120.0


def test_the_body_stands_upright_and_faces_where_the_archive_says(archive):
    upright = np.zeros((1, 66))
    upright[0, :3] = [np.pi / 2, 0, 0]  # SMPL's T-pose looks along +z, and has y up; archives turn it to z up
    motion = load_save.load(archive(poses=upright, trans=np.array([[2.0, 3.0, 1.2]])))
    at = dict(zip(motion.skeleton.names, joint_positions(motion)[0], strict=True))
    assert at["head"][1] - at["left_ankle"][1] > 1.2
    assert at["left_wrist"][0] > at["right_wrist"][0]
    assert at["left_foot"][2] > at["left_ankle"][2]
    left, right = limbs.find_legs(motion.skeleton)
    assert motion.skeleton.names[left.ball] == "left_foot"
    assert np.allclose(left.lengths(motion.skeleton), right.lengths(motion.skeleton))


def test_older_and_newer_names_of_the_rate(archive):
    assert load_save.load(archive(mocap_framerate=None, mocap_frame_rate=np.array([60]))).fps == 60.0
    assert load_save.load(archive(mocap_framerate=None), fps=25.0).fps == 25.0


def test_arrays_with_the_names_of_other_programs_are_read_and_that_is_said(archive):
    poses, trans = numbers()["poses"], numbers()["trans"]
    expected = load_save.load(archive(poses=poses[:, :66]), up="z")
    usual = {"poses": None, "trans": None}
    parts = {"global_orient": poses[:, None, :3], "body_pose": poses[:, 3:72].reshape(4, 23, 3)}
    for positions in ({"transl": trans}, {"transl": trans[:, None]}):
        path = archive(**usual, **parts, **positions)
        said = "global_orient and body_pose are read as the poses of AMASS, and transl as its trans"
        with pytest.warns(MocapWarning, match=said):
            assert load_save.load(path, up="z") == expected
    path = archive(**usual, smpl_poses=poses[:, :72], smpl_trans=90 * trans, smpl_scaling=np.array([90.0]))
    with pytest.warns(MocapWarning, match="smpl_poses .* and smpl_trans / 90 as its trans, in metres"):
        dance = load_save.load(path, up="z")
    assert np.allclose(dance.root_positions, expected.root_positions)
    assert np.array_equal(dance.rotations, expected.rotations)
    six = archive(**usual, global_orient=np.zeros((4, 6)), body_pose=np.zeros((4, 63)), transl=trans)
    refused(r"3 numbers for each frame in 'global_orient', got float64\(4, 6\)", load_save.load, six)
    unscaled = archive(**usual, smpl_poses=poses[:, :72], smpl_trans=trans, smpl_scaling=0.0)
    refused("one number above 0 in 'smpl_scaling', got 0.0", load_save.load, unscaled)


def test_poses_in_three_dimensions_or_in_parts_are_the_same(archive):
    poses, trans = numbers()["poses"], numbers()["trans"]
    expected = load_save.load(archive(poses=poses[:, :66]), up="z")
    tall = load_save.load(archive(poses=poses[:, :72].reshape(4, 24, 3)), up="z")
    parts = {"poses": None, "root_orient": poses[:, :3], "pose_body": poses[:, 3:66]}
    path = archive(**parts, trans=trans, mocap_framerate=None, fps=120.0)
    assert motion_archives.is_motion(path)
    assert tall == expected == load_save.load(path, up="z")
    short = archive(**(parts | {"pose_body": poses[:3, 3:66]}))
    refused("as many rows of pose_body as of root_orient, 4, got 3", load_save.load, short)
    refused("no 'poses'", load_save.load, archive(poses=None, root_orient=poses[:, :3]))


def test_betas_are_ignored_with_a_sentence(archive):
    path = archive(betas=np.ones(16))
    betas = "betas, the shape of the body, are ignored"
    shaped = told(betas, load_save.load, path, up="z", most=200 + len(str(path)))
    plain = unwarned(load_save.load, archive(), up="z")
    assert np.array_equal(shaped.rotations, plain.rotations)


BAD = [
    ({"poses": None}, "no 'poses'"),
    ({"trans": None}, "no 'trans'"),
    ({"poses": np.array([{}], object)}, r"66 numbers .* got object\(\)"),  # no code of a file is run
    ({"poses": np.zeros((4, 63))}, r"66 numbers for each frame in 'poses', got float64\(4, 63\)"),
    ({"poses": np.zeros(4)}, r"66 numbers .* got float64\(4,\)"),
    ({"poses": np.full((4, 66), "x")}, "66 numbers"),
    ({"trans": np.zeros((3, 3))}, "as many rows of trans as of poses, 4, got 3"),
    ({"poses": np.zeros((0, 66)), "trans": np.zeros((0, 3))}, "one frame or more in 'poses', got none"),
    ({"trans": np.array([[0, 0, 0], [0, np.nan, 0]] * 2)}, "below 1e6 in 'trans', got others in frame 1"),
    ({"poses": np.full((4, 66), 1e300)}, "below 1e6 in 'poses', got others in frame 0"),
    ({"mocap_framerate": 0.0}, "one number above 0 in 'mocap_framerate', got 0.0"),
    ({"mocap_framerate": np.nan}, "one number above 0 in 'mocap_framerate', got nan"),
    ({"mocap_framerate": np.ones(2)}, "one number above 0"),
    ({"mocap_framerate": "fast"}, "one number above 0"),
    ({"mocap_framerate": None}, "'mocap_framerate', got none: give fps="),
]


@pytest.mark.parametrize(("changes", "message"), BAD)
def test_a_broken_archive_is_refused(archive, changes, message):
    path = archive(**changes)
    refused(message, load_save.load, path, kind=FormatError)


def test_files_of_other_kinds_are_refused(tmp_path):
    for path, reason in ((tmp_path / "gone.npz", "No such file"), (tmp_path, "Is a directory")):
        refused(f"Cannot read {path}: {reason}", load_save.load, path)
        assert not motion_archives.is_motion(path)
