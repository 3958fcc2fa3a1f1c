"""Labels from speed: means over a stride, at the ends over what is there."""

import numpy as np
import pytest

from mocap.body import label_by_speed, smooth_speed, velocities
from mocap.datasets.samples import sample

CLIP = sample("stop_and_go")


def plain_mean(speeds, span):
    half = span // 2
    return [speeds[max(0, f - half) : f + half + 1].mean() for f in range(len(speeds))]


@pytest.mark.parametrize("span", [1, 3, 131, 10_001])
def test_it_is_the_mean_over_the_frames_around(span):
    speeds = np.linalg.norm(velocities(CLIP.root_positions, CLIP.fps)[:, [0, 2]], axis=-1)
    assert smooth_speed(CLIP, span=span) == pytest.approx(plain_mean(speeds, span))


def test_every_frame_has_one_of_the_two_labels_and_others_stay():
    labelled = label_by_speed(CLIP, above=0.5, span=31, names=("still", "going"))
    assert np.array_equal(labelled.labels["going"], smooth_speed(CLIP, span=31) > 0.5)
    assert np.array_equal(labelled.labels["still"], ~labelled.labels["going"])
    assert 0.1 < labelled.labels["going"].mean() < 0.9
    assert set(CLIP.labels) < set(labelled.labels)


def test_it_labels_by_the_mean_of_the_frames_around():
    speeds = np.linalg.norm(velocities(CLIP.root_positions, CLIP.fps)[:, [0, 2]], axis=-1)
    wanted = np.array(plain_mean(speeds, 31)) > 0.5
    assert np.array_equal(label_by_speed(CLIP, above=0.5, span=31).labels["run"], wanted)
