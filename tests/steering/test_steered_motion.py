"""A steered motion records what its character does in each frame."""

import numpy as np
import pytest

from mocap.errors import MocapError
from mocap.steering.graph_control import Controller
from mocap.steering.steered_motion import steer
from tests.bundled import walking

GRAPH = walking()


def test_the_parts_of_a_delay_are_those_of_the_frames():
    """All of it waits, blends or plays a clip; the recorded frames say which."""
    heading, frame = 1.5, 90
    steered = steer(Controller(GRAPH), np.where(np.arange(240) < frame, 0.0, heading))
    waiting, blending, clip = np.round(30 * steered.delay(heading, frame)).astype(int)
    assert waiting == steered.frames_left[frame]
    took = waiting + blending + clip
    assert blending == steered.blending[frame + waiting : frame + took].sum()
    x, _, z = steered.motion.root_positions.T
    ways = np.arctan2(x[10:] - x[:-10], z[10:] - z[:-10])  # of the third of a second up to frames 10, 11, ...
    off = np.abs((ways[frame - 10 :] - heading + np.pi) % (2 * np.pi) - np.pi)
    assert (off[: took - 1] >= np.pi / 9).all()
    assert off[took - 1] < np.pi / 9
    assert np.isnan(steered.delay(heading + np.pi, 200)).all()
    assert (np.diff(steered.frames_left) <= 0).sum() > 200  # they count down between two choices


def test_no_headings_are_refused():
    with pytest.raises(MocapError, match="one heading per frame, got none"):
        steer(Controller(GRAPH), [])
