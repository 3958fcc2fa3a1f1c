"""Limbs are found by bones and motion, under any names, and what is doubtful is told."""

import pickle
from dataclasses import replace

import limb_schemes
import numpy as np
import pytest
from limb_schemes import LEG, ODDITIES, SCHEMES, random_names, scheme_rig, walker, wrong_roles

from mocap.body import limbs, rotations
from mocap.body.limb_partners import limb_partners
from mocap.body.limb_search import find_limbs
from mocap.body.limbs import find_legs, roles, with_roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.datasets import SAMPLES, sample
from mocap.datasets.samples import SKELETON
from mocap.errors import MocapWarning
from tests.editing.bodies import along_x, renamed, rested, without
from tests.refusals import refusals

SHOWN = ("Mixamo, colon", "Unreal mannequin", "3ds Max Biped, spaces", "Rigify, DEF", "VRM", "Daz Genesis 8",
         "Character Creator", "SMPL", "ARKit", "Second Life", "MakeHuman, BVH", "OpenPose", "MikuMikuDance",
         "SOMA, BONES-SEED")  # fmt: skip
FINGERS = ("thumb", "index", "middle", "ring", "little")
DOUBTS = {
    "wings": "the arms end at",
    "no forearms": "no second pair",
    "only legs": "no second pair",
    "one frame": "hardly bend",
}


def limbs_of(rig, names=None, up=(0, 1, 0)):
    """Find the limbs of a rig whose joints have these names, or numbers."""
    numbers = {name: f"joint{number}" for number, name in enumerate(rig.names())}
    skeleton, positions = rig.skeleton(numbers if names is None else names)
    return find_limbs(skeleton, positions, up)


@pytest.mark.parametrize("name", SHOWN)
def test_limbs_of_public_schemes_are_found(name):
    rig, names = scheme_rig(SCHEMES[name], "jog")
    found = limbs_of(rig, names)
    assert (wrong_roles(rig, found), found.doubts) == ([], ())


@pytest.mark.sweep
@pytest.mark.parametrize("clip", SAMPLES)
def test_limbs_of_all_schemes_are_found_in_all_bundled_clips(clip):
    assert len(SCHEMES) == 43
    for rig, names in limb_schemes.rigs(clip).values():
        assert wrong_roles(rig, limbs_of(rig, names)) == []


@pytest.mark.parametrize("name", ODDITIES)
def test_odd_bodies_have_limbs_and_what_is_open_is_told(name):
    rig = limb_schemes.odd_rig(ODDITIES[name])
    found = limbs_of(rig)
    assert wrong_roles(rig, found) == []
    told = " ".join(found.doubts)
    assert DOUBTS.get(name, "") in told
    assert bool(told) == (name in DOUBTS)


@pytest.mark.parametrize("seed", range(5))
def test_names_at_random_change_no_role(seed):
    for name in ("Unreal mannequin", "VRM", "Rigify, DEF"):
        rig, names = scheme_rig(SCHEMES[name])
        anonymous = limbs_of(rig, random_names(rig, seed))
        assert anonymous == limbs_of(rig, names)


@pytest.mark.parametrize("seed", [3, 5, 12, 20, 33, 46])
def test_limbs_of_rigs_of_three_kinds_at_a_time_are_found_or_their_doubts_are_told(seed):
    kinds, rig = limb_schemes.mixed_rig(seed)
    found = limbs_of(rig, random_names(rig, seed))
    assert len(kinds) == 3
    assert found.doubts or wrong_roles(rig, found) == []


@pytest.mark.sweep
def test_most_rigs_of_three_kinds_are_right_and_no_other_is_silent():
    right = 0
    for seed in range(60):
        _, rig = limb_schemes.mixed_rig(seed)
        found = limbs_of(rig, random_names(rig, seed))
        wrong = wrong_roles(rig, found)
        right += not wrong
        assert found.doubts or not wrong
    assert right >= 55


