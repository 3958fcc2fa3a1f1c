"""What it costs to retarget, as a multiple of forward kinematics on the same motion in the same run.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_retargeting.py
"""

import pytest

from mocap.body.kinematics import forward_kinematics
from mocap.editing.retargeting import copied, retarget
from mocap.editing.stances import stance_of
from tests.benchmarks.timing import least
from tests.editing.bodies import adult, child, walk, without

pytestmark = pytest.mark.benchmark

BODIES = {
    "a child": child(),
    "fewer joints": stance_of(
        without(walk(), "lowerback", "upperback", "lclavicle", "rclavicle", "lowerneck")
    ),
}


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("steps", [1.0, 1.4])
def test_to_retarget_takes_at_most_ninety_forward_kinematics(name, steps):
    target = BODIES[name]
    scale = steps * target.leg / adult().leg
    once = least(lambda: forward_kinematics(walk()), 20)
    ratio = least(lambda: retarget(walk(), target, adult(), scale=scale), 5) / once
    print(f"\n{name}, steps {steps:g} times as long: {ratio:.0f} forward kinematics")
    assert ratio <= 90


def test_a_copy_alone_takes_at_most_twenty():
    once = least(lambda: forward_kinematics(walk()), 20)
    ratio = least(lambda: copied(walk(), adult(), child()), 5) / once
    print(f"\na copy alone: {ratio:.0f} forward kinematics")
    assert ratio <= 20


def test_the_time_is_linear_in_the_frames():
    short, long = walk(2.5), walk(10.0)
    seconds = [least(lambda clip=clip: retarget(clip, child(), adult()), 3) for clip in (short, long)]
    print(f"\n4 times the frames: {seconds[1] / seconds[0]:.1f} times the time")
    assert seconds[1] < 6 * seconds[0]
