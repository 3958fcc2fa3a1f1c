"""How long edits take, as ratios to forward kinematics on the same motion in the same run.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_editing.py
"""

import numpy as np
import pytest

from mocap.body.ground_path import s_curve
from mocap.body.kinematics import forward_kinematics
from mocap.datasets.samples import sample
from mocap.editing.edits import edit, hierarchy
from mocap.editing.path_editing import on_path, ride_of
from mocap.editing.pins import Pins, plant_pins
from mocap.editing.solver import solve
from mocap.editing.steps import Basis
from mocap.feet.footskate import clean_up
from tests.benchmarks.timing import least
from tests.editing.wishes import hand_at, stone, walk

pytestmark = pytest.mark.benchmark

# 60 ms for 4 s of motion, whose forward kinematics takes 2.7 ms.
ANSWER = 22


def ratio(work, motion, times=5):
    """Return how many forward kinematics a piece of work lasts: the least of both, taking turns."""
    return least(work, times) / least(lambda: forward_kinematics(motion), 20)


def hold(name, work, motion, most):
    found = ratio(work, motion)
    print(f"\n{name}: {found:.1f} times forward kinematics, at most {most}")
    assert found <= most


def bent_path(clip):
    return s_curve(3 * ride_of(clip).path.length)  # as sharp as a person turns


def test_an_edit():
    clip = walk()
    pins = stone(clip, 0.15)
    hold("edit", lambda: edit(clip, pins), clip, 80)


def test_a_dragged_handle_of_a_path():
    clip = walk()
    ride, path = ride_of(clip), bent_path(clip)
    hold("a handle", lambda: clean_up(on_path(clip, path, ride)), clip, ANSWER)


def test_the_first_level_of_a_dragged_hand():
    clip = walk()
    pins = hand_at(clip, (180, 240, 300))
    hold("a hand", lambda: hierarchy(clip, pins, knots=(0.5,)), clip, ANSWER)


def test_spacetime_grows_as_the_frames_do():
    ratios = []
    for name in ("walk_straight", "walk_circle"):
        clip = sample(name)
        pins = plant_pins(clip)
        up = np.array([0, 0.03, 0])
        up = Pins(pins.joints, pins.low + up, pins.high + up)
        ratios.append(ratio(lambda clip=clip, up=up: solve(clip, up, [Basis(knots=0.125)]), clip, times=3))
        print(f"\n{name}: {len(clip)} frames, {ratios[-1]:.0f} times forward kinematics")
    assert ratios[1] < 1.5 * ratios[0]
