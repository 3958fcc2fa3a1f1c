"""Feet without toes, and legs with more bones: every tool that holds feet holds theirs."""

from dataclasses import replace

import numpy as np
import pytest

from mocap import editing, graphs, quality
from mocap.body import GroundPath, Skeleton, find_legs, joint_positions, resample, with_roles
from mocap.body.motion import Motion
from mocap.datasets import sample
from mocap.editing.pins import plant_pins
from mocap.editing.retargeting import wear
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up, settled_marks
from mocap.methods import in_betweening
from mocap.quality.seam_measures import feet_of
from tests.editing.bodies import renamed, without

WALK = replace(sample("walk_straight")[:480], contacts={})
LINE = GroundPath([[0, 0], [0, 1], [0.6, 2.4]])
TOES = ("ltoes", "ltoes_end", "rtoes", "rtoes_end")


def split(motion: Motion, *names: str) -> Motion:
    """Insert a joint in the middle of the bones that lead to joints."""
    for name in names:
        skeleton = motion.skeleton
        joint = skeleton.index(name)
        half = skeleton.offsets[joint] / 2
        labels = [*skeleton.names[:joint], f"{name}_twist", *skeleton.names[joint:]]
        parents = np.insert(skeleton.parents + (skeleton.parents >= joint), joint, skeleton.parents[joint])
        parents[joint + 1] = joint
        offsets = np.insert(skeleton.offsets, joint, half, axis=0)
        offsets[joint + 1] = half
        turns = np.insert(motion.rotations, joint, [1, 0, 0, 0], axis=1)
        motion = replace(motion, skeleton=Skeleton(labels, parents, offsets), rotations=turns)
    return motion


def numbered(motion: Motion) -> Motion:
    """Give all joints numbers for names, and the roles that their motion shows."""
    return with_roles(renamed(motion, {name: f"b{n:02d}" for n, name in enumerate(motion.skeleton.names)}))


BODIES = {
    "numbers": numbered(WALK),
    "split": numbered(split(WALK, "ltibia", "rtibia", "lfoot", "rfoot", "lradius", "rradius")),
    "no toes": numbered(without(WALK, *TOES)),
    "no toes, known names": without(WALK, *TOES),
    "split, known names": split(WALK, "ltibia", "rtibia"),
}


def sliding(motion):
    """Let a walk slide by 20 cm a second while its feet stand as they stood."""
    slide = np.outer(np.arange(len(motion)) / motion.fps, [0.2, 0, 0])
    return replace(motion, root_positions=motion.root_positions + slide)


def residual_sliding(motion):
    """Return the largest distance of a standing foot from its mean position, metres."""
    legs = find_legs(motion.skeleton)
    marks = settled_marks(motion, legs)
    feet = joint_positions(motion)[:, feet_of(legs)].reshape(len(motion), len(legs), 2, 3)
    farthest = 0.0
    for (leg, joint), stands in zip(np.ndindex(marks.shape[:2]), marks.reshape(-1, len(motion)), strict=True):
        edges = np.flatnonzero(np.diff(np.r_[False, stands, False]))
        for start, stop in edges.reshape(-1, 2):
            plant = feet[start:stop, leg, joint]
            farthest = max(farthest, np.linalg.norm(plant - plant.mean(axis=0), axis=1).max())
    return farthest


@pytest.mark.parametrize("name", BODIES)
def test_planted_feet_are_found_and_held(name):
    motion = mark_plants(BODIES[name])
    legs = find_legs(motion.skeleton)
    ankles = [motion.contacts[motion.skeleton.names[leg.ankle]] for leg in legs]
    assert all(0.15 < ankle.mean() < 0.45 for ankle in ankles)
    assert len(motion.contacts) == (2 if "no toes" in name else 4)
    shifted = sliding(motion)
    assert residual_sliding(shifted) > 0.02
    cleaned = clean_up(shifted)
    assert residual_sliding(cleaned) < 1e-6
    kept = [cleaned.contacts[joint].sum() / marks.sum() for joint, marks in motion.contacts.items()]
    assert min(kept) > 0.9


@pytest.mark.parametrize("name", BODIES)
def test_it_bends_loops_and_is_judged(name):
    motion = BODIES[name]
    bent = editing.bend(motion, LINE).motion
    judged = quality.judge(bent)
    assert judged.left_out == ()
    assert all(measure.ratio < 1 for measure in judged.measures if measure.name == "slide")
    assert len(bent.contacts) == (2 if "no toes" in name else 4)
    editing.loop(motion, editing.find_loop(motion, seconds=(0.4, 3)), clean=True)


@pytest.mark.parametrize("name", ["split", "no toes"])
def test_gaps_are_filled(name):
    longer = replace(sample("walk_curve_1"), contacts={})
    changed = split(longer, "ltibia", "rtibia") if name == "split" else without(longer, *TOES)
    walk = mark_plants(numbered(resample(changed, 30)))
    graph = graphs.build([walk], window=10, threshold=0.04)
    filled = in_betweening.fill_gap(graph, walk[:100], walk[130:], 31 / 30).motion
    assert np.abs(joint_positions(filled[0:1]) - joint_positions(walk[99:100])).max() < 1e-6
    assert residual_sliding(filled) < 0.005


@pytest.mark.parametrize("name", BODIES)
def test_it_wears_others_clips_and_others_wear_its(name):
    motion = BODIES[name]
    other = sample("walk_curve_1")[:240]
    worn = wear(other, editing.stance_of(motion))
    assert residual_sliding(worn) < 0.002
    assert np.abs(worn.root_positions[:, [0, 2]] - other.root_positions[:, [0, 2]]).max() < 0.1
    back = wear(motion, editing.stance_of(sample("walk_straight")))
    assert set(back.contacts) == {"lfoot", "ltoes", "rfoot", "rtoes"}
    assert residual_sliding(back) < 0.002


@pytest.mark.parametrize("name", BODIES)
def test_its_mirror_image_is_where_a_mirror_shows_it(name):
    motion = BODIES[name]
    image = editing.mirror(motion)
    partners = editing.mirroring.symmetry(motion.skeleton)[0]
    shown = joint_positions(motion)[:, partners] * [-1, 1, 1]
    assert np.abs(joint_positions(image) - shown).max() < 1e-9


def test_pins_hold_only_the_ankles_of_feet_without_toes():
    motion = mark_plants(BODIES["no toes"])
    pins = plant_pins(motion)
    assert pins.joints == tuple(leg.ankle for leg in find_legs(motion.skeleton))