def test_a_head_without_a_neck_is_not_its_end_site():
    rig = walker()
    limb_schemes.without("neck1", "neck2")(rig)
    skeleton, positions = rig.skeleton({})
    joints = find_limbs(skeleton, positions).roles
    assert "neck" not in joints
    assert skeleton.names[joints["head"]] == "head"


def test_a_joint_for_the_face_at_the_position_of_the_head_is_not_the_head():
    rig = limb_schemes.odd_rig(ODDITIES["a joint for the face"])
    skeleton, positions = rig.skeleton({})
    assert skeleton.names[find_limbs(skeleton, positions).roles["head"]] == "head"


@pytest.mark.parametrize(("scale", "turn"), [(0.01, 0.0), (100.0, 1.0), (39.37, 2.5)])
def test_neither_unit_nor_heading_nor_up_axis_changes_a_role(scale, turn):
    rig, names = scheme_rig(SCHEMES["Unreal mannequin"])
    skeleton, positions = rig.skeleton(names)
    turned = rotations.rotate(rotations.about_y(turn), positions) * scale
    lying = turned[..., [0, 2, 1]] * [1, -1, 1]  # z up
    usual = find_limbs(skeleton, positions)
    assert find_limbs(skeleton, turned) == usual
    assert find_limbs(skeleton, lying, [0, 0, 1]) == usual


@pytest.mark.parametrize("up", [[1, 0, 0], [0, 0, 1], [0, 0, -1], [0, -1, 0]])
def test_a_wrong_axis_is_told(up):
    rig, names = scheme_rig(SCHEMES["Mixamo, colon"])
    assert any("up is another axis" in doubt for doubt in limbs_of(rig, names, up).doubts)


def test_a_mirror_image_has_its_sides_exchanged_and_the_names_are_told_to_be_wrong():
    walk = sample("walk_straight")
    found = find_limbs(SKELETON, walk.positions)
    image = find_limbs(SKELETON, walk.positions * [-1, 1, 1])
    assert {SKELETON.names[image.roles[f"left {part}"]] for part in LEG} == {
        SKELETON.names[found.roles[f"right {part}"]] for part in LEG
    }
    assert image.doubts == ("the names say left where the motion says right",) or image.doubts == ()
    names = {name: name.replace("l", "left_", 1) for name in SKELETON.names if name.startswith("l")}
    worded = renamed(walk, names).skeleton
    assert "names say left" in " ".join(find_limbs(worded, walk.positions * [-1, 1, 1]).doubts)


def test_a_pose_that_shows_no_side_takes_it_from_the_names():
    rig = walker()
    limb_schemes.without("ball", "tip")(rig)
    for side in limb_schemes.SIDES:  # straight limbs under the hips, in one frame
        for role, height in (("knee", 0.5), ("ankle", 0.1), ("elbow", 1.1), ("wrist", 0.9)):
            top = "hip" if role in LEG else "shoulder"
            rig.positions[f"{side} {role}"] = rig.positions[f"{side} {top}"] * [1, 0, 1] + [0, height, 0]
    rig.positions = {name: places[:1] for name, places in rig.positions.items()}
    doubts = limbs_of(rig).doubts
    assert any("guessed" in doubt for doubt in doubts)
    named = limbs_of(rig, {})  # "left hip" and so on
    assert any("taken from the names" in doubt for doubt in named.doubts)
    assert rig.names()[named.roles["left hip"]] == "left hip"


@pytest.mark.parametrize(
    ("parents", "places"),
    [
        ([-1], [[0, 0, 0]]),
        ([-1, 0, 0], np.zeros((3, 3))),
        ([-1, 0, 1, 2], np.outer(range(4), [0, 1, 0])),
        ([-1, 0, 0, 1, 2], [[0, 1, 0], [1, 0, 0], [-1, 0, 0], [1, -1, 0], [-1, -1, 0]]),
    ],
)
def test_what_is_no_body_has_no_limbs(parents, places):
    skeleton = Skeleton([f"j{n}" for n in range(len(parents))], parents, np.zeros((len(parents), 3)))
    found = find_limbs(skeleton, np.array([places, places], float))
    assert found == ({}, ("no two limbs are mirror images of each other",))


