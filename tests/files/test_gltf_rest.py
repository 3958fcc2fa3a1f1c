"""The rest pose of a `.glb`, and its bones, read back by a reader of our own."""

import warnings
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from mocap.body import Skeleton, joint_positions, resample, rotations, with_roles
from mocap.body.limb_partners import limb_partners
from mocap.body.limbs import roles
from mocap.datasets import samples
from mocap.errors import MocapWarning
from mocap.files import gltf, load_save
from mocap.files.gltf_bones import bone_axes, bone_directions
from mocap.files.gltf_rest import with_standing_rest
from tests.editing.bodies import LONG, SMPL, along_x, renamed, rested
from tests.files.glb_reader import Glb
from tests.strategies import random_motion, random_quaternions, seeds

MIRROR = [-1.0, 1.0, 1.0]
REPLACED = "The rest pose of '.*' does not stand: .glb files get the mean pose of their clips"


def walk(name="walk_straight"):
    return resample(samples.sample(name)[:360], 30)


def all_alike(motion, turn):
    return rested(motion, np.tile(turn, (len(motion.skeleton), 1)))


def odd(motion, seed=0):
    return rested(motion, random_quaternions(np.random.default_rng(seed), len(motion.skeleton)))


def lying(motion):
    return all_alike(motion, rotations.from_rotvec([np.pi / 2, 0, 0]))


def numbered(motion):
    names = {name: f"j{number}" for number, name in enumerate(motion.skeleton.names)}
    return with_roles(renamed(motion, names))


STANDING = {
    "standing": walk,
    "lying": lambda: lying(renamed(walk(), SMPL)),
    "facing x": lambda: all_alike(walk(), rotations.about_y(-np.pi / 2)),
    "facing away, on the head": lambda: all_alike(walk(), rotations.from_rotvec([np.pi, 0, 0])),
}


def on_tiptoe(motion):
    """Return the motion on a body whose feet hang at rest."""
    turns = np.tile(rotations.IDENTITY, (len(motion.skeleton), 1))
    for name in ("lfoot", "ltoes", "ltoes_end", "rfoot", "rtoes", "rtoes_end"):
        turns[motion.skeleton.index(name)] = rotations.from_rotvec([-1.2, 0, 0])
    return rested(motion, turns)


REPLACING = {
    "all bones along x": lambda: rested(renamed(walk(), LONG), along_x(walk().skeleton)),
    "without sense": lambda: odd(walk()),
    "without sense, unknown names": lambda: numbered(odd(walk())),
}
BODIES = STANDING | REPLACING


def glb(motions, *, expected=None, **options):
    """Return the file of motions, read back; `expected` is the warning."""
    with pytest.warns(MocapWarning, match=expected) if expected else nullcontext(), warnings.catch_warnings():
        warnings.simplefilter("default" if expected else "error")
        return Glb(gltf.glb(motions, **options))


def read(body, **options):
    return glb(BODIES[body](), expected=REPLACED if body in REPLACING else None, **options)


def check_bones(file):
    """Check what every file promises: bones along y, bound at rest, on the floor."""
    rest = file.poses(0, rest=True)
    positions = rest[:, :3, 3]
    parents = [file.parents()[joint] for joint in file.joints]
    for index, joint in enumerate(file.joints):
        children = [child for child, parent in enumerate(parents) if parent == joint]
        offsets = [positions[child] - positions[index] for child in children]
        lengths = [np.linalg.norm(offset) for offset in offsets]
        distant = [k for k, length in enumerate(lengths) if length > 1e-4]
        if len(distant) == 1:
            (child,) = distant
            np.testing.assert_allclose(rest[index, :3, 1], offsets[child] / lengths[child], atol=1e-6)
    np.testing.assert_allclose(rest @ file.inverse_binds(), np.tile(np.eye(4), (len(rest), 1, 1)), atol=1e-6)
    assert abs(positions[:, 1].min()) < 1e-6
    return rest


@pytest.mark.parametrize("root", [False, True])
@pytest.mark.parametrize("body", BODIES)
def test_bones_point_along_y_and_are_bound_at_rest_and_the_body_stands_on_the_floor(body, root):
    motion = BODIES[body]()
    file = read(body, root=root)
    positions = check_bones(file)[:, :3, 3]
    joints = {role: positions[joint] for role, joint in roles(motion.skeleton).items()}
    for side, sign in (("left", 1), ("right", -1)):
        hip, knee, ankle, ball = (joints[f"{side} {part}"] for part in ("hip", "knee", "ankle", "ball"))
        assert hip[1] > knee[1] + 0.3 > ankle[1] + 0.6
        assert sign * hip[0] > 0.05 and ball[2] > ankle[2] + 0.05  # faces +z
        assert ball[1] < ankle[1] < 0.15
        assert abs(ball[0] - ankle[0]) < 0.1 * (ball[2] - ankle[2])
    assert positions[:, 1].max() > 1.6
    assert np.abs(np.mean([joints["left hip"], joints["right hip"]], axis=0)[[0, 2]]).max() < 0.1


