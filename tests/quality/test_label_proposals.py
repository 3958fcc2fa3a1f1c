"""Proposed labels are those that the bundled clips are known to have."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import resample
from mocap.datasets import sample
from mocap.editing import mirror
from mocap.files.label_tables import label_clips
from mocap.quality import propose_labels
from tests.strategies import wave


def proposed(clip):
    bare = replace(clip, labels={})
    return label_clips([bare], propose_labels(bare))[0].labels


@pytest.mark.parametrize(
    ("name", "true", "found"), [("stop_and_go", "stand", "stand"), ("jog", "jog", "run")]
)
def test_nine_of_ten_frames_in_which_a_body_stands_or_runs_are_found(name, true, found):
    clip = resample(sample(name), 30)
    assert proposed(clip)[found][clip.labels[true]].mean() > 0.9


def test_turns_change_sides_in_the_mirror_and_paces_do_not():
    clip = resample(sample("walk_curve_1"), 30)
    left, right = proposed(clip), proposed(mirror(clip))
    assert (left["turn left"] == right["turn right"]).mean() > 0.99
    assert (left["walk"] == right["walk"]).all() and left["turn left"].any()


def test_a_straight_walk_turns_nowhere_and_every_frame_has_one_pace():
    labels = proposed(resample(sample("walk_straight"), 30))
    assert set(labels) == {"walk"} and labels["walk"].all()
    of_jog = proposed(resample(sample("jog"), 30))
    assert (sum(of_jog[name].astype(int) for name in ("walk", "run")) == 1).all()


def test_a_small_body_has_the_labels_of_a_large_one():
    clip = resample(sample("jog"), 30)
    half = replace(clip.skeleton, offsets=0.5 * clip.skeleton.offsets)
    # Time runs faster by √2 for a body of half the size, which a higher frame rate expresses.
    small = replace(clip, skeleton=half, root_positions=0.5 * clip.root_positions, fps=30 * np.sqrt(2))
    assert (proposed(small)["run"] == proposed(clip)["run"]).mean() > 0.97


def test_labels_that_a_clip_has_are_kept():
    clip = replace(wave(60, name="a"), labels={"mine": np.arange(60) < 20})
    assert [row.label for row in propose_labels(clip)] == ["mine"]
