"""Joints and their roles, how bodies stand, at rest and on average, and left and right swapped."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap import load
from mocap.body import Motion, PlanarTransform, Skeleton, joint_positions, resample, rotations
from mocap.body.foot_joints import feet_of
from mocap.body.limbs import FEET, ROLES, roles
from mocap.body.motion import rotating_joints
from mocap.datasets.samples import SKELETON, sample
from mocap.editing.foot_heights import standing_heights
from mocap.editing.mirroring import mirror, mirror_above_floor, symmetry
from mocap.editing.proportions import proportioned
from mocap.editing.stances import Stance, stance_of, stance_of_zero
from mocap.editing.toes import bend_toes, lowest_allowed
from mocap.feet.footplants import mark_plants
from mocap.files import load_save
from tests.editing.bodies import NAMINGS, adult, along_x, child, renamed, rested, walk, without
from tests.refusals import refusals, refused, told, unwarned
from tests.strategies import random_quaternions, seeds


def degrees_apart(a, b):
    return np.degrees(rotations.angle_between(a, b))


def test_the_bundled_rest_pose_stands_on_flat_feet():
    stance = adult()
    for side in ("left", "right"):
        ankle, ball = (stance.points[stance.roles[f"{side} {part}"]] for part in ("ankle", "ball"))
        drop = stance.heights[f"{side} ankle"] - stance.heights[f"{side} ball"]
        assert ankle[1] - ball[1] == pytest.approx(drop)
    assert stance.height("ankle") == pytest.approx(0.068, abs=0.001)
    assert stance.leg == pytest.approx(0.491 * 1.75)


def test_feet_that_hang_at_rest_are_laid_flat():
    hanging = np.tile([1.0, 0, 0, 0], (len(walk().skeleton), 1))
    for foot in ("lfoot", "ltoes"):
        hanging[walk().skeleton.index(foot)] = rotations.from_rotvec([-0.9, 0, 0])
    clip = rested(walk(), hanging)
    stance = stance_of(clip)
    assert np.allclose(stance.points, adult().points)
    straight_down = np.tile([1.0, 0, 0, 0], (len(walk().skeleton), 1))
    bone = clip.skeleton.offsets[clip.skeleton.index("ltoes")]
    straight_down[clip.skeleton.index("lfoot")] = rotations.between([0, -1, 0], walk().skeleton.offsets[5])
    down = stance_of_zero(rested(walk(), straight_down).skeleton, standing_heights(walk(), adult().roles))
    foot = down.points[down.roles["left ball"]] - down.points[down.roles["left ankle"]]
    assert foot[2] > 0.9 * np.linalg.norm(bone)  # a foot that points nowhere is laid ahead


def test_a_walk_gives_the_stance_that_the_rest_pose_gives():
    mean = stance_of(walk(), mean=True)
    arms_and_legs = [joint for r, joint in mean.roles.items() if r.split()[-1] not in ("elbow", "wrist")]
    assert degrees_apart(mean.turns, adult().turns)[arms_and_legs].max() < 38  # at the shoulders
    assert degrees_apart(mean.turns, adult().turns)[mean.roles["pelvis"]] < 5
    feet = [mean.roles[role] for role in FEET]
    assert degrees_apart(mean.turns, adult().turns)[feet].max() < 5
    assert mean.heights == adult().heights


@settings(max_examples=5)
@given(angle=st.floats(-3, 3), x=st.floats(-9, 9))
def test_where_a_walk_heads_does_not_matter(angle, x):
    moved = PlanarTransform(angle, x, 1.0).apply_motion(walk(2.0))
    here, there = stance_of(walk(2.0), mean=True), stance_of(moved, mean=True)
    assert degrees_apart(here.turns, there.turns).max() < 1e-5


def test_a_rest_pose_that_means_nothing_is_not_believed():
    clip = rested(walk(), along_x(walk().skeleton))
    refused(r"does not stand: its hips are .*; give stance_of a walk", stance_of_zero, clip.skeleton, 0.03)
    assert np.allclose(stance_of(clip).points, stance_of(walk(), mean=True).points)
    backwards = np.tile(rotations.about_y(np.pi), (len(walk().skeleton), 1))
    refused("180° off level", stance_of_zero, rested(walk(), backwards).skeleton, 0.03)


def test_plants_are_marked_where_they_are_not_yet():
    bare = replace(walk(), contacts={})
    assert stance_of(bare).heights == standing_heights(mark_plants(bare), adult().roles)
    assert stance_of(bare).heights == pytest.approx(adult().heights, abs=0.002)


def test_feet_that_never_stand_flat_and_feet_that_never_stand():
    never = np.zeros(len(walk()), bool)
    tiptoe = {**walk().contacts, "lfoot": walk().contacts["rfoot"], "ltoes": never, "rfoot": never}
    raised = replace(walk(), contacts=tiptoe)
    refused("In 'walk_straight' the left ball never stands", standing_heights, raised, adult().roles)
    apart = {**walk().contacts, "ltoes": walk().contacts["ltoes"] & ~walk().contacts["lfoot"]}
    loose = replace(walk(), contacts=apart)
    assert standing_heights(loose, adult().roles)["left ball"] == pytest.approx(0.026, abs=0.003)
    assert np.isfinite(stance_of(loose, mean=True).turns).all()


def in_the_rest_pose(frames=2, root=(0.0, 0.97, 0.0), ankles=0.0):
    """Return a pose of the bundled body with straight legs, and its feet tilted by an angle, radians."""
    turns = np.tile([1.0, 0, 0, 0], (frames, len(SKELETON), 1))
    for foot in ("lfoot", "rfoot"):
        turns[:, SKELETON.index(foot)] = rotations.from_rotvec([ankles, 0, 0])
    return Motion(SKELETON, np.tile(root, (frames, 1)), turns, 30.0, "pose")


@pytest.mark.parametrize("frames", [1, 2])
@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_a_standing_pose_of_one_or_two_frames_is_the_stance_wherever_it_heads(frames, angle):
    pose = PlanarTransform(angle, 3.0, -1.0).apply_motion(in_the_rest_pose(frames, (0, 1.07, 0), ankles=0.4))
    stance = unwarned(stance_of, pose)
    points = joint_positions(in_the_rest_pose(1, (0, 1.07, 0), ankles=0.4))[0]
    assert np.allclose(stance.points - stance.points[0], points - points[0])
    ankles = [points[stance.roles[f"{side} ankle"], 1] for side in ("left", "right")]
    assert [stance.heights[f"{side} ankle"] for side in ("left", "right")] == pytest.approx(ankles)
    flat = stance_of_zero(SKELETON, 0.03)  # what the rest pose alone would give
    assert degrees_apart(stance.turns, flat.turns)[stance.roles["left ankle"]] > 15


def test_a_pose_that_is_relative_to_its_root_is_put_on_the_floor_with_a_sentence():
    pose = in_the_rest_pose(root=(0.0, 0.0, 0.0))
    stance = told("the lowest joint is 1.00 m below y = 0, and is taken to be on the floor", stance_of, pose)
    assert min(stance.heights.values()) < 0.03
    lowest = joint_positions(pose)[0, :, 1].min()
    assert stance.heights["left ankle"] == pytest.approx(
        joint_positions(pose)[0, stance.roles["left ankle"], 1] - lowest
    )


def test_a_stride_and_a_body_that_lies_are_no_stances():
    for frame in range(0, 120, 10):
        refused(
            "The pose in 'walk_straight' does not stand: one ankle is", stance_of, walk()[frame : frame + 1]
        )
    turns = in_the_rest_pose().rotations.copy()
    turns[:, 0] = rotations.from_rotvec([-np.pi / 2, 0, 0])
    refused("its thighs 90° off hanging", stance_of, replace(in_the_rest_pose(), rotations=turns))


def test_a_run_takes_the_heights_of_other_clips_of_its_body_or_of_balls_alone():
    never = np.zeros(len(walk()), bool)
    run = replace(walk(), name="run", contacts={**walk().contacts, "lfoot": never, "rfoot": never})
    assert unwarned(stance_of, run, clips=[walk(2.0)]).heights == stance_of(walk(2.0)).heights
    other_body = replace(walk(), skeleton=child().skeleton)
    alone = told(
        "'run' the left ankle never stands.*estimated from the balls", stance_of, run, clips=[other_body]
    )
    assert alone.heights == pytest.approx(adult().heights, abs=0.012)
    hop = replace(run, contacts={**run.contacts, "ltoes": never})
    left, right = (told("never stands", stance_of, hop).heights[f"{side} ball"] for side in ("left", "right"))
    assert left == right
    refused(
        "In 'run' no foot ever stands", stance_of, replace(run, contacts=dict.fromkeys(run.contacts, never))
    )


def lengths(stance, *roles):
    return [np.linalg.norm(stance.skeleton.offsets[stance.roles[role]]) for role in roles]


def test_each_part_has_its_share():
    new = proportioned(adult(), legs=0.5, trunk=0.6, arms=0.7, head=0.8)
    for share, parts in {
        0.5: ["left knee", "right ankle", "right ball"],
        0.6: ["chest", "left shoulder", "left hip"],
        0.7: ["left elbow", "right wrist"],
        0.8: ["head"],
    }.items():
        assert lengths(new, *parts) == pytest.approx(share * np.array(lengths(adult(), *parts)))
    assert new.heights == pytest.approx({role: 0.5 * height for role, height in adult().heights.items()})
    assert new.leg == pytest.approx(0.5 * adult().leg)


def on_tiptoe():
    still = np.tile([1.0, 0, 0, 0], (len(walk().skeleton), 1))
    heights = {role: 0.2 * role.endswith("ankle") for role in FEET}
    return Stance(walk().skeleton, adult().roles, still, heights)


test_shares_and_heights_that_no_body_has_are_refused = refusals(
    ("left ankle would stand 20 cm over its ball; the foot is 13", on_tiptoe),
    *(
        ("The factor of the arms must be above 0", lambda share=share: proportioned(adult(), arms=share))
        for share in (0, -1, np.nan, np.inf)
    ),
)


FILES = {
    "cmu/49/49_01.amc": "root lowerback thorax lowerneck lwrist",
    "bvh/imusim/16_15.bvh": "root lowerback thorax lowerneck lwrist",
    "bvh/bandai_namco/dataset-1_walk_normal_001.bvh": "Hips Spine Chest Neck Hand_L",
    "bvh/puppy0512_motion_graph/walk_normal_stright.bvh": "pelvis - thorax - lhand",
    "bvh/olaf_bvh_toolbox/walk01.bvh": "Hips Spine Spine1 Neck LeftHand",
    "bvh/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh": "Hips - Spine - LeftHand",
    "bvh/pybvh/bvh_test1.bvh": "Hips Spine Spine3 Neck LeftHand",
    "bvh/20tab/test_mocapbank.bvh": "Hips Chest Chest2 Neck LeftWrist",
}


def test_the_bundled_body_has_all_roles():
    found = roles(SKELETON)
    assert list(found) == list(ROLES)
    assert [SKELETON.names[found[f"{side} ball"]] for side in ("left", "right")] == ["ltoes", "rtoes"]


@pytest.mark.parametrize("names", NAMINGS)
def test_names_do_not_matter_where_they_are_known(names):
    body = renamed(walk(), names).skeleton
    assert {role: SKELETON.names[joint] for role, joint in roles(body).items()} == {
        role: SKELETON.names[joint] for role, joint in roles(SKELETON).items()
    }
    prefixed = renamed(walk(), {name: f"mixamorig:{names.get(name, name)}" for name in SKELETON.names})
    assert roles(prefixed.skeleton) == roles(body)


def test_the_trunk_is_found_by_the_tree():
    short = without(walk(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck", "upperneck")
    found = roles(short.skeleton)
    assert short.skeleton.names[found["chest"]] == "thorax"
    assert {"waist", "neck", "left clavicle", "right clavicle"}.isdisjoint(found)
    armless = renamed(walk(), {"lhumerus": "wing"})
    assert "chest" not in roles(armless.skeleton)  # nothing says where the arms meet
    legs = without(walk(), *SKELETON.names[13:]).skeleton
    assert set(roles(legs)) == {"pelvis"} | {r for r in ROLES if r.split()[-1] in "hip knee ankle ball"}
    spider = without(walk(), "lowerback", "upperback", "thorax", "lclavicle", "rclavicle")
    assert "chest" not in roles(spider.skeleton)


@pytest.mark.parametrize("name", FILES)
def test_files_of_many_makers(real_data, name):
    body = load(real_data / name).skeleton
    found = roles(body)
    shown = [body.names[found[role]] if role in found else "-"
             for role in ("pelvis", "waist", "chest", "neck", "left wrist")]  # fmt: skip
    assert shown == FILES[name].split()
    assert len(found) == 21 - shown.count("-")


test_a_body_without_known_legs_says_what_was_tried_and_what_to_do = refusals(
    (
        r"No legs found among vertebra.*name them by roles=",
        roles,
        Skeleton([f"vertebra_number_{n}" for n in range(30)], np.arange(30) - 1, np.ones((30, 3))),
    )
)


WALK = resample(sample("walk_curve_1"), 30)[:150]


def reflected(motion):
    """Return where the joints of a mirror image must be: those of the partners, with x the other way."""
    return joint_positions(motion)[:, symmetry(motion.skeleton)[0]] * [-1, 1, 1]


@given(seeds)
@settings(max_examples=8)
def test_joints_are_where_a_mirror_shows_them_wherever_axes_point_and_twice_is_the_identity(seed):
    odd = rested(WALK, random_quaternions(np.random.default_rng(seed), len(WALK.skeleton)))
    assert np.abs(joint_positions(odd) - joint_positions(WALK)).max() < 1e-9
    for motion in (WALK, odd):
        image = mirror(motion)
        assert np.abs(joint_positions(image) - reflected(motion)).max() < 1e-12
        twice = mirror(image)
        assert np.abs(joint_positions(twice) - joint_positions(motion)).max() < 1e-12
        assert np.abs(np.abs((twice.rotations * motion.rotations).sum(-1)) - 1).max() < 1e-12
        assert twice.name == motion.name


def test_where_all_axes_of_a_side_point_the_other_way_a_knee_bends_as_its_partner_does():
    """By other angles it would bend the same, but a blend of both would turn it round."""
    leg = ("rfemur", "rtibia", "rfoot", "rtoes", "rtoes_end")
    axes = np.tile(rotations.IDENTITY, (len(WALK.skeleton), 1))
    axes[[WALK.skeleton.index(name) for name in leg]] = [0.0, 1.0, 0.0, 0.0]
    there, here = rested(mirror(WALK), axes), mirror(rested(WALK, axes))
    assert rotations.angle_between(there.rotations, here.rotations).max() < 1e-6


def test_the_end_of_a_chain_that_never_turns_does_not_turn_in_the_mirror_either():
    """A bent foot is no mirror image of its partner, so its joint is turned; the toe's end below is not."""
    offsets = WALK.skeleton.offsets.copy()
    for name in ("lwrist", "rtoes", "rtoes_end"):
        joint = WALK.skeleton.index(name)
        offsets[joint] = rotations.rotate(rotations.from_rotvec([0.1, 0.3, -0.2]), offsets[joint])
    body = replace(WALK.skeleton, offsets=offsets)
    image = mirror(replace(WALK, skeleton=body))
    ends = [joint for joint in range(len(body)) if not body.children(joint)]
    assert not rotating_joints(WALK)[ends].any()
    assert not rotating_joints(image)[ends].any()


