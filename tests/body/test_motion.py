"""What a motion refuses; slices, rates and sequences of motions, of one rig with any end sites."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.blending import blend, mix, register
from mocap.body import Motion, Skeleton, concatenate, resample, rotations
from mocap.body.concatenation import require_compatible
from mocap.body.fingerprints import fingerprint
from mocap.body.kinematics import forward_kinematics
from mocap.datasets import sample
from mocap.errors import MocapError, SkeletonMismatch
from mocap.graphs import build
from mocap.matching import find_transitions
from mocap.matching.point_clouds import rms_distance
from mocap.methods.match_webs import build_web
from tests.refusals import refusals, refused
from tests.strategies import random_motion, seeds, wave


def bad_rotations(motion, value):
    changed = motion.rotations.copy()
    changed[3, 2] = value
    return changed


def changed(**fields):
    return replace(random_motion(0), **fields)


GIVEN = random_motion(0)

test_a_bad_motion_is_refused = refusals(
    ("has no frames", lambda: changed(root_positions=np.zeros((0, 3)))),
    (r"got \(4, 3\) and \(5, 6, 4\)", lambda: changed(root_positions=GIVEN.root_positions[:4])),
    (r"got \(5, 3\) and \(5, 5, 4\)", lambda: changed(rotations=GIVEN.rotations[:, :5])),
    ("not finite in frame 3", lambda: changed(rotations=bad_rotations(GIVEN, np.nan))),
    ("frame 3, joint 'joint2'.*length 1", lambda: changed(rotations=bad_rotations(GIVEN, 0.9))),
    ("frame rate above 0, got 0", lambda: changed(fps=0)),
    ("frame rate above 0", lambda: changed(fps=np.inf)),
    ("No joint 'tail'", lambda: changed(contacts={"tail": True})),
    (r"'walk' needs 5 booleans, got shape \(2,\)", lambda: changed(labels={"walk": [True, False]})),
    ("forwards only; got a step of -1", lambda: GIVEN[::-1]),
    ("no frames", lambda: GIVEN[4:4]),
    ("above 0, got -3", resample, GIVEN, -3),
    ("one clip or more, got none", concatenate, []),
    ("30 Hz, 'wave' at 60 Hz", concatenate, [wave(3), replace(wave(3), fps=60)]),
    (SkeletonMismatch, "'random1' and 'wave': The skel", concatenate, [random_motion(1), wave(3)]),
)


def test_a_single_boolean_marks_every_frame():
    walk = replace(random_motion(0), labels={"walk": True})
    assert walk.labels["walk"].tolist() == [True] * 5


def test_a_motion_can_be_copied_and_sent_to_another_process():
    motion = random_motion(1)
    for twin in (copy.deepcopy(motion), pickle.loads(pickle.dumps(motion))):
        assert np.array_equal(twin.rotations, motion.rotations)


def test_slices_keep_marks_and_divide_the_rate():
    motion = random_motion(2, frames=9)
    part = motion[2:8:3]
    assert len(part) == 2
    assert part.fps == 10
    assert np.array_equal(part.rotations, motion.rotations[[2, 5]])
    assert np.array_equal(part.contacts["joint5"], motion.contacts["joint5"][[2, 5]])


@given(seeds, st.integers(2, 5))
def test_resampling_up_and_back_down_gives_the_motion_back(seed, factor):
    motion = random_motion(seed)
    back = resample(resample(motion, motion.fps * factor), motion.fps)
    assert len(back) == len(motion)
    assert back.root_positions == pytest.approx(motion.root_positions, abs=1e-9)
    assert rotations.angle_between(back.rotations, motion.rotations) == pytest.approx(0, abs=1e-6)
    assert np.array_equal(back.contacts["joint5"], motion.contacts["joint5"])


@given(st.floats(1, 500), st.integers(1, 200))
def test_resampling_keeps_the_duration_to_a_frame(fps, frames):
    after = resample(wave(frames), fps)
    assert after.duration <= wave(frames).duration + 1e-6
    assert after.duration > wave(frames).duration - 1 / fps


def test_resampling_a_smooth_motion_stays_on_it():
    coarse, fine = wave(100), resample(wave(100), 117.0)
    t = 2 * np.pi * np.arange(len(fine)) / 117 * 30 / 40
    assert fine.root_positions[:, 1] == pytest.approx(1 + 0.02 * np.sin(2 * t), abs=5e-3)
    assert fine.name == coarse.name
    assert resample(coarse, coarse.fps) is coarse
    assert wave(31).duration == 1.0


def test_concatenation_keeps_frames_and_fills_missing_marks():
    skeleton = random_motion(0).skeleton
    a = random_motion(1, 3, skeleton=skeleton)
    b = replace(random_motion(2, 2, skeleton=skeleton), contacts={})
    both = concatenate([a, replace(b, labels={"run": True})], "both")
    assert both.name == "both"
    assert np.array_equal(both.rotations, np.concatenate([a.rotations, b.rotations]))
    assert both.labels["run"].tolist() == [False] * 3 + [True] * 2
    assert both.contacts["joint5"].tolist() == [*a.contacts["joint5"], False, False]


PLAIN = wave(160, name="plain")
NAMES, BONES = PLAIN.skeleton.names, PLAIN.skeleton.offsets


def rigged(motion: Motion, **ends: list[float]) -> Motion:
    """Put end sites of given offsets on a clip: `hand_end`, `side_end`, `side_end2`."""
    names = [*NAMES, *ends]
    parents = [*PLAIN.skeleton.parents, *(names.index(end.partition("_")[0]) for end in ends)]
    body = Skeleton(names, np.array(parents), np.array([*BONES, *ends.values()]))
    still = np.tile([1.0, 0, 0, 0], (len(motion), len(ends), 1))
    return replace(motion, skeleton=body, rotations=np.concatenate([motion.rotations, still], axis=1))


def laboratory() -> list[Motion]:
    """Three clips of one rig, whose files have three kinds of end sites."""
    clips = [wave(160, phase=n, name="abc"[n], seed=n) for n in range(3)]
    side = rigged(clips[1], hand_end=[0.12, 0, 0], side_end=[0, 0.1, 0])
    return [rigged(clips[0], hand_end=[0.1, 0, 0]), side, clips[2]]


def same_rig() -> list[Motion]:
    """The same clips, all with the end sites of the second."""
    full = {"hand_end": [0.12, 0, 0], "side_end": [0, 0.1, 0]}
    return [rigged(wave(160, phase=n, name="abc"[n], seed=n), **full) for n in range(3)]


def test_all_get_the_end_sites_of_the_one_with_the_most():
    for clip, wanted in zip(require_compatible(laboratory()), same_rig(), strict=True):
        np.testing.assert_array_equal(clip.skeleton.offsets, wanted.skeleton.offsets)
        np.testing.assert_array_equal(clip.rotations, wanted.rotations)
        assert clip.contacts.keys() == {"hand"} and clip.skeleton.names == wanted.skeleton.names


@pytest.mark.parametrize(
    "work",
    [
        lambda clips: find_transitions(clips, window=10, below=0.05).cost,
        lambda clips: sorted(map(str, build(clips, window=10, threshold=0.05).graph.edges)),
        lambda clips: build_web(clips, below=0.05).cells,
        lambda clips: blend(clips[1], clips[2], np.linspace(0, 1, 160)).rotations,
        lambda clips: mix(register(clips, slack=0), [0.2, 0.3, 0.5]).rotations,
        lambda clips: concatenate(clips).rotations,
        lambda clips: [rms_distance(clips[1], clips[2])],
    ],
    ids=["transitions", "graph", "web", "blend", "mix", "concatenate", "distance"],
)
def test_what_is_made_of_them_is_what_one_rig_gives(work):
    some, wanted = (np.array(work(clips)) for clips in (laboratory(), same_rig()))
    assert len(some) and np.array_equal(some, wanted)


def other(names, offsets):
    return [PLAIN, replace(PLAIN, skeleton=Skeleton(names, PLAIN.skeleton.parents, offsets), contacts={})]


test_more_than_end_sites_still_parts_skeletons = refusals(
    (
        SkeletonMismatch,
        "'plain' and 'plain': .* these joints: foot, side",
        require_compatible,
        other((*NAMES[:3], "foot"), BONES),
    ),
    (
        SkeletonMismatch,
        "'side' sits 10 cm apart",
        require_compatible,
        other(NAMES, BONES + np.outer([0, 0, 0, 0.1], [1, 0, 0])),
    ),
)


# Positions and velocities -----------------------------------------------------------------------------------


def test_positions_are_those_of_forward_kinematics_kept_and_read_only():
    walk = sample("walk_straight")[:20]
    assert np.array_equal(walk.positions, forward_kinematics(walk).positions)
    assert walk.positions is walk.positions
    with pytest.raises(ValueError, match="read-only"):
        walk.positions[0, 0, 0] = 1.0


def test_a_changed_copy_has_positions_of_its_own():
    walk = sample("walk_straight")[:20]
    moved = replace(walk, root_positions=walk.root_positions + np.array([0, 0, 1.0]))
    assert np.allclose(moved.positions - walk.positions, [0, 0, 1.0])


def test_velocities_are_central_differences_and_one_sided_at_both_ends():
    """A point at z = t² moves at 2 t; half a frame inwards at the ends."""
    times = np.arange(6) / 10
    roots = np.stack([0 * times, 0 * times, times**2], axis=1)
    dot = Motion(Skeleton(["root"], [-1], [[0, 0, 0]]), roots, np.tile([1.0, 0, 0, 0], (6, 1, 1)), 10)
    expected = 2 * times
    expected[[0, -1]] += [0.1, -0.1]
    assert np.allclose(dot.velocities[:, 0, 2], expected)
    assert dot.velocities.shape == dot.positions.shape
    with pytest.raises(MocapError, match="at least two frames"):
        _ = dot[:1].velocities


def test_rates_that_differ_by_a_thousandth_are_one():
    walk = wave(9)
    ntsc, noisy = replace(walk, fps=29.97 * walk.fps / 30), replace(walk, fps=walk.fps * (1 + 4e-7))
    alike = require_compatible([walk, ntsc, noisy])
    assert [motion.fps for motion in alike] == [walk.fps] * 3
    refused("resample one first", require_compatible, [walk, replace(walk, fps=1.002 * walk.fps)])


def test_a_fingerprint_ignores_rounding_and_no_hundredth_of_a_millimetre():
    clip = wave(9)

    def shifted(metres):
        return replace(clip, root_positions=np.round(clip.root_positions, 5) + metres)

    assert fingerprint(shifted(1e-12)) == fingerprint(shifted(0))
    assert fingerprint(shifted(1e-5)) != fingerprint(shifted(0))
