"""Constants that trials chose; `figures/tune/parametric_graphs.py` runs the trials again."""

from __future__ import annotations

import math

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Strides in clips
    step_seconds: tuple[float, float] = (0.23, 1.0)  # from strike to strike. Others are no walk or run
    calm: float = math.radians(15)  # from the median turn. Steps that turn by less count as straight ahead
    straight: float = math.radians(20)  # a straight stride turns by less
    straight_speed: float = 0.3  # m/s. A straight stride is faster
    margin: float = 0.38  # fraction of an action, before and after it. Transitions are centred near its ends

    # Spaces of strides
    samples: int = 120  # number of samples of a space

    # Changes between strides
    change_from: float = 0.2  # phase at which a change begins
    change_to: float = 0.8  # phase at which a change ends
    step_phases: tuple[float, float] = (0.05, 0.95)  # phases between which feet step. Seams blend the others
    strike_phases: int = 2  # phases of the grid by which a swing may end after a strike
    rotation_beyond: float = math.radians(5)  # a turn may be this far outside those of the other kind
    change_examples: int = 60  # number of examples of a change, at most

    # Transitions between made motions
    span: int = 3  # frames before and after an end at which a transition may be centred
    neighbours: int = 4  # sources beyond the number of parameters: with one, as in [HG07, 4], boxes jump
    bad: float = 1.35  # T_BAD over T_GOOD: with 2 no bad target cuts a box
    sampling: tuple[int, int] = (50, 1000)  # number of sources and of targets of an edge
    distance_from_bad: float = 0.005  # fraction of half a range: the distance of a box from bad targets

    # Graphs fitted to clips
    good: float = 0.04  # metres, T_GOOD where the examples allow it
    worst: float = 1.5  # times `good`: the largest T_GOOD of slow motions
    pose_change: float = 1 / 15  # seconds. T_GOOD may be as large as a pose changes in them
    beyond_worst: float = 1.25  # times the largest T_GOOD, if that keeps more of a range
    largest_rotation: float = math.radians(75)  # of a stride, to either side
    step_fraction: float = 0.55  # a step turns by a little more than half of what a stride does
    rotation_width: float = math.radians(14)  # of the Gaussian in the turn of a stride
    speed_width: float = 0.1  # m/s, of the Gaussian in the speed
    rotations_from: float = 1.5  # widths. Examples that vary less in their turns do not turn
    speeds_from: float = 1.5  # widths. Examples that vary less in their speeds have one speed
    most_range: float = 2 / 3  # of a range: if less is left, a somewhat larger T_GOOD is tried
    least_range: float = 0.25  # of a range must be left
    reported_loss: float = 0.1  # of a range may be lost without a warning
    fitting: tuple[int, int] = (50, 200)  # number of sources and of targets that narrow the ranges

    # A position that is asked for
    position_rounds: int = 8  # iterations at most: where a motion starts depends on its parameters
    settled: float = 0.002  # metres: a smaller change of the parameters ends the iterations


TUNED = Tuned()
