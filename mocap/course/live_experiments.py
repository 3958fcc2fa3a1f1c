"""Small experiments that run on the pages of the course without Python: their controls, data, and numbers.

`live.js` computes the same numbers, and draws them.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.course import live_bodies as bodies
from mocap.course import live_walks as walks

Control = tuple[float, float, float, float]
"""Of a slider: the lowest value, the highest, the step, and the initial value."""


class LiveExperiment(NamedTuple):
    """Controls (lowest, highest, step, initial value), a function of their values, and data for the page."""

    controls: dict[str, Control]
    compute: Callable[..., dict[str, Any]]
    data: Callable[[], dict[str, Any]]


TIP = (0, 175, 5, 60)  # degrees, as all angles of controls
TOWARDS = (-180, 180, 15, 90)
FACING = (-180, 180, 10, -20)
QUARTER = (-90, 90, 5, 40)
OTHER_QUARTER = (-90, 90, 5, -40)
FRACTION = (0, 1, 0.05, 0.25)
AHEAD = (-0.5, 0.7, 0.05, 0.2)  # metres
HEIGHT = (0, 0.5, 0.05, 0.25)  # metres
STEPS_OF_TARJAN = (0, 21, 1, 9)
STEPS_OF_SEARCH = (0, 21, 1, 18)
JOINT = (0, 37, 1, 24)
SAME_ANGLE = (0, 60, 1, 40)
TURN = (-180, 180, 3, 60)
MOMENT = (0, 8, 1, 8)
LEANING: dict[str, Control] = {"tip": TIP, "towards": TOWARDS, "facing": FACING}
RINGS: dict[str, Control] = {"z": QUARTER, "x": QUARTER, "y": OTHER_QUARTER}
REACHING: dict[str, Control] = {"ahead": AHEAD, "height": HEIGHT}
LIVE: dict[str, LiveExperiment] = {}
"""The experiments, by the notebook and the name of the experiment in it."""
LIVE["01-skeletons-and-clips:placed"] = LiveExperiment({"joint": JOINT}, bodies.placed, bodies.pose_data)
LIVE["01b-motion-files:wrong_order"] = LiveExperiment(
    {"angle": SAME_ANGLE}, bodies.wrong_order, bodies.orders_data
)
LIVE["02-matching:turn"] = LiveExperiment({"degrees": TURN}, bodies.turn, bodies.turn_data)
LIVE["03b-angles:lean"] = LiveExperiment(LEANING, bodies.lean, bodies.body_data)
LIVE["03b-angles:gimbals"] = LiveExperiment(RINGS, bodies.gimbals, bodies.body_data)
LIVE["04-blending:ways"] = LiveExperiment({"fraction": FRACTION}, bodies.interpolations, bodies.ways_data)
LIVE["04b-feet:leg"] = LiveExperiment(REACHING, bodies.leg, bodies.leg_data)
LIVE["06-pruning:tarjan"] = LiveExperiment({"step": STEPS_OF_TARJAN}, walks.tarjan, walks.tarjan_data)
LIVE["07-walks-and-search:eight_nodes"] = LiveExperiment(
    {"step": STEPS_OF_SEARCH}, walks.eight_nodes, walks.search_data
)
LIVE["08c-judging-a-search:distances"] = LiveExperiment(
    {"step": MOMENT}, walks.distances, walks.distances_data
)


def numbers_of(computed: dict[str, Any]) -> Array:
    """Return all numbers that an experiment computed, in the order of its entries.

    Examples
    --------
    >>> len(numbers_of(bodies.leg(ahead=0.2, height=0.25)))
    5
    """
    values = [value for value in computed.values() if not isinstance(value, str)]
    return np.concatenate([np.ravel(np.asarray(value, float)) for value in values])
