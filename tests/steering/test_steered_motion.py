"""A steered motion records each frame; delays are measured from the command to the frame that obeys it."""

import numpy as np
import pytest

from mocap.datasets.samples import SKELETON
from mocap.steering.characters import Pose, measure_delay, steer
from mocap.steering.graph_control import Controller
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


def test_delays_are_measured():
    delay = measure_delay(Controller(GRAPH), turns=6)
    assert 0.3 < delay.mean <= delay.slowest <= 8
    assert 0 < delay.step < delay.worst
    assert 0 < delay.waiting < delay.mean
    assert 0 < delay.blending < delay.mean - delay.waiting


class Turner:
    """It turns by one degree per frame, and walks where it looks."""

    skeleton, fps, frames_left = SKELETON, 30.0, 0

    def __init__(self):
        self.heading, self.place = 0.0, 0j

    def step(self, heading, speed, label=""):
        self.heading += np.clip(heading - self.heading, -np.radians(1), np.radians(1))
        self.place += speed / self.fps * np.exp(1j * self.heading)
        root = np.array([self.place.imag, 1.0, self.place.real])
        return Pose(root, np.tile([1.0, 0, 0, 0], (38, 1)), blending=False)


def test_a_character_of_any_kind_is_measured_and_its_delay_is_known_exactly():
    """From 30 to 120° within 20° at 30° per second, looked at over the last third of a second."""
    random = np.random.default_rng(7)
    delay = measure_delay(Turner(), turns=200, seed=7)
    turned = []
    for _ in range(200):
        random.choice([-1, 1])
        turned.append(np.degrees(random.uniform(np.pi / 6, 2 * np.pi / 3)))
    assert delay.mean == pytest.approx((np.mean(turned) - 20) / 30 + 1 / 6, abs=0.25)
    assert delay.waiting == delay.blending == 0


class Blender(Turner):
    frames_left = 5

    def step(self, heading, speed, label=""):
        return super().step(heading, speed)._replace(blending=True)


def test_blending_counts_from_the_first_choice():
    delay = measure_delay(Blender(), turns=3)
    assert delay.waiting == pytest.approx(5 / 30)
    assert delay.blending == pytest.approx(delay.mean - delay.waiting)


class Deaf(Turner):
    def step(self, heading, speed, label=""):
        return super().step(0.0, speed)


def test_a_turn_that_never_comes_counts_as_eight_seconds():
    delay = measure_delay(Deaf(), turns=1)
    assert delay.mean == 8 and delay.never == 1
    assert measure_delay(Turner(), turns=3).never == 0
