"""The unit and the vertical axis of clips, from their frames: bundled walks written in any space."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mocap.body import joint_positions, resample, rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.datasets import sample
from mocap.errors import MocapError, MocapWarning
from mocap.files import bvh, clip_sets, load_save, spaces
from mocap.files.space_evidence import (
    carried_joints,
    direction,
    frames_to_look_at,
    free_fall,
    gather,
    main_body,
)
from tests.editing.bodies import renamed
from tests.refusals import refused, unwarned

WALK = resample(sample("walk_straight"), 30)
DEFAULT = (0.01, "y")


def in_space(motion, scale, up):
    """Return a motion as a file with another unit, `scale` metres, and another axis up has it."""
    turn = rotations.inverse(spaces.UPRIGHT[up])
    skeleton = replace(motion.skeleton, offsets=rotations.rotate(turn, motion.skeleton.offsets) / scale)
    local = rotations.multiply(rotations.multiply(turn, motion.rotations), rotations.inverse(turn))
    roots = rotations.rotate(turn, motion.root_positions) / scale
    return replace(motion, skeleton=skeleton, root_positions=roots, rotations=local)


def written(motion, path, scale, up="y"):
    """Write a motion as a BVH file of another space."""
    load_save.save(in_space(motion, scale / bvh.SCALE, up), path)
    return path


def evidence_of(motion):
    positions = joint_positions(motion)
    frames, rate = frames_to_look_at(motion.root_positions, motion.fps)
    return gather(motion.skeleton.parents, positions[frames], rate)


def resized(motion, size, *, own_pace):
    """Return a motion of a smaller body; at its own pace it moves faster, by the square root of the size."""
    skeleton = replace(motion.skeleton, offsets=size * motion.skeleton.offsets)
    fps = motion.fps / math.sqrt(size) if own_pace else motion.fps
    return replace(motion, skeleton=skeleton, root_positions=size * motion.root_positions, fps=fps)


SPACES = [(scale, up) for scale in spaces.UNITS for up in spaces.UPRIGHT]


@pytest.mark.parametrize(("scale", "up"), SPACES)
def test_a_walk_is_read_upright_in_metres_from_any_space(tmp_path, scale, up):
    path = written(WALK, tmp_path / "walk.bvh", scale, up)
    if (scale, up) == DEFAULT:
        motion = unwarned(load_save.load, path)
    else:
        said = f"read as {spaces.unit_name(scale)} a unit, {up} up: 1.7"
        with pytest.warns(MocapWarning, match=f"{said}.* scale= and up= overrule it"):
            motion = load_save.load(path)
    order = [motion.skeleton.index(name) for name in WALK.skeleton.names]
    assert np.abs(joint_positions(motion)[:, order] - joint_positions(WALK)).max() < 1e-5
    assert motion == load_save.load(path, scale=scale, up=up)


def test_what_the_caller_says_is_not_decided_and_not_stated(tmp_path):
    path = written(WALK, tmp_path / "walk.bvh", 0.0254, "z")
    small = unwarned(load_save.load, path, scale=0.01, up="z")
    assert np.ptp(joint_positions(small)[0, :, 1]) == pytest.approx(1.6 / 2.54, rel=0.1)
    lying = unwarned(load_save.load, path, scale=0.0254, up="y")
    assert np.ptp(joint_positions(lying)[0, :, 1]) < 1.2
    with pytest.warns(
        MocapWarning, match=r"1 inch a unit, z up: 1\.7\d m tall \(0\.68 m .*\)\. scale= overrules it"
    ):
        load_save.load(path, up="z")
    refused("up must be 'y', 'z', '-y', '-z', 'x' or '-x', got 'Y'", load_save.load, path, up="Y")


@pytest.mark.parametrize("own_pace", [True, False])
@pytest.mark.parametrize("size", [1.0 / 1.75, 0.8])
def test_children_keep_their_size(tmp_path, size, own_pace):
    child = resized(WALK, size, own_pace=own_pace)
    load_save.save(child, tmp_path / "child.bvh")
    motion = load_save.load(tmp_path / "child.bvh")
    assert np.allclose(motion.root_positions, child.root_positions, atol=1e-6)


def test_a_toy_at_its_own_pace_keeps_its_size_and_a_doubt_is_stated(tmp_path):
    toy = resized(WALK, 0.3 / 1.75, own_pace=True)
    load_save.save(toy, tmp_path / "toy.bvh")
    with pytest.warns(MocapWarning, match=r"0\.30 m tall; 1\.6\d m if it is 5\.64 cm a unit"):
        motion = load_save.load(tmp_path / "toy.bvh")
    assert np.allclose(motion.root_positions, toy.root_positions, atol=1e-6)


def test_a_toy_at_an_adults_pace_is_an_adult_number_for_number_and_both_sizes_are_stated(tmp_path):
    load_save.save(resized(WALK, 0.3 / 1.75, own_pace=False), tmp_path / "toy.bvh")
    said = (
        r"5\.64 cm a unit, y up: 1\.6\d m tall \(0\.30 m if it is 1 cm a unit\)\. scale= and up= overrule it"
    )
    with pytest.warns(MocapWarning, match=said):
        load_save.load(tmp_path / "toy.bvh")


def lying():
    """Return the walk of a body that lies on its back."""
    turned = rotations.multiply(rotations.from_rotvec([np.pi / 2, 0, 0]), WALK.rotations[:, :1])
    flat = np.concatenate([turned, WALK.rotations[:, 1:]], axis=1)
    return replace(WALK, rotations=flat, root_positions=np.full((len(WALK), 3), [0.0, 0.2, 0.0]))


def test_a_body_that_lies_is_not_set_upright(tmp_path):
    load_save.save(lying(), tmp_path / "lying.bvh")
    motion = load_save.load(tmp_path / "lying.bvh")
    assert np.allclose(motion.root_positions, [0.0, 0.2, 0.0], atol=1e-6)


def test_other_things_than_bodies_are_read_in_the_space_of_the_format(tmp_path):
    bones = Skeleton([f"bone{n}" for n in range(5)], [-1, 0, 1, 2, 3], np.full((5, 3), 30.0))
    crane = Motion(bones, np.zeros((40, 3)), np.tile([1.0, 0, 0, 0], (40, 5, 1)), 30.0)
    load_save.save(crane, tmp_path / "crane.bvh")
    assert unwarned(load_save.load, tmp_path / "crane.bvh").skeleton.offsets[1, 0] == pytest.approx(30)


def alone_and_together(paths):
    """Return the spaces of files that are read each by itself, and their recordings as a set."""

    def read(number, space=None):
        scale, up, root_offset = space.choices() if space else (None, None, None)
        return load_save.read(paths[number], None, None, scale, 0.02, up, root_offset)

    recordings = [read(number) for number in range(len(paths))]
    spaces = clip_sets.agreed_spaces([clip_sets.set_member(recording) for recording in recordings])
    alone = [recording.space.choices() for recording in recordings]
    return alone, clip_sets.agree(recordings, spaces, read)


def test_a_set_has_one_space_that_its_surest_clip_settles(tmp_path):
    clips = [lying()[:8], WALK]
    paths = [written(clip, tmp_path / f"{n}.bvh", 0.056444, "z") for n, clip in enumerate(clips)]

    alone, together = alone_and_together(paths)
    assert alone != [(0.056444, "z", None)] * 2
    assert [recording.space.choices() for recording in together] == [(0.056444, "z", None)] * 2
    assert together[0].motion.root_positions[0] == pytest.approx([0.0, 0.2, 0.0], abs=1e-5)


def test_files_of_one_body_that_show_different_axes_beyond_doubt_keep_them(tmp_path):
    paths = [written(WALK, tmp_path / f"{up}.bvh", 0.01, up) for up in ("y", "z", "y")]
    paths.append(written(WALK[:8], tmp_path / "short.bvh", 0.01, "y"))
    alone, together = alone_and_together(paths)
    assert [up for _, up, _ in alone[:3]] == ["y", "z", "y"]
    assert [recording.space.choices() for recording in together] == alone


def test_files_of_one_hierarchy_in_different_units_do_not_decide_for_each_other(tmp_path):
    units = (0.01, 0.0254, 0.01, 0.0254)
    clips = [WALK, WALK, WALK[:8], WALK[:8]]
    paths = [written(clip, tmp_path / f"{n}.bvh", units[n]) for n, clip in enumerate(clips)]
    _, together = alone_and_together(paths)
    assert [recording.space.scale for recording in together] == [*units]
    heights = [np.ptp(joint_positions(recording.motion)[0, :, 1]) for recording in together]
    assert heights == pytest.approx([heights[0]] * 4, rel=0.02)


def test_bodies_of_other_joints_or_another_size_do_not_decide_for_each_other(tmp_path):
    toddler = resized(WALK, 0.45, own_pace=True)
    other = renamed(WALK, {name: f"b_{name}" for name in WALK.skeleton.names})
    bodies = [WALK, toddler, in_space(other, 2.54, "y")]
    paths = [tmp_path / f"{n}.bvh" for n in range(3)]
    for body, path in zip(bodies, paths, strict=True):
        load_save.save(body, path)
    alone, together = alone_and_together(paths)
    assert [recording.space.choices() for recording in together] == alone
    assert alone == [(0.01, "y", None), (0.01, "y", None), (0.0254, "y", None)]


# The evidence -------------------------------------------------------------------


def test_ten_seconds_are_looked_at_in_which_the_root_travels_furthest():
    roots = np.zeros((6000, 3))
    roots[3000:4500, 2] = np.linspace(0, 9, 1500)
    roots[4500:, 2] = 9
    frames, rate = frames_to_look_at(roots, 120.0)
    assert len(frames) == 300 and rate == 30.0
    assert frames[0] > 3000 - 4 and frames[-1] < 4500 + 4


def test_props_and_still_roots_are_no_part_of_the_body():
    positions = joint_positions(WALK)
    still = np.zeros((len(WALK), 1, 3))
    sword = positions[:, :1] + np.linspace(0, 3, len(WALK))[:, None, None]
    everything = np.concatenate([still, positions, sword], axis=1)
    parents = np.array([-1, *(WALK.skeleton.parents + 1), 1])
    joints = main_body(parents, everything)
    assert 0 not in joints and len(parents) - 1 not in joints
    assert len(joints) == len(WALK.skeleton)


def with_sword(motion, length, direction):
    """Return a motion with a sword in the right hand, which keeps its direction in the frame of the hand."""
    skeleton = motion.skeleton
    names = [*skeleton.names, "hilt", "point"]
    parents = [*skeleton.parents, skeleton.index("rhand"), len(skeleton)]
    offsets = [*skeleton.offsets, [0.0, 0.0, 0.0], length * np.array(direction)]
    still = np.broadcast_to(rotations.IDENTITY, (len(motion), 2, 4))
    turns = np.concatenate([motion.rotations, still], axis=1)
    return replace(motion, skeleton=Skeleton(names, parents, offsets), rotations=turns)


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 1, 0), (0, -0.7, 0.7), (-1, 0, 0)])
def test_a_sword_in_a_hand_changes_neither_unit_nor_axis(tmp_path, direction):
    path = written(with_sword(WALK, 0.9, direction), tmp_path / "sword.bvh", 0.0254, "z")
    with pytest.warns(MocapWarning, match=r"read as 1 inch a unit, z up: 1\.[67]\d m tall \(0"):
        load_save.load(path)


def test_fingers_of_one_hand_only_are_no_props():
    parents = WALK.skeleton.parents
    positions = joint_positions(WALK)
    is_finger = np.array([name in ("lfingers", "lfingers_end") for name in WALK.skeleton.names])
    numbers = np.cumsum(~is_finger) - 1
    kept = np.where(parents < 0, -1, numbers[parents])[~is_finger]
    assert carried_joints(kept, positions[:, ~is_finger]) == set()


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254])
def test_a_free_fall_shows_the_acceleration_of_gravity_in_the_unit_of_the_file(unit):
    times = np.arange(60) / 30
    height = np.where(times < 0.6, 2.943 * times - 9.81 / 2 * times**2, 0.0)
    body = np.linspace(0, 1.7, 20)
    heights = (np.maximum(height, 0)[:, None] + body) / unit
    assert free_fall(heights, 30.0, 1.7 / unit) * unit == pytest.approx(9.81, rel=0.02)
    assert free_fall(np.tile(body, (60, 1)), 30.0, 1.7) is None


def test_evidence_does_not_depend_on_the_unit_but_by_its_size():
    metres = evidence_of(WALK)
    inches = evidence_of(in_space(WALK, 0.0254, "y"))
    assert inches.size * 0.0254 == pytest.approx(metres.size)
    assert inches.stride.period == metres.stride.period
    assert inches.stride.length == pytest.approx(metres.stride.length)
    assert inches.scores == pytest.approx(metres.scores)


def test_scores_turn_with_the_body():
    for up in spaces.UPRIGHT:
        evidence = evidence_of(in_space(WALK, 1.0, up))
        assert evidence.best_axis() == up
        assert np.allclose(rotations.rotate(spaces.UPRIGHT[up], direction(up)), [0, 1, 0])


def test_a_wrong_axis_is_refused():
    with pytest.raises(MocapError, match="up must be"):
        spaces.require_axis("up")


# Root channels that are relative to the root's OFFSET ---------------------------


def with_offset(path, offset, *, relative):
    """Give the root of a BVH file an OFFSET; if its positions are relative to that, subtract it from them."""
    hierarchy, _, frames = path.read_text().partition("Frame Time")
    hierarchy = hierarchy.replace(
        "OFFSET 0.000000 0.000000 0.000000", f"OFFSET {offset[0]} {offset[1]} {offset[2]}", 1
    )
    seconds, *rows = frames.splitlines()
    numbers = np.array([row.split() for row in rows], float)
    if relative:
        numbers[:, :3] -= offset
    rows = [" ".join(f"{number:.6f}" for number in row) for row in numbers]
    path.write_text("\n".join([f"{hierarchy}Frame Time{seconds}", *rows, ""]))
    return path


def lifted(motion, height):
    """Return a motion at another height, as on another floor."""
    return replace(motion, root_positions=motion.root_positions + np.array([0.0, height, 0.0]))


HIPS = np.array([3.0, 95.0, -2.0])  # centimetres: a point that the hips have in the rest pose


@pytest.mark.parametrize("name", ["walk_straight", "jog", "sneak"])
def test_positions_relative_to_the_offset_of_the_root_are_added_to_it_and_that_is_said(tmp_path, name):
    motion = resample(sample(name), 30)
    load_save.save(motion, tmp_path / "a.bvh")
    path = with_offset(tmp_path / "a.bvh", HIPS, relative=True)
    with pytest.warns(
        MocapWarning, match=r"1 cm a unit, y up: 1\.\d+ m tall, the root's OFFSET added\. scale=, up= and"
    ):
        loaded = load_save.load(path)
    assert np.allclose(loaded.root_positions, motion.root_positions, atol=1e-6)
    assert loaded == unwarned(load_save.load, path, root_offset="add")
    below = unwarned(load_save.load, path, root_offset="ignore")
    assert np.allclose(below.root_positions, motion.root_positions - HIPS / 100, atol=1e-6)


@pytest.mark.parametrize(("scale", "up"), [(0.0254, "y"), (1.0, "z"), (0.01, "-x")])
def test_they_are_added_in_any_unit_and_along_any_axis(tmp_path, scale, up):
    offset = rotations.rotate(rotations.inverse(spaces.UPRIGHT[up]), HIPS) * 0.01 / scale
    path = with_offset(written(WALK, tmp_path / "walk.bvh", scale, up), offset, relative=True)
    with pytest.warns(MocapWarning, match="the root's OFFSET added"):
        motion = load_save.load(path)
    assert np.allclose(motion.root_positions, WALK.root_positions, atol=1e-5)


@pytest.mark.parametrize("height", [0.0, 0.3, -0.2, -3.0])
def test_an_offset_that_does_not_lift_the_body_onto_the_floor_is_ignored(tmp_path, height):
    load_save.save(lifted(WALK, height), tmp_path / "a.bvh")
    motion = unwarned(load_save.load, with_offset(tmp_path / "a.bvh", HIPS, relative=False))
    assert np.allclose(motion.root_positions, lifted(WALK, height).root_positions, atol=1e-6)


@pytest.mark.parametrize("height", [-0.7, -1.2])
def test_an_offset_that_lifts_the_body_near_the_floor_is_ignored_and_the_doubt_is_stated(tmp_path, height):
    load_save.save(lifted(WALK, height), tmp_path / "a.bvh")
    with pytest.warns(
        MocapWarning, match=r"; perhaps the root's OFFSET is to be added\. scale=, up= and root_offset="
    ):
        motion = load_save.load(with_offset(tmp_path / "a.bvh", HIPS, relative=False))
    assert np.allclose(motion.root_positions, lifted(WALK, height).root_positions, atol=1e-6)


def test_a_small_offset_is_ignored(tmp_path):
    load_save.save(lifted(WALK, -0.2), tmp_path / "a.bvh")
    motion = unwarned(load_save.load, with_offset(tmp_path / "a.bvh", [0.0, 20.0, 0.0], relative=False))
    assert np.allclose(motion.root_positions, lifted(WALK, -0.2).root_positions, atol=1e-6)


def test_a_set_of_files_adds_the_offset_to_all_or_to_none(tmp_path):
    clips = [WALK, WALK[:40], lifted(WALK, -0.3)]  # the last one alone is in doubt
    paths = []
    for number, clip in enumerate(clips):
        load_save.save(clip, tmp_path / f"{number}.bvh")
        paths.append(with_offset(tmp_path / f"{number}.bvh", HIPS, relative=True))
    alone, together = alone_and_together(paths)
    assert [choices[2] for choices in alone] == ["add", "add", "ignore"]
    assert [recording.space.root_offset for recording in together] == ["add"] * 3
    assert np.allclose(together[2].motion.root_positions, clips[2].root_positions, atol=1e-6)


def test_a_wrong_use_of_the_offset_is_refused(tmp_path):
    path = written(WALK, tmp_path / "walk.bvh", 0.01)
    refused("root_offset must be 'add' or 'ignore', got 'yes'", load_save.load, path, root_offset="yes")
