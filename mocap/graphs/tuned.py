"""Constants of graphs that trials chose; `figures/tune/graphs.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    longest_macro_edge: float = 1 / 6  # seconds of clip after which one ends. A third or thrice is slower
    largest_component: float = 0.9  # of the most frames at any threshold. More takes a larger threshold
    ahead: tuple[float, ...] = (0.25, 0.5, 0.75)  # seconds. A third or twice of it lets walks stray farther
    least_speed: float = 0.3  # m/s. Standing counts as this, lest a walk stands for ever. Γ in [KGP02, 5.1]
    velocity_time: float = 1 / 6  # seconds before a clip's end, whose velocity continues. 1/30 does as well
    standing: float = 0.1  # metres within the last time of `ahead` that have a direction. At 0.3 walks stray


TUNED = Tuned()