@pytest.mark.parametrize("name", ["skis", "two swords"])
def test_rigid_things_on_feet_and_hands_are_in_doubt_in_a_single_pose(name):
    rig = limb_schemes.odd_rig((*ODDITIES[name], limb_schemes.one_frame))
    assert "hardly bend" in " ".join(limbs_of(rig).doubts)


@pytest.mark.parametrize("height", [0.3, 0.6])
def test_stilts_of_any_height_are_below_the_ankles(height):
    stilts = limb_schemes.held("ankle", (0.0, -0.05, 0.0), (0.0, -height, 0.0))
    rig = limb_schemes.odd_rig((stilts,), "walk_circle")
    assert wrong_roles(rig, limbs_of(rig)) == []


def test_long_bones_below_the_legs_are_told():
    rig = limb_schemes.odd_rig((limb_schemes.flat_toes, limb_schemes.split_bones, limb_schemes.noise))
    found = limbs_of(rig)
    assert not wrong_roles(rig, found) or "below the ankles" in " ".join(found.doubts)


def test_a_dog_has_more_than_two_legs():
    rig = walker()
    limb_schemes.without("clavicle", "hand")(rig)
    for side in limb_schemes.SIDES:  # forelegs that step as the legs do
        for role, role_of_leg in (("shoulder", "hip"), ("elbow", "knee"), ("wrist", "ankle")):
            rig.positions[f"{side} {role}"] = rig.positions[f"{side} {role_of_leg}"] + [0, -0.05, 0.6]
    assert "more than two limbs are on the floor" in limbs_of(rig).doubts[0]


# What a skeleton makes of it --------------------------------------------------------------------------------


WALK = sample("walk_straight")[:240]


def anonymous(motion: Motion) -> Motion:
    """Give all joints numbers for names."""
    return renamed(motion, {name: f"bone{n:02d}" for n, name in enumerate(motion.skeleton.names)})


def test_fingers_are_paired_and_a_sword_in_one_hand_is_not():
    rig = limb_schemes.odd_rig(ODDITIES["a sword"])
    skeleton, positions = rig.skeleton({})
    roles = {role: skeleton.names[joint] for role, joint in find_limbs(skeleton, positions).roles.items()}
    pairs = limb_partners(replace(skeleton, roles=roles))
    names = {skeleton.names[left]: skeleton.names[right] for left, right in pairs.items()}
    fingers = [name for name in skeleton.names if name.startswith("left") and name.split()[1] in FINGERS]
    assert len(fingers) == 15
    assert all(names[name] == name.replace("left", "right") for name in fingers)
    assert not any("sword" in name for pair in names.items() for name in pair)


def test_a_motion_with_known_names_stays_as_it_is():
    assert with_roles(WALK) is WALK


def test_numbers_for_names_have_the_roles_of_the_motion():
    motion = with_roles(anonymous(WALK))
    assert find_legs(motion.skeleton) == find_legs(SKELETON)
    by_motion = roles(motion.skeleton)
    by_name = roles(SKELETON)
    differing = {role for role in by_name if by_name[role] != by_motion.get(role)}
    assert differing == {"left wrist", "right wrist"}  # by names it is a joint that only twists
    assert with_roles(motion) is motion  # they are looked for once


def test_roles_survive_what_is_made_of_a_motion():
    motion = with_roles(anonymous(WALK))
    pickled = pickle.loads(pickle.dumps(motion))
    assert pickled == motion
    for made in (motion[10:50], motion.at([0.5, 1.5]), replace(motion, name="other"), pickled):
        assert made.skeleton.roles == motion.skeleton.roles
    assert motion.skeleton != anonymous(WALK).skeleton
    motion.skeleton.require_same(anonymous(WALK).skeleton)  # it asks for joints and bones only


