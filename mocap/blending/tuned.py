"""Constants of blends that trials chose; `figures/tune/blending.py` runs the trials again."""

from __future__ import annotations

import math

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Clocks
    shortest_footplant: float = 0.02  # seconds of the common clock. Shorter parts are dropped
    clock_step: float = 0.002  # seconds of the common clock between the points at which its speed is computed

    # Registration
    rate: float = 30.0  # frames per second that are compared, or the nearest that takes each n-th frame
    window: int = 5  # frames, at this rate. Shorter ones make the pace wobble, longer ones blur the distances
    # Half the width of the band in which the path is searched first. Clips up to this are searched as a whole
    band: float = 10.0  # seconds
    band_margin: float = 2.0  # seconds from the edge of the band at which the band is widened
    spacing: float = 0.3  # seconds between the knots of the curves. At 0.1 the pace wobbles far more
    many_knots: int = 200  # knot intervals up to which a fit is dense. Denser fits are slower beyond
    # Wider spacings are tried first, and the first is taken whose mean distance is as good as that of
    # `spacing`, with which the pace of two even walks wobbles by a fifth. Clips that are cut alike take
    # `spacing`: a straight line through nine punches makes blends miss their targets by 8 mm, where these
    # knots miss by 5.
    wider_spacings: tuple[float, ...] = (math.inf, 8.0, 4.0, 2.0)  # times `spacing`. First a straight line
    as_good: float = 1.06  # times the mean distance with `spacing`. At 1 the pace wobbles four times as much

    # A mean RMS distance along the path above both of these is reported. Walks have 3 to 8 cm. Runs of one
    # kind 4 to 18 cm, which the roots go in 0.01 to 0.06 s. A walk and a run 24 cm, in 0.1 s.
    unlike: float = 0.12  # metres. At 0.08 some walks of one person are, at 0.24 some walks and runs are not
    unlike_time: float = 0.06  # seconds, times the speed of the roots. At 0.12 half of walks and runs pass
    # A foot sliding speed of the even blend above both of these is reported. For walks of one person it is
    # 0.7 to 1.2 times that of the clips.
    sliding_ratio: float = 1.4  # times that of the clips
    sliding_difference: float = 0.01  # m/s above that of the clips


TUNED = Tuned()
