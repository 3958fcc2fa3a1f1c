"""How long it takes to lay a walk on a line, as a ratio to forward kinematics and to the motion's duration.

Run them alone, and see the numbers: pytest -m benchmark -n 0 -s tests/benchmarks/test_bending.py
"""

import numpy as np
import pytest
from asked_lines import heart, sine, spiral

from mocap.body.ground_path import GroundPath, circle, s_curve
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import resample
from mocap.datasets.samples import sample
from mocap.editing.bending import LIMIT, bend
from mocap.editing.path_editing import on_path, ride_of
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings
from tests.benchmarks.timing import least
from tests.bundled import walking
from tests.steering.test_bent_following import quietly, straight_walker

pytestmark = pytest.mark.benchmark

CLIPS = {"10 s at 120 Hz": sample("walk_straight"), "40 s at 30 Hz": resample(sample("walk_circle"), 30)}
CORNER = GroundPath(np.array([[0.0, 0.0], [0.0, 4.0], [4.0, 4.0]]))


@pytest.mark.parametrize("name", CLIPS)
@pytest.mark.parametrize("path", [circle(3.0), s_curve(20), CORNER], ids=["circle", "S", "corner"])
def test_a_walk_is_bent_in_36_forward_kinematics(name, path):
    """In fifty where it takes a corner: to round a line takes 10 ms, however few the frames."""
    clip = CLIPS[name]
    frames = len(bend(clip, path).motion)
    ratio = least(lambda: bend(clip, path)) / least(lambda: forward_kinematics(clip[:frames]), 20)
    print(f"\nbend, {name}: {ratio:.1f} times forward kinematics")
    assert ratio <= (50 if path is CORNER else 36)


def test_a_walk_is_put_on_a_path_in_two_forward_kinematics():
    clip, path = CLIPS["10 s at 120 Hz"], circle(3.0)
    ride = ride_of(clip)
    ratio = least(lambda: on_path(clip, path, ride)) / least(lambda: forward_kinematics(clip), 20)
    print(f"\non_path: {ratio:.1f} times forward kinematics")
    assert ratio <= 2


@pytest.mark.parametrize("line", [sine, spiral, heart])
@pytest.mark.parametrize("graph", [walking, straight_walker])
def test_any_line_with_any_walk_takes_a_sixtieth_of_its_duration(graph, line):
    compiled, path = graph(), line()
    followed = quietly(compiled, path)
    share = least(lambda: quietly(compiled, path), 5) / followed.seconds
    plain = least(lambda: follow_path(compiled, path, settings=Settings(tries=1)), 3) / followed.seconds
    print(f"\n{line.__name__}: 1/{1 / share:.0f} of the duration, at {np.degrees(LIMIT):.0f}°/s", end="")
    print(f"; one search without bending 1/{1 / plain:.0f}")
    assert share <= 1 / 60