@pytest.mark.parametrize("root", [False, True])
@pytest.mark.parametrize("body", BODIES)
def test_all_frames_have_the_joints_where_ours_are_whatever_the_rest_pose(body, root):
    motion = BODIES[body]()
    file = read(body, root=root)
    exact = joint_positions(motion)
    for frame in range(0, len(motion), 13):
        poses = file.poses(frame / motion.fps)[: len(motion.skeleton), :3, 3]
        assert np.linalg.norm(poses - exact[frame], axis=-1).max() < 2e-5


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("root", [False, True])
def test_each_clip_of_a_file_plays_on_the_skeleton_of_all(body, root):
    first = BODIES[body]()
    # The second motion holds the hands still, which the first moves.
    second = replace(first[20:50], name="second", fps=24.0)
    still = second.rotations.copy()
    arms = [joint for joint, name in enumerate(walk().skeleton.names) if "wrist" in name or "hand" in name]
    still[:, arms] = rotations.IDENTITY
    second = replace(second, rotations=still)
    motions = [first, second]
    file = glb(motions, root=root, expected=REPLACED if body in REPLACING else None)
    check_bones(file)
    for motion in motions:
        exact = joint_positions(motion)
        for frame in (0, 11, len(motion) - 1):
            poses = file.poses(frame / motion.fps, clip=motion.name)[: len(motion.skeleton), :3, 3]
            assert np.linalg.norm(poses - exact[frame], axis=-1).max() < 2e-5


@pytest.mark.parametrize("body", STANDING)
def test_a_rest_pose_that_stands_after_quarter_turns_is_kept(body):
    rest = walk().skeleton.rest
    positions = read(body).poses(0, rest=True)[:, :3, 3]
    np.testing.assert_allclose(positions - positions[0], rest - rest[0], atol=1e-6)


@pytest.mark.parametrize("body", REPLACING)
def test_a_rest_pose_that_is_found_has_limbs_that_mirror_each_other(body):
    motion = BODIES[body]()
    rest = read(body).poses(0, rest=True)
    pairs = limb_partners(motion.skeleton)
    assert len(pairs) > 10
    for left, right in pairs.items():
        np.testing.assert_allclose(rest[left, :3, 3] * MIRROR, rest[right, :3, 3], atol=1e-4)


def rest_turned(angles):
    """Return whether the rest pose is kept if its thighs are rotated by these degrees about x and z."""
    motion = walk()
    turns = np.tile(rotations.IDENTITY, (len(motion.skeleton), 1))
    for name in motion.skeleton.names:
        if any(part in name for part in ("femur", "tibia", "foot", "toes")):
            turns[motion.skeleton.index(name)] = rotations.from_rotvec(np.radians([angles[0], 0, angles[1]]))
    body = rested(motion, turns)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        return with_standing_rest([body])[0] is body, bool(caught)


@pytest.mark.parametrize(
    ("angles", "kept"), [((40, 0), True), ((50, 0), False), ((0, 40), True), ((0, 50), False)]
)
def test_thighs_of_a_rest_pose_that_stands_are_within_45_degrees_of_vertical(angles, kept):
    assert rest_turned(angles) == (kept, not kept)


@pytest.mark.parametrize(("degrees", "kept"), [(25, True), (35, False)])
def test_hips_of_a_rest_pose_that_stands_are_within_30_degrees_of_level(degrees, kept):
    motion = all_alike(walk(), rotations.from_rotvec([0, 0, np.radians(degrees)]))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert (with_standing_rest([motion])[0] is motion) == kept
    assert bool(caught) != kept


def test_another_rest_pose_changes_no_position_in_any_frame_and_no_length_of_a_bone():
    motions = [odd(walk()), odd(walk("jog"))]
    with pytest.warns(MocapWarning, match=REPLACED):
        standing = with_standing_rest(motions)
    for old, new in zip(motions, standing, strict=True):
        np.testing.assert_allclose(joint_positions(new), joint_positions(old), atol=1e-9)
        lengths = np.linalg.norm(old.skeleton.offsets, axis=-1)
        np.testing.assert_allclose(np.linalg.norm(new.skeleton.offsets, axis=-1), lengths, atol=1e-12)
    assert np.array_equal(standing[0].skeleton.offsets, standing[1].skeleton.offsets)


def test_the_rest_pose_that_is_found_is_that_of_the_body_whatever_its_zero_pose():
    """Joint axes of a file mean nothing: the same motion gives the same pose."""
    with pytest.warns(MocapWarning, match=REPLACED):
        rests = [with_standing_rest([odd(walk(), seed)])[0].skeleton.rest for seed in (0, 1)]
    np.testing.assert_allclose(rests[0], rests[1], atol=1e-9)


