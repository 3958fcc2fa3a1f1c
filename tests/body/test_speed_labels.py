"""Labels from speed: means over a stride, at the ends over what is there."""

import numpy as np
import pytest

from mocap.body import label_by_speed, velocities
from mocap.datasets.samples import sample

CLIP = sample("stop_and_go")


@pytest.mark.parametrize("span", [1, 3, 131, 10_001])
def test_every_frame_is_labelled_by_the_mean_of_those_around_and_other_labels_stay(span):
    speeds = np.linalg.norm(velocities(CLIP.root_positions, CLIP.fps)[:, [0, 2]], axis=-1)
    means = np.array([speeds[max(0, f - span // 2) : f + span // 2 + 1].mean() for f in range(len(speeds))])
    above = float(np.median(means)) - 1e-6
    labelled = label_by_speed(CLIP, above=above, span=span, names=("still", "going"))
    assert np.array_equal(labelled.labels["going"], means > above)
    assert np.array_equal(labelled.labels["still"], ~labelled.labels["going"])
    assert set(CLIP.labels) < set(labelled.labels)
    assert label_by_speed(CLIP, above=above, span=span).labels["run"].any()
