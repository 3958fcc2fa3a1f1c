"""A `.glb` read back by a reader of our own, and by trimesh."""

import io
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from mocap.body import Motion, Skeleton, heading, joint_positions, resample
from mocap.datasets import samples
from mocap.errors import SkeletonMismatch
from mocap.files import gltf, gltf_capsules, load_save
from tests.files.glb_reader import Glb
from tests.refusals import refused
from tests.strategies import random_motion, seeds, wave


def walk():
    return resample(samples.sample("walk_circle"), 30)[:200]


def gap(motion):
    """Return how far joints of the file are from ours, metres."""
    read = Glb(gltf.glb(motion))
    exact = joint_positions(motion)
    assert [read.nodes[joint]["name"] for joint in read.joints] == list(motion.skeleton.names)
    frames = range(0, len(motion), max(1, len(motion) // 7))
    return max(np.abs(read.poses(f / motion.fps)[:, :3, 3] - exact[f]).max() for f in frames)


@given(seeds)
def test_any_motion_of_any_skeleton(seed):
    motion = random_motion(seed, joints=int(seed % 9) + 1)
    assert gap(motion) < 1e-4


def test_between_frames_no_joint_turns_the_long_way_round():
    motion = walk()
    signs = np.random.default_rng(0).choice([-1.0, 1.0], size=(len(motion), len(motion.skeleton), 1))
    read = Glb(gltf.glb(replace(motion, rotations=motion.rotations * signs)))
    for (_, path), (_, values) in read.curves().items():
        if path == "rotation":
            assert np.all((values[1:] * values[:-1]).sum(-1) > 0)


def test_the_file_keeps_the_rules_of_its_specification():
    """As in [GLTF21, 3]: what a validator looks at, beyond what `Glb` asserts of any file."""
    read = Glb(gltf.glb(walk()))
    document, views = read.document, read.document["bufferViews"]
    assert document["asset"]["version"] == "2.0"
    below = [child for node in read.nodes for child in node.get("children", ())]
    roots = set(range(len(read.nodes))) - set(below)
    assert len(set(below)) == len(below) and roots == set(document["scenes"][0]["nodes"])  # trees
    starts = [*(view["byteOffset"] for view in views), document["buffers"][0]["byteLength"]]
    gaps = np.diff(starts) - [view["byteLength"] for view in views]
    assert starts[0] == 0 and np.all((gaps >= 0) & (gaps < 4))
    (part,) = document["meshes"][0]["primitives"]
    corners = {name: read.arrays[number] for name, number in part["attributes"].items()}
    assert {"min", "max"} <= set(document["accessors"][part["attributes"]["POSITION"]])
    assert np.all(corners["WEIGHTS_0"].sum(-1) == 1) and corners["JOINTS_0"].max() < len(read.joints)
    assert read.arrays[part["indices"]].max() == len(corners["POSITION"]) - 1
    for (node, path), (times, values) in read.curves().items():
        assert node in read.joints and len(times) == len(values) and times[0] == 0
        assert path == "translation" or np.allclose(np.linalg.norm(values, axis=-1), 1, atol=1e-4)


def test_the_body_moves_with_its_bones():
    motion = walk()
    read, (spots, _, joints, _) = Glb(gltf.glb(motion)), gltf_capsules.body(motion.skeleton)
    rest, exact = motion.skeleton.rest, joint_positions(motion)[50]
    moved = read.skinned(50 / motion.fps)
    before = np.linalg.norm(spots - rest[joints], axis=-1)
    after = np.linalg.norm(moved - exact[joints], axis=-1)
    assert np.abs(before - after).max() < 1e-4
    assert 1.6 < np.ptp(moved[:, 1]) < 2.0  # the size of a person, metres
    assert moved[:, 1].min() > -0.06


def test_capsules_are_closed_and_face_outwards():
    for bone in ([0, 0.4, 0], [0, -0.4, 0], [0.3, 0.1, -0.2], [0, 0, 0]):
        spots, outward, _, corners = gltf_capsules.body(Skeleton(["a", "b"], [-1, 0], [[0, 0, 0], bone]))
        sides = spots[corners]
        normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        assert np.linalg.norm(normals, axis=-1).min() > 1e-9
        assert np.all((normals * outward[corners].mean(axis=1)).sum(-1) > 0)
        assert np.allclose(np.linalg.norm(outward, axis=-1), 1)
        # Closed: each side of a triangle, by place, is met once in each direction.
        places = {tuple(place): number for number, place in enumerate(np.round(spots, 9).tolist())}
        number = [places[tuple(place)] for place in np.round(spots, 9).tolist()]
        pairs = (pair for t in corners for pair in zip(t, np.roll(t, -1), strict=True))
        edges = [(number[a], number[b]) for a, b in pairs]
        assert len(set(edges)) == len(edges)
        assert {(b, a) for a, b in edges} == set(edges)


def test_a_head_is_a_ball_whether_a_bone_starts_there_or_not():
    neck = ["hips", "neck", "Head"]
    for names, parents in ((neck, [-1, 0, 1]), ([*neck, "Head_end"], [-1, 0, 1, 2])):
        offsets = [[0, 0, 0], [0, 0.6, 0], [0, 0.1, 0], [0, 0.15, 0]][: len(names)]
        spots, _, joints, _ = gltf_capsules.body(Skeleton(names, parents, offsets))
        ball = spots[joints == 2]
        width, height = np.ptp(ball, axis=0)[[0, 1]]
        assert 0.08 < width < height < 2 * width


def test_a_large_skeleton_counts_corners_in_32_bits():
    count = 1200
    chain = Skeleton([f"j{n}" for n in range(count)], np.arange(count) - 1, np.eye(3)[np.zeros(count, int)])
    still = Motion(chain, np.zeros((1, 3)), np.tile([1.0, 0, 0, 0], (1, count, 1)), 30.0)
    read = Glb(gltf.glb(still))
    index = read.document["meshes"][0]["primitives"][0]["indices"]
    assert read.arrays[index].dtype == np.uint32
    assert read.arrays[index].max() > 65535


def test_frames_too_short_for_its_clock_and_files_too_large_are_refused(tmp_path, monkeypatch):
    fast, file = replace(wave(300), fps=1e50), tmp_path / "a.glb"
    refused(r"'wave' at 1e\+50 Hz is too fast for a \.glb: resample it\.", load_save.save, fast, file)
    monkeypatch.setattr(gltf, "MOST", 10_000)
    refused(r"A \.glb file holds 0\.0 GB at most, not 0\.0: write \.bvh\.", load_save.save, wave(300), file)
    assert list(tmp_path.iterdir()) == []


def test_ten_seconds_at_120_hz_take_less_than_half_a_megabyte():
    assert len(gltf.glb(samples.sample("walk_straight"))) < 500_000


def test_odd_names_are_kept():
    motion = wave(3, name='w"\n\u2028\ud800')
    skeleton = replace(motion.skeleton, names=['"root"', "ellenbogen-ä", "\0", "{}"])
    assert gap(replace(motion, skeleton=skeleton, contacts={})) < 1e-4


def test_trimesh_reads_the_body_and_the_joints():
    trimesh = pytest.importorskip("trimesh", reason="pip install '.[ci]'")
    motion = walk()
    scene = trimesh.load(io.BytesIO(gltf.glb(motion)), file_type="glb")
    spots, _, _, corners = gltf_capsules.body(motion.skeleton)
    (mesh,) = scene.geometry.values()
    assert len(mesh.faces) == len(corners)
    rest = motion.skeleton.rest
    spots = spots - [0, rest[:, 1].min(), 0]
    assert np.allclose(mesh.bounds, [spots.min(0), spots.max(0)], atol=1e-6)
    for joint, name in enumerate(motion.skeleton.names):
        place = scene.graph.get(name)[0][:3, 3]
        assert np.abs(place - rest[joint] + [0, rest[:, 1].min(), 0]).max() < 1e-4


def test_several_motions_of_one_body_are_animations_with_their_own_rates():
    still = replace(walk()[:1].at([0, 0, 0, 0]), name="still")
    motions = [walk(), replace(resample(walk(), 20), name="slow"), still]
    read = Glb(gltf.glb(motions))
    alone = Glb(gltf.glb(walk()))
    animations = read.document["animations"]
    assert [animation["name"] for animation in animations] == ["walk_circle", "slow", "still"]
    for motion, animation in zip(motions, animations, strict=True):
        targets = [channel["target"] for channel in animation["channels"]]
        assert targets == [channel["target"] for channel in alone.document["animations"][0]["channels"]]
        clock = read.arrays[animation["samplers"][0]["input"]].ravel()
        assert len(clock) == len(motion) and clock[-1] == pytest.approx(motion.duration)
    assert gltf.glb([walk()]) == gltf.glb(walk())


def test_animations_need_one_body_and_their_own_names():
    refused("Two motions have the name 'walk_circle'", gltf.glb, [walk(), walk()])
    refused("skeletons differ", gltf.glb, [walk(), wave(20)], kind=SkeletonMismatch, most=300)


def test_several_clips_are_written_as_glb(tmp_path):
    clips = [wave(20, name="a"), wave(30, name="b")]
    load_save.save_clips(clips, tmp_path / "clips.glb")
    assert len(Glb((tmp_path / "clips.glb").read_bytes()).document["animations"]) == 2
    load_save.save_clips(clips[:1], tmp_path / "a.bvh")
    assert len(load_save.load(tmp_path / "a.bvh")) == 20
    path = tmp_path / "clips.bvh"
    refused(
        "Several clips in one file, and a joint on the floor, need .glb, got ",
        load_save.save_clips,
        clips,
        path,
        most=300,
    )


def test_a_joint_on_the_floor_carries_the_travel_and_nothing_else_changes():
    motion = walk()
    read = Glb(gltf.glb(motion, root=True))
    joints = len(motion.skeleton)
    floor = read.joints[-1]
    assert len(read.joints) == joints + 1 and read.parents()[0] == floor
    assert read.nodes[floor]["name"] == "floor_root" and read.document["skins"][0]["skeleton"] == floor
    exact = joint_positions(motion)
    for frame in range(0, len(motion), 29):
        *poses, root = read.poses(frame / motion.fps)
        np.testing.assert_allclose(np.array(poses)[:, :3, 3], exact[frame], atol=1e-4)
        np.testing.assert_allclose(root[:3, 3], motion.root_positions[frame] * [1, 0, 1], atol=1e-6)
        ahead = root[:3, 2]
        assert np.arctan2(ahead[0], ahead[2]) == pytest.approx(heading(motion.rotations[frame, 0]), abs=1e-6)
        assert root[1, 1] == pytest.approx(1.0)
    hips = read.curves()[0, "translation"][1]
    assert np.abs(hips[:, [0, 2]]).max() < 1e-6
    np.testing.assert_allclose(read.skinned(1.0), Glb(gltf.glb(motion)).skinned(1.0), atol=1e-4)
    np.testing.assert_allclose(
        read.skinned(0, rest=True), Glb(gltf.glb(motion)).skinned(0, rest=True), atol=1e-6
    )
