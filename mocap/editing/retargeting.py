"""A motion worn by another body: copied, then brought back to the floor by a smooth change [Gle98].

The paper's steps: start from the old motion, scale the root's way, choose how far apart the knots are, solve
for all frames at once, and solve again with more knots where something is not met. Here the start is a copy
from body to body, so that trees and rest poses may differ, and the last knots are the frames.
"""

from collections.abc import Mapping

import numpy as np

from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.bodies import body_of
from mocap.editing.body_roles import FEET
from mocap.editing.copied_motion import copied
from mocap.editing.edits import let_go
from mocap.editing.pins import Pins, join_pins, pin_errors, plant_pins, with_plants
from mocap.editing.solver import CLOSE, solve
from mocap.editing.stances import Stance, stance_of, stance_of_zero
from mocap.editing.steps import Basis
from mocap.errors import shortened, warn
from mocap.feet.footskate import clean_up

# Less calm than an edit: with 0.2 the knees of a child with long steps straighten to 4°. Few passes are
# enough for plants.
RETARGET = (Basis(knots=0.125, calm=0.1, passes=5), CLOSE, CLOSE)

# What turns of knees and of the trunk cost, as a share of what they move. With 1 the knees of a child that
# takes long steps straighten. A hand that reaches for a rail leans the body by 17° with 1, and by 12° with 4.
STIFF = 4.0

# Metres. Feet that move more while they stand are cleaned up first. Without that, up to 6 % of the planted
# frames of captured walks are let go on the new body; with it, none that stand on the old one.
STILL = 0.001

MOST = 0.5  # of a leg: hips that move by more to take the steps jump; a child's do at 3 times its own steps


def retarget(
    motion: Motion, body: Skeleton | Stance, source: Stance | None = None, *, scale: float | None = None
) -> Motion:
    """Let another body wear a motion, with its feet planted on the floor where the old feet were planted.

    In the paper: [Gle98, method].

    The motion is copied; pins say where its feet must be; the smallest smooth change over all frames at once
    brings them there [Gle98]. Copied angle by angle, feet would slide, float and sink, and bodies with other
    rest poses would fold.

    Parameters
    ----------
    motion : F frames; its plants are marked if they are not yet, and its feet cleaned up if they slide. Its
        plants are the new body's as well.
    body : how the new body stands; or its skeleton, whose rest pose must stand. Then its balls are as high
        over the floor as the source's, times the ratio of the legs.
    source : how the old body stands; by default `stance_of(motion)`.
    scale : of the way over the ground; by default the ratio of the legs. More makes the steps longer.

    Returns
    -------
    F frames of the new skeleton, with the motion's name and labels. It falls as fast as the scale says: for a
    child's jump `retime` by 1 / √scale.

    Raises
    ------
    MocapError : for legs that are not found, rest poses that do not stand, and pins that no pose can meet.
    SkeletonMismatch : for a motion of another skeleton than the source's.

    Warns
    -----
    MocapWarning : for steps that no leg takes: hips that move by more than half a leg, and pins that are
        missed by more than 0.1 mm; plants among them are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import proportioned
    >>> walk = sample("walk_straight")[:240]
    >>> child = proportioned(stance_of(walk), legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    >>> worn = retarget(walk, child)
    >>> [round(float(clip.root_positions[-1, 2] - clip.root_positions[0, 2]), 2) for clip in (walk, worn)]
    [2.12, 1.17]

    Notebook: 13-retargeting
    """
    source = stance_of(motion) if source is None else source
    target = body if isinstance(body, Stance) else standing_like(body, source)
    planted = with_plants(motion, source.legs)
    if pin_errors(planted, plant_pins(planted, source.legs)).max() > STILL:
        planted = clean_up(planted, source.legs)
    base = copied(planted, source, target, scale=scale)
    dips = {role: dip * target.leg / source.leg for role, dip in dips_of(motion, source).items()}
    wishes = floor_pins(base, target, dips)
    who, trunk = target.roles, target.skeleton.path_to_root(target.roles.get("chest", 0))
    stiff = [*(leg.knee for leg in target.legs), *(joint for joint in trunk if joint > who["pelvis"])]
    prices = dict.fromkeys((target.skeleton.names[joint] for joint in stiff), STIFF)
    priced = body_of(base, wishes.joints, prices=prices)
    worn = solve(base, wishes, RETARGET, priced, quiet=True).motion
    if (moved := np.abs(worn.root_positions - base.root_positions).max()) > MOST * target.leg:
        hips = f"the hips move by {100 * moved:.0f} cm to take these steps"
        legs = f"with legs of {100 * target.leg:.0f} cm: no leg takes them at ease"
        warn(f"'{shortened(motion.name)}': {hips}, {legs}.")
    return let_go(worn, wishes, floor_pins(base, target))


def floor_pins(motion: Motion, stance: Stance, dips: Mapping[str, float] | None = None) -> Pins:
    """Hold each plant at the height that its joint stands at, and keep feet above the floor.

    Feet differ: an ankle stands 4 cm over the ball in one body and 8 cm in another. So plants take their
    heights from how the new body stands, not from the old feet. A plant's place over the ground is the mean
    over its frames [Gle98]. The floor is level, at y = 0: a plant on a step comes down to it.

    Parameters
    ----------
    motion : the copied motion; its `contacts` say when ankles and balls stand.
    stance : how its body stands.
    dips : how far each ankle and ball may be lower than it stands, metres by role; without it there is no
        floor, only plants.

    Raises
    ------
    MocapError : for marks that are missing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> pins = floor_pins(walk, stance_of(walk))
    >>> ankle = pins.low[:, 0, 1]  # held at one height, or free
    >>> np.unique(ankle[np.isfinite(ankle)]).round(3)
    array([0.068])

    Notebook: 13-retargeting
    """
    heights = np.reshape([stance.heights[role] for role in FEET], (2, 2))
    free = np.full((len(motion), len(dips or ()), 3), np.inf)
    low = -free
    low[..., 1] = [stance.heights[role] - dip for role, dip in (dips or {}).items()]
    floors = Pins(tuple(stance.roles[role] for role in dips or ()), low, free)
    return join_pins(floors, plant_pins(motion, stance.legs, heights))


def dips_of(motion: Motion, stance: Stance) -> dict[str, float]:
    """Measure how far each ankle and ball ever is below where it stands, metres by role, 0 or more."""
    lowest = joint_positions(motion)[..., 1].min(axis=0)
    return {role: max(0.0, stance.heights[role] - float(lowest[stance.roles[role]])) for role in FEET}


def standing_like(skeleton: Skeleton, source: Stance) -> Stance:
    """Take a skeleton's rest pose as its stance, with balls as high as another body's, by the legs' ratio.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> adult = stance_of(sample("walk_straight"))
    >>> round(standing_like(adult.skeleton, adult).height("ball"), 3)
    0.026
    """
    ratio = stance_of_zero(skeleton, 0.0).leg / source.leg
    return stance_of_zero(skeleton, ratio * source.height("ball"))
