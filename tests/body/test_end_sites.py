"""Files of one laboratory that differ in end sites alone mix; where more differs they do not."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.blending import blend, mix, register
from mocap.body.motion import Motion, concatenate, require_alike
from mocap.body.skeleton import Skeleton
from mocap.errors import SkeletonMismatch
from mocap.graphs import build
from mocap.matching import find_transitions
from mocap.matching.point_clouds import rms_distance
from mocap.methods.match_webs import build_web
from tests.refusals import refusals
from tests.strategies import wave

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
    for clip, wanted in zip(require_alike(laboratory()), same_rig(), strict=True):
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
        require_alike,
        other((*NAMES[:3], "foot"), BONES),
    ),
    (
        SkeletonMismatch,
        "'side' sits 10 cm apart",
        require_alike,
        other(NAMES, BONES + np.outer([0, 0, 0, 0.1], [1, 0, 0])),
    ),
)
