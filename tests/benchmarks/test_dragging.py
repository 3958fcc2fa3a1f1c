"""A dragged handle: `pytest -m benchmark -n 0 tests/benchmarks/test_dragging.py`.

The time is CPU milliseconds from the handle's new place to the new picture, the median of some drags.
"""

import time

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest

from mocap.body.motion import resample
from mocap.datasets import samples
from mocap.editing.path_editing import on_path, ride_of
from mocap.feet.footplants import standing_tracks
from mocap.feet.footskate import clean_up
from mocap.widgets.experiments import explore
from mocap.widgets.pointing import handles

pytestmark = pytest.mark.benchmark


@pytest.mark.parametrize("fps", [30, 120])
def test_four_seconds_follow_a_dragged_handle_within_sixty_milliseconds(fps):
    """As in notebook 12: bend, clean up, and draw both, four seconds of motion."""
    walk = resample(samples.sample("walk_straight"), fps)[: 4 * fps]
    ride = ride_of(walk)
    ax = plt.figure(figsize=(5.2, 6.6), layout="constrained").add_subplot(xlim=(3, -3), ylim=(-3, 7))
    (asked,), (root,), (smears,), (stood,) = (ax.plot([], [], mark) for mark in ("-", "-", "-", "o"))

    def drag(way):
        path = ride.with_handles(way)
        bent = on_path(walk, path, ride)
        clean = clean_up(bent)
        asked.set_data(*path.points.T)
        root.set_data(*clean.root_positions[:, [0, 2]].T)
        smears.set_data(*standing_tracks(bent).T)
        stood.set_data(*standing_tracks(clean).T)
        return [asked, root, smears, stood]

    experiment, took = explore(drag, alt="A path.", way=handles(ax, ride.handles)), []
    for aside in np.linspace(0.1, 1.2, 12):
        way = ride.handles + np.eye(len(ride.handles))[2][:, None] * [aside, 0]
        start = time.process_time()
        experiment.controls["way"].value = way.tolist()
        took.append(1000 * (time.process_time() - start))
    assert experiment.error is None
    assert np.median(took) < 60
