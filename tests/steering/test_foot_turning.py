"""A character turns about the foot that stands, sooner than its clips turn, and its feet slide no more."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mocap
from mocap import graphs
from mocap._shared.arrays import runs
from mocap.body import PlanarTransform, joint_positions, on_ground
from mocap.feet.footplants import mark_plants
from mocap.steering import Controller, FootTurner, measure_delay, steer
from tests.blending.registered import feet, foot_sliding_speed
from tests.bundled import bundled
from tests.refusals import refusals

BUNDLED = graphs.compile_graph(bundled("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight"))
RATE = np.radians(40)


def zigzag(turns, hold=1.3, seed=0):
    """Give a heading per frame that turns by 30 to 120° again and again."""
    random = np.random.default_rng(seed)
    turned = random.choice([-1, 1], turns) * random.uniform(np.pi / 6, 2 * np.pi / 3, turns)
    return np.repeat(np.cumsum(turned), round(hold * 30))


class Noted:
    """A controller that notes how it was turned, so that a test can undo it."""

    def __init__(self, graph):
        self.character, self.turn, self.move, self.places = Controller(graph), 1 + 0j, 0j, []
        self.skeleton, self.fps, self.feet = graph.source.clips[0].skeleton, graph.fps, self.character.feet

    frames_left = property(lambda self: self.character.frames_left)

    def step(self, *command):
        self.places.append((self.turn, self.move))
        return self.character.step(*command)

    def turn_about(self, point, angle):
        more = np.exp(1j * angle)
        self.turn, self.move = more * self.turn, more * (self.move - point) + point
        self.character.turn_about(point, angle)


def turned_and_not(graph, headings, rate=RATE):
    """Give a steered motion, the same without what was turned, and the angle that it was turned by."""
    noted = Noted(graph)
    motion = steer(FootTurner(noted, rate), headings).motion
    turns, moves = np.array(noted.places).T
    straight = PlanarTransform.from_complex(turns, moves).inverse().apply_motion(motion)
    return motion, straight, np.unwrap(np.angle(turns))


def pivots(straight, angle):
    """Give by how much each stance was turned, radians; the stances are those of the unturned motion."""
    marks = mark_plants(straight).contacts
    return np.array([abs(angle[b - 1] - angle[a]) for name in marks for a, b in runs(marks[name])])


def test_it_obeys_sooner_than_its_clips_turn_and_feet_slide_and_pivot_no_more():
    """The bars are 1.25 and 2.0 s; the controller alone takes 1.6 and 2.2 s."""
    alone, turned = (measure_delay(make(Controller(BUNDLED))) for make in (lambda it: it, FootTurner))
    assert turned.mean <= 1.25
    assert turned.slowest <= 2.0
    assert turned.mean < 0.85 * alone.mean
    motion, straight, angle = turned_and_not(BUNDLED, zigzag(40))
    assert foot_sliding_speed(motion) <= 1.05 * foot_sliding_speed(straight)
    assert np.degrees(pivots(straight, angle).max()) <= 25
    assert np.ptp(angle) > np.pi / 2  # and it was turned a good deal


def hard(motion):
    """Give the 99th percentile of the root's accelerations."""
    return np.percentile(np.linalg.norm(np.diff(motion.root_positions, 2, axis=0), axis=1), 99)


def test_the_root_does_not_jolt_where_the_pivot_goes_from_foot_to_foot():
    """There the root turned about a foot behind it, and turns about one ahead: at once, by more than 2.4."""
    motion, straight, _ = turned_and_not(BUNDLED, zigzag(30))
    assert hard(motion) < 2 * hard(straight)


def test_a_straight_walk_wags_no_more_than_the_clips():
    """After turns by some angles; the pelvis sways, and a late answer would turn the figure to and fro."""

    def wag(make):
        found = []
        for before in (0.0, 2.0, 3.0):
            motion = steer(make(), np.repeat([before, 0.0], [60, 400])).motion
            track = on_ground(motion.root_positions)
            found.append(np.std(np.unwrap(np.angle(track[210:] - track[200:-10]))))
        return np.mean(found)

    turned = wag(lambda: FootTurner(Controller(BUNDLED)))
    assert turned < 1.25 * wag(lambda: Controller(BUNDLED))


@settings(max_examples=8)
@given(rate=st.floats(0.05, 3), seed=st.integers(0, 99))
def test_it_turns_no_faster_than_asked_about_a_point_that_stays(rate, seed):
    noted = Noted(BUNDLED)
    turner = FootTurner(noted, rate)
    for heading in zigzag(3, seed=seed)[:60]:
        before = noted.turn, noted.move
        pivot = turner.pivot
        turner.step(heading, 1.1)
        more = noted.turn / before[0]
        assert abs(np.angle(more)) <= rate / 30 + 1e-12
        assert more * (before[1] - pivot) + pivot == pytest.approx(noted.move, abs=1e-9)


def test_one_who_stands_is_not_turned():
    noted = Noted(graphs.compile_graph(bundled("stop_and_go")))
    steer(FootTurner(noted), np.full(240, np.pi / 2), speed=0.0)
    turns = np.unwrap(np.angle([turn for turn, _ in noted.places]))
    assert np.abs(np.diff(turns[-60:])).max() < np.radians(40) / 30 + 1e-12


test_nonsense_is_refused = refusals(
    *(("finite rate from 0 on", FootTurner, Controller(BUNDLED), rate) for rate in (-0.1, np.nan, np.inf))
)


def test_a_controller_knows_where_its_feet_are():
    controller, off = Controller(BUNDLED), []
    for frame in range(120):
        pose = controller.step(0.02 * frame, 1.1)
        skeleton, roots = controller.skeleton, pose.root_position[None]
        one = mocap.Motion(skeleton, roots, pose.rotations[None], controller.fps)
        off.append(np.abs(controller.feet() - on_ground(joint_positions(one)[:, feet(one)])[0]).max())
        if not pose.blending:
            assert off[-1] < 1e-9
        controller.turn_about(controller.feet()[0], 0.01)
    assert max(off) < 0.02  # in transitions
