"""Names that three.js keeps: by its own rule, all different, and each joint with its motion and marks."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.files import gltf, load_save, with_plain_names
from mocap.files.plain_names import plain_names
from tests.files.glb_reader import Glb
from tests.strategies import wave


def kept_by_three_js(name):
    """Change a name as `PropertyBinding.sanitizeNodeName` does: \\s to _, and without [ ] . : /."""
    return re.sub(r"[\[\].:/]", "", re.sub(r"[\s\ufeff]", "_", name))


@given(st.lists(st.text("aA_2.:/[] \tä手", max_size=4), unique=True, max_size=30))
def test_plain_names_are_kept_and_different_and_plain_ones_stay(names):
    plain = plain_names(names)
    assert len(set(plain)) == len(names) and all(plain)
    assert [kept_by_three_js(name) for name in plain] == plain
    for name, new in zip(names, plain, strict=True):
        assert new == name or not name or kept_by_three_js(name) != name


ODD = ["rig:hips", "rig.hips", "left hand", "side[1]"]


def odd():
    """Return a motion with names that three.js would change, two of them to the same."""
    skeleton = replace(wave(9).skeleton, names=ODD, roles={"pelvis": "rig:hips"})
    return replace(wave(9), skeleton=skeleton, contacts={"rig.hips": np.arange(9) > 4})


def test_motion_roles_and_contacts_keep_their_joints():
    plain = with_plain_names(odd())
    assert plain.skeleton.names == ("righips", "righips_2", "left_hand", "side1")
    assert plain.skeleton.roles == {"pelvis": "righips"}
    assert plain.contacts["righips_2"].sum() == 4
    assert np.array_equal(plain.positions, odd().positions)
    assert with_plain_names(plain) == plain


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_files_have_the_plain_names(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    load_save.save(with_plain_names(odd()), path)
    if suffix == ".bvh":
        names = load_save.load(path).skeleton.names
    else:
        read = Glb(path.read_bytes())
        names = [read.nodes[joint]["name"] for joint in read.joints]
    assert sorted(names) == ["left_hand", "righips", "righips_2", "side1"]


def test_the_body_and_the_scene_take_no_name_of_a_joint():
    """A program that needs unique names would rename the joint."""
    names = ["body", "root", "a b", "c"]
    skeleton = replace(wave(9).skeleton, names=names)
    motion = replace(wave(9), name="a.b", skeleton=skeleton, contacts={})
    taken = Glb(gltf.glb(replace(motion, name="a_b"), root=True))
    others = [node["name"] for number, node in enumerate(taken.nodes) if number not in taken.joints[:4]]
    assert others == ["drawn_body", "floor_root"]
    document = taken.document
    assert document["scenes"][0]["name"] == "clip_a_b" and document["meshes"][0]["name"] == "drawn_body"
    assert document["animations"][0]["name"] == "a_b"
    assert Glb(gltf.glb(motion)).document["scenes"][0]["name"] == "a.b"