def test_plants_and_words_change_sides():
    left = np.arange(len(WALK)) % 2 == 0
    marked = replace(WALK, labels={"turn left": left, "Right": ~left, "walk": True})
    image = mirror(marked)
    assert np.array_equal(image.labels["turn right"], left)
    assert np.array_equal(image.labels["Left"], ~left)
    for one, other in (("lfoot", "rfoot"), ("ltoes", "rtoes")):
        assert np.array_equal(image.contacts[one], WALK.contacts[other])
    found = mark_plants(replace(image, contacts={}))  # they are there, as the feet stand, not only by name
    assert (found.contacts["lfoot"] == image.contacts["lfoot"]).mean() > 0.97


def test_a_lopsided_body_is_mirrored_with_a_sentence():
    offsets = WALK.skeleton.offsets.copy()
    offsets[WALK.skeleton.index("ltibia")] *= 1.1
    lopsided = replace(WALK, skeleton=replace(WALK.skeleton, offsets=offsets))
    image = told(r"bones differ by up to 43 mm \(ltibia\)", mirror, lopsided)
    assert np.allclose(image.skeleton.offsets, offsets)
    assert np.abs(joint_positions(image) - reflected(lopsided)).max() < 0.06
    unwarned(mirror, WALK)


def test_longer_toes_of_one_side_do_not_sink_in_the_mirror():
    offsets = WALK.skeleton.offsets.copy()
    offsets[WALK.skeleton.index("ltoes_end")] *= 2
    lopsided = replace(WALK, skeleton=replace(WALK.skeleton, offsets=offsets))
    lopsided = bend_toes(lopsided, lowest_allowed(WALK, feet_of(WALK)), feet_of(WALK))
    lowest = joint_positions(lopsided)[..., 1].min()
    plain, raised = (told("bones differ by up to", call, lopsided) for call in (mirror, mirror_above_floor))
    assert joint_positions(plain)[..., 1].min() < lowest - 0.003
    assert joint_positions(raised)[..., 1].min() > lowest - 0.0011


