"""How long joining, blending and cleaning take, as shares of the time that the motion itself lasts.

Run them alone, and see the shares: pytest -m benchmark -n 0 -s tests/benchmarks/test_feet.py
"""

from dataclasses import replace

import numpy as np
import pytest
from walking import generate_walk

from mocap.blending.joining import blend, inertialize, join
from mocap.datasets.samples import sample
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from tests.benchmarks.timing import least

pytestmark = pytest.mark.benchmark

CLIP = sample("walk_circle")
MINUTE = generate_walk([[0, 0], [0, 55]], speed=0.85)[: 60 * 120]  # 60 s at 120 Hz
PUSH = 0.01 * np.sin(np.arange(len(MINUTE)) / 40)[:, None]
SKATING = replace(MINUTE, root_positions=MINUTE.root_positions + PUSH)

WORK = {
    "join": lambda: join(CLIP, 3600, CLIP, 1000, 40),
    "inertialize": lambda: inertialize(CLIP, 3600, CLIP, 1000, 40),
    "blend": lambda: blend(MINUTE, SKATING, np.linspace(1, 0, len(MINUTE))),
    "mark_plants": lambda: mark_plants(SKATING),
    "clean_up": lambda: clean_up(SKATING),
}


@pytest.mark.parametrize("name", WORK)
def test_a_minute_of_motion_takes_under_a_tenth_of_its_duration(name):
    share = least(WORK[name], 3) / 60
    print(f"\n{name}: {100 * share:.2f} % of the motion's duration")
    assert share < 0.1
