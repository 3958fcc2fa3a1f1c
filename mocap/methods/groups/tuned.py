"""Constants of groups that trials chose; `figures/tune/groups.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # The simulation of a flock
    settle: float = 20.0  # seconds before the first frame. At 0 the start shows, and members are nearer
    spare: float = 0.03  # metres that members keep beyond a collision. At 0 they come nearer than 60 cm
    separations: int = 3  # passes per frame that separate members. Without any, a fifth is in the walls
    wall_force: float = 3.0  # m/s² per metre too near to a wall. At 0 the group is wider than it needs to be
    wall_push: float = 0.02  # metres by which a wall moves a member back in a pass. At 0 some are in it
    free_width: float = 0.7  # fraction of a corridor's half-width in which the walls exert no force
    line_pull: float = 0.3  # radians of heading per metre from a corridor's line
    direction_time: float = 2.0  # seconds in which the direction of a whim decays. Shorter ones differ less
    pace_time: float = 4.0  # seconds in which the pace of a whim decays. Shorter ones differ less
    pace_whim: float = 0.35  # drift of the pace, as a fraction of that of the direction
    paces: tuple[float, float] = (0.6, 1.4)  # lowest and highest pace of a whim, as fractions of the group's
    rate_time: float = 3.0  # seconds in which the group's rate of turning decays
    rate_drift: float = 0.25  # rad/s per √s of the group's rate of turning
    fastest_rotation: float = 0.5  # rad/s of the group's heading. At 2 paces differ more

    # Configurations that recur
    velocity_seconds: float = 0.7  # a difference of 1 m/s counts as much as 0.7 m
    starts: tuple[float, ...] = (0.0, 0.5, -0.5)  # radians from the rotation that aligns the mean velocities
    rounds: int = 5  # of ordering and aligning, at most. One finds as near configurations
    node_interval: float = 1.0  # seconds between the frames that nodes are chosen from. Less takes time
    covered: float = 0.8  # fraction of the simulation near a node; `cluster` warns of less
    slowest: float = 0.2  # m/s. The mean velocity of a slower group has no direction

    # Clips from node to node
    corridors: tuple[float, ...] = (2.5, 2.0, 1.7)  # metres from wall to wall. They make columns
    column: float = 60.0  # seconds of simulation in each corridor
    bends: tuple[float, ...] = (-1.2, -0.6, 0.0, 0.6, 1.2)  # radians. Straight clips find few ways
    shifts: tuple[float, ...] = (-0.3, 0.0, 0.3)  # metres to the left, to the middle of a narrow passage
    seconds: float = 4.0  # of a clip. Shorter clips need higher accelerations
    pull: float = 2.0  # m/s² per metre from a member's target position. Critically damped
    hardest: float = 2.2  # m/s². A clip with a larger acceleration is dropped
    parting_rounds: int = 60  # of separation, at most. Clips that need more are dropped
    held_frames: int = 2  # at the start and at the end, which separation leaves unchanged
    ease: float = 4.0  # frames over which the weight of a push grows to 1
    parting_spare: float = 0.02  # metres beyond a collision to which members are separated
    overshoot: float = 1.5  # factor of a push, because smoothing lowers it. 1 keeps as many clips
    smoothings: int = 4  # of each push over time. Fewer leave jolts
    bend_pace: float = 1.6  # the bend of a run is complete after 1 / 1.6 of it
    pull_pace: float = 2.0  # the attraction to a goal is complete after 1 / 2 of a run

    # Plans, and steering without one
    pace: float = 1.05  # m/s, expected speed of a group. With 2 a plan expands 70 times as many states
    turning: float = 1.3  # seconds per radian, expected for the first rotation
    cell: float = 0.7  # metres. Groups in one cell and one sector are one state
    sector: float = 0.3  # radians
    states: int = 4000  # to expand. A plan that needs more is refused
    disc_force: float = 3.0  # m/s² per metre of depth
    avoidances: tuple[float, ...] = (0.8, 1.2, 1.6, 2.0)  # metres from a disc, as `Flock.avoid`
    cohesions: tuple[float, ...] = (0.0, 0.35, 1.0, 2.0)  # weights, as `Flock.gather`

    # Walkers that follow the members
    late: float = 1.0  # m² per s² of delay. 0.1 keeps the members as near
    time_every: float = 1.0  # seconds between the positions that have a time
    kept: float = 0.9  # fraction of planted frames. A warning is given of less
    narrow: int = 40  # beam width of a bent walk, which bending keeps on its path. 10 do as well
    extension: float = 3.0  # seconds by which each path is extended. At 0.5 some walks end before their plan
    least_step: float = 0.05  # metres in a second. A slower member has no direction


TUNED = Tuned()
