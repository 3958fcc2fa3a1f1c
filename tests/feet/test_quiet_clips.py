"""Feet of quiet, slow and straight-legged bodies are held, too, and no knee pops."""

from dataclasses import replace

import numpy as np
import pytest

from mocap.body.motion import resample
from mocap.datasets.samples import sample
from tests.feet.quiet_clips import check_clean_up, slowed, standing, unbent

POSE = sample("stop_and_go")[100:101]
WALK = sample("walk_straight")
PUSH = np.sin(np.arange(len(WALK))[:, None] / WALK.fps * [5, 7, 3])
SKATING = replace(WALK, root_positions=WALK.root_positions + 0.006 * PUSH)
FASTER = (pytest.param(fps, marks=pytest.mark.sweep) for fps in (60.0, 120.0))
RATES = pytest.mark.parametrize("fps", [30.0, *FASTER])
HERE = {
    "stand": lambda fps: standing(POSE, fps, knee=2.5, bow=0.0, sway=0.004),
    "bow": lambda fps: standing(POSE, fps, knee=2.5, bow=40.0, sway=0.004),
    "sway": lambda fps: standing(POSE, fps, knee=1.0, bow=0.0, sway=0.01),
    "slow": lambda fps: slowed(resample(SKATING, fps), 2),
    "straight": lambda fps: unbent(resample(SKATING, fps), 0.0),
    "beyond straight": lambda fps: unbent(resample(SKATING, fps), 4.0),
}


@RATES
@pytest.mark.parametrize("kind", HERE)
def test_all_plants_of_quiet_clips_are_held(kind, fps):
    check_clean_up(HERE[kind](fps), 0.995)
