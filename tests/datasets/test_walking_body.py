"""The body's shape, and legs that reach the ground."""

import numpy as np
import pytest

from mocap.body import rotations
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.datasets.footsteps import FootPath
from mocap.datasets.walking_body import (
    FOOT,
    HIPS,
    LEAST_KNEE,
    SHANK,
    SKELETON,
    STATURE,
    THIGH,
    leg,
    pelvis_height,
)
from mocap.errors import MocapError


def standing_foot(ankle: np.ndarray) -> FootPath:
    zeros, yes = np.zeros(len(ankle)), np.ones(len(ankle), bool)
    return FootPath(ankle, zeros, zeros, zeros, yes, yes, zeros + 0.2, zeros + 1.0)


def rest() -> dict[str, np.ndarray]:
    pose = np.tile(rotations.IDENTITY, (1, len(SKELETON), 1))
    positions = joint_positions(Motion(SKELETON, np.zeros((1, 3)), pose, 120.0))[0]
    return dict(zip(SKELETON.names, positions, strict=True))


def test_the_body_is_as_tall_as_it_says():
    at = rest()
    assert at["head_end"][1] - (at["lfoot"][1] - FOOT.ankle) == pytest.approx(STATURE)


def test_the_body_has_cmu_s_31_bones():
    inner = [name for name in SKELETON.names if not name.endswith("_end")]
    assert len(inner) == 31
    assert len(SKELETON) == 38


def test_left_and_right_are_mirror_images():
    at = rest()
    for name, place in at.items():
        if name.startswith("l") and "r" + name[1:] in at:
            assert at["r" + name[1:]] == pytest.approx(place * [-1, 1, 1])
    assert at["lhumerus"][0] > 0.15
    assert at["ltoes"][2] > at["lfoot"][2]


def test_the_foot_s_shape_is_the_skeleton_s():
    at = rest()
    assert at["ltoes"] - at["lfoot"] == pytest.approx([0, FOOT.ball - FOOT.ankle, FOOT.instep])
    assert np.linalg.norm(at["ltibia"] - at["lfemur"]) == pytest.approx(THIGH)
    assert np.linalg.norm(at["lfoot"] - at["ltibia"]) == pytest.approx(SHANK)


@pytest.mark.parametrize("degrees", [10, 30, 60])
def test_the_pelvis_stands_where_the_knees_bend_as_asked(degrees):
    frames = 40
    hips = {side: np.tile(HIPS[side], (frames, 1)) for side in "lr"}
    feet = {s: standing_foot(np.tile([HIPS[s][0], FOOT.ankle, 0.1], (frames, 1))) for s in "lr"}
    bends = dict.fromkeys("lr", np.full(frames, np.radians(degrees)))
    root = np.tile([0.0, 0.5, 0.0], (frames, 1))
    root[:, 1] = pelvis_height(root, hips, feet, bends, 0.0)
    ahead = np.tile([0.0, 0, 1], (frames, 1))
    turns = leg("l", np.tile(rotations.IDENTITY, (frames, 1)), root, feet["l"], ahead)
    assert np.degrees(rotations.to_rotvec(turns["ltibia"])[:, 0]) == pytest.approx(degrees)


def test_the_pelvis_stoops_rather_than_lose_a_foot():
    frames = 200
    hips = {side: np.tile(HIPS[side], (frames, 1)) for side in "lr"}
    ankle = np.tile([0.0, FOOT.ankle, 0.0], (frames, 1))
    ankle[:, 2] += 0.6 * np.sin(np.linspace(0, 9, frames))
    feet = {side: standing_foot(ankle) for side in "lr"}
    bends = dict.fromkeys("lr", np.zeros(frames))
    root = np.tile([0.0, 1.2, 0.0], (frames, 1))
    root[:, 1] = pelvis_height(root, hips, feet, bends, 1.0)
    for side in "lr":
        length = np.linalg.norm(ankle - root - hips[side], axis=-1)
        longest = np.sqrt(THIGH**2 + SHANK**2 + 2 * THIGH * SHANK * np.cos(LEAST_KNEE))
        assert length.max() <= longest + 1e-9


def test_a_leg_that_cannot_reach_is_told():
    foot = standing_foot(np.array([[0.0, FOOT.ankle, 2.0]]))
    with pytest.raises(MocapError, match="longer than the legs"):
        leg("l", rotations.IDENTITY[None], np.array([[0.0, 1.0, 0.0]]), foot, np.array([[0.0, 0, 1]]))