def test_a_captured_mirror_image_on_a_longer_leg_is_raised_to_the_floor(real_data):
    clip = load(real_data / "cmu/127/127_33.amc")
    plain, raised = (told("bones differ by up to", call, clip) for call in (mirror, mirror_above_floor))
    lowest = min(0.0, joint_positions(clip)[..., 1].min())
    assert joint_positions(plain)[..., 1].min() < lowest - 0.005
    assert joint_positions(raised)[..., 1].min() > lowest - 0.0011


def with_sword(motion, *, side="r"):
    """Hang a sword of two bones on a hand; it turns in the hand."""
    body = motion.skeleton
    hand = body.index(f"{side}hand")
    names = [*body.names, "hilt", "point"]
    offsets = np.vstack([body.offsets, [[0.0, 0.0, 0.1], [0.0, 0.0, 0.8]]])
    skeleton = Skeleton(names, [*body.parents, hand, len(body)], offsets)
    turns = np.zeros((len(motion), 2, 3))
    turns[:, 0, 0] = np.linspace(0.0, 1.0, len(motion))
    both = np.concatenate([motion.rotations, rotations.from_rotvec(turns)], axis=1)
    return replace(motion, skeleton=skeleton, rotations=both)


@pytest.mark.parametrize("names", ["known", "unknown"])
def test_a_sword_stays_in_its_hand_as_it_was_held_and_the_body_is_mirrored(names):
    armed = with_sword(WALK)
    if names == "unknown":
        armed = renamed(armed, {name: f"j{n}" for n, name in enumerate(armed.skeleton.names)})
    mirrored = told("only one side has '(hilt|j38)', which stays there", mirror, armed)
    assert np.abs(joint_positions(mirrored)[:, :-2] - joint_positions(mirror(WALK))).max() < 1e-9
    assert (mirrored.rotations[:, -2:] == armed.rotations[:, -2:]).all()
    again = told("which stays there", mirror, mirrored)
    assert np.abs(joint_positions(again) - joint_positions(armed)).max() < 1e-9