def test_a_person_who_holds_still_rests_in_that_pose():
    motion = walk()[:1].at([0] * 20)
    with pytest.warns(MocapWarning, match=REPLACED):
        still = with_standing_rest([odd(motion)])[0]
    skeleton = motion.skeleton
    found = still.skeleton.rest
    pose = joint_positions(motion)[0] - joint_positions(motion)[0, 0]
    knees = [skeleton.index("ltibia"), skeleton.index("rtibia")]
    assert found[knees, 2].mean() == pytest.approx(pose[knees, 2].mean(), abs=0.02)
    head = skeleton.index("head")
    np.testing.assert_allclose(found[head], pose[head] * [0, 1, 1], atol=0.03)


def test_feet_that_hang_at_rest_are_laid_flat_and_nothing_else_changes():
    motion = on_tiptoe(walk())
    skeleton = motion.skeleton
    foot = skeleton.rest[skeleton.index("ltoes")] - skeleton.rest[skeleton.index("lfoot")]
    assert foot[1] < -0.9 * np.linalg.norm(foot)  # it hangs
    file = glb(motion)
    positions = check_bones(file)[:, :3, 3]
    assert np.ptp(positions[[skeleton.index(name) for name in ("lfoot", "ltoes", "rtoes")], 1]) < 0.01
    legs = [skeleton.index(name) for name in ("lfoot", "ltoes")]
    np.testing.assert_allclose(
        np.diff(positions[legs], axis=0)[0] / np.linalg.norm(foot), [0, 0, 1], atol=1e-6
    )
    kept = [joint for joint in range(len(skeleton)) if "toes" not in skeleton.names[joint]]
    rest = walk().skeleton.rest
    np.testing.assert_allclose((positions - positions[0])[kept], (rest - rest[0])[kept], atol=1e-6)
    np.testing.assert_allclose(file.poses(1.0)[:, :3, 3], joint_positions(motion)[30], atol=2e-5)


def test_the_joint_on_the_floor_has_the_heading_of_the_body_though_its_root_is_rotated():
    motion = walk()
    plain, turned = glb(motion, root=True), glb(lying(motion), root=True)
    for seconds in (0.0, 1.0, 2.0):
        np.testing.assert_allclose(turned.poses(seconds)[-1], plain.poses(seconds)[-1], atol=1e-5)


def test_a_body_on_which_nobody_stands_keeps_its_rest_pose():
    motion = random_motion(3, joints=7)
    positions = glb(motion).poses(0, rest=True)[:, :3, 3]
    rest = motion.skeleton.rest
    np.testing.assert_allclose(positions, rest - [0, rest[:, 1].min(), 0], atol=1e-6)


@given(seeds)
def test_any_skeleton_has_bones_along_y_that_are_bound_at_rest(seed):
    motion = random_motion(seed, joints=int(seed % 12) + 1)
    check_bones(glb(motion, root=bool(seed % 2)))


def test_frames_in_which_the_body_lies_do_not_decide_the_rest_pose():
    motion = BODIES["without sense"]()
    fallen = motion.rotations.copy()
    fallen[::3, 0] = rotations.multiply(rotations.from_rotvec([-np.pi / 2, 0, 0]), fallen[::3, 0])
    file = glb(replace(motion, rotations=fallen), expected=REPLACED)
    positions = file.poses(0, rest=True)[:, :3, 3]
    assert positions[:, 1].max() > 1.6


def test_axes_of_left_and_right_limbs_mirror_each_other():
    skeleton = samples.SKELETON
    y, z = (rotations.rotate(bone_axes(skeleton), axis) for axis in ([0, 1, 0], [0, 0, 1]))
    for left, right in limb_partners(skeleton).items():
        np.testing.assert_allclose(y[left] * MIRROR, y[right], atol=1e-6)
        np.testing.assert_allclose(z[left] * MIRROR, z[right], atol=1e-6)


def test_z_points_forward_in_trunk_legs_and_arms_and_up_in_feet():
    skeleton = samples.SKELETON
    joints = roles(skeleton)
    z = rotations.rotate(bone_axes(skeleton), [0, 0, 1])
    for role in ("pelvis", "waist", "chest", "neck", "left hip", "left knee", "left shoulder", "left elbow"):
        assert z[joints[role], 2] > 0.97, role
    assert z[joints["left ball"], 1] > 0.97


def z_of(*bones):
    """Return the z axis of each bone of a chain."""
    chain = Skeleton(
        [f"j{k}" for k in range(len(bones) + 1)], np.arange(len(bones) + 1) - 1, [[0, 0, 0], *bones]
    )
    return rotations.rotate(bone_axes(chain), [0, 0, 1])[:-1]


