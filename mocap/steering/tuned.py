"""Constants of searches along a path that trials chose; `figures/tune/steering.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # The search along a path
    route_spacing: float = 0.02  # metres between the points of a route; twice as far, distances are coarser
    layer: float = 0.15  # metres of path whose walks compete; longer layers drop walks that recover later
    idle_price: float = 0.1  # m² for a frame of a bent walk that hardly moves on; lower, walks pause
    slowest: float = 0.3  # m/s; a bent walk behind this speed is dropped, as slow walks fill the beam
    grace: float = 4.0  # seconds that a bent walk may be late at that speed, as for a start from standing
    walking_speed: float = 0.5  # m/s; a clip whose root is faster walks, as an error tells
    creep: float = 0.05  # m/s, the least progress of a bent walk; without it searches may not end
    clock: int = 4  # cells of time per second for walks that give way; finer ones keep too many similar walks
    give_way: tuple[int, int, int] = (0, 1, 2)  # multiples of the distance ahead at which others are looked for

    # Repeated searches
    wide_beam: int = 400  # walks in a layer, after narrower searches left the path; wider ones are slower
    cheap_seams: tuple[float, ...] = (1 / 3, 0.0)  # of the price of seams, after walks that left the path
    seam_price_step: float = 1.25  # factor of the price of a seam from try to try; larger ones overshoot
    not_followed: float = 1.0  # metres, mean distance; a walk beyond it has lost the path, and is refused

    # Judging a walk
    leaves_path: float = 0.15  # metres from the path; the sway of the root stays below
    mean_distance: float = 0.04  # metres from the path on average, which clips with enough turns reach
    seam_rate: float = 1.0  # transitions per second; more are seen as restless
    bent_seam_rate: float = 0.7  # the same for a bent walk, which needs fewer as bending keeps it on the path
    reach: float = 0.5  # metres of path before and after a point in which its nearest point is searched

    # Walks that are bent onto a path
    overrun: float = 0.5  # metres that a search goes on beyond the end, since bending changes lengths
    overrun_fraction: float = 0.02  # of the path's length, in addition

    # Waypoints and crowds
    waits: tuple[float, ...] = (0.0, 1.0, 2.0, 4.0)  # seconds before a start, in this order; most need none
    crowd_beam: int = 100  # walks in a layer; those who give way have three times as many
    passing: float = 0.02  # metres beyond the least distance; a waypoint is passed when first so near


TUNED = Tuned()