ARM = Skeleton(["root", "elbow", "hand"], [-1, 0, 1], np.eye(3))
ODD = Skeleton(["root", "lhip", "rhip", "lknee", "rknee"], [-1, 0, 0, 1, 0], np.eye(5)[:, :3])

test_what_has_no_sides_is_refused = refusals(
    ("No left and right joints here: root, elbow, hand", symmetry, ARM),
    ("'lknee' has no mirror image: its side has other joints", symmetry, ODD),
)


@pytest.mark.filterwarnings("ignore::mocap.errors.MocapWarning")
def test_files_of_many_programs(real_data):
    clips = {
        "bvh/bandai_namco/dataset-2_walk-turn-left_normal_001.bvh": 1e-3,  # all bones along their own x
        "bvh/20tab/test_freebvh.bvh": 1e-3,
        "bvh/puppy0512_motion_graph/walk_normal_left_45.bvh": 1e-3,
        "bvh/pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh": 1e-3,
        "cmu/16/16_17.amc": 0.04,  # captured: left and right bones differ
    }
    for name, close in clips.items():
        clip = load_save.load(real_data / name)
        image = mirror(clip)
        assert np.abs(joint_positions(image) - reflected(clip)).max() < close, name
        assert np.abs(joint_positions(mirror(image)) - joint_positions(clip)).max() < 1e-12
