"""Motions worn by other bodies: turns are copied; feet planted, nothing slides, sinks or jolts."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap import load
from mocap.body import Motion, PlanarTransform, Skeleton, joint_positions, rotations
from mocap.body.limbs import FEET
from mocap.editing import join_pins, pin_errors, plants_kept
from mocap.editing.pose_copying import copied
from mocap.editing.proportions import proportioned
from mocap.editing.retargeting import floor_pins, floor_under, retarget, wear
from mocap.editing.stances import Stance, stance_of, stance_of_zero
from mocap.errors import SkeletonMismatch
from mocap.feet import clean_up, mark_plants
from tests.editing.bodies import LONG, adult, along_x, bends, child, renamed, rested, walk, without
from tests.editing.test_path_editing import slide
from tests.editing.wishes import bones, captured, smoothness
from tests.refusals import refusals, told, unwarned


def farthest(a: Motion, b: Motion) -> float:
    return float(np.linalg.norm(joint_positions(a) - joint_positions(b), axis=-1).max())


def rms(errors: np.ndarray) -> float:
    return float(np.sqrt((errors**2).mean()))


@settings(max_examples=5)
@given(share=st.floats(0.2, 3))
def test_onto_a_scaled_copy_all_places_are_scaled(share):
    """About the ground below the hips of the first frame. As in [Gle98, scaled start]."""
    smaller = proportioned(adult(), legs=share, trunk=share, arms=share, head=share)
    there = joint_positions(copied(walk(1.0), adult(), smaller))
    here = joint_positions(walk(1.0))
    centre = here[0, [adult().roles["left hip"], adult().roles["right hip"]]].mean(axis=0) * [1, 0, 1]
    assert np.allclose(there - centre, share * (here - centre), atol=1e-12)


@settings(max_examples=5)
@given(angle=st.floats(-3, 3), x=st.floats(-9, 9), z=st.floats(-9, 9))
def test_a_copy_is_carried_over_the_ground_with_its_source(angle, x, z):
    carry = PlanarTransform(angle, x, z)
    moved = copied(carry.apply_motion(walk(1.0)), adult(), child())
    assert farthest(moved, carry.apply_motion(copied(walk(1.0), adult(), child()))) < 1e-11


def test_the_rest_pose_does_not_matter():
    """Bones along +x at rest, as in Bandai-Namco's files; copied angle by angle the figure would fold."""
    other = rested(walk(), along_x(walk().skeleton))
    onto = stance_of(other)
    assert farthest(copied(walk(), stance_of(walk(), mean=True), onto), walk()) < 1e-12
    who = adult().roles
    apart = bends(copied(walk(), adult(), onto), who) - bends(walk(), who)
    assert rms(apart) < 5  # the rest pose against the mean over the walk, at the elbows


def test_arms_that_rest_another_way_keep_their_hands():
    """Arms out at rest, as in the CMU files, on arms that rest hanging: hands go with their forearms."""
    turns = np.tile([1.0, 0, 0, 0], (len(walk().skeleton), 1))
    for side, sign in (("l", -1), ("r", 1)):
        arm = walk().skeleton.index(f"{side}humerus")
        below = [j for j in range(len(turns)) if arm in walk().skeleton.path_to_root(j)]
        turns[below] = rotations.from_rotvec([0, 0, sign * np.pi / 2])
    out = rested(walk(), turns)
    assert farthest(copied(walk(), adult(), stance_of(out)), walk()) < 1e-12
    assert farthest(copied(out, stance_of(out), adult()), walk()) < 1e-12


