"""A leg's hinge says how far it reaches, and how far its root may rise."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.feet.leg_track import BENT, UP, LegTrack

CLIP = sample("walk_straight")[300:420]
LEFT = find_legs(CLIP.skeleton)[0]
TRACK = LegTrack(CLIP, LEFT, forward_kinematics(CLIP))


def test_the_names_and_bones_are_the_skeleton_s():
    assert TRACK.names == ["lfemur", "ltibia", "lfoot", "ltoes"]
    lengths = LEFT.lengths(CLIP.skeleton)
    for bone, length in zip((*TRACK.bones, TRACK.ball - TRACK.ankle), lengths, strict=True):
        assert np.linalg.norm(bone, axis=-1) == pytest.approx(np.full(len(CLIP), length))


def test_the_hinge_says_how_far_a_leg_reaches():
    hinge = TRACK.hinge
    thigh, shank, _ = LEFT.lengths(CLIP.skeleton)
    assert hinge.reach == pytest.approx(np.full(len(CLIP), thigh + shank))
    assert hinge.turn(TRACK.distance) == pytest.approx(0, abs=1e-6)
    assert np.all(hinge.straight < 0)  # to stretch a bent knee is to turn it back


def test_no_knee_becomes_straighter_than_eight_degrees_or_than_it_is():
    thigh, shank, _ = LEFT.lengths(CLIP.skeleton)
    bent = np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(BENT))
    assert pytest.approx(np.maximum(TRACK.distance, bent)) == TRACK.limit
    assert np.all(TRACK.hinge.limit(TRACK.hinge.reach) == TRACK.hinge.reach)


def test_a_root_as_high_as_it_may_be_stretches_the_leg_to_its_length():
    highest = TRACK.highest(TRACK.ankle, TRACK.hinge.reach)
    risen = TRACK.hip + highest[:, None] * UP
    assert np.linalg.norm(risen - TRACK.ankle, axis=-1) == pytest.approx(TRACK.hinge.reach)
    assert np.all(highest >= -1e-9)


def test_a_knee_that_never_bends_hides_its_hinge():
    straight = CLIP.rotations.copy()
    straight[:, LEFT.knee] = rotations.IDENTITY
    stiff = replace(CLIP, rotations=straight)
    with pytest.raises(MocapError, match="'ltibia' is straight in every frame"):
        _ = LegTrack(stiff, LEFT, forward_kinematics(stiff)).hinge
