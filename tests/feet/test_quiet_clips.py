"""Feet of quiet, slow and straight-legged bodies are held, too, and no knee pops."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body import find_legs, resample
from mocap.body.kinematics import forward_kinematics
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
    check_clean_up(HERE[kind](fps), 0.995)


@pytest.mark.parametrize("name", ["walk_straight", "sneak"])
def test_a_knee_that_is_bent_backwards_keeps_its_side(name):
    clip, planted = unbent(skating(30.0, name), 12.0), 0
    cleaned = clean_up(clip)
    for leg in find_legs(clip.skeleton):
        own, now = (track_leg(m, leg, forward_kinematics(m)).own for m in (clip, cleaned))
        back = (own < -1e-4) & cleaned.contacts[clip.skeleton.names[leg.ankle]]
        assert np.all(now[back] < 1e-5)
        planted += back.sum()
    assert planted > 10