def test_there_and_back():
    there = copied(walk(), adult(), child())
    assert farthest(copied(there, child(), adult()), walk()) < 1e-12
    fewer = without(walk(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    there = copied(walk(), adult(), stance_of(fewer))
    back = copied(there, stance_of(fewer), adult())
    apart = joint_positions(back) - joint_positions(walk())
    assert 0.001 < rms(np.linalg.norm(apart, axis=-1)) < 0.025  # the turns of joints that it lacks are lost
    legs = [joint for r, joint in adult().roles.items() if r.split()[-1] in ("hip", "knee", "ankle", "ball")]
    assert np.abs(apart[:, legs]).max() < 1e-12


def test_names_labels_and_contacts_come_along():
    other = renamed(walk(), LONG)
    there = copied(walk(), adult(), stance_of(other))
    assert there.name == walk().name
    assert list(there.labels) == list(walk().labels)
    assert np.array_equal(there.contacts["LeftFoot"], walk().contacts["lfoot"])
    assert set(there.contacts) == {"LeftFoot", "RightFoot", "LeftToeBase", "RightToeBase"}


def test_a_root_above_the_pelvis_turns_with_the_heading_only():
    old = walk().skeleton
    offsets = np.r_[[[0.0, 0, 0], [0, 0.9, 0]], old.offsets[1:]]
    body = type(old)(["ground", *old.names], [-1, *(old.parents + 1)], offsets)
    roots = walk().root_positions - [0, 0.9, 0]
    turns = np.concatenate([np.tile([1.0, 0, 0, 0], (len(walk()), 1, 1)), walk().rotations], axis=1)
    clip = Motion(body, roots, turns, walk().fps, contacts=walk().contacts)
    there = copied(walk(), adult(), stance_of(clip))
    assert np.abs(joint_positions(there)[:, 1:] - joint_positions(walk())).max() < 1e-12
    assert np.abs(there.rotations[:, 0, [1, 3]]).max() < 1e-9  # about the vertical


test_what_cannot_be_copied_is_refused = refusals(
    (SkeletonMismatch, "bones differ", copied, walk(), child(), adult()),
    *(
        ("scale of a path must be above 0", lambda share=share: copied(walk(), adult(), child(), scale=share))
        for share in (0, -1, np.nan, np.inf)
    ),
)

test_another_body_than_a_skeleton_or_a_stance_is_refused = refusals(
    (r"got a Motion: pass motion.skeleton, or editing.stance_of\(motion\)", wear, walk(), walk()),
    ("got the text 'child.bvh': pass motion.skeleton", wear, walk(), "child.bvh"),
    ("a Skeleton, which is a body without poses", wear, walk().skeleton, walk()),
)


MM = 1000


def sinks(motion: Motion, stance: Stance, clip: Motion, source: Stance) -> float:
    """Measure by how much feet are deeper in the floor than the source's, for their size; millimetres."""
    allowed, deepest = floor_under(joint_positions(clip), source, stance), joint_positions(motion)
    return MM * float((allowed.low - deepest[:, list(allowed.joints)])[..., 1].max())


def held_to_the_bars(clip, source, target, *, scale=None, smooth=1.05, deep=3.0):
    worn = unwarned(retarget, clip, target, source, scale=scale)  # nothing is let go
    base = copied(clip, source, target, scale=scale)
    off = bends(worn, target.roles) - bends(base, target.roles)
    knees, *others = (rms(off[:, [k, k + 4]]) for k in range(4))  # degrees; elbows, hips and shoulders
    assert MM * slide(worn) <= 1e-3
    assert plants_kept(worn, base) >= 0.99
    assert sinks(worn, target, clip, source) <= deep
    assert smoothness(worn, base) <= smooth
    assert knees <= 3
    if scale is None:
        assert max(others) <= 7
    assert bones(worn) <= 1e-12
    return worn


def broad() -> Stance:
    """Make a body with short shanks and broad hips, whose feet stand higher."""
    old = adult().skeleton
    offsets = old.offsets.copy()
    for side in "lr":
        offsets[old.index(f"{side}femur"), 0] *= 1.3
        offsets[old.index(f"{side}foot")] *= 0.85
    heights = {r: height + 0.03 * r.endswith("ankle") + 0.01 for r, height in adult().heights.items()}
    body = replace(old, offsets=offsets)
    return replace(adult(), skeleton=body, heights=heights)


BODIES = {
    "child": child,
    "broad": broad,
    "other names": lambda: stance_of(renamed(walk(), LONG)),
    "a rest pose that means nothing": lambda: stance_of(rested(walk(), along_x(walk().skeleton))),
    "fewer joints": lambda: stance_of(
        without(walk(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    ),
}


@pytest.mark.parametrize("name", BODIES)
def test_bodies_made_of_the_bundled_one(name):
    """As in [Gle98, method]."""
    held_to_the_bars(walk(), adult(), BODIES[name]())


@settings(max_examples=5)
@given(shares=st.tuples(*[st.floats(0.4, 1.3)] * 4))
def test_bodies_of_any_proportions_stand(shares):
    legs, trunk, arms, head = shares
    body = proportioned(adult(), legs=legs, trunk=trunk, arms=arms, head=head)
    worn = retarget(walk(1.5), body, adult())
    assert MM * slide(worn) <= 1e-3
    assert sinks(worn, body, walk(1.5), adult()) <= 3
    assert plants_kept(worn, copied(walk(1.5), adult(), body)) >= 0.99


@pytest.mark.parametrize(("gain", "smooth"), [(1.4, 1.2)])
def test_a_child_with_long_steps(gain, smooth):
    """Smooth to 1.35 for a captured walk, below; a generated one has less to drown a change in.

    As in [Gle98, method].
    """
    worn = held_to_the_bars(walk(), adult(), child(), scale=0.55 * gain, smooth=smooth)
    assert bends(worn, child().roles)[:, [0, 4]].min() > 2  # no knee straightens


def test_steps_that_no_leg_takes_are_said():
    told(r"the hips move by \d+ cm .* legs of 47 cm", retarget, walk(2.0), child(), adult(), scale=0.55 * 4)


def test_a_skeleton_alone_stands_as_high_as_the_source():
    body = child().skeleton
    stance = stance_of_zero(body, 0.55 * adult().height("ball"))
    worn = wear(walk(2.0), body)
    assert MM * slide(worn) <= 1e-3
    assert np.allclose(joint_positions(worn), joint_positions(retarget(walk(2.0), stance, adult())))


FOLDED = rested(walk(), along_x(walk().skeleton))

test_bodies_that_cannot_wear_it_are_refused = refusals(
    (r"does not stand.*give stance_of a walk", wear, walk(), FOLDED.skeleton),
    ("No legs found", wear, walk(), Skeleton(["root", "spine", "head"], [-1, 0, 1], np.eye(3))),
    (SkeletonMismatch, "bones differ", retarget, walk(), child(), child()),
)


REAL_BODIES = {
    "CMU 02": "cmu/02/02_01.amc",
    "CMU 49": "cmu/49/49_01.amc",
    "Bandai-Namco": "bvh/bandai_namco/dataset-1_walk_normal_001.bvh",
    "puppy": "bvh/puppy0512_motion_graph/walk_normal_stright.bvh",
    "imusim": "bvh/imusim/16_15.bvh",
    "cgspeed": "bvh/cmu_cgspeed_bvh11/131_01.bvh",
}


@cache
def stance_in(real_data, name: str) -> Stance:
    """Say how the body in a real file stands."""
    scale = 0.0564444 if name == "cgspeed" else None
    return stance_of(mark_plants(load(real_data / REAL_BODIES[name], scale=scale)))


@pytest.mark.parametrize("name", REAL_BODIES)
def test_a_captured_walk_on_captured_bodies(real_data, name):
    if not (real_data / REAL_BODIES[name]).exists():
        pytest.skip(f"no {REAL_BODIES[name]} among the real clips")
    clip = captured(real_data, last=None)
    target = stance_in(real_data, name)
    source = stance_of(clip, mean=True) if name == "Bandai-Namco" else stance_of(clip)
    held_to_the_bars(clip, source, target)


@pytest.mark.parametrize("name", ["cmu/16/16_31.amc", "cmu/16/16_22.amc", "hw3/walk_fwd_curve1.AMC"])
@pytest.mark.filterwarnings("ignore:.*let go")
def test_feet_that_slide_are_cleaned_up_first_and_no_further_plant_is_lost(real_data, name):
    clip = mark_plants(load(real_data / name)[12:1000])
    source, target = stance_of(clip), stance_in(real_data, "Bandai-Namco")
    worn, own = retarget(clip, target, source), clean_up(clip)
    assert MM * slide(clip) > 1 > 1e-3 >= MM * slide(worn)
    assert plants_kept(worn, copied(clip, source, target)) == plants_kept(own, clip) > 0.94


def test_plants_are_held_at_the_heights_of_the_stance_a_flat_foot_apart():
    thick = {r: height + (0.02 if r.endswith("ankle") else 0.01) for r, height in child().heights.items()}
    stance = replace(child(), heights=thick)
    base = copied(walk(), adult(), stance)
    pins = floor_pins(base, stance)
    for side, (ankle, ball) in enumerate([(0, 1), (2, 3)]):
        both = pins.held[:, [ankle, ball], 0].all(axis=1)
        assert both.any()
        apart = np.linalg.norm(pins.low[both][:, ankle] - pins.low[both][:, ball], axis=-1)
        assert np.allclose(apart, stance.legs[side].lengths(stance.skeleton)[2])
    for column, role in enumerate(FEET):
        held = pins.held[:, column, 1]
        assert np.allclose(pins.low[held, column, 1], thick[role])
        assert np.array_equal(held, base.contacts[base.skeleton.names[stance.roles[role]]])


def test_a_floor_bounds_feet_in_all_other_frames():
    plants = floor_pins(walk(), adult())
    assert not plants.constrained.all()
    floor = join_pins(floor_under(joint_positions(walk()), adult(), adult()), plants)
    assert floor.constrained.all()
    swings = ~floor.held[:, 0, 1]
    lowest = joint_positions(walk())[:, adult().roles["left ankle"], 1].min()
    assert np.allclose(floor.low[swings, 0, 1], min(lowest, adult().heights["left ankle"]))
    assert np.array_equal(floor.held, plants.held)
    sunk = replace(walk(), root_positions=walk().root_positions - [0, 0.05, 0])
    assert pin_errors(sunk, floor).max() == pytest.approx(0.05)
    depths = [floor_under(joint_positions(m), adult(), adult()).low[0, 1, 1] for m in (sunk, walk())]
    assert depths[0] == pytest.approx(depths[1] - 0.05)  # of the left ball
