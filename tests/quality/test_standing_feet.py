"""One measure of sliding plants serves seams, motions and characters."""

from dataclasses import replace

import numpy as np
import pytest

from mocap._shared.arrays import runs
from mocap.body.kinematics import joint_positions
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.quality.standing_feet import plant_slides

WALK = sample("walk_curve_2")


def test_a_clip_s_own_feet_stand_and_no_plants_are_no_slide():
    assert max(slide.far for slide in plant_slides(WALK)) < 1e-6
    assert plant_slides(replace(WALK, contacts={})) == []


def test_a_body_that_is_pushed_slides_by_what_it_is_pushed():
    pushed = replace(WALK, root_positions=WALK.root_positions + np.linspace([0, 0, 0], [1, 0, 0], len(WALK)))
    places, step = joint_positions(pushed)[..., [0, 2]], 100 / (len(WALK) - 1)
    slides = plant_slides(pushed)
    assert len(slides) == sum(len(runs(mark)) for mark in WALK.contacts.values())
    for slide in slides:
        stood = places[slide.start : slide.stop, WALK.skeleton.index(slide.joint)]
        assert slide.far == pytest.approx(100 * np.linalg.norm(stood - stood.mean(0), axis=1).max())
        assert slide.far == pytest.approx(step * (slide.stop - slide.start - 1) / 2, abs=1e-6)


def test_only_the_joints_asked_for_count_and_they_need_marks():
    foot = WALK.skeleton.index("lfoot")
    assert {slide.joint for slide in plant_slides(WALK, [foot])} == {"lfoot"}
    with pytest.raises(MocapError, match="does not say when 'head' stands; mark_plants finds out"):
        plant_slides(WALK, [WALK.skeleton.index("head")])
