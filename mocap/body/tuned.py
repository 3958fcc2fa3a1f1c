"""Constants of bodies and paths that trials chose; `figures/tune/body.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    path_spacing: float = 0.02  # metres between the points of a curve. A circle of 1 m is then 0.05 mm off
    # The largest ratio of a hinge's second singular value to its first. The knees of six sources have 0.008
    # at most. Those of puppy, which are no hinges, 0.45.
    hinge: float = 0.05  # times the first singular value
    still: float = 0.01  # radians (RMS). A joint that rotates less does not show its axis


TUNED = Tuned()
