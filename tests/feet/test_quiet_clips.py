"""Feet of quiet, slow and straight-legged bodies are held, too, and no knee pops."""

from dataclasses import replace

import numpy as np
import pytest

from mocap._shared.arrays import runs
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import resample
from mocap.datasets.samples import sample
from mocap.feet.footskate import clean_up
from mocap.feet.leg_track import track_leg
from tests.feet.quiet_clips import check_clean_up, slowed, standing, unbent

POSE = sample("stop_and_go")[100:101]


def skating(fps, name="walk_straight"):
    clip = resample(sample(name), fps)
    push = np.sin(np.arange(len(clip))[:, None] / fps * [5, 7, 3])
    return replace(clip, root_positions=clip.root_positions + 0.006 * push)


FASTER = (pytest.param(fps, marks=pytest.mark.sweep) for fps in (60.0, 120.0))
RATES = pytest.mark.parametrize("fps", [30.0, *FASTER])
HERE = {
    "stand": lambda fps: standing(POSE, fps, knee=2.5, bow=0.0, sway=0.004),
    "bow": lambda fps: standing(POSE, fps, knee=2.5, bow=40.0, sway=0.004),
    "sway": lambda fps: standing(POSE, fps, knee=1.0, bow=0.0, sway=0.01),
    "slow": lambda fps: slowed(skating(fps), 2),
    "straight": lambda fps: unbent(skating(fps), 0.0),
    "beyond straight": lambda fps: unbent(skating(fps), 4.0),
    "straight jog": lambda fps: unbent(skating(fps, "jog"), 8.0),
    "straight stop": lambda fps: unbent(skating(fps, "stop_and_go"), 4.0),
    "straight sneak": lambda fps: unbent(resample(sample("sneak"), fps), 4.0),
}


@RATES
@pytest.mark.parametrize("kind", HERE)
def test_all_plants_of_quiet_clips_are_held(kind, fps):
    if (kind, fps) == ("straight stop", 120.0):
        pytest.xfail("a knee turns about within a frame: accelerations × 1.24, where 1.2 is asked")
    check_clean_up(HERE[kind](fps), 0.995)


def test_a_knee_that_is_bent_backwards_keeps_or_changes_its_side_as_a_whole():
    clip, sides = unbent(skating(30.0), 12.0), set()
    cleaned = clean_up(clip)
    for leg in find_legs(clip.skeleton):
        own, now = (track_leg(m, leg, forward_kinematics(m)).own for m in (clip, cleaned))
        planted = np.any([cleaned.contacts[clip.skeleton.names[joint]] for joint in leg[2:]], axis=0)
        for start, stop in runs(own < -1e-4):
            bent = now[start:stop][planted[start:stop]]
            there = set(np.sign(bent[np.abs(bent) > 1e-5]))
            assert len(there) <= 1
            sides |= there
    assert sides == {-1.0, 1.0}
    assert joint_positions(clean_up(cleaned)) == pytest.approx(joint_positions(cleaned), abs=1e-6)
