"""An ankle comes to its target, the knee bends as a hinge, and with nothing to do nothing changes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import rotations
from mocap.body.kinematics import forward_kinematics
from mocap.body.limbs import find_legs
from mocap.datasets.samples import sample
from mocap.errors import MocapError
from mocap.feet.leg_ik import pose_leg
from mocap.feet.leg_track import LegTrack
from tests.strategies import seeds

CLIP = sample("walk_straight")[300:420]
LEFT, RIGHT = find_legs(CLIP.skeleton)
POSES = forward_kinematics(CLIP)
TRACK = LegTrack(CLIP, LEFT, POSES)
ANKLE, HIP = TRACK.ankle, TRACK.hip


def posed(ankle, turn):
    """Return the positions and matrices of the clip with its left leg posed anew."""
    pose = CLIP.rotations.copy()
    pose[:, LEFT[:3]] = pose_leg(TRACK, ankle, turn)
    return forward_kinematics(replace(CLIP, rotations=pose))


@given(seeds, st.floats(0, 0.15))
def test_the_ankle_comes_to_its_target_and_the_foot_turns_as_asked(seed, far):
    random = np.random.default_rng(seed)
    target = ANKLE + far * random.uniform(-1, 1, (len(CLIP), 3)) * [1, 0, 1] + [0, 0.1, 0]
    stretch = np.linalg.norm(target - HIP, axis=-1) / TRACK.hinge.reach
    target = HIP + (target - HIP) / np.maximum(1, 1.001 * stretch)[:, None]  # within reach
    turn = random.normal(size=(len(CLIP), 3)) * 0.3
    after = posed(target, turn)
    assert after.positions[:, LEFT.ankle] == pytest.approx(target, abs=1e-9)
    wanted = rotations.multiply(
        rotations.from_rotvec(turn), rotations.from_matrix(POSES.matrices[:, LEFT.ankle])
    )
    got = rotations.from_matrix(after.matrices[:, LEFT.ankle])
    assert rotations.angle_between(got, wanted) == pytest.approx(0, abs=1e-6)
    # A hinge stays one: seen from the thigh, the knee's axis is where it was.
    axis = np.einsum(
        "fji,fj->fi",
        after.matrices[:, LEFT.hip],
        np.cross(
            after.positions[:, LEFT.knee] - after.positions[:, LEFT.hip],
            after.positions[:, LEFT.ankle] - after.positions[:, LEFT.knee],
        ),
    )
    assert axis / np.linalg.norm(axis, axis=-1, keepdims=True) == pytest.approx(
        np.tile([1.0, 0, 0], (len(CLIP), 1)), abs=1e-6
    )


def test_with_the_ankle_at_its_target_nothing_changes():
    same = pose_leg(TRACK, ANKLE, np.zeros((len(CLIP), 3)))
    assert same == pytest.approx(CLIP.rotations[:, LEFT[:3]], abs=1e-9)


def test_the_other_leg_and_the_trunk_stay():
    after = posed(ANKLE + np.array([0, 0.05, 0]), np.zeros((len(CLIP), 3)))
    others = [j for j in range(len(CLIP.skeleton)) if not CLIP.skeleton.names[j].startswith(("lf", "lt"))]
    assert after.positions[:, others] == pytest.approx(POSES.positions[:, others])


def test_a_target_out_of_reach_names_frame_and_distance():
    target = ANKLE.copy()
    target[7] = HIP[7] + [0, -1.0, 0]
    with pytest.raises(MocapError, match="frame 7: 'lfoot' would have to be 14 cm out of its leg's reach"):
        pose_leg(TRACK, target, np.zeros((len(CLIP), 3)))
