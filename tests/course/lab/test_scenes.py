"""What a page unpacks is the clip; feet and bones are those of the package."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion, resample
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.course.lab.scenes import STEP, packed_clip, packed_skeleton
from mocap.datasets.samples import sample

WALK = resample(sample("walk_curve_1"), 30)[:90]


def plants(motion):
    return packed_clip(motion, 0, np.ones(len(motion), bool))[0]["plants"]


def unpacked(motion, about, block):
    """Undo the packing, as the script does."""
    planes = np.frombuffer(block, np.uint8).reshape(4, about["channels"], about["frames"])
    changes = np.moveaxis(planes, 0, -1).copy().view("<i4")[..., 0].T.astype(np.int64)
    numbers = np.cumsum(np.cumsum(changes, axis=0), axis=0) * STEP
    x, z = about["origin"]
    roots, turns = numbers[:, :3] + [x, 0, z], numbers[:, 3:].reshape(len(motion), -1, 4)
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    return replace(motion, root_positions=roots, rotations=turns)


@pytest.mark.parametrize("far", [0.0, 1e5])
def test_a_clip_comes_back_to_a_tenth_of_a_millimetre(far):
    walk = PlanarTransform(2.0, far, -far).apply_motion(WALK)
    back = unpacked(walk, *packed_clip(walk, 0, np.ones(len(walk), bool)))
    assert np.abs(joint_positions(back) - joint_positions(walk)).max() < 1e-4


def test_flipped_signs_of_quaternions_are_smoothed():
    signs = np.where(np.arange(len(WALK)) % 2, 1.0, -1.0)[:, None, None]
    flipped = replace(WALK, rotations=WALK.rotations * signs)
    back = unpacked(flipped, *packed_clip(flipped, 0, np.ones(len(WALK), bool)))
    assert ((back.rotations[1:] * back.rotations[:-1]).sum(-1) > 0).all()


def test_frames_that_nobody_looks_at_take_no_room():
    needed = np.arange(len(WALK)) < 30
    back = unpacked(WALK, *packed_clip(WALK, 0, needed))
    assert np.abs(back.rotations[30:] - back.rotations[29]).max() == 0


def test_feet_without_marks_are_marked_and_a_body_without_legs_has_none():
    bare = replace(WALK, contacts={})
    assert set(plants(bare)) <= set("0246") and "2" in plants(bare)
    dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    still = Motion(dot, np.zeros((5, 3)), np.tile([1.0, 0, 0, 0], (5, 1, 1)), 30.0)
    assert plants(still) == "00000"
    assert packed_skeleton(dot)["feet"] == [] and packed_skeleton(dot)["head"] is None
