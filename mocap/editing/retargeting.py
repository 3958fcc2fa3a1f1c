"""Retargeting: the motion of one body for another one, by a copy and a smooth change of it [Gle98].

The steps of the paper are: start from the old motion, scale the path of the root, choose the time between
knots, solve for all frames at once, and solve again with more knots if a constraint is not met. Here the
start is a copy of global rotations (`pose_copying`). In the last stage every frame is a knot.
"""

from collections.abc import Iterable

import numpy as np

from mocap._shared.arguments import checked_by
from mocap._shared.arrays import Array
from mocap._shared.quantities import described
from mocap.body.foot_joints import feet_of
from mocap.body.limbs import FEET, SIDES
from mocap.body.motion import Motion, require_motion
from mocap.body.skeleton import Skeleton
from mocap.editing.above_floor import Heights, Solving, meet_above_floor
from mocap.editing.bodies import Body, body_rotating
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins, plant_pins, with_plants
from mocap.editing.pose_copying import copied
from mocap.editing.poses import MotionOrPoses, Poses, poses_of
from mocap.editing.stages import Stage, closing_stages
from mocap.editing.stances import Stance, stance_of, stance_of_zero
from mocap.editing.standing import mark_met
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, shortened, warn
from mocap.feet.footskate import clean_up


def _require_stances(
    motion: object = None, body: object = None, source: object = None, **_options: object
) -> None:
    """Raise unless a motion comes with the stances of both bodies."""
    require_motion(motion)
    for stance in (body, source):
        if not isinstance(stance, Stance):
            needs = "This takes the stances of both bodies, body and source"
            raise MocapError(f"{needs}, got {described(stance)}: editing.wear(motion, skeleton) finds them.")


@checked_by(_require_stances)
def retarget(motion: Motion, body: Stance, source: Stance, *, scale: float | None = None) -> Motion:
    """Retarget a motion to another body, with its feet planted on the floor when the old feet were planted.

    In the paper: [Gle98, method].

    The motion is copied. Then the smallest smooth change over all frames at once moves the feet to their
    constraints [Gle98]. In a copy of joint angles, feet would slide, float and sink, and bodies with other
    rest poses would fold.

    Parameters
    ----------
    motion : F frames, with `contacts`, which are also those of the new body. Feet that slide are cleaned up
        first. For a clip as it was read, `wear` finds contacts and stances.
    body, source : the stances of the new and of the old body.
    scale : of the path on the ground; by default the ratio of the legs. A larger one makes longer steps.

    Returns
    -------
    F frames of the new skeleton, with the motion's name and labels. Accelerations are multiplied by the
    scale: for a child's jump `retime` by 1 / √scale.

    Raises
    ------
    MocapError : for a value that is no stance, missing contacts, and constraints that no pose can meet.
    SkeletonMismatch : for a motion of another skeleton than the source's.

    Warns
    -----
    MocapWarning : for steps that are too long: hips that move by more than half a leg, and constraints that
        are missed by more than 0.1 mm; footplants among them are released.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing import proportioned
    >>> walk = sample("walk_straight")[:240]
    >>> adult = stance_of(walk)
    >>> worn = retarget(walk, proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85), adult)
    >>> [round(float(clip.root_positions[-1, 2] - clip.root_positions[0, 2]), 2) for clip in (walk, worn)]
    [2.54, 1.4]

    Notebook: 13-retargeting
    """
    poses = poses_of(motion)
    planted = poses
    if plant_pins(poses, source.legs).errors(poses).max() > TUNED.worn_slide:
        planted = poses_of(clean_up(motion, source.legs, poses=poses.world))
    base = poses_of(copied(planted, source, body, scale=scale))
    positions = poses.positions
    plants = floor_pins(base, body)
    pins = join_pins(floor_under(positions, source, body), plants)
    allowed = lowest_worn(positions, body.leg / source.leg, len(body.skeleton))
    worn = meet_above_floor(base, pins, _solving(base, body), Heights(feet_of(base.motion), allowed, allowed))
    moved = np.abs(worn.motion.root_positions - base.motion.root_positions).max()
    if moved > TUNED.worn_hips * body.leg:
        hips = f"the hips move by {100 * moved:.0f} cm to take these steps"
        legs = f"with legs of {100 * body.leg:.0f} cm: no leg takes them at ease"
        warn(f"'{shortened(motion.name)}': {hips}, {legs}.")
    return mark_met(worn, pins, plants)


def _solving(base: Poses, body: Stance) -> Solving:
    """Return how a copied motion is solved for: with a higher cost of knees and trunk than in an edit."""
    smooth = Stage(knots=TUNED.worn_knots, decay=TUNED.worn_decay, passes=TUNED.worn_passes)
    costs = dict.fromkeys(_stiff_joints(body), TUNED.worn_stiffness)

    def body_for(pins: Pins) -> Body:
        return body_rotating(base, pins.movers(body.skeleton), costs)

    return Solving((smooth, *closing_stages()), body_for)


