"""Where the feet go: each foot is planted where the pelvis passes over it later."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array
from walking.footsteps import Footplant, SmoothPath
from walking.gait import mix_rolls
from walking.gait_timing import Timing
from walking.walking_body import FPS

GRAVITY = 9.81  # m/s²
LEANING = 1.0  # metres: the height of the centre of mass, which comes to the inside of the feet
OUTWARDS = {"l": 1, "r": -1}
FIRST_STRIKE = {"l": 0.0, "r": 0.5}  # phases
WIDER = 0.02  # metres per rad/s: feet are wider apart in turns on the spot
SCATTER_ACROSS = 0.007  # metres: a foot's standard deviations from where it should be
SCATTER_AHEAD = 0.008  # metres
SCATTER_YAW = np.radians(1.5)
LEAST_VIGOUR = 0.4  # so much is a foot lifted in the shortest step


class Travel(NamedTuple):
    """The direction of the body.

    `heading` (F,) is where it faces and `bank` (F,) its lean to the left, radians; `turn_rate` (F,) is in
    rad/s to the left; `ahead` and `leftwards` (F, 3) are unit vectors.
    """

    heading: Array
    bank: Array
    turn_rate: Array
    ahead: Array
    leftwards: Array


def follow(path: SmoothPath, timing: Timing) -> Travel:
    """Face along the path and lean into its turns: tan(bank) = v · dθ/dt / g."""
    heading = gaussian_filter1d(path.heading(timing.distance), 0.12 * FPS)
    turn_rate = np.gradient(heading) * FPS
    push = np.gradient(timing.distance) * FPS * turn_rate
    bank = gaussian_filter1d(np.arctan(push / GRAVITY), 0.2 * FPS)
    level = np.zeros_like(heading)
    ahead = np.stack([np.sin(heading), level, np.cos(heading)], axis=-1)
    leftwards = np.stack([np.cos(heading), level, -np.sin(heading)], axis=-1)
    return Travel(heading, bank, turn_rate, ahead, leftwards)


def plan_footplants(
    path: SmoothPath, timing: Timing, travel: Travel, side: str, rng: np.random.Generator
) -> list[Footplant]:
    """Plan the footplants of one foot.

    A foot is planted half a step's width to the side of the path, where the pelvis is at the phase `under`
    after the strike. In a curve it is farther out: the leaning body is inside of its feet.

    Parameters
    ----------
    path, timing, travel : of the whole walk.
    side : "l" or "r".
    rng : draws the differences between steps.
    """
    first = np.floor(timing.phase[0]) - 2 + FIRST_STRIKE[side]
    strikes = np.arange(first, timing.phase[-1] + 3)
    strikes = strikes[~np.isin(strikes, timing.skipped)]
    return [
        _plan_one(path, timing, travel, OUTWARDS[side], steps, rng.standard_normal(3))
        for steps in pairwise(strikes.tolist())
    ]


def _plan_one(  # noqa: PLR0913
    path: SmoothPath,
    timing: Timing,
    travel: Travel,
    outwards: int,
    strikes: tuple[float, float],
    luck: Array,
) -> Footplant:
    """Plan a footplant between two strikes; `luck` (3,) moves it outwards, ahead, and turns it."""
    weights = timing.weights_at(strikes[0])
    rows = [(gait.under, gait.step_width, gait.toe_out) for gait in timing.gaits]
    under, width, toe_out = weights @ rows
    passing = strikes[0] + under  # phase
    heading = _at_phase(timing, travel.heading, passing)
    turn_rate = _at_phase(timing, travel.turn_rate, passing)
    lean = _at_phase(timing, travel.bank, passing)
    vigour = max(LEAST_VIGOUR, _at_phase(timing, timing.vigour, strikes[1] - 0.2))
    aside = width / 2 + WIDER * abs(turn_rate) + SCATTER_ACROSS * luck[0]
    across = outwards * aside - LEANING * np.tan(lean)
    along = _at_phase(timing, timing.distance, passing) + SCATTER_AHEAD * luck[1] * min(1.0, vigour)
    leftwards = np.array([np.cos(heading), -np.sin(heading)])
    position = path.point(np.array(along)) + across * leftwards
    yaw = heading + outwards * np.radians(toe_out) + SCATTER_YAW * luck[2]
    roll = mix_rolls([gait.roll for gait in timing.gaits], weights)
    return Footplant(strikes[0], strikes[1], position, yaw, vigour, roll, weights)


def _at_phase(timing: Timing, values: Array, phase: float) -> float:
    """Interpolate values (F,) at a phase; beyond the planned frames they go on as at the ends."""
    if timing.phase[0] <= phase <= timing.phase[-1]:
        return float(np.interp(phase, timing.phase, values))
    end = 0 if phase < timing.phase[0] else -1
    pace = max(np.gradient(timing.phase)[end], 1e-9)
    slope = np.gradient(values)[end] / pace
    return float(values[end] + slope * (phase - timing.phase[end]))
