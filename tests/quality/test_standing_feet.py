"""One measure of sliding plants serves seams, motions and characters."""

from dataclasses import replace

import numpy as np
import pytest

from mocap._shared.arrays import runs
from mocap.body.kinematics import joint_positions
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.quality.standing_feet import ground_slides, plant_slides
from tests.refusals import refused

WALK = sample("walk_curve_2")


def pushed(step):
    """Push the walk over the ground by some metres per frame."""
    return replace(WALK, root_positions=WALK.root_positions + np.arange(len(WALK))[:, None] * step)


def test_a_clip_s_own_feet_stand_and_no_plants_are_no_slide():
    assert max(slide.far for slide in plant_slides(WALK)) < 1e-6
    assert plant_slides(replace(WALK, contacts={})) == []


def test_a_body_that_is_pushed_slides_by_what_it_is_pushed():
    body = pushed([1e-3, 0, 0])
    places = joint_positions(body)[..., [0, 2]]
    slides = plant_slides(body)
    assert len(slides) == sum(len(runs(mark)) for mark in WALK.contacts.values())
    for slide in slides:
        stood = places[slide.start : slide.stop, WALK.skeleton.index(slide.joint)]
        assert slide.far == pytest.approx(100 * np.linalg.norm(stood - stood.mean(0), axis=1).max())
        assert slide.far == pytest.approx(0.1 * (slide.stop - slide.start - 1) / 2, abs=1e-6)
    slid = ground_slides(pushed([0.003, 0.01, 0.004]))  # 5 mm per frame over the ground
    planted = sum(int((on[1:] & on[:-1]).sum()) for on in WALK.contacts.values())
    assert slid.sum() == pytest.approx(0.5 * planted)
    assert slid[slid > 0.1] == pytest.approx(0.5)


def test_only_the_joints_asked_for_count_and_they_need_marks():
    foot = WALK.skeleton.index("lfoot")
    assert {slide.joint for slide in plant_slides(WALK, [foot])} == {"lfoot"}
    with pytest.raises(MocapError, match="does not say when 'head' stands; mark_plants finds out"):
        plant_slides(WALK, [WALK.skeleton.index("head")])
    refused("mark_plants", lambda: ground_slides(replace(WALK, contacts={})))