def elevated(degrees, heading=0.0):
    """Return a bone that runs forward and rises by an angle."""
    up, turn = np.radians([degrees, heading])
    return [np.cos(up) * np.sin(turn), np.sin(up), np.cos(up) * np.cos(turn)]


def test_bones_that_run_forward_take_the_axes_of_their_parent_and_others_point_z_forward():
    shin = [0, -1, 0]
    np.testing.assert_allclose(z_of(shin, elevated(-50))[1], elevated(40), atol=1e-12)
    np.testing.assert_allclose(
        z_of(shin, elevated(10), elevated(0))[1:], [elevated(100), elevated(90)], atol=1e-9
    )
    # Below 45° from forward the parent decides, beyond it the world.
    thumb = [elevated(0, 50), elevated(0, 40)]
    np.testing.assert_allclose(z_of([1, 0, 0], *thumb)[1:], [elevated(0, -40), elevated(0, -50)], atol=1e-9)
    np.testing.assert_allclose(z_of([0, 1, 0], elevated(46))[1], elevated(-44), atol=1e-9)
    np.testing.assert_allclose(z_of([0, 0, 1], elevated(44))[1], elevated(134), atol=1e-9)


def test_bones_at_the_root_or_behind_their_parent_have_z_up():
    np.testing.assert_allclose(z_of(elevated(20)), [elevated(110)], atol=1e-12)
    back = [0, -0.1, -1]
    z = z_of([0, 0, 1], back)[1]
    assert z[1] > 0.99 and abs(z @ back) < 1e-9
    beside = elevated(44, 0)
    np.testing.assert_allclose(z_of([0, -1, 0], beside)[1], elevated(134), atol=1e-9)  # 134° apart


CONTINUED = {  # joint: (parent, offset); the joint that the bone "a" points at
    "the spine, between the thighs": (
        {"a": ("", [0, 0, 0]), "lThigh": ("a", [0.1, -0.05, 0]), "lShin": ("lThigh", [0, -0.9, 0])}
        | {"rThigh": ("a", [-0.1, -0.05, 0]), "rShin": ("rThigh", [0, -0.9, 0]), "b": ("a", [0, 0.1, 0.01])},
        "b",
    ),
    "the shin, beside a joint for twists": (
        {"a": ("", [0, 0, 0]), "twist": ("a", [0, -0.2, 0]), "b": ("a", [0.01, -0.4, 0])}
        | {"c": ("b", [0, -0.4, 0])},
        "b",
    ),
    "the toes, beside a heel": (
        {"a": ("", [0, 0, 0]), "heel": ("a", [0, -0.05, -0.06]), "b": ("a", [0, -0.05, 0.13])},
        "b",
    ),
    "the only child at a distance": (
        {
            "a": ("", [0, 0, 0]),
            "target": ("a", [0, 0, 0]),
            "far": ("target", [0, 0, 3]),
            "b": ("a", [0, 1, 0]),
        },
        "b",
    ),
}


@pytest.mark.parametrize("case", CONTINUED)
def test_a_bone_with_several_children_points_at_the_one_that_continues(case):
    rows, child = CONTINUED[case]
    skeleton = Skeleton.from_table(rows)
    offset = skeleton.offsets[skeleton.index(child)]
    np.testing.assert_allclose(bone_directions(skeleton)[0], offset / np.linalg.norm(offset), atol=1e-12)


def test_a_bone_without_a_direction_of_its_own_continues_that_of_its_parent():
    names = ["hips", "left", "right", "middle", "end"]
    offsets = [[0, 0, 0], [0.1, 0, 0], [-0.1, 0, 0], [0, 0.2, 0.2], [0, 0, 0]]
    skeleton = Skeleton(names, [-1, 0, 0, 0, 3], offsets)
    directions = bone_directions(skeleton)
    for joint, offset in ((1, [1, 0, 0]), (3, [0, 1, 1]), (4, [0, 1, 1])):
        np.testing.assert_allclose(directions[joint], offset / np.linalg.norm(offset))
    pair = Skeleton(names[:3], [-1, 0, 0], offsets[:3])
    np.testing.assert_allclose(bone_directions(pair)[0], [0, 1, 0])  # two bones that cancel, at the root


def test_captured_bodies_whose_bones_rest_along_one_line_stand(real_data):
    folder = real_data / "bvh/bandai_namco"
    for name in ("dataset-1_run_normal_001", "dataset-2_walk_elderly_001"):
        motion = load_save.load(folder / f"{name}.bvh")[:90]
        file = glb(motion, expected=REPLACED)
        assert check_bones(file)[:, 1, 3].max() > 1.25
        exact = joint_positions(motion)
        np.testing.assert_allclose(file.poses(20 / motion.fps)[:, :3, 3], exact[20], atol=2e-5)