def test_without_a_motion_the_rest_pose_is_used_and_said_once():
    limbs._limbs_at_rest.cache_clear()
    skeleton = anonymous(WALK).skeleton
    with pytest.warns(MocapWarning, match=r"by its rest pose alone the left leg is 'bone02', .*hardly bend"):
        assert find_legs(skeleton) == find_legs(SKELETON)
    find_legs(skeleton)  # no second warning, which would be an error


def test_a_rest_pose_that_means_nothing_does_not_matter_where_there_is_a_motion():
    odd = with_roles(anonymous(rested(WALK, along_x(SKELETON))))
    assert find_legs(odd.skeleton) == find_legs(SKELETON)


def test_names_by_hand_replace_what_is_found():
    names = {"left ball": "ltoes_end", "right ball": "", "chest": "upperback"}
    body = with_roles(WALK, names).skeleton
    left, right = find_legs(body)
    assert body.names[left.ball] == "ltoes_end"
    assert not right.has_ball
    assert body.names[roles(body)["chest"]] == "upperback"


def test_known_legs_keep_their_sides_where_only_the_arms_are_unknown():
    walk = renamed(WALK, {"lhumerus": "wing1", "rhumerus": "wing2"})
    found = roles(with_roles(walk).skeleton)
    assert {role: found[role] for role in ("left shoulder", "right elbow", "left ball", "chest")} == {
        role: roles(SKELETON)[role] for role in ("left shoulder", "right elbow", "left ball", "chest")
    }


def test_a_heel_that_is_listed_before_the_toes_is_no_ball_in_a_motion():
    rig = limb_schemes.odd_rig((limb_schemes.heels,))
    names = {"left heel": "lheel", "right heel": "rheel"}
    names |= {role: name for name, role in limb_schemes.ROLES.items()}
    skeleton, _ = rig.skeleton(names)
    heel, ball = (skeleton.index(name) for name in ("lheel", "ltoes"))
    assert heel < ball
    turns = np.tile(rotations.IDENTITY, (len(WALK), len(skeleton), 1))
    for joint, name in enumerate(skeleton.names):
        if name in SKELETON.names:
            turns[:, joint] = WALK.rotations[:, SKELETON.index(name)]
    rest = np.array([SKELETON.offsets[SKELETON.index(name)] if name in SKELETON.names else [0, -0.05, -0.05]
                     for name in skeleton.names])  # fmt: skip
    motion = with_roles(Motion(replace(skeleton, offsets=rest), WALK.root_positions, turns, WALK.fps))
    assert find_legs(motion.skeleton)[0].ball == ball


def test_doubts_about_unknown_legs_are_told():
    with pytest.warns(MocapWarning, match=r"limbs are unsure: .*hardly bend.*mocap info FILE --joints"):
        with_roles(anonymous(WALK[:1]))


test_wrong_roles_are_refused = refusals(
    ("No role 'left foot'; there are pelvis,", with_roles, WALK, {"left foot": "lfoot"}),
    ("No joint 'Foot_L'", with_roles, WALK, {"left ankle": "Foot_L"}),
    ("No joint 'thigh'", lambda: replace(SKELETON, roles={"left hip": "thigh"})),
    (
        "each joint hangs on the one before, but 'rtibia' hangs on 'rfemur', not on 'lfemur'",
        lambda: find_legs(with_roles(WALK, {"left knee": "rtibia"}).skeleton),
    ),
)


def test_a_body_without_toes_and_names_has_feet_that_end_at_the_ankles():
    short = without(replace(WALK, contacts={}), "ltoes", "ltoes_end", "rtoes", "rtoes_end")
    left, right = find_legs(with_roles(anonymous(short)).skeleton)
    assert not left.has_ball
    assert not right.has_ball
