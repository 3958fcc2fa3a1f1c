"""Left and right swapped: against geometry, on bodies of any axes, and what it is good for."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from mocap.body import Skeleton, joint_positions, resample, rotations
from mocap.datasets import samples
from mocap.editing.mirroring import mirror, symmetry
from mocap.feet.footplants import mark_plants
from mocap.files import load_save
from tests.editing.bodies import rested
from tests.refusals import refusals, told, unwarned
from tests.strategies import random_quaternions, seeds

WALK = resample(samples.sample("walk_curve_1"), 30)[:150]


def reflected(motion):
    """Return where the joints of a mirror image must be: those of the partners, with x the other way."""
    return joint_positions(motion)[:, symmetry(motion.skeleton)[0]] * [-1, 1, 1]


def with_other_axes(motion, seed):
    """Describe the same motion by a skeleton in which each joint's axes point anywhere."""
    return rested(motion, random_quaternions(np.random.default_rng(seed), len(motion.skeleton)))


@given(seeds)
@settings(max_examples=8)
def test_joints_are_where_a_mirror_shows_them_wherever_axes_point_and_twice_is_the_identity(seed):
    odd = with_other_axes(WALK, seed)
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
