"""Constants of paths and control that trials chose; `figures/tune/steering.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # The search along a path
    route_spacing: float = 0.02  # metres between the points of a route. At 0.2 walks change clips often
    layer: float = 0.15  # metres of path whose walks compete. 0.05 takes longer, 0.1 to 0.6 are as good
    idle_price: float = 0.1  # m² for a frame of a bent walk that hardly moves on. At 0 walks pause for long
    slowest: float = 0.3  # m/s. A bent walk behind this speed is dropped. At 0.6 slow clips are refused
    grace: float = 4.0  # seconds that a bent walk may be late at that speed. 0 to 8 find the same walks
    walking_speed: float = 0.5  # m/s. A clip whose root is faster walks, as an error tells
    creep: float = 0.05  # m/s, the least progress of a bent walk, so that searches end. At 0.3 it may stand
    clock: int = 4  # cells of time per second for walks that give way. 1 to 8 keep as far apart
    wider_views: tuple[int, int, int] = (0, 1, 2)  # times the distance ahead. With 0 some must wait

    # Repeated searches
    wide_beam: int = 400  # walks in a layer of repeated searches. 800 take longer, and are no nearer
    lower_seam_prices: tuple[float, ...] = (1 / 3, 0.0)  # factors, after walks that left the path
    seam_price_step: float = 1.25  # factor of the price of a seam from try to try. 1 to 2 find as good walks
    not_followed: float = 1.0  # metres, mean distance. Beyond it a walk is refused. At 0.1 tight bends are

    # Judging a walk
    leaves_path: float = 0.15  # metres from the path. At 0.05 the sway of the root leaves it
    mean_distance: float = 0.04  # metres from the path on average. At 0.03 a quarter of good lines fails
    seam_rate: float = 1.0  # transitions per second. At 0.7 a quarter of good walks fails
    bent_seam_rate: float = 0.7  # the same for a bent walk, which needs fewer. 0.5 to 1 accept the same walks
    reach: float = 0.5  # metres of path on either side in which the nearest point is sought. 0.25 to 3 agree

    # Walks that are bent onto a path
    overrun: float = 0.5  # metres that a search goes on beyond the end. 0 to 1 end within 3 to 5 cm of it
    overrun_fraction: float = 0.02  # of the path's length, in addition

    # Characters that are turned about their roots
    rotation_price: float = 0.3  # metres per radian, of a clip that is turned. At 0 one circle is walked on
    turned_seam: float = 3.0  # factor of the price of a seam, as no seam is needed for a turn. At 1 more jolt
    pace_price: float = 6.0  # factor of the price of a wrong pace, which is stretched. At 0 fast clips jolt

    largest_rotation: float = 1.5  # times the rate, against a clip that turns. Without a limit landings jolt
    foot_halflife: float = 0.2  # seconds, of the spring that fades the offset of a foot in the air
    heel_halflife: float = 0.1  # seconds, of the spring that lowers a heel: a step later none is lifted
    hip_halflife: float = 0.1  # seconds, of the spring that lowers the hips. At 0.2 feet slide further
    lowest_hips: float = 0.05  # metres by which hips are lowered at most. At 0 feet slide by up to 3 cm
    soft_reach: float = 0.97  # of a straight leg, up to which a leg reaches its target
    longest_reach: float = 0.999  # of a straight leg, beyond which no target stretches a leg
    steepest_foot: float = 1.31  # radians, 75°, of a foot against the ground: its heel lifts no further
    turned_ahead: float = 1.5  # seconds of the look-ahead. At 3 a step takes longer, at 1 more jolt

    # Directions
    standing_seconds: float = 0.4  # seconds that a clip must stand to be a start or an end, half a step
    starting_seconds: float = 0.5  # seconds before the end of a standing stretch in which walks start
    standing_nodes: int = 3  # frames between the nodes of a standing stretch, a tenth of a second at 30 Hz
    standing_seam: float = 0.06  # metres RMS of a seam between standing stretches, or the graph's worst
    clearances: tuple[float, float] = (0.7, 0.4)  # metres from the root to a disc. 0.4 is half a walking body
    settled_seconds: float = 0.2  # seconds of standing before a walk has arrived: the last step still sways
    arrival: float = 1.0  # metres from the end within which a standing walk has arrived. 0.6 misses stops
    starting_metres: float = 0.5  # metres in which a body that starts or stops has half its pace
    pace_percentiles: tuple[float, float] = (50.0, 90.0)  # of the speeds of walking frames: usual and fast
    overshoot: float = 1.5  # metres that a walk may go on beyond the end before it must stand
    turned_from: float = 0.52  # radians, 30°, beyond which a body is rotated at the ends of a line

    # Waypoints and crowds
    waits: tuple[float, ...] = (0.0, 1.0, 2.0, 4.0)  # seconds before a start, in this order. Most need none
    wait_step: float = 0.5  # seconds between the waits that are tried for a walk that is not searched again
    detours: int = 6  # characters who search again, which takes 1 to 3 s. The others of a larger crowd wait
    crowd_beam: int = 100  # walks in a layer, and thrice as many to give way. 30 to 200 keep as far apart
    passing: float = 0.02  # metres beyond the least distance that count as passed. At 0.2 points are missed


TUNED = Tuned()
