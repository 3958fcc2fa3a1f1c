"""Left, right and the head are the same under any names, once a skeleton stores the roles of its joints."""

from dataclasses import replace

import pytest

from mocap.body import with_roles
from mocap.body.body_sides import head_joints, partners, sides
from mocap.datasets import sample
from mocap.datasets.samples import SKELETON
from mocap.editing import mirror
from mocap.feet import mark_plants
from mocap.feet.footplants import find_footprints
from mocap.plotting.bodies import bones
from mocap.quality import judge
from tests.editing.bodies import renamed

WALK = sample("walk_straight")[:480:4]
NUMBERS = {name: f"bone{number:02d}" for number, name in enumerate(SKELETON.names)}
ANONYMOUS = with_roles(renamed(replace(WALK, contacts={}), NUMBERS))
NUMBERED = ANONYMOUS.skeleton


def test_partners_and_sides_by_roles_are_those_by_names():
    assert partners(NUMBERED) == partners(SKELETON)
    assert sides(NUMBERED) == sides(SKELETON) == [SKELETON.side(joint) for joint in range(len(SKELETON))]
    assert head_joints(NUMBERED) == head_joints(SKELETON)
    assert (bones(NUMBERED)[2] == bones(SKELETON)[2]).all()


def test_without_names_and_roles_all_joints_are_in_the_middle_and_nothing_is_searched():
    skeleton = replace(NUMBERED, roles={})
    assert partners(skeleton) == [*range(len(skeleton))]
    assert set(sides(skeleton)) == {"middle"}
    assert head_joints(skeleton) == []


def test_names_of_fingers_or_eyes_do_not_hide_the_roles_of_limbs():
    names = {"lhand": "handle_l", "rhand": "handle_r"}
    body = with_roles(renamed(replace(WALK, contacts={}), NUMBERS | names)).skeleton
    assert partners(body) == partners(SKELETON)
    assert sides(body) == sides(SKELETON)


def test_footprints_measures_and_mirror_images_are_the_same_under_any_names():
    usual = mark_plants(replace(WALK, contacts={}))
    anonymous = mark_plants(ANONYMOUS)
    prints = [[row[1:] for row in find_footprints(motion)] for motion in (usual, anonymous)]
    assert {row[0] for row in prints[0]} == {"left", "right"}
    assert sorted(prints[0]) == sorted(prints[1])
    named, unnamed = ({m.name: m.value for m in judge(motion).measures} for motion in (usual, anonymous))
    assert named == pytest.approx(unnamed)
    image, anonymous_image = (mirror(motion) for motion in (usual, anonymous))
    assert anonymous_image.positions == pytest.approx(image.positions, abs=1e-6)
