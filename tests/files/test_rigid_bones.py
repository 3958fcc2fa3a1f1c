"""Bones that stretch are fitted to rigid ones: closer than by dropping what moves, and not at all too far."""

import re

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from mocap.body import Motion, Skeleton, joint_positions, resample, rotations
from mocap.datasets import samples
from mocap.errors import FormatError
from mocap.files import load_save, rigid_bones
from mocap.files.tuned import TUNED
from tests.refusals import refused, told

WALK = resample(samples.sample("walk_straight"), 30)[:90]


def stretched(amount, seed=0):
    """Give places (F, J, 3) below the parents that move smoothly by up to `amount` metres along each axis."""
    random = np.random.default_rng(seed)
    noise = gaussian_filter1d(random.normal(size=(len(WALK), len(WALK.skeleton), 3)), 5, axis=0)
    noise *= amount / np.abs(noise).max()
    noise[:, 0] = 0
    places = WALK.skeleton.offsets + noise * (np.linalg.norm(WALK.skeleton.offsets, axis=-1) > 0)[:, None]
    places[:, 0] = WALK.root_positions
    return places


def apart(offsets, local, places):
    """Return how far joints lie from those of the file, (J,), metres, RMS over the frames."""
    skeleton = Skeleton(WALK.skeleton.names, WALK.skeleton.parents, offsets)
    ours = joint_positions(Motion(skeleton, WALK.root_positions, local, 30.0))
    theirs, _ = rigid_bones._world_poses(WALK.skeleton.parents, places, WALK.rotations)
    return np.sqrt(((ours - theirs) ** 2).sum(-1).mean(0))


def test_rigid_bones_stay_as_they_are():
    places = stretched(0.0)
    offsets, local, stretch, off = rigid_bones.fit(WALK.skeleton.parents, places, WALK.rotations)
    assert stretch.max() < 1e-12
    assert off.max() < 1e-9
    assert np.allclose(offsets, WALK.skeleton.offsets, atol=1e-12)
    assert rotations.angle_between(local, WALK.rotations).max() < 1e-7


@pytest.mark.parametrize("seed", range(3))
def test_the_fit_is_closer_than_dropping_what_moves(seed):
    places = stretched(0.006, seed)
    offsets, local, stretch, off = rigid_bones.fit(WALK.skeleton.parents, places, WALK.rotations)
    assert stretch.max() <= TUNED.stretch and off.max() <= TUNED.strayed * TUNED.stretch
    fitted = apart(offsets, local, places)
    for offsets in (places[0], places.mean(axis=0)):  # of the first frame, as some readers do; or the mean
        dropped = apart(np.vstack([np.zeros((1, 3)), offsets[1:]]), WALK.rotations, places)
        assert np.median(fitted[1:] / np.maximum(dropped[1:], 1e-9)) < 0.8
        assert fitted.max() < 0.8 * dropped.max()


def test_a_bone_that_swings_keeps_its_length_and_loses_nothing():
    turn = np.linspace(0, 1.5, 40)
    places = np.zeros((40, 3, 3))
    places[:, 1] = 0.3 * np.stack([np.sin(turn), np.cos(turn), 0 * turn], axis=-1)
    places[:, 2] = [0, 0.2, 0]
    *_, stretch, off = rigid_bones.fit(np.array([-1, 0, 1]), places, np.tile(rotations.IDENTITY, (40, 3, 1)))
    assert stretch.max() < 1e-12
    assert off.max() < 1e-3


def six_channels(places, local, names=("hips", "spine", "head")):
    """Write a chain of joints with six channels each, in centimetres."""
    rows = ["HIERARCHY"]
    for depth, name in enumerate(names):
        rows += [f"{'JOINT' if depth else 'ROOT'} {name}", "{", "OFFSET 0 0 0", "CHANNELS 6"]
        rows[-1] += " Xposition Yposition Zposition Zrotation Xrotation Yrotation"
        rows += ["JOINT side", "{", "OFFSET 9 0 0", "CHANNELS 0", "}"] if depth == 0 else []
    rows += ["}"] * len(names) + ["MOTION", f"Frames: {len(places)}", "Frame Time: 0.033333"]
    values = np.concatenate([100 * places, np.degrees(local)], axis=-1).reshape(len(places), -1)
    return "\n".join(rows + [" ".join(f"{number:.9f}" for number in row) for row in values])


def chain(amount):
    """Return places and angles of a chain whose middle bone changes its length by `amount` metres."""
    places, angles = np.zeros((60, 3, 3)), np.zeros((60, 3, 3))
    places[:, 0] = [0, 1, 0]
    places[:, 1:, 1] = 0.4
    places[:, 1, 1] += amount * np.linspace(0, 1, 60)
    angles[:, 0, 2] = np.linspace(0, 1, 60)
    return places, angles


def test_a_bvh_file_that_stretches_a_little_is_read_with_a_warning(tmp_path):
    (tmp_path / "a.bvh").write_text(six_channels(*chain(0.01)))
    fitted = "bones change length by up to 10 mm (spine); fitted to rigid bones, joints lie up to 5 mm"
    motion = told(re.escape(fitted), load_save.load, tmp_path / "a.bvh", most=200 + len(str(tmp_path)))
    spine = motion.skeleton.index("spine")
    assert np.allclose(motion.skeleton.offsets[spine], [0, 0.405, 0])


@pytest.mark.parametrize("amount", [0.021, 0.5])
def test_a_bvh_file_that_stretches_far_is_refused(tmp_path, amount):
    (tmp_path / "a.bvh").write_text(six_channels(*chain(amount)))
    apart = rf"line 11: expected 'spine' in one place below its parent, but for 0.02 m, got .* by {amount:g}"
    refused(apart, load_save.load, tmp_path / "a.bvh", kind=FormatError)


def test_children_that_part_are_refused_even_if_their_bones_keep_their_lengths():
    turn = np.linspace(0, 2, 30)
    places = np.zeros((30, 3, 3))
    places[:, 1] = np.stack([np.sin(turn), np.cos(turn), 0 * turn], axis=-1)
    places[:, 2] = [0, -1, 0]
    *_, stretch, off = rigid_bones.fit(np.array([-1, 0, 0]), places, np.tile(rotations.IDENTITY, (30, 3, 1)))
    assert stretch.max() < 1e-12
    assert off.max() > TUNED.strayed * TUNED.stretch
