"""A character does what it is told, smoothly and in time: measured from the command to obeying it."""

import numpy as np
import pytest

from mocap.body.motion import Motion
from mocap.errors import NoWalk
from mocap.graphs.motion_graph import from_transitions
from mocap.steering import Controller, measure_delay, steer
from mocap.synthesis.walk_to_motion import to_motion
from tests.bundled import sneaking, walking
from tests.refusals import refusals
from tests.strategies import wave
from tests.widgets.steerable import Dot

GRAPH = walking()


def played(controller, frames, *command):
    poses = [controller.step(*command) for _ in range(frames)]
    roots, turns = np.array([p.root_position for p in poses]), np.array([p.rotations for p in poses])
    return Motion(GRAPH.source.clips[0].skeleton, roots, turns, 30.0)


def test_its_poses_are_those_of_the_walk_it_takes():
    controller, walk = Controller(GRAPH), []
    poses = []
    for frame in range(300):
        poses.append(controller.step(0.01 * frame, 1.0))
        if controller.frame == 1:  # a new edge was entered
            walk.append(GRAPH.edges[controller.edges[0]])
    motion = to_motion(GRAPH.source, walk)
    roots = np.array([pose.root_position for pose in poses])
    turns = np.array([pose.rotations for pose in poses])
    assert roots == pytest.approx(motion.root_positions[:300], abs=1e-9)
    assert np.abs((turns * motion.rotations[:300]).sum(-1)) == pytest.approx(np.ones(turns.shape[:2]))


def test_poses_are_those_of_a_recorded_run():
    """The root after each 100 frames, and the blended frames among them, as first recorded."""
    controller = Controller(sneaking())
    recorded = [
        ((0.0, ""), [0.5511758567258046, 0.9971100254915655, 3.6637202266798052], 30),
        ((1.0, "sneak"), [0.9256894188071083, 0.9398088222369552, 6.102390113370244], 30),
        ((-1.0, "walk"), [1.0249293403394997, 1.0043424576371909, 8.115086102290396], 34),
    ]
    for (heading, label), root, blended in recorded:
        poses = [controller.step(heading, 1.0, label) for _ in range(100)]
        # Room for other arithmetic.
        assert poses[-1].root_position == pytest.approx(root, abs=1e-7)
        assert sum(pose.blending for pose in poses) == blended


def test_it_goes_where_it_is_sent():
    """As in [KGP02, 5.3]."""
    controller = Controller(GRAPH)
    for heading in (0.0, 1.0, 2.0):
        played(controller, 120, heading, 1.0)
        way = np.diff(played(controller, 60, heading, 1.0).root_positions[[0, -1]], axis=0)[0]
        assert np.arctan2(way[0], way[2]) == pytest.approx(heading, abs=0.5)


def to_the_end():
    line = Controller(from_transitions([wave(40)], [], window=5), start=(0, 0))
    for _ in range(41):
        line.step(0.0, 1.0)


test_nonsense_is_refused = refusals(
    *(
        ("finite heading and a speed from 0 on", Controller(GRAPH).step, *command)
        for command in ((np.nan, 1.0), (0.0, np.inf), (0.0, -1.0))
    ),
    (NoWalk, "the label 'fly'; there are: walk", Controller(GRAPH).step, 0.0, 1.0, "fly"),
    (NoWalk, "no node", lambda: Controller(GRAPH, start=(0, 77777))),
    (NoWalk, r"ends at node \(0, 40\)", to_the_end),
)


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
    # They count down between two choices. Room for other choices under other arithmetic: here 201 of 239.
    assert (np.diff(steered.frames_left) <= 0).sum() > 170


def test_delays_are_measured():
    delay = measure_delay(Controller(GRAPH), turns=6)
    assert 0.3 < delay.mean <= delay.slowest <= 8
    assert 0 < delay.step < delay.worst
    assert 0 < delay.waiting < delay.mean
    assert 0 < delay.blending < delay.mean - delay.waiting


class Turner(Dot):
    """It turns by one degree per frame, and walks where it looks; all its frames are blends, or none is."""

    blends = False

    def __init__(self):
        super().__init__(np.radians(30))

    def step(self, *command):
        return super().step(*command)._replace(blending=self.blends)


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
    frames_left, blends = 5, True


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
