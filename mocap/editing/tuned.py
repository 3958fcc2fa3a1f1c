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

    # ---- Stances, retargeting, bending, warps, keys, turning and retiming ----


TUNED = Tuned()
