"""Joints and their roles, by names and by the tree."""

import numpy as np
import pytest

from mocap import load
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import SKELETON
from mocap.editing.body_roles import ROLES, roles
from tests.editing.bodies import DAZ, LONG, SMPL, UNDERSCORED, UP_AND_LOW, renamed, walk, without
from tests.refusals import refusals

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


@pytest.mark.parametrize("names", [LONG, UNDERSCORED, UP_AND_LOW, DAZ, SMPL])
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
        r"No legs found among vertebra.*tried lfemur.*Rename the joints",
        roles,
        Skeleton([f"vertebra_number_{n}" for n in range(30)], np.arange(30) - 1, np.ones((30, 3))),
    )
)