def _stiff_joints(body: Stance) -> list[str]:
    """Return the names of the knees, and of the joints of the trunk above the pelvis."""
    trunk = body.skeleton.path_to_root(body.roles.get("chest", 0))
    stiff = [leg.knee for leg in body.legs]
    stiff += [joint for joint in trunk if joint > body.roles["pelvis"]]
    return [body.skeleton.names[joint] for joint in stiff]


def wear(motion: Motion, body: Skeleton | Stance, *, clips: Iterable[Motion] = ()) -> Motion:
    """Retarget a motion as it was read: mark its footplants, find both stances, and call `retarget`.

    Parameters
    ----------
    motion : F frames; its footplants are marked if it has none.
    body : the skeleton of the other body, such as `mocap.load("child.bvh").skeleton`, or its stance, from
        `stance_of`. The balls of a skeleton stand as high as those of the clip, times the ratio of the legs.
    clips : other motions of the old body, for the heights of feet that never stand in this one.

    Returns
    -------
    F frames of the other body.

    Raises
    ------
    MocapError : for another `body`, legs that are not found, a clip in which no foot ever stands, and as for
        `retarget`.

    Warns
    -----
    MocapWarning : as for `retarget`, and `stance_of`.

    Examples
    --------
    A body of 70 % of the size:

    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]
    >>> child = replace(walk.skeleton, offsets=0.7 * walk.skeleton.offsets)
    >>> worn = wear(walk, child)
    >>> round(float(worn.root_positions[:, 1].mean() / walk.root_positions[:, 1].mean()), 1)
    0.7
    """
    require_motion(motion)
    if not isinstance(body, Skeleton | Stance):
        remedy = "motion.skeleton, or editing.stance_of(motion), of a motion of that body"
        raise MocapError(f"body is a skeleton or a stance, got {described(body)}: pass {remedy}.")
    motion = with_plants(motion)
    source = stance_of(motion, clips=clips)
    if isinstance(body, Skeleton):
        ratio = stance_of_zero(body, 0.0).leg / source.leg
        body = stance_of_zero(body, ratio * source.height("ball"))
    return retarget(motion, body, source)


def floor_pins(motion: MotionOrPoses, stance: Stance) -> Pins:
    """Return constraints that hold each footplant at the height of its joint in a stance.

    The ankle of one body stands 4 cm above the ball, that of another 8 cm. Therefore the heights are those of
    the new body, not of the old feet. The position of a footplant on the ground is the mean over its frames
    [Gle98]. The floor is level, at y = 0, also for a footplant that was on a step.

    Parameters
    ----------
    motion : the copied motion, with `contacts` of ankles and balls.
    stance : of its body.

    Raises
    ------
    MocapError : for missing contacts.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> upstairs = replace(walk, root_positions=walk.root_positions + [0, 0.2, 0])
    >>> ankle = floor_pins(upstairs, stance_of(walk)).low[:, 0, 1]  # held at one height, or free
    >>> np.unique(ankle[np.isfinite(ankle)]).round(3)
    array([0.068])

    Notebook: 13-retargeting
    """
    return plant_pins(motion, stance.legs, np.reshape([stance.heights[role] for role in FEET], (2, 2)))


def lowest_worn(positions: Array, ratio: float, joints: int) -> Array:
    """Compute the least heights of the joints of another body, (F, joints), metres.

    They are those of the floor, y = 0, or if the lowest joint of the source is below the floor in that frame,
    its height, in proportion to the legs.

    Parameters
    ----------
    positions : of the source's joints, (F, J, 3), metres.
    ratio : of the length of the new legs to that of the old ones.
    joints : the number of joints of the other body.

    Examples
    --------
    >>> lowest_worn(np.array([[[0.0, 0.02, 0.0]], [[0.0, -0.02, 0.0]]]), 0.5, 2)
    array([[ 0.  ,  0.  ],
           [-0.01, -0.01]])
    """
    lowest = np.minimum(ratio * positions[..., 1].min(axis=1), 0.0)
    return np.repeat(lowest[:, None], joints, axis=1)


def floor_under(positions: Array, source: Stance, body: Stance) -> Pins:
    """Return constraints that keep ankles and balls above their least heights in the source's motion.

    The least height is relative to the height at which the joint stands, and to the floor, y = 0, and in
    proportion to the legs.

    Parameters
    ----------
    positions : of the source's joints, (F, J, 3), metres.
    source, body : the stances of the old and of the new body.
    """
    lowest = positions[..., 1].min(axis=0)
    sides = [side for side, leg in zip(SIDES, body.legs, strict=True) if not leg.has_ball]
    feet = [role for role in FEET if role not in [f"{side} ball" for side in sides]]
    high = np.full((len(positions), len(feet), 3), np.inf)
    low = -high
    for column, role in enumerate(feet):
        dip = max(0.0, source.heights[role] - lowest[source.roles[role]])
        low[:, column, 1] = body.heights[role] - dip * body.leg / source.leg
        depth = body.leg / source.leg * min(0.0, lowest[source.roles[role]])
        low[:, column, 1] = np.maximum(low[:, column, 1], depth)
    return Pins(tuple(body.roles[role] for role in feet), low, high)
