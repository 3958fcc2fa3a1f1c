"""Both kinds of constraint are measured alike, and their Jacobians are those of finite differences."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mocap.body import rotations
from mocap.editing.bodies import body_of
from mocap.editing.boxes import PositionBoxes, RelativeRotation, RotationBoxes
from mocap.editing.constraints import Pins
from mocap.editing.displacements import displaced
from mocap.editing.poses import ROOT, poses_of
from mocap.editing.tuned import TUNED
from tests.editing.wishes import walk
from tests.refusals import refusals
from tests.strategies import seeds

STEP = 1e-6  # metres or radians
CLIP = walk()[::100]
NAMES = CLIP.skeleton.names
ENDS = [NAMES.index(name) for name in ("lwrist", "rtoes", "head", "root")]
ZERO = np.zeros((len(CLIP), 1, 3))


def positions(random):
    values = poses_of(CLIP).positions[:, ENDS] + random.normal(size=(len(CLIP), len(ENDS), 3))
    return PositionBoxes(tuple(ENDS), values, values)


def rotated(random):
    """Rotations in the world and in the parents' frames, away from their references."""
    chosen = []
    for name, is_global in (("head", True), ("thorax", False), ("ltibia", False), ("root", True)):
        reference = rotations.from_rotvec(random.normal(size=(len(CLIP), 3)))
        chosen.append(RelativeRotation(NAMES.index(name), reference, is_global))
    zeros = np.zeros((len(CLIP), len(chosen), 3))
    return RotationBoxes(tuple(chosen), zeros, zeros)


@given(seeds, st.sampled_from([positions, rotated]))
@settings(max_examples=6)
def test_the_jacobian_of_each_kind_is_that_of_finite_differences(seed, kind):
    random = np.random.default_rng(seed)
    boxes = kind(random)
    pins = Pins((), *np.zeros((2, len(CLIP), 0, 3)), boxes) if kind is rotated else None
    pins = pins or Pins(boxes.joints, boxes.low, boxes.high)
    body = body_of(walk(), pins)
    change = 0.3 * random.normal(size=(len(CLIP), len(body.price)))

    def values(numbers):
        return boxes.values(poses_of(displaced(CLIP, body.displacement(numbers, len(NAMES)))))

    displacement = body.displacement(change, len(NAMES))
    poses = poses_of(displaced(CLIP, displacement))
    jacobian = boxes.jacobian(poses, body.world_axes(poses, displacement))
    for column in range(change.shape[1]):
        step = np.zeros(change.shape)
        step[:, column] = STEP
        differences = (values(change + step) - values(change - step)) / (2 * STEP)
        # Rotation vectors jump where an angle passes π.
        is_smooth = np.abs(differences) < 10
        assert is_smooth.mean() > 0.9
        derivatives = np.where(is_smooth, jacobian[..., column], differences)
        np.testing.assert_allclose(derivatives, differences, atol=1e-5)


def test_a_rotation_error_counts_as_a_position_error_on_an_arm():
    quaternions = CLIP.rotations[:, 5]
    relative = RelativeRotation(5, rotations.multiply(quaternions, rotations.from_rotvec([0, 0.2, 0])), False)
    assert RotationBoxes((relative,), ZERO, ZERO).errors(poses_of(CLIP)) == pytest.approx(0.2 * TUNED.arm)


def test_translations_of_the_root_move_positions_and_no_rotations():
    poses = poses_of(CLIP)
    held = Pins((ENDS[0],), ZERO, ZERO, rotated(np.random.default_rng(0)))
    body = body_of(walk(), held)
    axes = body.world_axes(poses, body.displacement(np.zeros((len(CLIP), len(body.price))), len(NAMES)))
    position, rotation = (boxes.jacobian(poses, axes)[..., ROOT] for boxes in held.kinds)
    assert np.array_equal(position[:, 0], np.broadcast_to(np.eye(3), (len(CLIP), 3, 3)))
    assert not rotation.any()


def test_a_value_near_the_end_of_its_box_is_active_and_one_inside_is_not():
    low = np.zeros((1, 1, 3))
    boxes = PositionBoxes((0,), low, np.array([[[1.0, 0.0, np.inf]]]))
    assert boxes.active(np.array([[[0.5, 0.0, 3.0]]])).tolist() == [[[False, True, False]]]
    assert boxes.active(np.array([[[1.0, 0.2, -1.0]]])).tolist() == [[[True, True, True]]]


def test_frames_that_are_selected_take_their_references_along():
    boxes = rotated(np.random.default_rng(1))
    rows = [2, 0]
    clip = replace(CLIP, name="all")
    assert np.allclose(boxes[rows].values(poses_of(clip)[rows]), boxes.values(poses_of(clip))[rows])
    free = boxes.limited_to([1]).constrained
    assert free[1].all() and free.sum() == len(boxes.indices)


test_boxes_that_are_none_are_refused = refusals(
    ("Frame 0, joint 0: a pin needs low ≤ high", lambda: PositionBoxes((0,), ZERO + 1, ZERO)),
    ("2 different joints need", lambda: PositionBoxes((0, 0), np.zeros((1, 2, 3)), np.zeros((1, 2, 3)))),
    ("0 different joints need", lambda: RotationBoxes((), ZERO, ZERO)),
)
