"""Constants of editing that trials chose; `figures/tune/editing.py` runs the trials again."""

from __future__ import annotations

import math

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # ---- Constraints, the solver, edits, poses, levels and toes ----

    # Costs of a change
    arm: float = 0.3  # metres: the position error that counts as much as a rotation error of a radian
    effort: float = 1.0  # m²/rad² of a rotation beside what it moves. With 0.02 an ankle bends by 84°
    # Factors on the costs of root and trunk, and of the neck. Captured people whose feet stand, and who move
    # a hand by 30 cm and more (92 times in eight clips), tip the trunk by 7° to positions within 0.9 of an
    # arm's length, and by 23° to those beyond. With 16 and 32 it tips by 4° and 15°, with 1 by 13° and 23°.
    trunk: float = 16.0  # times. With a root as cheap as 1, a straight knee jumps on a stone by × 1.3
    neck: float = 32.0  # times. Under 16 bars it bends by 31° more than in the clip, with 16 by 40°
    pose_trunk: float = 16.0  # times, in a single pose. With 1 the trunk leans by 30° for a hand 30 cm away
    pose_neck: float = 16.0  # times, in a single pose
    level_trunk: float = 4.0  # times, in levels, where few iterations get no further with more
    level_neck: float = 8.0  # times, in levels. With 1 necks bend by 46° under bars, with 8 by 34°

    # The first stage of an edit: splines. Around stones of 10 to 50 cm on eleven walks the median growth of
    # accelerations is 3 %, the largest 12 %; without `lead` 6 and 22 %.
    knots: float = 0.125  # seconds between knots. 0.5 leaves centimetres, below 0.125 accelerations grow
    decay: float = 0.25  # seconds in which a change decays beyond a constraint
    weight: float = 100.0  # of a metre off a constraint. Later stages close what this leaves
    lead: float = 0.25  # seconds, over which joints are led to the first of their constraints

    # The last stages of edits and retargeting: each frame has its own numbers, and constraints are met
    close_decay: float = 0.06  # seconds in which a change decays beyond a constraint
    close_weight: float = 1e6  # of a metre. Constraints are met to 1e-9 m in few iterations
    close_damping: float = 0.1  # λ at first, times the costs

    # Inverse kinematics of single frames
    reach_weight: float = 100.0  # of a metre, in `REACH`
    reach_damping: float = 1e-3  # λ at first, times the costs, in `REACH`
    reach_passes: int = 16  # iterations at most, in `REACH`
    pose_weight: float = 3000.0  # of a metre: a dragged joint is 0.01 mm off, after about 7 iterations
    pose_damping: float = 1e-3  # λ at first, times the costs
    pose_passes: int = 60  # iterations at most. Poses near the end of a reach take many
    level_passes: int = 4  # iterations in each level. What these leave, the next level takes up

    # Steps of Levenberg and Marquardt
    gain: float = 3e-5  # fraction of the cost: an iteration that gains less is the last one
    loss: float = 3e-7  # fraction of the cost: an iteration that loses less is the last one
    fall: float = 3.0  # λ is divided by this after a step that lowers the cost
    rise: float = 10.0  # λ is multiplied by this after a step that does not
    leap: float = 0.3  # radians: no joint rotates further in a step. Else 46 of 216 elbows fold backwards
    bar_damping: float = 1000.0  # λ at first under a bar, so that the body bows. Else necks bend further

    # What an edit changes
    margin: float = 1.0  # seconds: frames farther from a constraint stay as they are
    sunk: float = 0.003  # metres. Joints of cleaned motions that are lower by less stay as they are

    # Toes that bend to keep their tips above the floor
    toe_ease: float = 0.05  # seconds over which a bend begins and ends. With 0 toes bend with a jolt
    toe_bend: float = math.radians(80.0)  # radians: toes bend no further
    toe_level: float = 0.5  # radians: toes within this angle of the floor show where their lateral axis is

    # ---- Paths, bending, keys, mirroring, cycles, stances and retargeting ----

    # Paths of motions, and the frames that move along them
    path_knots: float = 1.0  # seconds. With 1.6 turns are 17 cm off, not 8; with 0.4 headings wag by 3°
    chord: float = 0.25  # metres on each side. Bodies turn by 300°/s at corners, with 0.02 by 3300°/s
    chord_blur: float = 0.6  # of `chord`, of a Gaussian over positions. 0.4 to 0.9 are as good
    shortest_path: float = 0.5  # metres. With 0.1 a body that stands has a path; 1.0 refuses walks

    # Walks in bends: their pace and lean are those of captured turns
    bend_radius: float = 1.2  # metres, R of the law of pace: 8 % off captured turns, as 0.9, with 2 9 %
    bend_blur: float = 0.2  # metres, of a Gaussian over curvatures. With 0.4 corners are cut by 9 cm, not 6
    speed_blur: float = 0.3  # seconds, of a Gaussian over speeds. 0.1 to 0.6 are as good
    standing_speed: float = 0.2  # m/s: slower bodies stand, and their paths curl. 0.1 to 0.4 are as good
    walking_speed: float = 0.5  # m/s, from which on the pace is that of the law. 0.3 to 0.9 are as good
    corner_ratio: float = 0.45  # of the law's pace, at the slowest. With 0.6 corners are cut by 10 cm, not 6
    corner_speed: float = 0.3  # m/s, at the slowest. With 0.6 corners are cut by 27 cm, not 6
    rate_margin: float = 0.95  # of the limit, for slowing down. With 1 corners are cut by 7.4 cm, not 6
    lowest_ratio: float = 0.3  # of the speeds on the line and on the walk's path. 0.7 cuts by 10 cm, not 6
    highest_ratio: float = 1.25  # of the same. A straightened turn speeds up; with 1 it does not
    pelvis_lean: float = 0.5  # of the lean of the legs; 0.33 is the median of 22 captured turns
    trunk_lean: float = 0.25  # of the lean of the legs; 0.27 is the median of the same turns
    turning_limit: float = math.radians(100.0)  # radians per second. Captured people reach 90° to 110°

    # Lines that are rounded where a walk would turn too fast
    line_spacing: float = 0.05  # metres between points
    line_reach: float = 0.1  # metres, of smoothing everywhere. With 0.2 a corner is cut by 18 cm, not 16
    reach_growth: float = 1.15  # times. With 1.4 a corner is cut by 19 cm, not 16; 1.05 takes longer
    reach_slope: float = 0.6  # of reach per distance. With 0 and 0.1 corners are cut by 17 cm, not 16
    widest_reach: float = 2.5  # times the least radius that the limit allows
    largest_cut: float = 1.75  # times that radius. A line that is cut by more comes back on itself
    least_length: float = 0.6  # of a line's length, after rounding. With 0.9 more lines get loops
    loop_radius: float = 1.15  # times that radius. Walks are faster where they enter loops; 1.4 is wider
    pursuit_distance: float = 0.6  # times that radius: how far ahead the goal is. 0.2 to 1.2 are as good
    pursuit_step: float = 0.5  # of a step, at least, or a pursuit circles. 0.25 to 0.75 are as good
    tightest_radius: float = 0.2  # metres. With 0.1 walks turn at twice the limit; 0.4 makes wide loops

    # Warps
    key_margin: float = 0.5  # seconds on each side. With 0.15 a hand shakes 8 times as much, not 1.1

    # Mirror images
    lopsided: float = 0.01  # metres by which a bone and its partner differ without a warning
    mirror_axis: float = math.radians(10.0)  # radians: a plane nearer to an axis of the body is taken for it
    mirror_margin: float = 0.2  # of the bones' squares, between opposite axes. 0.02 to 0.6 are as good
    mirror_ridge: float = 1e-6  # of the bones' squares, for undetermined axes. 1e-9 to 0.01 are as good

    # The search for cycles
    loop_rate: float = 30.0  # frames per second, of the search in the whole clip
    loop_longest: float = 300.0  # seconds of a clip. The distances of all its windows take 0.3 GB
    loop_rows: int = 600  # frames of the clip, at even distances, that a cycle may cover
    loop_percentile: float = 90.0  # of displacements, to which larger ones count, where the data leap
    loop_motion: float = 0.75  # of the clip's motion per frame. A cycle that moves less is a held pose
    loop_slack: float = 1.1  # times the least cost. Two strides are hardly better than one
    loop_margin: float = 3.0  # seconds: longer than a footplant, and than the reach of any correction
    loop_seam: float = 0.2  # seconds, of the windows that are compared, and of the blend

    # Stances
    hips_level: float = 30.0  # degrees. Hips of rest poses that stand are level to 0, of others by 90
    thighs_hanging: float = 45.0  # degrees. Thighs of rest poses that stand hang to 20 (CMU), of others by 90
    pose_frames: int = 2  # A motion of no more frames is a pose: no feet that stand, and none that swing
    pose_seconds: float = 0.1  # A motion that is shorter is a pose
    ankle_rise: float = 0.05  # of a leg: higher is an ankle that passes the other one in a step
    ankle_lead: float = 0.25  # of a leg: farther ahead is an ankle in a step
    pose_below: float = 0.05  # of a leg. A pose that is lower is relative to its root
    pose_above: float = 0.2  # of a leg. A pose that is higher is relative to its root
    run_percentile: float = 25.0  # of ankle heights over standing balls. 10 to 50 are within 12 mm

    # Retargeting: a change that decays sooner than that of an edit
    worn_knots: float = 0.125  # seconds between knots
    worn_decay: float = 0.1  # seconds in which a change decays beyond a constraint
    worn_passes: int = 5  # iterations at most, enough for footplants
    worn_stiffness: float = 4.0  # times, on costs of knees and trunk. With 1 knees straighten to 3°, not 5°
    worn_slide: float = 0.001  # metres. Feet that slide further are cleaned up first; else 6 % are released
    worn_hips: float = 0.5  # of a leg. Hips that move by more jump: a child's at 3 times its steps


TUNED = Tuned()
