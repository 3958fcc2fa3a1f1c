"""Seams and plants are measured right where they are made to order; bad seams of real clips are found."""

from dataclasses import replace

import numpy as np
import pytest
from walking import generate

from mocap._shared.arrays import runs
from mocap.blending import join
from mocap.body import concatenate, joint_positions
from mocap.datasets.samples import sample
from mocap.errors import SkeletonMismatch
from mocap.quality.seam_measures import (
    foot_sliding,
    jumps,
    knee_rotations,
    seam_quality,
    sliding_per_frame,
    spread,
)
from tests.refusals import refusals, refused
from tests.strategies import glide, random_motion

WALK = sample("walk_straight")
USUAL = spread([WALK])


def test_jumps_are_those_of_curves_known_in_closed_form():
    t = np.arange(20) / 30
    assert jumps(glide(t**3))[1:-1] == pytest.approx(6 * t[1:-1] / 30)
    bent = np.maximum(t - t[10], 0) * 3  # 3 m/s from frame 10 on
    assert jumps(glide(bent)) == pytest.approx(3.0 * (np.arange(20) == 10))


def test_a_clip_s_own_frames_are_nothing_special():
    walk = generate("walk_straight")  # as stored, feet tremble by a nanometre
    inside = [seam_quality(walk, (start, start + 40), USUAL) for start in range(40, 1100, 120)]
    assert np.mean([q.velocity_jump <= 1.001 for q in inside]) > 0.9
    assert max(q.foot_sliding for q in inside) < 1e-9


def test_a_cut_shows_and_a_blend_does_not():
    cut = concatenate([WALK[:500], WALK[320:]])
    assert seam_quality(cut, (500, 501), USUAL).velocity_jump > 20
    assert seam_quality(join(WALK, 500, WALK, 242, 40), (500, 540), USUAL).velocity_jump < 1


def test_plants_that_touch_the_seam_slide_and_no_plants_do_not():
    drift = (np.arange(len(WALK)) / 120)[:, None] * [0.1, 0, 0]
    drifting = replace(WALK, root_positions=WALK.root_positions + drift)
    # A plant of n frames drifts by 10 cm/s · n / 120 s: at its ends it is half as far from its middle.
    assert 1 < seam_quality(drifting, (600, 640), USUAL).foot_sliding < 5
    floating = replace(WALK, contacts=dict.fromkeys(WALK.contacts, False))
    assert seam_quality(floating, (600, 640), USUAL).foot_sliding == 0


FROZEN = replace(WALK[:9], root_positions=WALK.root_positions[[0] * 9], rotations=WALK.rotations[[0] * 9])

test_what_is_measured_must_go_together = refusals(
    *(
        (f"{len(WALK)} frames, and no seam", seam_quality, WALK, seam, USUAL)
        for seam in ((-1, 5), (5, 5), (len(WALK) - 11, len(WALK) + 1))
    ),
    ("one clip or more, got none", spread, []),
    ("takes three frames; 'walk_straight' has 2", jumps, WALK[:2]),
    (SkeletonMismatch, "joints", spread, [WALK, random_motion(0)]),
    ("'lfoot' stands; mark_plants", seam_quality, replace(WALK, contacts={}), (5, 9), USUAL),
    ("The clips do not move", seam_quality, WALK, (5, 9), spread([FROZEN])),
)


def test_a_leap_in_the_data_is_neither_usual_nor_hides_a_seam():
    root = WALK.root_positions.copy()
    root[700] += [0.0, 0.2, 0.1]
    usual = spread([replace(WALK, root_positions=root), WALK])
    assert np.flatnonzero(np.isnan(usual.velocity[0])).tolist() == [699, 700, 701]
    assert not np.isnan(usual.velocity[1]).any()
    assert usual.within(42)[-1] == USUAL.within(42)[-1]


def test_a_knee_that_is_turned_by_hand_turns_as_far():
    knee, rotations = WALK.skeleton.index("ltibia"), WALK.rotations.copy()
    rotations[600:, knee] = rotations[599, knee]
    assert knee_rotations(replace(WALK, rotations=rotations))[600:, 0] == pytest.approx(0, abs=1e-5)
    half = np.sqrt(0.5)
    rotations[699:701, knee] = [1, 0, 0, 0], [half, half, 0, 0]
    assert knee_rotations(replace(WALK, rotations=rotations))[699, 0] == pytest.approx(90)


def pushed(step):
    """Push the walk over the ground by some metres per frame."""
    return replace(WALK, root_positions=WALK.root_positions + np.arange(len(WALK))[:, None] * step)


def test_a_clip_s_own_feet_stand_and_no_plants_are_no_slide():
    assert max(slide.distance for slide in foot_sliding(WALK)) < 1e-6
    assert foot_sliding(replace(WALK, contacts={})) == []


def test_a_body_that_is_pushed_slides_by_what_it_is_pushed():
    body = pushed([1e-3, 0, 0])
    places = joint_positions(body)[..., [0, 2]]
    slides = foot_sliding(body)
    assert len(slides) == sum(len(runs(mark)) for mark in WALK.contacts.values())
    for slide in slides:
        stood = places[slide.start : slide.stop, WALK.skeleton.index(slide.joint)]
        assert slide.distance == pytest.approx(100 * np.linalg.norm(stood - stood.mean(0), axis=1).max())
        assert slide.distance == pytest.approx(0.1 * (slide.stop - slide.start - 1) / 2, abs=1e-6)
    slid = sliding_per_frame(pushed([0.003, 0.01, 0.004]))  # 5 mm per frame over the ground
    planted = sum(int((on[1:] & on[:-1]).sum()) for on in WALK.contacts.values())
    assert slid.sum() == pytest.approx(0.5 * planted)
    assert slid[slid > 0.1] == pytest.approx(0.5)


def test_only_the_joints_asked_for_count_and_they_need_marks():
    foot = WALK.skeleton.index("lfoot")
    assert {slide.joint for slide in foot_sliding(WALK, [foot])} == {"lfoot"}
    refused("does not say when 'head' stands; mark_plants", foot_sliding, WALK, [WALK.skeleton.index("head")])
    refused("mark_plants", lambda: sliding_per_frame(replace(WALK, contacts={})))
